// The path of a bent ray: straight ways, and what turns one into the next.

@group(0) @binding(BINDING_INDEX) var<storage, read> index_table: array<f32>;

// A pair that still changes it by more than this is taken as a surface: Snell's law, and a mirror beyond the critical
// angle. Over smaller changes the ray equation is followed: ν v changes by ∇ν times the way.
const SURFACE: f32 = 0.02;
// Ways straight on are measured from a new origin after this many voxels, so that no step is lost to rounding.
const LONGEST_STRAIGHT: f32 = 1024.0;
// Difference quotients over less than this many table cells are replaced by the slope of the cell.
const LEAST_CELLS: f32 = 0.5;

// The refraction index at a scalar.
fn index_at(s: f32) -> f32 {
    let place = place_of(s);
    return mix(index_table[place.node], index_table[place.node + 1u], place.part);
}

// Its mean slope between two scalars. A surface has none, nor has a piece of the table that is as steep as one: they are
// met by crossing them.
fn index_slope(s0: f32, s1: f32) -> f32 {
    let cells = f32(scene.tables.x);
    if abs(s1 - s0) * cells >= LEAST_CELLS {
        return (index_at(s1) - index_at(s0)) / (s1 - s0);
    }
    let node = place_of(0.5 * (s0 + s1)).node;
    let width = optics_table[node + 1u].position - optics_table[node].position;
    let change = index_table[node + 1u] - index_table[node];
    if abs(change) > SURFACE || width <= 0.0 {
        return 0.0;
    }
    return change * cells / width;
}

// Whether the index may change between two scalars.
fn bends(s0: f32, s1: f32) -> bool {
    return index_at(s0) != index_at(s1) || index_slope(s0, s1) != 0.0;
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

// From where a ray from the eye enters the volume.
fn entering(eye_ray: Ray, t: f32) -> Bent {
    var bent: Bent;
    bent.ray = turned_at(eye_ray, t, eye_ray.direction_in_display);
    bent.t = 0.0;
    bent.way = 0.0;
    bent.is_passing = false;
    return bent;
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
