// Four stored samples by four fetches.

@group(0) @binding(BINDING_ATLAS) var atlas: texture_3d<f32>;

// Four texels of a layer, from the lowest one on: 00, 10, 01, 11 along x and y.
fn quad_at(texel: vec3<f32>) -> vec4<f32> {
    let i = vec3<i32>(texel);
    return vec4<f32>(texel_at(i, 0, 0), texel_at(i, 1, 0), texel_at(i, 0, 1), texel_at(i, 1, 1));
}

fn texel_at(first: vec3<i32>, x: i32, y: i32) -> f32 {
    return textureLoad(atlas, first + vec3<i32>(x, y, 0), 0).x;
}
