// What enhancers see and change of a sample's importance.

fn mean_importance(sample: Sample) -> f32 {
    return sample.importance.mean;
}

// Moves it toward another by `weight`. The largest value is then a bound, reached where both are largest together.
fn with_importance(sample: Sample, mean: f32, most: f32, weight: f32) -> Sample {
    var changed = sample;
    changed.importance.mean += (mean - sample.importance.mean) * weight;
    changed.importance.most += (most - sample.importance.most) * weight;
    return changed;
}
