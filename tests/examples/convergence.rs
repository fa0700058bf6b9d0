//! How the error falls with the step, where steps have one length: a table, and a plot for each kind of scene.
//!
//! ```text
//! cargo run --release -p lightloom-tests --example convergence -- [-o DIR]
//! ```
//!
//! Smooth fields of 64³ voxels, sampled and then seen as stored: plain, shaded, and with both forms of MImDA. The steps are
//! those of the twin (tolerance ∞, finest level, no early end), in f32 as the CPU device takes them, and in f64, so that
//! rounding does not hide the order. The published form of MImDA depends on the step: it is compared with the limit that it
//! creeps toward, and with the reference over the same steps.

use bricks::BrickSource;
use display_config::Display;
use frontend::report::plot::{Chart, Mark, Point, Series, Stroke};
use glam::{DQuat, DVec3, UVec3};
use lightloom_tests::closure_volume::ClosureVolume;
use lightloom_tests::compare::lod_rule;
use lightloom_tests::results::{self, Program, Results};
use lightloom_tests::scenes::{frame, optics, placed};
use lightloom_tests::twin_scene::{TwinScene, View, view};
use optics::{Curve, Light, Mimda, MimdaForm, Quality};
use protocol::FrameState;
use rayon::prelude::*;
use reference::{Errors, Field, Integrator, Radiance, Ray, Reference, Segmentation};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use twin::Real;
use twin_f64::Precision;

/// Step lengths, voxels: halved from the length of the shortest wave's bend down to where f32 rounding takes over.
const STEPS_VOXELS: [f64; 9] = [4.0, 2.0, 1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125, 0.015_625];
/// The order is measured between these: below the bend of trilinear cells, above the rounding of the tables, which hold
/// f32 whatever the twin computes in.
const ORDER_BETWEEN: (f64, f64) = (0.5, 0.0625);
/// Well below any error of the table.
const TOLERANCE: f64 = 1e-11;
/// Pixels between those compared.
const STRIDE: usize = 8;
/// Near the middle.
const PROJECTOR: u32 = 4;
/// One brick: a ray's steps are then equal from end to end, and the reference can take the same ones.
const ONE_BRICK: u32 = 28;

/// A scene, and what of it is measured.
struct Case {
    name: &'static str,
    source: Arc<dyn BrickSource>,
    frame: FrameState,
}

/// A field without edges, and transfer functions without corners where its values lie.
fn source(edge: u32) -> Arc<dyn BrickSource> {
    let scale = 64.0 / f64::from(edge);
    let waves = move |p: DVec3| {
        let p = p * scale;
        0.5 + 0.3 * (0.14 * p.x).sin() * (0.11 * p.y).cos() * (0.09 * p.z + 1.0).sin()
    };
    Arc::new(ClosureVolume::new(UVec3::splat(edge), (0.0, 1.0), waves))
}

fn case(display: &Display, name: &'static str, light: Option<Light>, form: Option<MimdaForm>) -> Case {
    let source = source(if form.is_some() { ONE_BRICK } else { 64 });
    let mut optics = optics(
        (0.0, 1.0),
        &vec![(0.0, 0.0), (1.0, 0.1)],
        &vec![(0.0, [0.9, 0.2, 0.1]), (1.0, [0.1, 0.6, 0.9])],
    );
    optics.mimda = form.map(|form| Mimda {
        importance: Curve::new(vec![(0.0, 0.0), (1.0, 1.0)]).expect("rising points make a curve"),
        gamma: 0.8,
        form,
    });
    let place = placed(&*source, 0.6 * display.height_m, DQuat::from_rotation_y(0.4));
    let mut frame = frame(display, place, optics, light);
    frame.quality = Quality {
        tolerance: f64::INFINITY,
        termination: 0.0,
        lod_scale: 0.0,
        step_voxels: STEPS_VOXELS[0],
        quadrilinear: false,
        blended: false,
        deviation: false,
    };
    Case { name, source, frame }
}

