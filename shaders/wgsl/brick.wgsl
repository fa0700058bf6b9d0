// A ray's way through one brick: samples, light and steps.

// What stays the same on that way.
struct Brick {
    // First texel in the atlas.
    origin: vec3<f32>,
    // First word of its cells.
    words: u32,
    // A point t metres along the ray lies at base + slope t, in texels of the brick.
    base: vec3<f32>,
    slope: vec3<f32>,
    // Metres per texel along each axis, without sign.
    pace: vec3<f32>,
    // Turns a difference over two texels into a change of the scalar per finest voxel.
    gradient_scale: f32,
    offset: f32,
    scale: f32,
}

fn slot_origin(slot: u32) -> vec3<f32> {
    let across = params.atlas.x;
    let layer = params.atlas.x * params.atlas.y;
    return vec3<f32>(vec3<u32>(slot % across, (slot % layer) / across, slot / layer) * BRICK_EDGE);
}

fn brick_of(node: NodeRecord, ray: Ray) -> Brick {
    let edge = voxel_edge(node.depth);
    var brick: Brick;
    brick.origin = slot_origin(node.slot);
    brick.words = node.slot * CELL_WORDS;
    brick.base = (ray.origin_in_volume - node_low(node)) / edge + OVERLAP;
    brick.slope = ray.direction_in_volume / edge;
    brick.pace = abs(ray.inverse) * edge;
    brick.gradient_scale = 0.5 * node.scale / edge;
    brick.offset = node.offset;
    brick.scale = node.scale;
    return brick;
}

// The point at t, in texels of the brick.
fn point_in(brick: Brick, t: f32) -> vec3<f32> {
    return brick.base + brick.slope * t;
}

fn scalar_at(brick: Brick, t: f32) -> f32 {
    return clamp(brick.offset + brick.scale * sample_atlas(brick.origin, point_in(brick, t)), 0.0, 1.0);
}

// Whether anything shows within a voxel of the cell around a point.
fn is_visible_at(brick: Brick, point: vec3<f32>) -> bool {
    let at = vec3<u32>(point * (1.0 / CELL_EDGE)) & vec3<u32>(7u);
    let cell = (at.z * 8u + at.y) * 8u + at.x;
    return ((cells[brick.words + (cell >> 5u)] >> (cell & 31u)) & 1u) != 0u;
}

// Pairs of steps of `length` metres until the middle of one lies beyond the cell around `middle`; at least 1.
fn pairs_across(brick: Brick, middle: vec3<f32>, length: f32) -> f32 {
    let low = floor(middle * (1.0 / CELL_EDGE)) * CELL_EDGE;
    let face = select(low, low + CELL_EDGE, brick.slope >= vec3<f32>(0.0));
    let way = abs(face - middle) * brick.pace;
    return clamp(ceil(min(way.x, min(way.y, way.z)) / length), 1.0, 1e6);
}

// What light makes of a colour: τ c · body + τ · highlight.
struct Lighting {
    body: f32,
    highlight: f32,
}

// The light at t, where there is extinction to be lit.
fn light_at(brick: Brick, ray: Ray, extinction: f32, t: f32) -> Lighting {
    if extinction > 0.0 {
        return lighting(brick.origin, point_in(brick, t), brick.gradient_scale, ray);
    }
    return Lighting(1.0, 0.0);
}

// Light of a segment with mean `k` of (τ c, τ), composited alone: premultiplied colour and opacity. `thickness` is metres
// times the extinction per metre where the table says 1.
fn segment_light(k: vec4<f32>, thickness: f32, light: Lighting) -> vec4<f32> {
    let depth = k.w * thickness;
    let mean = attenuation_mean(depth);
    let lit = k.xyz * light.body + vec3<f32>(k.w * light.highlight);
    return vec4<f32>(lit * (thickness * mean), depth * mean);
}

// Adds one step, lit as given.
fn add_whole(front: Accumulated, k: vec4<f32>, s0: f32, s1: f32, thickness: f32, light: Lighting) -> Accumulated {
    if is_clear(k.w) {
        return front;
    }
    return composite(front, segment_light(k, thickness, light), s0, s1);
}

// Adds one step that begins at t0, cut into parts.
fn add_parts(front_of_step: Accumulated, brick: Brick, ray: Ray, s0: f32, s1: f32, t0: f32, step: f32,
    parts: f32) -> Accumulated {
    let part = step / parts;
    let thickness = params.quality.z * part;
    var front = front_of_step;
    var alone = vec4<f32>(0.0);
    var from_s = s0;
    var from_located = locate(s0);
    for (var j = 1.0; j <= parts; j += 1.0) {
        let t = t0 + j * part;
        var to_s = s1;
        if j < parts {
            to_s = scalar_at(brick, t);
        }
        let to_located = locate(to_s);
        let k = optics_between(from_located, to_located);
        if !is_clear(k.w) {
            let light = segment_light(k, thickness, light_at(brick, ray, k.w, t - 0.5 * part));
            if ONCE_PER_STEP {
                alone += light * (1.0 - alone.w);
            } else {
                front = composite(front, light, from_s, to_s);
            }
        }
        from_s = to_s;
        from_located = to_located;
    }
    if ONCE_PER_STEP {
        front = composite(front, alone, s0, s1);
    }
    return front;
}
