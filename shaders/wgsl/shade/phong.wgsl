// Gradient shading as the law has it.

fn lighting(gradients: Gradients, ray: Ray, material: vec4<f32>) -> Lighting {
    let square = dot(gradients.at, gradients.at);
    if square < LEAST_SQUARE {
        return Lighting(1.0, 0.0);
    }
    let lit = abs(dot(gradients.at, scene.light.xyz)) / sqrt(square);
    return lit_by(gradients.at, square, lit, ray, material);
}
