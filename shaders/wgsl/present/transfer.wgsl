// The codes for a light, by rounding or by dither; see backend/renderer/src/present/finish/transfer.rs and dither.rs.

@group(0) @binding(BINDING_CURVES) var<storage, read> curves: array<f32>;

// How many of a channel's edges a light reaches.
fn edges_up_to(channel: u32, light: f32) -> u32 {
    let first = channel * CURVE_NUMBERS;
    var low = 0u;
    var high = CODES - 1u;
    while low < high {
        let middle = (low + high) / 2u;
        if curves[first + middle] <= light {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

// A pixel's threshold, between 0 and 1.
fn dither_threshold(pixel: vec2<u32>) -> f32 {
    var rank = 0u;
    for (var bit = 0u; bit < DITHER_BITS; bit++) {
        let x = pixel.x >> bit & 1u;
        let y = pixel.y >> bit & 1u;
        rank = 4u * rank + 2u * (x ^ y) + y;
    }
    return (f32(rank) + 0.5) / f32(1u << (2u * DITHER_BITS));
}

fn code_of(channel: u32, light: f32, pixel: vec2<u32>) -> u32 {
    let below = edges_up_to(channel, light);
    if (present.stages.y & IS_DITHERED) == 0u || below == CODES - 1u {
        return below;
    }
    let lights = channel * CURVE_NUMBERS + CODES - 1u;
    let low = curves[lights + below];
    let above = curves[lights + below + 1u];
    return below + select(0u, 1u, light - low > dither_threshold(pixel) * (above - low));
}
