// What the rays of each tile counted, added up, so that pictures' counts stay on the device.

struct TileTally {
    samples: u32,
    missing: array<u32, 2>,
    cut: u32,
}

@group(0) @binding(BINDING_TALLIES) var<storage, read_write> tallies: array<TileTally>;

var<workgroup> samples: atomic<u32>;
var<workgroup> missing: array<atomic<u32>, 2>;
var<workgroup> cut: atomic<u32>;

// One tile per invocation: the samples of its rays, how many of them the driver left before their end, and whether any met a
// node that is too coarse.
fn tally(tile: ListedTile, place: u32) {
    projector = views[tile.view];
    var all = 0u;
    var left = 0u;
    for (var i = 0u; i < TILE_EDGE * TILE_EDGE; i++) {
        let pixel = pixel_of(tile, vec2<u32>(i % TILE_EDGE, i / TILE_EDGE));
        if is_in_raster(pixel) {
            let count = counts[index_of(pixel)];
            all += count & SAMPLE_COUNT;
            left += select(0u, 1u, (count & CUT) != 0u);
            if (count & MISSING) != 0u {
                atomicOr(&missing[place / 32u], 1u << (place % 32u));
            }
        }
    }
    atomicAdd(&samples, all);
    atomicAdd(&cut, left);
}

@compute @workgroup_size(TALLIED_TILES, 1, 1)
fn tally_tiles(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_id) local: vec3<u32>) {
    let index = group.x + group.y * groups.x;
    let place = index * TALLIED_TILES + local.x;
    if place < listed[0] {
        tally(tile_at(place), local.x);
    }
    workgroupBarrier();
    if local.x == 0u && place < listed[0] {
        let met = array<u32, 2>(atomicLoad(&missing[0]), atomicLoad(&missing[1]));
        tallies[index] = TileTally(atomicLoad(&samples), met, atomicLoad(&cut));
    }
}
