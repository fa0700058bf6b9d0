// A node's share of its own samples, by the weights of its corners (LOD section 4.3); the parent has the rest.

struct Weights {
    // Of the corners with low z and with high z; x + 2 y within each.
    low: vec4<f32>,
    high: vec4<f32>,
    // Whether the parent has any share. A node of which it has none is sampled as if there were no weights.
    is_blended: bool,
}

fn weights_of(node: NodeRecord, has_parent: bool) -> Weights {
    let words = vec2<u32>(node.weights[0], node.weights[1]);
    let is_full = all(words == vec2<u32>(0xffffffffu));
    return Weights(unpack4x8unorm(words.x), unpack4x8unorm(words.y), has_parent && !is_full);
}

fn is_blended(weights: Weights) -> bool {
    return weights.is_blended;
}

// The parent's share at t on the way that `own` lies on, of a blended node.
fn parents_share(weights: Weights, own: Level, t: f32) -> f32 {
    // A bent path may lead out of the node by a step, where the weights stay what they are on its face.
    let place = clamp((point_in(own, t) - OVERLAP) / OWN_EDGE, vec3<f32>(0.0), vec3<f32>(1.0));
    let along_z = weights.low + (weights.high - weights.low) * place.z;
    let along_y = along_z.xy + (along_z.zw - along_z.xy) * place.y;
    return 1.0 - (along_y.x + (along_y.y - along_y.x) * place.x);
}
