// Four stored samples by one gather: a texture unit takes a quarter of the time that four fetches take. Layers of the atlas are
// its third axis.

@group(0) @binding(BINDING_ATLAS) var atlas: texture_2d_array<f32>;
@group(0) @binding(BINDING_SAMPLER) var nearest: sampler;

// Four texels of a layer, from the lowest one on: 00, 10, 01, 11 along x and y.
fn quad_at(texel: vec3<f32>) -> vec4<f32> {
    // Between the four: exact, as whole texels are in an atlas of 2^n along each axis.
    return textureGather(0, atlas, nearest, (texel.xy + 1.0) * scene.texel.xy, i32(texel.z)).wzxy;
}
