// Samples of the node that a ray is in, of its parent and of its grandparent.

// What stays the same on a straight way through one brick. Where an ancestor has no brick, the level below stands for it.
struct Brick {
    own: Level,
    parent: Level,
    grandparent: Level,
    weights: Weights,
    // First word of its cells.
    words: u32,
    // Metres per texel along each axis, without sign.
    pace: vec3<f32>,
    // Levels between the node and the finest.
    above_finest: f32,
    // Levels that there are above the node, 0 to 2.
    coarsest: f32,
}

fn brick_of(node: NodeRecord, ray: Ray) -> Brick {
    var brick: Brick;
    brick.own = level_of(node, ray);
    brick.parent = brick.own;
    brick.grandparent = brick.own;
    brick.words = node.slot * CELL_WORDS;
    brick.pace = abs(ray.inverse) * voxel_edge(node.depth);
    brick.above_finest = f32(scene.atlas.w - node.depth);
    brick.coarsest = 0.0;
    if node.parent != NO_NODE {
        let parent = nodes[node.parent];
        if parent.slot != NO_SLOT {
            brick.parent = level_of(parent, ray);
            brick.grandparent = brick.parent;
            brick.coarsest = 1.0;
            if parent.parent != NO_NODE {
                let grandparent = nodes[parent.parent];
                if grandparent.slot != NO_SLOT {
                    brick.grandparent = level_of(grandparent, ray);
                    brick.coarsest = 2.0;
                }
            }
        }
    }
    brick.weights = weights_of(node, brick.coarsest > 0.0);
    return brick;
}

// Whether samples may be of levels above the node's.
fn has_fractions(brick: Brick) -> bool {
    return (FILTERS_LEVELS && brick.coarsest > 0.0) || is_blended(brick.weights);
}

// The fractional level of samples at t, 0 is the node, 1 the parent, 2 the grandparent: the one that they are filtered at,
// or the parent's share by the node's corners where that is more.
fn fraction_at(brick: Brick, ray: Ray, t: f32) -> f32 {
    var f = 0.0;
    if FILTERS_LEVELS {
        let z = ray.origin_in_display.z + ray.direction_in_display.z * t;
        let wanted = log2(max(scene.resolution.x + scene.resolution.y * abs(z), 1e-30)) - brick.above_finest;
        f = clamp(wanted, 0.0, brick.coarsest);
    }
    if is_blended(brick.weights) {
        f = max(f, parents_share(brick.weights, brick.own, t));
    }
    return f;
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
        if f > 1.0 {
            s += (scalar_in(brick.grandparent, t) - s) * (f - 1.0);
        }
    }
    return clamp(s, 0.0, 1.0);
}
