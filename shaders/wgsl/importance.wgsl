// Averages of the importance over a segment, as tables.wgsl does for the optics.

@group(0) @binding(9) var<storage, read> importance_table: array<ImportanceEntry>;

// Parts of a step where all that lies in front may be erased within reach of it.
const RISE: f32 = 64.0;

struct Importance {
    mean: f32,
    // At the two ends, in the order of the ray.
    ends: vec2<f32>,
}

// The larger of the values at the two ends.
fn at_ends(importance: Importance) -> f32 {
    return max(importance.ends.x, importance.ends.y);
}

fn importance_at(u: f32, cell: u32) -> f32 {
    return mix(importance_table[cell].value, importance_table[cell + 1u].value, u - f32(cell));
}

fn importance_between(s0: f32, s1: f32) -> Importance {
    let entries = params.tables.y;
    let u0 = min(s0, s1) * f32(entries - 1u);
    let u1 = max(s0, s1) * f32(entries - 1u);
    let c0 = min(u32(u0), entries - 2u);
    let c1 = min(u32(u1), entries - 2u);
    let first = importance_at(u0, c0);
    let last = importance_at(u1, c1);
    let ends = select(vec2<f32>(first, last), vec2<f32>(last, first), s1 < s0);
    if c0 == c1 {
        return Importance(0.5 * (first + last), ends);
    }
    let left = (first + importance_table[c0 + 1u].value) * (0.5 * (f32(c0 + 1u) - u0));
    let right = (importance_table[c1].value + last) * (0.5 * (u1 - f32(c1)));
    let whole = (importance_table[c1].integral - importance_table[c0 + 1u].integral)
        + (importance_table[c1].integral_rest - importance_table[c0 + 1u].integral_rest);
    return Importance((left + whole + right) / (u1 - u0), ends);
}
