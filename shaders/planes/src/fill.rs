//! Samples of the volume on a row's grid.

use crate::Fan;
use crate::fan::AtDepth;
use crate::leaves::Leaf;
use crate::slab::{Keeps, LANES, Slab};
use glam::{DAffine3, DVec3};
use twin::gradient::Gradients;
use twin::kernel::Kernel;
use twin::levels::Brick;
use twin::ray::Ray;
use twin::{Casting, vector::Vec3};

/// The columns of a leaf at a depth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub(crate) node: u32,
    depth: u32,
    /// Whether it is the leaf's first in the slab.
    pub(crate) is_first: bool,
    /// The first, and one past the last.
    columns: [i64; 2],
}

impl Span {
    /// The blocks of its columns.
    pub(crate) fn blocks(&self, slab: &Slab) -> impl Iterator<Item = usize> {
        let [from, to] = [self.columns[0], self.columns[1] - 1].map(|column| slab.place(column).1 / LANES);
        from..=to
    }
}

/// Where the columns of a slab lie.
pub(crate) struct Grid<'a> {
    pub(crate) casting: &'a Casting<'a, f32>,
    pub(crate) fan: &'a Fan,
    pub(crate) volume_from_display: &'a DAffine3,
    pub(crate) row: u32,
}

impl Grid<'_> {
    /// The columns of each leaf at each depth of a slab.
    pub(crate) fn spans(&self, slab: &Slab, leaves: &[Leaf], spans: &mut Vec<Span>) {
        spans.clear();
        let along_x = self.volume_from_display.matrix3.x_axis;
        let phases = slab.phases as f64;
        for (index, depth) in slab.depths.iter().enumerate() {
            let y = self.fan.y_at(self.row, depth);
            let origin = self.volume_from_display.transform_point3(DVec3::new(0.0, y, depth.z));
            let (seen_low, seen_high) = self.fan.seen(depth);
            let seen = [seen_low, seen_high].map(|u| (phases * u - 0.5).ceil() as i64);
            for leaf in leaves {
                // A little more than the leaf, whose box is known to rounding.
                if depth.z > leaf.z[0] + 1e-9 || depth.z < leaf.z[1] - 1e-9 {
                    continue;
                }
                let Some((from, to)) = crossing(leaf, origin, along_x) else { continue };
                let column = |x: f64| (phases * self.fan.column_of(x, depth) - 0.5).ceil() as i64;
                let columns = [column(from).max(seen[0] - 1), column(to).min(seen[1] + 1)];
                if columns[0] < columns[1] {
                    let before = slab.depths[..index].last();
                    let is_first = before.is_none_or(|before| before.z > leaf.z[0] + 1e-9);
                    spans.push(Span { node: leaf.node, depth: index as u32, is_first, columns });
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
            speed: 0.0,
        };
        ray.turned(self.casting.scene, Vec3([1.0, 0.0, 0.0]))
    }

    /// Samples the columns of spans that may show something and that `wanted` names, block by block. How many there were.
    #[inline(always)]
    pub(crate) fn fill<K: Kernel>(
        &self,
        slab: &mut Slab,
        spans: &[Span],
        wanted: &[bool],
        keeps: Keeps,
    ) -> u64 {
        let mut samples = 0;
        let mut line = None;
        for span in spans {
            let depth = slab.depths[span.depth as usize];
            let ray = match line {
                Some((known, ray)) if known == span.depth => ray,
                _ => self.line(&depth),
            };
            line = Some((span.depth, ray));
            let node = &self.casting.volume.nodes[span.node as usize];
            let brick = Brick::new::<K>(self.casting, node, &ray);
            let pitch = (self.fan.pitch(&depth) / slab.phases as f64) as f32;
            let first_x = self.fan.x_of((span.columns[0] as f64 + 0.5) / slab.phases as f64, &depth) as f32;
            let x_of = |column: i64| first_x + (column - span.columns[0]) as f32 * pitch;
            let rows = slab.row_start(span.depth as usize, 0);
            let line = Line { casting: self.casting, ray: &ray, brick: &brick, rows, keeps };
            let mut column = Column::at(slab, span.columns[0]);
            let mut was_seen = false;
            while column.index < span.columns[1] {
                let block = column.entry / LANES;
                let unseen = if wanted[block] {
                    let half = 0.5 * pitch;
                    i64::from(brick.pairs_unseen::<K>(x_of(column.index) - half, half))
                } else {
                    // To the next block.
                    let next = (slab.base + ((block + 1) * LANES) as i64) * slab.phases as i64;
                    next - column.index
                };
                // What shows is known one column farther on both sides, so that what lies between is, too.
                if unseen > 0 {
                    if was_seen {
                        samples += line.put::<K>(slab, column, x_of(column.index), false);
                    }
                    was_seen = false;
                    column = Column::at(slab, column.index + unseen);
                    continue;
                }
                if !was_seen {
                    let before = Column::at(slab, column.index - 1);
                    samples += line.put::<K>(slab, before, x_of(before.index), false);
                }
                samples += line.put::<K>(slab, column, x_of(column.index), true);
                was_seen = true;
                column = column.next(slab);
            }
            if was_seen {
                let end = Column::at(slab, span.columns[1]);
                samples += line.put::<K>(slab, end, x_of(end.index), false);
            }
        }
        samples
    }

    /// Gradients where something shows in front of a sample or behind it.
    #[inline(always)]
    pub(crate) fn fill_gradients<K: Kernel>(&self, slab: &mut Slab, spans: &[Span]) {
        let cells = slab.cells();
        for span in spans {
            let depth_index = span.depth as usize;
            let depth = slab.depths[depth_index];
            let mut known: Option<(Ray<f32>, Brick<f32>)> = None;
            for column in span.columns[0] - 1..span.columns[1] + 1 {
                let (phase, entry) = slab.place(column);
                let row = slab.row_start(depth_index, phase);
                if slab.scalars[row + entry].is_nan() {
                    continue;
                }
                let is_own = column >= span.columns[0] && column < span.columns[1];
                let block = entry / LANES;
                // A view that meets a block meets the next one's first columns as well.
                let shows = |cell: usize| {
                    let at = cell * slab.blocks_across() + block;
                    slab.blocks[at] != 0 || (block > 0 && slab.blocks[at - 1] != 0)
                };
                if !((depth_index > 0 && shows(depth_index - 1))
                    || (depth_index < cells && shows(depth_index)))
                {
                    continue;
                }
                let at = 3 * row + entry;
                if !is_own && slab.gradients[at..].iter().step_by(slab.stride).take(3).any(|&g| g != 0.0) {
                    continue;
                }
                let (ray, brick) = known.get_or_insert_with(|| {
                    let ray = self.line(&depth);
                    let node = &self.casting.volume.nodes[span.node as usize];
                    (ray, Brick::new::<K>(self.casting, node, &ray))
                });
                let x = self.fan.x_of((column as f64 + 0.5) / slab.phases as f64, &depth) as f32;
                let gradient = Gradients::new::<K>(self.casting, brick, ray, x).at;
                for axis in 0..3 {
                    slab.gradients[at + axis * slab.stride] = gradient.0[axis];
                }
            }
        }
    }
}

/// A column, and where a slab keeps it.
#[derive(Clone, Copy)]
struct Column {
    index: i64,
    phase: usize,
    entry: usize,
}

impl Column {
    #[inline(always)]
    fn at(slab: &Slab, index: i64) -> Self {
        let (phase, entry) = slab.place(index);
        Self { index, phase, entry }
    }

    #[inline(always)]
    fn next(self, slab: &Slab) -> Self {
        let index = self.index + 1;
        if self.phase + 1 < slab.phases {
            Self { index, phase: self.phase + 1, ..self }
        } else {
            Self { index, phase: 0, entry: self.entry + 1 }
        }
    }
}

/// A leaf's part of the columns at a depth.
struct Line<'a> {
    casting: &'a Casting<'a, f32>,
    ray: &'a Ray<f32>,
    brick: &'a Brick<'a, f32>,
    /// Where the depth's rows begin.
    rows: usize,
    keeps: Keeps,
}

