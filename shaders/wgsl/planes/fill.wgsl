// Samples of the volume on the grid, where some view still sees.

@group(0) @binding(BINDING_OPEN) var<storage, read> open_blocks: array<u32>;
// What the means of each block err, at most.
@group(0) @binding(BINDING_ERRORS) var<storage, read_write> block_errors: array<u32>;
// Of each row of tiles: samples, and whether a node on the way was too coarse.
@group(0) @binding(BINDING_FOUND) var<storage, read_write> found: array<atomic<u32>>;

var<workgroup> is_wanted: atomic<u32>;
var<workgroup> samples_taken: atomic<u32>;
var<workgroup> leaves: array<u32, PLANE_COLUMNS>;

// Columns beside those of the blocks that a view meets, of which it hears: neighbours say how far a scalar bends.
const BESIDE: f32 = 4.0;
// Pixels that a block reaches beyond what a pixel meets of it.
const AROUND: f32 = f32(TILE_EDGE) + 1.0;

// Whether a view still sees some of the columns of a group.
fn is_seen_by(view: u32, place: PlanePlace, band: u32) -> bool {
    if fan.grid.sweeps == 0u {
        return true;
    }
    let offset = fan.offsets[view];
    let a = shift_of(offset, place.layer.slab_z.x);
    let b = shift_of(offset, place.layer.slab_z.y);
    let first = f32(place.layer.first + i32(place.first)) - BESIDE;
    let low = first / place.layer.phases - max(a, b) - AROUND;
    let high = (first + f32(PLANE_COLUMNS) + 2.0 * BESIDE) / place.layer.phases - min(a, b) + AROUND;
    let last = f32(fan.grid.blocks * TILE_EDGE) - 1.0;
    if high < 0.0 || low > last {
        return false;
    }
    let row = ((band * TILE_EDGE + place.number) * fan.grid.views + view) * fan.grid.blocks;
    let until = u32(min(high, last)) / TILE_EDGE;
    for (var block = u32(max(low, 0.0)) / TILE_EDGE; block <= until; block++) {
        if open_blocks[row + block] == fan.grid.sweeps {
            return true;
        }
    }
    return false;
}

@compute @workgroup_size(PLANE_COLUMNS, 1, 1)
fn fill(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let place = plane_place(group);
    if !place.exists {
        return;
    }
    for (var view = lane; view < fan.grid.views; view += PLANE_COLUMNS) {
        if is_seen_by(view, place, group.z / TILE_EDGE) {
            atomicStore(&is_wanted, 1u);
        }
    }
    workgroupBarrier();
    let column = place.first + lane;
    var leaf = NO_NODE;
    if column < place.layer.width {
        let at = kept_at(place, column);
        var scalar = UNKNOWN;
        if atomicLoad(&is_wanted) != 0u {
            var ray = line_of(row_of(place.band, place.number), place.layer.z.x);
            let point = point_on(ray, column_x(place.layer, column));
            // What lies up to a face is known from both of its sides. Beyond, it is what it is there.
            let inside = clamp(point, vec3<f32>(0.0), scene.volume.xyz);
            ray.origin_in_volume = inside;
            leaf = leaf_at(inside, ray);
            let node = nodes[leaf];
            let beyond = abs(point - inside);
            if node.slot == NO_SLOT || any(beyond > vec3<f32>(voxel_edge(node.depth))) {
                leaf = NO_NODE;
            } else {
                let brick = brick_of(node, ray);
                if is_visible_at(brick, point_in(brick.own, 0.0)) {
                    scalar = scalar_at(brick, ray, 0.0);
                    keep_spread(at, brick, ray);
                    keep_gradients(at, brick, ray);
                    atomicAdd(&samples_taken, 1u);
                }
            }
        }
        plane_samples[SAMPLE_WORDS * at] = scalar;
        if column % columns_of_block(place.layer) == 0u {
            block_errors[block_kept_at(place, column)] = EMPTY;
        }
    }
    leaves[lane] = leaf;
    workgroupBarrier();
    if leaf != NO_NODE && (lane == 0u || leaves[max(lane, 1u) - 1u] != leaf) {
        let deficit = nodes[leaf].deficit;
        note(leaf, deficit);
        if deficit > 0.0 {
            atomicStore(&found[2u * place.band.at + 1u], 1u);
        }
    }
    if lane == 0u {
        atomicAdd(&found[2u * place.band.at], atomicLoad(&samples_taken));
    }
}

fn keep_spread(at: u32, brick: Brick, ray: Ray) {
    if SPREAD_WORDS != 0u {
        plane_samples[SAMPLE_WORDS * at + SPREAD_WORDS] = spread_at(brick, ray, 0.0);
    }
}
