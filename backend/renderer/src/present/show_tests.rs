//! Laws of what is shown.

use super::*;
use crate::present::lattice_of;
use proptest::prelude::*;
use protocol::SubFrame;

const RASTER: Raster = Raster { width: 9, height: 7 };

fn picture(colour: impl Fn(f32, f32) -> f32) -> Vec<f32> {
    picture_of(RASTER, colour)
}

fn picture_of(raster: Raster, colour: impl Fn(f32, f32) -> f32) -> Vec<f32> {
    let pixels = (0..raster.width * raster.height).map(|i| (i % raster.width, i / raster.width));
    pixels.flat_map(|(x, y)| [colour(x as f32, y as f32); 4]).collect()
}

/// What a device has after it cast some classes of a picture: the rest is of long ago.
fn partly(whole: &[f32], raster: Raster, known: Classes) -> Vec<f32> {
    let pixels = whole.chunks_exact(4).enumerate();
    let cast = |(i, pixel): (usize, &[f32])| {
        let has = known.has(i % raster.width, i / raster.width);
        [0, 1, 2, 3].map(|c| if has { pixel[c] } else { f32::NAN })
    };
    pixels.flat_map(cast).collect()
}

fn known_sets() -> Vec<Classes> {
    let cast = |has_rows| SubFrame::ORDER.map(|sub| Classes::of_lattice(&lattice_of(Some(sub), has_rows)));
    let (quincunx, rows) = (cast(false), cast(true));
    let grown =
        |n: usize| (0..4).map(move |i| (0..n).fold(Classes::default(), |s, k| s.with(quincunx[(i + k) % 4])));
    (1..=4).flat_map(grown).chain(rows).collect()
}

#[test]
fn known_pixels_are_shown_as_they_were_cast() {
    let (now, before) = (picture(|x, y| (x * y).sin()), picture(|x, y| (x + y).cos()));
    for known in known_sets() {
        for before in [None, Some(&before[..])] {
            let shown =
                reconstruct(&partly(&now, RASTER, known), before, RASTER, known, Thresholds::default());
            assert!(shown.iter().all(|number| number.is_finite()), "{known:?}");
            for (i, (shown, now)) in shown.chunks_exact(4).zip(now.chunks_exact(4)).enumerate() {
                if known.has(i % RASTER.width, i / RASTER.width) {
                    assert_eq!(shown, now, "{known:?} {i}");
                }
            }
        }
    }
}

/// The mean of an opposite pair of a plane's values is the value in the middle, so only the rim errs, and what is made from
/// the rim.
#[test]
fn slopes_come_back_without_what_was_before() {
    let ramp = picture(|x, y| 0.1 * x + 0.03 * y);
    for known in known_sets() {
        let shown = reconstruct(&partly(&ramp, RASTER, known), None, RASTER, known, Thresholds::default());
        for y in 2..RASTER.height - 2 {
            for x in 2..RASTER.width - 2 {
                let at = 4 * (y * RASTER.width + x);
                assert!((shown[at] - ramp[at]).abs() < 1e-5, "{known:?} {x} {y}");
            }
        }
    }
}

#[test]
fn what_stands_still_stays_to_the_bit_and_what_jumps_follows() {
    let (still, bright) = (picture(|x, y| (3.0 * x).sin().abs() * y), picture(|_, _| 0.875));
    let dark = picture(|_, _| 0.125);
    for known in known_sets() {
        let again =
            reconstruct(&partly(&still, RASTER, known), Some(&still), RASTER, known, Thresholds::default());
        assert_eq!(again, still, "{known:?}");
        let shown =
            reconstruct(&partly(&bright, RASTER, known), Some(&dark), RASTER, known, Thresholds::default());
        assert_eq!(shown, bright, "{known:?}");
    }
}

/// Light that grows everywhere by as much leaves detail as it is, also detail that no neighbour has.
#[test]
fn an_even_change_keeps_detail() {
    let detail = |x: f32, y: f32| if (x + y) % 3.0 == 0.0 { 0.5 } else { 0.25 };
    let (before, now) = (picture(detail), picture(|x, y| detail(x, y) + 0.125));
    for known in known_sets() {
        let shown =
            reconstruct(&partly(&now, RASTER, known), Some(&before), RASTER, known, Thresholds::default());
        assert_eq!(shown, now, "{known:?}");
    }
}

