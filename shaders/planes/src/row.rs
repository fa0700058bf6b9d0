//! One screen row of all views, from the front to the back.

use crate::Fan;
use crate::classify::Classing;
use crate::fill::{Grid, Span, extent};
use crate::fine::FineTable;
use crate::lanes::{Level, Simd, dispatch};
use crate::leaves::{Leaf, leaves, volume_from_display};
use crate::rough::Roughness;
use crate::slab::{Keeps, LANES, Slab};
use crate::steep::Steep;
use crate::sweep::{Places, Sweep};
use crate::view_row::ViewRow;
use glam::{DAffine3, DVec3};
use needs::{Levels, Shading};
use twin::Casting;
use twin::composite::Over;
use twin::kernel::{Blended, Full, Kernel, Lean};
use twin::shade::Plain;

/// Depths of a slab, less one: what is sampled of them fits a core's own cache beside the views' rows.
const CELLS: f64 = 16.0;

/// Columns per pixel, at most: more are worth no memory.
const MOST_PHASES: f64 = 256.0;

/// Spacing at this tolerance, where something may hide in a voxel and where media are thin; from studies of both.
const AT_TOLERANCE: f64 = 1e-4;
const DENSE: Spacing = Spacing { step: 0.4, pitch: 0.3 };
const THIN: Spacing = Spacing { step: 1.0, pitch: 1.0 };
/// A voxel is thin if its optical depth is below this, as it is for rays.
const THIN_DEPTH: f32 = 0.04;

/// Bounds of the error of a cell's means, and of the order of what a cell shows, in tolerances: as bounds they lie far above
/// the errors themselves.
const MEAN_ERROR: f32 = 300.0;
const ORDER_ERROR: f32 = 10.0;

/// A scene, ready to be cast row by row.
pub struct Planes<'a> {
    casting: &'a Casting<'a, f32>,
    fan: &'a Fan,
    volume_from_display: DAffine3,
    leaves: Vec<Leaf>,
    roughness: Roughness,
    fine: FineTable,
    level: Level,
    /// Where something may hide in a voxel, and where media are thin.
    dense: Spacing,
    thin: Spacing,
    /// The largest error of a cell's means, and of the order of what a cell shows.
    mean_tolerance: f32,
    order_tolerance: f32,
}

/// How far apart samples lie, in voxels of the finest leaf around.
#[derive(Clone, Copy, Debug)]
struct Spacing {
    /// From one depth to the next.
    step: f64,
    /// From one column to the next, at most.
    pitch: f64,
}

impl Spacing {
    fn times(self, factor: f64) -> Self {
        Self { step: self.step * factor, pitch: self.pitch * factor }
    }
}

/// What one thread keeps from row to row.
#[derive(Debug, Default)]
pub struct Scratch {
    slab: Slab,
    spans: Vec<Span>,
    leaves: Vec<Leaf>,
    views: Vec<ViewRow>,
    places: Places,
    wanted: Vec<bool>,
}

/// What a row brought back, its colours apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RowCast {
    /// Samples of the volume.
    pub samples: u64,
    /// Whether a node on the way was too coarse.
    pub is_missing: bool,
}

impl<'a> Planes<'a> {
    /// The scene of `casting` for the views of `fan`.
    pub fn new(casting: &'a Casting<'a, f32>, fan: &'a Fan) -> Self {
        let tolerance = f64::from(casting.scene.tolerance);
        // Errors fall with the square of the distance.
        let closer = if tolerance < 1.0 { (tolerance / AT_TOLERANCE).sqrt().clamp(0.125, 2.0) } else { 1.0 };
        Self {
            casting,
            fan,
            volume_from_display: volume_from_display(casting),
            leaves: leaves(casting, fan),
            roughness: Roughness::of(casting.tables),
            fine: FineTable::of(casting.tables),
            level: Level::new(),
            dense: DENSE.times(closer),
            thin: THIN.times(closer),
            mean_tolerance: casting.scene.tolerance * MEAN_ERROR,
            order_tolerance: casting.scene.tolerance * ORDER_ERROR,
        }
    }

    /// The same with the fewest instructions that this kind of processor has: the same bits, only later.
    #[must_use]
    pub fn plainly(self) -> Self {
        Self { level: Level::baseline(), ..self }
    }

