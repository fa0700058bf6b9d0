// Gradients of cells are kept with their means: the highlight depends on who looks.

fn keep_cell_gradient(at: u32, gradients: Gradients) {
    let word = MEAN_WORDS * at + 4u;
    plane_means[word] = gradients.at.x;
    plane_means[word + 1u] = gradients.at.y;
    plane_means[word + 2u] = gradients.at.z;
}

// What light makes of colours, but for the highlight: who looks makes no difference.
fn body_of(gradients: Gradients, ray: Ray) -> f32 {
    return lighting(gradients, ray, scene.material).body;
}

// The highlight between a cell's column and the next, as a share of the extinction.
fn highlight_between(at: u32, part: f32, ray: Ray) -> f32 {
    let a = MEAN_WORDS * at + 4u;
    let b = a + MEAN_WORDS;
    let near = vec3<f32>(plane_means[a], plane_means[a + 1u], plane_means[a + 2u]);
    let far = vec3<f32>(plane_means[b], plane_means[b + 1u], plane_means[b + 2u]);
    return lighting(Gradients(mix(near, far, part)), ray, scene.material).highlight;
}
