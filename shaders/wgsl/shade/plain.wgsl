// No shading: a segment shows its own colour.

// Whether it looks at gradients.
const SHADES: bool = false;
// How much the shaded colour may vary within a step, for the estimate of a step's error.
const SHADE_SPREAD: f32 = 0.0;
// Steps may grow while the optical depth of one stays below this.
const SAFE_DEPTH: f32 = 0.04;

fn lighting(gradients: Gradients, ray: Ray, material: vec4<f32>) -> Lighting {
    return Lighting(1.0, 0.0);
}
