// Debug views of nodes: light in the colour of the node that it comes from, as opaque as it is. The composer tells
// DEBUG_SHOWS, one of the three below, and the ends of the scales, DEBUG_LEAST, DEBUG_MOST and DEBUG_LOW, DEBUG_HIGH.

const DEBUG_LOD: u32 = 0u;
const DEBUG_DEFICIT: u32 = 1u;
const DEBUG_WEIGHTS: u32 = 2u;

// Share of the node's own samples at a point, between its eight corners.
fn debug_weight(node: NodeRecord, point: vec3<f32>) -> f32 {
    let place = clamp((point - node_low(node)) / (OWN_EDGE * voxel_edge(node.depth)), vec3<f32>(0.0), vec3<f32>(1.0));
    let low = unpack4x8unorm(node.weights[0]);
    let high = unpack4x8unorm(node.weights[1]);
    let face = mix(low, high, place.z);
    let edge = mix(face.xy, face.zw, place.y);
    return mix(edge.x, edge.y, place.x);
}

fn debug_value(node: NodeRecord, point: vec3<f32>) -> f32 {
    switch DEBUG_SHOWS {
        case DEBUG_LOD: {
            return f32(scene.atlas.w - node.depth);
        }
        case DEBUG_DEFICIT: {
            return node.deficit;
        }
        default: {
            return debug_weight(node, point);
        }
    }
}

fn debug_light(light: vec4<f32>, ray: Ray, t: f32) -> vec4<f32> {
    let point = point_on(ray, t);
    // From the root, so that nothing has to be carried along the ray for this.
    let value = debug_value(nodes[leaf_at(point, ray)], point);
    let share = clamp((value - DEBUG_LEAST) / (DEBUG_MOST - DEBUG_LEAST), 0.0, 1.0);
    return vec4<f32>(heat(mix(DEBUG_LOW, DEBUG_HIGH, share)) * light.w, light.w);
}

fn debug_pixel(colour: vec4<f32>, samples: u32) -> vec4<f32> {
    return colour;
}
