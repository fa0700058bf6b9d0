// A scalar's place in the tables, where a cell may hold more nodes than it lists: the last at or below u of the nodes from
// its lower border to its upper one, found by halving.

fn place_of(s: f32) -> TablePlace {
    let cell = cell_of(s);
    var low = table_cells[cell.index].first;
    var high = table_cells[cell.index + 1u].first;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if optics_table[middle].position <= cell.u {
            low = middle;
        } else {
            high = middle;
        }
    }
    return place_between(cell.u, low, optics_table[low].position, optics_table[low + 1u].position);
}
