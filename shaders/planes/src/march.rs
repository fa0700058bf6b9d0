//! A row's plane, from the front to the back: how far apart samples lie in each part of it, and what every view adds of them.

use crate::around::Around;
use crate::blocks::Blocks;
use crate::classify::Classing;
use crate::fill::{Grid, Span};
use crate::gradients::gradients_every;
use crate::leaves::{Leaf, extent};
use crate::near::Near;
use crate::need::{Judge, SPACINGS, spacing_for};
use crate::parts::{Part, parts, phases_of};
use crate::places::Places;
use crate::rough::Variation;
use crate::slab::{Keeps, Slab};
use crate::steep::Steep;
use crate::sweep::Sweep;
use crate::view_row::ViewRow;
use lanes::Simd;
use twin::kernel::Kernel;

/// Cells of a slab at closer spacings: what is sampled of them fits a core's own cache beside the views' rows.
const FINE_CELLS: usize = 16;
// A sweep has a bit for each.
const _: () = assert!(FINE_CELLS <= u32::BITS as usize);

/// What one thread keeps from slab to slab.
#[derive(Debug, Default)]
pub(crate) struct Room {
    wide: Slab,
    close: Slab,
    spans: Vec<Span>,
    near: Vec<Leaf>,
    /// Which of these were noted.
    noted: Vec<bool>,
    places: Places,
    bends: Vec<f32>,
    wanted: Blocks,
    need: [Blocks; SPACINGS],
    /// Which blocks of the widest slab each view's pixels meet.
    reaches: Vec<[i64; 2]>,
    pixels: Blocks,
}

/// What a row brought back, its colours apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RowCast {
    /// Samples of the volume.
    pub samples: u64,
    /// Whether a node on the way was too coarse.
    pub is_missing: bool,
}

/// A row of all views.
pub(crate) struct March<'a> {
    pub(crate) grid: Grid<'a>,
    pub(crate) variation: &'a Variation,
    pub(crate) steep: Steep<'a>,
    /// Voxels per metre of depth.
    pub(crate) speed: f64,
    pub(crate) keeps: Keeps,
    /// γ of importance accumulation; 0 where there is none.
    pub(crate) gamma: f32,
    /// Whether each pixel goes through the rays' own code.
    pub(crate) is_by_pixel: bool,
    /// Whether rays sample for themselves what is too steep; otherwise, and for smaller tolerances, the plane is sampled closer there.
    pub(crate) is_alone: bool,
    /// The largest error of a cell's light that distances between samples may make, and that means may.
    pub(crate) tolerances: [f32; 2],
}

