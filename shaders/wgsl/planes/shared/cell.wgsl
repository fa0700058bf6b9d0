// A pixel takes what the means of a cell show, between a column and the next.

// The first columns of which a pixel meets anything.
fn columns_met(layer: PlaneLayer, pixel: u32) -> vec2<f32> {
    return vec2<f32>(meeting(layer, pixel, 0.5 * (layer.z.x + layer.z.y)).column);
}

// Adds what lies on a span of the ray, in a cell whose columns are kept from `at` on. Whether they tell enough of it.
fn add_cell(layer: PlaneLayer, at: u32, pixel: u32, ray: Ray, span: vec2<f32>, front: ptr<function, Accumulated>) -> bool {
    let met = meeting(layer, pixel, 0.5 * (layer.z.x + layer.z.y));
    if !is_met(layer, met) {
        return true;
    }
    let column = at + u32(met.column);
    let mean = mix(known_mean(column), known_mean(column + 1u), met.part);
    // Metres of the ray per metre of depth, as far as it is in the volume.
    let length = (span.y - span.x) / (layer.z.x - layer.z.y);
    let depth = mean.w * length;
    if depth > 0.0 {
        let visible = still_to_come(*front);
        let lit = mean.xyz + mean.w * highlight_between(column, met.part, ray);
        let share = attenuation_mean(depth) * length;
        *front = Accumulated((*front).rgb + lit * (share * visible), (*front).alpha + mean.w * share * visible);
    }
    return true;
}
