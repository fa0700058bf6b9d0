//! Hard cases: pictures of light, whatever comes, and as near to the reference as each case allows.

use bricks::BrickSource;
use display_config::Display;
use glam::{DAffine3, DQuat, DVec3, UVec3};
use lightloom_tests::closure_volume::{ClosureVolume, bumps};
use lightloom_tests::compare::{self, Limits, TruePixel, errors, truth};
use lightloom_tests::draw::{self, Drawn, With};
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes::{Points, frame, optics, placed};
use needs::tables::TABLE_CELLS;
use optics::{Curve, Light, Mimda, MimdaForm};
use protocol::{FilterChoice, FrameState, ProjectorImage};
use reference::Radiance;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// What default quality keeps in hard cases. Those that it does not keep it in say why, with limits of their own: a fifth above
/// what was measured, as drivers round differently.
const PROMISE: Limits = Limits::of_255(0.1, 1.0, 1.0);
/// One projector from the side and one near the middle.
pub const PROJECTORS: [u32; 2] = [1, 5];

pub struct Case {
    pub name: String,
    pub display: Display,
    pub source: Arc<dyn BrickSource>,
    pub frame: FrameState,
    limits: Limits,
    pub filter: FilterChoice,
    /// Whether rays of the middle column and row may miss the volume or meet it: f32 cannot say.
    pub may_middle_miss: bool,
    /// Whether [Mesa's llvmpipe](Drawn::is_left_by_llvmpipe) cannot draw it: rays of 7e3 steps are whole there, of 1.4e4 are not.
    is_beyond_llvmpipe: bool,
}

/// Odd numbers of pixels, so that one column and one row look straight ahead.
fn display() -> Display {
    Display::load("desk8").unwrap().with_rasters(97, 73)
}

fn source(dims: [u32; 3], value: impl Fn(DVec3) -> f64 + Send + Sync + 'static) -> Arc<dyn BrickSource> {
    Arc::new(ClosureVolume::new(UVec3::from(dims), (0.0, 1.0), value))
}

fn colours() -> Vec<(f64, [f64; 3])> {
    vec![(0.0, [1.0, 0.3, 0.1]), (0.5, [0.2, 0.9, 0.3]), (1.0, [0.3, 0.4, 1.0])]
}

fn soft() -> Points {
    vec![(0.2, 0.0), (0.6, 0.05), (1.0, 0.2)]
}

impl Case {
    fn new(name: &str, source: Arc<dyn BrickSource>, extinction: Points) -> Self {
        let display = display();
        let place = placed(&*source, 0.6 * display.height_m, DQuat::from_rotation_y(0.4));
        let frame =
            frame(&display, place, optics((0.0, 1.0), &extinction, &colours()), Some(Light::default()));
        Self {
            name: name.into(),
            display,
            source,
            frame,
            limits: PROMISE,
            filter: FilterChoice::Auto,
            may_middle_miss: false,
            is_beyond_llvmpipe: false,
        }
    }

    /// The case's own limits.
    fn within(self, rms: f64, p999: f64, max: f64) -> Self {
        Self { limits: Limits::of_255(rms, p999, max), ..self }
    }

    /// Not by the texture unit.
    fn exactly_filtered(self) -> Self {
        Self { filter: FilterChoice::Exact, ..self }
    }

    /// Few pixels, for cases whose rays take long.
    fn few_pixels(self) -> Self {
        Self { display: self.display.with_rasters(49, 37), ..self }
    }

    fn with(mut self, change: impl FnOnce(&mut FrameState)) -> Self {
        change(&mut self.frame);
        self
    }

    /// The volume upright and centred, `size_m` along its longest edge, moved by `shift_voxels`; one viewer straight ahead.
    fn straight_ahead(self, size_m: f64, shift_voxels: DVec3) -> Self {
        let place = placed(&*self.source, size_m, DQuat::IDENTITY) * DAffine3::from_translation(shift_voxels);
        self.with(|f| (f.eta, f.display_from_volume) = (0.0, place))
    }
}

