//! What a study of frame control found, for programs and for people.

use super::study::PlayedStage;
use super::{Contender, Footage, Machine, RATE_HZ, Score, Stage, Study, play};
use crate::FrontendError;
use crate::report::plot::strip_of_control;
use control::{Rule, Weights};
use renderer::output::Picture;
use serde::Serialize;

/// A setting, and how it went.
#[derive(Clone, Debug, Serialize)]
pub struct SettingReport {
    /// What it is called.
    pub name: String,
    /// The number that is varied.
    pub value: Option<f64>,
    /// How bad it is over all scenarios, by RMS: 0 is the best everywhere.
    pub badness: f64,
    /// The same by flicker.
    pub badness_by_flicker: f64,
    /// Seconds in which rays are cast, over all runs.
    pub busy_s: f64,
    /// Of each scenario on each machine, in their order.
    pub scores: Vec<Score>,
    /// Pictures shown per second, of each.
    pub shown_per_s: Vec<f64>,
}

/// A stage.
#[derive(Clone, Debug, Serialize)]
pub struct StageReport {
    /// Which number is varied.
    pub stage: Stage,
    /// What was tried.
    pub settings: Vec<SettingReport>,
    /// The best of those with a number.
    pub best: usize,
}

/// A study.
#[derive(Debug, Serialize)]
pub struct TuneReport {
    /// This program's version.
    pub version: &'static str,
    /// How it was called.
    pub command_line: Vec<String>,
    /// The display.
    pub display: String,
    /// Pixels of each projector's picture.
    pub raster: [u32; 2],
    /// What was played.
    pub scenarios: Vec<String>,
    /// Seconds that a complete picture takes each machine.
    pub machines_s: Vec<f64>,
    /// The stages.
    pub stages: Vec<StageReport>,
    /// The weights that are best.
    pub best: Weights,
    /// How long it took, seconds.
    pub seconds: f64,
    #[serde(skip)]
    pub(super) charts: Vec<String>,
    #[serde(skip)]
    pub(super) strips: Vec<String>,
    #[serde(skip)]
    pub(super) worst: Vec<Worst>,
}

/// The worst instant of a scenario, as the eye is shown it and as it should be.
#[derive(Clone, Debug)]
pub(super) struct Worst {
    pub name: String,
    pub instant: usize,
    pub rms: f64,
    pub shown: Picture,
    pub truth: Picture,
}

impl TuneReport {
    /// Of a study that has been played.
    ///
    /// # Errors
    /// Footage that does not fit its display.
    pub fn new(
        study: &Study,
        stages: &[PlayedStage],
        best: Weights,
        seconds: f64,
    ) -> Result<Self, FrontendError> {
        let mut charts: Vec<String> = stages.iter().map(super::charts::badness_chart).collect();
        charts.extend(stages.iter().filter(|one| one.stage == Stage::Chi).map(super::charts::work_chart));
        let contender = Contender::Control(Rule::Errors(best));
        let (mut strips, mut worst) = (Vec::new(), Vec::new());
        if let Some(&machine) = study.machines.get(study.machines.len() / 2) {
            for footage in &study.footage {
                let (strip, instant) = watched(footage, contender, machine)?;
                strips.push(strip);
                worst.push(instant);
            }
        }
        let raster = study.footage.first().map_or([0; 2], |footage| {
            let raster = &footage.display().projectors[0].raster;
            [raster.width, raster.height]
        });
        Ok(Self {
            version: env!("CARGO_PKG_VERSION"),
            command_line: std::env::args().collect(),
            display: study.footage.first().map_or_else(String::new, |footage| footage.display().name.clone()),
            raster,
            scenarios: study.footage.iter().map(|footage| footage.name.clone()).collect(),
            machines_s: study.machines.iter().map(|machine| machine.full.as_secs_f64()).collect(),
            stages: stages.iter().map(|played| stage_report(study, played)).collect(),
            best,
            seconds,
            charts,
            strips,
            worst,
        })
    }
}

fn stage_report(study: &Study, played: &PlayedStage) -> StageReport {
    let seconds: Vec<f64> = study.footage.iter().map(|footage| footage.len() as f64 / RATE_HZ).collect();
    let settings = played.settings.iter().enumerate().map(|(place, setting)| {
        let runs = &played.runs[place];
        let length = |run: usize| seconds[run / study.machines.len().max(1)];
        SettingReport {
            name: setting.name.clone(),
            value: setting.value,
            badness: played.badness[0][place],
            badness_by_flicker: played.badness[1][place],
            busy_s: played.busy(place).as_secs_f64(),
            scores: runs.iter().map(|run| run.score).collect(),
            shown_per_s: runs
                .iter()
                .enumerate()
                .map(|(at, run)| f64::from(run.played.shown) / length(at))
                .collect(),
        }
    });
    StageReport { stage: played.stage, settings: settings.collect(), best: played.best }
}

/// A scenario as a strip, and its worst instant.
fn watched(
    footage: &Footage,
    contender: Contender,
    machine: Machine,
) -> Result<(String, Worst), FrontendError> {
    let mut worst: Option<Worst> = None;
    let played = play(footage, contender, machine, &mut |instant, shown| {
        let truth = footage.truth(instant);
        let squares = shown.rgba.iter().zip(&truth.rgba).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>();
        let rms = (squares / shown.rgba.len().max(1) as f64).sqrt();
        if worst.as_ref().is_none_or(|worst| worst.rms < rms) {
            worst = Some(Worst {
                name: footage.name.clone(),
                instant,
                rms,
                shown: shown.clone(),
                truth: truth.clone(),
            });
        }
    });
    let ticks: Vec<_> = played.ticks.iter().map(super::machine::strip_tick).collect();
    let title = format!("{}, complete pictures in {:.2} s", footage.name, machine.full.as_secs_f64());
    let nothing = || FrontendError::Volume(format!("{} has no instant", footage.name));
    Ok((strip_of_control(&title, &ticks).svg(), worst.ok_or_else(nothing)?))
}
