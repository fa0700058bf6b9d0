//! The key of a debug view: which value has which colour.

use optics::DebugView;
use renderer::output::{OutputError, Picture, write_png};
use std::path::Path;
use twin::debug::heat;

/// The picture of the key, in the output folder.
pub const LEGEND: &str = "legend.png";

/// Pixels of the picture, and of the bar in it.
const WIDTH: u32 = 640;
const HEIGHT: u32 = 76;
const BAR: (u32, u32, u32, u32) = (32, 10, 576, 32);
/// Length of a tick below the bar, and edge of a point of a digit, pixels.
const TICK: u32 = 6;
const POINT: u32 = 3;
/// Linear grey of ticks and digits.
const INK: f32 = 0.7;

/// What a view shows, in words.
pub fn shows(view: DebugView) -> &'static str {
    match view {
        DebugView::Lod => "levels above the finest from which the light comes",
        DebugView::Deficit => "levels by which the light's node is too coarse",
        DebugView::Samples => "samples that a ray took",
        DebugView::Weights => "share of the node's own samples; the rest is its parent's",
    }
}

/// The values that are marked; the last also stands for larger ones, if there can be any.
pub fn marks(view: DebugView) -> Vec<f64> {
    match view {
        DebugView::Lod | DebugView::Deficit => {
            let (_, most) = view.scale();
            (0..=most as u32).map(f64::from).collect()
        }
        DebugView::Samples => vec![0.0, 1.0, 4.0, 16.0, 64.0, 256.0, 1024.0],
        DebugView::Weights => vec![0.0, 0.25, 0.5, 0.75, 1.0],
    }
}

/// A mark's number as it is written.
pub fn number(view: DebugView, value: f64) -> String {
    let is_open = view != DebugView::Weights && value >= view.scale().1;
    format!("{value}{}", if is_open { "+" } else { "" })
}

/// Writes the picture of the key.
pub(crate) fn write_legend(view: DebugView, out: &Path) -> Result<(), OutputError> {
    write_png(&out.join(LEGEND), picture(view).view()?)
}

fn picture(view: DebugView) -> Picture {
    let mut rgba = [0.0, 0.0, 0.0, 1.0].repeat((WIDTH * HEIGHT) as usize);
    let mut fill = |(x, y, width, height): (u32, u32, u32, u32), rgb: [f32; 3]| {
        for (x, y) in (y..y + height).flat_map(|y| (x..x + width).map(move |x| (x, y))) {
            let at = 4 * (y * WIDTH + x) as usize;
            rgba[at..at + 3].copy_from_slice(&rgb);
        }
    };
    let (left, top, across, down) = BAR;
    let (low, high) = view.colours();
    for x in 0..across {
        let share = f64::from(x) / f64::from(across - 1);
        fill((left + x, top, 1, down), heat(low + (high - low) * share).0.map(|c| c as f32));
    }
    for value in marks(view) {
        let x = left + (view.place(value) * f64::from(across - 1)).round() as u32;
        fill((x, top + down, 1, TICK), [INK; 3]);
        let text = number(view, value);
        let half = (4 * text.len() as u32 - 1) * POINT / 2;
        for (place, letter) in (0..).zip(text.chars()) {
            let from = (x - half + 4 * POINT * place, top + down + TICK + POINT);
            for (px, py) in points(letter) {
                fill((from.0 + px * POINT, from.1 + py * POINT, POINT, POINT), [INK; 3]);
            }
        }
    }
    Picture { width: WIDTH, height: HEIGHT, rgba }
}

/// The points of a digit, 3 across and 5 down.
fn points(letter: char) -> impl Iterator<Item = (u32, u32)> {
    let bits: u32 = match letter {
        '0' => 0b111_101_101_101_111,
        '1' => 0b010_110_010_010_111,
        '2' => 0b111_001_111_100_111,
        '3' => 0b111_001_111_001_111,
        '4' => 0b101_101_111_001_001,
        '5' => 0b111_100_111_001_111,
        '6' => 0b111_100_111_101_111,
        '7' => 0b111_001_010_010_010,
        '8' => 0b111_101_111_101_111,
        '9' => 0b111_101_111_001_111,
        '.' => 0b000_000_000_000_010,
        '+' => 0b000_010_111_010_000,
        _ => 0,
    };
    (0..15).filter(move |i| bits >> (14 - i) & 1 == 1).map(|i| (i % 3, i / 3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_key_tells_the_colours_of_its_marks() {
        for view in DebugView::ALL {
            let picture = picture(view);
            let picture = picture.view().unwrap();
            let (left, top, across, _) = BAR;
            let (low, high) = view.colours();
            for value in marks(view) {
                let x = left + (view.place(value) * f64::from(across - 1)).round() as u32;
                let found = picture.pixel(x as usize, top as usize + 3);
                let colour = heat(low + (high - low) * view.place(value)).0;
                for (found, colour) in found.iter().zip(colour) {
                    assert!((f64::from(*found) - colour).abs() < 0.02, "{view:?} at {value}");
                }
                assert_eq!(picture.pixel(x as usize, (BAR.1 + BAR.3) as usize), [INK, INK, INK, 1.0]);
            }
        }
    }

    #[test]
    fn numbers_say_where_a_scale_is_open() {
        let numbers = |view| marks(view).into_iter().map(|v| number(view, v)).collect::<Vec<_>>().join(" ");
        assert_eq!(numbers(DebugView::Lod), "0 1 2 3 4+");
        assert_eq!(numbers(DebugView::Samples), "0 1 4 16 64 256 1024+");
        assert_eq!(numbers(DebugView::Weights), "0 0.25 0.5 0.75 1");
    }
}
