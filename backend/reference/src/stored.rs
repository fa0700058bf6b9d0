//! The field of a brick source: trilinear or quadrilinear interpolation on the ideal cut.

use super::cells::Cells;
use super::cut::{Cut, Leaf};
use super::field::Levels;
use super::ladder::Ladder;
use super::level::{Blending, FilterLevel};
use super::{Cubic, Field, Line, Piece, Visitor};
use bricks::LodRule;
use bricks::{BrickError, BrickSource, NodeKey};
use glam::DVec3;
use optics::Optics;
use std::ops::ControlFlow;
use std::sync::Arc;

/// The samples of a store, at the level that a [`LodRule`] asks for. Inside a leaf the value is the trilinear
/// interpolation of that leaf's brick, or, where it is quadrilinear, a blend of those of the leaf and its ancestors; at
/// borders between leaves of different depth it may jump.
///
/// Bricks stay in memory once read (64 KiB each).
pub struct StoredField {
    cut: Cut,
    filter: Option<FilterLevel>,
}

impl StoredField {
    /// The field of `source` on the cut that `rule` asks for.
    pub fn new(source: Arc<dyn BrickSource>, rule: &LodRule) -> Self {
        Self { cut: Cut::new(source, rule), filter: None }
    }

    /// The same, filtered over levels as [`optics::Quality::quadrilinear`] says.
    pub fn quadrilinear(source: Arc<dyn BrickSource>, rule: &LodRule) -> Self {
        Self::new(source, rule).filtered(rule)
    }

    /// The same around bricks that cannot be read: as the renderer does, it takes the parent instead of a family of
    /// which a brick that `optics` show is damaged.
    pub fn around_damage(source: Arc<dyn BrickSource>, rule: &LodRule, optics: &Optics) -> Self {
        Self { cut: Cut::around_damage(source, rule, optics), filter: None }
    }

    /// The field of a cut given by its leaves, each with its own share of the samples at its corners x + 2 y + 4 z; its
    /// parent has the rest. `leaves` cover the volume. A leaf that shows nothing by its own values is taken as the middle of
    /// them where its parent has a share.
    pub fn presented(
        source: Arc<dyn BrickSource>,
        leaves: impl IntoIterator<Item = (NodeKey, [f64; 8])>,
        optics: &Optics,
    ) -> Self {
        Self { cut: Cut::presented(source, leaves, optics), filter: None }
    }

    /// This field, blended at borders between levels as [`optics::Quality::blended`] says.
    pub fn blended(self, rule: &LodRule, optics: &Optics) -> Self {
        Self { cut: self.cut.blended(rule, optics), ..self }
    }

    /// This field, filtered over levels by the resolution that `rule` gives.
    pub fn filtered(self, rule: &LodRule) -> Self {
        Self { filter: Some(FilterLevel::new(rule)), ..self }
    }

    /// This field, with every voxel taken as its mean alone, whatever [`optics::Quality::deviation`] says.
    pub fn without_deviation(self) -> Self {
        Self { cut: self.cut.without_deviation(), ..self }
    }

    fn blending<'a>(&'a self, leaf: &'a Leaf) -> Blending<'a> {
        Blending { filter: self.filter.as_ref(), corners: leaf.corners.as_ref(), level: leaf.level }
    }

    fn walk_leaf(
        &self,
        leaf: &Leaf,
        line: &Line,
        within: (f64, f64),
        accuracy: f64,
        visitor: &mut dyn Visitor,
    ) -> Result<ControlFlow<()>, BrickError> {
        let (low, high) = leaf.bounds;
        if !visitor.wants(low, high) {
            return Ok(ControlFlow::Continue(()));
        }
        if self.filter.is_some() || leaf.corners.is_some() || visitor.levels() > Levels::One {
            let ladder = Ladder::new(&self.cut, leaf, Levels::Three)?;
            return Ok(ladder.visit(&self.blending(leaf), line, within, accuracy, visitor));
        }
        if low == high {
            let gradient = |_| [Cubic::constant(0.0); 3];
            let (value, deviation) = (Cubic::constant(low), None);
            let piece = Piece { t0: within.0, t1: within.1, value, deviation, gradient: &gradient };
            return Ok(visitor.piece(&piece));
        }
        let grid = self.cut.grid(leaf);
        let voxels = self.cut.voxels(grid)?;
        Ok(Cells::new(grid, line, within).visit(voxels, visitor))
    }
}

impl Field for StoredField {
    fn extent(&self) -> DVec3 {
        self.cut.shape().dims().as_dvec3()
    }

    fn value(&self, point: DVec3) -> Result<f64, BrickError> {
        Ok(self.sample(point, &|_, _| true)?.0)
    }

    fn gradient(&self, point: DVec3) -> Result<DVec3, BrickError> {
        Ok(self.sample(point, &|_, _| true)?.1)
    }

    fn sample(&self, point: DVec3, wants: &dyn Fn(f64, f64) -> bool) -> Result<(f64, DVec3), BrickError> {
        let point = point.clamp(DVec3::ZERO, self.extent());
        let leaf = self.cut.leaf_at(point);
        if !wants(leaf.bounds.0, leaf.bounds.1) {
            return Ok((leaf.bounds.0, DVec3::ZERO));
        }
        let above = self.blending(leaf).above(point);
        let rungs = if above > 0.0 { Levels::Three } else { Levels::One };
        Ok(Ladder::new(&self.cut, leaf, rungs)?.at(point, above))
    }

    fn walk(
        &self,
        line: &Line,
        within: (f64, f64),
        accuracy: f64,
        visitor: &mut dyn Visitor,
    ) -> Result<(), BrickError> {
        let (mut t, end) = within;
        while t < end {
            let leaf = self.cut.leaf_on(line, t);
            let exit = line.exit(leaf.region.0, leaf.region.1).min(end);
            if exit <= t {
                // Only rounding at the box's own faces can bring a line here.
                t = t.next_up();
                continue;
            }
            if self.walk_leaf(leaf, line, (t, exit), accuracy, visitor)?.is_break() {
                break;
            }
            t = exit;
        }
        Ok(())
    }
}
