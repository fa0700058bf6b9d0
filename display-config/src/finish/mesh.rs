//! A mesh: where the pixels of a projector fall on the screen, measured at the points of a grid.

use super::{MOST_MESH_ALONG, MapFault};
use crate::raster::is_strictly_convex;
use glam::{DVec2, Vec2};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Nothing of a display is farther away, metres.
const FARTHEST_M: f32 = 1e6;

/// Screen points (metres, x right, y up) at the points of an even grid over a raster, from its top left corner to its
/// bottom right one; bilinear between. Messages carry its points apart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    columns: u32,
    rows: u32,
    #[serde(skip)]
    points: Arc<[Vec2]>,
}

impl Mesh {
    /// Rows from the raster's top, each from its left.
    ///
    /// # Errors
    /// Too few or too many points, points at no ordinary place, or a mesh that folds over.
    pub fn new(columns: u32, rows: u32, points: Vec<Vec2>) -> Result<Self, MapFault> {
        if [columns, rows].iter().any(|along| !(2..=MOST_MESH_ALONG).contains(along)) {
            return Err(MapFault::MeshHead);
        }
        let is_far = |point: &Vec2| !point.is_finite() || point.abs().max_element() > FARTHEST_M;
        if columns as usize * rows as usize != points.len() {
            return Err(MapFault::MeshCount { found: 2 * points.len(), columns, rows });
        }
        if points.iter().any(is_far) {
            return Err(MapFault::MeshFar);
        }
        let mesh = Self { columns, rows, points: points.into() };
        match mesh.fold() {
            Some([column, row]) => Err(MapFault::Folded { column, row }),
            None => Ok(mesh),
        }
    }

    /// Points along x and y of the raster.
    pub fn size(&self) -> [u32; 2] {
        [self.columns, self.rows]
    }

    /// All points.
    pub fn points(&self) -> &[Vec2] {
        &self.points
    }

    /// The screen point of a place in the raster, as a share of its width (from the left) and of its height (from the top).
    pub fn screen(&self, share: DVec2) -> DVec2 {
        let cells = DVec2::new(f64::from(self.columns - 1), f64::from(self.rows - 1));
        let place = share.clamp(DVec2::ZERO, DVec2::ONE) * cells;
        let cell = place.floor().min(cells - 1.0);
        let [a, b, c, d] = self.corners(cell.x as u32, cell.y as u32);
        let part = place - cell;
        a.lerp(b, part.x).lerp(d.lerp(c, part.x), part.y)
    }

    /// The corners of a cell, clockwise in the raster from its top left.
    fn corners(&self, column: u32, row: u32) -> [DVec2; 4] {
        let point = |x: u32, y: u32| self.points[(y * self.columns + x) as usize].as_dvec2();
        [point(column, row), point(column + 1, row), point(column + 1, row + 1), point(column, row + 1)]
    }

    /// The first cell, by rows, that is no proper quadrilateral or turns the other way than the one at the top left.
    fn fold(&self) -> Option<[u32; 2]> {
        let turn = |[a, b, c, _]: [DVec2; 4]| (b - a).perp_dot(c - b).signum();
        let first = turn(self.corners(0, 0));
        let is_wrong = |corners: [DVec2; 4]| !is_strictly_convex(corners) || turn(corners) != first;
        let mut cells =
            (0..self.rows - 1).flat_map(|row| (0..self.columns - 1).map(move |column| [column, row]));
        cells.find(|&[column, row]| is_wrong(self.corners(column, row)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(columns: u32, rows: u32, place: impl Fn(f32, f32) -> Vec2) -> Vec<Vec2> {
        let at = |x: u32, y: u32| place(x as f32 / (columns - 1) as f32, y as f32 / (rows - 1) as f32);
        (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect()
    }

    fn upright(x: f32, y: f32) -> Vec2 {
        Vec2::new(x - 0.5, 0.5 - y)
    }

    #[test]
    fn a_mesh_is_bilinear_between_its_points_and_reaches_from_edge_to_edge() {
        let mesh = Mesh::new(3, 2, points(3, 2, |x, y| Vec2::new(x * x, 1.0 - y - 0.1 * x))).unwrap();
        let near = |share: [f64; 2], point: [f64; 2]| {
            let found = mesh.screen(DVec2::from(share));
            assert!((found - DVec2::from(point)).length() < 1e-7, "{found}");
        };
        near([0.0, 0.0], [0.0, 1.0]);
        near([1.0, 1.0], [1.0, -0.1]);
        near([0.5, 0.25], [0.25, 0.7]);
        near([0.75, 0.5], [0.625, 0.425]);
        near([2.0, -1.0], [1.0, 0.9]);
    }

    #[test]
    fn mirrored_meshes_are_meshes_and_folded_ones_are_not() {
        assert!(Mesh::new(5, 4, points(5, 4, |x, y| upright(1.0 - x, y))).is_ok());
        let mut folded = points(5, 4, upright);
        folded[7].x = 0.4;
        let fault = Mesh::new(5, 4, folded).unwrap_err().to_string();
        assert!(fault.starts_with("which folds over, or has no area, in the cell"), "{fault}");
        assert!(matches!(Mesh::new(2, 2, vec![Vec2::ZERO; 4]), Err(MapFault::Folded { column: 0, row: 0 })));
    }

    #[test]
    fn meshes_of_other_sizes_and_at_no_place_are_refused() {
        assert!(matches!(Mesh::new(1, 4, vec![Vec2::ZERO; 4]), Err(MapFault::MeshHead)));
        assert!(matches!(Mesh::new(1026, 2, Vec::new()), Err(MapFault::MeshHead)));
        assert!(matches!(Mesh::new(2, 2, vec![Vec2::ZERO; 3]), Err(MapFault::MeshCount { found: 6, .. })));
        for wrong in [f32::NAN, f32::INFINITY, 2e6] {
            let mut wild = points(3, 3, upright);
            wild[4].y = wrong;
            assert!(matches!(Mesh::new(3, 3, wild), Err(MapFault::MeshFar)));
        }
    }
}
