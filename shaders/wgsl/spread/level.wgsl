// Samples of coarse levels stand for the scalars within a standard deviation of them, of equal share each.

@group(0) @binding(BINDING_DEVIATIONS) var deviations: texture_3d<f32>;

// The standard deviation at t, interpolated in f32 from eight fetches.
fn spread_in(level: Level, t: f32) -> f32 {
    if level.deviation_scale == 0.0 {
        return 0.0;
    }
    let shifted = point_in(level, t) - 0.5;
    let base = floor(shifted);
    let f = shifted - base;
    let i = vec3<i32>(level.origin) + vec3<i32>(base);
    let low = vec4<f32>(deviation_of(i, 0, 0, 0), deviation_of(i, 0, 1, 0), deviation_of(i, 0, 0, 1),
        deviation_of(i, 0, 1, 1));
    let high = vec4<f32>(deviation_of(i, 1, 0, 0), deviation_of(i, 1, 1, 0), deviation_of(i, 1, 0, 1),
        deviation_of(i, 1, 1, 1));
    let along_x = low + (high - low) * f.x;
    let along_y = along_x.xz + (along_x.yw - along_x.xz) * f.y;
    return level.deviation_scale * (along_y.x + (along_y.y - along_y.x) * f.z);
}

fn deviation_of(base: vec3<i32>, x: i32, y: i32, z: i32) -> f32 {
    return textureLoad(deviations, base + vec3<i32>(x, y, z), 0).x;
}

// A segment between two scalars, each of which stands for those within `spread` of it. The mean over all of them is taken
// as that over an interval: of the same middle, and as wide as has the same variance.
fn sample_over(a: Located, b: Located, s0: f32, s1: f32, spread: f32) -> Sample {
    if spread > 0.0 {
        let along = 0.5 * (s1 - s0);
        return sample_of(optics_around(0.5 * (s0 + s1), sqrt(along * along + spread * spread)), a.place, b.place);
    }
    return sample_of(optics_between(a, b), a.place, b.place);
}

// Mean of (τ c, τ) over the scalars within `reach` of one; beyond [0, 1] they are what they are at its ends.
fn optics_around(middle: f32, reach: f32) -> vec4<f32> {
    let from_s = middle - reach;
    let to_s = middle + reach;
    let low = locate(max(from_s, 0.0));
    let high = locate(min(to_s, 1.0));
    let inside = optics_between(low, high);
    let below = max(-from_s, 0.0);
    let above = max(to_s - 1.0, 0.0);
    if below + above == 0.0 {
        return inside;
    }
    let outside = low.value * below + high.value * above;
    return (inside * (2.0 * reach - below - above) + outside) / (2.0 * reach);
}
