// Averages of the transfer functions over a segment, from tables of f and F = ∫ f.

// A scalar's place in the tables, and the values there: looked up once, used for every mean that ends at it.
struct Located {
    // Position in cells, and the cell.
    u: f32,
    cell: u32,
    // (τ c, τ).
    value: vec4<f32>,
}

fn locate(s: f32) -> Located {
    let entries = scene.tables.x;
    let u = s * f32(entries - 1u);
    let cell = min(u32(u), entries - 2u);
    return Located(u, cell, mix(optics_table[cell].value, optics_table[cell + 1u].value, u - f32(cell)));
}

// Mean of (τ c, τ) between two scalars. Within one table cell f is linear, so the mean is that of the ends; over several
// cells the end pieces are trapezoids and only whole cells use the difference of integrals, kept as the sum of two
// floats: nothing cancels.
fn optics_between(a: Located, b: Located) -> vec4<f32> {
    if a.cell == b.cell {
        return 0.5 * (a.value + b.value);
    }
    var first = a;
    var last = b;
    if b.cell < a.cell {
        first = b;
        last = a;
    }
    let left = (first.value + optics_table[first.cell + 1u].value) * (0.5 * (f32(first.cell + 1u) - first.u));
    let right = (optics_table[last.cell].value + last.value) * (0.5 * (last.u - f32(last.cell)));
    let whole = (optics_table[last.cell].integral - optics_table[first.cell + 1u].integral)
        + (optics_table[last.cell].integral_rest - optics_table[first.cell + 1u].integral_rest);
    return (left + whole + right) / (last.u - first.u);
}

// Whether nothing within scalars [low, high] changes a picture.
fn is_vacant(low: f32, high: f32) -> bool {
    let entries = scene.tables.x;
    let c0 = min(u32(low * f32(entries - 1u)), entries - 2u);
    let c1 = min(u32(high * f32(entries - 1u)), entries - 2u);
    return occupied[c0] == occupied[c1 + 1u];
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
