// A kernel written without refraction, gradients, importance, enhancers, materials and levels: what the simplest scene needs,
// and nothing else. It was frozen so that `cargo bench -p lightloom-tests --bench kernels` can tell what it costs that
// kernels are composed from modules that could do more. Its code stays as it is; where the host's structs change, only
// their declarations here follow.

// The structs that the host fills and reads; their Rust forms stand in src/layout/.

struct SceneBlock {
    volume_from_display: array<vec4<f32>, 4>,
    volume: vec4<f32>,
    light: vec4<f32>,
    material: vec4<f32>,
    quality: vec4<f32>,
    mimda: vec4<f32>,
    texel: vec4<f32>,
    atlas: vec4<u32>,
    tables: vec4<u32>,
    resolution: vec4<f32>,
}

struct ViewBlock {
    screen_from_pixel: array<vec4<f32>, 3>,
    beam: vec4<f32>,
    raster: vec4<u32>,
    extent: vec4<u32>,
}

struct NodeRecord {
    cell: vec3<u32>,
    depth: u32,
    parent: u32,
    first_child: u32,
    slot: u32,
    deficit: f32,
    offset: f32,
    scale: f32,
    neighbours: array<u32, 6>,
    most_extinction: f32,
    padding: array<u32, 3>,
}

struct OpticsEntry {
    value: vec4<f32>,
    integral: vec4<f32>,
    integral_rest: vec4<f32>,
}

struct ImportanceEntry {
    value: f32,
    integral: f32,
    integral_rest: f32,
    padding: f32,
}

struct FeedbackEntry {
    deficit_code: atomic<u32>,
    rays: atomic<u32>,
}

const NO_NODE: u32 = 0xffffffffu;
const NO_SLOT: u32 = 0xffffffffu;
const TILE_EDGE: u32 = 8u;
const BRICK_EDGE: u32 = 32u;
const OVERLAP: f32 = 2.0;
const OWN_EDGE: f32 = 28.0;
// Texels along the edge of a cell, and words of cells a slot.
const CELL_EDGE: f32 = 4.0;
const CELL_WORDS: u32 = 16u;
// Set in the count of samples where a ray met a node that is too coarse.
const MISSING: u32 = 0x80000000u;

@group(0) @binding(0) var<uniform> scene: SceneBlock;
@group(0) @binding(1) var<uniform> projector: ViewBlock;
@group(0) @binding(3) var<storage, read> nodes: array<NodeRecord>;
@group(0) @binding(7) var<storage, read> optics_table: array<OpticsEntry>;
@group(0) @binding(13) var<storage, read> tiles: array<u32>;
@group(0) @binding(14) var<storage, read_write> pixels: array<vec4<f32>>;
@group(0) @binding(15) var<storage, read_write> counts: array<u32>;
@group(0) @binding(16) var<storage, read_write> feedback: array<FeedbackEntry>;
@group(0) @binding(5) var atlas: texture_3d<f32>;
// How many table cells below each node change a picture.
@group(0) @binding(8) var<storage, read> occupied: array<u32>;
// Which 4³ cells of each slot's brick show anything: 16 words a slot, cell (x, y, z) is bit (z 8 + y) 8 + x.
@group(0) @binding(4) var<storage, read> cells: array<u32>;

// The ray of a projector pixel (LFD eq. 1), seen from the volume.

struct Ray {
    // Where the ray meets the screen; t = 0 there, and t counts metres from the viewer toward the screen.
    origin_in_volume: vec3<f32>,
    // Voxels per metre.
    direction_in_volume: vec3<f32>,
    // Metres per voxel along each axis; FAR along an axis that the ray is parallel to.
    inverse: vec3<f32>,
    // Unit vector.
    direction_in_display: vec3<f32>,
    // t of the ray's start on the observer's line.
    start: f32,
    // Voxels per metre of t.
    speed: f32,
}

// Stands for infinity, which WGSL does not promise.
const FAR: f32 = 1e30;
// Slower than this along an axis (voxels per metre), a ray counts as parallel to it.
const PARALLEL: f32 = 1e-12;

