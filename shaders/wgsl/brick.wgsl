// A ray's way through one brick: light and steps.

// Whether anything shows within a voxel of the cell around a point.
fn is_visible_at(brick: Brick, point: vec3<f32>) -> bool {
    let at = vec3<u32>(point * (1.0 / CELL_EDGE)) & vec3<u32>(CELLS_ACROSS - 1u);
    let cell = (at.z * CELLS_ACROSS + at.y) * CELLS_ACROSS + at.x;
    return ((cells[brick.words + (cell >> 5u)] >> (cell & 31u)) & 1u) != 0u;
}

// Pairs of steps of `length` metres until the middle of one lies beyond the cell around `middle`; at least 1.
fn pairs_across(brick: Brick, middle: vec3<f32>, length: f32) -> f32 {
    let low = floor(middle * (1.0 / CELL_EDGE)) * CELL_EDGE;
    let face = select(low, low + CELL_EDGE, brick.own.slope >= vec3<f32>(0.0));
    let way = abs(face - middle) * brick.pace;
    return clamp(ceil(min(way.x, min(way.y, way.z)) / length), 1.0, 1e6);
}

// A step of a voxel is no longer than this much more.
const ROUNDED_VOXELS: f32 = 1e-3;

// Pairs from `t` on that show nothing, where the first has steps of `length` metres; 0 if it may show something. A cell
// is kept with a margin of one voxel, and as many points of a pair are asked as leave none of it farther than a voxel, but for
// rounding.
fn pairs_unseen(brick: Brick, t: f32, length: f32) -> f32 {
    let slope = abs(brick.own.slope);
    let points = max(1.0, ceil(length * max(slope.x, max(slope.y, slope.z)) - ROUNDED_VOXELS));
    let each = 2.0 * length / points;
    let first = point_in(brick.own, t + 0.5 * each);
    if is_visible_at(brick, first) {
        return 0.0;
    }
    var unseen = pairs_across(brick, first, 2.0 * length);
    for (var j = 1.5; j < points; j += 1.0) {
        let point = point_in(brick.own, t + each * j);
        if is_visible_at(brick, point) {
            return 0.0;
        }
        unseen = min(unseen, pairs_across(brick, point, 2.0 * length));
    }
    return unseen;
}

// What light makes of a colour: τ c · body + τ · highlight.
struct Lighting {
    body: f32,
    highlight: f32,
}

// The light on a segment at t, where there is extinction to be lit.
fn light_on(sample: Sample, gradients: Gradients, ray: Ray, s0: f32, s1: f32) -> Lighting {
    if sample.k.w > 0.0 {
        return lighting(gradients, ray, material_between(s0, s1));
    }
    return Lighting(1.0, 0.0);
}

// Light of a segment, composited alone: premultiplied colour and opacity. `thickness` is metres times the extinction per
// metre where the table says 1.
fn segment_light(sample: Sample, thickness: f32, light: Lighting) -> vec4<f32> {
    let depth = sample.k.w * thickness;
    let mean = attenuation_mean(depth);
    let body = 1.0 - sample.lit + sample.lit * light.body;
    let lit = sample.k.xyz * body + vec3<f32>(sample.k.w * (sample.lit * light.highlight));
    return vec4<f32>(lit * (thickness * mean * sample.brightness), depth * mean);
}

// Adds one step with its middle at t, lit as given.
fn add_whole(front: Accumulated, sample: Sample, thickness: f32, light: Lighting, ray: Ray, t: f32) -> Accumulated {
    if is_clear(sample.k.w) {
        return front;
    }
    return composite(front, debug_light(segment_light(sample, thickness, light), ray, t), sample);
}

// One step along a ray.
struct Step {
    // All of it as one segment.
    whole: Sample,
    s0: f32,
    s1: f32,
    // Where it begins, and its length, metres.
    t0: f32,
    length: f32,
    // Whether enhancers look at its gradient.
    enhancers_look: bool,
}

// Adds a step in equal parts, as many of them as can be seen. Yields the number of samples taken between its ends.
fn add_parts(accumulated: ptr<function, Accumulated>, brick: Brick, ray: Ray, step: Step, parts: f32) -> u32 {
    let part = step.length / parts;
    var front = *accumulated;
    // What the parts show among themselves.
    var alone = vec4<f32>(0.0);
    var samples = 0u;
    var from_s = step.s0;
    var from_located = locate(from_s);
    var goes_on = true;
    for (var j = 1.0; goes_on; j += 1.0) {
        goes_on = j < parts;
        let t = step.t0 + j * part;
        var to_s = step.s1;
        if goes_on {
            to_s = scalar_at(brick, ray, t);
            samples += 1u;
        }
        let to_located = locate(to_s);
        let middle = t - 0.5 * part;
        let plain = sample_over(from_located, to_located, from_s, to_s, spread_at(brick, ray, middle));
        if !is_clear(plain.k.w) {
            var gradients = NO_GRADIENTS;
            if plain.k.w > 0.0 && (SHADES || step.enhancers_look) {
                gradients = gradients_at(brick, ray, middle);
            }
            let sample = enhance(plain, ray, middle, part, from_s, to_s, gradients);
            let lit = light_on(sample, gradients, ray, from_s, to_s);
            let light = debug_light(segment_light(sample, scene.quality.z * part, lit), ray, middle);
            if ONCE_PER_STEP {
                alone += light * (1.0 - alone.w);
            } else {
                front = composite(front, light, sample);
                goes_on &= still_to_come(front) >= scene.quality.y;
            }
        }
        from_s = to_s;
        from_located = to_located;
    }
    if ONCE_PER_STEP {
        front = composite(front, alone, step.whole);
    }
    *accumulated = front;
    return samples;
}

