// What the links of a chain of enhancers share.

// An enhancer's constants: each packs them in its own way.
struct Link {
    a: vec4<f32>,
    b: vec4<f32>,
    c: vec4<f32>,
    d: vec4<f32>,
}

@group(0) @binding(BINDING_LINKS) var<uniform> links: array<Link, MOST_LINKS>;

// An enhancer's state along one ray.
struct LinkState {
    // What it made of the ray's direction.
    weights: vec4<f32>,
    // Where on the ray its law is not smooth; FAR if nowhere.
    breaks: vec3<f32>,
}

// Where the segment lies that enhancers change.
struct Place {
    // Middle of the segment, metres, display frame.
    point: vec3<f32>,
    // From there to the end of the segment.
    reach: vec3<f32>,
    // Of the scalar there, per finest voxel, display frame.
    gradient: vec3<f32>,
    // At the segment's ends.
    s0: f32,
    s1: f32,
    // The direction in which the ray left the eye.
    view: vec3<f32>,
}

// k and τ of a sample, scaled.
fn scaled(sample: Sample, factor: f32) -> Sample {
    var changed = sample;
    changed.k = sample.k * factor;
    return changed;
}

// The first break beyond t.
fn first_beyond(breaks: vec3<f32>, t: f32) -> f32 {
    let ahead = select(vec3<f32>(FAR), breaks, breaks > vec3<f32>(t));
    return min(ahead.x, min(ahead.y, ahead.z));
}

// t where dot(normal, point) = offset along the ray.
fn plane_crossing(ray: Ray, normal: vec3<f32>, offset: f32) -> f32 {
    let speed = dot(normal, ray.direction_in_display);
    if abs(speed) < PARALLEL {
        return FAR;
    }
    return (offset - dot(normal, ray.origin_in_display)) / speed;
}
