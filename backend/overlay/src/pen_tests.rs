//! What is drawn against what each ray meets.

use super::*;
use crate::letters::{Letters, Part};
use display_config::{BeamLaw, Display, Homography, Raster};
use glam::{DVec3, UVec2};
use proptest::prelude::*;

/// Rays per pixel, along each axis, that say how much of it a mark covers; and that look for what is missing or too much.
const RAYS: u32 = 8;
const CLOSE_RAYS: u32 = 24;
/// A pixel may be wrong where an edge passes this near to it, pixels.
const QUARTER: f64 = 0.25;
/// Slivers and gaps that are narrower than this are between the rays, pixels.
const BETWEEN: f64 = 1.5 / CLOSE_RAYS as f64;

const WHITE: Paint = Paint { rgb: [1.0; 3], opacity: 1.0 };

/// Lays marks that shine through into a picture.
fn draw(pen: &mut Pen, marks: &[Mark], view: &View, rgba: &mut [f32]) {
    for Fragment { pixel, paint: Paint { rgb: [r, g, b], opacity }, place } in pen.fragments(marks, view) {
        assert_eq!(place, None);
        let parts = rgba[4 * pixel as usize..].iter_mut().zip([r, g, b, 1.0]);
        parts.for_each(|(part, own)| *part = (1.0 - opacity) * *part + opacity * own);
    }
}

/// Whether the ray of a screen point meets a mark, told without any inverse.
fn meets(law: &BeamLaw, screen: DVec2, shape: &MarkShape, letters: &[[DVec2; 2]]) -> bool {
    let ray = law.ray(screen);
    let at_depth = |z: f64| ray.at((z - ray.origin_in_display.z) / ray.direction_in_display.z);
    match shape {
        MarkShape::Stroke { points_in_display, radius_m } => {
            let gap = |[a, b]: [DVec3; 2]| {
                // Both go evenly with depth, so their distance is that of a point from a line in the plane.
                if a.z == b.z {
                    let (here, way) = (at_depth(a.z).truncate(), (b - a).truncate());
                    let t =
                        ((here - a.truncate()).dot(way) / way.length_squared().max(1e-300)).clamp(0.0, 1.0);
                    return (here - a.truncate() - t * way).length();
                }
                let (from, to) = (at_depth(a.z) - a, at_depth(b.z) - b);
                let way = to - from;
                let t = (-from.dot(way) / way.length_squared().max(1e-300)).clamp(0.0, 1.0);
                (from + t * way).length()
            };
            let points = points_in_display;
            let single = (points.len() == 1).then(|| [points[0], points[0]]);
            let pairs = points.windows(2).map(|pair| [pair[0], pair[1]]).chain(single);
            pairs.into_iter().any(|pair| gap(pair) <= *radius_m)
        }
        MarkShape::Sheet { corners_in_display: corners } => {
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
            let distance =
                (corners[0] - ray.origin_in_display).dot(normal) / ray.direction_in_display.dot(normal);
            let hit = ray.at(distance);
            let turns = corners.iter().zip(corners.iter().cycle().skip(1));
            let sides: Vec<f64> = turns.map(|(a, b)| (b - a).cross(hit - a).dot(normal)).collect();
            sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0)
        }
        MarkShape::Label { base_in_display: base, em_m, .. } => {
            let at = (at_depth(base.z) - base).truncate() / em_m;
            is_inside(letters, at)
        }
    }
}

/// The edges of letters, whose curves are cut into 64 pieces each.
fn edges(letters: &Letters) -> Vec<[DVec2; 2]> {
    let mut edges = Vec::new();
    for (begin, parts) in &letters.contours {
        let mut here = *begin;
        for part in parts {
            let from = here;
            for i in 1..=64 {
                let t = f64::from(i) / 64.0;
                let next = match *part {
                    Part::Line(end) => end,
                    Part::Quad(control, end) => from.lerp(control, t).lerp(control.lerp(end, t), t),
                    Part::Cubic(a, b, end) => {
                        let (p, q, r) = (from.lerp(a, t), a.lerp(b, t), b.lerp(end, t));
                        p.lerp(q, t).lerp(q.lerp(r, t), t)
                    }
                };
                edges.push([here, next]);
                here = next;
                if matches!(part, Part::Line(_)) {
                    break;
                }
            }
        }
        edges.push([here, *begin]);
    }
    edges
}

/// Whether a point is inside what edges go around.
fn is_inside(edges: &[[DVec2; 2]], at: DVec2) -> bool {
    let mut winding = 0;
    for &[a, b] in edges {
        if (a.y <= at.y) != (b.y <= at.y) {
            let is_right = a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x) > at.x;
            winding += match (is_right, b.y > a.y) {
                (false, _) => 0,
                (true, true) => 1,
                (true, false) => -1,
            };
        }
    }
    winding != 0
}

