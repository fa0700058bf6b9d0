// What the rays of each tile counted, added up: a word a tile, so that pictures' counts stay on the device.

@group(0) @binding(BINDING_TALLIES) var<storage, read_write> tallies: array<u32>;

// One tile per invocation: the samples of its rays, with MISSING where any of them met a node that is too coarse.
@compute @workgroup_size(TALLIED_TILES, 1, 1)
fn tally_tile(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_id) local: vec3<u32>) {
    let place = (group.x + group.y * groups.x) * TALLIED_TILES + local.x;
    if place >= listed[0] {
        return;
    }
    projector = views[listed[1u + 2u * place]];
    let tile = listed[2u + 2u * place];
    let across = projector.raster.z;
    let corner = vec2<u32>(tile % across, tile / across) * TILE_EDGE;
    var samples = 0u;
    var missing = 0u;
    for (var i = 0u; i < TILE_EDGE * TILE_EDGE; i++) {
        let in_tiles = corner + vec2<u32>(i % TILE_EDGE, i / TILE_EDGE);
        let pixel = in_tiles * projector.lattice.xy + projector.lattice.zw;
        if pixel.x < projector.raster.x && pixel.y < projector.raster.y {
            let count = counts[projector.raster.w + pixel.y * projector.raster.x + pixel.x];
            samples += count & ~MISSING;
            missing |= count & MISSING;
        }
    }
    tallies[place] = samples | missing;
}
