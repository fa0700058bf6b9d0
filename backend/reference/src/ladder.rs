//! A leaf with the two nodes above it, and the blend between them.

use super::cell::Cell;
use super::cut::{Cut, Grid, Leaf, Voxels};
use super::field::Levels;
use super::fit::{Fit, GRADIENT_SLACK, MOST_BISECTIONS};
use super::level::Blending;
use super::{Cubic, Line, Piece, Visitor};
use bricks::BrickError;
use glam::DVec3;
use std::ops::ControlFlow;

/// A node's samples.
struct Rung<'a> {
    grid: &'a Grid,
    voxels: &'a Voxels,
}

/// A leaf's samples, its parent's and its grandparent's, as far as these exist.
pub struct Ladder<'a> {
    rungs: Vec<Rung<'a>>,
}

/// A line's way between two t inside the leaf, on which λ − ℓ, or what the corners make of it, has no kink.
struct Way<'a> {
    ladder: &'a Ladder<'a>,
    line: &'a Line,
    /// What blends, and None if it is the same all the way.
    blending: Option<Blending<'a>>,
    /// The level above the leaf's at its middle.
    above: f64,
    /// Levels of which gradients are wanted.
    levels: Levels,
    accuracy: f64,
}

impl<'a> Ladder<'a> {
    /// At most `most` rungs above and with `leaf`.
    pub fn new(cut: &'a Cut, leaf: &Leaf, most: Levels) -> Result<Self, BrickError> {
        let grids = cut.ladder(leaf).take(most.count());
        let rungs = grids.map(|grid| Ok(Rung { grid, voxels: cut.voxels(grid)? }));
        Ok(Self { rungs: rungs.collect::<Result<_, BrickError>>()? })
    }

    /// Value and gradient at a point of the leaf, `above` levels above it.
    pub fn at(&self, point: DVec3, above: f64) -> (f64, DVec3) {
        let (low, high, share) = self.between(above);
        let sample = |rung: usize| {
            let cell = self.rungs[rung].cell(point, point, point);
            let gradient = cell.gradient(self.rungs[rung].grid.voxel_edge).map(|g| g.0[0]);
            (cell.value().0[0], DVec3::from_array(gradient))
        };
        let (value, gradient) = sample(low);
        if share == 0.0 {
            return (value, gradient);
        }
        let (next_value, next_gradient) = sample(high);
        (value + (next_value - value) * share, gradient + (next_gradient - gradient) * share)
    }

    /// Shows `visitor` what lies between two t of `line` inside the leaf.
    pub fn visit(
        &self,
        blending: &Blending,
        line: &Line,
        within: (f64, f64),
        accuracy: f64,
        visitor: &mut dyn Visitor,
    ) -> ControlFlow<()> {
        let mut from = within.0;
        for to in ends(blending.kinks(line), within) {
            let middle = line.at(0.5 * (from + to));
            let above = blending.above(middle);
            let blending = blending.varies(middle, self.top()).then_some(*blending);
            Way { ladder: self, line, blending, above, levels: visitor.levels(), accuracy }
                .visit((from, to), visitor)?;
            from = to;
        }
        ControlFlow::Continue(())
    }

    /// The highest rung.
    fn top(&self) -> f64 {
        (self.rungs.len() - 1) as f64
    }

    /// The rungs on both sides of the level `above`, and how far it is from the first to the second.
    fn between(&self, above: f64) -> (usize, usize, f64) {
        let above = above.clamp(0.0, self.top());
        let low = above.floor();
        let high = (low as usize + 1).min(self.rungs.len() - 1);
        (low as usize, high, above - low)
    }
}

impl Rung<'_> {
    /// The cell around `inside`, with the way from `enter` to `leave` in it.
    fn cell(&self, inside: DVec3, enter: DVec3, leave: DVec3) -> Cell<'_> {
        let edge = self.grid.voxel_edge;
        let low = (inside / edge - 0.5).floor();
        let within = |point: DVec3| point / edge - 0.5 - low;
        Cell::new(self.voxels, low.as_ivec3() - self.grid.first_sample, within(enter), within(leave))
    }

    /// The t between two others at which a line crosses a plane between cells.
    fn planes(&self, line: &Line, (from, to): (f64, f64)) -> impl Iterator<Item = f64> {
        let edge = self.grid.voxel_edge;
        let (a, b) = (line.at(from) / edge - 0.5, line.at(to) / edge - 0.5);
        let line = *line;
        (0..3).flat_map(move |axis| {
            let (low, high) = (a[axis].min(b[axis]).ceil() as i64, a[axis].max(b[axis]).floor() as i64);
            (low..=high).map(move |n| line.crossing(axis, (n as f64 + 0.5) * edge))
        })
    }
}

