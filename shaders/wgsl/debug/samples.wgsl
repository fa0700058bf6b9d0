// The debug view of samples: how many a ray took, instead of its colour. The composer defines DEBUG_MOST.

fn debug_light(light: vec4<f32>, ray: Ray, t: f32) -> vec4<f32> {
    return light;
}

fn debug_pixel(colour: vec4<f32>, samples: u32) -> vec4<f32> {
    return vec4<f32>(heat(min(log2(1.0 + f32(samples)) / log2(1.0 + DEBUG_MOST), 1.0)), 1.0);
}
