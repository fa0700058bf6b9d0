// No enhancers.

const CHAIN_NEEDS_GRADIENT: bool = false;

fn chain_spread(t: f32) -> f32 {
    return 0.0;
}

fn start_chain(ray: Ray) {}

fn follow_chain(ray: Ray) {}

fn next_break(t: f32) -> f32 {
    return FAR;
}

fn enhance(sample: Sample, ray: Ray, t: f32, length: f32, s0: f32, s1: f32, gradients: Gradients) -> Sample {
    return sample;
}
