// The colours of debug views, from the darkest to the lightest. The composer defines the five ramps, HEAT_RAMP_0 to 4.

// The colour at x in [0, 1], linear RGB: five ramps, one after the other.
fn heat(x: f32) -> vec3<f32> {
    let u = 5.0 * x;
    return HEAT_RAMP_0 * clamp(u, 0.0, 1.0) + HEAT_RAMP_1 * clamp(u - 1.0, 0.0, 1.0)
        + HEAT_RAMP_2 * clamp(u - 2.0, 0.0, 1.0) + HEAT_RAMP_3 * clamp(u - 3.0, 0.0, 1.0)
        + HEAT_RAMP_4 * clamp(u - 4.0, 0.0, 1.0);
}
