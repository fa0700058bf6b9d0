// The stored sample at a point of a brick, interpolated by the texture unit.

@group(0) @binding(BINDING_ATLAS) var atlas: texture_3d<f32>;
@group(0) @binding(BINDING_SAMPLER) var trilinear: sampler;

// Points are taken to the nearest 1/4096 texel: with slots at whole texels and an atlas of 2^n texels along each axis, the
// texture coordinate is then exact, so that the same point of a brick gives the same bits in any slot.
const GRID: f32 = 4096.0;

// `origin` is the slot's first texel, `point` in texels of the brick, sample centres at integer + 0.5.
fn sample_atlas(origin: vec3<f32>, point: vec3<f32>) -> f32 {
    let exact = origin + round(point * GRID) / GRID;
    return textureSampleLevel(atlas, trilinear, exact * scene.texel.xyz, 0.0).x;
}

// Differences of the samples one texel ahead and one behind, along each axis.
fn differences(origin: vec3<f32>, point: vec3<f32>) -> vec3<f32> {
    let x = vec3<f32>(1.0, 0.0, 0.0);
    let y = vec3<f32>(0.0, 1.0, 0.0);
    let z = vec3<f32>(0.0, 0.0, 1.0);
    return vec3<f32>(sample_atlas(origin, point + x) - sample_atlas(origin, point - x),
        sample_atlas(origin, point + y) - sample_atlas(origin, point - y),
        sample_atlas(origin, point + z) - sample_atlas(origin, point - z));
}
