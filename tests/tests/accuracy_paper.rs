//! MImDA as published, whose picture depends on the step, against the reference over the same steps.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use display_config::Display;
use glam::{DQuat, UVec3};
use lightloom_tests::compare::{Limits, TruePixel, errors, lod_rule};
use lightloom_tests::draw::{self, With, draw};
use lightloom_tests::scenes::{TestScene, frame, optics, placed};
use optics::{Curve, Light, Mimda, MimdaForm};
use protocol::{DeviceChoice, FrameState, ProjectorImage};
use rayon::prelude::*;
use reference::{Field, Integrator, Radiance, Ray, Reference, Segmentation};
use std::sync::Arc;

/// One projector from the side and one near the middle.
const PROJECTORS: [u32; 2] = [1, 5];
/// What default quality promises is 0.5 and 4; on this scene, a twelfth of which is lit, it keeps less.
const KEPT: Limits = Limits::of_255(0.04, 0.6, 4.0);
/// Pixels between those compared.
const STRIDE: usize = 2;

/// Shells of importance that rises inward, in a volume of one brick: a ray's steps are then equal from end to end.
fn scene(display: &Display) -> TestScene {
    let source: Arc<dyn BrickSource> =
        Arc::new(ProceduralVolume::new("shells", UVec3::splat(28), 1e-3).unwrap());
    let mut optics = optics(
        (0.0, 1.0),
        &vec![(0.15, 0.0), (0.35, 0.15), (0.5, 0.05), (0.75, 0.4), (1.0, 0.8)],
        &vec![(0.2, [0.9, 0.35, 0.1]), (0.6, [0.1, 0.6, 0.9]), (1.0, [1.0, 0.95, 0.8])],
    );
    let importance = Curve::new(vec![(0.3, 0.0), (0.9, 1.0)]).unwrap();
    optics.mimda = Some(Mimda { importance, gamma: 0.8, form: MimdaForm::Paper });
    let place = placed(&*source, 0.8 * display.height_m, DQuat::from_rotation_y(0.4));
    let frame = frame(display, place, optics, Some(Light::default()));
    TestScene { name: "shells, MImDA as published", source, frame }
}

/// The pixels by the reference: in the limit of short steps, and over the steps that a device takes.
fn truths(display: &Display, scene: &TestScene) -> (Vec<TruePixel>, Vec<TruePixel>) {
    let TestScene { frame, source, .. } = scene;
    let rule = lod_rule(display, frame);
    let reference = Reference::new(Arc::clone(source), frame, &rule, Integrator::default()).unwrap();
    let pixels: Vec<(u32, u32, u32)> = PROJECTORS
        .iter()
        .flat_map(|&p| {
            (0..240).step_by(STRIDE).flat_map(move |y| (0..320).step_by(STRIDE).map(move |x| (p, x, y)))
        })
        .collect();
    pixels
        .into_par_iter()
        .map(|(projector, x, y)| {
            let law = display.beam_law(projector as usize, frame.observer_in_display, frame.eta).unwrap();
            let ray = law.ray(display.pixel_on_screen(projector as usize, x, y));
            let ray = Ray::new(ray.origin_in_display, ray.direction_in_display);
            let limit = reference.radiance(ray.origin_in_display, ray.direction_in_display).unwrap();
            let stepped = steps(frame, &reference, &ray)
                .map_or(Radiance::NOTHING, |steps| reference.segmented(&ray, &steps).unwrap());
            let pixel = |truth| TruePixel { projector, x, y, truth };
            (pixel(limit), pixel(stepped))
        })
        .unzip()
}

/// The steps of a ray through a volume of one brick: equal pairs.
fn steps(frame: &FrameState, reference: &Reference, ray: &Ray) -> Option<Segmentation> {
    let line = ray.line(&frame.display_from_volume.inverse());
    let (start, end) = line.clip(reference.field().extent(), (0.0, f64::INFINITY))?;
    let voxels = (end - start) * line.direction.length();
    let pairs = (voxels / (2.0 * frame.quality.step_voxels)).ceil().max(1.0);
    Some(Segmentation::uniform(start, end, 2 * pairs as u32).unwrap())
}

#[test]
fn the_published_form_takes_the_steps_it_says() {
    let _turn = draw::turn();
    let display = Display::load("desk8").unwrap();
    let scene = scene(&display);
    let (limit, stepped) = truths(&display, &scene);
    let pictures = |frame: &FrameState, device| -> Vec<ProjectorImage> {
        draw(&display, frame, &scene.source, &PROJECTORS, With::device(device)).images
    };
    for device in draw::devices() {
        let images = pictures(&scene.frame, device);
        let found = errors(&images, &stepped);
        println!("{} {device:?}: {found}", scene.name);
        println!("    from the limit of short steps: {}", errors(&images, &limit));
        assert!(KEPT.hold(&found), "{device:?}: {found}");
        assert!(found.pixels >= 15_000 && found.lit >= 3_000);
    }
    let with = |change: &dyn Fn(&mut FrameState)| {
        let mut frame = scene.frame.clone();
        change(&mut frame);
        errors(&pictures(&frame, DeviceChoice::Cpu), &stepped)
    };
    let mimda = |change: &dyn Fn(&mut Mimda)| with(&|f| f.optics.mimda.iter_mut().for_each(change));
    let canaries = [
        ("steps four times as long", with(&|f| f.quality.step_voxels *= 4.0)),
        ("the consistent form", mimda(&|m| m.form = MimdaForm::Consistent)),
        ("gamma off by 0.05", mimda(&|m| m.gamma += 0.05)),
        ("no MImDA", with(&|f| f.optics.mimda = None)),
    ];
    for (what, errors) in canaries {
        println!("    {what}: {errors}");
        assert!(!KEPT.hold(&errors), "{what} passes for the published form");
    }
}
