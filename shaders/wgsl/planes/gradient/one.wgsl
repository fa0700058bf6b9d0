// The gradient is kept with each sample.

const GRADIENT_WORDS: u32 = 3u;

// Those where a ray begins.
fn keep_gradients(at: u32, brick: Brick, ray: Ray) {
    keep_vector(gradient_word(at), gradients_at(brick, ray, 0.0).at);
}

fn known_gradients(at: u32) -> Gradients {
    return Gradients(known_vector(gradient_word(at)));
}

fn gradients_between(a: Gradients, b: Gradients, share: f32) -> Gradients {
    return Gradients(mix(a.at, b.at, share));
}
