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
    let across = projector.raster.z;
    let in_tiles = vec2<u32>(tile.number % across, tile.number / across) * TILE_EDGE + local.xy;
    let pixel = in_tiles * projector.lattice.xy + projector.lattice.zw;
    if pixel.x >= projector.raster.x || pixel.y >= projector.raster.y {
        return;
    }
    var count = 0u;
    let colour = cast_ray(ray_of_pixel(vec2<f32>(pixel) + 0.5), &count);
    let index = projector.raster.w + pixel.y * projector.raster.x + pixel.x;
    pixels[index] = debug_pixel(colour, count & ~MISSING);
    counts[index] = count;
}