fn ray_of_pixel(pixel: vec2<f32>) -> Ray {
    let on_screen = projector.screen_from_pixel[0].xyz * pixel.x + projector.screen_from_pixel[1].xyz * pixel.y
        + projector.screen_from_pixel[2].xyz;
    let screen = vec3<f32>(on_screen.xy / on_screen.z, 0.0);
    let beam = projector.beam;
    let origin = vec3<f32>(beam.x + beam.y * screen.x, beam.z, beam.w);
    let reach = length(screen - origin);
    var ray: Ray;
    ray.direction_in_display = (screen - origin) / reach;
    ray.start = -reach;
    let m = scene.volume_from_display;
    let v = ray.direction_in_display;
    ray.origin_in_volume = m[0].xyz * screen.x + m[1].xyz * screen.y + m[3].xyz;
    ray.direction_in_volume = m[0].xyz * v.x + m[1].xyz * v.y + m[2].xyz * v.z;
    ray.speed = length(ray.direction_in_volume);
    ray.inverse = select(vec3<f32>(1.0) / ray.direction_in_volume, vec3<f32>(FAR),
        abs(ray.direction_in_volume) < vec3<f32>(PARALLEL));
    return ray;
}

fn is_parallel(ray: Ray, axis: u32) -> bool {
    return abs(ray.direction_in_volume[axis]) < PARALLEL;
}

fn is_forward(ray: Ray, axis: u32) -> bool {
    return ray.direction_in_volume[axis] >= 0.0;
}

fn point_on(ray: Ray, t: f32) -> vec3<f32> {
    return ray.origin_in_volume + ray.direction_in_volume * t;
}

// The part of the ray inside the volume; empty where x >= y.
fn clip_to_volume(ray: Ray) -> vec2<f32> {
    var span = vec2<f32>(ray.start, FAR);
    for (var axis = 0u; axis < 3u; axis++) {
        let origin = ray.origin_in_volume[axis];
        let high = scene.volume[axis];
        if is_parallel(ray, axis) {
            if origin < 0.0 || origin > high {
                return vec2<f32>(FAR, -FAR);
            }
        } else {
            let a = (0.0 - origin) * ray.inverse[axis];
            let b = (high - origin) * ray.inverse[axis];
            span = vec2<f32>(max(span.x, min(a, b)), min(span.y, max(a, b)));
        }
    }
    return span;
}

// Stackless traversal of the octree along neighbour links.

struct Exit {
    t: f32,
    axis: u32,
}

// Edge of a node's voxel in finest voxels.
fn voxel_edge(depth: u32) -> f32 {
    return f32(1u << (scene.atlas.w - depth));
}

fn node_low(node: NodeRecord) -> vec3<f32> {
    return vec3<f32>(node.cell) * (OWN_EDGE * voxel_edge(node.depth));
}

// Where and through which face the ray leaves the node.
fn exit_of(node: NodeRecord, ray: Ray) -> Exit {
    let edge = OWN_EDGE * voxel_edge(node.depth);
    let low = node_low(node);
    var exit = Exit(FAR, 0u);
    for (var axis = 0u; axis < 3u; axis++) {
        if !is_parallel(ray, axis) {
            let face = select(low[axis], low[axis] + edge, is_forward(ray, axis));
            let t = (face - ray.origin_in_volume[axis]) * ray.inverse[axis];
            if t < exit.t {
                exit = Exit(t, axis);
            }
        }
    }
    return exit;
}

// Which child of a node a point belongs to; on a border, the one the ray goes into.
fn octant_of(node: NodeRecord, point: vec3<f32>, ray: Ray) -> u32 {
    let centre = node_low(node) + 0.5 * OWN_EDGE * voxel_edge(node.depth);
    var octant = 0u;
    for (var axis = 0u; axis < 3u; axis++) {
        let is_upper = point[axis] > centre[axis] || (point[axis] == centre[axis] && is_forward(ray, axis));
        octant |= select(0u, 1u << axis, is_upper);
    }
    return octant;
}

// The leaf of the cut at `point`, from the root.
fn leaf_at(point: vec3<f32>, ray: Ray) -> u32 {
    var at = 0u;
    loop {
        let node = nodes[at];
        if node.first_child == NO_NODE {
            return at;
        }
        at = node.first_child + octant_of(node, point, ray);
    }
    return at;
}

// The leaf beyond the face that the ray leaves `node` through, or NO_NODE. Down to the node's own depth the way is
// told by its cell alone, so that it does not depend on where in the tree the link led; below, by the point.
fn leaf_beyond(node: NodeRecord, axis: u32, point: vec3<f32>, ray: Ray) -> u32 {
    let forward = is_forward(ray, axis);
    let links = node.neighbours;
    var at = links[2u * axis + select(0u, 1u, forward)];
    if at == NO_NODE {
        return NO_NODE;
    }
    var cell = node.cell;
    cell[axis] = select(cell[axis] - 1u, cell[axis] + 1u, forward);
    loop {
        let next = nodes[at];
        if next.first_child == NO_NODE {
            return at;
        }
        var octant: u32;
        if next.depth < node.depth {
            let bits = (cell >> vec3<u32>(node.depth - next.depth - 1u)) & vec3<u32>(1u);
            octant = bits.x | (bits.y << 1u) | (bits.z << 2u);
        } else {
            octant = octant_of(next, point, ray) & ~(1u << axis);
            octant |= select(1u << axis, 0u, forward);
        }
        at = next.first_child + octant;
    }
    return NO_NODE;
}