/// What is wrong of the picture of a mark: pixels that are not full though the rays within a quarter pixel around all meet it, or not
/// empty though none does. With the pixels in which anything is drawn, and what those at edges are off on average.
struct Compared {
    wrong: usize,
    drawn: usize,
    mean_off: f64,
}

fn compare(shape: &MarkShape, law: BeamLaw, raster: &Raster, drawn_law: BeamLaw) -> Compared {
    let view = View::new(drawn_law, raster).unwrap();
    let UVec2 { x: width, y: height } = view.size();
    let mut rgba = vec![0.0; 4 * (width * height) as usize];
    let mut pen = Pen::default();
    draw(
        &mut pen,
        &[Mark { shape: shape.clone(), paint: WHITE, is_depth_combined: false }],
        &view,
        &mut rgba,
    );
    let letters = match shape {
        MarkShape::Label { text, .. } => edges(&Font::new().letters(text)),
        _ => Vec::new(),
    };
    let meets = |at: DVec2| meets(&law, raster.screen_from_pixel.apply(at), shape, &letters);
    let among = |rays: u32, low: DVec2, high: DVec2| {
        let place = move |i: u32| (f64::from(i) + 0.5) / f64::from(rays);
        (0..rays * rays).map(move |i| low + (high - low) * DVec2::new(place(i % rays), place(i / rays)))
    };
    let mut compared = Compared { wrong: 0, drawn: 0, mean_off: 0.0 };
    for (number, pixel) in rgba.chunks_exact(4).enumerate() {
        let low = DVec2::new((number as u32 % width).into(), (number as u32 / width).into());
        let share = f64::from(pixel[3]);
        let mut around = among(CLOSE_RAYS, low - QUARTER, low + 1.0 + QUARTER);
        let is_missing = share < 1.0 - BETWEEN && around.clone().all(meets);
        let is_too_much = share > BETWEEN && !around.any(meets);
        compared.wrong += usize::from(is_missing || is_too_much);
        compared.drawn += usize::from(share > 0.0);
        if share > 0.0 && share < 1.0 {
            let met = among(RAYS, low, low + 1.0).filter(|&at| meets(at)).count();
            compared.mean_off += (share - met as f64 / f64::from(RAYS * RAYS)).abs();
        }
    }
    compared.mean_off /= compared.drawn.max(1) as f64;
    compared
}

/// A raster of 96 × 72 pixels whose corners are off their places by these parts of the screen.
fn raster(jitter: [f64; 8]) -> Raster {
    let half = DVec2::new(0.8, 0.45);
    let corner = |x: f64, y: f64, i: usize| half * DVec2::new(x + jitter[i], y + jitter[i + 1]);
    let corners = [corner(-1.0, 1.0, 0), corner(1.0, 1.0, 2), corner(1.0, -1.0, 4), corner(-1.0, -1.0, 6)];
    let size = DVec2::new(96.0, 72.0);
    let screen_from_pixel = Homography::of_corners(size, corners).unwrap();
    Raster { width: 96, height: 72, screen_from_pixel, output: None }
}

fn point() -> impl Strategy<Value = DVec3> {
    (-0.9..0.9, -0.5..0.5, -0.8..0.8).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn shape() -> impl Strategy<Value = MarkShape> {
    let stroke = (prop::collection::vec(point(), 1..4), 0.01..0.08)
        .prop_map(|(points_in_display, radius_m)| MarkShape::Stroke { points_in_display, radius_m });
    let sheet = [point(), point(), point()]
        .prop_map(|corners| MarkShape::Sheet { corners_in_display: corners.into() });
    let label = (point(), 0.1..0.4).prop_map(|(base_in_display, em_m)| MarkShape::Label {
        text: "Ray & Żó8".to_owned(),
        base_in_display,
        em_m,
        backing: None,
    });
    prop_oneof![stroke, sheet, label]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, rng_seed: prop::test_runner::RngSeed::Fixed(11), ..ProptestConfig::default() })]

    #[test]
    fn marks_are_where_rays_meet_them(
        shape in shape(), projector in 0usize..72, eta in prop_oneof![Just(0.0), Just(0.5), Just(1.0)],
        jitter in prop::array::uniform8(-0.05f64..0.05),
    ) {
        let display = Display::load("holo72").unwrap();
        let law = display.beam_law(projector, display.observer_in_display, eta).unwrap();
        let compared = compare(&shape, law, &raster(jitter), law);
        prop_assert_eq!(compared.wrong, 0);
        // 64 rays find the share of a pixel to about 1/30.
        prop_assert!(compared.mean_off < 0.05, "{}", compared.mean_off);
    }
}

