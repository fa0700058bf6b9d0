// One level of detail around a ray: where a brick's samples lie on it.

struct Level {
    // First texel in the atlas.
    origin: vec3<f32>,
    // A point t metres along the ray lies at base + slope t, in texels of the brick.
    base: vec3<f32>,
    slope: vec3<f32>,
    // Turns a difference over two texels into a change of the scalar per finest voxel.
    gradient_scale: f32,
    offset: f32,
    scale: f32,
    // Standard deviation of code 255; 0 where samples stand for themselves.
    deviation_scale: f32,
}

fn slot_origin(slot: u32) -> vec3<f32> {
    let across = scene.atlas.x;
    let layer = scene.atlas.x * scene.atlas.y;
    return vec3<f32>(vec3<u32>(slot % across, (slot % layer) / across, slot / layer) * BRICK_EDGE);
}

fn level_of(node: NodeRecord, ray: Ray) -> Level {
    let edge = voxel_edge(node.depth);
    var level: Level;
    level.origin = slot_origin(node.slot);
    level.base = (ray.origin_in_volume - node_low(node)) / edge + OVERLAP;
    level.slope = ray.direction_in_volume / edge;
    level.gradient_scale = 0.5 * node.scale / edge;
    level.offset = node.offset;
    level.scale = node.scale;
    level.deviation_scale = node.deviation_scale;
    return level;
}

// The point at t, in texels of the brick.
fn point_in(level: Level, t: f32) -> vec3<f32> {
    return level.base + level.slope * t;
}

fn scalar_in(level: Level, t: f32) -> f32 {
    return level.offset + level.scale * sample_atlas(level.origin, point_in(level, t));
}
