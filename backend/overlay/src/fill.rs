//! Polygons as shares of pixels.

use crate::polygon::cut;
use glam::{DVec2, UVec2};
use zeno::{Command, Fill, Format, Mask, Vector};

/// What lies further outside a picture is cut off first: the rasteriser's numbers are not made for great ones.
const MARGIN_PX: f64 = 2.0;

/// How much of each pixel polygons cover together, in a part of a picture.
#[derive(Debug, Default)]
pub(crate) struct Coverage {
    /// Its first column and row.
    pub(crate) first: UVec2,
    /// Columns and rows.
    pub(crate) size: UVec2,
    /// 255 for the whole pixel, rows from the top.
    pub(crate) shares: Vec<u8>,
}

impl Coverage {
    /// Of polygons of which those that overlap turn the same way, in a picture of this size. None where they are all outside.
    pub(crate) fn of(polygons: &[Vec<DVec2>], picture: UVec2) -> Option<Self> {
        let most = picture.as_dvec2() + MARGIN_PX;
        let inside = |polygon: &Vec<DVec2>| {
            let polygon = cut(polygon, |p| p.x + MARGIN_PX);
            let polygon = cut(&polygon, |p| p.y + MARGIN_PX);
            let polygon = cut(&polygon, |p| most.x - p.x);
            cut(&polygon, |p| most.y - p.y)
        };
        let polygons: Vec<_> = polygons.iter().map(inside).filter(|polygon| polygon.len() > 2).collect();
        let corners = || polygons.iter().flatten().copied();
        let first = corners().reduce(DVec2::min)?.floor().max(DVec2::ZERO).as_uvec2();
        let last = corners().reduce(DVec2::max)?.ceil().max(DVec2::ZERO).as_uvec2().min(picture);
        let size = last.saturating_sub(first);
        if size.min_element() == 0 {
            return None;
        }
        let mut commands = Vec::new();
        for polygon in &polygons {
            for (i, corner) in polygon.iter().enumerate() {
                let at = (corner - first.as_dvec2()).as_vec2();
                let at = Vector::new(at.x, at.y);
                commands.push(if i == 0 { Command::MoveTo(at) } else { Command::LineTo(at) });
            }
            commands.push(Command::Close);
        }
        let mut shares = vec![0; size.x as usize * size.y as usize];
        Mask::new(commands.as_slice())
            .style(Fill::NonZero)
            .format(Format::Alpha)
            .size(size.x, size.y)
            .render_into(&mut shares, None);
        Some(Self { first, size, shares })
    }

    /// The pixels of which anything is covered: their columns and rows, and the opacity there of a mark of this opacity.
    pub(crate) fn pixels(&self, opacity: f32) -> impl Iterator<Item = (UVec2, f32)> {
        let rows = self.shares.chunks_exact(self.size.x as usize).zip(self.first.y..);
        rows.flat_map(move |(shares, y)| {
            shares.iter().zip(self.first.x..).map(move |(share, x)| (*share, x, y))
        })
        .filter(|(share, ..)| *share > 0)
        .map(move |(share, x, y)| (UVec2::new(x, y), opacity * f32::from(share) / 255.0))
    }
}
