//! How far a transfer function is from linear between two scalars.

use layout::PlaneVariation;
use needs::tables::{TABLE_CELLS, Tables};
use twin::tables::locate;

/// The variation of the slopes of (τ c, τ), summed from the lowest cell on.
#[derive(Clone, Debug)]
pub(crate) struct Roughness(Vec<f32>);

/// Narrower nodes than this share of a cell are a jump.
const LEAST_WIDTH: f32 = 1e-3;

impl Roughness {
    pub(crate) fn of(tables: &Tables) -> Self {
        let slopes: Vec<[f32; 4]> = tables
            .optics
            .windows(2)
            .map(|ends| {
                let width = (ends[1].position - ends[0].position).max(LEAST_WIDTH) / TABLE_CELLS as f32;
                std::array::from_fn(|c| (ends[1].value[c] - ends[0].value[c]) / width)
            })
            .collect();
        // At each node inside, the change of slope there.
        let mut sums = vec![0.0f32; TABLE_CELLS + 2];
        for (i, ends) in slopes.windows(2).enumerate() {
            let change = (0..4).map(|c| (ends[1][c] - ends[0][c]).abs()).fold(0.0, f32::max);
            let cell = (tables.optics[i + 1].position as usize).min(TABLE_CELLS);
            sums[cell + 1] += change;
        }
        let mut sum = 0.0;
        for entry in &mut sums {
            sum += *entry;
            *entry = sum;
        }
        Self(sums)
    }

    /// A bound of |f((a + b) / 2) − (f(a) + f(b)) / 2| for scalars a and b within [low, high], `apart` at most.
    #[inline(always)]
    pub(crate) fn bend(&self, low: f32, high: f32, apart: f32) -> f32 {
        let cell = |s: f32| ((s * TABLE_CELLS as f32) as usize).min(TABLE_CELLS);
        0.25 * apart * (self.0[cell(high) + 1] - self.0[cell(low)])
    }
}

/// How much (τ c, τ) vary, summed from the lowest scalar on, at the borders of the tables' cells.
#[derive(Clone, Debug)]
pub(crate) struct Variation {
    /// Of the channel that varies most, and of each.
    most: Vec<f32>,
    each: Vec<[f32; 4]>,
    values: Vec<[f32; 4]>,
    /// The same of importance; empty where there is none.
    importance: Vec<f32>,
}

impl Variation {
    pub(crate) fn of(tables: &Tables) -> Self {
        let mut each = vec![[0.0f32; 4]; TABLE_CELLS + 1];
        let mut most = vec![0.0f32; TABLE_CELLS + 1];
        for ends in tables.optics.windows(2) {
            let cell = (ends[0].position as usize).min(TABLE_CELLS - 1) + 1;
            let change = |c: usize| (ends[1].value[c] - ends[0].value[c]).abs();
            most[cell] += (0..4).map(change).fold(0.0, f32::max);
            (0..4).for_each(|c| each[cell][c] += change(c));
        }
        let mut importance = vec![0.0f32; if tables.importance.is_empty() { 0 } else { TABLE_CELLS + 1 }];
        for (ends, node) in tables.importance.windows(2).zip(&tables.optics) {
            let cell = (node.position as usize).min(TABLE_CELLS - 1) + 1;
            importance[cell] += (ends[1].value - ends[0].value).abs();
        }
        for cell in 1..importance.len() {
            importance[cell] += importance[cell - 1];
        }
        for cell in 1..=TABLE_CELLS {
            most[cell] += most[cell - 1];
            (0..4).for_each(|c| each[cell][c] += each[cell - 1][c]);
        }
        let value = |cell: usize| locate(tables, cell as f32 / TABLE_CELLS as f32).value();
        Self { most, each, values: (0..=TABLE_CELLS).map(value).collect(), importance }
    }

    /// The borders of the tables' cells, as kernels read them.
    pub(crate) fn entries(&self) -> Vec<PlaneVariation> {
        let entry = |cell: usize| PlaneVariation {
            most: self.most[cell],
            importance: self.importance.get(cell).copied().unwrap_or(0.0),
            padding: [0.0; 2],
            each: self.each[cell],
            value: self.values[cell],
        };
        (0..=TABLE_CELLS).map(entry).collect()
    }

    /// The cells' borders around scalars from `low` to `high`, and `around` them.
    #[inline(always)]
    fn borders(low: f32, high: f32, around: f32) -> [usize; 2] {
        let cells = TABLE_CELLS as f32;
        let from = (((low - around).max(0.0) * cells) as usize).min(TABLE_CELLS - 1);
        [from, (((high + around).min(1.0) * cells) as usize + 1).min(TABLE_CELLS)]
    }

    /// All of it around some scalars.
    #[inline(always)]
    pub(crate) fn total(&self, low: f32, high: f32, around: f32) -> f32 {
        let [from, to] = Self::borders(low, high, around);
        self.most[to] - self.most[from]
    }

    /// All of the variation of importance around some scalars.
    #[inline(always)]
    pub(crate) fn total_importance(&self, low: f32, high: f32, around: f32) -> f32 {
        if self.importance.is_empty() {
            return 0.0;
        }
        let [from, to] = Self::borders(low, high, around);
        self.importance[to] - self.importance[from]
    }

    /// How much the importance of scalars from `low` to `high` changes if they are wrong by `error`.
    #[inline(always)]
    pub(crate) fn change_of_importance(&self, low: f32, high: f32, error: f32) -> f32 {
        let [from, to] = Self::borders(low, high, error);
        let share = 2.0 * error * TABLE_CELLS as f32 / (to - from) as f32;
        self.total_importance(low, high, error) * share.min(1.0)
    }

    /// How much a mean over scalars from `low` to `high` changes if both are wrong by `error`.
    #[inline(always)]
    pub(crate) fn change(&self, low: f32, high: f32, error: f32) -> f32 {
        let [from, to] = Self::borders(low, high, error);
        let share = 2.0 * error * TABLE_CELLS as f32 / (to - from) as f32;
        (self.most[to] - self.most[from]) * share.min(1.0)
    }

    /// What goes up between two scalars and comes down again, which their own values do not tell.
    #[inline(always)]
    pub(crate) fn hidden(&self, low: f32, high: f32) -> f32 {
        let [from, to] = Self::borders(low, high, 0.0);
        let mut most = 0.0f32;
        for c in 0..4 {
            let rise = (self.values[to][c] - self.values[from][c]).abs();
            most = most.max(self.each[to][c] - self.each[from][c] - rise);
        }
        0.5 * most
    }
}
