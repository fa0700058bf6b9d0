//! What is known of a volume's values without knowing what they mean.

use super::histogram::Histogram;
use bricks::volume::Modality;

/// Two voxels side by side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub here: f32,
    pub beside: f32,
}

/// Voxels of a volume.
#[derive(Clone, Debug, Default)]
pub(super) struct Sample {
    pub values: Vec<f32>,
    pub pairs: Vec<Pair>,
}

impl Sample {
    pub fn with(mut self, other: Self) -> Self {
        self.values.extend(other.values);
        self.pairs.extend(other.pairs);
        self
    }
}

/// More different whole numbers than this are no labels.
const MOST_LABELS: usize = 512;
/// How far from a whole number a value may be that stands for it, after rounding to f32.
const WHOLE: f32 = 1e-3;
/// Changes between voxels below this part of the range are no edges.
const LEAST_EDGE: f64 = 0.02;

/// What a volume was taken by, the distribution of its values, and how they change from voxel to voxel.
#[derive(Clone, Debug)]
pub struct Values {
    /// What the volume was taken by, where its file says so.
    pub(super) modality: Modality,
    /// Rising; never empty.
    sorted: Vec<f32>,
    /// Without the rarest ones.
    pub(super) histogram: Histogram,
    /// The different values, rising, if they are few and whole.
    pub(super) labels: Option<Vec<f32>>,
    /// Of the pairs of voxels that are not both background, the part that is equal.
    pub(super) flat: f64,
    /// How much values change at an edge, per finest voxel.
    pub(super) slope: f64,
}

impl Values {
    /// The values of `coarse`, voxels of a level whose edges are `edge` finest voxels long; `fine` are some of the finest
    /// level, where that is another one. `range` is what is known of the whole volume.
    pub(super) fn new(coarse: &Sample, fine: Option<&Sample>, edge: f64, range: (f64, f64)) -> Self {
        let mut sorted: Vec<f32> = coarse.values.iter().copied().filter(|v| v.is_finite()).collect();
        if sorted.is_empty() {
            sorted = vec![range.0 as f32, range.1 as f32];
        }
        sorted.sort_unstable_by(f32::total_cmp);
        let histogram = Histogram::new(&sorted);
        let background = histogram.background();
        let fine = fine.filter(|fine| !fine.pairs.is_empty()).unwrap_or(coarse);
        Self {
            modality: Modality::Unknown,
            labels: whole_numbers(&fine.values),
            flat: flat(&fine.pairs, background),
            slope: slope(&coarse.pairs, histogram.width()) / edge,
            sorted,
            histogram,
        }
    }

    /// The same of a volume of a modality.
    pub(super) fn of_modality(self, modality: Modality) -> Self {
        Self { modality, ..self }
    }

    /// The value below which this part of the voxels lies.
    pub(super) fn quantile(&self, part: f64) -> f64 {
        f64::from(self.sorted[(part * (self.sorted.len() - 1) as f64) as usize])
    }

    /// The part of the voxels from `low` up to `high`.
    pub(super) fn share(&self, low: f64, high: f64) -> f64 {
        let from = self.sorted.partition_point(|&v| f64::from(v) < low);
        let to = self.sorted.partition_point(|&v| f64::from(v) <= high);
        to.saturating_sub(from) as f64 / self.sorted.len() as f64
    }

    /// [`Self::share`] per unit of the values.
    pub(super) fn density(&self, low: f64, high: f64) -> f64 {
        self.share(low, high) / (high - low)
    }
}

fn whole_numbers(values: &[f32]) -> Option<Vec<f32>> {
    // What is not finite fails this, too.
    if !values.iter().all(|v| (v - v.round()).abs() <= WHOLE) {
        return None;
    }
    let mut found: Vec<f32> = values.iter().map(|v| v.round()).collect();
    found.sort_unstable_by(f32::total_cmp);
    found.dedup();
    (found.len() <= MOST_LABELS).then_some(found)
}

fn flat(pairs: &[Pair], background: f64) -> f64 {
    let is_background = |v: f32| f64::from(v) == background;
    let inner = pairs.iter().filter(|pair| !is_background(pair.here) || !is_background(pair.beside));
    let (mut all, mut equal) = (0_u64, 0_u64);
    for pair in inner {
        all += 1;
        equal += u64::from(pair.here == pair.beside);
    }
    equal as f64 / all.max(1) as f64
}

/// The middle one of the changes that are edges; the whole range if there is none.
fn slope(pairs: &[Pair], width: f64) -> f64 {
    let changes = pairs.iter().map(|pair| (pair.here - pair.beside).abs());
    let mut edges: Vec<f32> =
        changes.filter(|&change| change.is_finite() && f64::from(change) > LEAST_EDGE * width).collect();
    edges.sort_unstable_by(f32::total_cmp);
    edges.get(edges.len() / 2).map_or(width, |&edge| f64::from(edge))
}
