// Maximum Importance Difference Accumulation as published (LFD eq. 3): β = 1 − γ max(ι − ι_max, 0).

// β: what a rise of the largest importance from `largest` to `importance` keeps of what lies before it.
fn kept(largest: f32, importance: f32) -> f32 {
    return 1.0 - scene.mimda.x * max(importance - largest, 0.0);
}

// The equation is one of steps, and its picture depends on them: the parts of a step are composited among themselves
// first, and the equation is applied once.
const ONCE_PER_STEP: bool = true;

// A segment's light, premultiplied colour and opacity, behind what is in front.
fn composite(front: Accumulated, light: vec4<f32>, sample: Sample) -> Accumulated {
    let beta = kept(front.importance, sample.importance.mean);
    let through = 1.0 - beta * front.alpha;
    return Accumulated(front.rgb * beta + light.xyz * through, front.alpha * beta + light.w * through,
        max(front.importance, sample.importance.mean));
}

// Parts of each step of a pair, by what a rise of importance may have erased unseen: parts do not change the rise here.
fn parts_of_rise(front: Accumulated, reach: Sample) -> f32 {
    return 1.0;
}