    /// Why rays have to serve these needs instead.
    pub fn refusal(needs: &needs::Needs) -> Option<&'static str> {
        if needs.way != needs::Way::Straight {
            return Some("light is bent");
        }
        if needs.compositing != needs::Compositing::Over || needs.tells_importance {
            return Some("importance is accumulated");
        }
        if needs.chain != needs::Chain::EMPTY {
            return Some("the scene has enhancers");
        }
        if needs.has_materials || needs.shading.has_detail() {
            return Some("shading has materials or shows detail");
        }
        needs.debug.map(|_| "a debug view is shown")
    }

    /// Casts a row of all views into `out`: for each view RGBA, pixel by pixel.
    pub fn cast_row(&self, row: u32, scratch: &mut Scratch, out: &mut [&mut [f32]]) -> RowCast {
        dispatch!(self.level, simd => self.cast_row_on(simd, row, scratch, out))
    }

    #[inline(always)]
    fn cast_row_on<S: Simd>(
        &self,
        simd: S,
        row: u32,
        scratch: &mut Scratch,
        out: &mut [&mut [f32]],
    ) -> RowCast {
        let needs = self.casting.needs;
        let light = (needs.shading != Shading::Plain).then_some(self.casting.scene.toward_light.0);
        scratch.views.resize_with(self.fan.offsets.len(), ViewRow::default);
        for (view, state) in scratch.views.iter_mut().enumerate() {
            state.begin(self.fan, view, row, light);
        }
        let cast = if needs.levels == Levels::Quadrilinear {
            self.cast_slabs::<S, Full<Plain, Over<false>>>(simd, row, scratch)
        } else if needs.blends || needs.spreads {
            self.cast_slabs::<S, Blended<Plain, Over<false>>>(simd, row, scratch)
        } else {
            self.cast_slabs::<S, Lean<Plain, Over<false>>>(simd, row, scratch)
        };
        for (state, out) in scratch.views.iter().zip(out) {
            for (i, pixel) in out.chunks_exact_mut(4).enumerate() {
                for (c, value) in pixel.iter_mut().enumerate() {
                    *value = state.rgba[c][i];
                }
            }
        }
        cast
    }

    #[inline(always)]
    fn cast_slabs<S: Simd, K: Kernel>(&self, simd: S, row: u32, scratch: &mut Scratch) -> RowCast {
        let mut cast = RowCast::default();
        let Scratch { slab, spans, leaves, views, places, wanted } = scratch;
        leaves.clear();
        leaves.extend(self.leaves.iter().filter(|leaf| leaf.rows[0] <= row && row < leaf.rows[1]));
        if leaves.is_empty() {
            return cast;
        }
        let bottom = leaves.iter().fold(f64::MAX, |z, leaf| z.min(leaf.z[1]));
        let mut z = leaves.iter().fold(f64::MIN, |z, leaf| z.max(leaf.z[0]));
        let needs = self.casting.needs;
        let along_ray = DVec3::new(0.0, self.fan.y_slope(row), 1.0);
        let speed = (self.volume_from_display.matrix3 * along_ray).length();
        let grid = Grid {
            casting: self.casting,
            fan: self.fan,
            volume_from_display: &self.volume_from_display,
            row,
        };
        let steep = Steep {
            casting: self.casting,
            fine: &self.fine,
            roughness: &self.roughness,
            tolerance: self.order_tolerance,
        };
        let mut has_ends = false;
        while z > bottom {
            let Some((spacing, edge, to)) = self.next_slab(leaves, z, 1.0 / speed) else {
                z = leaves.iter().filter(|leaf| leaf.z[0] < z).fold(f64::MIN, |z, leaf| z.max(leaf.z[0]));
                continue;
            };
            let to = to.max(bottom);
            let cells = ((z - to) / (edge * spacing.step / speed)).ceil().max(1.0) as usize;
            let step = (z - to) / cells as f64;
            slab.depths.clear();
            slab.depths.extend((0..=cells).map(|k| self.fan.at(z - k as f64 * step)));
            slab.middles.clear();
            slab.middles.extend((0..cells).map(|k| self.fan.at(z - (k as f64 + 0.5) * step)));
            let across = self.fan.pitch(&slab.depths[0]).max(self.fan.pitch(&slab.depths[cells]));
            let voxels = across * self.volume_from_display.matrix3.x_axis.length() / edge;
            slab.phases = (voxels / spacing.pitch).ceil().clamp(1.0, MOST_PHASES) as usize;
            let is_outer = |leaf: &Leaf| leaf.is_outer && leaf.z[0] > to && leaf.z[1] < z;
            let keeps = Keeps { spreads: needs.spreads, gradients: needs.shading != Shading::Plain };
            slab.is_outer = leaves.iter().any(is_outer);
            z = to;
            grid.spans(slab, leaves, spans);
            let Some((first, last)) = extent(spans, slab.phases) else { continue };
            slab.clear(first, last, keeps);
            if !self.find_wanted(slab, views, wanted) {
                continue;
            }
            let samples = grid.fill::<K>(slab, spans, wanted, keeps);
            self.note(slab, spans, wanted, &mut cast);
            cast.samples += samples;
            if samples == 0 {
                continue;
            }
            let thickness = self.casting.scene.extinction_per_metre * step as f32;
            let classing =
                Classing { steep, thickness, tolerance: self.mean_tolerance, views_differ: keeps.gradients };
            classing.find_blocks(slab);
            if slab.any.iter().all(|&any| any == 0) {
                continue;
            }
            if !classing.views_differ {
                classing.find_means(simd, slab);
            }
            if keeps.gradients {
                grid.fill_gradients::<K>(slab, spans);
            }
            if slab.is_outer && !has_ends {
                has_ends = true;
                let dims = self.casting.scene.dims.0;
                for (view, state) in views.iter_mut().enumerate() {
                    state.find_ends(self.fan, (view, row), &self.volume_from_display, dims);
                }
            }
            for (view, state) in views.iter_mut().enumerate() {
                let sweep = Sweep { fan: self.fan, slab, view, row, thickness, steep };
                sweep.add(simd, state, places);
            }
        }
        cast
    }

    /// How the slab from z on is spaced, by the voxel's edge that it goes by, and where it ends; a voxel of edge 1 is `voxel`
    /// metres deep. None where no leaf is.
    fn next_slab(&self, leaves: &[Leaf], z: f64, voxel: f64) -> Option<(Spacing, f64, f64)> {
        let slab = |spacing: Spacing| next_slab(leaves, z, CELLS * spacing.step * voxel);
        if let Some((edge, to)) = slab(self.thin) {
            let is_thin = |leaf: &&Leaf| {
                let extinction = self.casting.volume.nodes[leaf.node as usize].most_extinction;
                let depth = extinction * self.casting.scene.extinction_per_metre * (leaf.edge * voxel) as f32;
                depth < THIN_DEPTH
            };
            if leaves.iter().filter(|leaf| leaf.z[0] > to && leaf.z[1] < z).all(|leaf| is_thin(&leaf)) {
                return Some((self.thin, edge, to));
            }
        }
        slab(self.dense).map(|(edge, to)| (self.dense, edge, to))
    }

    /// Which blocks of columns some view still sees; whether there is any.
    fn find_wanted(&self, slab: &Slab, views: &[ViewRow], wanted: &mut Vec<bool>) -> bool {
        wanted.clear();
        wanted.resize(slab.blocks_across(), false);
        let ends =
            [slab.depths.first(), slab.depths.last()].map(|depth| depth.expect("a slab has two depths"));
        let lanes = LANES as i64;
        let last = slab.blocks_across() as i64 - 1;
        for (view, state) in views.iter().enumerate() {
            let entries = ends.map(|depth| (0.5 + self.fan.shift(view, depth)).floor() as i64 - slab.base);
            let (low, high) = (entries[0].min(entries[1]) - 1, entries[0].max(entries[1]) + 1);
            for (block, &is_closed) in state.closed.iter().enumerate() {
                let pixel = block as i64 * lanes;
                let from = (low + pixel).div_euclid(lanes).max(0);
                let to = (high + pixel + lanes).div_euclid(lanes).min(last);
                if !is_closed && from <= to {
                    wanted[from as usize..=to as usize].fill(true);
                }
            }
        }
        wanted.iter().any(|&is_wanted| is_wanted)
    }

    /// Notes the leaves that were looked at.
    fn note(&self, slab: &Slab, spans: &[Span], wanted: &[bool], cast: &mut RowCast) {
        for span in spans {
            if span.is_first && span.blocks(slab).any(|block| wanted[block]) {
                let node = &self.casting.volume.nodes[span.node as usize];
                self.casting.observer.note(span.node, node.deficit);
                cast.is_missing |= node.deficit > 0.0;
            }
        }
    }
}

/// The voxel's edge by which the slab from z on is spaced, the coarsest that no leaf in it is finer than; and where it ends,
/// some times that many `voxel`s away. None where no leaf is.
fn next_slab(leaves: &[Leaf], z: f64, depth: f64) -> Option<(f64, f64)> {
    let mut edges: Vec<f64> = leaves.iter().map(|leaf| leaf.edge).collect();
    edges.sort_by(|a, b| b.total_cmp(a));
    edges.dedup();
    let meets = |to: f64| leaves.iter().filter(move |leaf| leaf.z[0] > to && leaf.z[1] < z);
    let end = |edge: f64| z - edge * depth;
    meets(end(*edges.last()?)).next()?;
    edges
        .into_iter()
        .map(|edge| (edge, end(edge)))
        .find(|&(edge, to)| meets(to).all(|leaf| leaf.edge >= edge))
}
