// Which column of which layer of which row an invocation is at: a workgroup takes a row of columns.

struct PlanePlace {
    // Whether there is such a layer.
    exists: bool,
    band: PlaneBand,
    layer: PlaneLayer,
    // The row's number in its band.
    number: u32,
    // The layer's number in its band.
    number_of_layer: u32,
    // First column of the group.
    first: u32,
}

fn plane_place(group: vec3<u32>) -> PlanePlace {
    var place: PlanePlace;
    place.band = bands[group.z / TILE_EDGE];
    place.number = group.z % TILE_EDGE;
    place.number_of_layer = group.y;
    place.first = group.x * PLANE_COLUMNS;
    place.exists = group.y < place.band.layers && row_of(place.band, place.number) < fan.grid.rows;
    if place.exists {
        place.layer = plane_layers[place.band.first_layer + group.y];
        place.exists = place.first < place.layer.width;
    }
    return place;
}

// Where the block of a column is kept.
fn block_kept_at(place: PlanePlace, column: u32) -> u32 {
    return place.band.first_block + place.number * place.band.blocks + place.layer.block_at
        + column / columns_of_block(place.layer);
}

// Where a column is kept.
fn kept_at(place: PlanePlace, column: u32) -> u32 {
    return place.band.first_column + place.number * place.band.columns + place.layer.at + column;
}
