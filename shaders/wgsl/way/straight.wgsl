// A straight ray's way through the volume.

struct Marched {
    front: Accumulated,
    samples: u32,
    is_done: bool,
    // Whether the driver left the loop before its end.
    is_cut: bool,
}

// Follows the ray through one brick, from t_in to t_out, in equal pairs of steps. If the steps of a pair turn out too
// long for the tolerance, each of them is split into equal parts. If samples blend levels, the rest of the way is
// divided anew after each pair, into pairs as long as the level there allows.
fn march(front_of_brick: Accumulated, brick: Brick, ray: Ray, voxel: Voxel, t_in: f32, t_out: f32) -> Marched {
    var from_t = t_in;
    var span = t_out - t_in;
    var pairs = max(1.0, ceil(span / (2.0 * longest_step(voxel, brick, ray, t_in))));
    var step = 0.5 * span / pairs;
    var front = front_of_brick;
    var marched = Marched(front, 0u, false, false);
    var known = false;
    var s2 = 0.0;
    var i = 0.0;
    while i < pairs {
        let t0 = from_t + 2.0 * i * step;
        // Steps too short for t to grow by them are counted instead, or there would be no end.
        if has_fractions(brick) && t0 > from_t {
            from_t = t0;
            span = max(t_out - from_t, 0.0);
            pairs = max(1.0, ceil(span / (2.0 * longest_step(voxel, brick, ray, from_t))));
            step = 0.5 * span / pairs;
            i = 0.0;
        }
        let unseen = pairs_unseen(brick, t0, step);
        if unseen > 0.0 {
            i += unseen;
            known = false;
            continue;
        }
        i += 1.0;
        var s0 = s2;
        if !known {
            s0 = scalar_at(brick, ray, t0);
            marched.samples++;
        }
        let s1 = scalar_at(brick, ray, t0 + step);
        s2 = scalar_at(brick, ray, t0 + 2.0 * step);
        marched.samples += 2u;
        known = true;
        let range = scalars_in_reach(s0, s1, s2);
        let spreads = vec2<f32>(spread_at(brick, ray, t0 + 0.5 * step), spread_at(brick, ray, t0 + 1.5 * step));
        if is_vacant_around(range, max(spreads.x, spreads.y)) {
            continue;
        }
        let steps = PairOfSteps(ray, ray, vec2<f32>(t0, t0 + step), step, vec3<f32>(s0, s1, s2), range);
        let pair = add_pair(&front, brick, brick, steps, spreads);
        if pair.parts > 1.0 {
            // One after the other in a loop: a driver in software runs what stands here for rays, too, that cut nothing.
            var half = pair.first;
            for (var k = 0u; k < 2u; k++) {
                marched.samples += add_parts(&front, brick, ray, half, pair.parts);
                half = pair.second;
            }
        }
        if still_to_come(front) < scene.quality.y {
            marched.is_done = true;
            break;
        }
    }
    marched.front = front;
    marched.is_cut = i < pairs && !marched.is_done;
    return marched;
}

// Goes on along a part of a ray. `count` is the number of samples so far, with MISSING where a node was too coarse, and CUT if
// the driver left a loop before its end.
fn follow(ray: Ray, span: vec2<f32>, accumulated: ptr<function, Accumulated>, count: ptr<function, u32>) {
    var front = *accumulated;
    var t = span.x;
    var at = leaf_at(point_on(ray, t), ray);
    var goes_on = at != NO_NODE;
    var is_cut = false;
    while goes_on {
        let node = nodes[at];
        let exit = exit_of(node, ray);
        let t_out = min(max(exit.t, t), span.y);
        goes_on = t_out < span.y;
        if node.slot != NO_SLOT && t_out > t {
            note(at, node.deficit);
            let brick = brick_of(node, ray);
            let voxel = voxel_of(node, ray);
            var is_done = false;
            // Cut where the law of an enhancer is not smooth.
            while t < t_out && !is_done {
                let until = min(next_break(t), t_out);
                let marched = march(front, brick, ray, voxel, t, until);
                front = marched.front;
                is_done = marched.is_done;
                is_cut |= marched.is_cut;
                *count += marched.samples;
                t = until;
            }
            *count |= select(0u, MISSING, node.deficit > 0.0);
            is_cut |= t < t_out && !is_done;
            goes_on &= !is_done;
        }
        if goes_on {
            t = t_out;
            at = leaf_beyond(at, node, exit.axis, point_on(ray, t), ray);
            goes_on = at != NO_NODE;
        }
    }
    *count |= select(0u, CUT, is_cut || goes_on);
    *accumulated = front;
}

// Colour and opacity of a ray; `count` as above.
fn cast_ray(ray: Ray, count: ptr<function, u32>) -> vec4<f32> {
    let span = clip_to_volume(ray);
    if span.x >= span.y {
        return vec4<f32>(0.0);
    }
    start_chain(ray);
    follow_chain(ray);
    var front = nothing_accumulated();
    follow(ray, span, &front, count);
    return vec4<f32>(front.rgb, front.alpha);
}
