//! Samples of the volume on a row's grid.

use crate::Fan;
use crate::blocks::Blocks;
use crate::fan::AtDepth;
use crate::gradients::{gradients_every, spread_gradients};
use crate::leaves::Leaf;
use crate::sample::{scalars_in, spreads_in, texels_at};
use crate::slab::{HALO, Keeps, LANES, Slab};
use crate::view_row::ViewRow;
use glam::{DAffine3, DVec3};
use lanes::*;
use optics::Enhancer;
use twin::gradient::Gradients;
use twin::kernel::Kernel;
use twin::levels::Brick;
use twin::ray::{Ray, far};
use twin::{Casting, vector::Vec3};

/// The columns of a leaf at a depth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub(crate) node: u32,
    /// The leaf's number among those of the slab.
    pub(crate) leaf: usize,
    depth: u32,
    /// The first, and one past the last.
    columns: [i64; 2],
}

impl Span {
    /// Blocks that its columns lie in, and those up to `beside` it.
    pub(crate) fn blocks(&self, slab: &Slab, beside: usize) -> std::ops::RangeInclusive<usize> {
        let beside = beside as i64;
        slab.block_of(self.columns[0] - beside)..=slab.block_of(self.columns[1] - 1 + beside)
    }
}

/// Where the columns of a slab lie.
pub(crate) struct Grid<'a> {
    pub(crate) casting: &'a Casting<'a, f32>,
    pub(crate) fan: &'a Fan,
    pub(crate) volume_from_display: &'a DAffine3,
    pub(crate) row: u32,
    pub(crate) enhancers: &'a [Enhancer],
}

impl Grid<'_> {
    /// Finds where a view's rays enter the volume and leave it.
    #[inline(always)]
    pub(crate) fn find_ends(&self, index: usize, view: &mut ViewRow) {
        let dims = self.casting.scene.dims.0;
        view.find_ends(self.fan, (index, self.row), self.volume_from_display, dims);
    }

    /// The columns of each leaf at each depth of a slab.
    pub(crate) fn spans(&self, slab: &Slab, leaves: &[Leaf], spans: &mut Vec<Span>) {
        spans.clear();
        let along_x = self.volume_from_display.matrix3.x_axis;
        let phases = slab.phases as f64;
        let [first, past] = slab.inner_columns();
        for (index, depth) in slab.depths.iter().enumerate() {
            let y = self.fan.y_at(self.row, depth);
            let origin = self.volume_from_display.transform_point3(DVec3::new(0.0, y, depth.z));
            for (number, leaf) in leaves.iter().enumerate() {
                // A little more than the leaf, whose box is known to rounding.
                if depth.z > leaf.z[0] + 1e-9 || depth.z < leaf.z[1] - 1e-9 {
                    continue;
                }
                let Some((from, to)) = leaf.crossing(origin, along_x) else { continue };
                let column = |x: f64| (phases * self.fan.column_of(x, depth) - 0.5).ceil() as i64;
                // All of a block is known, whoever looks at it, and so are its columns in front of what a ray meets and behind it.
                let columns = [column(from).max(first), column(to).min(past)];
                if columns[0] < columns[1] {
                    spans.push(Span { node: leaf.node, leaf: number, depth: index as u32, columns });
                }
            }
        }
    }

    /// The line of columns at a depth; its t is x.
    pub(crate) fn line(&self, depth: &AtDepth) -> Ray<f32> {
        let y = self.fan.y_at(self.row, depth);
        let origin = self.volume_from_display.transform_point3(DVec3::new(0.0, y, depth.z));
        let ray = Ray {
            origin_in_volume: Vec3(origin.to_array().map(|c| c as f32)),
            direction_in_volume: Vec3::ZERO,
            inverse: Vec3::ZERO,
            origin_in_display: Vec3([0.0, y as f32, depth.z as f32]),
            direction_in_display: Vec3::ZERO,
            start: 0.0,
            end: far(),
            speed: 0.0,
        };
        ray.turned(self.casting.scene, Vec3([1.0, 0.0, 0.0]))
    }

    /// Samples the columns that may show something, of those blocks that are `wanted`. How many there were.
    ///
    /// What a block holds depends on nothing but the block, so that it is the same whoever else looks.
    #[inline(always)]
    pub(crate) fn fill<S: Simd, K: Kernel>(
        &self,
        simd: S,
        slab: &mut Slab,
        spans: &[Span],
        wanted: &Blocks,
        keeps: Keeps,
    ) -> u64 {
        let mut samples = 0;
        let mut rays = Rays { grid: self, last: None };
        for span in spans {
            let mut known = None;
            for block in span.blocks(slab, HALO) {
                if !wanted.contains(block) {
                    continue;
                }
                let line = rays.line_of::<K>(&mut known, slab, span, keeps);
                let next = block + 1;
                let has_halo = next < slab.blocks_across() && !wanted.contains(next);
                samples += line.fill_block::<S, K>(simd, slab, block, if has_halo { HALO } else { 0 });
            }
        }
        samples
    }

    /// Gradients where something shows in front of a sample or behind it, of those blocks that are `wanted`: taken as far apart
    /// as [`gradients_every`] says, and between these elsewhere.
    #[inline(always)]
    pub(crate) fn fill_gradients<S: Simd, K: Kernel>(
        &self,
        simd: S,
        slab: &mut Slab,
        spans: &[Span],
        wanted: &Blocks,
        keeps: Keeps,
        spacing: usize,
    ) {
        let cells = slab.cells();
        let every = gradients_every(spacing, keeps.halvings);
        let mut rays = Rays { grid: self, last: None };
        for span in spans {
            let depth = span.depth as usize;
            if !depth.is_multiple_of(every) && depth != cells {
                continue;
            }
            let near = [depth.saturating_sub(every), (depth + every).min(cells)];
            let mut known = None;
            for block in span.blocks(slab, every.max(HALO)) {
                if !wanted.contains(block) || !slab.shows(block, near) {
                    continue;
                }
                let line = rays.line_of::<K>(&mut known, slab, span, keeps);
                line.fill_gradients::<K>(slab, block, every);
            }
        }
        if every > 1 {
            for block in wanted.iter() {
                spread_gradients(simd, slab, block, every);
            }
        }
    }
}

