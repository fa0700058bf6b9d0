//! Lines as polygons of pixels.

use crate::polygon::{cut_line, hull};
use crate::view::{FLAT_PX, MOST_HALVINGS, View};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Convex polygons, all turning one way, whose union is the picture of a stroke: the discs about the ends of each piece of it,
/// and what lies between.
pub(crate) fn polygons(points: &[DVec3], radius_m: f64, view: &View) -> Vec<Vec<DVec2>> {
    let mut out = Vec::new();
    match *points {
        [] => {}
        [point] => line([point, point], radius_m, view, &mut out),
        _ => points.windows(2).for_each(|ends| line([ends[0], ends[1]], radius_m, view, &mut out)),
    }
    out
}

fn line(ends: [DVec3; 2], radius_m: f64, view: &View, out: &mut Vec<Vec<DVec2>>) {
    let kept = cut_line(ends, |p| view.margins(p).x).and_then(|ends| cut_line(ends, |p| view.margins(p).y));
    if let Some(ends) = kept {
        pieces(ends, radius_m, view, MOST_HALVINGS, out);
    }
}

fn pieces(ends: [DVec3; 2], radius_m: f64, view: &View, halvings: u32, out: &mut Vec<Vec<DVec2>>) {
    let [a, b] = ends;
    let middle = 0.5 * (a + b);
    if halvings > 0 && a != b && !is_straight(ends, middle, radius_m, view) {
        pieces([a, middle], radius_m, view, halvings - 1, out);
        pieces([middle, b], radius_m, view, halvings - 1, out);
        return;
    }
    let corners: Option<Vec<_>> = [a, b].into_iter().map(|end| disc(end, radius_m, view)).collect();
    // Beyond the horizon of a calibration there is nothing to see.
    out.extend(corners.map(|discs| hull(discs.concat())));
}

/// Whether the middle of a line and the edges beside it land halfway between those of its ends.
fn is_straight([a, b]: [DVec3; 2], middle: DVec3, radius_m: f64, view: &View) -> bool {
    let across = [DVec3::ZERO, DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y];
    across.into_iter().all(|way| {
        let pixel = |point: DVec3| view.pixel(point + radius_m * way);
        let off = || Some((pixel(middle)? - 0.5 * (pixel(a)? + pixel(b)?)).length());
        off().is_some_and(|off| off <= FLAT_PX)
    })
}

/// The corners of a disc parallel to the screen.
fn disc(centre: DVec3, radius_m: f64, view: &View) -> Option<Vec<DVec2>> {
    let middle = view.pixel(centre)?;
    let extent = |way: DVec3| Some((view.pixel(centre + radius_m * way)? - middle).length());
    let radius_px = extent(DVec3::X)?.max(extent(DVec3::Y)?);
    // An arc stands above its chord by r (1 − cos(π / n)).
    let corners = (TAU / 2.0 / (2.0 * FLAT_PX / radius_px.max(1.0)).sqrt()).ceil().clamp(8.0, 512.0);
    let corner = |i: u32| {
        let (sin, cos) = libm::sincos(f64::from(i) / corners * TAU);
        view.pixel(centre + radius_m * DVec3::new(cos, sin, 0.0))
    };
    (0..corners as u32).map(corner).collect()
}
