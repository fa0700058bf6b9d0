// One ray per invocation, one tile of rays per workgroup.

struct Marched {
    front: Accumulated,
    samples: u32,
    is_done: bool,
}

// First texel of a node's brick in the atlas.
fn slot_origin(slot: u32) -> vec3<f32> {
    let across = params.atlas.x;
    let layer = params.atlas.x * params.atlas.y;
    return vec3<f32>(vec3<u32>(slot % across, (slot % layer) / across, slot / layer) * BRICK_EDGE);
}

// What stays the same on a ray's way through one brick.
struct Brick {
    // A point t metres along the ray lies at base + slope t, in texels of the atlas.
    base: vec3<f32>,
    slope: vec3<f32>,
    // Turns a difference over two texels into a change of the scalar per finest voxel.
    gradient_scale: f32,
    offset: f32,
    scale: f32,
}

fn brick_of(node: NodeRecord, ray: Ray) -> Brick {
    let edge = voxel_edge(node.depth);
    let base = (ray.origin_in_volume - node_low(node)) / edge + OVERLAP + slot_origin(node.slot);
    return Brick(base, ray.direction_in_volume / edge, 0.5 * node.scale / edge, node.offset, node.scale);
}

fn scalar_at(brick: Brick, t: f32) -> f32 {
    return clamp(brick.offset + brick.scale * sample_atlas(brick.base + brick.slope * t), 0.0, 1.0);
}

// Premultiplied colour and opacity of a segment of `thickness` (extinction per metre of table value 1, times metres) with
// its middle at t, composited alone.
fn segment_light(brick: Brick, ray: Ray, k: vec4<f32>, t: f32, thickness: f32) -> vec4<f32> {
    if k.w <= 0.0 {
        return vec4<f32>(0.0);
    }
    let depth = k.w * thickness;
    let mean = attenuation_mean(depth);
    let lit = shade(k, brick.base + brick.slope * t, brick.gradient_scale, ray);
    return vec4<f32>(lit * (thickness * mean), depth * mean);
}

// Adds one step that begins at t0, cut into parts.
fn add_step(front_of_step: Accumulated, brick: Brick, ray: Ray, k: vec4<f32>, s0: f32, s1: f32, t0: f32, step: f32,
    parts: f32) -> Accumulated {
    let thickness = params.quality.z * step;
    if parts == 1.0 {
        if is_clear(k.w) {
            return front_of_step;
        }
        return composite(front_of_step, segment_light(brick, ray, k, t0 + 0.5 * step, thickness), s0, s1);
    }
    var front = front_of_step;
    var alone = vec4<f32>(0.0);
    let part = step / parts;
    var from_s = s0;
    for (var j = 1.0; j <= parts; j += 1.0) {
        let t = t0 + j * part;
        var to_s = s1;
        if j < parts {
            to_s = scalar_at(brick, t);
        }
        let mean = optics_between(from_s, to_s);
        if !is_clear(mean.w) {
            let light = segment_light(brick, ray, mean, t - 0.5 * part, thickness / parts);
            if ONCE_PER_STEP {
                alone += light * (1.0 - alone.w);
            } else {
                front = composite(front, light, from_s, to_s);
            }
        }
        from_s = to_s;
    }
    if ONCE_PER_STEP {
        front = composite(front, alone, s0, s1);
    }
    return front;
}

// Follows the ray through one brick, from t_in to t_out, in equal pairs of steps. Where a pair tells that its steps are
// too long for the tolerance, each of them is cut into equal parts.
fn march(front_of_brick: Accumulated, node: NodeRecord, ray: Ray, t_in: f32, t_out: f32) -> Marched {
    let brick = brick_of(node, ray);
    let span = t_out - t_in;
    let pairs = max(1.0, ceil(span * ray.speed / (2.0 * params.quality.x * voxel_edge(node.depth))));
    let step = 0.5 * span / pairs;
    let thickness = params.quality.z * step;
    var marched = Marched(front_of_brick, 1u, false);
    var s0 = scalar_at(brick, t_in);
    for (var i = 0.0; i < pairs; i += 1.0) {
        let t0 = t_in + 2.0 * i * step;
        let s1 = scalar_at(brick, t0 + step);
        let s2 = scalar_at(brick, t0 + 2.0 * step);
        marched.samples += 2u;
        let first = optics_between(s0, s1);
        let second = optics_between(s1, s2);
        let range = scalars_in_reach(s0, s1, s2);
        let reach = optics_between(range.x, range.y);
        if !is_clear(reach.w) {
            let pair = Pair(first, second, optics_between(s0, s2), reach);
            let visible = still_to_come(marched.front);
            let parts = max(parts_of_step(pair, thickness, visible), parts_of_rise(marched.front, range));
            marched.front = add_step(marched.front, brick, ray, first, s0, s1, t0, step, parts);
            marched.front = add_step(marched.front, brick, ray, second, s1, s2, t0 + step, step, parts);
            marched.samples += 2u * u32(parts - 1.0);
            if still_to_come(marched.front) < params.quality.y {
                marched.is_done = true;
                break;
            }
        }
        s0 = s2;
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
