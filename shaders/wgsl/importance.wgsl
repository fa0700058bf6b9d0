// Averages of the importance over a segment, as tables.wgsl does for the optics.

@group(0) @binding(9) var<storage, read> importance_table: array<ImportanceEntry>;

fn importance_at(u: f32, cell: u32) -> f32 {
    return mix(importance_table[cell].value, importance_table[cell + 1u].value, u - f32(cell));
}

fn importance_between(s0: f32, s1: f32) -> f32 {
    let entries = params.tables.y;
    let u0 = min(s0, s1) * f32(entries - 1u);
    let u1 = max(s0, s1) * f32(entries - 1u);
    let c0 = min(u32(u0), entries - 2u);
    let c1 = min(u32(u1), entries - 2u);
    if c0 == c1 {
        return importance_at(0.5 * (u0 + u1), c0);
    }
    let left = (importance_at(u0, c0) + importance_table[c0 + 1u].value) * (0.5 * (f32(c0 + 1u) - u0));
    let right = (importance_table[c1].value + importance_at(u1, c1)) * (0.5 * (u1 - f32(c1)));
    let whole = (importance_table[c1].integral - importance_table[c0 + 1u].integral)
        + (importance_table[c1].integral_rest - importance_table[c0 + 1u].integral_rest);
    return (left + whole + right) / (u1 - u0);
}
