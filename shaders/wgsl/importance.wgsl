// Averages of the importance over a segment, as tables.wgsl does for the optics.

@group(0) @binding(BINDING_IMPORTANCE) var<storage, read> importance_table: array<ImportanceEntry>;
// Row j holds at i the largest importance of the 2^j nodes from node i on.
@group(0) @binding(BINDING_IMPORTANCE_MOST) var<storage, read> importance_most: array<f32>;

// Parts of a step, times the error allowed per step, where all that lies in front may be erased within reach of it.
const RISE: f32 = 0.0064;

struct Importance {
    mean: f32,
    // The largest.
    most: f32,
}

fn importance_at(place: TablePlace) -> f32 {
    return mix(importance_table[place.node].value, importance_table[place.node + 1u].value, place.part);
}

fn importance_between(a: TablePlace, b: TablePlace) -> Importance {
    var from_place = a;
    var to_place = b;
    if b.node < a.node {
        from_place = b;
        to_place = a;
    }
    let first = importance_at(from_place);
    let last = importance_at(to_place);
    let at_ends = max(first, last);
    if from_place.node == to_place.node {
        return Importance(0.5 * (first + last), at_ends);
    }
    let after = from_place.node + 1u;
    let before = to_place.node;
    // The nodes between are covered by two spans of a power of two; a row of spans has as many entries as there are nodes.
    let span = firstLeadingBit(to_place.node - from_place.node);
    let row = span * (table_cells[scene.tables.x].first + 1u);
    let inside = max(importance_most[row + after], importance_most[row + before + 1u - (1u << span)]);
    let left = (first + importance_table[after].value) * (0.5 * (from_place.high - from_place.u));
    let right = (importance_table[before].value + last) * (0.5 * (to_place.u - to_place.low));
    let whole = (importance_table[before].integral - importance_table[after].integral)
        + (importance_table[before].integral_rest - importance_table[after].integral_rest);
    // The mean is a rounded quotient.
    let most = max(at_ends, inside);
    return Importance(min((left + whole + right) / (to_place.u - from_place.u), most), most);
}
