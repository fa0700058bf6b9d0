// What a pixel of a projector sees of the picture that was drawn; see backend/renderer/src/present/finish/warp.rs.

@group(0) @binding(BINDING_PLACES) var<storage, read> places: array<vec2<f32>>;

// Catmull and Rom's weights of the four pixels around a place, which lies t beyond the second of them.
fn cubic_weights(t: f32) -> vec4<f32> {
    return vec4<f32>(
        t * (t * (1.0 - 0.5 * t) - 0.5),
        t * t * (1.5 * t - 2.5) + 1.0,
        t * (t * (2.0 - 1.5 * t) + 0.5),
        t * t * (0.5 * t - 0.5),
    );
}

// Black where the pixel sees none of the picture.
fn warped_colour(at: u32) -> vec3<f32> {
    let place = places[at];
    if place.x == NOWHERE {
        return vec3<f32>(0.0);
    }
    let first = floor(place);
    let across = cubic_weights(place.x - first.x);
    let down = cubic_weights(place.y - first.y);
    let last = vec2<i32>(present.raster.xy) - 1;
    var sum = vec3<f32>(0.0);
    for (var j = 0; j < 4; j++) {
        for (var i = 0; i < 4; i++) {
            let pixel = clamp(vec2<i32>(first) + vec2<i32>(i, j) - 1, vec2<i32>(0), last);
            sum += down[j] * across[i] * picture[place_of(pixel)].rgb;
        }
    }
    return sum;
}
