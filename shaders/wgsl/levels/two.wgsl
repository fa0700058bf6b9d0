// Samples of the node that a ray is in and of its parent.

// What stays the same on a straight path through one brick. Where the parent has no brick, the node stands for it.
struct Brick {
    own: Level,
    parent: Level,
    weights: Weights,
    // First word of its cells.
    words: u32,
    // Metres per texel along each axis, without sign.
    pace: vec3<f32>,
}

fn brick_of(node: NodeRecord, ray: Ray) -> Brick {
    let own = level_of(node, ray);
    var parent = own;
    var has_parent = false;
    if node.parent != NO_NODE {
        let above = nodes[node.parent];
        if above.slot != NO_SLOT {
            parent = level_of(above, ray);
            has_parent = true;
        }
    }
    return Brick(own, parent, weights_of(node, has_parent), node.slot * CELL_WORDS,
        abs(ray.inverse) * voxel_edge(node.depth));
}

// Whether samples may be of levels above the node's.
fn has_fractions(brick: Brick) -> bool {
    return is_blended(brick.weights);
}

// The fractional level of samples at t: 0 is the node, 1 the parent.
fn fraction_at(brick: Brick, ray: Ray, t: f32) -> f32 {
    if !is_blended(brick.weights) {
        return 0.0;
    }
    return parents_share(brick.weights, brick.own, t);
}

fn scalar_at(brick: Brick, ray: Ray, t: f32) -> f32 {
    let f = fraction_at(brick, ray, t);
    var s: f32;
    if f <= 0.0 {
        s = scalar_in(brick.own, t);
    } else if f < 1.0 {
        let near = scalar_in(brick.own, t);
        s = near + (scalar_in(brick.parent, t) - near) * f;
    } else {
        s = scalar_in(brick.parent, t);
    }
    return clamp(s, 0.0, 1.0);
}
