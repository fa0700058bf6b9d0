// Gradients are kept with samples, and those of cells with means: the highlight depends on who looks.

const GRADIENT_WORDS: u32 = 3u;

// The gradient where a ray begins.
fn keep_gradient(at: u32, brick: Brick, ray: Ray) {
    let gradient = gradients_at(brick, ray, 0.0).at;
    let word = SAMPLE_WORDS * at + 1u + SPREAD_WORDS;
    plane_samples[word] = gradient.x;
    plane_samples[word + 1u] = gradient.y;
    plane_samples[word + 2u] = gradient.z;
}

fn known_gradient(at: u32) -> vec3<f32> {
    let word = SAMPLE_WORDS * at + 1u + SPREAD_WORDS;
    return vec3<f32>(plane_samples[word], plane_samples[word + 1u], plane_samples[word + 2u]);
}

// The gradient of a cell between two samples.
fn cell_gradient(front: u32, behind: u32) -> vec3<f32> {
    return 0.5 * (known_gradient(front) + known_gradient(behind));
}

fn keep_cell_gradient(at: u32, gradient: vec3<f32>) {
    let word = MEAN_WORDS * at + 4u;
    plane_means[word] = gradient.x;
    plane_means[word + 1u] = gradient.y;
    plane_means[word + 2u] = gradient.z;
}

// What light makes of colours, but for the highlight: who looks makes no difference.
fn body_of(gradient: vec3<f32>, ray: Ray) -> f32 {
    return lighting(Gradients(gradient), ray, scene.material).body;
}

// The highlight between a cell's column and the next, as a share of the extinction.
fn highlight_between(at: u32, part: f32, ray: Ray) -> f32 {
    let a = MEAN_WORDS * at + 4u;
    let b = a + MEAN_WORDS;
    let near = vec3<f32>(plane_means[a], plane_means[a + 1u], plane_means[a + 2u]);
    let far = vec3<f32>(plane_means[b], plane_means[b + 1u], plane_means[b + 2u]);
    return lighting(Gradients(mix(near, far, part)), ray, scene.material).highlight;
}
