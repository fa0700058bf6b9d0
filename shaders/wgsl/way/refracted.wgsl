// A bent ray's way through the volume: straight pairs of steps, with a turn in the middle of each.

@group(0) @binding(BINDING_INDEX) var<storage, read> index_table: array<f32>;

// Pairs over which the index changes by more than this are halved, up to MOST_HALVINGS times.
const LARGE_CHANGE: f32 = 0.004;
const MOST_HALVINGS: u32 = 4u;
// A pair that still changes it by more than this is taken as a surface: Snell's law, and a mirror beyond the critical
// angle. Over smaller changes the ray equation is followed: ν v changes by ∇ν times the way.
const SURFACE: f32 = 0.02;
// Ways that are longer than this many diagonals of the volume end.
const LONGEST_WAY_DIAGONALS: f32 = 4.0;
// Steps are at most this long, voxels of the node: after a turn a step may lead out of the brick, as far as its overlap
// holds samples for gradients.
const MOST_STEP: f32 = 0.5;
// Ways straight on are measured from a new origin after this many voxels, so that no step is lost to rounding.
const LONGEST_STRAIGHT: f32 = 1024.0;
// A pair is at least this long, voxels of the node, however near the node's border is.
const LEAST_PAIR: f32 = 1e-3;
// Difference quotients over less than this many table cells are replaced by the slope of the cell.
const LEAST_CELLS: f32 = 0.5;

// The refraction index at a scalar.
fn index_at(s: f32) -> f32 {
    let entries = scene.tables.x;
    let u = s * f32(entries - 1u);
    let cell = min(u32(u), entries - 2u);
    return mix(index_table[cell], index_table[cell + 1u], u - f32(cell));
}

// Its mean slope between two scalars. The cell of a jump has none: surfaces are met by crossing them.
fn index_slope(s0: f32, s1: f32) -> f32 {
    let cells = f32(scene.tables.x - 1u);
    if abs(s1 - s0) * cells >= LEAST_CELLS {
        return (index_at(s1) - index_at(s0)) / (s1 - s0);
    }
    let cell = min(u32(0.5 * (s0 + s1) * cells), scene.tables.x - 2u);
    let change = index_table[cell + 1u] - index_table[cell];
    return select(change * cells, 0.0, abs(change) > SURFACE);
}

// What a bent ray carries along.
struct Bent {
    // Straight from the last turn on.
    ray: Ray,
    // Metres since that turn, and of the whole way.
    t: f32,
    way: f32,
    // Whether it was turned by a surface that it may not have passed yet, and the indices on both sides.
    is_passing: bool,
    index_before: f32,
    index_beyond: f32,
}

// Turns the ray in the middle of a pair of steps, where the gradient of the scalar (per finest voxel) is `gradient` and
// the pair, straight on, would go from s0 to s2 over `length` metres. The direction, unit vector.
fn direction_beyond(bent: ptr<function, Bent>, gradient: vec3<f32>, s0: f32, s2: f32, length: f32) -> vec3<f32> {
    let v = (*bent).ray.direction_in_display;
    let n0 = index_at(s0);
    let n2 = index_at(s2);
    // A ray that was turned by a surface and has not passed it yet goes straight on; then it has the index beyond.
    var own = n0;
    if (*bent).is_passing {
        if abs(n0 - (*bent).index_before) < abs(n0 - (*bent).index_beyond) {
            return v;
        }
        own = (*bent).index_beyond;
        (*bent).is_passing = false;
    }
    let square = dot(gradient, gradient);
    if square < LEAST_SQUARE {
        return v;
    }
    if abs(n2 - n0) <= SURFACE {
        return normalize(v * (0.5 * (n0 + n2)) + gradient * (index_slope(s0, s2) * length / scene.volume.w));
    }
    var normal = gradient / sqrt(square);
    let towards = dot(normal, v);
    normal = select(-normal, normal, towards >= 0.0);
    // From the index that the direction belongs to, so that the turns of a steep rise add up to Snell's law.
    let along = own * abs(towards);
    let beyond = along * along + n2 * n2 - own * own;
    if beyond < 0.0 {
        return normalize(v - normal * (2.0 * abs(towards)));
    }
    (*bent).is_passing = true;
    (*bent).index_before = n0;
    (*bent).index_beyond = n2;
    return normalize(v * own + normal * (sqrt(beyond) - along));
}

// The same ray, turned at t.
fn turned_at(ray: Ray, t: f32, direction_in_display: vec3<f32>) -> Ray {
    var next = ray;
    next.origin_in_volume = point_on(ray, t);
    next.origin_in_display = point_in_display(ray, t);
    return turned(next, direction_in_display);
}

// Where the ray, which is inside, leaves the volume.
fn exit_of_volume(ray: Ray) -> f32 {
    var t = FAR;
    for (var axis = 0u; axis < 3u; axis++) {
        if !is_parallel(ray, axis) {
            let face = select(0.0, scene.volume[axis], is_forward(ray, axis));
            t = min(t, (face - ray.origin_in_volume[axis]) * ray.inverse[axis]);
        }
    }
    return t;
}

fn is_in_node(node: NodeRecord, point: vec3<f32>) -> bool {
    let low = node_low(node);
    let high = low + OWN_EDGE * voxel_edge(node.depth);
    return all(point >= low) && all(point <= high);
}

