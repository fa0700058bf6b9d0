//! All of a frame's marks.

use crate::depth::Depth;
use crate::fill::Coverage;
use crate::fragment::{Fragment, FragmentPlace, order};
use crate::letters::Font;
use crate::view::View;
use crate::{sheet, stroke};
use glam::DVec2;
use protocol::{Mark, MarkShape, Paint};

/// Draws marks. It keeps the outlines of texts that come again.
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
    /// The pixels of marks in a projector's picture, in the order in which they are laid into it: pixel by pixel, first those that are
    /// depth-combined, the farthest first, then those that shine through, as they are listed.
    pub fn fragments(&mut self, marks: &[Mark], view: &View) -> Vec<Fragment> {
        let mut fragments = Vec::new();
        for mark in marks {
            let depth = mark.is_depth_combined.then(|| Depth::of(&mark.shape));
            for (polygons, paint) in self.polygons(mark, view) {
                let Some(coverage) = Coverage::of(&polygons, view.size()) else { continue };
                fragments.extend(coverage.pixels(paint.opacity).map(|(at, opacity)| {
                    let place = depth.as_ref().map(|depth| {
                        let ray = view.ray(at);
                        FragmentPlace { distance_m: depth.along(&ray), ray }
                    });
                    Fragment { pixel: at.y * view.size().x + at.x, paint: Paint { opacity, ..paint }, place }
                }));
            }
        }
        fragments.sort_by(order);
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
