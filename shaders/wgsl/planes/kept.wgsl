// What is kept of each column of a layer: a scalar, its spread and its gradient, and the mean of what lies between it and the
// next layer.

@group(0) @binding(BINDING_SAMPLES) var<storage, read_write> plane_samples: array<f32>;
@group(0) @binding(BINDING_MEANS) var<storage, read_write> plane_means: array<f32>;

// Words of a sample: the scalar, then what follows.
const SAMPLE_WORDS: u32 = 1u + SPREAD_WORDS + GRADIENT_WORDS;
const MEAN_WORDS: u32 = 4u + GRADIENT_WORDS;

fn known_scalar(at: u32) -> f32 {
    return plane_samples[SAMPLE_WORDS * at];
}

fn known_spread(at: u32) -> f32 {
    if SPREAD_WORDS == 0u {
        return 0.0;
    }
    return plane_samples[SAMPLE_WORDS * at + SPREAD_WORDS];
}

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
