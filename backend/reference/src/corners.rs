//! The weights at a leaf's corners: how far the leaf's samples blend into its parent's (LOD section 4.3).

use glam::DVec3;

/// Weights in [0, 1], trilinear over a leaf.
#[derive(Clone, Copy, Debug)]
pub struct Corners {
    /// The leaf's low corner, finest voxels.
    pub low: DVec3,
    /// Its edge, also where it reaches beyond the volume.
    pub edge: f64,
    /// The leaf's share at corners x + 2 y + 4 z.
    pub weights: [f64; 8],
}

impl Corners {
    /// The share that the parent has at a point of the leaf.
    pub fn parents_share(&self, point: DVec3) -> f64 {
        let upper = ((point - self.low) / self.edge).clamp(DVec3::ZERO, DVec3::ONE);
        let reach = |corner: usize| -> f64 {
            let along = |axis: usize| if corner >> axis & 1 == 1 { upper[axis] } else { 1.0 - upper[axis] };
            (0..3).map(along).product()
        };
        let kept: f64 = (0..8).map(|corner| self.weights[corner] * reach(corner)).sum();
        (1.0 - kept).clamp(0.0, 1.0)
    }
}
