// The shading law: two-sided Phong, weighted by the strength of the gradient.

// Whether it looks at gradients.
const SHADES: bool = true;
// Steps may grow while the optical depth of one stays below this.
const SAFE_DEPTH: f32 = 0.01;
// How much the shaded colour may vary within a step, for the estimate of a step's error.
const SHADE_SPREAD: f32 = 0.1;

// The light on a gradient of length sqrt(square) > 0, of which the share `lit` is scattered.
fn lit_by(gradient: vec3<f32>, square: f32, lit: f32, ray: Ray, material: vec4<f32>) -> Lighting {
    let weight = square / (square + scene.light.w);
    let halfway = scene.light.xyz - ray.direction_in_display;
    let halfway_square = dot(halfway, halfway);
    var specular = 0.0;
    if halfway_square > 1e-12 {
        let cosine = min(abs(dot(gradient, halfway)) / sqrt(square) / sqrt(halfway_square), 1.0);
        if cosine > 0.0 {
            specular = pow(cosine, material.w);
        }
    }
    let body = 1.0 - weight + weight * (material.x + material.y * lit);
    return Lighting(body, weight * material.z * specular);
}