impl Line<'_> {
    /// Samples a column; one that is not the leaf's own only where nothing is known. How many samples that took.
    #[inline(always)]
    fn put<K: Kernel>(&self, slab: &mut Slab, column: Column, x: f32, is_own: bool) -> u64 {
        let at = self.rows + column.phase * slab.stride + column.entry;
        if !is_own && !slab.scalars[at].is_nan() {
            return 0;
        }
        slab.scalars[at] = self.brick.scalar_at::<K>(self.casting, self.ray, x);
        if self.keeps.spreads {
            slab.spreads[at] = self.brick.spread_at::<K>(self.casting, self.ray, x);
        }
        1
    }
}

/// The first and the last column of all spans, in pixels.
pub(crate) fn extent(spans: &[Span], phases: usize) -> Option<(i64, i64)> {
    let pixels = |column: i64| column.div_euclid(phases as i64);
    spans.iter().fold(None, |extent: Option<(i64, i64)>, span| {
        let (first, last) = (pixels(span.columns[0] - 1), pixels(span.columns[1]));
        Some(extent.map_or((first, last), |(low, high)| (low.min(first), high.max(last))))
    })
}

/// Where the line from `origin` along `direction` is in the leaf's box: [from, to).
fn crossing(leaf: &Leaf, origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
    let (mut enter, mut leave) = (f64::MIN, f64::MAX);
    for axis in 0..3 {
        if direction[axis].abs() < 1e-12 {
            if origin[axis] < leaf.low[axis] || origin[axis] >= leaf.high[axis] {
                return None;
            }
        } else {
            let a = (leaf.low[axis] - origin[axis]) / direction[axis];
            let b = (leaf.high[axis] - origin[axis]) / direction[axis];
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
    }
    (enter < leave).then_some((enter, leave))
}
