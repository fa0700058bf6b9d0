// Pixels of all views: what lies between layers is shifted to where each ray meets it, and what it cannot tell the ray samples
// itself.

@group(0) @binding(BINDING_OPEN) var<storage, read_write> open_blocks: array<atomic<u32>>;

@group(0) @binding(BINDING_ERRORS) var<storage, read> block_errors: array<u32>;

// What a view's pixel meets at a depth: between a column of a layer's and the next, this share of the way.
struct Meeting {
    column: f32,
    part: f32,
}

fn meeting(layer: PlaneLayer, pixel: u32, z: f32) -> Meeting {
    let place = layer.phases * (f32(pixel) + 0.5 + shift_of(projector.beam.x, z)) - 0.5;
    let column = floor(place);
    return Meeting(column - f32(layer.first), place - column);
}

// Whether a layer has both of the columns.
fn is_met(layer: PlaneLayer, met: Meeting) -> bool {
    return met.column >= 0.0 && met.column + 1.0 < f32(layer.width);
}

// What is wrong in a cell, at most, where the pixels of a block meet it, the first of which is `pixel`: a code, the same for all
// of them, so that they go on alike.
fn error_of_block(layer: PlaneLayer, row_at: u32, pixel: u32) -> u32 {
    let columns = columns_of_block(layer);
    let met = columns_met(layer, pixel);
    let first = max(i32(met.x), 0);
    let last = min(i32(met.y + f32(columns) - layer.phases) + 1, i32(layer.width) - 1);
    var code = EMPTY;
    if first <= last {
        for (var block = u32(first) / columns; block <= u32(last) / columns; block++) {
            code = max(code, block_errors[row_at + layer.block_at + block]);
        }
    }
    return code;
}

// Whether so large an error shows where so much is still seen.
fn is_too_large(code: u32, visible: f32) -> bool {
    return code != EMPTY && error_of_code(code) * visible > fan.grid.most_mean_error;
}

@compute @workgroup_size(TILE_EDGE, TILE_EDGE, 1)
fn sweep(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_id) local: vec3<u32>) {
    let place = group.x + group.y * groups.x;
    if place >= listed[0] {
        return;
    }
    let tile = tile_at(place);
    projector = views[tile.view];
    let row_of_tiles = tile.number / projector.raster.z;
    var number = 0u;
    while number + 1u < fan.grid.bands && bands[number].at != row_of_tiles {
        number++;
    }
    let band = bands[number];
    let pixel = pixel_of(tile, local.xy);
    if !is_in_raster(pixel) {
        return;
    }
    let index = index_of(pixel);
    let ray = ray_of_pixel(vec2<f32>(pixel) + 0.5);
    let span = clip_to_volume(ray);
    start_chain(ray);
    follow_chain(ray);
    let band_row = ((number * TILE_EDGE + local.y) * fan.grid.views + tile.view) * fan.grid.blocks;
    let place_in_bands = band_row * TILE_EDGE + pixel.x;
    var front = nothing_accumulated();
    var count = 0u;
    if fan.grid.sweeps > 0u {
        front = front_at(index, place_in_bands);
        count = counts[index];
    }
    let per_depth = 1.0 / ray.direction_in_display.z;
    let row_at = band.first_column + local.y * band.columns;
    let blocks_at = band.first_block + local.y * band.blocks;
    let first_pixel = pixel.x - local.x;
    var is_open = span.x < span.y && still_to_come(front) >= scene.quality.y;
    var i = band.first_layer;
    let last = band.first_layer + band.layers;
    while is_open && i < last {
        // Cells that means tell, up to one that they do not: in a loop of its own, as a driver in software runs through all that a
        // loop has for every cell.
        var stretch = vec2<f32>(0.0);
        var most_visible = 1.0;
        while is_open && i < last && stretch.x == stretch.y {
            let layer = plane_layers[i];
            i++;
            let code = error_of_block(layer, blocks_at, first_pixel);
            let from_t = max(layer.z.x * per_depth, span.x);
            let to_t = min(layer.z.y * per_depth, span.y);
            if layer.has_cell == 0u || code == EMPTY || from_t >= to_t {
                continue;
            }
            // Rounded up, so that neighbours seldom differ in what they go on with.
            most_visible = exp2(ceil(log2(still_to_come(front))));
            let span = vec2<f32>(from_t, to_t);
            if is_too_large(code, most_visible) || !add_cell(layer, row_at + layer.at, pixel.x, ray, span, &front) {
                stretch = span;
                continue;
            }
            is_open = still_to_come(front) >= scene.quality.y;
        }
        // As far as they go on to tell too little. The next slab begins where one ends, or there is nothing between the two.
        var goes_on = stretch.x < stretch.y;
        while goes_on && i < last {
            let next = plane_layers[i];
            let has_cell = next.has_cell != 0u;
            let is_steep = is_too_large(error_of_block(next, blocks_at, first_pixel), most_visible);
            goes_on = !has_cell || (is_steep && next.z.x * per_depth <= stretch.y);
            if goes_on {
                i++;
                if has_cell {
                    stretch.y = min(next.z.y * per_depth, span.y);
                }
            }
        }
        if stretch.x < stretch.y {
            follow(ray, stretch, &front, &count);
            is_open = still_to_come(front) >= scene.quality.y;
        }
    }
    keep_front(index, place_in_bands, front);
    counts[index] = count;
    if is_open {
        atomicStore(&open_blocks[band_row + pixel.x / TILE_EDGE], fan.grid.sweeps + 1u);
    }
}
