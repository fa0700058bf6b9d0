// Lays what lies in a pixel into it, one after the other; see backend/renderer/src/present/layers.rs.

struct Layer {
    before: vec4<f32>,
    rgb: vec3<f32>,
    opacity: f32,
}

struct MarkedPixel {
    pixel: u32,
    first: u32,
    count: u32,
}

@group(0) @binding(BINDING_MARKED_PIXELS) var<storage, read> marked_pixels: array<MarkedPixel>;
@group(0) @binding(BINDING_LAYERS) var<storage, read> layers: array<Layer>;
@group(0) @binding(BINDING_MARKED) var<storage, read_write> marked: array<vec4<f32>>;

// The pixels are those of a list, in rows as wide as the raster that is given.
@compute @workgroup_size(TILE_EDGE, TILE_EDGE, 1)
fn lay_pixel(@builtin(global_invocation_id) id: vec3<u32>) {
    let listed = id.y * present.raster.x + id.x;
    if id.x >= present.raster.x || listed >= present.stages.x {
        return;
    }
    let into = marked_pixels[listed];
    var colour = picture[into.pixel];
    for (var i = into.first; i < into.first + into.count; i++) {
        let layer = layers[i];
        let backed = layer.before + (1.0 - layer.before.a) * vec4<f32>(layer.rgb, 1.0);
        colour = (1.0 - layer.opacity) * colour + layer.opacity * backed;
    }
    marked[into.pixel] = colour;
}