fn is_in_volume(point: vec3<f32>) -> bool {
    return all(point >= vec3<f32>(0.0)) && all(point <= scene.volume.xyz);
}

// Colour and opacity of a ray, then the number of samples with MISSING where a node was too coarse.
fn cast_ray(eye_ray: Ray, count: ptr<function, u32>) -> vec4<f32> {
    var front = nothing_accumulated();
    let span = clip_to_volume(eye_ray);
    if span.x >= span.y {
        return vec4<f32>(0.0);
    }
    start_chain(eye_ray);
    var bent: Bent;
    bent.ray = turned_at(eye_ray, span.x, eye_ray.direction_in_display);
    bent.t = 0.0;
    bent.way = 0.0;
    bent.is_passing = false;
    follow_chain(bent.ray);
    let longest_way = scene.resolution.w * LONGEST_WAY_DIAGONALS;
    var at = leaf_at(bent.ray.origin_in_volume, bent.ray);
    var reported = NO_NODE;
    var known = false;
    var s2 = 0.0;
    while at != NO_NODE && bent.way < longest_way {
        let node = nodes[at];
        if bent.t * bent.ray.speed > LONGEST_STRAIGHT {
            bent.ray = turned_at(bent.ray, bent.t, bent.ray.direction_in_display);
            bent.t = 0.0;
            follow_chain(bent.ray);
        }
        let exit = exit_of(node, bent.ray);
        let t_out = min(exit.t, exit_of_volume(bent.ray));
        if node.slot == NO_SLOT {
            known = false;
            bent.way += max(t_out - bent.t, 0.0);
            bent.t = max(t_out, bent.t);
            if t_out < exit.t {
                break;
            }
            at = leaf_beyond(node, exit.axis, point_on(bent.ray, bent.t), bent.ray);
            continue;
        }
        if reported != at {
            reported = at;
            known = false;
            note(at, node.deficit);
            *count |= select(0u, MISSING, node.deficit > 0.0);
        }
        let brick = brick_of(node, bent.ray);
        let voxel = voxel_of(node, bent.ray);
        // As many equal pairs as lie between here and the border or the next break; one of them is taken.
        let span_left = max(min(t_out, next_break(bent.t)) - bent.t, LEAST_PAIR * voxel.edge);
        let longest = min(longest_step(voxel, brick, bent.ray, bent.t), MOST_STEP * voxel.edge);
        let pairs = max(1.0, ceil(span_left / (2.0 * longest)));
        var step = 0.5 * span_left / pairs;
        let t0 = bent.t;
        let unseen = pairs_unseen(brick, t0, step);
        if unseen > 0.0 {
            known = false;
            let skipped = min(unseen, pairs) * 2.0 * step;
            bent.t += skipped;
            bent.way += skipped;
            if bent.t >= t_out {
                if t_out < exit.t {
                    break;
                }
                at = leaf_beyond(node, exit.axis, point_on(bent.ray, bent.t), bent.ray);
            }
            continue;
        }
        var s0 = s2;
        if !known {
            s0 = scalar_at(brick, bent.ray, t0);
        }
        s2 = scalar_at(brick, bent.ray, t0 + 2.0 * step);
        for (var halved = 0u; halved < MOST_HALVINGS && abs(index_at(s2) - index_at(s0)) > LARGE_CHANGE; halved++) {
            step *= 0.5;
            s2 = scalar_at(brick, bent.ray, t0 + 2.0 * step);
            *count += 1u;
        }
        let s1 = scalar_at(brick, bent.ray, t0 + step);
        known = true;
        *count += 3u;
        let ray = bent.ray;
        var next_brick = brick;
        var t1 = t0 + step;
        var is_turned = false;
        if bends(s0, s2) {
            let gradient = gradients_at(brick, ray, t1).at;
            let direction = direction_beyond(&bent, gradient, s0, s2, 2.0 * step);
            is_turned = any(direction != ray.direction_in_display);
            if is_turned {
                bent.ray = turned_at(ray, t1, direction);
                follow_chain(bent.ray);
                next_brick = brick_of(node, bent.ray);
                t1 = 0.0;
                s2 = scalar_at(next_brick, bent.ray, step);
                *count += 1u;
            }
        }
        bent.t = t1 + step;
        bent.way += 2.0 * step;
        let range = scalars_in_reach(s0, s1, s2);
        if !is_vacant(range.x, range.y) {
            let parts = add_pair(&front, brick, ray, t0, next_brick, bent.ray, t1, step, s0, s1, s2, range);
            *count += 2u * u32(parts - 1.0);
            if still_to_come(front) < scene.quality.y {
                break;
            }
        }
        let point = point_on(bent.ray, bent.t);
        if is_turned {
            if !is_in_volume(point) {
                break;
            }
            if !is_in_node(node, point) {
                at = leaf_at(point, bent.ray);
            }
        } else if bent.t >= t_out {
            if t_out < exit.t {
                break;
            }
            at = leaf_beyond(node, exit.axis, point, bent.ray);
        }
    }
    return vec4<f32>(front.rgb, front.alpha);
}

// Whether the index may change between two scalars.
fn bends(s0: f32, s1: f32) -> bool {
    return index_at(s0) != index_at(s1) || index_slope(s0, s1) != 0.0;
}
