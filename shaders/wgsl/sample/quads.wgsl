// The stored sample at a point of a brick, and its differences, interpolated in f32 from fours of neighbours.

// `origin` is the slot's first texel, `point` in texels of the brick, sample centres at integer + 0.5. The slot enters as
// whole numbers alone, so that the same point of a brick gives the same bits in any slot.
fn sample_atlas(origin: vec3<f32>, point: vec3<f32>) -> f32 {
    let shifted = point - 0.5;
    let base = floor(shifted);
    let f = shifted - base;
    let near = quad_at(origin + base);
    let far = quad_at(origin + base + vec3<f32>(0.0, 0.0, 1.0));
    let low = vec4<f32>(near.xz, far.xz);
    let high = vec4<f32>(near.yw, far.yw);
    let along_x = low + (high - low) * f.x;
    let along_y = along_x.xz + (along_x.yw - along_x.xz) * f.y;
    return along_y.x + (along_y.y - along_y.x) * f.z;
}

// Differences of the samples one texel ahead and one behind, along each axis: the same as six samples. Neighbours a whole texel
// apart share their weights, so texels are subtracted before they are weighed.
fn differences(origin: vec3<f32>, point: vec3<f32>) -> vec3<f32> {
    let shifted = point - 0.5;
    let base = floor(shifted);
    let f = shifted - base;
    let texel = origin + base;
    let behind = quad_at(texel - vec3<f32>(0.0, 0.0, 1.0));
    let near = beside(texel, f);
    let far = beside(texel + vec3<f32>(0.0, 0.0, 1.0), f);
    let ahead = quad_at(texel + vec3<f32>(0.0, 0.0, 2.0));
    let x = near.x + (far.x - near.x) * f.z;
    let y = near.y + (far.y - near.y) * f.z;
    let z = (far.middle - behind) + ((ahead - near.middle) - (far.middle - behind)) * f.z;
    let along_x = z.xz + (z.yw - z.xz) * f.x;
    return vec3<f32>(x, y, along_x.x + (along_x.y - along_x.x) * f.y);
}

// What a layer tells.
struct Beside {
    // Differences along x and along y.
    x: f32,
    y: f32,
    // The four texels around the point.
    middle: vec4<f32>,
}

fn beside(texel: vec3<f32>, f: vec3<f32>) -> Beside {
    let left = quad_at(texel - vec3<f32>(1.0, 0.0, 0.0));
    let right = quad_at(texel + vec3<f32>(1.0, 0.0, 0.0));
    let above = quad_at(texel - vec3<f32>(0.0, 1.0, 0.0));
    let below = quad_at(texel + vec3<f32>(0.0, 1.0, 0.0));
    let by_row = (right.xz - left.xz) + ((right.yw - left.yw) - (right.xz - left.xz)) * f.x;
    let by_column = (below.xy - above.xy) + ((below.zw - above.zw) - (below.xy - above.xy)) * f.y;
    return Beside(by_row.x + (by_row.y - by_row.x) * f.y, by_column.x + (by_column.y - by_column.x) * f.x,
        vec4<f32>(left.y, right.x, left.w, right.z));
}
