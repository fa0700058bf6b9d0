// Gradient shading: two-sided Phong, weighted by the strength of the gradient.

// How much the shaded colour may vary within a step, for the estimate of a step's error.
const SPREAD: f32 = 0.1;
// Steps may grow while the optical depth of one stays below this.
const SAFE_DEPTH: f32 = 0.01;

// `place` in texels of the brick whose first texel is `origin`; `gradient_scale` turns a difference over two texels into a change of the scalar per
// finest voxel.
fn lighting(origin: vec3<f32>, place: vec3<f32>, gradient_scale: f32, ray: Ray) -> Lighting {
    let difference = vec3<f32>(
        sample_atlas(origin, place + vec3<f32>(1.0, 0.0, 0.0)) - sample_atlas(origin, place - vec3<f32>(1.0, 0.0, 0.0)),
        sample_atlas(origin, place + vec3<f32>(0.0, 1.0, 0.0)) - sample_atlas(origin, place - vec3<f32>(0.0, 1.0, 0.0)),
        sample_atlas(origin, place + vec3<f32>(0.0, 0.0, 1.0)) - sample_atlas(origin, place - vec3<f32>(0.0, 0.0, 1.0)));
    let in_volume = difference * gradient_scale;
    let m = params.volume_from_display;
    let gradient = vec3<f32>(dot(m[0].xyz, in_volume), dot(m[1].xyz, in_volume), dot(m[2].xyz, in_volume))
        * params.volume.w;
    let square = dot(gradient, gradient);
    if square < 1e-30 {
        return Lighting(1.0, 0.0);
    }
    let weight = square / (square + params.light.w);
    let normal = gradient / sqrt(square);
    let diffuse = abs(dot(normal, params.light.xyz));
    let halfway = params.light.xyz - ray.direction_in_display;
    let halfway_square = dot(halfway, halfway);
    var specular = 0.0;
    if halfway_square > 1e-12 {
        let cosine = min(abs(dot(normal, halfway)) / sqrt(halfway_square), 1.0);
        if cosine > 0.0 {
            specular = pow(cosine, params.material.w);
        }
    }
    let body = 1.0 - weight + weight * (params.material.x + params.material.y * diffuse);
    return Lighting(body, weight * params.material.z * specular);
}
