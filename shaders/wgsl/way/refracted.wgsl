// A bent ray's way through the volume: node by node, in straight pairs of steps with a turn in the middle of each.

// Ways that are longer than this many diagonals of the volume end.
const LONGEST_WAY_DIAGONALS: f32 = 4.0;
// Steps are at most this long, voxels of the node: what a pair turns by is seen in its middle, where it may miss what the
// gradient does elsewhere on it; and after a turn a step may lead out of the brick, as far as its overlap holds samples.
const MOST_STEP: f32 = 0.25;
// A pair is at least this long, voxels of the node, however near the node's border is.
const LEAST_PAIR: f32 = 1e-3;

// A bent ray on its way.
struct Walk {
    bent: Bent,
    front: Accumulated,
    // The number of samples, with MISSING where a node was too coarse, and CUT if the driver left the loop before its end.
    count: u32,
    // The scalar where it is, where that is known.
    is_known: bool,
    known: f32,
    // The node it is in, and the one that was last noted.
    at: u32,
    noted: u32,
}

// How a straight way leaves a node: the node itself, and where it leaves that, or the volume before that.
struct Leaving {
    exit: Exit,
    t_out: f32,
}

// Where the ray, which is inside, leaves the volume.
fn exit_of_volume(ray: Ray) -> f32 {
    let t = ways_to(select(vec3<f32>(0.0), scene.volume.xyz, are_forward(ray)), ray);
    return min(t.x, min(t.y, t.z));
}

fn is_in_node(node: NodeRecord, point: vec3<f32>) -> bool {
    let low = node_low(node);
    let high = low + OWN_EDGE * voxel_edge(node.depth);
    return all(point >= low) && all(point <= high);
}

fn is_in_volume(point: vec3<f32>) -> bool {
    return all(point >= vec3<f32>(0.0)) && all(point <= scene.volume.xyz);
}

// Colour and opacity of a ray; `count` as above.
fn cast_ray(eye_ray: Ray, count: ptr<function, u32>) -> vec4<f32> {
    let span = clip_to_volume(eye_ray);
    if span.x >= span.y {
        return vec4<f32>(0.0);
    }
    var walk = start_walk(eye_ray, span.x);
    let longest_way = scene.resolution.w * LONGEST_WAY_DIAGONALS;
    var goes_on = walk.at != NO_NODE;
    while goes_on {
        goes_on = go_on(&walk) && walk.at != NO_NODE && walk.bent.way < longest_way;
    }
    *count = walk.count | select(0u, CUT, goes_on);
    return vec4<f32>(walk.front.rgb, walk.front.alpha);
}

fn start_walk(eye_ray: Ray, t: f32) -> Walk {
    start_chain(eye_ray);
    var walk: Walk;
    walk.bent = entering(eye_ray, t);
    follow_chain(walk.bent.ray);
    walk.front = nothing_accumulated();
    walk.count = 0u;
    walk.is_known = false;
    walk.at = leaf_at(walk.bent.ray.origin_in_volume, walk.bent.ray);
    walk.noted = NO_NODE;
    return walk;
}

// Takes one pair of steps, or passes over what shows nothing; whether the way goes on.
fn go_on(walk: ptr<function, Walk>) -> bool {
    let node = nodes[(*walk).at];
    if (*walk).bent.t * (*walk).bent.ray.speed > LONGEST_STRAIGHT {
        (*walk).bent.ray = turned_at((*walk).bent.ray, (*walk).bent.t, (*walk).bent.ray.direction_in_display);
        (*walk).bent.t = 0.0;
        follow_chain((*walk).bent.ray);
    }
    let exit = exit_of(node, (*walk).bent.ray);
    let leaving = Leaving(exit, min(exit.t, exit_of_volume((*walk).bent.ray)));
    if node.slot == NO_SLOT {
        (*walk).is_known = false;
        (*walk).bent.way += max(leaving.t_out - (*walk).bent.t, 0.0);
        (*walk).bent.t = max(leaving.t_out, (*walk).bent.t);
        forget(walk);
        return leave(walk, node, leaving);
    }
    note_node(walk, node);
    let brick = brick_of(node, (*walk).bent.ray);
    let pairs = lay_out(*walk, node, brick, leaving.t_out);
    let unseen = pairs_unseen(brick, (*walk).bent.t, pairs.x);
    if unseen > 0.0 {
        let skipped = min(unseen, pairs.y) * 2.0 * pairs.x;
        (*walk).is_known = false;
        (*walk).bent.t += skipped;
        (*walk).bent.way += skipped;
        forget(walk);
    } else {
        let taken = take_pair(walk, node, brick, pairs.x);
        if taken.is_last {
            return false;
        }
        if taken.is_turned {
            return find_node(walk, node);
        }
    }
    if (*walk).bent.t < leaving.t_out {
        return true;
    }
    return leave(walk, node, leaving);
}

// Forgets what was before something that bends nothing.
fn forget(walk: ptr<function, Walk>) {
    (*walk).bent.force = vec3<f32>(0.0);
    (*walk).bent.since = 0.0;
    (*walk).bent.side = UNKNOWN_SIDE;
}

// Notes a node that the ray comes into.
fn note_node(walk: ptr<function, Walk>, node: NodeRecord) {
    if (*walk).noted != (*walk).at {
        (*walk).noted = (*walk).at;
        (*walk).is_known = false;
        note((*walk).at, node.deficit);
        (*walk).count |= select(0u, MISSING, node.deficit > 0.0);
    }
}

// As many equal pairs as lie between here and the border or the next break, of which one is taken: the length of their
// steps, and how many they are.
fn lay_out(walk: Walk, node: NodeRecord, brick: Brick, t_out: f32) -> vec2<f32> {
    let t = walk.bent.t;
    let voxel = voxel_of(node, walk.bent.ray);
    let span = max(min(t_out, next_break(t)) - t, LEAST_PAIR * voxel.edge);
    let longest = min(longest_step(voxel, brick, walk.bent.ray, t), MOST_STEP * voxel.edge);
    let pairs = max(1.0, ceil(span / (2.0 * longest)));
    return vec2<f32>(0.5 * span / pairs, pairs);
}

// Goes over a node's border; whether it goes on beyond.
fn leave(walk: ptr<function, Walk>, node: NodeRecord, leaving: Leaving) -> bool {
    if leaving.t_out < leaving.exit.t {
        return false;
    }
    let ray = (*walk).bent.ray;
    (*walk).at = leaf_beyond((*walk).at, node, leaving.exit.axis, point_on(ray, (*walk).bent.t), ray);
    return true;
}

// Finds out which node a turn led into; whether it is inside the volume.
fn find_node(walk: ptr<function, Walk>, node: NodeRecord) -> bool {
    let ray = (*walk).bent.ray;
    let point = point_on(ray, (*walk).bent.t);
    if !is_in_volume(point) {
        return false;
    }
    if !is_in_node(node, point) {
        (*walk).at = leaf_at(point, ray);
    }
    return true;
}
