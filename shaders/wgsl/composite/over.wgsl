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

// Whether the parts of a step are composited among themselves first: it makes no difference here.
const ONCE_PER_STEP: bool = false;

// A segment's light, premultiplied colour and opacity, behind what is in front.
fn composite(front: Accumulated, light: vec4<f32>, sample: Sample) -> Accumulated {
    let through = 1.0 - front.alpha;
    return Accumulated(front.rgb + light.xyz * through, front.alpha + light.w * through);
}

// The opacity that what follows may still add.
fn still_to_come(front: Accumulated) -> f32 {
    return 1.0 - front.alpha;
}

// Parts of each step of a pair, by what a rise of importance may have erased unseen: there is none.
fn parts_of_rise(front: Accumulated, reach: Sample) -> f32 {
    return 1.0;
}
