// No debug view: light is light.

fn debug_light(light: vec4<f32>, ray: Ray, t: f32) -> vec4<f32> {
    return light;
}

fn debug_pixel(colour: vec4<f32>, samples: u32) -> vec4<f32> {
    return colour;
}
