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
