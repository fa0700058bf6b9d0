// Maximum Importance Difference Accumulation as published (LFD eq. 3): β = 1 − γ max(ι − ι_max, 0).

struct Accumulated {
    rgb: vec3<f32>,
    alpha: f32,
    importance: f32,
}

fn nothing_accumulated() -> Accumulated {
    return Accumulated(vec3<f32>(0.0), 0.0, 0.0);
}

// Importance acts whatever the extinction: no segment is clear.
fn is_clear(extinction: f32) -> bool {
    return false;
}

// β: what a rise of the largest importance from `largest` to `importance` keeps of what lies before it.
fn kept(largest: f32, importance: f32) -> f32 {
    return 1.0 - params.mimda.x * max(importance - largest, 0.0);
}

// The equation is one of steps, and its picture depends on them: the parts of a step are composited among themselves
// first, and the equation is applied once.
const ONCE_PER_STEP: bool = true;

// A segment's light, premultiplied colour and opacity, over scalars [s0, s1], behind what is in front.
fn composite(front: Accumulated, light: vec4<f32>, s0: f32, s1: f32) -> Accumulated {
    let importance = importance_between(s0, s1).mean;
    let beta = kept(front.importance, importance);
    let through = 1.0 - beta * front.alpha;
    return Accumulated(front.rgb * beta + light.xyz * through, front.alpha * beta + light.w * through,
        max(front.importance, importance));
}

// The opacity that what follows may still add, when the largest importance is yet to come.
fn still_to_come(front: Accumulated) -> f32 {
    return 1.0 - (1.0 - params.mimda.x * max(params.mimda.y - front.importance, 0.0)) * front.alpha;
}

// Parts of each step of a pair, by what a rise of importance may have erased unseen: parts do not change the rise here.
fn parts_of_rise(front: Accumulated, range: vec2<f32>) -> f32 {
    return 1.0;
}
