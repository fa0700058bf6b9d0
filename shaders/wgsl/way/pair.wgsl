// A pair of steps of a bent ray, with a turn in its middle.

// Pairs over which the index changes by more than this, squared and per unit of the tolerance, are halved, as are those that
// turn a ray too coarsely, at most MOST_HALVINGS times, to a thousandth of a voxel. What the middle of a pair errs where the
// index changes along it falls with the square of that change.
const LARGE_CHANGE_SQUARED: f32 = 0.16;
const MOST_HALVINGS: u32 = 8u;
// Steps by which a surface on a pair is found: a bend of the scalar's profile leaves less than rounding after so many.
const SURFACE_STEPS: u32 = 8u;
// A surface is met this share of a step ahead at least, so that the way goes on.
const LEAST_STEP: f32 = 0.01;

// What a pair of steps led to.
struct Taken {
    // Whether nothing that follows can be seen.
    is_last: bool,
    // Whether the ray was turned.
    is_turned: bool,
}

const NOTHING: u32 = 0u;
const CHANGE: u32 = 1u;
const SURFACE_AHEAD: u32 = 2u;

// A pair straight on.
struct Laid {
    // Metres of each step.
    step: f32,
    // At its ends and in its middle.
    s0: f32,
    s1: f32,
    s2: f32,
    // What turns the ray in its middle, and the gradient of the scalar there.
    turn: u32,
    gradient: vec3<f32>,
    surface: Surface,
}

// Takes a pair of steps of at most `longest` metres each.
fn take_pair(walk: ptr<function, Walk>, node: NodeRecord, brick: Brick, longest: f32) -> Taken {
    let ray = (*walk).bent.ray;
    let t0 = (*walk).bent.t;
    let laid = lay(walk, brick, longest);
    let step = laid.step;
    var t1 = t0 + step;
    var s2 = laid.s2;
    let is_turned = laid.turn != NOTHING && turn(walk, laid);
    var next_brick = brick;
    if is_turned {
        next_brick = brick_of(node, (*walk).bent.ray);
        t1 = 0.0;
        s2 = scalar_at(next_brick, (*walk).bent.ray, step);
        (*walk).count += 1u;
    }
    let spreads = vec2<f32>(spread_at(brick, ray, t0 + 0.5 * step),
        spread_at(next_brick, (*walk).bent.ray, t1 + 0.5 * step));
    (*walk).is_known = true;
    (*walk).known = s2;
    (*walk).bent.t = t1 + step;
    (*walk).bent.way += 2.0 * step;
    let range = scalars_in_reach(laid.s0, laid.s1, s2);
    if is_vacant_around(range, max(spreads.x, spreads.y)) {
        return Taken(false, is_turned);
    }
    var front = (*walk).front;
    let next_ray = (*walk).bent.ray;
    let steps = PairOfSteps(ray, next_ray, vec2<f32>(t0, t1), step, vec3<f32>(laid.s0, laid.s1, s2), range);
    let pair = add_pair(&front, brick, next_brick, steps, spreads);
    var between = 0u;
    if pair.parts > 1.0 {
        between += add_parts(&front, brick, ray, pair.first, pair.parts);
        between += add_parts(&front, next_brick, next_ray, pair.second, pair.parts);
    }
    (*walk).front = front;
    (*walk).count += between;
    return Taken(still_to_come(front) < scene.quality.y, is_turned);
}