/// Rays along octree faces and edges, through corners and voxel centres, and past them by little.
fn along_axes() -> Vec<Case> {
    let case =
        |name: &str, shift| Case::new(name, source([56, 56, 56], bumps), soft()).straight_ahead(0.27, shift);
    let far_viewer = |mut case: Case| {
        // Rays so nearly parallel that most columns keep to one slice of voxels.
        case.display.observer_in_display.z = 1e4;
        case.with(|f| f.observer_in_display.z = 1e4)
    };
    // The middle ray enters at a corner of the volume, meets eight bricks in one, and leaves by the opposite corner.
    let diagonal = |mut case: Case| {
        let turn = DQuat::from_rotation_arc(DVec3::ONE.normalize(), DVec3::NEG_Z);
        let place = placed(&*case.source, 0.27, turn);
        case.frame.display_from_volume = place;
        case
    };
    // The same look along the volume's other axes, both ways.
    let turned = |name: &str, axis: DVec3, angle: f64| {
        let case = case(name, DVec3::ZERO);
        let place = placed(&*case.source, 0.27, DQuat::from_axis_angle(axis, angle));
        case.with(|f| f.display_from_volume = place)
    };
    vec![
        case("along an octree edge", DVec3::ZERO),
        turned("along an octree edge in x", DVec3::Y, FRAC_PI_2),
        turned("along an octree edge in -x", DVec3::Y, -FRAC_PI_2),
        turned("along an octree edge in y", DVec3::X, FRAC_PI_2),
        turned("along an octree edge in -z", DVec3::Y, PI),
        diagonal(case("through octree corners", DVec3::ZERO)),
        case("beside an octree edge by 1e-6", DVec3::new(1e-6, -1e-6, 0.0)),
        case("along voxel centres", DVec3::splat(0.5)),
        case("grazing a brick by 1e-6", DVec3::new(28.0 - 1e-6, 0.0, 0.0)),
        case("grazing the volume by 1e-3", DVec3::new(-28.0 + 1e-3, 28.0 - 1e-3, 0.0)),
        // The middle column and row run in a face of the volume, 1e-6 voxels within: f32 puts them in or out.
        Case {
            may_middle_miss: true,
            ..case("grazing the volume by 1e-6", DVec3::new(-28.0 + 1e-6, 28.0 - 1e-6, 0.0))
        },
        far_viewer(case("a viewer 10 km away", DVec3::ZERO)),
    ]
}

/// The viewer in and on the volume.
fn inside() -> Vec<Case> {
    let volume = || source([40, 40, 40], bumps);
    let thin = || soft().into_iter().map(|(s, tau)| (s, 0.5 * tau)).collect::<Points>();
    let voxel_m = 3.0 / 40.0;
    let case = |name: &str, z_m: f64, eta: f64| {
        Case::new(name, volume(), thin())
            .straight_ahead(3.0, DVec3::new(0.0, 0.0, z_m / voxel_m))
            .with(|f| f.eta = eta)
    };
    vec![
        case("camera inside", 0.3, 0.0),
        case("camera inside, parallax", 0.3, 1.0),
        case("camera on the front face", 1.2 - 1.5, 0.0),
        case("camera on the back face", 1.2 + 1.5, 0.0),
        case("camera at a voxel centre", 1.2 - 0.5 * voxel_m, 1.0),
    ]
}

fn small_volumes() -> Vec<Case> {
    let dense = || vec![(0.0, 0.3), (1.0, 2.0)];
    [
        ([1, 1, 1], 0.2),
        ([1, 1, 100], 0.3),
        ([100, 1, 1], 0.3),
        ([57, 28, 3], 0.3),
        ([28, 28, 28], 0.2),
        ([29, 29, 29], 0.2),
    ]
    .into_iter()
    .map(|(dims, size_m)| {
        let case = Case::new(&format!("{dims:?} voxels"), source(dims, bumps), dense());
        let place = placed(&*case.source, size_m, DQuat::from_euler(glam::EulerRot::YXZ, 0.5, 0.4, 0.0));
        case.with(|f| f.display_from_volume = place)
    })
    .collect()
}

