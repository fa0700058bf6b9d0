// A scalar's place in the tables, whose cells list all the nodes inside them.

fn place_of(s: f32) -> TablePlace {
    let cell = cell_of(s);
    let listed = table_cells[cell.index];
    let is_beyond = listed.inside <= vec2<f32>(cell.u);
    let next = f32(cell.index + 1u);
    let low = select(f32(cell.index), listed.inside[0], is_beyond[0]);
    let high = select(min(listed.inside[0], next), next, is_beyond[0]);
    let node = listed.first + select(0u, 1u, is_beyond[0]) + select(0u, 1u, is_beyond[1]);
    return place_between(cell.u, node, select(low, listed.inside[1], is_beyond[1]),
        select(min(high, listed.inside[1]), next, is_beyond[1]));
}
