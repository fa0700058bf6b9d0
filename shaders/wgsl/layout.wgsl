// The structs that the host fills and reads; their Rust forms, and the constants that host and kernels share, stand in
// the crate layout.

// See src/twin/scene.rs.
struct SceneBlock {
    volume_from_display: array<vec4<f32>, 4>,
    volume: vec4<f32>,
    light: vec4<f32>,
    material: vec4<f32>,
    quality: vec4<f32>,
    mimda: vec4<f32>,
    texel: vec4<f32>,
    atlas: vec4<u32>,
    tables: vec4<u32>,
    resolution: vec4<f32>,
}

// See src/twin/projector.rs.
struct ViewBlock {
    screen_from_pixel: array<vec4<f32>, 3>,
    beam: vec4<f32>,
    raster: vec4<u32>,
    lattice: vec4<u32>,
}

struct NodeRecord {
    cell: vec3<u32>,
    depth: u32,
    parent: u32,
    first_child: u32,
    slot: u32,
    deficit: f32,
    offset: f32,
    scale: f32,
    neighbours: array<u32, 6>,
    most_extinction: f32,
    weights: array<u32, 2>,
    deviation_scale: f32,
}

struct TableCell {
    first: u32,
    occupied: u32,
    inside: vec2<f32>,
}

struct TableEntry {
    value: vec4<f32>,
    integral: vec4<f32>,
    integral_rest: vec4<f32>,
    position: f32,
    padding: array<f32, 3>,
}

struct ImportanceEntry {
    value: f32,
    integral: f32,
    integral_rest: f32,
    padding: f32,
}

struct IndexEntry {
    value: f32,
    slope: f32,
    jumps: u32,
}

struct FeedbackEntry {
    deficit_code: atomic<u32>,
    rays: atomic<u32>,
}

// The view that an invocation is at.
var<private> projector: ViewBlock;

@group(0) @binding(BINDING_SCENE) var<uniform> scene: SceneBlock;
@group(0) @binding(BINDING_VIEWS) var<storage, read> views: array<ViewBlock>;
@group(0) @binding(BINDING_NODES) var<storage, read> nodes: array<NodeRecord>;
@group(0) @binding(BINDING_OPTICS) var<storage, read> optics_table: array<TableEntry>;
// How many there are, then the words of each.
@group(0) @binding(BINDING_LISTED) var<storage, read> listed: array<u32>;
@group(0) @binding(BINDING_PIXELS) var<storage, read_write> pixels: array<vec4<f32>>;
@group(0) @binding(BINDING_COUNTS) var<storage, read_write> counts: array<u32>;
@group(0) @binding(BINDING_FEEDBACK) var<storage, read_write> feedback: array<FeedbackEntry>;
@group(0) @binding(BINDING_TABLE_CELLS) var<storage, read> table_cells: array<TableCell>;
// Which 4³ cells of each slot's brick show anything: 16 words a slot, cell (x, y, z) is bit (z 8 + y) 8 + x.
@group(0) @binding(BINDING_CELLS) var<storage, read> cells: array<u32>;
