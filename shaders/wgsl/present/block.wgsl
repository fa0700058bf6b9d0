// What all kernels that present read; its Rust form stands in the crate layout.

struct PresentBlock {
    raster: vec4<u32>,
    steps: array<vec4<i32>, MOST_PAIRS>,
    numbers: vec4<f32>,
    stages: vec4<u32>,
    black: vec4<f32>,
}

@group(0) @binding(BINDING_PRESENT) var<uniform> present: PresentBlock;
@group(0) @binding(BINDING_PICTURE) var<storage, read> picture: array<vec4<f32>>;

fn is_in_raster(pixel: vec2<i32>) -> bool {
    return all(pixel >= vec2<i32>(0)) && all(pixel < vec2<i32>(present.raster.xy));
}

fn place_of(pixel: vec2<i32>) -> u32 {
    return u32(pixel.y) * present.raster.x + u32(pixel.x);
}

// The largest difference of any of a pixel's numbers.
fn difference(a: vec4<f32>, b: vec4<f32>) -> f32 {
    let apart = abs(a - b);
    return max(max(apart.x, apart.y), max(apart.z, apart.w));
}
