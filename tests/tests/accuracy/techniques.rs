//! Every illustrative technique: kernel, twin and reference tell one picture.

use display_config::Display;
use glam::DVec3;
use lightloom_tests::compare::{self, Errors, Limits, cells, errors_between, errors_of, heads};
use lightloom_tests::draw::{self, Drawn, With};
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::techniques::{self, TECHNIQUES, band_picker, clip_plane, layer_opacity, probe};
use lightloom_tests::twin_scene::{TwinScene, view};
use optics::{
    BandPicker, ClipPlane, Curve, Enhancer, LayerOpacity, MOST_ENHANCERS, Mimda, MimdaForm, Probe, Ramp,
};
use protocol::{DeviceChoice, FilterChoice, ProjectorImage};
use std::sync::Arc;
use twin::Real;

/// One projector from the side and one near the middle.
const PROJECTORS: [u32; 2] = [1, 5];
/// What two ways to round cost: see the comparison of kernel and twin.
const SAME_TO_ROUNDING: Limits = Limits::of_255(0.002, 0.05, 1.0);
/// The same where eight links cut a ray: each stretch has a number of steps of its own, so that there are eight times as many
/// places where rounding makes it another, and the RMS is √8 times as large.
const SAME_TO_ROUNDING_OF_EIGHT: Limits = Limits::of_255(0.0057, 0.05, 1.0);
/// The same where light is bent: each of some hundred turns passes on the rounding of the turns before it, and on real
/// data, where neighbouring rays part, a few pixels meet another surface.
const SAME_BUT_BENT: Limits = Limits::of_255(0.005, 0.1, 2.0);
/// What default quality keeps: here as below, a tenth to a fourth above the most that was measured, in whole pictures too.
const KEPT: Limits = Limits::of_255(0.065, 1.05, 1.8);
/// Bent light in real data, in whole pictures: of some thousand rays one grazes a surface and goes the other way.
const KEPT_BENT_IN_WHOLE_PICTURES: Limits = Limits::of_255(0.125, 2.3, 10.0);
/// MImDA over a chain: importance rises where a step is still too long for it to be seen.
const KEPT_CHAINED: Limits = Limits::of_255(0.15, 2.25, 3.8);
/// The same through a chain of eight links.
const KEPT_IN_CHAINS_OF_EIGHT: Limits = Limits::of_255(0.2, 2.3, 2.5);

/// For the reference, which takes a part of the pixels.
fn test_display() -> Display {
    scenes::small_desk8(160, 120)
}

/// Fewer pixels, for kernels: a GPU's driver may run on the processor, twenty times as slow as their twins.
fn small_display() -> Display {
    scenes::small_desk8(64, 48)
}

/// Fewer still, for what has to be the same to the bit in each.
fn tiny_display() -> Display {
    Display::load("desk8").unwrap().with_rasters(32, 24)
}

fn draw_on(display: &Display, scene: &TestScene, device: DeviceChoice) -> Arc<Drawn> {
    let TestScene { frame, source, .. } = scene;
    let with = With { filter: FilterChoice::Exact, ..With::device(device) };
    let drawn = draw::drawn_once(display, frame, source, &PROJECTORS, with);
    assert!(drawn.report.complete, "{}", drawn.report.shortfall);
    assert_is_light(scene.name, &drawn.images);
    drawn
}

/// Neither NaN nor infinite nor negative, nor more than opaque.
fn assert_is_light(name: &str, images: &[ProjectorImage]) {
    let pixels = images.iter().flat_map(|image| image.rgba.as_chunks::<4>().0);
    for pixel in pixels {
        let is_light = pixel.iter().all(|n| n.is_finite() && *n >= 0.0) && pixel[3] <= 1.0 + 1e-5;
        assert!(is_light, "{name}: {pixel:?} is no light");
    }
}

/// Every technique on every base, with the plain picture of the base.
fn for_each_technique(display: &Display, mut see: impl FnMut(&TestScene, &TestScene)) {
    for base in techniques::bases(display) {
        for (name, _) in TECHNIQUES {
            see(&base, &techniques::with(&base, name));
        }
    }
}