/// Extinction nowhere but within a cell of the tables or a hundredth of one, and of every size everywhere.
fn transfer_functions() -> Vec<Case> {
    let cell = 1.0 / TABLE_CELLS as f64;
    let around =
        |peak: f64, width: f64, height: f64| vec![(peak - width, 0.0), (peak, height), (peak + width, 0.0)];
    let spike = |height: f64| around(614.0 * cell, cell, height);
    let narrow = |height: f64| around(614.4 * cell, 0.01 * cell, height);
    let case = |name: String, extinction| Case::new(&name, source([56, 40, 30], bumps), extinction);
    let mut cases = vec![
        case("a spike of 1 per voxel".into(), spike(1.0)).within(0.1, 1.0, 5.0),
        // Opaque skins a hundredth of a voxel thick. Between two samples the kernel takes the scalar as straight; where it turns
        // just short of the spike, or just within, a pixel shows the skin or what lies behind.
        case("a spike of 1e3 per voxel".into(), spike(1e3)).within(0.1, 1.0, 7.0),
        case("a spike of 1e6 per voxel".into(), spike(1e6)).within(0.1, 1.0, 1.0),
    ];
    // The same a hundred times thinner, between two borders of cells: the scalar is known to a hundredth of its width, and
    // to the grid of a texture unit not at all.
    for height in [1e2, 1e4] {
        let narrow = case(format!("a narrow spike of {height:e} per voxel"), narrow(height));
        cases.push(narrow.exactly_filtered().within(0.1, 2.0, 10.0));
    }
    for exponent in [-6, -4, -2, 0, 2, 4, 6] {
        let scale = 10f64.powi(exponent);
        let ramp = vec![(0.3, 0.0), (0.9, scale)];
        cases.push(case(format!("up to 1e{exponent} per voxel"), ramp));
    }
    cases
}

fn other() -> Vec<Case> {
    let plateaus = |p: DVec3| (2.0 * bumps(p) - 0.5).clamp(0.0, 1.0);
    let mimda = |gamma| {
        // Importance that jumps between two samples.
        let importance = Curve::new(vec![(0.6, 0.0), (0.6, 1.0)]).unwrap();
        Some(Mimda { importance, gamma, form: MimdaForm::Consistent })
    };
    // Importance that reaches 1 step by step, and then falls: what lies before is gone altogether.
    let rising = || {
        let importance = Curve::new(vec![(0.3, 0.0), (0.7, 1.0), (0.9, 0.2)]).unwrap();
        Some(Mimda { importance, gamma: 1.0, form: MimdaForm::Consistent })
    };
    let case = |name: &str| Case::new(name, source([56, 40, 30], bumps), soft());
    // All of one length: in thin media those of a tolerance would grow.
    let steps = |name: &str, step_voxels| {
        let even = |f: &mut FrameState| (f.quality.step_voxels, f.quality.tolerance) = (step_voxels, 1.0);
        case(name).with(even).within(0.01, 0.1, 0.1).few_pixels()
    };
    let mut in_viewers_plane = case("projectors in the viewer's plane");
    for projector in &mut in_viewers_plane.display.projectors {
        projector.centre_in_display = DVec3::new(0.1 * projector.centre_in_display.x, 0.0, 1.2);
    }
    vec![
        Case::new("bricks constant in parts", source([84, 56, 40], plateaus), soft()),
        Case::new("a constant volume, lit", source([40, 40, 40], |_| 0.5), soft()),
        case("eta 0").with(|f| f.eta = 0.0),
        case("eta 0.5").with(|f| f.eta = 0.5),
        in_viewers_plane,
        // On the outline of the jump a pixel loses what lies before it or nothing.
        case("importance that jumps").with(|f| f.optics.mimda = mimda(0.8)).within(0.1, 1.0, 3.7),
        case("importance that jumps, gamma 1").with(|f| f.optics.mimda = mimda(1.0)).within(0.1, 1.8, 5.2),
        // Where the ray turns below the peak, between two samples, the kernel keeps a little of what the truth erases, and
        // where it meets the peak once more it erases that.
        case("importance that rises to 1, gamma 1")
            .with(|f| f.optics.mimda = rising())
            .within(0.16, 2.8, 4.7),
        steps("7e3 steps", 1e-2),
        Case { is_beyond_llvmpipe: true, ..steps("3e4 steps", 2.4e-3) },
        Case { is_beyond_llvmpipe: true, ..steps("1e5 steps", 7e-4) },
        case("never ending early").with(|f| f.quality.termination = 0.0),
    ]
}

/// All of them.
pub fn all() -> Vec<Case> {
    [along_axes(), inside(), small_volumes(), transfer_functions(), other()].into_iter().flatten().collect()
}