impl Way<'_> {
    fn visit(&self, within: (f64, f64), visitor: &mut dyn Visitor) -> ControlFlow<()> {
        let rungs = &self.ladder.rungs;
        let (first, next, share) = self.ladder.between(self.above);
        let highest = if share > 0.0 { next } else { first } + self.levels.count().saturating_sub(1);
        let used = &rungs[first..=highest.min(rungs.len() - 1)];
        let planes = used.iter().flat_map(|rung| rung.planes(self.line, within));
        let mut from = within.0;
        for to in ends(planes, within) {
            self.show(used, (from, to), visitor)?;
            from = to;
        }
        ControlFlow::Continue(())
    }

    /// Shows a stretch that lies in one cell of each of the `used` rungs.
    fn show(&self, used: &[Rung], part: (f64, f64), visitor: &mut dyn Visitor) -> ControlFlow<()> {
        let [enter, leave, middle] = [part.0, part.1, 0.5 * (part.0 + part.1)].map(|t| self.line.at(t));
        let cells: Vec<Cell> = used.iter().map(|rung| rung.cell(middle, enter, leave)).collect();
        let values: Vec<Cubic> = cells.iter().map(Cell::value).collect();
        let deviations: Vec<Option<Cubic>> = cells.iter().map(Cell::deviation).collect();
        let has_deviation = deviations.iter().any(Option::is_some);
        let or_none = |found: Option<Cubic>| found.unwrap_or(Cubic::constant(0.0));
        let deviations = has_deviation.then(|| deviations.into_iter().map(or_none).collect());
        let sloped = cells.iter().zip(used).filter(|_| self.levels > Levels::Zero);
        let gradients = sloped.map(|(cell, rung)| cell.gradient(rung.grid.voxel_edge)).collect();
        let blend = Blend { way: self, values, deviations, gradients, part };
        match &self.blending {
            None => blend.show_fixed(visitor),
            Some(blending) => blend.show_fitted(blending, (0.0, 1.0), MOST_BISECTIONS, visitor),
        }
    }

    /// The level, counted from the lowest of the used rungs, at `t`.
    fn share(&self, blending: &Blending, t: f64) -> f64 {
        let above = blending.above(self.line.at(t));
        (above - self.above.floor()).clamp(0.0, 1.0)
    }
}

/// The cubics of all used rungs on a stretch.
struct Blend<'a> {
    way: &'a Way<'a>,
    values: Vec<Cubic>,
    /// None if no rung has any.
    deviations: Option<Vec<Cubic>>,
    gradients: Vec<[Cubic; 3]>,
    part: (f64, f64),
}

impl Blend<'_> {
    /// The rungs between which the level `above` that of the sample lies; the highest one for all beyond.
    fn pair<'b, T>(&self, of: &'b [T], above: usize) -> (&'b T, &'b T) {
        let last = of.len() - 1;
        (&of[above.min(last)], &of[(above + 1).min(last)])
    }

    /// Where the blend is the same all the way, it is a cubic.
    fn show_fixed(&self, visitor: &mut dyn Visitor) -> ControlFlow<()> {
        let share = self.way.ladder.between(self.way.above).2;
        let (low, high) = self.pair(&self.values, 0);
        let value = if share == 0.0 { *low } else { low.lerp(high, share) };
        let gradient = |above: usize| {
            let (low, high) = self.pair(&self.gradients, above);
            std::array::from_fn(|axis| low[axis].lerp(&high[axis], share))
        };
        let deviation = self.deviations.as_ref().map(|deviations| {
            let (low, high) = self.pair(deviations, 0);
            low.lerp(high, share)
        });
        visitor.piece(&Piece { t0: self.part.0, t1: self.part.1, value, deviation, gradient: &gradient })
    }

    /// Where it is not, cubics are fitted to it.
    fn show_fitted(
        &self,
        blending: &Blending,
        (from, to): (f64, f64),
        left: u32,
        visitor: &mut dyn Visitor,
    ) -> ControlFlow<()> {
        let t = |u: f64| self.part.0 + u * (self.part.1 - self.part.0);
        let at = |u: f64| from + u * (to - from);
        let lerp = |low: &Cubic, high: &Cubic, u: f64| {
            let (low, high) = (low.at(u), high.at(u));
            low + (high - low) * self.way.share(blending, t(u))
        };
        let (low, high) = self.pair(&self.values, 0);
        let value = Fit::new(|u| [lerp(low, high, at(u))]);
        let deviation = self.deviations.as_ref().map(|deviations| {
            let (low, high) = self.pair(deviations, 0);
            Fit::new(|u| [lerp(low, high, at(u))])
        });
        let gradient = |above: usize| {
            let (low, high) = self.pair(&self.gradients, above);
            Fit::new(|u| std::array::from_fn(|axis| lerp(&low[axis], &high[axis], at(u))))
        };
        let is_smooth = |above: usize| gradient(above).error <= self.way.accuracy * GRADIENT_SLACK;
        let is_spread_good = deviation.as_ref().is_none_or(|fit| fit.error <= self.way.accuracy);
        let is_good =
            value.error <= self.way.accuracy && is_spread_good && (0..self.way.levels.count()).all(is_smooth);
        let middle = 0.5 * (from + to);
        if is_good || left == 0 || t(middle) <= t(from) || t(middle) >= t(to) {
            let gradient = |above: usize| gradient(above).cubics;
            let deviation = deviation.map(|fit| fit.cubics[0]);
            let (t0, t1, value) = (t(from), t(to), value.cubics[0]);
            return visitor.piece(&Piece { t0, t1, value, deviation, gradient: &gradient });
        }
        self.show_fitted(blending, (from, middle), left - 1, visitor)?;
        self.show_fitted(blending, (middle, to), left - 1, visitor)
    }
}

/// The ends of the stretches that `marks` cut an interval into, in rising order.
fn ends(marks: impl Iterator<Item = f64>, (from, to): (f64, f64)) -> Vec<f64> {
    let mut ends: Vec<f64> = marks.filter(|&t| t > from && t < to).chain([to]).collect();
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    ends
}
