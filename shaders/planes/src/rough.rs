//! How far a transfer function is from linear between two scalars.

use needs::tables::{TABLE_CELLS, Tables};

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
