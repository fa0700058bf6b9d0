// One ray per invocation, one tile of rays per workgroup; the tiles may be of many views.

@compute @workgroup_size(TILE_EDGE, TILE_EDGE, 1)
fn cast_tile(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_id) local: vec3<u32>) {
    let place = group.x + group.y * groups.x;
    if place >= listed[0] {
        return;
    }
    let tile = tile_at(place);
    projector = views[tile.view];
    let pixel = pixel_of(tile, local.xy);
    if !is_in_raster(pixel) {
        return;
    }
    var count = 0u;
    let colour = cast_ray(ray_of_pixel(vec2<f32>(pixel) + 0.5), &count);
    let index = index_of(pixel);
    pixels[index] = debug_pixel(colour, count & SAMPLE_COUNT);
    counts[index] = count;
}
