//! Laws of filling, and that filling again is filling anew.

use super::*;
use crate::refine::ERROR_UNIT;

const SIZES: [[u32; 2]; 5] = [[1, 1], [7, 9], [64, 48], [131, 97], [3, 200]];

/// A picture of some function of x and y, in every channel.
fn picture([width, height]: [u32; 2], colour: impl Fn(f32, f32) -> f32) -> Vec<f32> {
    (0..width * height).flat_map(|i| [colour((i % width) as f32, (i / width) as f32); 4]).collect()
}

/// The picture with what is not cast yet spoiled: nothing may look at it.
fn unknown(mut picture: Vec<f32>, order: &Order, done: u32) -> Vec<f32> {
    for (at, pixel) in picture.chunks_exact_mut(4).enumerate() {
        if !order.is_cast(at, done) {
            pixel.fill(f32::NAN);
        }
    }
    picture
}

#[test]
fn a_complete_picture_is_what_was_cast_and_has_no_error() {
    for grain in [Grain::Pixels, Grain::Rows] {
        for size in SIZES {
            let (order, cast) = (Order::new(grain, size), picture(size, |x, y| (x * 0.7 + y * y).sin()));
            assert_eq!(
                fill(cast.clone(), None, Filled::default(), &order, UNITS),
                Filled { rgba: cast, ..Filled::default() }
            );
        }
    }
}

#[test]
fn one_colour_is_filled_from_its_first_unit_on_with_no_error() {
    for grain in [Grain::Pixels, Grain::Rows] {
        for size in SIZES {
            let (order, flat) = (Order::new(grain, size), picture(size, |_, _| 0.25));
            for done in [1, 2, 3, 4, 5, 15, 16, 17, 33, 63] {
                let filled = fill(unknown(flat.clone(), &order, done), None, Filled::default(), &order, done);
                assert_eq!((&filled.rgba, filled.spatial), (&flat, 0), "{grain:?} {size:?} {done}");
            }
        }
    }
}

#[test]
fn what_is_cast_stays_and_nothing_looks_at_what_is_not() {
    for grain in [Grain::Pixels, Grain::Rows] {
        let size = [131, 97];
        let (order, full) =
            (Order::new(grain, size), picture(size, |x, y| (0.3 * x).sin() * (0.2 * y).cos()));
        for done in 1..UNITS {
            let filled = fill(unknown(full.clone(), &order, done), None, Filled::default(), &order, done);
            for (at, (filled, cast)) in filled.rgba.chunks_exact(4).zip(full.chunks_exact(4)).enumerate() {
                assert!(filled.iter().all(|n| n.is_finite()));
                assert!(!order.is_cast(at, done) || filled == cast);
            }
        }
    }
}

#[test]
fn more_units_leave_less_error_and_the_estimate_follows_it() {
    let size = [160, 120];
    let (order, full) =
        (Order::new(Grain::Pixels, size), picture(size, |x, y| 0.5 + 0.5 * (0.1 * x + 0.004 * y * y).sin()));
    let mut last = f64::INFINITY;
    for done in [1, 4, 16, 32, 48] {
        let filled = fill(unknown(full.clone(), &order, done), None, Filled::default(), &order, done);
        let pixels = (size[0] * size[1]) as f64;
        let true_error: f64 =
            filled.rgba.iter().zip(&full).map(|(a, b)| f64::from((a - b).abs())).sum::<f64>()
                / (4.0 * pixels);
        let estimate = filled.spatial as f64 * ERROR_UNIT / pixels;
        assert!(true_error < last && estimate > 0.5 * true_error, "{done}: {true_error} {estimate}");
        last = true_error;
    }
}

#[test]
fn an_edge_beside_a_missing_pixel_is_its_error() {
    // Nine columns: 0 and 8 are cast first, one dark and one bright; between them all is made.
    let size = [9, 1];
    let order = Order::new(Grain::Pixels, size);
    let full = picture(size, |x, _| if x < 4.0 { 0.0 } else { 1.0 });
    let filled = fill(unknown(full, &order, 1), None, Filled::default(), &order, 1);
    assert_eq!(filled.rgba[16], 0.5, "the middle of the two");
    // The variance of 0 and 1 is 1/2 in each of three channels.
    let middle = (1.5_f64).sqrt();
    assert!(filled.spatial as f64 * ERROR_UNIT > middle);
}

