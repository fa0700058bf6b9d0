// Clip plane with view-dependent context (LFD section 4).
// a: normal, offset; b: limits of the context, thickness, least y; c: strength, offset where y is least.

// x: factor of what is cut away.
fn clip_plane_start(link: Link, view: vec3<f32>) -> vec4<f32> {
    let aside = 1.0 - max(0.0, -dot(link.a.xyz, view));
    let context = smoothstep(link.b.x, link.b.y, aside);
    return vec4<f32>(1.0 + (context - 1.0) * link.c.x, 0.0, 0.0, 0.0);
}

fn clip_plane_breaks(link: Link, weights: vec4<f32>, ray: Ray) -> vec3<f32> {
    if link.c.x <= 0.0 {
        return vec3<f32>(FAR);
    }
    return vec3<f32>(plane_crossing(ray, link.a.xyz, link.a.w), plane_crossing(ray, link.a.xyz, link.a.w - link.b.z),
        plane_crossing(ray, link.a.xyz, link.c.y));
}

fn clip_plane_at(link: Link, weights: vec4<f32>, sample: Sample, place: Place) -> Sample {
    let above = dot(link.a.xyz, place.point) - link.a.w;
    if above > 0.0 {
        return scaled(sample, weights.x);
    }
    if above <= -link.b.z {
        return sample;
    }
    let sliced = link.c.x * smoothstep(-link.b.z, 0.0, above);
    // y at both ends; 1 / (a b) is the mean of 1 / y² between them.
    let reach = dot(link.a.xyz, place.reach);
    let a = clip_plane_edge(link, above - reach);
    let b = clip_plane_edge(link, above + reach);
    var changed = scaled(sample, 1.0 / (a * b) - 2.0 + (a + b));
    changed.lit *= 1.0 - sliced;
    return changed;
}

// y: 1 at the back of the slice, 1 − strength on the plane, held to where the boost is reached.
fn clip_plane_edge(link: Link, above: f32) -> f32 {
    return max(1.0 - link.c.x * clamp(1.0 + above / link.b.z, 0.0, 1.0), link.b.w);
}
