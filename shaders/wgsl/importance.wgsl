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

fn importance_at(u: f32, cell: u32) -> f32 {
    return mix(importance_table[cell].value, importance_table[cell + 1u].value, u - f32(cell));
}

fn importance_between(s0: f32, s1: f32) -> Importance {
    let entries = scene.tables.y;
    let u0 = min(s0, s1) * f32(entries - 1u);
    let u1 = max(s0, s1) * f32(entries - 1u);
    let c0 = min(u32(u0), entries - 2u);
    let c1 = min(u32(u1), entries - 2u);
    let first = importance_at(u0, c0);
    let last = importance_at(u1, c1);
    let at_ends = max(first, last);
    if c0 == c1 {
        return Importance(0.5 * (first + last), at_ends);
    }
    // The nodes between are covered by two spans of a power of two.
    let row = firstLeadingBit(c1 - c0);
    let inside = max(importance_most[row * entries + c0 + 1u], importance_most[row * entries + c1 + 1u - (1u << row)]);
    let left = (first + importance_table[c0 + 1u].value) * (0.5 * (f32(c0 + 1u) - u0));
    let right = (importance_table[c1].value + last) * (0.5 * (u1 - f32(c1)));
    let whole = (importance_table[c1].integral - importance_table[c0 + 1u].integral)
        + (importance_table[c1].integral_rest - importance_table[c0 + 1u].integral_rest);
    // The mean is a rounded quotient.
    let most = max(at_ends, inside);
    return Importance(min((left + whole + right) / (u1 - u0), most), most);
}
