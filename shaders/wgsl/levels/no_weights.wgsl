// Nodes do not blend into their parents.

struct Weights {
    none: f32,
}

fn weights_of(node: NodeRecord, has_parent: bool) -> Weights {
    return Weights(0.0);
}

fn is_blended(weights: Weights) -> bool {
    return false;
}

fn parents_share(weights: Weights, own: Level, t: f32) -> f32 {
    return 0.0;
}