// Averages of the transfer functions over a segment, from tables of f and F = ∫ f.

// A scalar's place in the tables, and the values there: looked up once, used for every mean that ends at it.
struct Located {
    // Position in cells, and the cell.
    u: f32,
    cell: u32,
    // (τ c, τ).
    value: vec4<f32>,
}

fn locate(s: f32) -> Located {
    let entries = scene.tables.x;
    let u = s * f32(entries - 1u);
    let cell = min(u32(u), entries - 2u);
    return Located(u, cell, mix(optics_table[cell].value, optics_table[cell + 1u].value, u - f32(cell)));
}

// Mean of (τ c, τ) between two scalars. Within one table cell f is linear, so the mean is that of the ends; over several
// cells the end pieces are trapezoids and only whole cells use the difference of integrals, kept as the sum of two
// floats: nothing cancels.
fn optics_between(a: Located, b: Located) -> vec4<f32> {
    if a.cell == b.cell {
        return 0.5 * (a.value + b.value);
    }
    var first = a;
    var last = b;
    if b.cell < a.cell {
        first = b;
        last = a;
    }
    let left = (first.value + optics_table[first.cell + 1u].value) * (0.5 * (f32(first.cell + 1u) - first.u));
    let right = (optics_table[last.cell].value + last.value) * (0.5 * (last.u - f32(last.cell)));
    let whole = (optics_table[last.cell].integral - optics_table[first.cell + 1u].integral)
        + (optics_table[last.cell].integral_rest - optics_table[first.cell + 1u].integral_rest);
    return (left + whole + right) / (last.u - first.u);
}

// Whether nothing within scalars [low, high] changes a picture.
fn is_vacant(low: f32, high: f32) -> bool {
    let entries = scene.tables.x;
    let c0 = min(u32(low * f32(entries - 1u)), entries - 2u);
    let c1 = min(u32(high * f32(entries - 1u)), entries - 2u);
    return occupied[c0] == occupied[c1 + 1u];
}

// φ(x) = (1 − e^−x) / x; a series where the difference would cancel.
fn attenuation_mean(x: f32) -> f32 {
    if x < 0.25 {
        return 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0 - x * (1.0 / 720.0)))));
    }
    return (1.0 - exp(-x)) / x;
}

// How many parts a step is cut into, by what a pair of steps tells of its own error.

// A step is cut into this many parts at most.
const MOST_PARTS: f32 = 16.0;
// Steps grow to this many voxels at most.
const LONGEST_STEP: f32 = 1.0;
// Share of what lies within reach of a pair, but not between its ends, that may have been passed by unseen.
const UNSEEN: f32 = 0.25;

// The longest step, in voxels of the node: `shortest` where much may hide between two samples, more where the largest
// optical depth of a voxel, `depth`, keeps what may hide small. Steps of one length (no tolerance) do not grow.
fn step_voxels(depth: f32) -> f32 {
    let shortest = scene.quality.x;
    if scene.quality.w >= 1.0 || depth * shortest >= SAFE_DEPTH {
        return shortest;
    }
    return min(SAFE_DEPTH / max(depth, 1e-30), max(shortest, LONGEST_STEP));
}

// Means of (τ c, τ) over a pair of steps.
struct Pair {
    first: vec4<f32>,
    second: vec4<f32>,
    // Over both steps, taken as one segment.
    both: vec4<f32>,
    // Over all scalars within reach.
    reach: vec4<f32>,
}

fn largest(v: vec4<f32>) -> f32 {
    return max(max(v.x, v.y), max(v.z, v.w));
}

fn pair_of(s0: Located, s1: Located, s2: Located, reach: vec2<f32>) -> Pair {
    return Pair(optics_between(s0, s1), optics_between(s1, s2), optics_between(s0, s2),
        optics_between(locate(reach.x), locate(reach.y)));
}

