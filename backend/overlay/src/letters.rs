//! Text as outlines.

use crate::view::{FLAT_PX, View};
use cosmic_text::fontdb::{Database, Source};
use cosmic_text::{
    Attrs, Buffer, CacheKey, CacheKeyFlags, Command, Family, FontSystem, Metrics, Shaping, SwashCache,
};
use glam::{DVec2, DVec3};
use std::collections::HashMap;
use std::sync::Arc;
use zeno::Vector;

/// Units of the em that outlines are asked for in: the font's own are 1000.
const EM: f32 = 1000.0;
/// Texts whose outlines are kept; more are forgotten together.
const MOST_KEPT: usize = 256;
/// What surrounds a text's letters on its backing, ems.
const BORDER_EM: f64 = 0.3;

/// A part of an outline, in ems: x along the base line from its middle, y up.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Part {
    Line(DVec2),
    Quad(DVec2, DVec2),
    Cubic(DVec2, DVec2, DVec2),
}

/// The outlines of a text.
#[derive(Debug, Default)]
pub(crate) struct Letters {
    /// Where each begins, and how it goes on to close itself.
    pub(crate) contours: Vec<(DVec2, Vec<Part>)>,
    /// Of the whole text, ems.
    pub(crate) width_em: f64,
}

impl Letters {
    /// The corners of what lies behind them, ems.
    pub(crate) fn backing(&self) -> [DVec2; 4] {
        let (low, high) = (
            DVec2::new(-0.5 * self.width_em - BORDER_EM, -0.25 - 0.5 * BORDER_EM),
            DVec2::new(0.5 * self.width_em + BORDER_EM, 0.75 + 0.5 * BORDER_EM),
        );
        [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
    }

    /// Their picture: polygons that turn as the outlines do. Text lies parallel to the screen, where straight lines stay straight
    /// but for a projector's own homography.
    pub(crate) fn polygons(&self, base: DVec3, em_m: f64, view: &View) -> Option<Vec<Vec<DVec2>>> {
        let pixel = |at: DVec2| view.pixel(base + em_m * at.extend(0.0));
        let contour = |(begin, parts): &(DVec2, Vec<Part>)| {
            let (mut here, mut out) = (*begin, vec![pixel(*begin)?]);
            for part in parts {
                here = flatten(here, *part, &pixel, &mut out)?;
            }
            Some(out)
        };
        self.contours.iter().map(contour).collect()
    }
}

/// Appends the points of a part after its begin; where it ends.
fn flatten(
    from: DVec2,
    part: Part,
    pixel: &impl Fn(DVec2) -> Option<DVec2>,
    out: &mut Vec<DVec2>,
) -> Option<DVec2> {
    // A piece of a curve is off its chord by at most an eighth of its second derivative.
    let pieces = |second_px: f64| (second_px / 8.0 / FLAT_PX).sqrt().ceil().clamp(1.0, 64.0);
    let end = match part {
        Part::Line(end) => end,
        Part::Quad(control, end) => {
            let bend = pixel(from)? - 2.0 * pixel(control)? + pixel(end)?;
            let n = pieces(2.0 * bend.length());
            for i in 1..n as u32 {
                let t = f64::from(i) / n;
                out.push(pixel(from.lerp(control, t).lerp(control.lerp(end, t), t))?);
            }
            end
        }
        Part::Cubic(first, second, end) => {
            let [a, b, c, d] = [pixel(from)?, pixel(first)?, pixel(second)?, pixel(end)?];
            let n = pieces(6.0 * (a - 2.0 * b + c).length().max((b - 2.0 * c + d).length()));
            for i in 1..n as u32 {
                let t = f64::from(i) / n;
                let (p, q, r) = (from.lerp(first, t), first.lerp(second, t), second.lerp(end, t));
                out.push(pixel(p.lerp(q, t).lerp(q.lerp(r, t), t))?);
            }
            end
        }
    };
    out.push(pixel(end)?);
    Some(end)
}

/// The one font that there is, so that a text looks the same on every machine: Noto Sans, which has Latin, Greek and Cyrillic.
pub(crate) struct Font {
    system: FontSystem,
    outlines: SwashCache,
    kept: HashMap<String, Arc<Letters>>,
}

impl Font {
    pub(crate) fn new() -> Self {
        let mut fonts = Database::new();
        fonts.load_font_source(Source::Binary(Arc::new(notosans::REGULAR_TTF)));
        Self {
            system: FontSystem::new_with_locale_and_db("en".to_owned(), fonts),
            outlines: SwashCache::new(),
            kept: HashMap::new(),
        }
    }

