//! The field of a brick source: trilinear interpolation on the ideal cut.

use super::cell::Cell;
use super::cut::{Cut, Leaf, Voxels};
use super::{Cubic, Field, Line, Piece, Visitor};
use crate::store::{BrickError, BrickSource};
use crate::working_set::LodRule;
use glam::{DVec3, IVec3};
use shaders::optics::Optics;
use std::ops::ControlFlow;
use std::sync::Arc;

/// The samples of a store, at the level that a [`LodRule`] asks for. Inside a leaf the value is the trilinear
/// interpolation of that leaf's brick; at borders between leaves of different depth it may jump.
///
/// Bricks stay in memory once read (64 KiB each).
pub struct StoredField {
    cut: Cut,
}

impl StoredField {
    /// The field of `source` on the cut that `rule` asks for.
    pub fn new(source: Arc<dyn BrickSource>, rule: &LodRule) -> Self {
        Self { cut: Cut::new(source, rule) }
    }

    /// The same around bricks that cannot be read: as the renderer does, it takes the parent in place of a family of
    /// which a brick that `optics` show is damaged.
    pub fn around_damage(source: Arc<dyn BrickSource>, rule: &LodRule, optics: &Optics) -> Self {
        Self { cut: Cut::around_damage(source, rule, optics) }
    }

    /// Value and gradient at a point, which is moved into the box where it lies outside.
    fn sample(&self, point: DVec3) -> Result<(f64, DVec3), BrickError> {
        let point = point.clamp(DVec3::ZERO, self.extent());
        let leaf = self.cut.leaf_at(point);
        let at = point / leaf.voxel_edge - 0.5;
        let low = at.floor();
        let voxels = self.cut.voxels(leaf)?;
        let cell = Cell::new(voxels, low.as_ivec3() - leaf.first_sample, at - low, at - low);
        Ok((cell.value().0[0], DVec3::from_array(cell.gradient(leaf.voxel_edge).map(|g| g.0[0]))))
    }

    fn walk_leaf(
        &self,
        leaf: &Leaf,
        line: &Line,
        within: (f64, f64),
        visitor: &mut dyn Visitor,
    ) -> Result<ControlFlow<()>, BrickError> {
        let (low, high) = leaf.bounds;
        if !visitor.wants(low, high) {
            return Ok(ControlFlow::Continue(()));
        }
        if low == high {
            let gradient = || [Cubic::constant(0.0); 3];
            let value = Cubic::constant(low);
            return Ok(visitor.piece(&Piece { t0: within.0, t1: within.1, value, gradient: &gradient }));
        }
        let voxels = self.cut.voxels(leaf)?;
        Ok(Cells::new(leaf, line, within).visit(voxels, visitor))
    }
}

impl Field for StoredField {
    fn extent(&self) -> DVec3 {
        self.cut.shape().dims().as_dvec3()
    }

    fn value(&self, point: DVec3) -> Result<f64, BrickError> {
        Ok(self.sample(point)?.0)
    }

    fn gradient(&self, point: DVec3) -> Result<DVec3, BrickError> {
        Ok(self.sample(point)?.1)
    }

    fn walk(
        &self,
        line: &Line,
        within: (f64, f64),
        _accuracy: f64,
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
            if self.walk_leaf(leaf, line, (t, exit), visitor)?.is_break() {
                break;
            }
            t = exit;
        }
        Ok(())
    }
}

/// A line's way through the cells of a leaf. The planes between cells lie at (n + 0.5) voxel edges; the gradient's
/// lie there too, as they are the same shifted by whole voxels.
struct Cells<'a> {
    leaf: &'a Leaf,
    line: &'a Line,
    end: f64,
    t: f64,
    cell: IVec3,
    next: DVec3,
}

impl<'a> Cells<'a> {
    fn new(leaf: &'a Leaf, line: &'a Line, (t, end): (f64, f64)) -> Self {
        let near = (line.at(t) / leaf.voxel_edge - 0.5).floor().as_ivec3();
        let mut cells = Self { leaf, line, end, t, cell: near, next: DVec3::INFINITY };
        for axis in 0..3 {
            // Rounding may have put the start into a neighbour.
            while line.is_beyond(t, axis, cells.plane(cells.cell[axis] + 1)) {
                cells.cell[axis] += 1;
            }
            while !line.is_beyond(t, axis, cells.plane(cells.cell[axis])) {
                cells.cell[axis] -= 1;
            }
            cells.next[axis] = cells.exit(axis);
        }
        cells
    }

    fn plane(&self, n: i32) -> f64 {
        (f64::from(n) + 0.5) * self.leaf.voxel_edge
    }

    /// The t at which the line leaves the present cell along `axis`.
    fn exit(&self, axis: usize) -> f64 {
        let speed = self.line.direction[axis];
        if speed == 0.0 {
            return f64::INFINITY;
        }
        self.line.crossing(axis, self.plane(self.cell[axis] + i32::from(speed > 0.0)))
    }

    fn visit(&mut self, voxels: &Voxels, visitor: &mut dyn Visitor) -> ControlFlow<()> {
        while self.t < self.end {
            let exit = self.next.min_element().min(self.end);
            if exit > self.t {
                self.show(exit, voxels, visitor)?;
                self.t = exit;
            }
            for axis in 0..3 {
                if self.next[axis] <= exit {
                    self.cell[axis] += if self.line.direction[axis] > 0.0 { 1 } else { -1 };
                    self.next[axis] = self.exit(axis);
                }
            }
        }
        ControlFlow::Continue(())
    }

    fn show(&self, exit: f64, voxels: &Voxels, visitor: &mut dyn Visitor) -> ControlFlow<()> {
        let edge = self.leaf.voxel_edge;
        let within_cell = |t: f64| self.line.at(t) / edge - 0.5 - self.cell.as_dvec3();
        let low = self.cell - self.leaf.first_sample;
        let cell = Cell::new(voxels, low, within_cell(self.t), within_cell(exit));
        visitor.piece(&Piece { t0: self.t, t1: exit, value: cell.value(), gradient: &|| cell.gradient(edge) })
    }
}
