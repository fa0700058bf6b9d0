// One ray per invocation, one tile of rays per workgroup.

struct Marched {
    front: Accumulated,
    samples: u32,
    is_done: bool,
}

// Follows the ray through one brick, from t_in to t_out, in equal pairs of steps. Where a pair tells that its steps are
// too long for the tolerance, each of them is cut into equal parts.
fn march(front_of_brick: Accumulated, node: NodeRecord, ray: Ray, t_in: f32, t_out: f32) -> Marched {
    let brick = brick_of(node, ray);
    let span = t_out - t_in;
    let edge = voxel_edge(node.depth);
    let longest = step_voxels(node.most_extinction * params.quality.z * (edge / ray.speed));
    let pairs = max(1.0, ceil(span * ray.speed / (2.0 * longest * edge)));
    let step = 0.5 * span / pairs;
    let thickness = params.quality.z * step;
    var marched = Marched(front_of_brick, 0u, false);
    var known = false;
    var s2 = 0.0;
    var i = 0.0;
    while i < pairs {
        let t0 = t_in + 2.0 * i * step;
        let middle = point_in(brick, t0 + step);
        if !is_visible_at(brick, middle) {
            i += pairs_across(brick, middle, 2.0 * step);
            known = false;
            continue;
        }
        i += 1.0;
        var s0 = s2;
        if !known {
            s0 = scalar_at(brick, t0);
            marched.samples++;
        }
        let s1 = scalar_at(brick, t0 + step);
        s2 = scalar_at(brick, t0 + 2.0 * step);
        marched.samples += 2u;
        known = true;
        let range = scalars_in_reach(s0, s1, s2);
        if is_vacant(range.x, range.y) {
            continue;
        }
        let pair = pair_of(locate(s0), locate(s1), locate(s2), range);
        let visible = still_to_come(marched.front);
        let parts = max(parts_of_step(pair, thickness, visible), parts_of_rise(marched.front, range));
        if parts == 1.0 {
            // The light in the middle of the pair serves both steps.
            let light = light_at(brick, ray, max(pair.first.w, pair.second.w), t0 + step);
            marched.front = add_whole(marched.front, pair.first, s0, s1, thickness, light);
            marched.front = add_whole(marched.front, pair.second, s1, s2, thickness, light);
        } else {
            marched.front = add_parts(marched.front, brick, ray, s0, s1, t0, step, parts);
            marched.front = add_parts(marched.front, brick, ray, s1, s2, t0 + step, step, parts);
            marched.samples += 2u * u32(parts - 1.0);
        }
        if still_to_come(marched.front) < params.quality.y {
            marched.is_done = true;
            break;
        }
    }
    return marched;
}

fn report(at: u32, deficit: f32) {
    let code = u32(32768.0 + clamp(deficit, -100.0, 100.0) * 256.0);
    atomicMax(&feedback[at].deficit_code, code);
    atomicAdd(&feedback[at].rays, 1u);
}

// Colour and opacity of a ray, then the number of samples with MISSING where a node was too coarse.
fn cast_ray(ray: Ray, count: ptr<function, u32>) -> vec4<f32> {
    var front = nothing_accumulated();
    let span = clip_to_volume(ray);
    if span.x >= span.y {
        return vec4<f32>(0.0);
    }
    var t = span.x;
    var at = leaf_at(point_on(ray, t), ray);
    while at != NO_NODE {
        let node = nodes[at];
        let exit = exit_of(node, ray);
        let t_out = min(max(exit.t, t), span.y);
        if node.slot != NO_SLOT && t_out > t {
            report(at, node.deficit);
            let marched = march(front, node, ray, t, t_out);
            front = marched.front;
            *count = (*count + marched.samples) | select(0u, MISSING, node.deficit > 0.0);
            if marched.is_done {
                break;
            }
        }
        if t_out >= span.y {
            break;
        }
        t = t_out;
        at = leaf_beyond(node, exit.axis, point_on(ray, t), ray);
    }
    return vec4<f32>(front.rgb, front.alpha);
}

@compute @workgroup_size(8, 8, 1)
fn cast_tile(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_id) local: vec3<u32>) {
    let listed = group.x + group.y * groups.x;
    if listed >= params.tables.z {
        return;
    }
    let tile = tiles[listed];
    let across = params.raster.w;
    let in_tiles = vec2<u32>(tile % across, tile / across) * TILE_EDGE + local.xy;
    let pixel = in_tiles * params.raster.z + vec2<u32>(params.raster.z / 2u);
    if pixel.x >= params.raster.x || pixel.y >= params.raster.y {
        return;
    }
    var count = 0u;
    let colour = cast_ray(ray_of_pixel(vec2<f32>(pixel) + 0.5), &count);
    let index = pixel.y * params.raster.x + pixel.x;
    pixels[index] = colour;
    counts[index] = count;
}