    /// The outlines of a text.
    pub(crate) fn letters(&mut self, text: &str) -> Arc<Letters> {
        if let Some(letters) = self.kept.get(text) {
            return Arc::clone(letters);
        }
        if self.kept.len() >= MOST_KEPT {
            self.kept.clear();
        }
        let letters = Arc::new(self.lay_out(text));
        self.kept.insert(text.to_owned(), Arc::clone(&letters));
        letters
    }

    fn lay_out(&mut self, text: &str) -> Letters {
        let buffer = self.shape(text);
        let mut letters = Letters::default();
        for run in buffer.layout_runs().take(1) {
            letters.width_em = f64::from(run.line_w / EM);
            for glyph in run.glyphs {
                let flags = CacheKeyFlags::DISABLE_HINTING;
                let (key, ..) =
                    CacheKey::new(glyph.font_id, glyph.glyph_id, EM, (0.0, 0.0), glyph.font_weight, flags);
                let at = DVec2::new(
                    f64::from(glyph.x / EM + glyph.x_offset),
                    f64::from(glyph.y_offset - glyph.y / EM),
                );
                let at = at - DVec2::new(0.5 * letters.width_em, 0.0);
                let commands = self.outlines.get_outline_commands_uncached(&mut self.system, key);
                letters.contours.extend(contours(commands.as_deref().unwrap_or_default(), at));
            }
        }
        letters
    }

    fn shape(&mut self, text: &str) -> Buffer {
        let mut buffer = Buffer::new(&mut self.system, Metrics::new(EM, 1.2 * EM));
        // One line: what ends a line is a space.
        let line: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        let attributes = Attrs::new().family(Family::Name("Noto Sans"));
        buffer.set_size(None, None);
        buffer.set_text(&line, &attributes, Shaping::Advanced, None);
        buffer.shape_until_scroll(&mut self.system, false);
        buffer
    }

    /// Characters of a text for which it has no letters.
    fn unknown(&mut self, text: &str) -> Vec<char> {
        let buffer = self.shape(text);
        let missing =
            buffer.layout_runs().flat_map(|run| run.glyphs.iter().filter(|glyph| glyph.glyph_id == 0));
        let mut unknown: Vec<char> =
            missing.filter_map(|glyph| text.get(glyph.start..)?.chars().next()).collect();
        unknown.sort_unstable();
        unknown.dedup();
        unknown
    }
}

/// Outlines of a glyph at a place.
fn contours(commands: &[Command], at: DVec2) -> Vec<(DVec2, Vec<Part>)> {
    let point = |to: Vector| at + DVec2::new(f64::from(to.x / EM), f64::from(to.y / EM));
    let mut out: Vec<(DVec2, Vec<Part>)> = Vec::new();
    for command in commands {
        let part = match *command {
            Command::MoveTo(to) => {
                out.push((point(to), Vec::new()));
                continue;
            }
            Command::LineTo(to) => Part::Line(point(to)),
            Command::QuadTo(control, to) => Part::Quad(point(control), point(to)),
            Command::CurveTo(first, second, to) => Part::Cubic(point(first), point(second), point(to)),
            Command::Close => continue,
        };
        if let Some((_, parts)) = out.last_mut() {
            parts.push(part);
        }
    }
    out
}

/// Texts that cannot be drawn whole, each with the characters for which the font has no letters.
pub fn unknown_characters<'a>(texts: impl IntoIterator<Item = &'a str>) -> Vec<(&'a str, Vec<char>)> {
    let mut font = Font::new();
    let each = texts.into_iter().map(|text| (text, font.unknown(text)));
    each.filter(|(_, unknown)| !unknown.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_as_wide_as_its_letters_and_stands_on_its_base_line() {
        let mut font = Font::new();
        let letters = font.letters("HH");
        // Noto Sans: H advances 741 of 1000 units, is 714 high, and has one contour.
        assert!((letters.width_em - 1.482).abs() < 1e-3, "{}", letters.width_em);
        assert_eq!(letters.contours.len(), 2);
        let ends = |part: &Part| match *part {
            Part::Line(end) | Part::Quad(_, end) | Part::Cubic(_, _, end) => end,
        };
        let points =
            || letters.contours.iter().flat_map(|(begin, parts)| parts.iter().map(ends).chain([*begin]));
        let (low, high) = (points().reduce(DVec2::min).unwrap(), points().reduce(DVec2::max).unwrap());
        assert!(low.y.abs() < 1e-6 && (high.y - 0.714).abs() < 2e-3, "{low} {high}");
        assert!((low.x + high.x).abs() < 0.01, "the text is not in the middle: {low} {high}");
        assert!(Arc::ptr_eq(&letters, &font.letters("HH")));
    }

    #[test]
    fn letters_that_the_font_lacks_are_named() {
        let texts = ["Grüße an Ωμέγα и Жук, 0–9", "CT 断層 a"];
        assert_eq!(unknown_characters(texts), [("CT 断層 a", vec!['層', '断'])]);
    }
}
