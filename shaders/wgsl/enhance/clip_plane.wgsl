// Clip plane with view-dependent context (LFD section 4).
// a: normal, offset; b: limits of the context, thickness, boost; c.x: strength.

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
    return vec3<f32>(plane_crossing(ray, link.a.xyz, link.a.w), plane_crossing(ray, link.a.xyz, link.a.w - link.b.z), FAR);
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
    var changed = scaled(sample, 1.0 + (link.b.w - 1.0) * sliced);
    changed.lit *= 1.0 - sliced;
    return changed;
}
