//! All of a frame's marks.

use crate::depth::Depth;
use crate::fill::Coverage;
use crate::fragment::{Fragment, sort};
use crate::letters::Font;
use crate::view::View;
use crate::{sheet, stroke};
use glam::DVec2;
use protocol::{Mark, MarkShape, Paint};

/// Draws marks over pictures. It keeps the outlines of texts that come again.
#[derive(Default)]
pub struct Pen {
    /// Once there is something to write.
    font: Option<Font>,
}

impl std::fmt::Debug for Pen {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.debug_struct("Pen").finish_non_exhaustive()
    }
}

impl Pen {
    /// Draws marks, one after the other, over a projector's picture: linear colours, premultiplied by their opacity, rows from the
    /// top, 4 numbers per pixel.
    ///
    /// # Panics
    /// If the picture is smaller than the view's, as a slice does.
    pub fn draw<'m>(&mut self, marks: impl IntoIterator<Item = &'m Mark>, view: &View, rgba: &mut [f32]) {
        for mark in marks {
            for (polygons, paint) in self.polygons(mark, view) {
                if let Some(coverage) = Coverage::of(&polygons, view.size()) {
                    coverage.lay_over(paint, rgba, view.size().x);
                }
            }
        }
    }

    /// The pixels of marks that belong among what their rays meet: pixel by pixel, the farthest first.
    pub fn fragments<'m>(&mut self, marks: impl IntoIterator<Item = &'m Mark>, view: &View) -> Vec<Fragment> {
        let mut fragments = Vec::new();
        for mark in marks {
            let depth = Depth::of(&mark.shape);
            for (polygons, paint) in self.polygons(mark, view) {
                let Some(coverage) = Coverage::of(&polygons, view.size()) else { continue };
                fragments.extend(coverage.pixels(paint.opacity).map(|(at, opacity)| {
                    let ray = view.ray(at);
                    let (pixel, distance_m) = (at.y * view.size().x + at.x, depth.along(&ray));
                    Fragment { pixel, ray, distance_m, paint: Paint { opacity, ..paint } }
                }));
            }
        }
        sort(&mut fragments);
        fragments
    }

    /// What a mark is in pixels: colours, one over the other.
    pub(crate) fn polygons(&mut self, mark: &Mark, view: &View) -> Vec<(Vec<Vec<DVec2>>, Paint)> {
        match &mark.shape {
            MarkShape::Stroke { points_in_display, radius_m } => {
                vec![(stroke::polygons(points_in_display, *radius_m, view), mark.paint)]
            }
            MarkShape::Sheet { corners_in_display } => {
                vec![(sheet::polygon(corners_in_display, view).into_iter().collect(), mark.paint)]
            }
            MarkShape::Label { text, base_in_display: base, em_m, backing } => {
                if view.margins(*base).min_element() < 0.0 {
                    return Vec::new();
                }
                let letters = self.font.get_or_insert_with(Font::new).letters(text);
                let behind = backing.and_then(|paint| {
                    let corners = letters.backing().map(|at| *base + *em_m * at.extend(0.0));
                    Some((vec![sheet::polygon(&corners, view)?], paint))
                });
                let written = letters.polygons(*base, *em_m, view).map(|polygons| (polygons, mark.paint));
                behind.into_iter().chain(written).collect()
            }
        }
    }
}

#[cfg(test)]
#[path = "pen_tests.rs"]
mod tests;
