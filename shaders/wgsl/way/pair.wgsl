// A pair of steps of a bent ray, with a turn in its middle.

// Pairs over which the index changes by more than this are halved, at most MOST_HALVINGS times.
const LARGE_CHANGE: f32 = 0.004;
const MOST_HALVINGS: u32 = 4u;

// What a pair of steps led to.
struct Taken {
    // Whether nothing that follows can be seen.
    is_last: bool,
    // Whether the ray was turned.
    is_turned: bool,
}

// A pair straight on: the length of its steps, and the scalars at its ends.
struct Ends {
    step: f32,
    s0: f32,
    s2: f32,
}

// Takes a pair of steps of at most `longest` metres each.
fn take_pair(walk: ptr<function, Walk>, node: NodeRecord, brick: Brick, longest: f32) -> Taken {
    let ray = (*walk).bent.ray;
    let t0 = (*walk).bent.t;
    let ends = ends_of_pair(walk, brick, longest);
    let step = ends.step;
    var t1 = t0 + step;
    var s2 = ends.s2;
    let s1 = scalar_at(brick, ray, t1);
    (*walk).count += 3u;
    let is_turned = turn(walk, brick, ends);
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
    let range = scalars_in_reach(ends.s0, s1, s2);
    if is_vacant_around(range, max(spreads.x, spreads.y)) {
        return Taken(false, is_turned);
    }
    var front = (*walk).front;
    let parts = add_pair(&front, brick, ray, t0, next_brick, (*walk).bent.ray, t1, step, ends.s0, s1, s2, range,
        spreads);
    (*walk).front = front;
    (*walk).count += 2u * u32(parts - 1.0);
    return Taken(still_to_come(front) < scene.quality.y, is_turned);
}

// The ends of a pair straight on, halved while the index changes much between them.
fn ends_of_pair(walk: ptr<function, Walk>, brick: Brick, longest: f32) -> Ends {
    let ray = (*walk).bent.ray;
    let t0 = (*walk).bent.t;
    var ends = Ends(longest, (*walk).known, 0.0);
    if !(*walk).is_known {
        ends.s0 = scalar_at(brick, ray, t0);
    }
    ends.s2 = scalar_at(brick, ray, t0 + 2.0 * ends.step);
    let index = index_at(ends.s0);
    for (var halved = 0u; halved < MOST_HALVINGS && abs(index_at(ends.s2) - index) > LARGE_CHANGE; halved++) {
        ends.step *= 0.5;
        ends.s2 = scalar_at(brick, ray, t0 + 2.0 * ends.step);
        (*walk).count += 1u;
    }
    return ends;
}

// Turns the ray in the middle of a pair; whether it does not go straight on.
fn turn(walk: ptr<function, Walk>, brick: Brick, ends: Ends) -> bool {
    if !bends(ends.s0, ends.s2) {
        return false;
    }
    var bent = (*walk).bent;
    let t1 = bent.t + ends.step;
    let gradient = gradients_at(brick, bent.ray, t1).at;
    let direction = direction_beyond(&bent, gradient, ends.s0, ends.s2, 2.0 * ends.step);
    let is_turned = any(direction != bent.ray.direction_in_display);
    if is_turned {
        bent.ray = turned_at(bent.ray, t1, direction);
        follow_chain(bent.ray);
    }
    (*walk).bent = bent;
    return is_turned;
}
