// Averages of the transfer functions over a segment, from tables of f and F = ∫ f.

// A scalar's place in the tables.
struct TablePlace {
    // Position in cells.
    u: f32,
    // The node at or below it, and how far it is from there to the next.
    node: u32,
    part: f32,
    // The positions of that node and the next.
    low: f32,
    high: f32,
}

// A scalar's place, and a table's values there: looked up once, used for every mean that ends at it.
struct Located {
    place: TablePlace,
    value: vec4<f32>,
}

// A scalar's position in cells, and the cell.
struct CellPlace {
    u: f32,
    index: u32,
}

fn cell_of(s: f32) -> CellPlace {
    let cells = scene.tables.x;
    let u = s * f32(cells);
    return CellPlace(u, min(u32(u), cells - 1u));
}

// The place of u between a node and the next, which stand at `low` and `high`.
fn place_between(u: f32, node: u32, low: f32, high: f32) -> TablePlace {
    let width = high - low;
    // The end of the last cell may lie on a jump: it is what it is there.
    return TablePlace(u, node, select(1.0, (u - low) / width, width > 0.0), low, high);
}

fn locate(s: f32) -> Located {
    let place = place_of(s);
    return Located(place, mix(optics_table[place.node].value, optics_table[place.node + 1u].value, place.part));
}

// Mean of (τ c, τ) between two scalars.
fn optics_between(a: Located, b: Located) -> vec4<f32> {
    if a.place.node == b.place.node {
        return 0.5 * (a.value + b.value);
    }
    let ends = in_rising_order(a, b);
    return mean_over(ends.first, optics_table[ends.first.place.node + 1u], optics_table[ends.last.place.node], ends.last);
}

struct Ends {
    first: Located,
    last: Located,
}

fn in_rising_order(a: Located, b: Located) -> Ends {
    if b.place.node < a.place.node {
        return Ends(b, a);
    }
    return Ends(a, b);
}

// Mean of a table from `first` over the nodes `after` it and `before` the last to `last`. Between two nodes f is linear, so
// the mean is that of the ends; over several nodes the end pieces are trapezoids and only what lies between nodes uses the
// difference of integrals, kept as the sum of two floats: nothing cancels.
fn mean_over(first: Located, after: TableEntry, before: TableEntry, last: Located) -> vec4<f32> {
    let left = (first.value + after.value) * (0.5 * (first.place.high - first.place.u));
    let right = (before.value + last.value) * (0.5 * (last.place.u - last.place.low));
    let whole = (before.integral - after.integral) + (before.integral_rest - after.integral_rest);
    return (left + whole + right) / (last.place.u - first.place.u);
}

// Whether nothing within scalars [low, high] changes a picture.
fn is_vacant(low: f32, high: f32) -> bool {
    return table_cells[cell_of(low).index].occupied == table_cells[cell_of(high).index + 1u].occupied;
}

// Whether nothing within `spread` of a range of scalars changes a picture.
fn is_vacant_around(range: vec2<f32>, spread: f32) -> bool {
    return is_vacant(max(range.x - spread, 0.0), min(range.y + spread, 1.0));
}

// φ(x) = (1 − e^−x) / x; a series where the difference would cancel.
fn attenuation_mean(x: f32) -> f32 {
    if x < 0.25 {
        return 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0 - x * (1.0 / 720.0)))));
    }
    return (1.0 - exp(-x)) / x;
}