// Lays a pair straight on, halved while the index changes much between its ends, or its slope since the last turn; where a
// surface lies on it, its middle is there.
fn lay(walk: ptr<function, Walk>, brick: Brick, longest: f32) -> Laid {
    let bent = (*walk).bent;
    var laid: Laid;
    laid.step = longest;
    laid.s0 = (*walk).known;
    if !(*walk).is_known {
        laid.s0 = scalar_at(brick, bent.ray, bent.t);
    }
    var side = bent.side;
    if side == UNKNOWN_SIDE {
        side = side_of(laid.s0);
    }
    laid.s1 = scalar_at(brick, bent.ray, bent.t + longest);
    laid.s2 = scalar_at(brick, bent.ray, bent.t + 2.0 * longest);
    (*walk).count += 3u;
    let index = index_at(side, laid.s0);
    var force = vec3<f32>(0.0);
    for (var left = MOST_HALVINGS; ; left--) {
        let change = index_at(side, laid.s2) - index;
        if left == 0u || change * change <= LARGE_CHANGE_SQUARED * scene.quality.w {
            laid.turn = NOTHING;
            force = vec3<f32>(0.0);
            if bends(side, laid.s0, laid.s2) {
                laid.turn = CHANGE;
                laid.gradient = gradients_at(brick, bent.ray, bent.t + laid.step).at;
                force = laid.gradient * index_slope(side, laid.s0, laid.s2);
            }
            if left == 0u || is_smooth(bent, force, laid.step) {
                break;
            }
        }
        laid.step *= 0.5;
        laid.s2 = laid.s1;
        laid.s1 = scalar_at(brick, bent.ray, bent.t + laid.step);
        (*walk).count += 1u;
    }
    (*walk).bent.force = force;
    (*walk).bent.since = laid.step;
    (*walk).bent.side = side;
    let beyond = side_of(laid.s2);
    if beyond != side {
        laid.surface = surface_between(side, beyond);
        lay_over(walk, brick, &laid);
    }
    return laid;
}

// Moves the middle of a pair to where the ray meets its surface.
fn lay_over(walk: ptr<function, Walk>, brick: Brick, laid: ptr<function, Laid>) {
    let bent = (*walk).bent;
    let both = 2.0 * (*laid).step;
    var low = vec2<f32>(0.0, (*laid).s0 - (*laid).surface.at);
    var high = vec2<f32>(both, (*laid).s2 - (*laid).surface.at);
    var t = between(low, high);
    // Regula falsi; the far end counts half where it has stayed (Illinois).
    var stayed = 0u;
    for (var i = 0u; i < SURFACE_STEPS; i++) {
        let found = vec2<f32>(t, scalar_at(brick, bent.ray, bent.t + t) - (*laid).surface.at);
        if (found.y < 0.0) == (low.y < 0.0) {
            low = found;
            high.y *= select(1.0, 0.5, stayed == 1u);
            stayed = 1u;
        } else {
            high = found;
            low.y *= select(1.0, 0.5, stayed == 2u);
            stayed = 2u;
        }
        t = between(low, high);
    }
    // Where the surface lies behind the ray by now, it is met at once.
    let least = LEAST_STEP * (*laid).step;
    (*laid).step = select(least, t, t > least && t <= both);
    (*laid).turn = SURFACE_AHEAD;
    (*laid).gradient = gradients_at(brick, bent.ray, bent.t + (*laid).step).at;
    (*laid).s1 = scalar_at(brick, bent.ray, bent.t + (*laid).step);
    (*laid).s2 = scalar_at(brick, bent.ray, bent.t + 2.0 * (*laid).step);
    (*walk).count += SURFACE_STEPS + 2u;
}

// Where a line through two points is 0.
fn between(low: vec2<f32>, high: vec2<f32>) -> f32 {
    return low.x - low.y * (high.x - low.x) / (high.y - low.y);
}

// Turns the ray in the middle of a pair; whether it does not go straight on.
fn turn(walk: ptr<function, Walk>, laid: Laid) -> bool {
    var bent = (*walk).bent;
    var direction = bent.ray.direction_in_display;
    if laid.turn == SURFACE_AHEAD {
        direction = direction_through(&bent, laid.surface, laid.gradient);
    } else {
        direction = direction_beyond(&bent, laid.gradient, laid.s0, laid.s2, 2.0 * laid.step);
    }
    let is_turned = any(direction != bent.ray.direction_in_display);
    if is_turned {
        bent.ray = turned_at(bent.ray, bent.t + laid.step, direction);
        follow_chain(bent.ray);
    }
    (*walk).bent = bent;
    return is_turned;
}
