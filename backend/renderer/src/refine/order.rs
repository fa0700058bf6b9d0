//! In which order the pixels of a picture are cast: first few of them all over it, then those between.

use crate::device::{TileGrid, TileList};
use protocol::Refinement;
use std::ops::Range;
use twin::Lattice;

/// A picture is cast in so many parts of about the same number of pixels.
pub const UNITS: u32 = Refinement::UNITS;

/// What is cast alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grain {
    /// Single pixels, as each ray alone can be.
    Pixels,
    /// Whole rows, as row planes cast them.
    Rows,
}

/// Pixels between those of the first unit, along both axes.
const COARSEST: u32 = 8;

/// The order of a raster.
#[derive(Clone, Debug)]
pub struct Order {
    grain: Grain,
    size: [u32; 2],
    steps: Vec<Step>,
    /// Of each pixel: the unit that casts it.
    units: Vec<u8>,
}

/// A lattice that is cast one part after the other.
#[derive(Clone, Debug)]
struct Step {
    lattice: Lattice,
    units: Range<u32>,
    /// Its tiles, those of the middle first: that is where eyes look.
    tiles: Vec<u32>,
}

impl Step {
    /// The tiles that some units cast.
    fn tiles_of(&self, units: &Range<u32>) -> &[u32] {
        let (from, to) = (self.units.start.max(units.start), self.units.end.min(units.end));
        let place = |unit: u32| {
            self.tiles.len() * (unit - self.units.start) as usize
                / (self.units.end - self.units.start) as usize
        };
        if from < to { &self.tiles[place(from)..place(to)] } else { &[] }
    }
}

impl Order {
    /// For a raster of pixels along x and y.
    pub fn new(grain: Grain, size: [u32; 2]) -> Self {
        let lattices = match grain {
            Grain::Pixels => lattices_of_pixels(),
            Grain::Rows => lattices_of_rows(size[1]),
        };
        let mut begin = 0;
        let steps: Vec<Step> = lattices
            .into_iter()
            .map(|(lattice, count)| {
                let units = begin..begin + count;
                begin = units.end;
                Step { lattice, units, tiles: from_the_middle(&TileGrid::new(size[0], size[1], lattice)) }
            })
            .collect();
        let mut units = vec![0; size[0] as usize * size[1] as usize];
        for step in &steps {
            let grid = TileGrid::new(size[0], size[1], step.lattice);
            for unit in step.units.clone() {
                for &tile in step.tiles_of(&(unit..unit + 1)) {
                    for (x, y) in grid.pixels(tile, size[0], size[1]) {
                        units[y as usize * size[0] as usize + x as usize] = unit as u8;
                    }
                }
            }
        }
        Self { grain, size, steps, units }
    }

    /// What is cast alone.
    pub fn grain(&self) -> Grain {
        self.grain
    }

    /// Pixels along x and y.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// What some units cast: tiles of lattices, one lattice after the other. Which lattices these are does not depend on the
    /// raster; of a small one there may be no tiles.
    pub fn casts(&self, units: &Range<u32>) -> Vec<(Lattice, TileList)> {
        let is_asked = |step: &&Step| step.units.start < units.end && units.start < step.units.end;
        let tiles = |step: &Step| step.tiles_of(units).iter().copied().collect();
        self.steps.iter().filter(is_asked).map(|step| (step.lattice, tiles(step))).collect()
    }

    /// The pixels of the first unit, which lie all over the picture.
    pub fn first(&self) -> Lattice {
        self.steps[0].lattice
    }

    /// Whether a pixel, by its place in the picture, is cast once so many units are done.
    pub fn is_cast(&self, pixel: usize, done: u32) -> bool {
        u32::from(self.units[pixel]) < done
    }
}