fn is_bent(scene: &TestScene) -> bool {
    scene.frame.optics.refraction.is_some()
}

#[test]
fn kernel_and_twin_tell_the_same_picture() {
    let _turn = draw::turn();
    if !draw::has_gpu() {
        return;
    }
    let display = small_display();
    for_each_technique(&display, |base, scene| {
        let plain = draw_on(&display, base, DeviceChoice::Cpu);
        let twin = draw_on(&display, scene, DeviceChoice::Cpu);
        let kernel = draw_on(&display, scene, DeviceChoice::Gpu);
        let errors = errors_between(&kernel.images, &twin.images);
        let effect = errors_between(&twin.images, &plain.images);
        println!("{:10} {:40} {errors}; it changes {:.2} RMS", base.name, scene.name, effect.rms * 255.0);
        let limits = if is_bent(scene) { SAME_BUT_BENT } else { SAME_TO_ROUNDING };
        assert!(limits.hold(&errors), "{}, {}: {errors}", base.name, scene.name);
        assert!(!limits.hold(&effect), "{}, {} changes nothing", base.name, scene.name);
    });
}

/// What a technique keeps on a base. A whole picture has rays that no smaller one has.
fn limits_of(base: &TestScene, scene: &TestScene) -> Limits {
    let optics = &scene.frame.optics;
    let has_probe = optics.enhancers.iter().any(|link| matches!(link, Enhancer::Probe(_)));
    let is_real = base.name != "bumps";
    let is_chained = has_probe && optics.mimda.is_some();
    if scenes::full_size() && is_bent(scene) && is_real {
        KEPT_BENT_IN_WHOLE_PICTURES
    } else if is_chained {
        KEPT_CHAINED
    } else {
        KEPT
    }
}

