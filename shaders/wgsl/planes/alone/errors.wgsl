// Each pixel takes what lies between samples through the rays' own code: only scalars between them may be wrong.

// The most that enhancers multiply an extinction by, block by block of each band.
@group(0) @binding(BINDING_FACTORS) var<storage, read> factors: array<f32>;

fn factor_at(place: PlanePlace, column: u32) -> f32 {
    // Those of a band's rows are alike.
    let blocks_before = place.band.first_block / TILE_EDGE + place.layer.block_at;
    return factors[blocks_before + column / columns_of_block(place.layer)];
}

fn error_between(place: PlanePlace, column: u32, corners: vec4<f32>, spread: f32) -> f32 {
    return 0.0;
}
