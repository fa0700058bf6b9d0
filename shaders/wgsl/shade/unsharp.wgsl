// Normal unsharp masking: the gradient's difference from a coarser level's is added to it.

fn lighting(gradients: Gradients, ray: Ray, material: vec4<f32>) -> Lighting {
    let gradient = gradients.at + scene.resolution.z * (gradients.at - gradients.coarse);
    let square = dot(gradient, gradient);
    if square < LEAST_SQUARE {
        return Lighting(1.0, 0.0);
    }
    let lit = abs(dot(gradient, scene.light.xyz)) / sqrt(square);
    return lit_by(gradient, square, lit, ray, material);
}
