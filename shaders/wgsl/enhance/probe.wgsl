// Context-preserving probe (LFD eq. 4 and 5).
// a: centre, radius; b: axis, strength; c: limits of the alignment, largest gradient; d: limits of the edges.

// Whether it looks at the gradient around t: inside the sphere.
fn probe_looks(breaks: vec3<f32>, t: f32) -> bool {
    return t > breaks.x && t < breaks.z;
}

// x: ω_a.
fn probe_start(link: Link, view: vec3<f32>) -> vec4<f32> {
    return vec4<f32>(smoothstep(link.c.x, link.c.y, max(0.0, dot(link.b.xyz, view))), 0.0, 0.0, 0.0);
}

// Where the ray enters and leaves the sphere, and where it crosses the plane through the centre.
fn probe_breaks(link: Link, weights: vec4<f32>, ray: Ray) -> vec3<f32> {
    let from_centre = ray.origin_in_display - link.a.xyz;
    let nearest = -dot(from_centre, ray.direction_in_display);
    let aside = from_centre + ray.direction_in_display * nearest;
    let square = link.a.w * link.a.w - dot(aside, aside);
    if link.b.w <= 0.0 || square <= 0.0 {
        return vec3<f32>(FAR);
    }
    let half = sqrt(square);
    return vec3<f32>(nearest - half, plane_crossing(ray, chain.view, dot(chain.view, link.a.xyz)), nearest + half);
}

fn probe_at(link: Link, weights: vec4<f32>, sample: Sample, place: Place) -> Sample {
    let from_centre = place.point - link.a.xyz;
    if dot(from_centre, from_centre) >= link.a.w * link.a.w {
        return sample;
    }
    let past = dot(from_centre, place.view);
    let near = 1.0 - (past * past) / (link.a.w * link.a.w);
    let edge = probe_edge(link, weights.x, sample, place);
    var opacity = edge * near;
    var intensity = 1.0 - edge;
    if past >= 0.0 {
        opacity = edge + (1.0 - edge) * (1.0 - near);
        intensity = 1.0 - edge + edge * (1.0 - near);
    }
    let factor = 1.0 + (opacity - 1.0) * link.b.w;
    var changed = scaled(sample, factor);
    changed.brightness *= 1.0 + (intensity - 1.0) * link.b.w;
    return changed;
}

// η: how much of an edge a sample is.
fn probe_edge(link: Link, aligned: f32, sample: Sample, place: Place) -> f32 {
    let square = dot(place.gradient, place.gradient);
    if square < LEAST_SQUARE {
        return 0.0;
    }
    let size = sqrt(square);
    let flat_share = 1.0 - min(abs(dot(place.gradient, place.view)) / size, 1.0);
    let strength = smoothstep(link.d.x, link.d.y, mean_importance(sample) * size / link.c.z);
    return aligned * strength * (flat_share * flat_share) * (flat_share * flat_share);
}