pub fn assert_is_light(name: &str, images: &[ProjectorImage]) {
    let worst = images.iter().flat_map(|image| &image.rgba).find(|n| !(n.is_finite() && **n >= 0.0));
    assert!(worst.is_none(), "{name}: {worst:?} is no light");
}

/// The truth, but for rays of the middle column and row that met nothing at all: for those it is that.
pub fn as_met(images: &[ProjectorImage], truth: &[TruePixel]) -> Vec<TruePixel> {
    let met_nothing = |pixel: &TruePixel| {
        let image = images.iter().find(|image| image.projector == pixel.projector);
        image.is_some_and(|image| {
            let at = 4 * (pixel.y * image.width + pixel.x) as usize;
            image.rgba[at..at + 4] == [0.0; 4]
        })
    };
    let seen = |pixel: &TruePixel| match (pixel.x == 48 || pixel.y == 36) && met_nothing(pixel) {
        true => TruePixel { truth: Radiance::NOTHING, ..*pixel },
        false => *pixel,
    };
    truth.iter().map(seen).collect()
}

/// The pictures with every other column dark.
pub fn half_dark(images: &[ProjectorImage]) -> Vec<ProjectorImage> {
    let mut images = images.to_vec();
    for image in &mut images {
        let row = 4 * image.width as usize;
        let pixels = image.rgba.chunks_exact_mut(row).flat_map(|row| row.chunks_exact_mut(4).step_by(2));
        pixels.for_each(|pixel| pixel.fill(0.0));
    }
    images
}

fn check(part: &'static str, cases: Vec<Case>) {
    let _turn = draw::turn();
    let mut failed = Vec::new();
    let mut results = Results::new(Program::Tests("accuracy"), "accuracy", part);
    results.line("| case | device | pixels lit | RMS, 99.9 %, largest error of 255 | their limits |");
    results.line("| --- | --- | ---: | ---: | ---: |");
    for case in cases {
        let Case { name, limits, .. } = &case;
        let truth = truth(&case.display, &case.frame, &case.source, &PROJECTORS, 1);
        for device in draw::devices() {
            let with = With { filter: case.filter, ..With::device(device) };
            let drawn = draw::draw(&case.display, &case.frame, &case.source, &PROJECTORS, with);
            results.drawn_by(&drawn.info.adapter);
            let Drawn { images, report, .. } = &drawn;
            assert_is_light(name, images);
            if case.is_beyond_llvmpipe && drawn.info.adapter.contains("llvmpipe") {
                assert!(drawn.is_left_by_llvmpipe(), "{name}: {report:?}");
                results.line(format!("| {name} | {device:?} | | {} | |", report.shortfall));
                continue;
            }
            assert!(report.complete, "{name}, {device:?}: {}", report.shortfall);
            let truth = if case.may_middle_miss { as_met(images, &truth) } else { truth.clone() };
            let errors = errors(images, &truth);
            let of_255 = |numbers: [f64; 3]| numbers.map(|number| 255.0 * number);
            let [rms, p999, max] = of_255([errors.rms, errors.p999, errors.max]);
            let [most_rms, most_p999, most] = of_255([limits.rms, limits.p999, limits.max]);
            results.line(format!(
                "| {name} | {device:?} | {} | {rms:.3}, {p999:.2}, {max:.2} | {most_rms:.2}, {most_p999:.1}, {most:.0} |",
                errors.lit
            ));
            if !limits.hold(&errors) {
                failed.push(format!("{name}, {device:?}: {errors}"));
            }
            // The canary: half of the columns dark.
            let is_lit = errors.lit > 500;
            if is_lit && limits.hold(&compare::errors(&half_dark(images), &truth)) {
                failed.push(format!("{name}, {device:?}: half a picture passes"));
            }
        }
    }
    results.finish().unwrap();
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn rays_along_axes() {
    check("hard cases by rays: along axes", along_axes());
}

#[test]
fn viewers_inside() {
    check("hard cases by rays: viewers inside", inside());
}

#[test]
fn small_and_flat_volumes() {
    check("hard cases by rays: small and flat volumes", small_volumes());
}

#[test]
fn extreme_transfer_functions() {
    check("hard cases by rays: extreme transfer functions", transfer_functions());
}

#[test]
fn other_cases() {
    check("hard cases by rays: others", other());
}
