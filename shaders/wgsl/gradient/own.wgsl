// The gradient at the level that the sample itself is filtered at, where that is the node's own.

struct Gradients {
    at: vec3<f32>,
}

const NO_GRADIENTS: Gradients = Gradients(vec3<f32>(0.0));

fn gradients_halfway(a: Gradients, b: Gradients) -> Gradients {
    return Gradients((a.at + b.at) * 0.5);
}

fn gradients_at(brick: Brick, ray: Ray, t: f32) -> Gradients {
    return Gradients(gradient_in(brick.own, t));
}
