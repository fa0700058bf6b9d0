// No gradient is needed.

struct Gradients {
    none: f32,
}

const NO_GRADIENTS: Gradients = Gradients(0.0);

fn gradients_halfway(a: Gradients, b: Gradients) -> Gradients {
    return NO_GRADIENTS;
}

fn gradients_at(brick: Brick, ray: Ray, t: f32) -> Gradients {
    return NO_GRADIENTS;
}