/// Pixels that are compared.
fn pixels(display: &Display) -> Vec<(u32, u32)> {
    let raster = &display.projectors[PROJECTOR as usize].raster;
    let along = |n: u32| (STRIDE as u32 / 2..n).step_by(STRIDE);
    along(raster.height).flat_map(|y| along(raster.width).map(move |x| (x, y))).collect()
}

/// What the reference sees at all pixels, by `see`.
fn truth(display: &Display, case: &Case, see: impl Fn(&Reference, &Ray) -> Radiance + Sync) -> Vec<[f64; 4]> {
    let Case { source, frame, .. } = case;
    let integrator = Integrator { tolerance: TOLERANCE, ..Integrator::default() };
    let reference = Reference::new(Arc::clone(source), frame, &lod_rule(display, frame), integrator)
        .expect("the scene has a reference");
    let law = display
        .beam_law(PROJECTOR as usize, frame.observer_in_display, frame.eta)
        .expect("the display's own observer goes with it");
    let one = |&(x, y): &(u32, u32)| {
        let ray = law.ray(display.pixel_on_screen(PROJECTOR as usize, x, y));
        let seen = see(&reference, &Ray::new(ray.origin_in_display, ray.direction_in_display));
        let [r, g, b] = seen.rgb.to_array();
        [r, g, b, seen.opacity]
    };
    pixels(display).par_iter().map(one).collect()
}

fn limit(reference: &Reference, ray: &Ray) -> Radiance {
    reference.radiance(ray.origin_in_display, ray.direction_in_display).expect("a formula has every brick")
}

/// The published form over the steps that a ray takes through one brick: equal pairs.
fn over_steps(reference: &Reference, ray: &Ray, frame: &FrameState) -> Radiance {
    let line = ray.line(&frame.display_from_volume.inverse());
    let Some((start, end)) = line.clip(reference.field().extent(), (0.0, f64::INFINITY)) else {
        return Radiance::NOTHING;
    };
    let voxels = (end - start) * line.direction.length();
    let pairs = (voxels / (2.0 * frame.quality.step_voxels)).ceil().max(1.0);
    let steps = Segmentation::uniform(start, end, 2 * pairs as u32).expect("a ray's ends rise");
    reference.segmented(ray, &steps).expect("a formula has every brick")
}

/// RMS errors at all step lengths, of 255.
struct Curves {
    name: String,
    errors: Vec<f64>,
}

impl Curves {
    /// The slope between [`ORDER_BETWEEN`]: the power of the step that the error follows.
    fn order(&self) -> f64 {
        let at = |step: f64| {
            let place = STEPS_VOXELS.iter().position(|&s| s == step).expect("a listed step");
            self.errors[place]
        };
        let (long, short) = ORDER_BETWEEN;
        (at(long) / at(short)).ln() / (long / short).ln()
    }
}

/// Errors of the twin in `F` against a truth, which may depend on the step.
fn errors<F: Precision>(
    display: &Display,
    case: &Case,
    name: String,
    round: impl Fn(&View<f64>) -> View<F>,
    truths: &[Vec<[f64; 4]>],
) -> Curves {
    let twin = TwinScene::new(display, &case.frame, &*case.source);
    let pixels = pixels(display);
    let at = |(place, &step_voxels): (usize, &f64)| {
        let quality = Quality { step_voxels, ..case.frame.quality };
        let frame = FrameState { quality, ..case.frame.clone() };
        let view = round(&view(display, PROJECTOR, &frame, &*case.source));
        let found = twin.cast(&view, &pixels).into_iter().map(|rgba| rgba.map(wide));
        let truth = truths[place % truths.len()].iter().copied();
        255.0 * Errors::of(found.zip(truth)).expect("there are pixels").rms
    };
    Curves { name, errors: STEPS_VOXELS.iter().enumerate().map(at).collect() }
}

/// A twin's number without loss.
fn wide<F: Real>(number: F) -> f64 {
    let high = f64::from(number.to_f32());
    high + f64::from((number - F::of(high)).to_f32())
}

/// Both precisions against one truth.
fn both(display: &Display, case: &Case, against: &str, truths: &[Vec<[f64; 4]>]) -> Vec<Curves> {
    let name = |bits: &str| format!("{}{against}, {bits}", case.name);
    vec![
        errors(display, case, name("f32"), View::rounded, truths),
        errors(display, case, name("f64"), Clone::clone, truths),
    ]
}

