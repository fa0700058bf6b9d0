// Where a scene gives no importance, or no link needs it, all samples are equally important.

fn mean_importance(sample: Sample) -> f32 {
    return 1.0;
}

fn with_importance(sample: Sample, mean: f32, most: f32, weight: f32) -> Sample {
    return sample;
}