/// Marks that are drawn for other rays, by up to three pixels aside, are found out.
#[test]
fn marks_of_other_rays_are_found() {
    let display = Display::load("holo72").unwrap();
    let (observer, mut centre) = (display.observer_in_display, display.projectors[20].centre_in_display);
    let law = BeamLaw::new(centre, observer, 1.0).unwrap();
    centre.x += 0.6;
    let other = BeamLaw::new(centre, observer, 1.0).unwrap();
    let points = vec![DVec3::new(-0.3, -0.2, 0.5), DVec3::new(0.3, 0.25, -0.5)];
    let shape = MarkShape::Stroke { points_in_display: points, radius_m: 0.03 };
    let raster = raster([0.0; 8]);
    assert_eq!(compare(&shape, law, &raster, law).wrong, 0);
    let wrong = compare(&shape, law, &raster, other);
    assert!(wrong.wrong > 20, "{} of {} pixels", wrong.wrong, wrong.drawn);
}

/// Corners, labels and tips: what is given to a twentieth of a pixel is drawn there by all projectors of a display.
#[test]
fn tips_land_where_the_rays_of_all_projectors_put_them() {
    let display = Display::load("holo72").unwrap();
    let tip = DVec3::new(0.11, -0.07, 0.35);
    let mut worst = 0.0_f64;
    for eta in [0.0, 0.5, 1.0] {
        for (number, projector) in display.projectors.iter().enumerate() {
            let law = display.beam_law(number, display.observer_in_display, eta).unwrap();
            let view = View::new(law, &projector.raster).unwrap();
            let dot = MarkShape::Stroke { points_in_display: vec![tip], radius_m: 0.01 };
            let mut rgba = vec![0.0; 4 * 800 * 600];
            draw(
                &mut Pen::default(),
                &[Mark { shape: dot, paint: WHITE, is_depth_combined: false }],
                &view,
                &mut rgba,
            );
            // The middle of what is drawn.
            let (mut sum, mut weight) = (DVec2::ZERO, 0.0);
            for (i, pixel) in rgba.chunks_exact(4).enumerate().filter(|(_, pixel)| pixel[3] > 0.0) {
                let at = DVec2::new((i % 800) as f64 + 0.5, (i / 800) as f64 + 0.5);
                (sum, weight) = (sum + f64::from(pixel[3]) * at, weight + f64::from(pixel[3]));
            }
            // The ray of that place passes the tip; how far beside it, in pixels at its depth.
            let ray = law.ray(projector.raster.screen_from_pixel.apply(sum / weight));
            let beside = ray.at((tip.z - ray.origin_in_display.z) / ray.direction_in_display.z) - tip;
            let pixel_m = law.divisors(tip.z) * DVec2::new(display.width_m / 800.0, display.height_m / 600.0);
            worst = worst.max((beside.truncate() / pixel_m).length());
        }
    }
    println!("tips of 72 projectors at three η: at most {worst:.4} pixels beside their rays");
    assert!(worst < QUARTER, "{worst}");
}

#[test]
fn colours_lie_over_each_other() {
    let display = Display::load("holo72").unwrap();
    let law = display.beam_law(0, display.observer_in_display, 1.0).unwrap();
    let view = View::new(law, &raster([0.0; 8])).unwrap();
    let wall = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let sheet = |rgb, opacity| Mark {
        shape: MarkShape::Sheet { corners_in_display: wall.into() },
        paint: Paint { rgb, opacity },
        is_depth_combined: false,
    };
    let mut rgba = [0.25, 0.0, 0.0, 0.5].repeat(96 * 72);
    draw(&mut Pen::default(), &[sheet([0.0, 1.0, 0.0], 0.5), sheet([0.0, 0.0, 1.0], 0.25)], &view, &mut rgba);
    for pixel in rgba.chunks_exact(4) {
        let near = |a: f32, b: f32| (a - b).abs() < 1e-6;
        assert!(
            near(pixel[0], 0.09375)
                && near(pixel[1], 0.375)
                && near(pixel[2], 0.25)
                && near(pixel[3], 0.8125),
            "{pixel:?}"
        );
    }
}

