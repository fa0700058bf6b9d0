//! Nodes that blend into their parents: kernel, twin and reference tell one picture, without borders.

use bricks::NodeKey;
use bricks::is_shown;
use display_config::Display;
use glam::DVec3;
use layout::{FULL_WEIGHTS, NO_SLOT, NodeRecord};
use lightloom_tests::blending_scenes::{self, LOOKS, is_split, presented};
use lightloom_tests::compare::{Errors, Limits, errors_of, lod_rule};
use lightloom_tests::draw;
use lightloom_tests::presented::{Presented, picture};
use lightloom_tests::scenes::TestScene;
use lightloom_tests::twin_scene::{TwinScene, View, view};
use protocol::FrameState;
use rayon::prelude::*;
use reference::{Field, Integrator, Ray, StoredField, Tracer};
use renderer::device::{CpuDevice, Device};
use std::sync::Arc;
use twin::composite::Over;
use twin::kernel::Full;
use twin::levels::Brick;
use twin::refine::Voxel;
use twin::shade::Plain;
use twin::vector::Vec3;
use twin::{Casting, FeedbackCell, ProjectorRays, Real, ray};

const PROJECTOR: u32 = 5;
/// Pixels between those compared with the reference, whose rays take long where levels blend.
const STRIDE: u32 = 4;
/// What default quality keeps on every scene.
const KEPT: Limits = Limits::of_255(0.15, 1.5, 1.5);
/// The same where light bends: a quarter above the most that was measured.
const KEPT_WHERE_LIGHT_BENDS: Limits = Limits::of_255(0.063, 1.65, 1.65);
/// f32 against f64, and kernel against twin: as in the comparisons of these without blending.
const ROUNDING: Limits = Limits::of_255(0.005, 0.05, 1.5);
/// f64, in numbers of order one.
const F64: f64 = 1e-9;

fn kept(scene: &TestScene) -> Limits {
    match scene.name {
        "refraction" => KEPT_WHERE_LIGHT_BENDS,
        _ => KEPT,
    }
}

/// A wrong reading of a node's weights.
type Spoil = fn([u32; 2]) -> [u32; 2];

type Plainest = Full<Plain, Over<false>>;

fn display() -> Display {
    Display::load("desk8").unwrap().with_rasters(97, 73)
}

/// Fewer pixels, for kernels: a GPU's driver may run on the processor.
fn small_display() -> Display {
    Display::load("desk8").unwrap().with_rasters(49, 37)
}

fn looks(scene: &TestScene) -> impl Iterator<Item = TestScene> {
    LOOKS.into_iter().map(|(name, change)| {
        let mut scene = TestScene { name, ..scene.clone() };
        change(&mut scene.frame);
        scene
    })
}

fn pixels(display: &Display, stride: u32) -> Vec<(u32, u32)> {
    let raster = &display.projectors[PROJECTOR as usize].raster;
    let along = |n: u32| (stride / 2..n).step_by(stride as usize);
    along(raster.height).flat_map(|y| along(raster.width).map(move |x| (x, y))).collect()
}

fn numbers<F: Real>(rgba: &[[F; 4]]) -> Vec<[f64; 4]> {
    rgba.iter().map(|rgba| rgba.map(|n| f64::from(n.to_f32()))).collect()
}

fn between(found: &[[f64; 4]], expected: &[[f64; 4]]) -> Errors {
    assert_eq!(found.len(), expected.len());
    errors_of(found.iter().copied().zip(expected.iter().copied()))
}

/// The reference's field of a cut, filtered where the frame asks for it.
fn field(display: &Display, frame: &FrameState, cut: &Presented) -> StoredField {
    let field = cut.field(frame);
    if frame.quality.quadrilinear { field.filtered(&lod_rule(display, frame)) } else { field }
}

fn truth(display: &Display, frame: &FrameState, field: &StoredField, stride: u32) -> Vec<[f64; 4]> {
    let tracer = Tracer::new(frame, Integrator { tolerance: 1e-4, ..Integrator::default() }).unwrap();
    let law = display.beam_law(PROJECTOR as usize, frame.observer_in_display, frame.eta).unwrap();
    let see = |(x, y)| {
        let ray = law.ray(display.pixel_on_screen(PROJECTOR as usize, x, y));
        let ray = Ray::new(ray.origin_in_display, ray.direction_in_display);
        let seen = tracer.radiance_on(field, &ray).unwrap();
        assert!(seen.reached, "the reference missed its own tolerance at {x}, {y}");
        [seen.rgb.x, seen.rgb.y, seen.rgb.z, seen.opacity]
    };
    pixels(display, stride).into_par_iter().map(see).collect()
}

