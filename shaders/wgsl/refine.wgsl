// How many parts a step is split into, from what a pair of steps estimates of its own error.

// A step is split into this many parts at most.
const MOST_PARTS: f32 = 16.0;
// The same for a pair whose parts are opaque: light comes from the first few of them.
const MOST_DEEP_PARTS: f32 = 1024.0;
// Steps grow to this many voxels at most; see `looseness`.
const LONGEST_STEP: f32 = 1.0;
// A tolerance as tight as this, or tighter, has steps grow no further.
const TIGHT: f32 = 1e-4;
// Others have them grow so many times as far, at most.
const MOST_LOOSE: f32 = 4.0;
// Share of what lies within reach of a pair, but not between its ends, that may have been passed by unseen.
const UNSEEN: f32 = 0.25;

// How many times as far steps may grow as at a tight tolerance: what hides between samples grows with the square of how far apart
// they are.
fn looseness() -> f32 {
    return clamp(sqrt(scene.quality.w * (1.0 / TIGHT)), 1.0, MOST_LOOSE);
}

// The longest step, in voxels of the node: `shortest` where much may hide between two samples, more where the largest
// optical depth of a voxel, `depth`, keeps what may hide small. Steps of one length (no tolerance) do not grow.
fn step_voxels(depth: f32) -> f32 {
    let shortest = scene.quality.x;
    let loose = looseness();
    let safe = SAFE_DEPTH * loose;
    if scene.quality.w >= 1.0 || depth * shortest >= safe {
        return shortest;
    }
    return min(safe / max(depth, 1e-30), max(shortest, LONGEST_STEP * loose));
}

// A voxel of a node, as a ray meets it.
struct Voxel {
    // Metres along the ray.
    edge: f32,
    // The largest extinction that the node may show, per metre.
    most_extinction: f32,
}

fn voxel_of(node: NodeRecord, ray: Ray) -> Voxel {
    return Voxel(voxel_edge(node.depth) / ray.speed, node.most_extinction * scene.quality.z);
}

// The longest step from t on, in metres. Where samples are of more than one level, voxels of the fractional level count: so
// steps are as long as a coarser neighbour's on the border to it (LOD section 5).
fn longest_step(voxel: Voxel, brick: Brick, ray: Ray, t: f32) -> f32 {
    var edge = voxel.edge;
    if has_fractions(brick) {
        edge *= exp2(fraction_at(brick, ray, t));
    }
    return step_voxels(voxel.most_extinction * edge) * edge;
}

// What a pair of steps shows.
struct Pair {
    first: Sample,
    second: Sample,
    // Both steps, taken as one segment.
    both: Sample,
    // All scalars within reach.
    reach: Sample,
}

fn largest(v: vec4<f32>) -> f32 {
    return max(max(v.x, v.y), max(v.z, v.w));
}

fn pair_of(s0: f32, s1: f32, s2: f32, reach: vec2<f32>, spreads: vec2<f32>) -> Pair {
    let l0 = locate(s0);
    let l1 = locate(s1);
    let l2 = locate(s2);
    return Pair(sample_over(l0, l1, s0, s1, spreads.x), sample_over(l1, l2, s1, s2, spreads.y),
        sample_over(l0, l2, s0, s2, 0.5 * (spreads.x + spreads.y)),
        sample_over(locate(reach.x), locate(reach.y), reach.x, reach.y, max(spreads.x, spreads.y)));
}

// (τ c, τ) of a sample with its brightness, as no light falls on it.
fn emitted(sample: Sample) -> vec4<f32> {
    return vec4<f32>(sample.k.xyz * sample.brightness, sample.k.w);
}

// Parts of each step of a pair, where a step has `thickness` and `visible` is the opacity that may still be added.
// Three things cause errors. Where the scalar bends, `both` differs from the mean of the two steps, and something between
// the samples may have been missed. Where colours differ, light taken as if it came from anywhere in a step is off by up
// to the product of both depths; so is whatever varies with the place. The first falls with the square of the parts.
// Where a part is opaque, it shows the colours of all its length in place of those in front: that falls with the parts
// alone, until they are no deeper than one.
fn parts_of_step(pair: Pair, thickness: f32, visible: f32) -> f32 {
    let first = emitted(pair.first);
    let second = emitted(pair.second);
    let both = emitted(pair.both);
    let depth = (first.w + second.w) * thickness;
    let order_scale = thickness * thickness / (1.0 + depth * depth);
    let bend = max(abs(first + second - 2.0 * both), abs(emitted(pair.reach) - both) * UNSEEN);
    let order = abs(first.xyz * second.w - second.xyz * first.w) * order_scale;
    let uneven = first.w * second.w * order_scale * SHADE_SPREAD;
    let worst = max(largest(bend) * (thickness / (1.0 + depth)), largest(vec4<f32>(order, uneven)));
    let errors = worst * visible / scene.quality.w;
    let parts = clamp(ceil(sqrt(errors)), 1.0, MOST_PARTS);
    if depth <= parts {
        return parts;
    }
    return max(min(ceil(min(2.0 * errors, depth)), MOST_DEEP_PARTS), parts);
}

// The scalars that a pair of steps may have met between its samples: the samples' own range, widened by half the larger
// step at both ends, as far as a kink of the trilinear field between two samples goes.
fn scalars_in_reach(s0: f32, s1: f32, s2: f32) -> vec2<f32> {
    let margin = 0.5 * max(abs(s1 - s0), abs(s2 - s1));
    let low = min(min(s0, s1), s2);
    let high = max(max(s0, s1), s2);
    return vec2<f32>(max(low - margin, 0.0), min(high + margin, 1.0));
}
