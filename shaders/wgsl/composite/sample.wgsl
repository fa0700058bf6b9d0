// What a segment shows, with its importance.

struct Sample {
    // Mean (τ c, τ).
    k: vec4<f32>,
    // Share of the shading that acts on it, and factor of the light that it emits.
    lit: f32,
    brightness: f32,
    importance: Importance,
}

// What a segment between the places of two scalars shows, whose mean (τ c, τ) is `k`.
fn sample_of(k: vec4<f32>, a: TablePlace, b: TablePlace) -> Sample {
    return Sample(k, 1.0, 1.0, importance_between(a, b));
}