/// The twin's picture at f32.
fn twin_sees(display: &Display, scene: &TestScene, twin: &TwinScene, stride: u32) -> Vec<[f64; 4]> {
    let view = view(display, PROJECTOR, &scene.frame, &*scene.source).rounded();
    numbers(&twin.cast(&view, &pixels(display, stride)))
}

fn with_weights(twin: &TwinScene, change: impl Fn([u32; 2]) -> [u32; 2]) -> TwinScene {
    let mut twin = twin.clone();
    twin.nodes.iter_mut().for_each(|node| node.weights = change(node.weights));
    twin
}

#[test]
fn twin_and_reference_tell_the_same_picture() {
    let _turn = draw::turn();
    let display = display();
    for scene in looks(&blending_scenes::busy(&display)) {
        let cut = presented(&scene);
        let twin = cut.scene(&display, &scene.frame);
        let truth = truth(&display, &scene.frame, &field(&display, &scene.frame, &cut), STRIDE);
        let seen = twin_sees(&display, &scene, &twin, STRIDE);
        let errors = between(&seen, &truth);
        println!("{:20} twin against reference: {errors}", scene.name);
        let kept = kept(&scene);
        assert!(kept.hold(&errors), "{}: {errors}", scene.name);
        let exact = view(&display, PROJECTOR, &scene.frame, &*scene.source);
        let errors = between(&seen, &numbers(&twin.cast(&exact, &pixels(&display, STRIDE))));
        println!("{:20} f32 against f64: {errors}", "");
        assert!(ROUNDING.hold(&errors), "{}: {errors}", scene.name);
        let spoils: [(&str, Spoil); 2] =
            [("no blending", |_| FULL_WEIGHTS), ("corners in another order", |[a, b]| [b.reverse_bits(), a])];
        for (what, spoil) in spoils {
            let errors = between(&twin_sees(&display, &scene, &with_weights(&twin, spoil), STRIDE), &truth);
            println!("{:20} {what}: {errors}", "");
            assert!(!kept.hold(&errors), "{}: {what} passes", scene.name);
        }
    }
}

fn devices(slots: u32) -> Vec<Device> {
    let mut all = vec![Device::Cpu(Box::new(CpuDevice::new(slots, false)))];
    #[cfg(feature = "gpu")]
    if draw::has_gpu() {
        use protocol::{AdapterWish, DeviceChoice, FilterChoice};
        use renderer::device::{CacheWish, open_device};
        let (gpu, exact) = (DeviceChoice::Gpu, FilterChoice::Exact);
        let cache = CacheWish { bytes: 1 << 30, slots_needed: slots.into(), has_deviations: false };
        all.push(open_device(gpu, &AdapterWish::default(), exact, &cache).unwrap().device);
    }
    all
}

fn colours(rgba: &[f32]) -> Vec<[f64; 4]> {
    rgba.as_chunks::<4>().0.iter().map(|rgba| rgba.map(f64::from)).collect()
}

#[test]
fn kernel_and_twin_tell_the_same_picture() {
    let _turn = draw::turn();
    let display = small_display();
    let scene = blending_scenes::busy(&display);
    let mut devices = devices(presented(&scene).scene(&display, &scene.frame).slots());
    for scene in looks(&scene) {
        let twin = presented(&scene).scene(&display, &scene.frame).with_visible_cells();
        let unblended = with_weights(&twin, |_| FULL_WEIGHTS);
        let view = view(&display, PROJECTOR, &scene.frame, &*scene.source).rounded();
        let draw = |device: &mut Device, twin: &TwinScene| {
            twin.load(device);
            picture(device, twin.needs, &view)
        };
        let Some((cpu, [gpu])) = devices.split_first_mut() else { return };
        let (expected, samples) = draw(cpu, &twin);
        let (found, samples_found) = draw(gpu, &twin);
        let errors = between(&colours(&found), &colours(&expected));
        println!("{:20} {errors}; {samples_found} samples, {samples} of the twin", scene.name);
        assert!(ROUNDING.hold(&errors), "{}: {errors}", scene.name);
        let (spoilt, _) = draw(gpu, &unblended);
        assert!(!ROUNDING.hold(&between(&colours(&spoilt), &colours(&expected))), "no blending passes");
    }
}

