// What is wrong between a column and the next, where what lies there is made of samples: how far scalars bend between these, and
// what is made of them says what else.

// How much (τ c, τ) and importance vary up to each border of the tables' cells.
struct PlaneVariation {
    // Of the channel that varies most.
    most: f32,
    // Of importance.
    importance: f32,
    padding: array<f32, 2>,
    // Of each.
    each: vec4<f32>,
    // (τ c, τ) there.
    value: vec4<f32>,
}

// What is wrong in each block, at most: a code.
@group(0) @binding(BINDING_ERRORS) var<storage, read_write> block_errors: array<atomic<u32>>;
@group(0) @binding(BINDING_VARIATION) var<storage, read> variation: array<PlaneVariation>;

struct Borders {
    low: u32,
    high: u32,
}

// The borders of cells around scalars, and `around` them.
fn borders_of(low: f32, high: f32, around: f32) -> Borders {
    let cells = scene.tables.x;
    return Borders(min(u32(max(low - around, 0.0) * f32(cells)), cells - 1u),
        min(u32(min(high + around, 1.0) * f32(cells)) + 1u, cells));
}

// How much light changes, and what importance erases of it, if scalars within a range are wrong by `error`.
fn spacing_error(place: PlanePlace, column: u32, low: f32, high: f32, error: f32) -> f32 {
    let borders = borders_of(low, high, error);
    let from_border = variation[borders.low];
    let to_border = variation[borders.high];
    let most = thickness_of(place.layer) * factor_at(place, column) * (to_border.most - from_border.most);
    let share = 2.0 * error * f32(scene.tables.x) / f32(borders.high - borders.low);
    return max(most, scene.mimda.x * (to_border.importance - from_border.importance)) * min(share, 1.0);
}

// Whether there is a cell behind the next layer.
fn has_cell_behind(place: PlanePlace) -> bool {
    return plane_layers[place.band.first_layer + place.number_of_layer + 1u].has_cell != 0u;
}

// How far the middle one of three scalars is from straight between the others; 0 where not all are known.
fn bend(a: f32, b: f32, c: f32) -> f32 {
    return select(0.0, abs(a - 2.0 * b + c), min(min(a, b), c) >= 0.0);
}

// The scalars of four columns, from the one before a column on, at the depth that is kept at `at`; its layer has so many.
fn four_scalars(at: u32, column: u32, width: u32) -> vec4<f32> {
    var four = vec4<f32>(UNKNOWN, known_scalar(at), UNKNOWN, UNKNOWN);
    if column > 0u {
        four.x = known_scalar(at - 1u);
    }
    if column + 1u < width {
        four.z = known_scalar(at + 1u);
    }
    if column + 2u < width {
        four.w = known_scalar(at + 2u);
    }
    return four;
}

// The code of what is wrong between a column and the next.
fn error_at(place: PlanePlace, column: u32) -> u32 {
    let width = place.layer.width;
    let at = kept_at(place, column);
    let front = four_scalars(at, column, width);
    let back = four_scalars(at + width, column, width);
    let corners = vec4<f32>(front.yz, back.yz);
    let are_known = corners >= vec4<f32>(0.0);
    let known = select(vec4<f32>(2.0), corners, are_known);
    let lowest = min(min(known.x, known.y), min(known.z, known.w));
    let highest = largest(corners);
    if highest < 0.0 {
        return EMPTY;
    }
    let spreads = vec4<f32>(known_spread(at), known_spread(at + 1u), known_spread(at + width), known_spread(at + width + 1u));
    let spread = largest(select(vec4<f32>(0.0), spreads, are_known));
    // How far a scalar between samples may be off.
    let across = max(max(bend(front.x, front.y, front.z), bend(front.y, front.z, front.w)),
        max(bend(back.x, back.y, back.z), bend(back.y, back.z, back.w)));
    var along = vec2<f32>(0.0);
    if place.layer.has_cell_before != 0u {
        along = vec2<f32>(bend(known_scalar(at - width), front.y, back.y), bend(known_scalar(at + 1u - width), front.z, back.z));
    }
    if has_cell_behind(place) {
        let beyond = at + 2u * width;
        along = max(along, vec2<f32>(bend(front.y, back.y, known_scalar(beyond)), bend(front.z, back.z, known_scalar(beyond + 1u))));
    }
    let twist = select(0.0, abs((corners.w - corners.z) - (corners.y - corners.x)), all(are_known));
    let error = 0.125 * (across + max(along.x, along.y) + twist);
    if is_vacant_around(vec2<f32>(lowest, highest), spread + error) {
        return EMPTY;
    }
    // Where one side of what shows is unknown, samples do not tell it.
    if !all(are_known) {
        return code_of_error(STEEP);
    }
    if spacing_error(place, column, lowest, highest, error) > fan.grid.most_spacing_error {
        return code_of_error(STEEP);
    }
    return code_of_error(error_between(place, column, corners, spread));
}

@compute @workgroup_size(PLANE_COLUMNS, 1, 1)
fn find_errors(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let place = plane_place(group);
    let column = place.first + lane;
    if !place.exists || place.layer.has_cell == 0u || column >= place.layer.width {
        return;
    }
    // The last column has none beside it.
    if column + 1u < place.layer.width {
        let code = error_at(place, column);
        if code != EMPTY {
            atomicMax(&block_errors[block_kept_at(place, column)], code);
        }
    }
}
