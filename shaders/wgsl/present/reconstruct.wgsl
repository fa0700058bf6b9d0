// Pixels that were not cast, from those that were and from what was shown before: one pass. The law stands with the
// host's form, backend/renderer/src/present/reconstruct.rs.

@group(0) @binding(BINDING_BEFORE) var<storage, read> before: array<vec4<f32>>;
@group(0) @binding(BINDING_WHOLE) var<storage, read_write> whole: array<vec4<f32>>;

// The neighbours of a pixel, pair by pair, those outside the raster left out.
struct Around {
    places: array<u32, 2 * MOST_PAIRS>,
    count: u32,
    // Where whole pairs begin among these.
    pairs: array<u32, MOST_PAIRS>,
    pair_count: u32,
}

fn around_pixel(pixel: vec2<i32>) -> Around {
    var around: Around;
    for (var i = 0u; i < present.raster.w; i++) {
        let one = pixel + present.steps[i].xy;
        let other = pixel - present.steps[i].xy;
        if is_in_raster(one) && is_in_raster(other) {
            around.pairs[around.pair_count] = around.count;
            around.pair_count++;
        }
        if is_in_raster(one) {
            around.places[around.count] = place_of(one);
            around.count++;
        }
        if is_in_raster(other) {
            around.places[around.count] = place_of(other);
            around.count++;
        }
    }
    return around;
}

// The mean of the opposite pair whose colours differ least; at the rim, where there may be none, of all neighbours.
fn in_space(at: u32, around: ptr<function, Around>) -> vec4<f32> {
    if (*around).count == 0u {
        return picture[at];
    }
    var mean = vec4<f32>(0.0);
    var least = -1.0;
    for (var i = 0u; i < (*around).pair_count; i++) {
        let first = (*around).pairs[i];
        let a = picture[(*around).places[first]];
        let b = picture[(*around).places[first + 1u]];
        let apart = difference(a, b);
        if least < 0.0 || apart < least {
            least = apart;
            mean = 0.5 * (a + b);
        }
    }
    if least >= 0.0 {
        return mean;
    }
    for (var i = 0u; i < (*around).count; i++) {
        mean += picture[(*around).places[i]];
    }
    return mean / f32((*around).count);
}

// What was shown, changed as those around it have changed; what they are where these changes differ much.
fn in_time(at: u32, around: ptr<function, Around>) -> vec4<f32> {
    var sum = vec4<f32>(0.0);
    for (var i = 0u; i < (*around).count; i++) {
        let place = (*around).places[i];
        sum += picture[place] - before[place];
    }
    let typical = sum / f32(max((*around).count, 1u));
    var disorder = 0.0;
    for (var i = 0u; i < (*around).count; i++) {
        let place = (*around).places[i];
        disorder = max(disorder, difference(picture[place] - before[place], typical));
    }
    let was = before[at];
    let temporal = clamp(was + typical, vec4<f32>(0.0), max(was, vec4<f32>(1.0)));
    let s = clamp((disorder - present.numbers.x) / (present.numbers.y - present.numbers.x), 0.0, 1.0);
    let share = s * s * (3.0 - 2.0 * s);
    if share == 0.0 {
        return temporal;
    }
    let spatial = in_space(at, around);
    if share == 1.0 {
        return spatial;
    }
    return temporal + share * (spatial - temporal);
}

fn reconstructed(pixel: vec2<i32>, at: u32) -> vec4<f32> {
    var around = around_pixel(pixel);
    if present.stages.x == 0u {
        return in_space(at, &around);
    }
    // Most of a picture is empty, or stands still.
    var stays = true;
    for (var i = 0u; i < around.count; i++) {
        stays = stays && all(picture[around.places[i]] == before[around.places[i]]);
    }
    if stays {
        return before[at];
    }
    return in_time(at, &around);
}

@compute @workgroup_size(TILE_EDGE, TILE_EDGE, 1)
fn reconstruct_pixel(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    if !is_in_raster(pixel) {
        return;
    }
    let at = place_of(pixel);
    let class_bit = 1u << ((id.x & 1u) + 2u * (id.y & 1u));
    if (present.raster.z & class_bit) == 0u {
        whole[at] = picture[at];
    } else {
        whole[at] = reconstructed(pixel, at);
    }
}
