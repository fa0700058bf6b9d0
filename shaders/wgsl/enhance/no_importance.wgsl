// Without importance accumulation all samples are equally important to enhancers.

fn mean_importance(sample: Sample) -> f32 {
    return 1.0;
}

fn with_importance(sample: Sample, mean: f32, ends: vec2<f32>, weight: f32) -> Sample {
    return sample;
}
