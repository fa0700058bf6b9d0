//! The laws of geometrical optics that a path must keep.

use super::bending::Bending;
use super::follower::{End, Follower, LONGEST_WAY_DIAGONALS, Limits};
use crate::refraction_index::Index;
use crate::test_scene::{VOXEL_M, optics};
use crate::{AnalyticField, Field, Ray};
use glam::{DAffine3, DMat3, DVec3};
use optics::{Curve, Optics};
use std::ops::ControlFlow;

/// Edge of the tests' volumes, voxels.
const EDGE: f64 = 10.0;
/// The middle of them.
const CENTRE: DVec3 = DVec3::splat(5.0);
/// Deviation of the tests' ways, voxels.
const DEVIATION: f64 = 1e-6;

/// A way: its chords, in voxels.
struct Way {
    chords: Vec<(Ray, f64)>,
    end: End,
}

impl Way {
    /// Through a field with an index, from a ray in voxels, in a volume of voxels of `VOXEL_M`.
    fn new(field: &dyn Field, index: &[(f64, f64)], start: &Ray) -> Self {
        Self::placed(field, index, start, DMat3::IDENTITY)
    }

    /// The same for a volume turned and stretched by `placement`; all in units of `VOXEL_M`.
    fn placed(field: &dyn Field, index: &[(f64, f64)], start: &Ray, placement: DMat3) -> Self {
        let curve = Curve::new(index.to_vec()).unwrap();
        let plain = optics(Curve::constant(1.0), Curve::constant(DVec3::ONE));
        let optics = Optics { refraction: Some(curve.clone()), ..plain };
        let volume_from_display = DAffine3::from_mat3(placement * VOXEL_M).inverse();
        let bending = Bending { field, index: &Index::new(&curve), optics: &optics, volume_from_display };
        let diagonal_m = 3.0_f64.sqrt() * EDGE * VOXEL_M;
        let limits = Limits { voxel_m: VOXEL_M, diagonal_m, deviation_m: DEVIATION * VOXEL_M };
        let start = Ray { origin_in_display: start.origin_in_display * VOXEL_M, ..*start };
        let mut chords = Vec::new();
        let mut take = |way: Ray, length_m: f64| {
            let way = Ray { origin_in_display: way.origin_in_display / VOXEL_M, ..way };
            chords.push((way, length_m / VOXEL_M));
            Ok(ControlFlow::Continue(()))
        };
        let end = Follower::new(&bending, limits, &start).unwrap().follow(&mut take).unwrap();
        Self { chords, end }
    }

    fn length(&self) -> f64 {
        self.chords.iter().map(|chord| chord.1).sum()
    }

    fn last(&self) -> Ray {
        let (way, length) = self.chords[self.chords.len() - 1];
        Ray { origin_in_display: way.at(length), ..way }
    }

    /// How near it comes to a point.
    fn nearest(&self, point: DVec3) -> f64 {
        let to_chord = |(way, length): &(Ray, f64)| {
            let t = (point - way.origin_in_display).dot(way.direction_in_display).clamp(0.0, *length);
            (way.at(t) - point).length()
        };
        self.chords.iter().map(to_chord).fold(f64::INFINITY, f64::min)
    }

    /// Middle and direction of each chord: on an arc, the direction is that of the way there.
    fn middles(&self) -> impl Iterator<Item = (DVec3, DVec3)> {
        self.chords.iter().map(|(way, length)| (way.at(0.5 * length), way.direction_in_display))
    }
}

/// A field that is `index` scaled to [0, 1], with its gradient by central differences, and the curve that undoes it.
fn field_of(
    lowest: f64,
    highest: f64,
    index: impl Fn(DVec3) -> f64 + Send + Sync + Copy,
) -> (impl Field, [(f64, f64); 2]) {
    let scalar = move |p: DVec3| (index(p) - lowest) / (highest - lowest);
    let gradient = move |p: DVec3| {
        let h = 1e-4;
        DVec3::from_array(DVec3::AXES.map(|axis| (scalar(p + h * axis) - scalar(p - h * axis)) / (2.0 * h)))
    };
    (AnalyticField::new(DVec3::splat(EDGE), scalar, gradient), [(0.0, lowest), (1.0, highest)])
}

/// s = x / 10, with a flat surface at x = 5.
fn slab() -> impl Field {
    AnalyticField::new(DVec3::splat(EDGE), |p: DVec3| p.x / EDGE, |_| DVec3::X / EDGE)
}

fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
    Ray::new(DVec3::from_array(origin), DVec3::from_array(direction))
}

