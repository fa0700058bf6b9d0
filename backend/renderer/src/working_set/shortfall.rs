//! How coarse a frame was.

/// How coarse a frame was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shortfall {
    /// What rays found too coarse on average, levels; what is fine enough counts 0.
    pub mean: f64,
    /// The largest deficit that a ray met, levels.
    pub largest: f64,
}

impl Shortfall {
    /// Of leaves, each with its rays and its deficit in levels; None if no ray met any.
    pub fn of(leaves: impl Iterator<Item = (u32, f64)>) -> Option<Self> {
        let (mut all, mut weighted, mut largest) = (0.0, 0.0, 0.0_f64);
        for (rays, deficit) in leaves {
            let (rays, deficit) = (f64::from(rays), deficit.max(0.0));
            all += rays;
            weighted += rays * deficit;
            largest = largest.max(deficit);
        }
        (all > 0.0).then(|| Self { mean: weighted / all, largest })
    }
}
