//! A tree of vessels in empty space: sparse data for out-of-core rendering to cope with.

use super::Field;
use super::tube::Tube;
use glam::{DVec3, UVec3};

/// Branchings from trunk to tip: 2^8 − 1 tubes.
const GENERATIONS: u32 = 8;
/// Length and radius of the trunk as parts of the smallest extent, and what a branch keeps of its parent's.
const TRUNK_LENGTH: f64 = 0.28;
const TRUNK_RADIUS: f64 = 0.03;
const LENGTH_KEPT: f64 = 0.8;
const RADIUS_KEPT: f64 = 0.77;
/// Distance between the tree and the cube's faces.
const MARGIN: f64 = 0.04;
/// Cells of the look-up grid along an edge of the cube.
const GRID: u32 = 48;
/// The tree is the same in every run.
const SEED: u64 = 0x6c69_6768_746c_6f6f;

/// The value is 1 − ∏ (1 − w) over the tubes' weights w: smooth where tubes meet, exactly 0 outside all of them.
pub struct SparseVessels {
    tubes: Vec<Tube>,
    /// Per grid cell, x fastest, the tubes that reach into it.
    cells: Vec<Vec<u16>>,
}

impl SparseVessels {
    /// A tree that grows along z in the extent.
    pub fn new(extent: DVec3) -> Self {
        let tubes: Vec<_> = grow_tree().into_iter().map(|tube| fitted(tube, extent)).collect();
        let mut cells = vec![Vec::new(); (GRID * GRID * GRID) as usize];
        for (number, tube) in tubes.iter().enumerate() {
            let reach = DVec3::splat(tube.radius);
            let (first, last) =
                (cell_of(tube.from.min(tube.to) - reach), cell_of(tube.from.max(tube.to) + reach));
            for cell in cells_between(first, last) {
                let low = cell.as_dvec3() / f64::from(GRID);
                if tube.weight_range(low, low + 1.0 / f64::from(GRID)).1 > 0.0 {
                    cells[cell_index(cell)].push(number as u16);
                }
            }
        }
        Self { tubes, cells }
    }

    /// The tubes that may reach a position; none lies outside the cube.
    fn tubes_at(&self, position: DVec3) -> impl Iterator<Item = &Tube> {
        let inside = position.cmpge(DVec3::ZERO).all() && position.cmple(DVec3::ONE).all();
        let numbers: &[u16] = if inside { &self.cells[cell_index(cell_of(position))] } else { &[] };
        numbers.iter().map(|&number| &self.tubes[usize::from(number)])
    }
}

impl Field for SparseVessels {
    fn value(&self, position: DVec3) -> f64 {
        1.0 - self.tubes_at(position).map(|tube| 1.0 - tube.weight(position)).product::<f64>()
    }

    fn gradient(&self, position: DVec3) -> DVec3 {
        let mut gradient = DVec3::ZERO;
        let mut rest = 1.0;
        for tube in self.tubes_at(position) {
            let weight = tube.weight(position);
            gradient = gradient * (1.0 - weight) + tube.weight_gradient(position) * rest;
            rest *= 1.0 - weight;
        }
        gradient
    }

    fn range_in_box(&self, low: DVec3, high: DVec3) -> (f64, f64) {
        let mut rest = (1.0, 1.0);
        for tube in &self.tubes {
            let (least, most) = tube.weight_range(low, high);
            rest = (rest.0 * (1.0 - least), rest.1 * (1.0 - most));
        }
        (1.0 - rest.0, 1.0 - rest.1)
    }
}

fn cell_of(position: DVec3) -> UVec3 {
    (position * f64::from(GRID)).clamp(DVec3::ZERO, DVec3::splat(f64::from(GRID - 1))).as_uvec3()
}

fn cell_index(cell: UVec3) -> usize {
    ((cell.z * GRID + cell.y) * GRID + cell.x) as usize
}

fn cells_between(first: UVec3, last: UVec3) -> impl Iterator<Item = UVec3> {
    (first.z..=last.z).flat_map(move |z| {
        (first.y..=last.y).flat_map(move |y| (first.x..=last.x).map(move |x| UVec3::new(x, y, z)))
    })
}

/// The tree of the cube, scaled to the extent; the radius shrinks with its smallest edge, so the tree stays inside.
fn fitted(tube: Tube, extent: DVec3) -> Tube {
    Tube { from: tube.from * extent, to: tube.to * extent, radius: tube.radius * extent.min_element() }
}

fn grow_tree() -> Vec<Tube> {
    let root = DVec3::new(0.5, 0.5, MARGIN);
    let mut tubes = Vec::new();
    let mut random = Random(SEED);
    grow(root, DVec3::Z, 0, &mut random, &mut tubes);
    tubes
}

fn grow(from: DVec3, direction: DVec3, generation: u32, random: &mut Random, tubes: &mut Vec<Tube>) {
    let radius = TRUNK_RADIUS * RADIUS_KEPT.powi(generation as i32);
    let length = TRUNK_LENGTH * LENGTH_KEPT.powi(generation as i32);
    let to = (from + direction * length).clamp(DVec3::splat(MARGIN), DVec3::splat(1.0 - MARGIN));
    // A branch clamped to nothing at a face has no axis and is left out, with everything that would grow from it.
    if from.distance(to) < radius {
        return;
    }
    tubes.push(Tube { from, to, radius });
    if generation + 1 == GENERATIONS {
        return;
    }
    let side = direction.any_orthonormal_vector();
    let turn = random.unit() * std::f64::consts::TAU;
    let across = side * turn.cos() + direction.cross(side) * turn.sin();
    for (sign, spread) in [(1.0, 0.5 + 0.4 * random.unit()), (-1.0, 0.5 + 0.4 * random.unit())] {
        grow(to, (direction + across * (sign * spread)).normalize(), generation + 1, random, tubes);
    }
}

/// SplitMix64 (Steele, Lea, Flood 2014): small, and the same on every machine.
struct Random(u64);

impl Random {
    /// A number in [0, 1).
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
