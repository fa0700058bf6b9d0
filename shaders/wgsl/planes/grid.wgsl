// The grid on a row's plane: at each depth its columns look the same to every view, shifted by a constant.

// See layout/src/planes.rs.
struct FanBlock {
    // Screen x of the left edge of pixel 0 and metres per pixel; screen y of row 0's edge and metres per row.
    raster: vec4<f32>,
    // B, Vy, Vz.
    way: vec3<f32>,
    // The largest error of a cell's light that distances between samples may make, and that means may, of what is still seen.
    most_spacing_error: f32,
    most_mean_error: f32,
    views: u32,
    // Blocks of pixels of a row.
    blocks: u32,
    // How often the rows of the bands have been swept so far.
    sweeps: u32,
    // Rows between those that are cast, the first of these, and rows there are.
    step: u32,
    first_row: u32,
    rows: u32,
    bands: u32,
}

struct Fan {
    grid: FanBlock,
    // A of each view.
    offsets: array<f32>,
}

// Rows of pixels, one row of tiles, and where what is known of them is kept.
struct PlaneBand {
    // Its number among the rows of tiles.
    at: u32,
    first_layer: u32,
    layers: u32,
    // The place of the first column that is kept of its first row, and columns of each row: one for each column of each layer.
    first_column: u32,
    columns: u32,
    // The same of blocks.
    first_block: u32,
    blocks: u32,
    padding: u32,
}

// The columns at one depth, and what lies between it and the next.
struct PlaneLayer {
    // Its depth, and that of the next.
    z: vec2<f32>,
    // Where its slab begins, and where it ends.
    slab_z: vec2<f32>,
    // Columns per pixel.
    phases: f32,
    // The number of its first column, counted from the left edge of pixel 0; whole blocks of pixels away from it.
    first: i32,
    width: u32,
    // Where its first column is kept in a row, and its first block.
    at: u32,
    block_at: u32,
    // Whether there is a cell behind it, and whether one in front.
    has_cell: u32,
    has_cell_before: u32,
    padding: u32,
}

@group(0) @binding(BINDING_FAN) var<storage, read> fan: Fan;
@group(0) @binding(BINDING_BANDS) var<storage, read> bands: array<PlaneBand>;
@group(0) @binding(BINDING_PLANE_LAYERS) var<storage, read> plane_layers: array<PlaneLayer>;

// A scalar that nobody knows, as nothing shows there.
const UNKNOWN: f32 = -1.0;
// The error of a cell that means cannot tell.
const STEEP: f32 = 1e30;
// The code of a block's error where nothing shows.
const EMPTY: u32 = 0u;

// The code of an error: the larger, the larger.
fn code_of_error(error: f32) -> u32 {
    return bitcast<u32>(error) + 1u;
}

fn error_of_code(code: u32) -> f32 {
    return bitcast<f32>(code - 1u);
}

// Columns of a block of pixels.
fn columns_of_block(layer: PlaneLayer) -> u32 {
    return TILE_EDGE * u32(layer.phases);
}

// z / Vz, and 1 − m + B m.
struct AtDepth {
    m: f32,
    scale: f32,
}

fn at_depth(z: f32) -> AtDepth {
    let m = z / fan.grid.way.z;
    return AtDepth(m, 1.0 - m + fan.grid.way.x * m);
}

// Pixels from a pixel of a view to where it meets the grid.
fn shift_of(offset: f32, z: f32) -> f32 {
    let depth = at_depth(z);
    return offset * depth.m / (fan.grid.raster.y * depth.scale);
}

// The line of columns of a row at a depth; its t is x.
fn line_of(row: u32, z: f32) -> Ray {
    let screen_y = fan.grid.raster.z + (f32(row) + 0.5) * fan.grid.raster.w;
    let y = screen_y + (fan.grid.way.y - screen_y) * at_depth(z).m;
    let m = scene.volume_from_display;
    var ray: Ray;
    ray.origin_in_display = vec3<f32>(0.0, y, z);
    ray.origin_in_volume = m[1].xyz * y + m[2].xyz * z + m[3].xyz;
    return turned(ray, vec3<f32>(1.0, 0.0, 0.0));
}

// x of a column.
fn column_x(layer: PlaneLayer, column: u32) -> f32 {
    let pixels = (f32(layer.first + i32(column)) + 0.5) / layer.phases;
    return (fan.grid.raster.x + fan.grid.raster.y * pixels) * at_depth(layer.z.x).scale;
}

// The row of a band that is its `number`th.
fn row_of(band: PlaneBand, number: u32) -> u32 {
    return (band.at * TILE_EDGE + number) * fan.grid.step + fan.grid.first_row;
}

// Optical depth of a cell where the table says 1.
fn thickness_of(layer: PlaneLayer) -> f32 {
    return scene.quality.z * (layer.z.x - layer.z.y);
}