/// The lines of columns at depths that follow each other.
struct Rays<'a> {
    grid: &'a Grid<'a>,
    last: Option<(u32, Ray<f32>)>,
}

impl<'a> Rays<'a> {
    /// The line of a span, unless it is known already.
    #[inline(always)]
    fn line_of<'l, K: Kernel>(
        &mut self,
        known: &'l mut Option<Line<'a>>,
        slab: &Slab,
        span: &Span,
        keeps: Keeps,
    ) -> &'l Line<'a> {
        if known.is_none() {
            *known = Some(self.new_line::<K>(slab, span, keeps));
        }
        known.as_ref().expect("it has just been found")
    }

    #[inline(always)]
    fn new_line<K: Kernel>(&mut self, slab: &Slab, span: &Span, keeps: Keeps) -> Line<'a> {
        let Grid { casting, fan, .. } = *self.grid;
        let depth = &slab.depths[span.depth as usize];
        let ray = match self.last {
            Some((known, ray)) if known == span.depth => ray,
            _ => self.grid.line(depth),
        };
        self.last = Some((span.depth, ray));
        let phases = slab.phases as f64;
        let node = &casting.volume.nodes[span.node as usize];
        Line {
            casting,
            ray,
            brick: Brick::new::<K>(casting, node, &ray),
            depth: span.depth as usize,
            columns: span.columns,
            x: [fan.x_of(0.5 / phases, depth), fan.pitch(depth) / phases],
            keeps,
        }
    }
}

/// A leaf's part of the columns at a depth.
struct Line<'a> {
    casting: &'a Casting<'a, f32>,
    ray: Ray<f32>,
    brick: Brick<'a, f32>,
    depth: usize,
    /// The leaf's own: the first, and one past the last.
    columns: [i64; 2],
    /// x of column 0, and from each to the next.
    x: [f64; 2],
    keeps: Keeps,
}

