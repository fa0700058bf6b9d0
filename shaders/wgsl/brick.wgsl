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
            if plain.k.w > 0.0 && (SHADES || chain_looks(middle)) {
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

// A pair of steps, each to be cut into so many parts; with one part, they have been added.
struct CutPair {
    parts: f32,
    first: Step,
    second: Step,
}

// Adds a pair of steps that meets nothing but scalars within `range`, each step standing for a spread, unless it has to be cut: the first along one straight
// path, the second along another, which is the same where light is not bent.
fn add_pair(front: ptr<function, Accumulated>, brick: Brick, ray: Ray, t0: f32, next_brick: Brick, next_ray: Ray,
    t1: f32, step: f32, s0: f32, s1: f32, s2: f32, range: vec2<f32>, spreads: vec2<f32>) -> CutPair {
    let thickness = scene.quality.z * step;
    var pair = pair_of(s0, s1, s2, range, spreads);
    let middle = t0 + step;
    // Each step is seen by its own gradient: so the pair tells how much what is made of it varies.
    var near = NO_GRADIENTS;
    var far = NO_GRADIENTS;
    var gradients = NO_GRADIENTS;
    let enhancers_look = chain_looks(middle);
    if enhancers_look && max(pair.reach.k.w, pair.both.k.w) > 0.0 {
        near = gradients_at(brick, ray, t0 + 0.5 * step);
        far = gradients_at(next_brick, next_ray, t1 + 0.5 * step);
        gradients = gradients_halfway(near, far);
    }
    pair.first = enhance(pair.first, ray, t0 + 0.5 * step, step, s0, s1, near);
    pair.second = enhance(pair.second, next_ray, t1 + 0.5 * step, step, s1, s2, far);
    pair.both = enhance(pair.both, ray, middle, 2.0 * step, s0, s2, gradients);
    pair.reach = enhance(pair.reach, ray, middle, 2.0 * step, range.x, range.y, gradients);
    let visible = still_to_come(*front);
    let parts = max(parts_of_step(pair, thickness, visible), parts_of_rise(*front, pair.reach));
    if parts == 1.0 {
        // The light in the middle of the pair serves both steps, unless the gradient is known in the middle of each.
        if SHADES && !enhancers_look && max(pair.first.k.w, pair.second.k.w) > 0.0 {
            near = gradients_at(brick, ray, middle);
        }
        let material = material_of_pair(s0, s1, s2);
        let light = lighting(near, ray, material);
        var light_beyond = light;
        if enhancers_look {
            light_beyond = lighting(far, ray, material);
        }
        *front = add_whole(*front, pair.first, thickness, light, ray, t0 + 0.5 * step);
        *front = add_whole(*front, pair.second, thickness, light_beyond, next_ray, t1 + 0.5 * step);
    }
    return CutPair(parts, Step(pair.first, s0, s1, t0, step), Step(pair.second, s1, s2, t1, step));
}
