// Layer opacity by view direction (LFD section 4).
// a: corners of the layer's band; b.xyz: axis; c: limits of the alignment, factors away from it and toward it.

// x: μ − 1.
fn layer_opacity_start(link: Link, view: vec3<f32>) -> vec4<f32> {
    let aligned = smoothstep(link.c.x, link.c.y, dot(link.b.xyz, view));
    return vec4<f32>(link.c.z + (link.c.w - link.c.z) * aligned - 1.0, 0.0, 0.0, 0.0);
}

fn layer_opacity_breaks(link: Link, weights: vec4<f32>, ray: Ray) -> vec3<f32> {
    return vec3<f32>(FAR);
}

fn layer_opacity_at(link: Link, weights: vec4<f32>, sample: Sample, place: Place) -> Sample {
    return scaled(sample, 1.0 + band_between(link.a, place.s0, place.s1) * weights.x);
}
