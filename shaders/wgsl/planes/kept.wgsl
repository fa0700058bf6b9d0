// What is kept of each column of a layer: a scalar, its spread and its gradients.

@group(0) @binding(BINDING_SAMPLES) var<storage, read_write> plane_samples: array<f32>;

// Words of a sample: the scalar, then what follows.
const SAMPLE_WORDS: u32 = 1u + SPREAD_WORDS + GRADIENT_WORDS;

fn known_scalar(at: u32) -> f32 {
    return plane_samples[SAMPLE_WORDS * at];
}

fn known_spread(at: u32) -> f32 {
    if SPREAD_WORDS == 0u {
        return 0.0;
    }
    return plane_samples[SAMPLE_WORDS * at + SPREAD_WORDS];
}

fn gradient_word(at: u32) -> u32 {
    return SAMPLE_WORDS * at + 1u + SPREAD_WORDS;
}

fn known_vector(word: u32) -> vec3<f32> {
    return vec3<f32>(plane_samples[word], plane_samples[word + 1u], plane_samples[word + 2u]);
}

fn keep_vector(word: u32, vector: vec3<f32>) {
    plane_samples[word] = vector.x;
    plane_samples[word + 1u] = vector.y;
    plane_samples[word + 2u] = vector.z;
}
