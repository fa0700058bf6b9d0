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
    let face = select(low, low + edge, are_forward(ray));
    let t = ways_to(face, ray);
    var exit = Exit(FAR, 0u);
    if t.x < exit.t {
        exit = Exit(t.x, 0u);
    }
    if t.y < exit.t {
        exit = Exit(t.y, 1u);
    }
    if t.z < exit.t {
        exit = Exit(t.z, 2u);
    }
    return exit;
}

// Which child of a node a point belongs to; on a border, the one the ray goes into.
fn octant_of(node: NodeRecord, point: vec3<f32>, ray: Ray) -> u32 {
    let centre = node_low(node) + 0.5 * OWN_EDGE * voxel_edge(node.depth);
    let forward = are_forward(ray);
    let upper = (point > centre) | ((point == centre) & forward);
    return select(0u, 1u, upper.x) | select(0u, 2u, upper.y) | select(0u, 4u, upper.z);
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

// The leaf beyond the face that the ray leaves a node through, or NO_NODE. Down to the node's own depth the way
// follows from its cell alone, so that it does not depend on where in the tree the link led; below, from the point.
fn leaf_beyond(index: u32, node: NodeRecord, axis: u32, point: vec3<f32>, ray: Ray) -> u32 {
    let along = vec3<u32>(axis) == vec3<u32>(0u, 1u, 2u);
    let forward = any(along & are_forward(ray));
    var at = nodes[index].neighbours[2u * axis + select(0u, 1u, forward)];
    if at == NO_NODE {
        return NO_NODE;
    }
    let cell = node.cell + select(vec3<u32>(0u), vec3<u32>(select(0xffffffffu, 1u, forward)), along);
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
