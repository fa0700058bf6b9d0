// What both forms of Maximum Importance Difference Accumulation share.

struct Accumulated {
    rgb: vec3<f32>,
    alpha: f32,
    importance: f32,
}

// What a segment shows.
struct Sample {
    // Mean (τ c, τ).
    k: vec4<f32>,
    // Share of the shading that acts on it, and factor of the light that it emits.
    lit: f32,
    brightness: f32,
    importance: Importance,
}

fn nothing_accumulated() -> Accumulated {
    return Accumulated(vec3<f32>(0.0), 0.0, 0.0);
}

// What a segment between the places of two scalars shows, whose mean (τ c, τ) is `k`.
fn sample_of(k: vec4<f32>, a: TablePlace, b: TablePlace) -> Sample {
    return Sample(k, 1.0, 1.0, importance_between(a, b));
}

// Importance acts whatever the extinction: no segment is clear.
fn is_clear(extinction: f32) -> bool {
    return false;
}

// The opacity that what follows may still add, when the largest importance is yet to come.
fn still_to_come(front: Accumulated) -> f32 {
    return 1.0 - kept(front.importance, max(scene.mimda.y, front.importance)) * front.alpha;
}