#[test]
fn what_stands_still_keeps_its_detail_and_has_no_error() {
    for grain in [Grain::Pixels, Grain::Rows] {
        let size = [131, 97];
        let (order, full) =
            (Order::new(grain, size), picture(size, |x, y| (0.9 * x).sin() * (1.2 * y).cos() + 1.0));
        let before = fill(full.clone(), None, Filled::default(), &order, UNITS);
        for done in [1, 7, 33] {
            let filled =
                fill(unknown(full.clone(), &order, done), Some(&before), Filled::default(), &order, done);
            assert_eq!((&filled.rgba, filled.spatial), (&full, 0), "{grain:?} {done}");
        }
    }
}

#[test]
fn what_becomes_brighter_everywhere_keeps_its_detail() {
    let size = [64, 48];
    let order = Order::new(Grain::Pixels, size);
    let at = |light: f32| picture(size, |x, y| 0.5 + light + 0.2 * (2.0 * x).sin() * (2.5 * y).cos());
    let (dark, bright) = (fill(at(0.0), None, Filled::default(), &order, UNITS), at(0.1));
    let error = |before| {
        let filled = fill(unknown(bright.clone(), &order, 2), before, Filled::default(), &order, 2);
        filled.rgba.iter().zip(&bright).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    };
    assert!(error(Some(&dark)) < 1e-5 && error(None) > 0.1, "{} {}", error(Some(&dark)), error(None));
}

#[test]
fn what_has_gone_leaves_nothing_behind() {
    // A bright square that is elsewhere now.
    let size = [64, 64];
    let order = Order::new(Grain::Pixels, size);
    let square =
        |left: f32| {
            picture(size, |x, y| {
                if (left..left + 20.0).contains(&x) && (16.0..40.0).contains(&y) { 1.0 } else { 0.0 }
            })
        };
    let before = fill(square(4.0), None, Filled::default(), &order, UNITS);
    let now = square(36.0);
    for done in [4, 16, 32] {
        let filled = fill(unknown(now.clone(), &order, done), Some(&before), Filled::default(), &order, done);
        let alone = fill(unknown(now.clone(), &order, done), None, Filled::default(), &order, done);
        // Where it was: columns 4 to 23; it is at columns 36 to 55 now.
        let left = |rgba: &[f32]| -> f32 {
            rgba.chunks_exact(4).enumerate().filter(|(at, _)| at % 64 < 28).map(|(_, pixel)| pixel[0]).sum()
        };
        let (left, left_alone) = (left(&filled.rgba), left(&alone.rgba));
        assert!(
            left <= left_alone + 0.02 * 480.0,
            "{done}: {left} of 480 are left, {left_alone} without the past"
        );
    }
}

/// Pictures of one state after another, each with so many units: going on from the last is filling anew.
#[test]
fn going_on_is_filling_anew_to_the_bit() {
    for grain in [Grain::Pixels, Grain::Rows] {
        for size in SIZES {
            let order = Order::new(grain, size);
            let bar = |shift: f32| {
                picture(size, |x, y| if (x - shift).abs() < 9.0 { 1.0 + (0.3 * y).sin() } else { 0.0 })
            };
            let before = fill(bar(20.0), None, Filled::default(), &order, UNITS);
            for before in [None, Some(&before)] {
                let mut last = Filled::default();
                // Detail that comes changes pixels that were cast before.
                for (done, shift) in
                    [(1, 30.0), (2, 30.0), (5, 30.0), (6, 31.0), (17, 31.0), (40, 31.0), (63, 31.0)]
                {
                    let cast = unknown(bar(shift), &order, done);
                    let anew = fill(cast.clone(), before, Filled::default(), &order, done);
                    last = fill(cast, before, last, &order, done);
                    assert!(last == anew, "{grain:?} {size:?} {done}");
                }
                assert!(
                    size[0] < 64 || last.rgba.iter().any(|&n| n > 1.0),
                    "an empty picture proves nothing"
                );
            }
        }
    }
}

#[test]
fn what_was_made_of_another_order_or_of_more_units_is_not_gone_on_from() {
    let size = [64, 48];
    let full = picture(size, |x, y| (0.4 * x).sin() + (0.3 * y).cos() + 2.0);
    let [pixels, rows] = [Grain::Pixels, Grain::Rows].map(|grain| Order::new(grain, size));
    let anew = fill(full.clone(), None, Filled::default(), &pixels, 5);
    for (order, done) in [(&rows, 3), (&pixels, 9)] {
        let other = fill(full.clone(), None, Filled::default(), order, done);
        assert!(fill(full.clone(), None, other, &pixels, 5) == anew);
    }
}
