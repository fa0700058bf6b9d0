// The gradient at the level that the sample itself is filtered at.

struct Gradients {
    at: vec3<f32>,
}

const NO_GRADIENTS: Gradients = Gradients(vec3<f32>(0.0));

fn gradients_halfway(a: Gradients, b: Gradients) -> Gradients {
    return Gradients((a.at + b.at) * 0.5);
}

fn gradients_at(brick: Brick, ray: Ray, t: f32) -> Gradients {
    let f = fraction_at(brick, ray, t);
    if f <= 0.0 {
        return Gradients(gradient_in(brick.own, t));
    }
    let parent = gradient_in(brick.parent, t);
    if f < 1.0 {
        return Gradients(mix(gradient_in(brick.own, t), parent, f));
    }
    if f == 1.0 {
        return Gradients(parent);
    }
    return Gradients(mix(parent, gradient_in(brick.grandparent, t), f - 1.0));
}
