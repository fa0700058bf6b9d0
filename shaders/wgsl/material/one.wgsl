// One material for all scalars: ambient, diffuse, specular, shininess.

fn material_at(s: f32) -> vec4<f32> {
    return scene.material;
}
