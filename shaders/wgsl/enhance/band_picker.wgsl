// View-dependent band picker (LFD section 4).
// a: corners of the band; b: axis, strength; c: limits of the alignment.

// x: weight of the change.
fn band_picker_start(link: Link, view: vec3<f32>) -> vec4<f32> {
    let aligned = smoothstep(link.c.x, link.c.y, max(0.0, dot(link.b.xyz, view)));
    return vec4<f32>(link.b.w * aligned, 0.0, 0.0, 0.0);
}

fn band_picker_breaks(link: Link, weights: vec4<f32>, ray: Ray) -> vec3<f32> {
    return vec3<f32>(FAR);
}

fn band_picker_at(link: Link, weights: vec4<f32>, sample: Sample, place: Place) -> Sample {
    let picked = band_between(link.a, place.s0, place.s1);
    let changed = scaled(sample, 1.0 - weights.x * (1.0 - picked));
    return with_importance(changed, picked, band_most(link.a, place.s0, place.s1), weights.x);
}
