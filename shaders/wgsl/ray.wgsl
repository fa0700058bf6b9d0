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

fn is_parallel(ray: Ray, axis: u32) -> bool {
    return abs(ray.direction_in_volume[axis]) < PARALLEL;
}

fn is_forward(ray: Ray, axis: u32) -> bool {
    return ray.direction_in_volume[axis] >= 0.0;
}

fn point_on(ray: Ray, t: f32) -> vec3<f32> {
    return ray.origin_in_volume + ray.direction_in_volume * t;
}

fn point_in_display(ray: Ray, t: f32) -> vec3<f32> {
    return ray.origin_in_display + ray.direction_in_display * t;
}

// The part of the ray inside the volume; empty if x >= y.
fn clip_to_volume(ray: Ray) -> vec2<f32> {
    var span = vec2<f32>(ray.start, ray.end);
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
