// Ordinary front-to-back compositing.

struct Accumulated {
    rgb: vec3<f32>,
    alpha: f32,
}

fn nothing_accumulated() -> Accumulated {
    return Accumulated(vec3<f32>(0.0), 0.0);
}

// Whether a segment without extinction changes nothing.
fn is_clear(extinction: f32) -> bool {
    return extinction <= 0.0;
}

fn composite(front: Accumulated, rgb: vec3<f32>, alpha: f32, s0: f32, s1: f32) -> Accumulated {
    let through = 1.0 - front.alpha;
    return Accumulated(front.rgb + rgb * through, front.alpha + alpha * through);
}

// The opacity that what follows may still add.
fn still_to_come(front: Accumulated) -> f32 {
    return 1.0 - front.alpha;
}