#[test]
fn what_has_no_image_is_not_drawn_and_does_not_hang() {
    let display = Display::load("holo72").unwrap();
    let law = display.beam_law(5, display.observer_in_display, 1.0).unwrap();
    let view = View::new(law, &raster([0.0; 8])).unwrap();
    let stroke = |points: &[DVec3]| MarkShape::Stroke { points_in_display: points.to_vec(), radius_m: 0.01 };
    let far = DVec3::new(1e9, -1e9, -3.0);
    let shapes = [
        stroke(&[]),
        stroke(&[DVec3::NAN, DVec3::ZERO]),
        stroke(&[DVec3::new(0.0, 0.0, 3.0), DVec3::new(0.0, 0.0, 5.0)]),
        stroke(&[DVec3::new(0.0, 0.0, 5.0), DVec3::new(0.0, 0.0, -50.0)]),
        stroke(&[DVec3::splat(f64::MAX), DVec3::splat(f64::MIN)]),
        stroke(&[far, -far]),
        MarkShape::Sheet { corners_in_display: vec![far, -far, DVec3::INFINITY] },
        MarkShape::Label { text: "\n\u{0}".into(), base_in_display: far, em_m: 1e9, backing: Some(WHITE) },
        MarkShape::Label {
            text: "near".into(),
            base_in_display: DVec3::Z * 2.99,
            em_m: 1.0,
            backing: Some(WHITE),
        },
    ];
    for shape in shapes {
        let mut rgba = vec![0.0; 4 * 96 * 72];
        draw(
            &mut Pen::default(),
            &[Mark { shape, paint: WHITE, is_depth_combined: false }],
            &view,
            &mut rgba,
        );
        assert!(rgba.iter().all(|part| (0.0..=1.0).contains(part)));
    }
}

#[test]
fn marks_among_others_are_laid_from_the_farthest_to_the_nearest() {
    let display = Display::load("holo72").unwrap();
    let law = display.beam_law(30, display.observer_in_display, 1.0).unwrap();
    let view = View::new(law, &raster([0.0; 8])).unwrap();
    let at = |z: f64, opacity: f32, is_depth_combined: bool| {
        let wall = [(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)].map(|(x, y)| DVec3::new(x, y, z));
        let shape = MarkShape::Sheet { corners_in_display: wall.into() };
        Mark { shape, paint: Paint { rgb: [1.0; 3], opacity }, is_depth_combined }
    };
    // The opacity tells which it is.
    let marks = [at(-0.5, 0.5, false), at(0.2, 0.1, true), at(-1.0, 0.2, true), at(0.2, 0.3, true)];
    let fragments = Pen::default().fragments(&marks, &view);
    assert_eq!(fragments.len(), 4 * 96 * 72);
    for of_pixel in fragments.chunks_exact(4) {
        assert!(of_pixel.iter().all(|one| one.pixel == of_pixel[0].pixel));
        let order: Vec<f32> = of_pixel.iter().map(|one| one.paint.opacity).collect();
        assert_eq!(order, [0.2, 0.1, 0.3, 0.5]);
        let places: Vec<FragmentPlace> = of_pixel.iter().filter_map(|one| one.place).collect();
        assert_eq!(places.len(), 3);
        for (FragmentPlace { ray, distance_m }, z) in places.iter().zip([-1.0, 0.2, 0.2]) {
            assert!((ray.at(*distance_m).z - z).abs() < 1e-12);
        }
    }
}

#[test]
fn a_line_into_the_depth_lies_where_its_discs_are() {
    let display = Display::load("holo72").unwrap();
    let law = display.beam_law(36, display.observer_in_display, 1.0).unwrap();
    let view = View::new(law, &raster([0.0; 8])).unwrap();
    let (a, b) = (DVec3::new(-0.3, 0.05, -0.6), DVec3::new(0.3, -0.05, 0.4));
    let shape = MarkShape::Stroke { points_in_display: vec![a, b], radius_m: 0.02 };
    let mark = Mark { shape, paint: WHITE, is_depth_combined: true };
    let fragments = Pen::default().fragments(&[mark], &view);
    assert!(fragments.len() > 100, "{}", fragments.len());
    let mut reach = (f64::INFINITY, f64::NEG_INFINITY);
    for Fragment { place, .. } in &fragments {
        let FragmentPlace { ray, distance_m } = place.unwrap();
        let at = ray.at(distance_m);
        let middle = a.lerp(b, (at.z - a.z) / (b.z - a.z));
        // A pixel that the line covers in part has its middle beside it, by less than a pixel's diagonal.
        let pixel_m = law.divisors(at.z) * DVec2::new(display.width_m / 96.0, display.height_m / 72.0);
        assert!(at.distance(middle) <= 0.02 + pixel_m.length(), "{at} is not at {middle}");
        reach = (reach.0.min(at.z), reach.1.max(at.z));
    }
    assert!(reach.0 < -0.55 && reach.1 > 0.35, "{reach:?}");
}
