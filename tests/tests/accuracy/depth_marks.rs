//! Marks that are depth-combined, against what rays see if the marks are things on their way.

use display_config::{Display, Ray};
use glam::DVec3;
use lightloom_tests::compare::{Limits, TruePixel, errors, lod_rule, seen_by};
use lightloom_tests::draw::{self, With};
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::techniques;
use optics::Curve;
use protocol::{DeviceChoice, FrameState, Mark, MarkShape, Paint};
use reference::{Integrator, Radiance, Reference};
use std::sync::Arc;

const PROJECTORS: [u32; 2] = [1, 6];
const STRIDE: u32 = 2;

/// A wall through the volume that fills the picture: where its plane is, and its paint.
#[derive(Clone, Copy)]
struct Wall {
    point: DVec3,
    normal: DVec3,
    paint: Paint,
}

impl Wall {
    fn new(z: f64, tilt: f64, rgb: [f32; 3], opacity: f32) -> Self {
        let (point, normal) = (DVec3::new(0.0, 0.0, z), DVec3::new(tilt, 0.5 * tilt, 1.0));
        Self { point, normal, paint: Paint { rgb, opacity } }
    }

    fn mark(&self) -> Mark {
        let at = |x: f64, y: f64| {
            let (dx, dy) = (x - self.point.x, y - self.point.y);
            let z = self.point.z - (self.normal.x * dx + self.normal.y * dy) / self.normal.z;
            DVec3::new(x, y, z)
        };
        let corners_in_display = vec![at(-2.0, -2.0), at(2.0, -2.0), at(2.0, 2.0), at(-2.0, 2.0)];
        let shape = MarkShape::Sheet { corners_in_display };
        Mark { shape, paint: self.paint, is_depth_combined: true }
    }

    fn distance_m(&self, ray: &Ray) -> f64 {
        (self.point - ray.origin_in_display).dot(self.normal) / ray.direction_in_display.dot(self.normal)
    }

    /// As something that a ray meets.
    fn radiance(&self) -> Radiance {
        let opacity = f64::from(self.paint.opacity);
        let rgb = opacity * DVec3::from_array(self.paint.rgb.map(f64::from));
        Radiance { rgb, opacity, ..Radiance::NOTHING }
    }
}

/// What rays see of a scene with walls in it: the parts between them, one over the other. With importance only of an opaque wall: it
/// is seen behind the part before it.
fn truth(display: &Display, scene: &TestScene, walls: &[Wall]) -> Vec<TruePixel> {
    let TestScene { frame, source, .. } = scene;
    let rule = lod_rule(display, frame);
    let reference = Reference::new(Arc::clone(source), frame, &rule, Integrator::default()).unwrap();
    seen_by(display, frame, &PROJECTORS, STRIDE, |ray| {
        let mut near: Vec<(f64, Radiance)> =
            walls.iter().map(|wall| (wall.distance_m(ray), wall.radiance())).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let way = reference::Ray::new(ray.origin_in_display, ray.direction_in_display);
        let part = |from: f64, to: f64| {
            reference.tracer().radiance_within(reference.field(), &way, (from, to)).unwrap()
        };
        let (mut seen, mut from) = (Radiance::NOTHING, 0.0);
        for (distance, wall) in near {
            seen = seen.over(part(from, distance)).over(wall);
            from = distance;
        }
        seen.over(part(from, f64::INFINITY))
    })
}

fn with_walls(frame: &FrameState, walls: &[Wall]) -> FrameState {
    FrameState { marks: walls.iter().map(Wall::mark).collect(), ..frame.clone() }
}

const OPAQUE: f32 = 1.0;

/// Scenes, with walls that suit them.
fn cases(display: &Display) -> Vec<(TestScene, Vec<Wall>)> {
    let red = Wall::new(0.02, 0.4, [0.8, 0.1, 0.05], 0.5);
    let blue = Wall::new(-0.05, -0.3, [0.1, 0.2, 0.9], 0.7);
    let solid = Wall::new(0.0, 0.2, [0.3, 0.7, 0.2], OPAQUE);
    let bumps = techniques::bumps(display);
    let mut blended = bumps.clone();
    blended.frame.quality.blended = true;
    blended.frame.quality.lod_scale = 2.3;
    let mut all = vec![
        (scenes::shells(display), vec![blue, red, solid]),
        (blended, vec![red, blue]),
        (techniques::with(&bumps, "picker, probe and clip plane with MImDA"), vec![solid]),
    ];
    all.extend(scenes::cranium(display).map(|scene| (scene, vec![red, blue])));
    all
}

/// Of pictures without marks of such scenes: what lies before and behind marks is cast by the same kernels to the same tolerance.
const LIMITS: Limits = Limits::of_255(0.1, 1.0, 1.0);

#[test]
fn marks_lie_where_they_are_among_what_rays_meet() {
    let _turn = draw::turn();
    let display = Display::load("desk8").unwrap().with_rasters(40, 30);
    for (scene, walls) in cases(&display) {
        let truth = truth(&display, &scene, &walls);
        let frame = with_walls(&scene.frame, &walls);
        let draw =
            |frame: &FrameState, with| draw::draw(&display, frame, &scene.source, &PROJECTORS, with).images;
        let ways = draw::devices().into_iter().map(With::device).chain([With::PLANES]);
        for with in ways {
            let found = errors(&draw(&frame, with), &truth);
            println!("{}, {:?}, {:?}: {found}", scene.name, with.device, with.caster);
            assert!(LIMITS.hold(&found), "{}, {with:?}: {found}", scene.name);
        }
        let with = With::device(DeviceChoice::Cpu);
        let mut other = frame.clone();
        other.marks.reverse();
        assert!(draw(&other, with) == draw(&frame, with), "{}: the order of marks shows", scene.name);
        // The canary: marks that shine through are far off.
        let mut through = frame;
        through.marks.iter_mut().for_each(|mark| mark.is_depth_combined = false);
        let found = errors(&draw(&through, with), &truth);
        assert!(!LIMITS.hold(&found) && found.rms > 10.0 * LIMITS.rms, "{}: {found}", scene.name);
    }
}

#[test]
fn bent_rays_do_not_meet_marks_where_they_are() {
    let _turn = draw::turn();
    let display = Display::load("desk8").unwrap().with_rasters(16, 12);
    let scene = techniques::bumps(&display);
    let mut frame = with_walls(&scene.frame, &[Wall::new(0.0, 0.0, [1.0; 3], OPAQUE)]);
    let (mut renderer, _) = draw::renderer(&display, &scene.source, &[0], With::device(DeviceChoice::Cpu));
    let refusal = |frame: &FrameState, renderer: &mut renderer::Renderer| {
        protocol::Draw::draw(renderer, frame, &mut |_| {}).err().map(|error| error.to_string())
    };
    frame.optics.refraction = Some(Curve::constant(1.3));
    assert_eq!(refusal(&frame, &mut renderer), None, "what bends nothing is no hindrance");
    frame.optics.refraction = Some(Curve::new(vec![(0.2, 1.0), (0.8, 1.3)]).unwrap());
    let refused = refusal(&frame, &mut renderer).unwrap();
    assert!(refused.contains("depth-combined") && refused.contains("shine through"), "{refused}");
    frame.marks[0].is_depth_combined = false;
    assert_eq!(refusal(&frame, &mut renderer), None);
}
