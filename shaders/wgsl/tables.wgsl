// Averages of the transfer functions over a segment, from tables of f and F = ∫ f.

fn optics_at(u: f32, cell: u32) -> vec4<f32> {
    return mix(optics_table[cell].value, optics_table[cell + 1u].value, u - f32(cell));
}

// Mean of (τ c, τ) over scalars [s0, s1]. Within one table cell f is linear, so the mean is the value in the middle;
// over several cells the end pieces are trapezoids and only whole cells use the difference of integrals, kept as the
// sum of two floats: nothing cancels.
fn optics_between(s0: f32, s1: f32) -> vec4<f32> {
    let entries = params.tables.x;
    let u0 = min(s0, s1) * f32(entries - 1u);
    let u1 = max(s0, s1) * f32(entries - 1u);
    let c0 = min(u32(u0), entries - 2u);
    let c1 = min(u32(u1), entries - 2u);
    if c0 == c1 {
        return optics_at(0.5 * (u0 + u1), c0);
    }
    let left = (optics_at(u0, c0) + optics_table[c0 + 1u].value) * (0.5 * (f32(c0 + 1u) - u0));
    let right = (optics_table[c1].value + optics_at(u1, c1)) * (0.5 * (u1 - f32(c1)));
    let whole = (optics_table[c1].integral - optics_table[c0 + 1u].integral)
        + (optics_table[c1].integral_rest - optics_table[c0 + 1u].integral_rest);
    return (left + whole + right) / (u1 - u0);
}

// φ(x) = (1 − e^−x) / x; a series where the difference would cancel.
fn attenuation_mean(x: f32) -> f32 {
    if x < 0.25 {
        return 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0 - x * (1.0 / 720.0)))));
    }
    return (1.0 - exp(-x)) / x;
}
