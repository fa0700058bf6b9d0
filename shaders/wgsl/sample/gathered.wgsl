// The stored sample at a point of a brick, interpolated in f32 from two gathers of four texels each: a texture unit takes a
// quarter of the time that eight fetches take. Layers of the atlas are its third axis.

@group(0) @binding(BINDING_ATLAS) var atlas: texture_2d_array<f32>;
@group(0) @binding(BINDING_SAMPLER) var nearest: sampler;

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

// Four texels of a layer, from the lowest one on: 00, 10, 01, 11 along x and y.
fn quad_at(texel: vec3<f32>) -> vec4<f32> {
    // Between the four: exact, as whole texels are in an atlas of 2^n along each axis.
    return textureGather(0, atlas, nearest, (texel.xy + 1.0) * scene.texel.xy, i32(texel.z)).wzxy;
}