impl Line<'_> {
    /// x of the columns from a block's first on, the same whoever looks.
    #[inline(always)]
    fn ruler(&self, first: i64) -> Ruler {
        let [of_zero, pitch] = self.x;
        Ruler { first, x: (of_zero + first as f64 * pitch) as f32, pitch: pitch as f32 }
    }

    #[inline(always)]
    fn is_own(&self, column: i64) -> bool {
        self.columns[0] <= column && column < self.columns[1]
    }

    /// Samples a block, and the columns of the next that are known with it. How many there were.
    #[inline(always)]
    fn fill_block<S: Simd, K: Kernel>(&self, simd: S, slab: &mut Slab, block: usize, halo: usize) -> u64 {
        let [first, past] = slab.columns(block);
        let past = past + halo as i64;
        let ruler = self.ruler(first);
        let mut samples = 0;
        let half = 0.5 * ruler.pitch;
        let mut column = (first - 1).max(self.columns[0]);
        let last = (past + 1).min(self.columns[1]);
        // What shows is known one column farther on both sides, so that what lies between is, too.
        let mut known = [first; 2];
        while column < last {
            let t = ruler.x_of(column) - half;
            let (shows, count) = if self.brick.has_fractions::<K>() {
                let unseen = self.brick.pairs_unseen(t, half);
                (unseen == 0, unseen.max(1))
            } else {
                self.brick.pairs_alike(t, half)
            };
            let next = (column + i64::from(count)).min(last);
            if shows {
                let shown = [(column - 1).max(known[1]), (next + 1).min(past)];
                if shown[0] > known[1] {
                    samples += self.put_all::<S, K>(simd, slab, (block, ruler), known);
                    known[0] = shown[0];
                }
                known[1] = shown[1].max(known[1]);
            }
            column = next;
        }
        samples + self.put_all::<S, K>(simd, slab, (block, ruler), known)
    }

    /// Samples a block's columns from one to before another. How many samples that took.
    #[inline(always)]
    fn put_all<S: Simd, K: Kernel>(
        &self,
        simd: S,
        slab: &mut Slab,
        (block, ruler): (usize, Ruler),
        [from, to]: [i64; 2],
    ) -> u64 {
        let first = ruler.first;
        // The leaf's own, eight at a time; where levels are mixed, none.
        let mut own = [to; 2];
        if !self.brick.has_levels::<K>() {
            own[0] = self.columns[0].clamp(from, to);
            own[1] = self.columns[1].clamp(own[0], to);
        }
        let mut samples = 0;
        for column in (from..own[0]).chain(own[1]..to) {
            let at = slab.place(self.depth, block, (column - first) as usize);
            samples += self.put::<K>(slab, (column, ruler.x_of(column)), at);
        }
        let own_level = &self.brick.own;
        let has_spreads = self.keeps.spreads && own_level.deviations.is_some();
        let mut column = own[0];
        while column < own[1] {
            let count = (own[1] - column).min(LANES as i64) as usize;
            let further = splat(simd, (column - first) as f32) + ramp(simd);
            let x = splat(simd, ruler.x) + further * splat(simd, ruler.pitch);
            let texels = texels_at(simd, own_level, x);
            let scalars = scalars_in(simd, own_level, texels).to_array();
            for (lane, &scalar) in scalars.iter().enumerate().take(count) {
                let at = slab.place(self.depth, block, (column - first) as usize + lane);
                slab.scalars[at] = scalar;
            }
            if has_spreads {
                let spreads = spreads_in(simd, own_level, texels).to_array();
                for (lane, &spread) in spreads.iter().enumerate().take(count) {
                    let at = slab.place(self.depth, block, (column - first) as usize + lane);
                    slab.spreads[at] = spread;
                }
            }
            samples += count as u64;
            column += count as i64;
        }
        samples
    }

    /// Samples a column; one that is not the leaf's own only where nothing is known. How many samples that took.
    #[inline(always)]
    fn put<K: Kernel>(&self, slab: &mut Slab, (column, x): (i64, f32), at: usize) -> u64 {
        if !self.is_own(column) && !slab.scalars[at].is_nan() {
            return 0;
        }
        slab.scalars[at] = self.brick.scalar_at::<K>(self.casting, &self.ray, x);
        if self.keeps.spreads {
            slab.spreads[at] = self.brick.spread_at::<K>(self.casting, &self.ray, x);
        }
        1
    }

    /// Gradients of a block, `every` so many columns: those that are the leaf's own, or near them and nobody else's.
    #[inline(always)]
    fn fill_gradients<K: Kernel>(&self, slab: &mut Slab, block: usize, every: usize) {
        let [first, past] = slab.columns(block);
        let ruler = self.ruler(first);
        let near = every as i64;
        let past = if every > 1 { past + 1 } else { past };
        for column in (first..past).step_by(every) {
            if column < self.columns[0] - near || column >= self.columns[1] + near {
                continue;
            }
            let place = slab.place(self.depth, block, (column - first) as usize);
            if every == 1 && slab.scalars[place].is_nan() {
                continue;
            }
            // So many rows for each of the scalars'.
            let at = place + (slab.gradient_rows - 1) * (place / slab.stride) * slab.stride;
            let is_known = [0, 1, 2].iter().any(|axis| slab.gradients[at + axis * slab.stride] != 0.0);
            if is_known && !self.is_own(column) {
                continue;
            }
            let found = Gradients::new::<K>(self.casting, &self.brick, &self.ray, ruler.x_of(column));
            for (level, gradient) in [found.at, found.coarse, found.coarsest].into_iter().enumerate() {
                for axis in (0..3).take_while(|axis| 3 * level + axis < slab.gradient_rows) {
                    slab.gradients[at + (3 * level + axis) * slab.stride] = gradient.0[axis];
                }
            }
        }
    }
}

/// Where columns lie, counted from one of them.
#[derive(Clone, Copy)]
struct Ruler {
    first: i64,
    x: f32,
    pitch: f32,
}

impl Ruler {
    #[inline(always)]
    fn x_of(&self, column: i64) -> f32 {
        self.x + (column - self.first) as f32 * self.pitch
    }
}
