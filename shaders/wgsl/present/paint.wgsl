// Lays the codes of a projector's picture onto the pixels of a window; see backend/screens/src/wall/pixels.rs.

struct PaintBlock {
    place: vec4<i32>,
    source: vec4<i32>,
    steps: vec4<i32>,
}

@group(0) @binding(BINDING_PAINT) var<uniform> paint: PaintBlock;
@group(0) @binding(BINDING_CODES) var<storage, read> codes: array<u32>;

// The corners of a triangle that the whole window lies in.
@vertex
fn paint_corner(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4<f32> {
    let at = vec2<f32>(f32(corner & 1u), f32(corner >> 1u));
    return vec4<f32>(4.0 * at - 1.0, 0.0, 1.0);
}

@fragment
fn paint_pixel(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(at.xy) - paint.place.xy;
    let source = paint.source.xy + pixel.x * paint.steps.xy + pixel.y * paint.steps.zw;
    let first = u32(source.y * paint.source.z + 3 * source.x);
    var rgb = vec3<f32>(0.0);
    for (var channel = 0u; channel < 3u; channel++) {
        let byte = first + channel;
        rgb[channel] = f32((codes[byte / 4u] >> (8u * (byte % 4u))) & 0xffu);
    }
    return vec4<f32>(rgb / 255.0, 1.0);
}