fn table(results: &mut Results, curves: &[Curves]) {
    let steps: String = STEPS_VOXELS.iter().map(|step| format!(" {step} |")).collect();
    results.line(format!("| RMS of 255 at steps of |{steps} order |"));
    results.line(format!("| --- |{} ---: |", " ---: |".repeat(STEPS_VOXELS.len())));
    for one in curves {
        let errors: String = one.errors.iter().map(|error| format!(" {error:.2e} |")).collect();
        results.line(format!("| {} |{errors} {:.2} |", one.name, one.order()));
    }
    results.line("");
}

fn chart(title: &str, curves: &[Curves]) -> Chart {
    let series = |(place, one): (usize, &Curves)| {
        let point = |(&x, &y): (&f64, &f64)| Point { x, y, title: format!("{x} voxels: {y:.2e}") };
        let is_f32 = one.name.ends_with("f32");
        let points = STEPS_VOXELS.iter().zip(&one.errors).map(point).collect();
        Series::new(format!("{}: {:.1}", one.name, one.order()), points)
            .ramp(place / 2, curves.len().div_ceil(2))
            .mark(if is_f32 { Mark::Square } else { Mark::Dot })
            .stroke(if is_f32 { Stroke::Dashed } else { Stroke::Thin })
    };
    Chart {
        title: title.to_owned(),
        x_label: "step, voxels".to_owned(),
        y_label: "RMS error of linear colour, units of 1/255".to_owned(),
        series: curves.iter().enumerate().map(series).collect(),
    }
}

fn compositing(display: &Display) -> Vec<Curves> {
    let cases = [
        case(display, "plain", None, None),
        case(display, "shaded", Some(Light::default()), None),
        case(display, "consistent MImDA", None, Some(MimdaForm::Consistent)),
    ];
    let curves = cases.iter().flat_map(|case| both(display, case, "", &[truth(display, case, limit)]));
    curves.collect()
}

fn published(display: &Display) -> Vec<Curves> {
    let case = case(display, "published", None, Some(MimdaForm::Paper));
    let same_steps = |&step_voxels: &f64| {
        let quality = Quality { step_voxels, ..case.frame.quality };
        let frame = FrameState { quality, ..case.frame.clone() };
        truth(display, &case, |reference, ray| over_steps(reference, ray, &frame))
    };
    let stepped: Vec<_> = STEPS_VOXELS.iter().map(same_steps).collect();
    let mut curves = both(display, &case, " to its limit", &[truth(display, &case, limit)]);
    curves.extend(both(display, &case, " over its steps", &stepped));
    curves
}

/// The folder for the plots: the one given, or that of the results; None if there is neither.
fn folder() -> Result<Option<PathBuf>, String> {
    match std::env::args().skip(1).collect::<Vec<_>>().as_slice() {
        [] => Ok(results::folder()),
        [flag, folder] if flag == "-o" => Ok(Some(PathBuf::from(folder))),
        _ => Err("give nothing, or -o and a folder for the plots".to_owned()),
    }
}

fn write_chart(folder: &Path, file: &str, chart: &Chart) -> Result<(), String> {
    let path = folder.join(file);
    let write = || {
        std::fs::create_dir_all(folder)?;
        std::fs::write(&path, chart.svg())
    };
    write().map_err(|error: std::io::Error| format!("{}: {error}", path.display()))
}

fn main() -> Result<(), String> {
    let out = folder()?;
    let display = Display::load("desk8").map_err(|error| error.to_string())?;
    let mut results = Results::new(Program::Study("convergence"), "convergence", "convergence");
    for (file, title, curves) in [
        ("convergence.svg", "Error against step length (and its order)", compositing(&display)),
        ("convergence-mimda.svg", "MImDA as published (and its order)", published(&display)),
    ] {
        table(&mut results, &curves);
        if let Some(folder) = &out {
            write_chart(folder, file, &chart(title, &curves))?;
        }
    }
    results.finish()
}
