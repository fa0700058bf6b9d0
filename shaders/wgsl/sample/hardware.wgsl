// The stored sample at a point of the atlas, interpolated by the texture unit.

@group(0) @binding(8) var trilinear: sampler;

// `point` in texels of the atlas, sample centres at integer + 0.5.
fn sample_atlas(point: vec3<f32>) -> f32 {
    return textureSampleLevel(atlas, trilinear, point * params.texel.xyz, 0.0).x;
}