#[test]
fn one_index_bends_nothing() {
    let start = ray([0.0, 4.0, 4.5], [1.0, 0.1, 0.2]);
    let way = Way::new(&slab(), &[(0.0, 1.4)], &start);
    assert!(way.chords.len() == 1 && way.end == End::Followed);
    assert_eq!(way.last().direction_in_display, start.direction_in_display);
    assert!((way.length() - EDGE / start.direction_in_display.x).abs() < 1e-12);
}

#[test]
fn a_flat_surface_keeps_the_law_of_snell() {
    for (from, to) in [(1.0, 1.5), (1.5, 1.0), (1.2, 1.21)] {
        let start = ray([0.0, 3.0, 4.0], [1.0, 0.4, 0.2]);
        let way = Way::new(&slab(), &[(0.5, from), (0.5, to)], &start);
        let last = way.last().direction_in_display;
        let [before, after] = [start.direction_in_display, last].map(|v| DVec3::new(0.0, v.y, v.z));
        assert!((before * from - after * to).length() < 1e-9, "{last}");
        let bent = way.chords.iter().find(|chord| chord.0.direction_in_display == last).unwrap();
        assert!((bent.0.origin_in_display.x - 5.0).abs() < 1e-9);
    }
}

#[test]
fn beyond_the_critical_angle_a_surface_is_a_mirror() {
    let start = ray([4.0, 1.0, 5.0], [1.0, 1.5, 0.0]);
    let way = Way::new(&slab(), &[(0.5, 1.5), (0.5, 1.0)], &start);
    let v = start.direction_in_display;
    assert!((way.last().direction_in_display - DVec3::new(-v.x, v.y, 0.0)).length() < 1e-12);
    assert!((way.last().origin_in_display.x - 0.0).abs() < 1e-9 && way.end == End::Followed);
}

#[test]
fn a_ball_that_is_only_grazed_bends_light_as_much_as_any() {
    let (radius, index) = (3.0, 1.5);
    let from_centre = |p: DVec3| (p - CENTRE).length();
    let field = AnalyticField::new(
        DVec3::splat(EDGE),
        move |p| 1.0 - from_centre(p) / EDGE,
        move |p: DVec3| -(p - CENTRE).normalize_or_zero() / EDGE,
    );
    let at_surface = 1.0 - radius / EDGE;
    for depth in [0.3, 1e-2, 1e-4, 1e-6, -1e-6] {
        let aside = radius - depth;
        let start = ray([0.03, 5.0 + aside, 5.0], [1.0, 0.0, 0.0]);
        let way = Way::new(&field, &[(at_surface, 1.0), (at_surface, index)], &start);
        let sine: f64 = aside / radius;
        let turn = if depth > 0.0 { 2.0 * (sine.asin() - (sine / index).asin()) } else { 0.0 };
        let last = way.last().direction_in_display;
        assert!((last - DVec3::new(turn.cos(), -turn.sin(), 0.0)).length() < 1e-6, "{depth}: {last}");
    }
}

#[test]
fn an_index_whose_square_is_linear_makes_parabolas() {
    // Along σ with ds = ν dσ the way is p'' = ∇ν²/2: here ν² = 1 + 0.2 x of the display, in a volume that is turned and
    // stretched.
    let placement = DMat3::from_rotation_z(0.4) * DMat3::from_diagonal(DVec3::new(1.3, 0.8, 1.1));
    let index = |x: f64| (1.0 + 0.2 * x).max(0.1).sqrt();
    let scalar = move |p: DVec3| (index((placement * p).x) - 0.3) / 2.0;
    let gradient = move |p: DVec3| placement.transpose() * DVec3::X * 0.1 / index((placement * p).x) / 2.0;
    let field = AnalyticField::new(DVec3::splat(EDGE), scalar, gradient);
    let start = Ray::new(placement * DVec3::new(0.5, 5.0, 3.0), DVec3::new(-0.3, 1.0, 0.2));
    let way = Way::placed(&field, &[(0.0, 0.3), (1.0, 2.3)], &start, placement);
    let momentum = start.direction_in_display * index(start.origin_in_display.x);
    assert!(way.end == End::Followed && way.chords.len() > 100);
    for (chord, _) in &way.chords {
        let offset = chord.origin_in_display - start.origin_in_display;
        let sigma = offset.y / momentum.y;
        let exact = momentum * sigma + DVec3::X * 0.05 * sigma * sigma;
        assert!((offset - exact).length() < 10.0 * DEVIATION, "{offset} {exact}");
    }
}

#[test]
fn the_fish_eye_of_maxwell_images_a_point_on_its_antipode() {
    let radius = 4.0;
    let (field, index) =
        field_of(0.3, 2.0, move |p| 2.0 / (1.0 + (p - CENTRE).length_squared() / (radius * radius)));
    for direction in [[1.0, 0.1, 0.0], [1.0, 0.5, -0.3], [1.0, 0.0, 0.9]] {
        let start = ray([1.0, 5.0, 5.0], direction);
        let way = Way::new(&field, &index, &start);
        let miss = way.nearest(DVec3::new(9.0, 5.0, 5.0));
        assert!(miss < 20.0 * DEVIATION && way.end == End::Followed, "{direction:?}: {miss:e}");
    }
}

