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
