// The spread of the node that a ray is in and of its parent, blended as their samples are.

fn spread_at(brick: Brick, ray: Ray, t: f32) -> f32 {
    let f = fraction_at(brick, ray, t);
    if f <= 0.0 {
        return spread_in(brick.own, t);
    }
    let parent = spread_in(brick.parent, t);
    if f >= 1.0 {
        return parent;
    }
    let own = spread_in(brick.own, t);
    return own + (parent - own) * f;
}
