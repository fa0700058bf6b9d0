// No gradient is kept.

const GRADIENT_WORDS: u32 = 0u;

fn keep_gradients(at: u32, brick: Brick, ray: Ray) {
}

fn known_gradients(at: u32) -> Gradients {
    return NO_GRADIENTS;
}

fn gradients_between(a: Gradients, b: Gradients, share: f32) -> Gradients {
    return NO_GRADIENTS;
}
