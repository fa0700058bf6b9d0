// One ray per invocation, one tile of rays per workgroup.

struct Marched {
    front: Accumulated,
    samples: u32,
    is_done: bool,
}

fn scalar_of(stored: f32, node: NodeRecord) -> f32 {
    return clamp(node.offset + node.scale * stored, 0.0, 1.0);
}

// First texel of a node's brick in the atlas.
fn slot_origin(slot: u32) -> vec3<f32> {
    let across = params.atlas.x;
    let layer = params.atlas.x * params.atlas.y;
    return vec3<f32>(vec3<u32>(slot % across, (slot % layer) / across, slot / layer) * BRICK_EDGE);
}

// Follows the ray through one brick, from t_in to t_out, in equal steps.
fn march(front_of_brick: Accumulated, node: NodeRecord, ray: Ray, t_in: f32, t_out: f32) -> Marched {
    let edge = voxel_edge(node.depth);
    let span = t_out - t_in;
    let steps = max(1.0, ceil(span * ray.speed / (params.quality.x * edge)));
    let step = span / steps;
    let base = (ray.origin_in_volume - node_low(node)) / edge + OVERLAP + slot_origin(node.slot);
    let slope = ray.direction_in_volume / edge;
    let gradient_scale = 0.5 * node.scale / edge;
    var marched = Marched(front_of_brick, 1u, false);
    var s0 = scalar_of(sample_atlas(base + slope * t_in), node);
    for (var i = 1.0; i <= steps; i += 1.0) {
        let t = t_in + i * step;
        let s1 = scalar_of(sample_atlas(base + slope * t), node);
        marched.samples++;
        let k = optics_between(s0, s1);
        if !is_clear(k.w) {
            let thickness = params.quality.z * step;
            let depth = k.w * thickness;
            let mean = attenuation_mean(depth);
            var lit = vec3<f32>(0.0);
            if k.w > 0.0 {
                lit = shade(k, base + slope * (t - 0.5 * step), gradient_scale, ray);
            }
            marched.front = composite(marched.front, lit * (thickness * mean), depth * mean, s0, s1);
            if still_to_come(marched.front) < params.quality.y {
                marched.is_done = true;
                break;
            }
        }
        s0 = s1;
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