// Parts of each step of a pair, where a step has `thickness` and `visible` is the opacity that may still be added.
// Three things err: where the scalar bends, `both` differs from the mean of the two steps, and something between the
// samples may not have been seen at all; where colours differ, light taken as if it came from anywhere in a step errs by
// up to the product of both depths; and so does shading. The first falls with the square of the parts.
fn parts_of_step(pair: Pair, thickness: f32, visible: f32) -> f32 {
    let depth = (pair.first.w + pair.second.w) * thickness;
    let order_scale = thickness * thickness / (1.0 + depth * depth);
    let bend = max(abs(pair.first + pair.second - 2.0 * pair.both), abs(pair.reach - pair.both) * UNSEEN);
    let order = abs(pair.first.xyz * pair.second.w - pair.second.xyz * pair.first.w) * order_scale;
    let shaded = pair.first.w * pair.second.w * order_scale * SPREAD;
    let worst = max(largest(bend) * (thickness / (1.0 + depth)), largest(vec4<f32>(order, shaded)));
    return clamp(ceil(sqrt(worst * visible / scene.quality.w)), 1.0, MOST_PARTS);
}

// The scalars that a pair of steps may have met between its samples: the samples' own range, widened by half the larger
// step at both ends, as far as a kink of the trilinear field between two samples goes.
fn scalars_in_reach(s0: f32, s1: f32, s2: f32) -> vec2<f32> {
    let margin = 0.5 * max(abs(s1 - s0), abs(s2 - s1));
    let low = min(min(s0, s1), s2);
    let high = max(max(s0, s1), s2);
    return vec2<f32>(max(low - margin, 0.0), min(high + margin, 1.0));
}

// The stored sample at a point of a brick, interpolated by the texture unit.

@group(0) @binding(6) var trilinear: sampler;

// Points are taken to the nearest 1/4096 texel: with slots at whole texels and an atlas of 2^n texels along each axis, the
// texture coordinate is then exact, so that the same point of a brick gives the same bits from whatever slot it lies in.
const GRID: f32 = 4096.0;

// `origin` is the slot's first texel, `point` in texels of the brick, sample centres at integer + 0.5.
fn sample_atlas(origin: vec3<f32>, point: vec3<f32>) -> f32 {
    let exact = origin + round(point * GRID) / GRID;
    return textureSampleLevel(atlas, trilinear, exact * scene.texel.xyz, 0.0).x;
}

// No shading: a segment shows its own colour.

// How much the shaded colour may vary within a step, for the estimate of a step's error.
const SPREAD: f32 = 0.0;
// Steps may grow while the optical depth of one stays below this.
const SAFE_DEPTH: f32 = 0.04;

fn lighting(origin: vec3<f32>, place: vec3<f32>, gradient_scale: f32, ray: Ray) -> Lighting {
    return Lighting(1.0, 0.0);
}

// Ordinary front-to-back compositing.

struct Accumulated {
    rgb: vec3<f32>,
    alpha: f32,
}

fn nothing_accumulated() -> Accumulated {
    return Accumulated(vec3<f32>(0.0), 0.0);
}

// Whether a segment without extinction changes nothing.
fn is_clear(extinction: f32) -> bool {
    return extinction <= 0.0;
}

// Whether the parts of a step are composited among themselves first: it makes no difference here.
const ONCE_PER_STEP: bool = false;

// A segment's light, premultiplied colour and opacity, over scalars [s0, s1], behind what is in front.
fn composite(front: Accumulated, light: vec4<f32>, s0: f32, s1: f32) -> Accumulated {
    let through = 1.0 - front.alpha;
    return Accumulated(front.rgb + light.xyz * through, front.alpha + light.w * through);
}

// The opacity that what follows may still add.
fn still_to_come(front: Accumulated) -> f32 {
    return 1.0 - front.alpha;
}

// Parts of each step of a pair, by what a rise of importance may have erased unseen: there is none.
fn parts_of_rise(front: Accumulated, range: vec2<f32>) -> f32 {
    return 1.0;
}

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
    let across = scene.atlas.x;
    let layer = scene.atlas.x * scene.atlas.y;
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
    let thickness = scene.quality.z * part;
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
    let longest = step_voxels(node.most_extinction * scene.quality.z * (edge / ray.speed));
    let pairs = max(1.0, ceil(span * ray.speed / (2.0 * longest * edge)));
    let step = 0.5 * span / pairs;
    let thickness = scene.quality.z * step;
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
        if still_to_come(marched.front) < scene.quality.y {
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
    if listed >= projector.extent.x {
        return;
    }
    let tile = tiles[listed];
    let across = projector.raster.w;
    let in_tiles = vec2<u32>(tile % across, tile / across) * TILE_EDGE + local.xy;
    let pixel = in_tiles * projector.raster.z + vec2<u32>(projector.raster.z / 2u);
    if pixel.x >= projector.raster.x || pixel.y >= projector.raster.y {
        return;
    }
    var count = 0u;
    let colour = cast_ray(ray_of_pixel(vec2<f32>(pixel) + 0.5), &count);
    let index = pixel.y * projector.raster.x + pixel.x;
    pixels[index] = colour;
    counts[index] = count;
}
