//! Where a view's pixels meet the columns of a slab, and what they take there for themselves.

use crate::Fan;
use crate::near::Near;
use crate::slab::{LANES, Slab};

/// Where a view's pixels meet the columns at one depth: between two columns, the same share of each for all of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// The phases of both.
    pub(crate) phases: [usize; 2],
    /// Entry of pixel 0, and by how much the second column's is further.
    pub(crate) entry: i64,
    pub(crate) further: usize,
    /// The second column's share.
    pub(crate) part: f32,
}

impl Place {
    #[inline(always)]
    fn new(slab: &Slab, shift: f64) -> Self {
        let place = slab.phases as f64 * (0.5 + shift) - 0.5;
        // The whole number at or below it, without the call of a library.
        let near = place as i64;
        let column = near - i64::from(near as f64 > place);
        let phases = slab.phases as i64;
        let (entry, phase) = (column.div_euclid(phases), column.rem_euclid(phases) as usize);
        let further = usize::from(phase + 1 == slab.phases);
        let next = if further == 1 { 0 } else { phase + 1 };
        Self {
            phases: [phase, next],
            entry: entry - slab.base,
            further,
            part: (place - column as f64) as f32,
        }
    }
}

/// Places of all cells' middles, and of all depths.
#[derive(Debug, Default)]
pub(crate) struct Places {
    pub(crate) middles: Vec<Place>,
    pub(crate) depths: Vec<Place>,
    /// Where the means of both columns that pixel 0 meets of each cell are kept.
    pub(crate) means: Vec<[i64; 2]>,
    /// Leaves near eight pixels, from the first depth to the last.
    pub(crate) leaves: Vec<usize>,
    /// The first of those pixels, once they are known.
    pub(crate) leaves_of: Option<usize>,
    /// Samples that rays took for themselves.
    pub(crate) samples: u64,
}

impl Places {
    #[inline(always)]
    pub(crate) fn find(&mut self, slab: &Slab, fan: &Fan, view: usize) {
        for (list, depths) in [(&mut self.middles, &slab.middles), (&mut self.depths, &slab.depths)] {
            list.clear();
            for depth in depths {
                list.push(Place::new(slab, fan.shift(view, depth)));
            }
        }
        self.means.clear();
        for (cell, place) in self.middles.iter().enumerate() {
            let [a, b] = place.phases.map(|phase| slab.mean_start(cell, phase) as i64 + place.entry);
            self.means.push([a, b + place.further as i64]);
        }
        self.leaves_of = None;
    }

    /// Finds the leaves near eight pixels.
    pub(crate) fn find_leaves(&mut self, near: &Near, at: usize) {
        let ends = [&self.depths[0], &self.depths[self.depths.len() - 1]];
        let [a, b] = ends.map(|place| place.entry + at as i64);
        let lanes = LANES as i64;
        near.find(a.min(b).div_euclid(lanes) - 1..=a.max(b).div_euclid(lanes) + 2, &mut self.leaves);
        self.leaves_of = Some(at);
    }
}
