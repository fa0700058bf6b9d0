// A material for each scalar: ambient, diffuse, specular, shininess.

@group(0) @binding(BINDING_MATERIALS) var<storage, read> material_table: array<vec4<f32>>;

fn material_at(s: f32) -> vec4<f32> {
    let entries = scene.tables.x;
    let u = s * f32(entries - 1u);
    let cell = min(u32(u), entries - 2u);
    return mix(material_table[cell], material_table[cell + 1u], u - f32(cell));
}
