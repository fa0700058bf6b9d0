// A material for each scalar: ambient, diffuse, specular, shininess.

@group(0) @binding(BINDING_MATERIALS) var<storage, read> material_table: array<TableEntry>;

fn material_of(place: TablePlace) -> vec4<f32> {
    return mix(material_table[place.node].value, material_table[place.node + 1u].value, place.part);
}

// Mean between two scalars, as of the optics.
fn material_between(s0: f32, s1: f32) -> vec4<f32> {
    var low = place_of(s0);
    var high = place_of(s1);
    if high.node < low.node {
        let other = low;
        low = high;
        high = other;
    }
    let first = material_of(low);
    let last = material_of(high);
    if low.node == high.node {
        return 0.5 * (first + last);
    }
    let after = low.node + 1u;
    let before = high.node;
    let left = (first + material_table[after].value) * (0.5 * (material_table[after].position - low.u));
    let right = (material_table[before].value + last) * (0.5 * (high.u - material_table[before].position));
    let whole = (material_table[before].integral - material_table[after].integral)
        + (material_table[before].integral_rest - material_table[after].integral_rest);
    return (left + whole + right) / (high.u - low.u);
}
