// What means err: how far they bend between columns, what hides between these, and how much the order of what a cell shows matters.

// What goes up between two scalars and comes down again, which their own values do not tell.
fn hidden_between(low: f32, high: f32) -> f32 {
    let borders = borders_of(low, high, 0.0);
    let rise = abs(variation[borders.high].value - variation[borders.low].value);
    return 0.5 * largest(variation[borders.high].each - variation[borders.low].each - rise);
}

// How much the order of what a column shows in a cell matters, as light.
fn disorder_in(s0: f32, s1: f32, spread: f32, thickness: f32) -> f32 {
    if min(s0, s1) < 0.0 {
        return 0.0;
    }
    let near = locate(s0);
    let far = locate(s1);
    let mean = sample_over(near, far, s0, s1, spread).k;
    let a = abs(near.value * mean.w - mean * near.value.w);
    let b = abs(mean * far.value.w - far.value * mean.w);
    let order = max(a.x, max(a.y, a.z)) + max(b.x, max(b.y, b.z));
    let depth = mean.w * thickness;
    return 0.125 * order * thickness * thickness / (1.0 + depth * depth);
}

// The same of a cell and the one behind it.
fn disorder_of_both(at: u32, behind: u32) -> f32 {
    let a = known_mean(at);
    let b = known_mean(behind);
    let order = abs(a.xyz * b.w - b.xyz * a.w);
    return max(order.x, max(order.y, order.z));
}

// No enhancer makes anything thicker.
fn factor_at(place: PlanePlace, column: u32) -> f32 {
    return 1.0;
}

// What the means between a column and the next err, whose corners have these scalars.
fn error_between(place: PlanePlace, column: u32, corners: vec4<f32>, spread: f32) -> f32 {
    let width = place.layer.width;
    let thickness = thickness_of(place.layer);
    let at = kept_at(place, column);
    // How far means bend.
    let mean = known_mean(at);
    let next = known_mean(at + 1u);
    var most = 0.0;
    if column > 0u {
        most = largest(abs(known_mean(at - 1u) - 2.0 * mean + next));
    }
    if column + 2u < width {
        most = max(most, largest(abs(mean - 2.0 * next + known_mean(at + 2u))));
    }
    most *= 0.125;
    // What neither of two columns shows.
    let hidden_low = min(max(corners.x, corners.z), max(corners.y, corners.w)) + spread;
    let hidden_high = max(min(corners.x, corners.z), min(corners.y, corners.w)) - spread;
    if hidden_high > hidden_low {
        most = max(most, thickness * hidden_between(hidden_low, hidden_high));
    }
    most = max(most, max(disorder_in(corners.x, corners.z, spread, thickness), disorder_in(corners.y, corners.w, spread, thickness)));
    if place.layer.has_cell_before != 0u {
        most = max(most, max(disorder_of_both(at - width, at), disorder_of_both(at + 1u - width, at + 1u)));
    }
    if has_cell_behind(place) {
        most = max(most, max(disorder_of_both(at, at + width), disorder_of_both(at + 1u, at + 1u + width)));
    }
    return most;
}
