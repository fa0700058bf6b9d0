//! The tapes that come with the program: what visitors did, to one volume, played to the same machines as the motions.

use super::{machines, sweeps};
use control::Weights;
use display_config::Display;
use frontend::FrontendError;
use frontend::adapter::{looks_of, meet_volume, open_scene_volume};
use frontend::scene::{QualityPreset, Scene};
use frontend::staging::Piece;
use frontend::tune::{Footage, SHIPPED, Study, TuneReport, open_shipped, recorded};
use lightloom_tests::results::Results;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// Pixels of each projector's picture: the tapes are two and a half times as long as a motion, and every instant is drawn and kept.
const RASTER: [u32; 2] = [80, 60];

/// Plays them; the report of it.
pub fn play(mut results: Results, display: &Display) -> Result<TuneReport, String> {
    let started = Instant::now();
    let footage = footage("procedural:shells@128", display).map_err(|error| error.to_string())?;
    let study = Study { footage, machines: machines() };
    let played = study.run(Weights::default(), &AtomicBool::new(false), &|| {});
    let (stages, best) = played.ok_or("nobody stops it")?;
    let report = TuneReport::new(&study, &stages, best, started.elapsed().as_secs_f64())
        .map_err(|error| error.to_string())?;
    results.line(format!("{}: {}.", report.scenarios.len(), report.scenarios.join("; ")));
    results.line("");
    sweeps(&mut results, &report);
    results.line("");
    results.line(defaults(&report));
    results.finish()?;
    Ok(report)
}

fn footage(name: &str, display: &Display) -> Result<Vec<Footage>, FrontendError> {
    let mut scene = Scene::load(name)?;
    scene.quality = QualityPreset::Draft.quality();
    let (facts, look) = meet_volume(&mut scene)?;
    let source = open_scene_volume(&scene)?;
    let looks = looks_of(&scene, look.as_ref())?;
    let piece = Piece::new(scene, facts, &looks);
    let mut footage = Vec::new();
    for (name, bytes) in SHIPPED {
        let (scenario, _) = recorded(open_shipped(name, bytes)?, name, piece.clone(), display)?;
        let drawn = Footage::draw(&scenario, display, RASTER, &source, &AtomicBool::new(false), &|_| {})?;
        eprintln!("{} is drawn", scenario.name);
        footage.extend(drawn);
    }
    Ok(footage)
}

/// How the default weights do beside the best.
fn defaults(report: &TuneReport) -> String {
    let own = Weights::default();
    let told = |stage: usize, value: f64| {
        let settings = &report.stages[stage].settings;
        let setting = settings.iter().find(|one| one.value == Some(value));
        let rms = setting.map_or(f64::NAN, |one| {
            255.0 * one.scores.iter().map(|score| score.rms).sum::<f64>() / one.scores.len().max(1) as f64
        });
        format!("bad by {:.3}, mean RMS {rms:.2}", setting.map_or(f64::NAN, |one| one.badness))
    };
    // ρ is varied around the default ϑ.
    let (best, theta) = (report.best, own.theta);
    format!(
        "The defaults, ρ = {} and ϑ = {theta}: {}. With ρ = {}: {}.",
        own.rho,
        told(0, own.rho),
        best.rho,
        told(0, best.rho)
    )
}
