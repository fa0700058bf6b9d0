// The spread of the node that a ray is in.

fn spread_at(brick: Brick, ray: Ray, t: f32) -> f32 {
    return spread_in(brick.own, t);
}
