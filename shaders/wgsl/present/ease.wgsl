// Takes a picture over into the one that is shown, a pixel by no more than it may change; see
// backend/renderer/src/present/ease.rs.

@group(0) @binding(BINDING_SHOWN) var<storage, read_write> shown: array<vec4<f32>>;
@group(0) @binding(BINDING_BEHIND) var<storage, read_write> behind: atomic<u32>;

@compute @workgroup_size(TILE_EDGE, TILE_EDGE, 1)
fn ease_pixel(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    if !is_in_raster(pixel) {
        return;
    }
    let at = place_of(pixel);
    let now = picture[at];
    let was = shown[at];
    let change = difference(now, was);
    let most = present.numbers.z;
    if present.stages.x == 0u || change <= most {
        shown[at] = now;
        return;
    }
    // On a straight line: a mixture of the two, of no third colour.
    shown[at] = was + most / change * (now - was);
    atomicStore(&behind, 1u);
}