#[test]
fn full_weights_are_no_blending_to_the_bit() {
    let _turn = draw::turn();
    let display = small_display();
    let scene = blending_scenes::busy(&display);
    let mut devices = devices(presented(&scene).scene(&display, &scene.frame).slots());
    for scene in looks(&scene) {
        let cut = Presented::new(Arc::clone(&scene.source), is_split, |_| 1.0);
        let mut twin = cut.scene(&display, &scene.frame);
        assert!(twin.nodes.iter().all(|node| node.weights == FULL_WEIGHTS || node.slot == NO_SLOT));
        let view = view(&display, PROJECTOR, &scene.frame, &*scene.source).rounded();
        for device in &mut devices {
            let mut draw = |twin: &TwinScene, blends: bool| {
                twin.load(device);
                picture(device, needs::Needs { blends, ..twin.needs }, &view)
            };
            let (blended, plain) = (draw(&twin, true), draw(&twin, false));
            assert!(blended == plain, "{}: {} and {} samples", scene.name, blended.1, plain.1);
            let untouched = twin.nodes.clone();
            twin.nodes.iter_mut().for_each(|node| node.weights[1] -= 1 << 24);
            assert!(draw(&twin, true) != plain, "{}: weights are not looked at", scene.name);
            twin.nodes = untouched;
        }
    }
}

#[test]
fn weights_of_zero_are_the_parents_picture() {
    let _turn = draw::turn();
    let display = display();
    for scene in looks(&blending_scenes::busy(&display)) {
        // Two levels up are others for the parent than for the node.
        if scene.name.contains("quadrilinear") || scene.name.contains("unsharp") {
            continue;
        }
        let cut = |depth: u8, share: f64| {
            Presented::new(Arc::clone(&scene.source), move |key| key.depth < depth, move |_| share)
        };
        let (fine, coarse) = (cut(2, 0.0), cut(1, 1.0));
        let point = DVec3::new(33.3, 71.7, 29.1);
        let [a, b] = [&fine, &coarse].map(|cut| cut.field(&scene.frame).sample(point, &|_, _| true).unwrap());
        assert!((a.0 - b.0).abs() < F64 && (a.1 - b.1).length() < F64, "{a:?} {b:?}");
        let seen = [&fine, &coarse, &cut(2, 1.0)]
            .map(|cut| twin_sees(&display, &scene, &cut.scene(&display, &scene.frame), STRIDE));
        let errors = between(&seen[0], &seen[1]);
        println!("{:20} {errors}", scene.name);
        let kept = kept(&scene);
        assert!(kept.hold(&errors), "{}: {errors}", scene.name);
        assert!(!kept.hold(&between(&seen[2], &seen[1])), "{}: the nodes' own samples pass", scene.name);
    }
}

/// What a node shows at a point of its border, and how long steps are there, by the f64 twin; and by the reference, just
/// within.
fn on_border(
    casting: &Casting<f64>,
    rays: &ProjectorRays<f64>,
    node: &NodeRecord,
    (point, direction): (DVec3, DVec3),
) -> [f64; 2] {
    let [origin, along] = [point, direction].map(|v| Vec3(v.to_array()));
    let ray = ray::Ray::of_pixel(casting.scene, rays, 0.5, 0.5);
    let inverse = direction.to_array().map(|d| if d == 0.0 { 1e30 } else { 1.0 / d });
    let ray = ray::Ray {
        origin_in_volume: origin,
        direction_in_volume: along,
        inverse: Vec3(inverse),
        speed: direction.length(),
        ..ray
    };
    let brick = Brick::new::<Plainest>(casting, node, &ray);
    let step = Voxel::new(casting, node, &ray).longest_step::<Plainest>(casting, &brick, &ray, 0.0);
    [brick.scalar_at::<Plainest>(casting, &ray, 0.0), step]
}