/// Every eighth pixel along both axes, then the middles of the squares that they form, then those of their sides, and so
/// on: with each lattice as many units as it has pixels.
fn lattices_of_pixels() -> Vec<(Lattice, u32)> {
    let square = |step: u32, first: [u32; 2]| (Lattice { step: [step; 2], first }, UNITS / (step * step));
    let mut lattices = vec![square(COARSEST, [0, 0])];
    let mut step = COARSEST;
    while step > 1 {
        let half = step / 2;
        lattices.extend([[half, half], [half, 0], [0, half]].map(|first| square(step, first)));
        step = half;
    }
    lattices
}

/// Every sixty-fourth row, then those half-way between, and so on: a unit each. The first rows are not at the rim, where
/// there may be nothing to see.
fn lattices_of_rows(height: u32) -> Vec<(Lattice, u32)> {
    let (bits, begin) = (UNITS.trailing_zeros(), (height.saturating_sub(1) / 2).min(UNITS / 2));
    let row = |unit: u32| (begin + (unit.reverse_bits() >> (u32::BITS - bits))) % UNITS;
    (0..UNITS).map(|unit| (Lattice { step: [1, UNITS], first: [0, row(unit)] }, 1)).collect()
}

/// The tiles of a grid by their distance from its middle.
fn from_the_middle(grid: &TileGrid) -> Vec<u32> {
    let middle = [grid.across, grid.down].map(|along| i64::from(along) - 1);
    let distance = |&tile: &u32| {
        let [x, y] = [tile % grid.across, tile / grid.across].map(|at| 2 * i64::from(at));
        let [x, y] = [x - middle[0], y - middle[1]];
        x * x + y * y
    };
    let mut tiles: Vec<u32> = (0..grid.count()).collect();
    tiles.sort_by_key(distance);
    tiles
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZES: [[u32; 2]; 5] = [[1, 1], [7, 9], [64, 48], [131, 97], [3, 200]];

    #[test]
    fn every_pixel_is_cast_by_one_unit_and_that_is_its_own() {
        for grain in [Grain::Pixels, Grain::Rows] {
            for size in SIZES {
                let order = Order::new(grain, size);
                let mut times = vec![0; (size[0] * size[1]) as usize];
                for unit in 0..UNITS {
                    for (lattice, tiles) in order.casts(&(unit..unit + 1)) {
                        let grid = TileGrid::new(size[0], size[1], lattice);
                        for (x, y) in tiles.iter().flat_map(|tile| grid.pixels(tile, size[0], size[1])) {
                            let at = (y * size[0] + x) as usize;
                            times[at] += 1;
                            assert!(!order.is_cast(at, unit) && order.is_cast(at, unit + 1));
                        }
                    }
                }
                assert!(times.iter().all(|&times| times == 1), "{grain:?} {size:?}");
            }
        }
    }

    #[test]
    fn units_are_of_about_the_same_size_and_the_first_is_everywhere() {
        let size = [800, 600];
        let order = Order::new(Grain::Pixels, size);
        for unit in 0..UNITS {
            let rays: u64 = order
                .casts(&(unit..unit + 1))
                .into_iter()
                .map(|(lattice, tiles)| {
                    let grid = TileGrid::new(size[0], size[1], lattice);
                    tiles.runs().iter().map(|run| grid.rays(run, size[0], size[1])).sum::<u64>()
                })
                .sum();
            let mean = 800.0 * 600.0 / f64::from(UNITS);
            assert!((rays as f64 / mean - 1.0).abs() < 0.1, "unit {unit}: {rays}");
        }
        assert_eq!(order.first(), Lattice { step: [8; 2], first: [0; 2] });
    }

    #[test]
    fn a_lattice_is_cast_from_the_middle_outward() {
        let order = Order::new(Grain::Pixels, [256, 256]);
        // The sixteen units of the diagonal neighbours of what is cast before them.
        let distance = |unit: u32| {
            let casts = order.casts(&(unit..unit + 1));
            let grid = TileGrid::new(256, 256, casts[0].0);
            let farthest = casts[0].1.iter().flat_map(|tile| grid.pixels(tile, 256, 256));
            farthest.map(|(x, y)| x.abs_diff(128).max(y.abs_diff(128))).max()
        };
        assert!(distance(16) < distance(24) && distance(24) < distance(31));
    }
}