#[test]
fn the_lens_of_luneburg_focuses_parallel_light() {
    let radius = 4.0;
    let square = move |p: DVec3| 2.0 - (p - CENTRE).length_squared() / (radius * radius);
    let (field, index) = field_of(1.0, 1.5, move |p| square(p).max(1.0).sqrt());
    for offset in [0.3, 1.0, 2.0, 3.0] {
        let way = Way::new(&field, &index, &ray([0.0, 5.0 + offset, 5.0], [1.0, 0.0, 0.0]));
        let miss = way.nearest(DVec3::new(9.0, 5.0, 5.0));
        // The kink at its rim is where central differences round it off.
        assert!(miss < 1e-4, "{offset}: {miss:e}");
    }
}

#[test]
fn a_radial_index_keeps_the_invariant_of_bouguer() {
    // Outside the bump light goes straight, so the first and the last chord have the way's own directions.
    let radial = |p: DVec3| 1.0 + 0.5 * (-0.8 * (p - CENTRE).length_squared()).exp();
    let (field, index) = field_of(1.0, 1.5, radial);
    let way = Way::new(&field, &index, &ray([0.0, 5.9, 5.5], [1.0, 0.0, 0.02]));
    let invariant =
        |(point, direction): (DVec3, DVec3)| radial(point) * (point - CENTRE).cross(direction).length();
    let all: Vec<f64> = way.middles().map(invariant).collect();
    let (first, last) = (all[0], all[all.len() - 1]);
    assert!((first - last).abs() < 20.0 * DEVIATION, "{first} {last}");
    // A chord has the direction of its middle up to the square of its length.
    assert!(all.iter().all(|other| (other - first).abs() < 1e-3));
    let bend = way.last().direction_in_display.angle_between(way.chords[0].0.direction_in_display);
    assert!(bend > 0.1, "{bend}");
}

#[test]
fn light_returns_the_way_it_came() {
    let bump = |p: DVec3, centre: [f64; 3]| (-(p - DVec3::from_array(centre)).length_squared()).exp();
    let (field, _) = field_of(0.0, 1.0, move |p| bump(p, [4.0, 5.0, 5.0]) + 0.8 * bump(p, [6.2, 5.7, 4.8]));
    let index = [(0.0, 1.0), (0.5, 1.1), (0.5, 1.3), (1.0, 1.35)];
    let start = ray([0.0, 4.8, 5.2], [1.0, 0.06, -0.05]);
    let there = Way::new(&field, &index, &start);
    let last = there.last();
    let inside =
        Ray { origin_in_display: last.origin_in_display, direction_in_display: -last.direction_in_display };
    let back = Way::new(&field, &index, &inside);
    assert!(there.end == End::Followed && back.end == End::Followed);
    let bend = last.direction_in_display.angle_between(start.direction_in_display);
    let miss = back.nearest(start.origin_in_display);
    assert!(bend > 0.05 && miss < 100.0 * DEVIATION, "{bend} {miss:e}");
}

#[test]
fn without_a_gradient_light_goes_straight_on() {
    let field = AnalyticField::new(DVec3::splat(EDGE), |p: DVec3| p.x / EDGE, |_| DVec3::ZERO);
    let start = ray([0.0, 4.0, 4.0], [1.0, 0.2, 0.1]);
    let way = Way::new(&field, &[(0.0, 1.0), (0.5, 1.1), (0.5, 1.5), (1.0, 2.0)], &start);
    assert!((way.last().direction_in_display - start.direction_in_display).length() < 1e-15);
}

#[test]
fn light_that_circles_for_ever_ends_after_the_longest_way() {
    let ball = |p: DVec3| 1.0 - (p - CENTRE).length() / 10.0;
    let field =
        AnalyticField::new(DVec3::splat(EDGE), ball, |p: DVec3| -(p - CENTRE).normalize_or_zero() / 10.0);
    let way = Way::new(&field, &[(0.7, 1.0), (0.7, 1.5)], &ray([5.0, 7.8, 5.0], [1.0, 0.1, 0.0]));
    let longest = LONGEST_WAY_DIAGONALS * 3.0_f64.sqrt() * EDGE;
    assert!(way.end == End::Followed && (way.length() - longest).abs() < 1e-6 * longest, "{}", way.length());
    assert!(way.chords.iter().all(|(way, _)| (way.origin_in_display - CENTRE).length() < 3.0 + 1e-6));
}
