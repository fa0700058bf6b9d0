// The gradients at the level that the sample itself is filtered at, and one and two levels above it.

struct Gradients {
    at: vec3<f32>,
    coarse: vec3<f32>,
    coarsest: vec3<f32>,
}

const NO_GRADIENTS: Gradients = Gradients(vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(0.0));

fn gradients_halfway(a: Gradients, b: Gradients) -> Gradients {
    return Gradients((a.at + b.at) * 0.5, (a.coarse + b.coarse) * 0.5, (a.coarsest + b.coarsest) * 0.5);
}

fn gradients_at(brick: Brick, ray: Ray, t: f32) -> Gradients {
    let f = fraction_at(brick, ray, t);
    let own = gradient_in(brick.own, t);
    let parent = gradient_in(brick.parent, t);
    let grandparent = gradient_in(brick.grandparent, t);
    return Gradients(between_levels(own, parent, grandparent, f), between_levels(own, parent, grandparent, f + 1.0),
        grandparent);
}

// Where an ancestor is missing, the level below stands for it: so what lies above the coarsest is the coarsest.
fn between_levels(own: vec3<f32>, parent: vec3<f32>, grandparent: vec3<f32>, f: f32) -> vec3<f32> {
    return mix(mix(own, parent, clamp(f, 0.0, 1.0)), grandparent, clamp(f - 1.0, 0.0, 1.0));
}
