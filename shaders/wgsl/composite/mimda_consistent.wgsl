// Maximum Importance Difference Accumulation in the form that telescopes: β = (1 − γ ι) / (1 − γ ι_max).

// β: what a rise of the largest importance from `largest` to `importance` keeps of what lies before it.
fn kept(largest: f32, importance: f32) -> f32 {
    let before = 1.0 - scene.mimda.x * largest;
    if importance <= largest || before <= 0.0 {
        return 1.0;
    }
    return (1.0 - scene.mimda.x * importance) / before;
}

// Whether the parts of a step are composited among themselves first: the product of their β telescopes as they are.
const ONCE_PER_STEP: bool = false;

// A segment's light, premultiplied colour and opacity, behind what is in front.
// The rise up to the segment's mean importance lies before its light, the rest of the rise after it.
fn composite(front: Accumulated, light: vec4<f32>, sample: Sample) -> Accumulated {
    let middle = max(front.importance, sample.importance.mean);
    let end = max(middle, sample.importance.most);
    let beta = kept(front.importance, middle);
    let rest = kept(middle, end);
    let through = 1.0 - beta * front.alpha;
    return Accumulated((front.rgb * beta + light.xyz * through) * rest, (front.alpha * beta + light.w * through) * rest, end);
}

// Parts of each step of a pair, by what a rise of importance within reach may have erased unseen. Its error falls with
// the parts, not with their square.
fn parts_of_rise(front: Accumulated, reach: Sample) -> f32 {
    let unseen = (1.0 - kept(front.importance, reach.importance.most)) * front.alpha * (RISE / scene.quality.w);
    return clamp(ceil(unseen), 1.0, MOST_PARTS);
}
