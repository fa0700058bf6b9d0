// The tiles that are listed: how many tiles and runs of them, then of each run the place of its first tile, its view, and the
// number of that tile.

struct ListedTile {
    view: u32,
    number: u32,
}

fn tile_at(place: u32) -> ListedTile {
    var low = 0u;
    var high = listed[1];
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if listed[2u + 3u * middle] <= place {
            low = middle;
        } else {
            high = middle;
        }
    }
    let run = 2u + 3u * low;
    return ListedTile(listed[run + 1u], listed[run + 2u] + (place - listed[run]));
}

// A pixel of the projector, by its place in a tile.
fn pixel_of(tile: ListedTile, local: vec2<u32>) -> vec2<u32> {
    let across = projector.raster.z;
    let in_tiles = vec2<u32>(tile.number % across, tile.number / across) * TILE_EDGE + local;
    return in_tiles * projector.lattice.xy + projector.lattice.zw;
}

// Whether the projector has it.
fn is_in_raster(pixel: vec2<u32>) -> bool {
    return pixel.x < projector.raster.x && pixel.y < projector.raster.y;
}

// Its place in the arena.
fn index_of(pixel: vec2<u32>) -> u32 {
    return projector.raster.w + pixel.y * projector.raster.x + pixel.x;
}
