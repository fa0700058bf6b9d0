// A band of scalars: a trapezoid with the corners x, y, z, w.

fn band_at(corners: vec4<f32>, s: f32) -> f32 {
    if s < corners.x || s > corners.w {
        return 0.0;
    }
    if s < corners.y {
        return (s - corners.x) / (corners.y - corners.x);
    }
    if s <= corners.z {
        return 1.0;
    }
    return (corners.w - s) / (corners.w - corners.z);
}

// Its mean between two scalars, flank by flank: nothing cancels.
fn band_between(corners: vec4<f32>, s0: f32, s1: f32) -> f32 {
    let low = min(s0, s1);
    let high = max(s0, s1);
    if high <= low {
        return band_at(corners, s0);
    }
    var sum = clamp(high, corners.y, corners.z) - clamp(low, corners.y, corners.z);
    if corners.y > corners.x {
        let from_s = clamp(low, corners.x, corners.y);
        let to_s = clamp(high, corners.x, corners.y);
        sum += (to_s - from_s) * (0.5 * (from_s + to_s) - corners.x) / (corners.y - corners.x);
    }
    if corners.w > corners.z {
        let from_s = clamp(low, corners.z, corners.w);
        let to_s = clamp(high, corners.z, corners.w);
        sum += (to_s - from_s) * (corners.w - 0.5 * (from_s + to_s)) / (corners.w - corners.z);
    }
    return min(sum / (high - low), 1.0);
}
