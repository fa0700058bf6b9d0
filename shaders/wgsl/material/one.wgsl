// One material for all scalars: ambient, diffuse, specular, shininess.

fn material_between(s0: f32, s1: f32) -> vec4<f32> {
    return scene.material;
}

fn material_of_pair(s0: f32, s1: f32, s2: f32) -> vec4<f32> {
    return scene.material;
}
