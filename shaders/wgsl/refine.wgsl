// How many parts a step is cut into, by what a pair of steps tells of its own error.

// A step is cut into this many parts at most.
const MOST_PARTS: f32 = 16.0;

// `first` and `second` are the means of (τ c, τ) over two steps of `thickness` each, `both` the mean over the two taken
// as one segment, `visible` the opacity that may still be added. Where the scalar is not linear along the two steps,
// `both` differs from the mean of the two; where colours differ, taking the light of one step as if it came from
// anywhere in it errs by up to the product of both depths. The first error falls with the square of the parts.
fn parts_of_step(first: vec4<f32>, second: vec4<f32>, both: vec4<f32>, thickness: f32, visible: f32) -> f32 {
    let depth = (first.w + second.w) * thickness;
    let bend = abs(first + second - 2.0 * both) * (thickness / (1.0 + depth));
    let order = abs(first.xyz * second.w - second.xyz * first.w) * (thickness * thickness / (1.0 + depth * depth));
    let worst = max(max(max(bend.x, bend.y), max(bend.z, bend.w)), max(order.x, max(order.y, order.z)));
    return clamp(ceil(sqrt(worst * visible / params.quality.w)), 1.0, MOST_PARTS);
}
