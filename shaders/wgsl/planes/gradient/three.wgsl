// The gradients at three levels are kept with each sample.

const GRADIENT_WORDS: u32 = 9u;

// Those where a ray begins.
fn keep_gradients(at: u32, brick: Brick, ray: Ray) {
    let gradients = gradients_at(brick, ray, 0.0);
    let word = gradient_word(at);
    keep_vector(word, gradients.at);
    keep_vector(word + 3u, gradients.coarse);
    keep_vector(word + 6u, gradients.coarsest);
}

fn known_gradients(at: u32) -> Gradients {
    let word = gradient_word(at);
    return Gradients(known_vector(word), known_vector(word + 3u), known_vector(word + 6u));
}

fn gradients_between(a: Gradients, b: Gradients, share: f32) -> Gradients {
    return Gradients(mix(a.at, b.at, share), mix(a.coarse, b.coarse, share), mix(a.coarsest, b.coarsest, share));
}