#[test]
fn the_reference_tells_the_same_picture() {
    let _turn = draw::turn();
    let display = test_display();
    let mut results = Results::new(Program::Tests("accuracy"), "accuracy", "techniques");
    results.line(heads(["scene", "technique"]));
    let mut failed = Vec::new();
    for_each_technique(&display, |base, scene| {
        let truth = compare::traced(&display, &scene.frame, &scene.source, &PROJECTORS, 4);
        let reached = truth.iter().filter(|pixel| pixel.truth.reached).count();
        let errors = compare::errors(&draw_on(&display, scene, DeviceChoice::Cpu).images, &truth);
        let plain = compare::errors(&draw_on(&display, base, DeviceChoice::Cpu).images, &truth);
        results.line(format!("| {} | {} | {} |", base.name, scene.name, cells(&errors)));
        assert!(reached == truth.len(), "{}, {}: {reached} reached", base.name, scene.name);
        let limits = limits_of(base, scene);
        if !limits.hold(&errors) {
            failed.push(format!("{}, {}: {errors}", base.name, scene.name));
        }
        assert!(!limits.hold(&plain), "{}, {}: the plain picture passes", base.name, scene.name);
    });
    results.finish().unwrap();
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn f32_costs_no_more_than_rounding() {
    let _turn = draw::turn();
    let display = test_display();
    fn numbers<F: Real>(rgba: Vec<[F; 4]>) -> impl Iterator<Item = [f64; 4]> {
        rgba.into_iter().map(|rgba| rgba.map(|n| f64::from(n.to_f32())))
    }
    // A third of the pixels, all over the picture.
    let raster = &display.projectors[PROJECTORS[0] as usize].raster;
    let pixels: Vec<(u32, u32)> =
        (0..raster.height).flat_map(|y| (y % 3..raster.width).step_by(3).map(move |x| (x, y))).collect();
    for_each_technique(&display, |base, scene| {
        let twin = TwinScene::new(&display, &scene.frame, &*scene.source);
        let view = view(&display, PROJECTORS[0], &scene.frame, &*scene.source);
        let pairs = numbers(twin.cast(&view.rounded(), &pixels)).zip(numbers(twin.cast(&view, &pixels)));
        let errors: Errors = errors_of(pairs);
        println!("{:10} {:40} f32 against f64: {errors}", base.name, scene.name);
        let limits = if is_bent(scene) { SAME_BUT_BENT } else { SAME_TO_ROUNDING };
        assert!(limits.hold(&errors), "{}, {}: {errors}", base.name, scene.name);
    });
}

/// A strength that a host takes for one, and that rounds to 0 in f32: the kernel has the enhancer, which does nothing.
const NEXT_TO_NOTHING: f64 = 1e-60;
/// The same for a factor.
const NEXT_TO_ONE: f64 = 1.0 + 1e-12;

#[test]
fn enhancers_that_do_nothing_are_none_to_the_bit() {
    let _turn = draw::turn();
    let display = tiny_display();
    let neutral = [
        Enhancer::ClipPlane(ClipPlane { strength: NEXT_TO_NOTHING, ..clip_plane() }),
        Enhancer::Probe(Probe { strength: NEXT_TO_NOTHING, ..probe() }),
        Enhancer::BandPicker(BandPicker { strength: NEXT_TO_NOTHING, ..band_picker([0.3, 0.4, 0.5, 0.6]) }),
        Enhancer::LayerOpacity(LayerOpacity {
            away: NEXT_TO_ONE,
            toward: NEXT_TO_ONE,
            ..layer_opacity([0.1, 0.2, 0.3, 0.4])
        }),
    ];
    let importance = techniques::with(&techniques::bumps(&display), TECHNIQUES[10].0).frame.optics.mimda;
    for base in techniques::bases(&display) {
        for mimda in [None, importance.clone()] {
            let mut plain = base.clone();
            plain.frame.optics.mimda = mimda;
            for device in draw::devices() {
                let expected = &draw_on(&display, &plain, device).images;
                let mut chains = vec![neutral[..3].to_vec()];
                // One by one in one field only on a GPU, whose driver may take seconds to compile each.
                if device == DeviceChoice::Cpu || base.name == "bumps" {
                    chains.extend(neutral.iter().map(|&link| vec![link]));
                }
                for chain in chains {
                    let mut scene = plain.clone();
                    scene.frame.optics.enhancers = chain;
                    let found = &draw_on(&display, &scene, device).images;
                    let errors = errors_between(found, expected);
                    assert!(found == expected, "{device:?}, {:?}: {errors}", scene.frame.optics.enhancers);
                }
            }
        }
    }
}

#[test]
fn gamma_zero_is_ordinary_compositing_to_the_bit_under_enhancers_too() {
    let _turn = draw::turn();
    let display = tiny_display();
    for base in techniques::bases(&display) {
        let mut scene = techniques::with(&base, TECHNIQUES[10].0);
        // All but the probe, which looks at importance whatever γ is.
        scene.frame.optics.enhancers.remove(1);
        for device in draw::devices() {
            for form in [MimdaForm::Paper, MimdaForm::Consistent] {
                let with_gamma = |gamma: f64, scene: &mut TestScene| {
                    let old = scene.frame.optics.mimda.take().unwrap();
                    scene.frame.optics.mimda = Some(Mimda { gamma, form, ..old });
                    draw_on(&display, scene, device)
                };
                let zero = with_gamma(0.0, &mut scene);
                let some = with_gamma(0.8, &mut scene);
                let mut without = scene.clone();
                without.frame.optics.mimda = None;
                let ordinary = draw_on(&display, &without, device);
                assert!(zero.images == ordinary.images, "{device:?}, {form:?}");
                assert!(some.images != ordinary.images, "{device:?}, {form:?}: γ changes nothing");
            }
        }
    }
}

/// A γ that is 0 in single precision, but not to those who ask whether it is: importance is accumulated, and erases nothing.
const NEXT_TO_NO_GAMMA: f64 = 1e-60;

#[test]
fn a_probe_sees_the_same_importance_whether_it_is_accumulated_or_not() {
    let _turn = draw::turn();
    let display = small_display();
    let scene = techniques::with(&techniques::bumps(&display), TECHNIQUES[11].0);
    let picker = Enhancer::BandPicker(band_picker([0.35, 0.4, 0.5, 0.7]));
    for (device, picks) in draw::devices().into_iter().flat_map(|d| [(d, false), (d, true)]) {
        let with = |change: &dyn Fn(&mut Option<Mimda>)| {
            let mut scene = scene.clone();
            let optics = &mut scene.frame.optics;
            optics.enhancers.splice(0..0, picks.then_some(picker));
            change(&mut optics.mimda);
            draw_on(&display, &scene, device)
        };
        let alone = with(&|_| ());
        let gamma = |mimda: &mut Option<Mimda>| mimda.as_mut().unwrap().gamma = NEXT_TO_NO_GAMMA;
        let accumulated = errors_between(&alone.images, &with(&gamma).images);
        assert!(SAME_TO_ROUNDING.hold(&accumulated), "{device:?}, {picks}: {accumulated}");
        let ignored = errors_between(&alone.images, &with(&|mimda| *mimda = None).images);
        assert!(!SAME_TO_ROUNDING.hold(&ignored), "{device:?}, {picks}: importance changes nothing");
    }
}

/// What counts as opaque.
const OPAQUE: f32 = 0.999;
/// A slice shows the tissue of its first hundredth of a voxel, of 255.
const SAME_COLOUR: f32 = 0.5;

#[test]
fn a_slice_through_a_thin_medium_is_opaque_on_the_plane() {
    let _turn = draw::turn();
    let display = small_display();
    let mut scene = techniques::bumps(&display);
    // Without the plane, all of the volume together hides an eighth of what lies behind it.
    scene.frame.light = None;
    scene.frame.optics.extinction = Curve::constant(0.002);
    let mut cut = scene.clone();
    let never = Ramp { low: 2.0, high: 3.0 };
    let facing = ClipPlane { normal_in_display: DVec3::Z, context: never, ..clip_plane() };
    cut.frame.optics.enhancers = vec![Enhancer::ClipPlane(facing)];
    // The plane lies where the one of five hundred times the extinction does.
    let mut solid = cut.clone();
    solid.frame.optics.extinction = Curve::constant(1.0);
    for device in draw::devices() {
        for step_voxels in [0.25, 1.0] {
            let with = |scene: &TestScene| {
                let mut scene = scene.clone();
                scene.frame.quality.step_voxels = step_voxels;
                draw_on(&display, &scene, device).images.clone()
            };
            let (thin, cut, solid) = (with(&scene), with(&cut), with(&solid));
            let pixels = |images: &[ProjectorImage]| -> Vec<[f32; 4]> {
                images.iter().flat_map(|image| image.rgba.as_chunks::<4>().0).copied().collect()
            };
            assert!(pixels(&thin).iter().all(|pixel| pixel[3] < 0.2));
            let pairs: Vec<([f32; 4], [f32; 4])> = pixels(&cut).into_iter().zip(pixels(&solid)).collect();
            // Those that are not, a ray comes to from the side.
            let meant = pairs.iter().filter(|(_, solid)| solid[3] > OPAQUE).count();
            let opaque: Vec<_> = pairs.into_iter().filter(|(thin, _)| thin[3] > OPAQUE).collect();
            println!(
                "{device:?}, steps of {step_voxels} voxels: {} pixels of {meant} are opaque",
                opaque.len()
            );
            assert!(meant > 640 && 10 * opaque.len() > 8 * meant, "{device:?}: {} of {meant}", opaque.len());
            let worst = opaque.iter().flat_map(|(thin, solid)| (0..3).map(|c| (thin[c] - solid[c]).abs()));
            let worst = 255.0 * worst.fold(0.0, f32::max);
            assert!(worst < SAME_COLOUR, "{device:?}: {worst} of 255");
        }
    }
}

#[test]
fn order_matters_exactly_where_the_reference_says_so() {
    let _turn = draw::turn();
    let display = small_display();
    let base = techniques::with(&techniques::bumps(&display), TECHNIQUES[10].0);
    let picker = Enhancer::BandPicker(band_picker([0.35, 0.4, 0.5, 0.7]));
    let layer = Enhancer::LayerOpacity(layer_opacity([0.3, 0.4, 0.6, 0.8]));
    let [plane, probe] = [Enhancer::ClipPlane(clip_plane()), Enhancer::Probe(probe())];
    for (name, links, matters) in [
        ("picker and probe", [picker, probe], true),
        ("plane and layer", [plane, layer], false),
        ("plane and picker", [plane, picker], false),
        ("probe and plane", [probe, plane], false),
    ] {
        let told = |links: Vec<Enhancer>| {
            let mut scene = base.clone();
            scene.frame.optics.enhancers = links;
            let truth = compare::truth(&display, &scene.frame, &scene.source, &PROJECTORS, 2);
            let pictures = draw::devices().into_iter().map(|d| draw_on(&display, &scene, d));
            (truth, pictures.collect::<Vec<_>>())
        };
        let (truth, pictures) = told(links.to_vec());
        let (turned_truth, turned) = told(links.iter().rev().copied().collect());
        let numbers = |r: &reference::Radiance| [r.rgb.x, r.rgb.y, r.rgb.z, r.opacity];
        let pairs = truth.iter().zip(&turned_truth).map(|(a, b)| (numbers(&a.truth), numbers(&b.truth)));
        let by_reference = errors_of(pairs);
        println!("{name}: the reference {by_reference}");
        assert_eq!(!SAME_TO_ROUNDING.hold(&by_reference), matters, "{name}: {by_reference}");
        for (a, b) in pictures.iter().zip(&turned) {
            let errors = errors_between(&a.images, &b.images);
            println!("{name}: a device    {errors}");
            assert_eq!(!SAME_TO_ROUNDING.hold(&errors), matters, "{name}: {errors}");
        }
    }
}

/// Three visitors with two tools each, beside the scene's own two: as many links as a chain may have, each of which acts.
#[test]
fn the_longest_chain_tells_the_same_picture() {
    let _turn = draw::turn();
    let display = test_display();
    let base = techniques::with(&techniques::bumps(&display), TECHNIQUES[10].0);
    let at = |x: f64, y: f64| {
        let centre_in_display = DVec3::new(x, y, 0.06);
        Enhancer::Probe(Probe { centre_in_display, radius_m: 0.05, ..probe() })
    };
    let cut = |normal: DVec3, point_in_display: DVec3| {
        let normal_in_display = normal.normalize();
        Enhancer::ClipPlane(ClipPlane { point_in_display, normal_in_display, ..clip_plane() })
    };
    let chain = vec![
        cut(DVec3::new(0.3, 0.2, 1.0), DVec3::new(0.0, 0.0, 0.05)),
        cut(DVec3::new(1.0, 0.0, 0.4), DVec3::new(0.07, 0.0, 0.0)),
        Enhancer::BandPicker(band_picker([0.35, 0.4, 0.5, 0.7])),
        Enhancer::LayerOpacity(layer_opacity([0.3, 0.4, 0.6, 0.8])),
        at(-0.05, 0.0),
        at(0.03, 0.03),
        at(0.0, -0.05),
        at(-0.03, 0.06),
    ];
    assert_eq!(chain.len(), MOST_ENHANCERS);
    let told = |chain: &[Enhancer]| {
        let mut scene = TestScene { name: "eight links", ..base.clone() };
        scene.frame.optics.enhancers = chain.to_vec();
        scene
    };
    let scene = told(&chain);
    let truth = compare::traced(&display, &scene.frame, &scene.source, &PROJECTORS, 4);
    let pictures: Vec<_> = draw::devices().into_iter().map(|d| draw_on(&display, &scene, d)).collect();
    for picture in &pictures {
        let errors = compare::errors(&picture.images, &truth);
        println!("eight links: {errors}");
        assert!(KEPT_IN_CHAINS_OF_EIGHT.hold(&errors), "{errors}");
        let apart = errors_between(&picture.images, &pictures[0].images);
        assert!(SAME_TO_ROUNDING_OF_EIGHT.hold(&apart), "{apart}");
    }
    for left in 0..chain.len() {
        let mut chain = chain.clone();
        chain.remove(left);
        let without = draw_on(&display, &told(&chain), DeviceChoice::Cpu);
        let errors = errors_between(&without.images, &pictures[0].images);
        println!("without link {left}: {errors}");
        assert!(!SAME_TO_ROUNDING_OF_EIGHT.hold(&errors), "link {left} does nothing: {errors}");
    }
}
