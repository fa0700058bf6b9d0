//! What the leaves of a part hold at points that lie on no grid.

use crate::fill::Grid;
use crate::leaves::Leaf;
use crate::sample::{gradients_in, scalars_in, spreads_in};
use crate::slab::{LANES, Slab};
use glam::DVec3;
use lanes::*;
use layout::brick::OVERLAP;
use std::ops::RangeInclusive;
use twin::levels::Level;
use twin::traverse::OWN_EDGE;
use twin::vector::Vec3;

/// Leaves take points so many texels beyond their own, so that rounding leaves none between two.
const MARGIN: f64 = 1e-3;

/// A leaf's samples around the plane of a row.
struct NearLevel<'a> {
    /// Its t is x, at the front of the part.
    level: Level<'a, f32>,
    /// Texels per metre of z.
    along: Vec3<f32>,
    /// Its own part of the brick, texels.
    low: Vec3<f32>,
    high: Vec3<f32>,
}

/// The leaves of a part, by the blocks of its slab that they lie in.
pub(crate) struct Near<'a> {
    levels: Vec<NearLevel<'a>>,
    blocks: Vec<[i64; 2]>,
    /// z that all is counted from.
    front: f64,
    /// From the volume's axes to the display's, per finest voxel.
    turn: [Vec3<f32>; 3],
}

/// Eight points of a row's plane at one depth.
#[derive(Clone, Copy)]
pub(crate) struct Points<S: Simd> {
    pub(crate) x: f32x8<S>,
    pub(crate) z: f64,
}

/// What eight points hold.
#[derive(Clone, Copy)]
pub(crate) struct Samples<S: Simd> {
    pub(crate) scalars: f32x8<S>,
    /// Half-width of the scalars that each stands for.
    pub(crate) spreads: f32x8<S>,
    /// Whether a leaf holds them.
    pub(crate) known: mask32x8<S>,
}

impl<'a> Near<'a> {
    /// Of the leaves near a slab.
    pub(crate) fn of(grid: &Grid<'a>, leaves: &[Leaf], slab: &Slab) -> Self {
        let front = slab.depths[0].z;
        let line = grid.line(&slab.depths[0]);
        let casting = grid.casting;
        let matrix = grid.volume_from_display.matrix3;
        let along = matrix * DVec3::new(0.0, grid.fan.y_slope(grid.row), 1.0);
        let level = |leaf: &Leaf| {
            let node = &casting.volume.nodes[leaf.node as usize];
            let level = Level::new(casting, node, &line);
            let of = |v: DVec3| Vec3(v.to_array().map(|c| c as f32));
            let lowest = DVec3::from_array(node.cell.map(f64::from)) * OWN_EDGE;
            let texels = |corner: DVec3| corner / leaf.edge - lowest + OVERLAP as f64;
            NearLevel {
                level,
                along: of(along / leaf.edge),
                low: of(texels(leaf.low) - MARGIN),
                high: of(texels(leaf.high) + MARGIN),
            }
        };
        let across = |leaf: &Leaf| {
            let columns = slab.ends().map(|depth| leaf.x.map(|x| grid.fan.column_of(x, depth)));
            let [a, b] = columns.map(|[from, to]| [from.min(to), from.max(to)]);
            [a[0].min(b[0]) - 1.0, a[1].max(b[1]) + 1.0]
                .map(|column| (column.floor() as i64 - slab.base).div_euclid(LANES as i64))
        };
        let m = &casting.scene.volume_from_display;
        Self {
            levels: leaves.iter().map(level).collect(),
            blocks: leaves.iter().map(across).collect(),
            front,
            turn: [0, 1, 2].map(|axis| m[axis] * casting.scene.voxel_m),
        }
    }

    /// The leaves, by their numbers, that may hold a point of some blocks.
    pub(crate) fn find(&self, blocks: RangeInclusive<i64>, found: &mut Vec<usize>) {
        found.clear();
        let meets = |&[first, last]: &[i64; 2]| first <= *blocks.end() && last >= *blocks.start();
        found
            .extend(self.blocks.iter().enumerate().filter(|(_, held)| meets(held)).map(|(number, _)| number));
    }

    /// What points in some leaves hold.
    #[inline(always)]
    pub(crate) fn samples<S: Simd>(&self, simd: S, points: Points<S>, leaves: &[usize]) -> Samples<S> {
        let zero = splat(simd, 0.0);
        let mut samples = Samples { scalars: zero, spreads: zero, known: zero.simd_gt(zero) };
        for &leaf in leaves {
            let near = &self.levels[leaf];
            let (texels, is_inside) = self.texels(simd, near, points);
            let is_new = is_inside & !samples.known;
            if is_new.any_true() {
                samples.scalars = is_new.select(scalars_in(simd, &near.level, texels), samples.scalars);
                if near.level.deviations.is_some() {
                    let spreads = spreads_in(simd, &near.level, texels);
                    samples.spreads = is_new.select(spreads, samples.spreads);
                }
                samples.known |= is_new;
                if samples.known.all_true() {
                    break;
                }
            }
        }
        samples
    }

    /// Their gradients, display frame; 0 where none is known.
    #[inline(never)]
    pub(crate) fn gradients<S: Simd>(&self, simd: S, points: Points<S>, leaves: &[usize]) -> [f32x8<S>; 3] {
        outlined!(simd => {
        let zero = splat(simd, 0.0);
        let (mut gradients, mut known) = ([zero; 3], zero.simd_gt(zero));
        for &leaf in leaves {
            let near = &self.levels[leaf];
            let (texels, is_inside) = self.texels(simd, near, points);
            let is_new = is_inside & !known;
            if is_new.any_true() {
                let found = gradients_in(simd, &near.level, texels);
                gradients = each!(axis of 3 => is_new.select(found[axis], gradients[axis]));
                known |= is_new;
                if known.all_true() {
                    break;
                }
            }
        }
        let [a, b, c] = gradients;
        each!(axis of 3 => {
            let Vec3([x, y, z]) = self.turn[axis];
            a * splat(simd, x) + b * splat(simd, y) + c * splat(simd, z)
        })
        })
    }

    /// Where points lie in a leaf's brick, and which in its own part of it.
    #[inline(always)]
    fn texels<S: Simd>(&self, simd: S, near: &NearLevel, points: Points<S>) -> ([f32x8<S>; 3], mask32x8<S>) {
        let behind = (points.z - self.front) as f32;
        let origin = near.level.point(0.0) + near.along * behind;
        let slope = near.level.slope;
        let texels = each!(axis of 3 => splat(simd, origin.0[axis]) + splat(simd, slope.0[axis]) * points.x);
        let is_inside = each!(axis of 3 => {
            texels[axis].simd_ge(splat(simd, near.low.0[axis])) & texels[axis].simd_le(splat(simd, near.high.0[axis]))
        });
        (texels, is_inside[0] & is_inside[1] & is_inside[2])
    }
}
