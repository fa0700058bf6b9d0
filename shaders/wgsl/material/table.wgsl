// A material for each scalar: ambient, diffuse, specular, shininess.

@group(0) @binding(BINDING_MATERIALS) var<storage, read> material_table: array<TableEntry>;

fn locate_material(s: f32) -> Located {
    let place = place_of(s);
    return Located(place, mix(material_table[place.node].value, material_table[place.node + 1u].value, place.part));
}

// Mean between two places, as of the optics.
fn materials_between(a: Located, b: Located) -> vec4<f32> {
    if a.place.node == b.place.node {
        return 0.5 * (a.value + b.value);
    }
    let ends = in_rising_order(a, b);
    return mean_over(ends.first, material_table[ends.first.place.node + 1u], material_table[ends.last.place.node], ends.last);
}

// Mean between two scalars.
fn material_between(s0: f32, s1: f32) -> vec4<f32> {
    return materials_between(locate_material(s0), locate_material(s1));
}

// Mean over both steps of a pair.
fn material_of_pair(s0: f32, s1: f32, s2: f32) -> vec4<f32> {
    let middle = locate_material(s1);
    let before = materials_between(locate_material(s0), middle);
    let after = materials_between(middle, locate_material(s2));
    return 0.5 * (before + after);
}