/// The largest jumps of value, of step length (as a ratio) and of the reference's value over the faces between leaves.
fn jumps(display: &Display, scene: &TestScene, cut: &Presented) -> [f64; 3] {
    let twin = cut.scene(display, &scene.frame);
    let view = view(display, PROJECTOR, &scene.frame, &*scene.source);
    let feedback: Vec<FeedbackCell> = twin.nodes.iter().map(|_| FeedbackCell::default()).collect();
    let View { scene: numbers, rays } = &view;
    let seen = twin.casting(numbers, &feedback);
    let field = cut.field(&scene.frame);
    let finest = scene.source.shape().finest_depth();
    let mut most = [0.0_f64; 3];
    for (key, _) in cut.leaves() {
        let edge = 28.0 * f64::from(1u32 << (finest - key.depth));
        let low = key.cell.as_dvec3() * edge;
        for axis in 0..3 {
            for (u, v) in [(0.13, 0.71), (0.5, 0.5), (0.02, 0.97), (1.0, 0.4)] {
                let mut point = low + edge * DVec3::splat(1.0);
                point[(axis + 1) % 3] = low[(axis + 1) % 3] + u * edge - 1e-9;
                point[(axis + 2) % 3] = low[(axis + 2) % 3] + v * edge;
                if point[axis] >= 112.0 {
                    continue;
                }
                let across = DVec3::from_array(std::array::from_fn(|i| f64::from(u8::from(i == axis))));
                let ray = ray::Ray {
                    direction_in_volume: Vec3(across.to_array()),
                    ..ray::Ray::of_pixel(numbers, rays, 0.5, 0.5)
                };
                let sides = [-1e-9, 1e-9].map(|shift| {
                    let at = Vec3((point + shift * across).to_array());
                    on_border(&seen, rays, &twin.nodes[seen.leaf_at(at, &ray) as usize], (point, across))
                });
                let [below, above] = [-1e-9, 1e-9].map(|shift| field.value(point + shift * across).unwrap());
                most[0] = most[0].max((sides[0][0] - sides[1][0]).abs());
                most[1] = most[1].max((sides[0][1] / sides[1][1]).ln().abs());
                most[2] = most[2].max((below - above).abs());
            }
        }
    }
    most
}

#[test]
fn neither_values_nor_steps_jump_between_levels() {
    let display = display();
    let scene = blending_scenes::busy(&display);
    let smooth = jumps(&display, &scene, &presented(&scene));
    let jumpy = jumps(&display, &scene, &Presented::new(Arc::clone(&scene.source), is_split, |_| 1.0));
    println!("with weights {smooth:?}, without {jumpy:?}");
    // Of points 1e-9 voxels apart.
    assert!(smooth.iter().all(|&jump| jump < 1e-7), "{smooth:?}");
    assert!(jumpy[0] > 0.02 && jumpy[1] > 0.6 && jumpy[2] > 0.02, "{jumpy:?}");
}

#[test]
fn nodes_that_show_nothing_blend_as_the_middle_of_their_values() {
    let _turn = draw::turn();
    let display = display();
    let scene = blending_scenes::half_hidden(&display);
    let cut = presented(&scene);
    let is_hidden = |key: NodeKey| !is_shown(&scene.frame.optics, scene.source.summary(key));
    let hidden = cut.leaves().filter(|&(key, weights)| is_hidden(key) && weights != [1.0; 8]).count();
    assert!(hidden > 1, "the scene has {hidden} such nodes");
    let twin = cut.scene(&display, &scene.frame);
    let truth = truth(&display, &scene.frame, &cut.field(&scene.frame), 2);
    for (what, twin) in [("all cells", twin.clone()), ("visible cells", twin.clone().with_visible_cells())] {
        let errors = between(&twin_sees(&display, &scene, &twin, 2), &truth);
        println!("{what:20} {errors}");
        assert!(KEPT.hold(&errors), "{what}: {errors}");
    }
    let mut blind = twin;
    blind.nodes.iter_mut().filter(|node| node.scale == 0.0).for_each(|node| node.slot = NO_SLOT);
    let errors = between(&twin_sees(&display, &scene, &blind, 2), &truth);
    println!("{:20} {errors}", "without those nodes");
    assert!(!KEPT.hold(&errors), "they may be left out");
}

#[test]
fn equal_corners_have_equal_weights() {
    let display = display();
    let scene = blending_scenes::busy(&display);
    let mut known = std::collections::HashMap::new();
    for (key, weights) in presented(&scene).leaves() {
        for (i, found) in weights.into_iter().enumerate() {
            let corner = key.cell + glam::UVec3::new(i as u32 & 1, i as u32 >> 1 & 1, i as u32 >> 2);
            assert_eq!(*known.entry((key.depth, corner)).or_insert(found), found);
        }
    }
    assert!(known.values().any(|&w| w == 1.0) && known.values().any(|&w| w > 0.1 && w < 0.9));
}
