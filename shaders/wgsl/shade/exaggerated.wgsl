// Exaggerated shading: each level is lit along the surface of the next coarser one.

fn lighting(gradients: Gradients, ray: Ray, material: vec4<f32>) -> Lighting {
    let square = dot(gradients.at, gradients.at);
    if square < LEAST_SQUARE {
        return Lighting(1.0, 0.0);
    }
    let n0 = outward(gradients.at);
    let n1 = outward(gradients.coarse);
    let n2 = outward(gradients.coarsest);
    let levels = 0.5 * raked(n0, n1) + 0.3 * raked(n1, n2) + 0.2 * dot(n2, scene.light.xyz);
    let lit = clamp(0.5 + 0.5 * levels, 0.0, 1.0);
    return lit_by(gradients.at, square, lit, ray, material);
}

// Unit vector toward lower values; zero where there is none.
fn outward(gradient: vec3<f32>) -> vec3<f32> {
    let square = dot(gradient, gradient);
    if square < LEAST_SQUARE {
        return vec3<f32>(0.0);
    }
    return gradient * (-1.0 / sqrt(square));
}

// The light that rakes over the coarser surface, on the finer one.
fn raked(fine: vec3<f32>, coarse: vec3<f32>) -> f32 {
    let light = scene.light.xyz;
    if dot(coarse, coarse) == 0.0 {
        return 0.0;
    }
    let along = light - coarse * dot(coarse, light);
    return clamp(scene.resolution.z * dot(fine, along) / sqrt(dot(along, along) + 0.01), -1.0, 1.0);
}
