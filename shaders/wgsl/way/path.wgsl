// The path of a bent ray: straight ways, and what turns one into the next.

@group(0) @binding(BINDING_INDEX) var<storage, read> index_table: array<IndexEntry>;

// What a pair of steps may turn a ray wrongly, radians per unit of the tolerance. Where the gradient of the index changes by
// g over a way, a pair of length l, turned in its middle, errs by g l² / 8 if that happens within the pair.
const TURN_ERROR: f32 = 3.0;
// A pair that still changes it by more than this is taken as a surface: Snell's law, and a mirror beyond the critical
// angle. Over smaller changes the ray equation is followed: ν v changes by ∇ν times the way.
const SURFACE: f32 = 0.02;
// Ways straight on are measured from a new origin after this many voxels, so that no step is lost to rounding.
const LONGEST_STRAIGHT: f32 = 1024.0;
// No scalar is known yet.
const UNKNOWN_SIDE: u32 = 0xffffffffu;
// What rounding may leave of the difference of two indices, in units of their sum.
const INDEX_ROUNDING: f32 = 2.5e-7;

// The side of the jumps of ν that a scalar lies on: how many of them lie at or below.
fn side_of(s: f32) -> u32 {
    return index_table[place_of(s).node].jumps;
}

// The node above the next jump, up or down from a side; that below is the one before.
fn node_above_jump(side: u32, is_up: bool) -> u32 {
    let most = select(side - 1u, side, is_up);
    var low = 0u;
    var high = arrayLength(&index_table);
    while low < high {
        let middle = (low + high) / 2u;
        if index_table[middle].jumps <= most {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

// ν at a scalar, seen from a side; beyond the jumps around it, it goes on with its value there.
fn index_at(side: u32, s: f32) -> f32 {
    let place = place_of(s);
    let jumps = index_table[place.node].jumps;
    if jumps != side {
        let is_up = jumps > side;
        return index_table[node_above_jump(side, is_up) - select(0u, 1u, is_up)].value;
    }
    return mix(index_table[place.node].value, index_table[place.node + 1u].value, place.part);
}

// Its mean slope between two scalars, where no jump lies: what the table says where that explains the change, for a small
// difference has no digits.
fn index_slope(side: u32, s0: f32, s1: f32) -> f32 {
    let n0 = index_at(side, s0);
    let n1 = index_at(side, s1);
    let entry = index_table[place_of(0.5 * (s0 + s1)).node];
    let listed = entry.slope * f32(scene.tables.x);
    if entry.jumps == side && abs(n1 - n0 - listed * (s1 - s0)) <= INDEX_ROUNDING * (n0 + n1) {
        return listed;
    }
    if s1 == s0 {
        return 0.0;
    }
    return (n1 - n0) / (s1 - s0);
}

// Whether the index may change between two scalars.
fn bends(side: u32, s0: f32, s1: f32) -> bool {
    return index_at(side, s0) != index_at(side, s1) || index_slope(side, s0, s1) != 0.0;
}

// A jump of ν, as it is met from one side: the scalar where it is, ν before and beyond, and the side beyond.
struct Surface {
    at: f32,
    index: f32,
    index_beyond: f32,
    beyond: u32,
}

// The first jump on the way from a side to another.
fn surface_between(side: u32, other: u32) -> Surface {
    let is_up = other > side;
    let above = node_above_jump(side, is_up);
    let own = index_table[select(above, above - 1u, is_up)];
    let next = index_table[select(above - 1u, above, is_up)];
    return Surface(optics_table[above].position / f32(scene.tables.x), own.value, next.value, next.jumps);
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
    // The gradient of the index at the last turn, per finest voxel, display frame, and metres since then.
    force: vec3<f32>,
    since: f32,
    // The side of the jumps of ν that it is on; UNKNOWN_SIDE before the first sample.
    side: u32,
    // Surfaces in a row that were met at once.
    met_at_once: u32,
}

// From where a ray from the eye enters the volume.
fn entering(eye_ray: Ray, t: f32) -> Bent {
    var bent: Bent;
    bent.ray = turned_at(eye_ray, t, eye_ray.direction_in_display);
    bent.t = 0.0;
    bent.way = 0.0;
    bent.is_passing = false;
    bent.force = vec3<f32>(0.0);
    bent.since = 0.0;
    bent.side = UNKNOWN_SIDE;
    bent.met_at_once = 0u;
    return bent;
}

// Whether a pair of steps of `step` metres, with `force` in its middle, turns the ray as closely as it has to.
fn is_smooth(bent: Bent, force: vec3<f32>, step: f32) -> bool {
    let change = length(force - bent.force) / (step + bent.since);
    return 0.5 * change * step * step <= TURN_ERROR * scene.quality.w * scene.volume.w;
}

// Turns the ray in the middle of a pair of steps, where the gradient of the scalar (per finest voxel) is `gradient` and
// the pair, straight on, would go from s0 to s2 over `length` metres. The direction, unit vector.
fn direction_beyond(bent: ptr<function, Bent>, gradient: vec3<f32>, s0: f32, s2: f32, length: f32) -> vec3<f32> {
    let v = (*bent).ray.direction_in_display;
    let n0 = index_at((*bent).side, s0);
    let n2 = index_at((*bent).side, s2);
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
        return normalize(v * (0.5 * (n0 + n2)) + gradient * (index_slope((*bent).side, s0, s2) * length / scene.volume.w));
    }
    // From the index that the direction belongs to, so that the turns of a steep rise add up to Snell's law.
    let beyond = refracted(v, gradient, own, n2);
    if !any(beyond != vec3<f32>(0.0)) {
        return mirrored(v, gradient);
    }
    (*bent).is_passing = true;
    (*bent).index_before = n0;
    (*bent).index_beyond = n2;
    return beyond;
}

// The direction beyond a surface, where the gradient of the scalar is `gradient`.
fn direction_through(bent: ptr<function, Bent>, surface: Surface, gradient: vec3<f32>) -> vec3<f32> {
    let v = (*bent).ray.direction_in_display;
    var beyond = v;
    if dot(gradient, gradient) >= LEAST_SQUARE {
        beyond = refracted(v, gradient, surface.index, surface.index_beyond);
        if !any(beyond != vec3<f32>(0.0)) {
            return mirrored(v, gradient);
        }
    }
    (*bent).side = surface.beyond;
    return beyond;
}

// The normal of a surface with this gradient, along the direction v, and its cosine with it.
fn normal_along(v: vec3<f32>, gradient: vec3<f32>) -> vec4<f32> {
    let normal = gradient / length(gradient);
    let towards = dot(normal, v);
    return select(vec4<f32>(-normal, -towards), vec4<f32>(normal, towards), towards >= 0.0);
}

// Snell's law; 0 beyond the critical angle.
fn refracted(v: vec3<f32>, gradient: vec3<f32>, index: f32, index_beyond: f32) -> vec3<f32> {
    let normal = normal_along(v, gradient);
    let along = index * normal.w;
    let beyond = along * along + index_beyond * index_beyond - index * index;
    if beyond < 0.0 {
        return vec3<f32>(0.0);
    }
    return normalize(v * index + normal.xyz * (sqrt(beyond) - along));
}

fn mirrored(v: vec3<f32>, gradient: vec3<f32>) -> vec3<f32> {
    let normal = normal_along(v, gradient);
    return normalize(v - normal.xyz * (2.0 * normal.w));
}

// The same ray, turned at t.
fn turned_at(ray: Ray, t: f32, direction_in_display: vec3<f32>) -> Ray {
    var next = ray;
    next.origin_in_volume = point_on(ray, t);
    next.origin_in_display = point_in_display(ray, t);
    return turned(next, direction_in_display);
}
