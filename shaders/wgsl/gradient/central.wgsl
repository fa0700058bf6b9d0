// The gradient of one level, by central differences.

// Shorter gradients (squared) have no direction.
const LEAST_SQUARE: f32 = 1e-30;

// Of the scalar per finest voxel's edge, display frame.
fn gradient_in(level: Level, t: f32) -> vec3<f32> {
    let place = point_in(level, t);
    let origin = level.origin;
    let difference = vec3<f32>(
        sample_atlas(origin, place + vec3<f32>(1.0, 0.0, 0.0)) - sample_atlas(origin, place - vec3<f32>(1.0, 0.0, 0.0)),
        sample_atlas(origin, place + vec3<f32>(0.0, 1.0, 0.0)) - sample_atlas(origin, place - vec3<f32>(0.0, 1.0, 0.0)),
        sample_atlas(origin, place + vec3<f32>(0.0, 0.0, 1.0)) - sample_atlas(origin, place - vec3<f32>(0.0, 0.0, 1.0)));
    let in_volume = difference * level.gradient_scale;
    let m = scene.volume_from_display;
    return vec3<f32>(dot(m[0].xyz, in_volume), dot(m[1].xyz, in_volume), dot(m[2].xyz, in_volume)) * scene.volume.w;
}