impl March<'_> {
    /// Adds all that the leaves show to the views.
    #[inline(always)]
    pub(crate) fn run<S: Simd, K: Kernel>(
        &self,
        simd: S,
        leaves: &[Leaf],
        views: &mut [ViewRow],
        room: &mut Room,
    ) -> RowCast {
        let mut cast = RowCast::default();
        let mut has_ends = false;
        for part in parts(leaves, self.speed) {
            let [z, to] = part.z;
            room.near.clear();
            room.near.extend(leaves.iter().filter(|leaf| leaf.z[0] > to && leaf.z[1] < z));
            self.add_part::<S, K>(simd, part, views, room, &mut has_ends, &mut cast);
        }
        cast
    }

    #[inline(always)]
    fn add_part<S: Simd, K: Kernel>(
        &self,
        simd: S,
        part: Part,
        views: &mut [ViewRow],
        room: &mut Room,
        has_ends: &mut bool,
        cast: &mut RowCast,
    ) {
        let is_outer = room.near.iter().any(|leaf| leaf.is_outer);
        let slab = &mut room.wide;
        self.lay_out(slab, part, 0, is_outer);
        let columns = extent(self.grid.fan, &room.near, slab.ends());
        if columns[0] >= columns[1] {
            return;
        }
        slab.lay_columns(columns);
        self.grid.spans(slab, &room.near, &mut room.spans);
        if room.spans.is_empty() {
            return;
        }
        room.wanted.clear(slab.blocks_across());
        room.reaches.clear();
        for (view, state) in views.iter().enumerate() {
            let reach = slab.reach(self.grid.fan, view);
            room.wanted.add_moved(&state.open, reach);
            room.reaches.push(reach);
        }
        // The last one is there for what is loaded beyond another.
        room.wanted.remove(slab.blocks_across() - 1);
        if room.wanted.is_empty() {
            return;
        }
        slab.clear(&room.wanted, self.keeps);
        let samples = self.grid.fill::<S, K>(simd, slab, &room.spans, &room.wanted, self.keeps);
        room.noted.clear();
        room.noted.resize(room.near.len(), false);
        self.note(slab, &room.spans, &room.wanted, &mut room.noted, cast);
        cast.samples += samples;
        if samples == 0 {
            return;
        }
        let step = (part.z[0] - part.z[1]) / part.cells as f64;
        let extinction = self.grid.casting.scene.extinction_per_metre;
        let judge = Judge {
            grid: &self.grid,
            variation: self.variation,
            thickness: extinction * step as f32,
            gamma: self.gamma,
            tolerance: self.tolerances[0],
        };
        judge.find(simd, slab, &room.wanted, &mut room.bends, &mut room.need[0]);
        if room.need[0].is_empty() {
            return;
        }
        if is_outer && !*has_ends {
            *has_ends = true;
            for (view, state) in views.iter_mut().enumerate() {
                self.grid.find_ends(view, state);
            }
        }
        let is_steep = self.is_alone && slab.apart.iter().any(|&apart| apart > 1.0);
        let near = is_steep.then(|| Near::of(&self.grid, &room.near, slab));
        if near.is_some() {
            room.need[1..].iter_mut().for_each(|blocks| blocks.clear(0));
        } else {
            spread_need(slab, self.keeps.halvings, &mut room.need);
        }
        for spacing in 0..SPACINGS {
            if room.need[spacing].is_empty() {
                break;
            }
            self.add_spacing::<S, K>(simd, (part, spacing), near.as_ref(), views, room, cast);
        }
    }

    /// Adds those pixels of a part that need one spacing.
    #[inline(always)]
    fn add_spacing<S: Simd, K: Kernel>(
        &self,
        simd: S,
        (part, spacing): (Part, usize),
        off_grid: Option<&Near>,
        views: &mut [ViewRow],
        room: &mut Room,
        cast: &mut RowCast,
    ) {
        let Room { wide, close, spans, near, places, wanted, need, reaches, pixels, .. } = room;
        let fan = self.grid.fan;
        let closer = need.get(spacing + 1);
        let cells = part.cells << spacing;
        let count = if spacing == 0 { 1 } else { cells.div_ceil(FINE_CELLS) };
        (close.base, close.stride) = (wide.base, wide.stride);
        let is_outer = wide.is_outer;
        let slab = if spacing == 0 { wide } else { close };
        for slice in 0..count {
            let bounds = [slice * cells / count, (slice + 1) * cells / count];
            let z = bounds.map(|cell| part.z[0] + (part.z[1] - part.z[0]) * (cell as f64 / cells as f64));
            let slice = Part { z, cells: bounds[1] - bounds[0], ..part };
            if spacing > 0 {
                self.lay_out(slab, slice, spacing, is_outer);
            }
            wanted.clear(slab.blocks_across());
            for (view, state) in views.iter().enumerate() {
                if pixels_of(state, reaches[view], &need[spacing], closer, pixels) {
                    wanted.add_moved(pixels, slab.reach(fan, view));
                }
            }
            wanted.remove(slab.blocks_across() - 1);
            if wanted.is_empty() {
                continue;
            }
            if spacing > 0 {
                self.grid.spans(slab, near, spans);
                slab.clear(wanted, self.keeps);
                let samples = self.grid.fill::<S, K>(simd, slab, spans, wanted, self.keeps);
                cast.samples += samples;
                if samples == 0 {
                    continue;
                }
            }
            let depth = (slice.z[0] - slice.z[1]) / slice.cells as f64;
            let thickness = self.grid.casting.scene.extinction_per_metre * depth as f32;
            let tolerance = self.tolerances[1] / (1 << spacing) as f32;
            let classing = Classing { steep: self.steep, variation: self.variation, thickness, tolerance };
            classing.find_blocks(simd, slab, wanted);
            if self.keeps.gradient_levels > 0 {
                self.grid.fill_gradients::<S, K>(simd, slab, spans, wanted, self.keeps, spacing);
            }
            if !self.is_by_pixel {
                classing.settle(simd, slab, wanted);
                slab.find_kinds(tolerance, off_grid.is_some());
            }
            let is_fine = self.steep.is_fine(&Around::ALL, thickness);
            for (view, state) in views.iter_mut().enumerate() {
                if pixels_of(state, reaches[view], &need[spacing], closer, pixels) {
                    let [least, most] = slab.reach(fan, view);
                    pixels.keep_moved(&slab.shown, [-most, -least]);
                    let sweep = Sweep {
                        fan,
                        slab,
                        view,
                        row: self.grid.row,
                        thickness,
                        steep: self.steep,
                        tolerance,
                        is_by_pixel: self.is_by_pixel,
                        near: off_grid,
                        lines: fan.lines(view),
                        is_fine,
                    };
                    sweep.add(simd, state, pixels, places);
                    cast.samples += std::mem::take(&mut places.samples);
                }
            }
        }
    }

    /// Says where a slab lies.
    #[inline(always)]
    fn lay_out(&self, slab: &mut Slab, part: Part, spacing: usize, is_outer: bool) {
        let fan = self.grid.fan;
        let Part { z: [z, to], edge, cells } = part;
        let at = |k: f64| fan.at(z + (to - z) * (k / cells as f64));
        slab.depths.clear();
        slab.depths.extend((0..=cells).map(|k| at(k as f64)));
        slab.middles.clear();
        slab.middles.extend((0..cells).map(|k| at(k as f64 + 0.5)));
        let per_metre = self.grid.volume_from_display.matrix3.x_axis.length();
        let phases = phases_of(
            [&slab.depths[0], &slab.depths[cells]].map(|at| fan.pitch(at) * per_metre),
            edge,
            spacing,
        );
        slab.phases = phases.next_multiple_of(gradients_every(spacing, self.keeps.halvings));
        slab.is_outer = is_outer;
    }

    /// Notes the leaves that were looked at, each once, at whichever depth.
    fn note(&self, slab: &Slab, spans: &[Span], wanted: &Blocks, noted: &mut [bool], cast: &mut RowCast) {
        for span in spans {
            if !noted[span.leaf] && span.blocks(slab, 0).any(|block| wanted.contains(block)) {
                noted[span.leaf] = true;
                let casting = self.grid.casting;
                let node = &casting.volume.nodes[span.node as usize];
                casting.observer.note(span.node, node.deficit);
                cast.is_missing |= node.deficit > 0.0;
            }
        }
    }
}

/// Which blocks need at least each spacing but the first, of which all need the `least`, where views share all samples.
fn spread_need(slab: &Slab, least: usize, need: &mut [Blocks; SPACINGS]) {
    let across = slab.blocks_across();
    let [showing, closer @ ..] = need;
    closer.iter_mut().for_each(|blocks| blocks.clear(across));
    for block in showing.iter() {
        let apart = (0..slab.cells()).map(|cell| slab.apart[cell * across + block]).fold(0.0, f32::max);
        closer.iter_mut().take(spacing_for(apart, 1.0).max(least)).for_each(|blocks| blocks.insert(block));
    }
}

/// Those blocks of a view's pixels that meet blocks in `need`, but none in `closer`. Whether there is any.
#[inline(always)]
fn pixels_of(
    view: &ViewRow,
    [least, most]: [i64; 2],
    need: &Blocks,
    closer: Option<&Blocks>,
    pixels: &mut Blocks,
) -> bool {
    pixels.clear(view.open.len());
    pixels.add_moved(need, [-most, -least]);
    if pixels.is_empty() {
        return false;
    }
    pixels.intersect(&view.open);
    if let Some(closer) = closer {
        pixels.subtract_moved(closer, [-most, -least]);
    }
    !pixels.is_empty()
}
