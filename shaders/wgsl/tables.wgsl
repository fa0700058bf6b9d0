// Averages of the transfer functions over a segment, from tables of f and F = ∫ f.

// A scalar's place in the tables.
struct TablePlace {
    // Position in cells.
    u: f32,
    // The node at or below it, and how far it is from there to the next.
    node: u32,
    part: f32,
}

// A scalar's place, and a table's values there: looked up once, used for every mean that ends at it.
struct Located {
    place: TablePlace,
    value: vec4<f32>,
}

fn place_of(s: f32) -> TablePlace {
    let cells = scene.tables.x;
    let u = s * f32(cells);
    let cell = min(u32(u), cells - 1u);
    let first = table_cells[cell].first;
    let next = table_cells[cell + 1u].first;
    if next - first == 1u {
        return TablePlace(u, first, u - f32(cell));
    }
    return place_among_knots(u, first, next);
}

// The same in a cell with knots: among the nodes from its lower border to its upper one, the last at or below u.
fn place_among_knots(u: f32, first: u32, next: u32) -> TablePlace {
    var low = first;
    var high = next;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if optics_table[middle].position <= u {
            low = middle;
        } else {
            high = middle;
        }
    }
    let from_u = optics_table[low].position;
    let width = optics_table[low + 1u].position - from_u;
    // The end of the last cell may lie on a jump: it is what it is there.
    var part = 1.0;
    if width > 0.0 {
        part = (u - from_u) / width;
    }
    return TablePlace(u, low, part);
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
    if b.place.node < a.place.node {
        return mean_over(b, optics_table[b.place.node + 1u], optics_table[a.place.node], a);
    }
    return mean_over(a, optics_table[a.place.node + 1u], optics_table[b.place.node], b);
}

// Mean of a table from `first` over the nodes `after` it and `before` the last to `last`. Between two nodes f is linear, so
// the mean is that of the ends; over several nodes the end pieces are trapezoids and only what lies between nodes uses the
// difference of integrals, kept as the sum of two floats: nothing cancels.
fn mean_over(first: Located, after: TableEntry, before: TableEntry, last: Located) -> vec4<f32> {
    let left = (first.value + after.value) * (0.5 * (after.position - first.place.u));
    let right = (before.value + last.value) * (0.5 * (last.place.u - before.position));
    let whole = (before.integral - after.integral) + (before.integral_rest - after.integral_rest);
    return (left + whole + right) / (last.place.u - first.place.u);
}

// Whether nothing within scalars [low, high] changes a picture.
fn is_vacant(low: f32, high: f32) -> bool {
    let cells = scene.tables.x;
    let c0 = min(u32(low * f32(cells)), cells - 1u);
    let c1 = min(u32(high * f32(cells)), cells - 1u);
    return table_cells[c0].occupied == table_cells[c1 + 1u].occupied;
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