// A pair of steps, each along a straight path of its own, which is the same where light is not bent.
struct PairOfSteps {
    first: Ray,
    second: Ray,
    // Where each begins, and the length of both, metres.
    t: vec2<f32>,
    length: f32,
    // The scalars before, between and behind them, and all that the pair may meet.
    s: vec3<f32>,
    range: vec2<f32>,
}

// The gradients in the middle of both steps, where enhancers look at them.
struct PairGradients {
    near: Gradients,
    far: Gradients,
}

// What enhancers make of a pair: each step is seen by its own gradient, so the pair tells how much what is made of it varies.
fn enhanced(plain: Pair, steps: PairOfSteps, gradients: PairGradients) -> Pair {
    let half = 0.5 * steps.length;
    let middle = steps.t.x + steps.length;
    let halfway = gradients_halfway(gradients.near, gradients.far);
    let s = steps.s;
    var pair = plain;
    pair.first = enhance(plain.first, steps.first, steps.t.x + half, steps.length, s.x, s.y, gradients.near);
    pair.second = enhance(plain.second, steps.second, steps.t.y + half, steps.length, s.y, s.z, gradients.far);
    pair.both = enhance(plain.both, steps.first, middle, 2.0 * steps.length, s.x, s.z, halfway);
    pair.reach = enhance(plain.reach, steps.first, middle, 2.0 * steps.length, steps.range.x, steps.range.y, halfway);
    return pair;
}

// Parts that each step of a pair has to be cut into, where a step is `length` metres long.
fn parts_of_pair(front: Accumulated, pair: Pair, length: f32) -> f32 {
    let parts = parts_of_step(pair, scene.quality.z * length, still_to_come(front));
    return max(parts, parts_of_rise(front, pair.reach));
}

// Adds both steps of a pair as they are. Unless enhancers look at the gradient in the middle of each, that in the middle of the
// pair, `near`, serves both.
fn add_both(front: ptr<function, Accumulated>, pair: Pair, steps: PairOfSteps, gradients: PairGradients) {
    let half = 0.5 * steps.length;
    let thickness = scene.quality.z * steps.length;
    let material = material_of_pair(steps.s.x, steps.s.y, steps.s.z);
    let light = lighting(gradients.near, steps.first, material);
    var light_beyond = light;
    if chain_looks(steps.t.y) {
        light_beyond = lighting(gradients.far, steps.first, material);
    }
    *front = add_whole(*front, pair.first, thickness, light, steps.first, steps.t.x + half);
    *front = add_whole(*front, pair.second, thickness, light_beyond, steps.second, steps.t.y + half);
}

// A pair of steps, each to be cut into so many parts; with one part, they have been added.
struct CutPair {
    parts: f32,
    first: Step,
    second: Step,
}

// Adds a pair of steps, the first through one brick, the second through another or the same, each standing for a spread, unless it
// has to be cut.
fn add_pair(front: ptr<function, Accumulated>, brick: Brick, next_brick: Brick, steps: PairOfSteps, spreads: vec2<f32>) -> CutPair {
    let s = steps.s;
    var pair = pair_of(s.x, s.y, s.z, steps.range, spreads);
    let middle = steps.t.x + steps.length;
    var gradients = PairGradients(NO_GRADIENTS, NO_GRADIENTS);
    // Breaks are known of the way that the second takes.
    let enhancers_look = chain_looks(steps.t.y);
    if enhancers_look && max(pair.reach.k.w, pair.both.k.w) > 0.0 {
        gradients.near = gradients_at(brick, steps.first, steps.t.x + 0.5 * steps.length);
        gradients.far = gradients_at(next_brick, steps.second, steps.t.y + 0.5 * steps.length);
    }
    pair = enhanced(pair, steps, gradients);
    let parts = parts_of_pair(*front, pair, steps.length);
    if parts == 1.0 {
        if SHADES && !enhancers_look && max(pair.first.k.w, pair.second.k.w) > 0.0 {
            gradients.near = gradients_at(brick, steps.first, middle);
        }
        add_both(front, pair, steps, gradients);
    }
    return CutPair(parts, Step(pair.first, s.x, s.y, steps.t.x, steps.length, enhancers_look),
        Step(pair.second, s.y, s.z, steps.t.y, steps.length, enhancers_look));
}
