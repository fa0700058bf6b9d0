// Samples stand for themselves alone.

fn spread_at(brick: Brick, ray: Ray, t: f32) -> f32 {
    return 0.0;
}

fn sample_over(a: Located, b: Located, s0: f32, s1: f32, spread: f32) -> Sample {
    return sample_of(optics_between(a, b), a.place, b.place);
}
