// No shading: a segment shows its own colour.

// How much the shaded colour may vary within a step, for the estimate of a step's error.
const SPREAD: f32 = 0.0;
// Steps may grow while the optical depth of one stays below this.
const SAFE_DEPTH: f32 = 0.04;

fn lighting(origin: vec3<f32>, place: vec3<f32>, gradient_scale: f32, ray: Ray) -> Lighting {
    return Lighting(1.0, 0.0);
}
