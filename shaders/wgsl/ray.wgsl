// The ray of a projector pixel (LFD eq. 1), seen from the volume.

struct Ray {
    // Where the ray meets the screen; t = 0 there, and t counts metres from the viewer toward the screen.
    origin_in_volume: vec3<f32>,
    // Voxels per metre.
    direction_in_volume: vec3<f32>,
    // Metres per voxel along each axis; FAR along an axis that the ray is parallel to.
    inverse: vec3<f32>,
    // The same place, metres, and the direction, a unit vector.
    origin_in_display: vec3<f32>,
    direction_in_display: vec3<f32>,
    // t of the ray's start on the observer's line.
    start: f32,
    // t of its end, beyond which nothing is looked at.
    end: f32,
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
    ray.origin_in_display = screen;
    ray.start = -reach;
    ray.end = FAR;
    let m = scene.volume_from_display;
    ray.origin_in_volume = m[0].xyz * screen.x + m[1].xyz * screen.y + m[3].xyz;
    return turned(ray, (screen - origin) / reach);
}

// A ray from the same origin along another unit vector.
fn turned(from_ray: Ray, direction_in_display: vec3<f32>) -> Ray {
    let m = scene.volume_from_display;
    let v = direction_in_display;
    var ray = from_ray;
    ray.direction_in_display = v;
    ray.direction_in_volume = m[0].xyz * v.x + m[1].xyz * v.y + m[2].xyz * v.z;
    ray.speed = length(ray.direction_in_volume);
    ray.inverse = select(vec3<f32>(1.0) / ray.direction_in_volume, vec3<f32>(FAR),
        abs(ray.direction_in_volume) < vec3<f32>(PARALLEL));
    return ray;
}

// Whether it is along each axis. All axes at once: a vector that is indexed by a variable lies in memory.
fn are_parallel(ray: Ray) -> vec3<bool> {
    return abs(ray.direction_in_volume) < vec3<f32>(PARALLEL);
}

// Whether it goes forward along each axis.
fn are_forward(ray: Ray) -> vec3<bool> {
    return ray.direction_in_volume >= vec3<f32>(0.0);
}

fn point_on(ray: Ray, t: f32) -> vec3<f32> {
    return ray.origin_in_volume + ray.direction_in_volume * t;
}

fn point_in_display(ray: Ray, t: f32) -> vec3<f32> {
    return ray.origin_in_display + ray.direction_in_display * t;
}

// t at which the ray meets a face across each axis; FAR along an axis that it is parallel to.
fn ways_to(faces: vec3<f32>, ray: Ray) -> vec3<f32> {
    return select((faces - ray.origin_in_volume) * ray.inverse, vec3<f32>(FAR), are_parallel(ray));
}

// The part of the ray inside the volume; empty if x >= y.
fn clip_to_volume(ray: Ray) -> vec2<f32> {
    let origin = ray.origin_in_volume;
    let high = scene.volume.xyz;
    let parallel = are_parallel(ray);
    if any(parallel & ((origin < vec3<f32>(0.0)) | (origin > high))) {
        return vec2<f32>(FAR, -FAR);
    }
    let forward = are_forward(ray);
    let enter = select(ways_to(select(high, vec3<f32>(0.0), forward), ray), vec3<f32>(-FAR), parallel);
    let leave = ways_to(select(vec3<f32>(0.0), high, forward), ray);
    return vec2<f32>(max(max(ray.start, enter.x), max(enter.y, enter.z)), min(min(ray.end, leave.x), min(leave.y, leave.z)));
}
