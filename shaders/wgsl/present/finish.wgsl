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

@compute @workgroup_size(TILE_EDGE, TILE_EDGE, 1)
fn finish_pixel(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    if !is_in_raster(pixel) {
        return;
    }
    let at = place_of(pixel);
    let light = light_of(at);
    var packed = 0u;
    for (var channel = 0u; channel < 3u; channel++) {
        packed |= code_of(channel, light[channel], id.xy) << (8u * channel);
    }
    codes[at] = packed;
}
