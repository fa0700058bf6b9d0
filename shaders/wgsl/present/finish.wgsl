// From the picture of one projector to its codes; see backend/renderer/src/present/finish/mod.rs.

@group(0) @binding(BINDING_BLEND) var<storage, read> blend: array<f32>;
@group(0) @binding(BINDING_BLACK) var<storage, read> black: array<f32>;
@group(0) @binding(BINDING_CODES) var<storage, read_write> codes: array<u32>;

fn has_stage(stage: u32) -> bool {
    return (present.stages.y & stage) != 0u;
}

// The linear light of a pixel.
fn light_of(at: u32) -> vec3<f32> {
    var seen = vec3<f32>(0.0);
    if has_stage(HAS_WARP) {
        seen = warped_colour(at);
    } else {
        seen = picture[at].rgb;
    }
    var light = min(max(seen, vec3<f32>(0.0)), vec3<f32>(1.0));
    if has_stage(HAS_BLEND) {
        light = light * blend[at];
    }
    var lifted = present.black.rgb;
    if has_stage(HAS_BLACK_MAP) {
        lifted = vec3<f32>(black[at]);
    }
    return lifted + (1.0 - lifted) * light;
}

// Four pixels of a row, whose codes are three whole words.
@compute @workgroup_size(TILE_EDGE, TILE_EDGE, 1)
fn finish_pixels(@builtin(global_invocation_id) id: vec3<u32>) {
    let first = vec2<u32>(id.x * CODED_PIXELS, id.y);
    if !is_in_raster(vec2<i32>(first)) {
        return;
    }
    var words = vec3<u32>(0u);
    for (var i = 0u; i < CODED_PIXELS; i++) {
        let pixel = first + vec2<u32>(i, 0u);
        if !is_in_raster(vec2<i32>(pixel)) {
            break;
        }
        let light = light_of(place_of(vec2<i32>(pixel)));
        for (var channel = 0u; channel < 3u; channel++) {
            let byte = 3u * i + channel;
            words[byte / 4u] |= code_of(channel, light[channel], pixel) << (8u * (byte % 4u));
        }
    }
    let across = (present.raster.x + CODED_PIXELS - 1u) / CODED_PIXELS;
    let at = 3u * (id.y * across + id.x);
    codes[at] = words.x;
    codes[at + 1u] = words.y;
    codes[at + 2u] = words.z;
}