/// An edge between two flat colours stays an edge: pairs across it differ, pairs along it do not.
#[test]
fn edges_along_a_pair_stay_sharp() {
    let diagonal = picture(|x, y| if x > y { 1.0 } else { 0.0 });
    for known in known_sets() {
        let shown =
            reconstruct(&partly(&diagonal, RASTER, known), None, RASTER, known, Thresholds::default());
        for y in 1..RASTER.height - 1 {
            for x in 1..RASTER.width - 1 {
                let value = shown[4 * (y * RASTER.width + x)];
                let is_at_edge = x == y || x == y + 1;
                assert!(is_at_edge || value == 0.0 || value == 1.0, "{known:?} {x} {y} {value}");
            }
        }
    }
}

proptest! {
    #[test]
    fn nothing_leaves_the_range_of_what_there_is(
        numbers in prop::collection::vec(0.0_f32..1.0, 2 * 25), width in 1_usize..6, height in 1_usize..6, set in 0_usize..20,
    ) {
        let raster = Raster { width, height };
        let value = |x: f32, y: f32, k: usize| numbers[k * 25 + (5.0 * y + x) as usize];
        let now = picture_of(raster, |x, y| value(x, y, 0));
        let before = picture_of(raster, |x, y| value(x, y, 1));
        let known = known_sets()[set];
        let is_known = |i: usize| known.has(i % width, i / width);
        let cast: Vec<f32> = now.chunks_exact(4).enumerate()
            .flat_map(|(i, p)| [if is_known(i) { p[0] } else { 0.5 }; 4]).collect();
        let shown = reconstruct(&cast, Some(&before), raster, known, Thresholds::default());
        prop_assert!(shown.iter().all(|number| (0.0..=1.0).contains(number)));
    }
}

/// What each pixel is by the filter alone, of pictures that are kept apart; with no regard to what stands still.
fn pixel_by_pixel(cast: &[f32], before: &[f32], raster: Raster, known: Classes) -> Vec<f32> {
    passes(known).fold(cast.to_vec(), |picture, pass| {
        let filter = Filter { picture: &picture, raster, pass, thresholds: Thresholds::default() };
        let before = Before { numbers: before, first: 0 };
        let pixels = (0..raster.width * raster.height).map(|i| (i % raster.width, i / raster.width));
        let pixel = |(i, (x, y))| match pass.missing.has(x, y) {
            true => filter.pixel(x, y, Some(before), true),
            false => [0, 1, 2, 3].map(|c| picture[4 * i + c]),
        };
        pixels.enumerate().flat_map(pixel).collect()
    })
}

/// Bands of rows, those that stand still, and pixels that may change by little only.
#[test]
fn a_picture_made_in_place_is_the_one_made_apart() {
    let raster = Raster { width: 7, height: 3 * BAND + 5 };
    let before = picture_of(raster, |x, y| 0.5 + 0.4 * (3.1 * x + 1.7 * y).sin());
    let moves = |x: f32, y: f32| match y as usize {
        // A band whose neighbours move, a few rows, a few pixels.
        y if y / BAND == 1 => y + 1 == 2 * BAND,
        y => y < 4 || (x + y as f32) % 5.0 == 0.0,
    };
    let change = picture_of(raster, |x, y| if moves(x, y) { 0.3 * (x * y).cos() } else { 0.0 });
    let now: Vec<f32> = before.iter().zip(&change).map(|(was, change)| (was + change).max(0.0)).collect();
    for known in known_sets() {
        let cast = partly(&now, raster, known);
        for most_change in [None, Some(0.04)] {
            let mut expected = pixel_by_pixel(&cast, &before, raster, known);
            let expected_behind = most_change.is_some_and(|most| ease(&before, &mut expected, most));
            let mut shown = before.clone();
            let show = Show { cast: &cast, raster, known, thresholds: Thresholds::default(), most_change };
            assert_eq!(show.over(&mut shown, true), expected_behind, "{known:?}");
            assert_eq!(shown, expected, "{known:?} {most_change:?}");
            assert_eq!(expected_behind, most_change.is_some(), "something moves by more than a little");
        }
    }
}

#[test]
fn a_picture_of_another_size_is_none_that_was_before() {
    let now = picture(|x, y| (x * y).sin().abs());
    let show = Show {
        cast: &now,
        raster: RASTER,
        known: Classes::ALL,
        thresholds: Thresholds::default(),
        most_change: Some(0.01),
    };
    let mut shown = vec![f32::NAN; 3];
    assert!(!show.over(&mut shown, true));
    assert_eq!(shown, now);
}
