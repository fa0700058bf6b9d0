// What enhancers see and change of a sample's importance.

fn mean_importance(sample: Sample) -> f32 {
    return sample.importance.mean;
}

// Moves it toward another by `weight`: the mean, and the values at the ends.
fn with_importance(sample: Sample, mean: f32, ends: vec2<f32>, weight: f32) -> Sample {
    var changed = sample;
    changed.importance.mean += (mean - sample.importance.mean) * weight;
    changed.importance.ends += (ends - sample.importance.ends) * weight;
    return changed;
}
