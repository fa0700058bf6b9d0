//! The leaves of the cut, as rows of the screen meet them.

use crate::Fan;
use crate::fan::AtDepth;
use glam::{DAffine3, DMat3, DVec3};
use layout::{NO_NODE, NO_SLOT, NodeRecord};
use twin::SceneNumbers;
use twin::traverse::OWN_EDGE;

/// A leaf with a brick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf {
    /// Its place in the index.
    pub(crate) node: u32,
    /// The first row that may meet it, and one past the last.
    pub(crate) rows: [u32; 2],
    /// Nearest to the viewers and farthest from them, metres.
    pub(crate) z: [f64; 2],
    /// Its extent along the screen, metres.
    pub(crate) x: [f64; 2],
    /// Whether one of its faces is the volume's.
    pub(crate) is_outer: bool,
    /// Its box, finest voxels; a voxel more where a face is the volume's, so that what lies up to there is known.
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
    /// Edge of its voxel, finest voxels.
    pub(crate) edge: f64,
}

impl Leaf {
    /// Where the line from `origin` along `direction` is in its box: [from, to).
    pub(crate) fn crossing(&self, origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
        let (mut enter, mut leave) = (f64::MIN, f64::MAX);
        for axis in 0..3 {
            if direction[axis].abs() < 1e-12 {
                if origin[axis] < self.low[axis] || origin[axis] >= self.high[axis] {
                    return None;
                }
            } else {
                let a = (self.low[axis] - origin[axis]) / direction[axis];
                let b = (self.high[axis] - origin[axis]) / direction[axis];
                enter = enter.max(a.min(b));
                leave = leave.min(a.max(b));
            }
        }
        (enter < leave).then_some((enter, leave))
    }
}

/// The affine map of a scene from the display to the volume.
pub(crate) fn volume_from_display(scene: &SceneNumbers<f32>) -> DAffine3 {
    let [x, y, z, w] = scene.volume_from_display.map(|c| DVec3::from_array(c.0.map(f64::from)));
    DAffine3 { matrix3: DMat3::from_cols(x, y, z), translation: w }
}

/// All leaves that some row meets.
pub(crate) fn leaves(scene: &SceneNumbers<f32>, nodes: &[NodeRecord], fan: &Fan) -> Vec<Leaf> {
    let display_from_volume = volume_from_display(scene).inverse();
    let dims = DVec3::from_array(scene.dims.0.map(f64::from));
    let finest = scene.finest_depth;
    let [_, rows] = fan.raster;
    let (farthest, nearest) = fan.depths();
    let nodes = nodes.iter().enumerate();
    let leaf = |(index, node): (usize, &NodeRecord)| {
        if node.first_child != NO_NODE || node.slot == NO_SLOT {
            return None;
        }
        let edge = f64::from(1u32 << (finest - node.depth));
        let low = DVec3::from_array(node.cell.map(|c| f64::from(c) * OWN_EDGE * edge));
        let high = low + OWN_EDGE * edge;
        let (is_first, is_last) = (low.cmple(DVec3::ZERO), high.cmpge(dims));
        let is_outer = is_first.any() || is_last.any();
        let low = DVec3::select(is_first, low - edge, low);
        let high = DVec3::select(is_last, dims + edge, high);
        let (mut first, mut last) = (f64::MAX, f64::MIN);
        let (mut near, mut far) = (f64::MIN, f64::MAX);
        let mut x = [f64::MAX, f64::MIN];
        for corner in 0..8u32 {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
            let p = display_from_volume.transform_point3(DVec3::new(pick(0), pick(1), pick(2)));
            let row = fan.row_of(p.y, p.z);
            first = first.min(row.unwrap_or(-1.0));
            last = last.max(row.unwrap_or(f64::from(rows)));
            x = [x[0].min(p.x), x[1].max(p.x)];
            near = near.max(p.z);
            far = far.min(p.z);
        }
        let rows = [
            (first - 1e-6).ceil().max(0.0) as u32,
            ((last + 1e-6).floor() + 1.0).clamp(0.0, f64::from(rows)) as u32,
        ];
        let z = [near.min(nearest), far.max(farthest)];
        (rows[0] < rows[1] && z[0] > z[1]).then_some(Leaf {
            node: index as u32,
            rows,
            z,
            x,
            is_outer,
            low,
            high,
            edge,
        })
    };
    nodes.filter_map(leaf).collect()
}

/// Columns of pixels, the first and the last, that some view meets in leaves between two depths, or more.
pub(crate) fn extent(fan: &Fan, leaves: &[Leaf], ends: [&AtDepth; 2]) -> [i64; 2] {
    let mut seen = [f64::MAX, f64::MIN];
    let mut held = [f64::MAX, f64::MIN];
    for depth in ends {
        let (low, high) = fan.seen(depth);
        seen = [seen[0].min(low), seen[1].max(high)];
        for x in leaves.iter().flat_map(|leaf| leaf.x) {
            let column = fan.column_of(x, depth);
            held = [held[0].min(column), held[1].max(column)];
        }
    }
    [seen[0].max(held[0]).floor() as i64 - 2, seen[1].min(held[1]).ceil() as i64 + 2]
}
