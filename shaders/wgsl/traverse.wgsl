// Stackless traversal of the octree along neighbour links.

struct Exit {
    t: f32,
    axis: u32,
}

// Edge of a node's voxel in finest voxels.
fn voxel_edge(depth: u32) -> f32 {
    return f32(1u << (scene.atlas.w - depth));
}

fn node_low(node: NodeRecord) -> vec3<f32> {
    return vec3<f32>(node.cell) * (OWN_EDGE * voxel_edge(node.depth));
}

// Where and through which face the ray leaves the node.
fn exit_of(node: NodeRecord, ray: Ray) -> Exit {
    let edge = OWN_EDGE * voxel_edge(node.depth);
    let low = node_low(node);
    var exit = Exit(FAR, 0u);
    for (var axis = 0u; axis < 3u; axis++) {
        if !is_parallel(ray, axis) {
            let face = select(low[axis], low[axis] + edge, is_forward(ray, axis));
            let t = (face - ray.origin_in_volume[axis]) * ray.inverse[axis];
            if t < exit.t {
                exit = Exit(t, axis);
            }
        }
    }
    return exit;
}

// Which child of a node a point belongs to; on a border, the one the ray goes into.
fn octant_of(node: NodeRecord, point: vec3<f32>, ray: Ray) -> u32 {
    let centre = node_low(node) + 0.5 * OWN_EDGE * voxel_edge(node.depth);
    var octant = 0u;
    for (var axis = 0u; axis < 3u; axis++) {
        let is_upper = point[axis] > centre[axis] || (point[axis] == centre[axis] && is_forward(ray, axis));
        octant |= select(0u, 1u << axis, is_upper);
    }
    return octant;
}

// The leaf of the cut at `point`, from the root.
fn leaf_at(point: vec3<f32>, ray: Ray) -> u32 {
    var at = 0u;
    loop {
        let node = nodes[at];
        if node.first_child == NO_NODE {
            return at;
        }
        at = node.first_child + octant_of(node, point, ray);
    }
    return at;
}

// The leaf beyond the face that the ray leaves `node` through, or NO_NODE. Down to the node's own depth the way is
// told by its cell alone, so that it does not depend on where in the tree the link led; below, by the point.
fn leaf_beyond(node: NodeRecord, axis: u32, point: vec3<f32>, ray: Ray) -> u32 {
    let forward = is_forward(ray, axis);
    let links = node.neighbours;
    var at = links[2u * axis + select(0u, 1u, forward)];
    if at == NO_NODE {
        return NO_NODE;
    }
    var cell = node.cell;
    cell[axis] = select(cell[axis] - 1u, cell[axis] + 1u, forward);
    loop {
        let next = nodes[at];
        if next.first_child == NO_NODE {
            return at;
        }
        var octant: u32;
        if next.depth < node.depth {
            let bits = (cell >> vec3<u32>(node.depth - next.depth - 1u)) & vec3<u32>(1u);
            octant = bits.x | (bits.y << 1u) | (bits.z << 2u);
        } else {
            octant = octant_of(next, point, ray) & ~(1u << axis);
            octant |= select(1u << axis, 0u, forward);
        }
        at = next.first_child + octant;
    }
    return NO_NODE;
}
