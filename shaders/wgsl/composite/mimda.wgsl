// What both forms of Maximum Importance Difference Accumulation share.

struct Accumulated {
    rgb: vec3<f32>,
    alpha: f32,
    importance: f32,
}

fn nothing_accumulated() -> Accumulated {
    return Accumulated(vec3<f32>(0.0), 0.0, 0.0);
}

// Importance acts whatever the extinction: no segment is clear.
fn is_clear(extinction: f32) -> bool {
    return false;
}

// The opacity that what follows may still add, when the largest importance is yet to come.
fn still_to_come(front: Accumulated) -> f32 {
    return 1.0 - kept(front.importance, max(scene.mimda.y, front.importance)) * front.alpha;
}
