//! A line's path through the cells of one grid.

use super::cell::Cell;
use super::cut::{Grid, Voxels};
use super::{Line, Piece, Visitor};
use glam::{DVec3, IVec3};
use std::ops::ControlFlow;

/// A line's way through the cells of a leaf. The planes between cells lie at (n + 0.5) voxel edges; the gradient's
/// lie there too, as they are the same shifted by whole voxels.
pub struct Cells<'a> {
    grid: &'a Grid,
    line: &'a Line,
    end: f64,
    t: f64,
    cell: IVec3,
    next: DVec3,
}

impl<'a> Cells<'a> {
    /// The cells between two t inside a leaf.
    pub fn new(grid: &'a Grid, line: &'a Line, (t, end): (f64, f64)) -> Self {
        let near = (line.at(t) / grid.voxel_edge - 0.5).floor().as_ivec3();
        let mut cells = Self { grid, line, end, t, cell: near, next: DVec3::INFINITY };
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
        (f64::from(n) + 0.5) * self.grid.voxel_edge
    }

    /// The t at which the line leaves the present cell along `axis`.
    fn exit(&self, axis: usize) -> f64 {
        let speed = self.line.direction[axis];
        if speed == 0.0 {
            return f64::INFINITY;
        }
        self.line.crossing(axis, self.plane(self.cell[axis] + i32::from(speed > 0.0)))
    }

    /// Shows `visitor` one piece per cell.
    pub fn visit(&mut self, voxels: &Voxels, visitor: &mut dyn Visitor) -> ControlFlow<()> {
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
        let edge = self.grid.voxel_edge;
        let within_cell = |t: f64| self.line.at(t) / edge - 0.5 - self.cell.as_dvec3();
        let low = self.cell - self.grid.first_sample;
        let cell = Cell::new(voxels, low, within_cell(self.t), within_cell(exit));
        visitor.piece(&Piece {
            t0: self.t,
            t1: exit,
            value: cell.value(),
            deviation: cell.deviation(),
            gradient: &|_| cell.gradient(edge),
        })
    }
}
