// The mean of what lies between a column and the next layer is kept for all views.

@group(0) @binding(BINDING_MEANS) var<storage, read_write> plane_means: array<f32>;

const MEAN_WORDS: u32 = 4u + GRADIENT_WORDS;

// (τ c, τ) of a cell, lit but for the highlight.
fn known_mean(at: u32) -> vec4<f32> {
    let word = MEAN_WORDS * at;
    return vec4<f32>(plane_means[word], plane_means[word + 1u], plane_means[word + 2u], plane_means[word + 3u]);
}

fn keep_mean(at: u32, mean: vec4<f32>) {
    let word = MEAN_WORDS * at;
    plane_means[word] = mean.x;
    plane_means[word + 1u] = mean.y;
    plane_means[word + 2u] = mean.z;
    plane_means[word + 3u] = mean.w;
}
