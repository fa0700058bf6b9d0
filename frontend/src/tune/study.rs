//! All settings on all scenarios and machines: stage after stage, each around the best of the one before.

use super::{Footage, Machine, Played, Score, Scorer, Setting, Stage, badness, play};
use super::{stage_of_chi, stage_of_rho, stage_of_theta};
use control::Weights;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// In the order in which they are played.
const STAGES: [Stage; 3] = [Stage::Rho, Stage::Theta, Stage::Chi];

/// What a stage tries around some weights.
fn settings_of(stage: Stage, around: Weights) -> Vec<Setting> {
    match stage {
        Stage::Rho => stage_of_rho(around),
        Stage::Theta => stage_of_theta(around),
        Stage::Chi => stage_of_chi(around),
    }
}

/// How a setting went on one scenario and one machine.
#[derive(Clone, Debug)]
pub struct Run {
    /// What the eye saw of it.
    pub score: Score,
    /// What happened.
    pub played: Played,
}

/// A stage that has been played.
#[derive(Clone, Debug)]
pub struct PlayedStage {
    /// Which number is varied.
    pub stage: Stage,
    /// What was tried.
    pub settings: Vec<Setting>,
    /// Of each setting: a run for each scenario on each machine, scenario by scenario.
    pub runs: Vec<Vec<Run>>,
    /// Of each setting, by RMS and by flicker: see [`badness`].
    pub badness: [Vec<f64>; 2],
    /// The setting that is best by RMS, of those with a number.
    pub best: usize,
}

/// What is played: scenarios, on machines.
pub struct Study {
    /// The scenarios.
    pub footage: Vec<Footage>,
    /// The machines.
    pub machines: Vec<Machine>,
}

impl Study {
    /// Plays all stages, from some weights on; the stages, and the best weights. `shown` is told how many runs are done. None
    /// if `stop` is set meanwhile.
    pub fn run(
        &self,
        from: Weights,
        stop: &AtomicBool,
        shown: &(dyn Fn() + Sync),
    ) -> Option<(Vec<PlayedStage>, Weights)> {
        let mut best = from;
        let mut stages = Vec::new();
        for stage in STAGES {
            let settings = settings_of(stage, best);
            let played = self.play_stage(stage, settings, stop, shown)?;
            let value = played.settings[played.best].value.unwrap_or_default();
            match stage {
                Stage::Rho => best.rho = value,
                Stage::Theta => best.theta = value,
                // How much an idle back-end saves is a matter of taste: see the page.
                Stage::Chi => {}
            }
            stages.push(played);
        }
        Some((stages, best))
    }

    /// Runs of all stages.
    pub fn runs(&self) -> usize {
        let settings = STAGES.map(|stage| settings_of(stage, Weights::default()).len());
        settings.iter().sum::<usize>() * self.runs_per_setting()
    }

    /// Runs of a setting: each scenario on each machine.
    pub fn runs_per_setting(&self) -> usize {
        self.footage.len() * self.machines.len()
    }

    fn play_stage(
        &self,
        stage: Stage,
        settings: Vec<Setting>,
        stop: &AtomicBool,
        shown: &(dyn Fn() + Sync),
    ) -> Option<PlayedStage> {
        let cases: Vec<(usize, &Footage, Machine)> = (0..settings.len())
            .flat_map(|setting| self.footage.iter().map(move |footage| (setting, footage)))
            .flat_map(|(setting, footage)| {
                self.machines.iter().map(move |&machine| (setting, footage, machine))
            })
            .collect();
        let played: Option<Vec<Run>> = cases
            .par_iter()
            .map(|&(setting, footage, machine)| {
                if stop.load(Ordering::SeqCst) {
                    return None;
                }
                let mut scorer = Scorer::new(footage);
                let contender = settings[setting].contender;
                let played =
                    play(footage, contender, machine, &mut |instant, seen| scorer.see(instant, seen));
                shown();
                Some(Run { score: scorer.score(), played })
            })
            .collect();
        let runs = played?;
        let runs: Vec<Vec<Run>> = runs.chunks(self.runs_per_setting()).map(<[Run]>::to_vec).collect();
        let errors_by = |of: fn(&Score) -> f64| -> Vec<Vec<f64>> {
            runs.iter().map(|row| row.iter().map(|run| of(&run.score)).collect()).collect()
        };
        let competes = |setting: usize| settings[setting].contender != super::Contender::Quincunx;
        let by_rms = badness(&errors_by(|score| score.rms), competes);
        let by_flicker = badness(&errors_by(|score| score.flicker), competes);
        let numbered = (0..settings.len()).filter(|&setting| settings[setting].value.is_some());
        let best = numbered.min_by(|&a, &b| by_rms[a].total_cmp(&by_rms[b])).unwrap_or(0);
        Some(PlayedStage { stage, settings, runs, badness: [by_rms, by_flicker], best })
    }
}

impl PlayedStage {
    /// Core-seconds of a setting, over all runs, if a machine has one core.
    pub fn busy(&self, setting: usize) -> Duration {
        self.runs[setting].iter().map(|run| run.played.busy).sum()
    }
}
