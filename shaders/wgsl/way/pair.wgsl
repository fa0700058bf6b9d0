// A pair of steps of a bent ray, with a turn in its middle, or at its end where it meets a surface.

// Pairs over which the index changes by more than this, squared and per unit of the tolerance, are halved, as are those that
// turn a ray too coarsely, at most MOST_HALVINGS times, to a thousandth of a voxel. What the middle of a pair errs where the
// index changes along it falls with the square of that change.
const LARGE_CHANGE_SQUARED: f32 = 0.16;
const MOST_HALVINGS: u32 = 8u;
// So often pairs are halved on which a ray may turn back just before a surface or just behind it: those on which the scalar
// rises by less than this many times the bend of its profile.
const GRAZING_HALVINGS: u32 = 3u;
const TURNING_BEND: f32 = 4.0;
// A ray meets a surface that it only dips into this many steps ahead at least.
const NEAREST_DIP: f32 = 0.05;
// Steps by which a surface on a pair is found: a bend of the scalar's profile leaves less than rounding after so many.
const SURFACE_STEPS: u32 = 8u;
// A surface is met this share of the longest step ahead at least, and twice as far each time that it is again, so that the way
// goes on: 128 times that is a little more than a step.
const LEAST_STEP: f32 = 0.01;
const MOST_AT_ONCE: u32 = 7u;

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
    // What turns the ray, in its middle or at a surface in its end, and the gradient of the scalar there.
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
    var is_turned = laid.turn == CHANGE && turn_in_middle(walk, laid);
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
    var is_last = false;
    if !is_vacant_around(range, max(spreads.x, spreads.y)) {
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
        is_last = still_to_come(front) < scene.quality.y;
    }
    if laid.turn == SURFACE_AHEAD {
        var bent = (*walk).bent;
        let direction = direction_through(&bent, laid.surface, laid.gradient);
        (*walk).bent = bent;
        is_turned = turn(walk, bent.t, direction);
    }
    return Taken(is_last, is_turned);
}

// Lays a pair straight on, halved while the index changes much between its ends, or its slope since the last turn; where a
// surface lies on it, its end is there.
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
        let is_close = left + GRAZING_HALVINGS > MOST_HALVINGS && side_of(laid.s2) == side && grazes(side, laid);
        if left == 0u || (change * change <= LARGE_CHANGE_SQUARED * scene.quality.w && !is_close) {
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
    var beyond = side_of(laid.s2);
    let dip = select(0.0, dip_of(side, laid), beyond == side);
    if dip > 0.0 {
        let there = scalar_at(brick, bent.ray, bent.t + dip * laid.step);
        (*walk).count += 1u;
        beyond = side_of(there);
        if beyond != side {
            laid.step *= 0.5 * dip;
            laid.s2 = there;
        }
    }
    if beyond != side {
        laid.surface = surface_between(side, beyond);
        lay_over(walk, brick, &laid, longest);
    }
    return laid;
}

fn is_off(side: u32, s: f32) -> bool {
    return side_of(clamp(s, 0.0, 1.0)) != side;
}

fn bend_of(laid: Laid) -> f32 {
    return laid.s2 - (laid.s1 + laid.s1) + laid.s0;
}

// Whether a ray, whose pair has its ends on a side, seems to turn back before a jump that is no farther than the scalar goes
// on the pair.
fn grazes(side: u32, laid: Laid) -> bool {
    let low = min(min(laid.s0, laid.s1), laid.s2);
    let high = max(max(laid.s0, laid.s1), laid.s2);
    let reach = high - low;
    return abs(laid.s2 - laid.s0) < TURNING_BEND * abs(bend_of(laid))
        && (is_off(side, low - reach) || is_off(side, high + reach));
}

// Where it may be beyond one, steps from the start; 0 where it is nowhere.
fn dip_of(side: u32, laid: Laid) -> f32 {
    if is_off(side, laid.s1) {
        return 1.0;
    }
    let rise = laid.s2 - laid.s0;
    let bend = bend_of(laid);
    let at = 1.0 - 0.5 * rise / bend;
    // Where a parabola through the three turns back, and as far again.
    let turns_back = laid.s1 - 0.25 * rise * rise / bend;
    return select(0.0, at, at > NEAREST_DIP && at < 2.0 && is_off(side, turns_back));
}

// Moves the end of a pair to where the ray meets its surface.
fn lay_over(walk: ptr<function, Walk>, brick: Brick, laid: ptr<function, Laid>, longest: f32) {
    let bent = (*walk).bent;
    let both = 2.0 * (*laid).step;
    var low = vec2<f32>(0.0, (*laid).s0 - (*laid).surface.at);
    var high = vec2<f32>(both, (*laid).s2 - (*laid).surface.at);
    // A ray that has just passed a surface may see its scalar behind it yet.
    if (low.y < 0.0) == (high.y < 0.0) {
        low.y = -high.y;
    }
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
    // Where the surface lies behind the ray by now, or just ahead, it is met at once; light that does so again and again goes
    // farther each time, so that its way goes on.
    let least = LEAST_STEP * longest * f32(1u << bent.met_at_once);
    let is_ahead = t > least && t <= both;
    (*walk).bent.met_at_once = select(min(bent.met_at_once + 1u, MOST_AT_ONCE), 0u, is_ahead);
    t = select(least, t, is_ahead);
    (*laid).step = 0.5 * t;
    (*laid).turn = SURFACE_AHEAD;
    (*laid).gradient = gradients_at(brick, bent.ray, bent.t + t).at;
    (*laid).s1 = scalar_at(brick, bent.ray, bent.t + (*laid).step);
    (*laid).s2 = scalar_at(brick, bent.ray, bent.t + t);
    (*walk).count += SURFACE_STEPS + 2u;
}

// Where a line through two points is 0.
fn between(low: vec2<f32>, high: vec2<f32>) -> f32 {
    return low.x - low.y * (high.x - low.x) / (high.y - low.y);
}

// Turns the ray in the middle of a pair; whether it does not go straight on.
fn turn_in_middle(walk: ptr<function, Walk>, laid: Laid) -> bool {
    var bent = (*walk).bent;
    let direction = direction_beyond(&bent, laid.gradient, laid.s0, laid.s2, 2.0 * laid.step);
    (*walk).bent = bent;
    return turn(walk, bent.t + laid.step, direction);
}

// Turns the ray at t; whether it does not go straight on.
fn turn(walk: ptr<function, Walk>, t: f32, direction: vec3<f32>) -> bool {
    let ray = (*walk).bent.ray;
    let is_turned = any(direction != ray.direction_in_display);
    if is_turned {
        (*walk).bent.ray = turned_at(ray, t, direction);
        (*walk).bent.t = 0.0;
        follow_chain((*walk).bent.ray);
    }
    return is_turned;
}
