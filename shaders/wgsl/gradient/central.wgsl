// The gradient of one level, by central differences.

// Shorter gradients (squared) have no direction.
const LEAST_SQUARE: f32 = 1e-30;

// Of the scalar per finest voxel's edge, display frame.
fn gradient_in(level: Level, t: f32) -> vec3<f32> {
    let in_volume = differences(level.origin, point_in(level, t)) * level.gradient_scale;
    let m = scene.volume_from_display;
    return vec3<f32>(dot(m[0].xyz, in_volume), dot(m[1].xyz, in_volume), dot(m[2].xyz, in_volume)) * scene.volume.w;
}
