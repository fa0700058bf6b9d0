// No enhancers.

fn chain_looks(t: f32) -> bool {
    return false;
}

fn start_chain(ray: Ray) {}

fn follow_chain(ray: Ray) {}

fn next_break(t: f32) -> f32 {
    return FAR;
}

fn enhance(sample: Sample, ray: Ray, t: f32, length: f32, s0: f32, s1: f32, gradients: Gradients) -> Sample {
    return sample;
}
