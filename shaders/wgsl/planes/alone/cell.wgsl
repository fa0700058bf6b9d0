// A pixel takes a cell through the rays' own code, straight from what is known at one of its ends to what is at the other.

// What a pixel meets at a depth.
struct PlaneEnd {
    scalar: f32,
    spread: f32,
    gradients: Gradients,
}

fn end_at(layer: PlaneLayer, at: u32, pixel: u32, z: f32) -> PlaneEnd {
    let met = meeting(layer, pixel, z);
    if !is_met(layer, met) {
        return PlaneEnd(UNKNOWN, 0.0, NO_GRADIENTS);
    }
    let a = at + u32(met.column);
    let b = a + 1u;
    let scalars = vec2<f32>(known_scalar(a), known_scalar(b));
    let scalar = select(UNKNOWN, mix(scalars.x, scalars.y, met.part), min(scalars.x, scalars.y) >= 0.0);
    return PlaneEnd(scalar, mix(known_spread(a), known_spread(b), met.part),
        gradients_between(known_gradients(a), known_gradients(b), met.part));
}

// The first columns of which a pixel meets anything.
fn columns_met(layer: PlaneLayer, pixel: u32) -> vec2<f32> {
    let front = meeting(layer, pixel, layer.z.x).column;
    let back = meeting(layer, pixel, layer.z.y).column;
    return vec2<f32>(min(front, back), max(front, back));
}

// Adds what lies on a span of the ray, in a cell whose columns are kept from `at` on. Whether they tell enough of it: the ray goes
// through for itself where the law of an enhancer is not smooth, and where a step would have to be cut.
fn add_cell(layer: PlaneLayer, at: u32, pixel: u32, ray: Ray, span: vec2<f32>, front: ptr<function, Accumulated>) -> bool {
    if next_break(span.x) < span.y {
        return false;
    }
    let near = end_at(layer, at, pixel, layer.z.x);
    let far = end_at(layer, at + layer.width, pixel, layer.z.y);
    if min(near.scalar, far.scalar) < 0.0 {
        return true;
    }
    // Of the way from one end to the other.
    let shares = (span * ray.direction_in_display.z - layer.z.x) / (layer.z.y - layer.z.x);
    let quarter = 0.25 * (shares.y - shares.x);
    let s0 = mix(near.scalar, far.scalar, shares.x);
    let s2 = mix(near.scalar, far.scalar, shares.y);
    let s1 = 0.5 * (s0 + s2);
    let range = vec2<f32>(min(s0, s2), max(s0, s2));
    let spreads = vec2<f32>(mix(near.spread, far.spread, shares.x + quarter), mix(near.spread, far.spread, shares.y - quarter));
    if is_vacant_around(range, max(spreads.x, spreads.y)) {
        return true;
    }
    let steps = PairOfSteps(ray, ray, vec2<f32>(span.x, 0.5 * (span.x + span.y)), 0.5 * (span.y - span.x), vec3<f32>(s0, s1, s2), range);
    var gradients = PairGradients(NO_GRADIENTS, NO_GRADIENTS);
    let enhancers_look = chain_looks(steps.t.y);
    if enhancers_look {
        gradients = PairGradients(gradients_between(near.gradients, far.gradients, shares.x + quarter),
            gradients_between(near.gradients, far.gradients, shares.y - quarter));
    }
    let pair = enhanced(pair_of(s0, s1, s2, range, spreads), steps, gradients);
    if parts_of_pair(*front, pair, steps.length) > 1.0 {
        return false;
    }
    if SHADES && !enhancers_look {
        gradients.near = gradients_between(near.gradients, far.gradients, 0.5 * (shares.x + shares.y));
    }
    add_both(front, pair, steps, gradients);
    return true;
}
