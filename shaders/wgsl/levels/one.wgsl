// Samples of the node that a ray is in.

// What stays the same on a straight path through one brick.
struct Brick {
    own: Level,
    weights: Weights,
    // First word of its cells.
    words: u32,
    // Metres per texel along each axis, without sign.
    pace: vec3<f32>,
}

fn brick_of(node: NodeRecord, ray: Ray) -> Brick {
    return Brick(level_of(node, ray), weights_of(node, false), node.slot * CELL_WORDS,
        abs(ray.inverse) * voxel_edge(node.depth));
}

// Whether samples may be of levels above the node's.
fn has_fractions(brick: Brick) -> bool {
    return false;
}

fn fraction_at(brick: Brick, ray: Ray, t: f32) -> f32 {
    return 0.0;
}

fn scalar_at(brick: Brick, ray: Ray, t: f32) -> f32 {
    return clamp(scalar_in(brick.own, t), 0.0, 1.0);
}
