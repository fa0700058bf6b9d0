//! Interaction played to machines that cast points, against those that cast lattices.

use super::kernels::{ALL, Kernels};
use super::painter::{InSpaceAlone, Levels, Points};
use super::patterns::Patterns;
use super::plan::BORDER;
use super::shots::{Shots, drawn};
use crate::eyes::{Judged, STRIDE, mean_flip};
use crate::{MACHINES_MS, PAGE, PROGRAM, RASTER, scenarios};
use bricks::BrickSource;
use control::{Rule, Weights};
use display_config::Display;
use frontend::tune::{Footage, Lattices, Machine, Painter, Scenario, Score, Scorer, badness, play_painted};
use lightloom_tests::points::{Pattern, Reconstructed, Schedule};
use lightloom_tests::results::Results;
use protocol::ProjectorImage;
use rayon::prelude::*;
use std::sync::Arc;
use std::time::Duration;

/// Points lie at the middles of their pixels, so that the pictures that lattices are taken from serve them too.
const PARTS: u32 = 1;
/// Of the scenarios these: each volume turned, and the cranium's extinction changed.
const PLAYED: [usize; 4] = [0, 2, 4, 5];
const RHO: [f64; 4] = [0.3, 0.5, 0.7, 0.9];
const THETA: [f64; 2] = [0.2, 0.5];
/// Of a picture of one ray a pixel.
const SHARE: f64 = 0.05;
/// Levels 0 to 4.
const DEPTH: u32 = 4;

/// Who plays.
#[derive(Clone, Copy, Debug)]
struct Player {
    casts: Casts,
    rule: Rule,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Casts {
    Lattices { has_past: bool },
    Points,
}

/// What all play with.
struct Stage {
    schedule: Schedule,
    machines: Vec<Machine>,
    players: Vec<(String, Player)>,
}

pub fn compare() -> Result<(), String> {
    let display = Display::load("desk8").map_err(|error| error.to_string())?;
    let mut results = Results::new(PROGRAM, PAGE, "played points");
    let stage = Stage::new(&display)?;
    let (mut names, mut runs) = (Vec::new(), vec![Vec::new(); stage.players.len()]);
    for (_, (scenario, source)) in
        scenarios(&display).into_iter().enumerate().filter(|(at, _)| PLAYED.contains(at))
    {
        let judged = stage.play_scenario(&display, &scenario, &source)?;
        names.extend(
            stage
                .machines
                .iter()
                .map(|machine| format!("{}, {} s", scenario.name, machine.full.as_secs_f64())),
        );
        judged.into_iter().zip(&mut runs).for_each(|(judged, runs)| runs.extend(judged));
        eprintln!("{} is played", scenario.name);
    }
    stage.write(&mut results, &names, &runs);
    results.finish()
}

impl Stage {
    fn new(display: &Display) -> Result<Self, String> {
        // The kernels that are best for stills; the tables about them are that part's.
        let mut unsaid = Results::new(PROGRAM, PAGE, "points");
        let pattern = Patterns::new(&mut unsaid)?.small;
        let shots = Shots::of_all(display, RASTER, PARTS, 1)?;
        let depths: Vec<(&Pattern, u32)> = (0..=DEPTH).map(|depth| (&pattern, depth)).collect();
        let kernels = Kernels::best(&mut unsaid, &shots, RASTER, ALL, &depths);
        let levels = (0..=DEPTH).map(|depth| kernels.level(&pattern, RASTER, PARTS, depth)).collect();
        let schedule = Schedule::new(levels, BORDER);
        let pixels = f64::from(RASTER[0] * RASTER[1]);
        let few = schedule.affordable((SHARE * pixels) as u64) as f64 / schedule.tiles() as f64;
        let machines = MACHINES_MS.map(|ms| Machine { full: Duration::from_millis(ms) }).to_vec();
        Ok(Self { players: players(few), schedule, machines })
    }

    /// All players on all machines, in one scenario.
    fn play_scenario(
        &self,
        display: &Display,
        scenario: &Scenario,
        source: &Arc<dyn BrickSource>,
    ) -> Result<Vec<Vec<Judged>>, String> {
        let footage = drawn(scenario, display, RASTER, source)?;
        let levels = self.levels(&footage);
        let cases: Vec<(Player, Machine)> = self
            .players
            .iter()
            .flat_map(|(_, player)| self.machines.iter().map(|&machine| (*player, machine)))
            .collect();
        let judged: Vec<Judged> = cases
            .par_iter()
            .map(|&(player, machine)| self.judge(&footage, &levels, player, machine))
            .collect();
        Ok(judged.chunks(self.machines.len()).map(<[Judged]>::to_vec).collect())
    }

    /// What the levels show of each instant.
    fn levels(&self, footage: &Footage) -> Vec<Levels> {
        let mut all: Vec<Levels> = Vec::new();
        for instant in 0..footage.len() {
            let is_as_before = instant > 0 && footage.is_same(instant - 1, instant);
            let before = all.last().filter(|_| is_as_before).cloned();
            all.push(before.unwrap_or_else(|| Arc::new(self.reconstructed(footage, instant))));
        }
        all
    }

    fn reconstructed(&self, footage: &Footage, instant: usize) -> Vec<Vec<Reconstructed>> {
        let of = |image: &ProjectorImage| {
            let levels = self.schedule.levels().iter();
            levels.map(|level| level.reconstruct(&level.samples().cast(&image.rgba))).collect()
        };
        footage.pictures(instant).par_iter().map(of).collect()
    }

    fn judge(&self, footage: &Footage, levels: &[Levels], player: Player, machine: Machine) -> Judged {
        let (mut scorer, mut flips, mut count) = (Scorer::new(footage), 0.0, 0);
        let mut painter: Box<dyn Painter> = match player.casts {
            Casts::Lattices { has_past: true } => Box::new(Lattices::new(footage)),
            Casts::Lattices { has_past: false } => Box::new(InSpaceAlone::new(footage)),
            Casts::Points => Box::new(Points { schedule: &self.schedule, levels, shown: Vec::new() }),
        };
        play_painted(footage, &mut *painter, player.rule, machine, &mut |instant, shown| {
            if instant % STRIDE == 0 {
                flips += f64::from(mean_flip(footage, shown, footage.truth(instant)));
                count += 1;
            }
            scorer.see(instant, shown);
        });
        let Score { rms, flicker, .. } = scorer.score();
        Judged { rms, flicker, flip: flips / f64::from(count.max(1)) }
    }

    /// The tables: the points' weights with the least badness, beside all others.
    fn write(&self, results: &mut Results, names: &[String], runs: &[Vec<Judged>]) {
        let measures: [fn(&Judged) -> f64; 3] = [|one| one.rms, |one| one.flip, |one| one.flicker];
        let fixed = self.players.len() - RHO.len() * THETA.len();
        let errors = |rows: &[&Vec<Judged>], of: fn(&Judged) -> f64| -> Vec<Vec<f64>> {
            rows.iter().map(|row| row.iter().map(of).collect()).collect()
        };
        let tried: Vec<&Vec<Judged>> = runs[fixed..].iter().collect();
        let tried = badness(&errors(&tried, measures[0]), |_| true);
        let best = (0..tried.len()).min_by(|&a, &b| tried[a].total_cmp(&tried[b])).unwrap_or(0);
        let shown: Vec<usize> = (0..fixed).chain([fixed + best]).collect();
        let rows: Vec<&Vec<Judged>> = shown.iter().map(|&at| &runs[at]).collect();
        let bad = measures.map(|of| badness(&errors(&rows, of), |_| true));
        results.line("| who casts, by which rule | bad by RMS | by FLIP | by flicker | mean RMS | mean FLIP | least RMS in |");
        results.line("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
        for (place, row) in rows.iter().enumerate() {
            let mean = |of: fn(&Judged) -> f64| row.iter().map(of).sum::<f64>() / row.len() as f64;
            let is_least = |run: &usize| rows.iter().all(|other| row[*run].rms <= other[*run].rms);
            results.line(format!(
                "| {} | {:.3} | {:.3} | {:.3} | {:.2} | {:.4} | {} of {} |",
                self.players[shown[place]].0,
                bad[0][place],
                bad[1][place],
                bad[2][place],
                255.0 * mean(measures[0]),
                mean(measures[1]),
                (0..row.len()).filter(is_least).count(),
                row.len(),
            ));
        }
        results.line("");
        let heads: Vec<&str> = shown.iter().map(|&at| &self.players[at].0[..]).collect();
        results.line(format!("| scenario, a complete picture takes | {} |", heads.join(" | ")));
        results.line(format!("| --- |{}", " ---: |".repeat(heads.len())));
        for (run, name) in names.iter().enumerate() {
            let cell = |row: &&Vec<Judged>| format!("{:.2} / {:.3}", 255.0 * row[run].rms, row[run].flip);
            let cells: Vec<String> = rows.iter().map(cell).collect();
            results.line(format!("| {name} | {} |", cells.join(" | ")));
        }
    }
}

/// Lattices and points by the best weights and by few rays, then points by all weights that are tried. `few` is the share of
/// the points' tiles that cast as many rays.
fn players(few: f64) -> Vec<(String, Player)> {
    let errors = Rule::default();
    let quality = |share| Rule::Quality { share };
    let (with, without) = (Casts::Lattices { has_past: true }, Casts::Lattices { has_past: false });
    let mut players: Vec<(String, Player)> = [
        ("lattices with the past, errors", with, errors),
        ("lattices in space alone, errors", without, errors),
        ("points, errors", Casts::Points, errors),
        ("lattices with the past, 5 % of the rays", with, quality(SHARE)),
        ("lattices in space alone, 5 % of the rays", without, quality(SHARE)),
        ("points, as many rays", Casts::Points, quality(few)),
        ("points, 5 % of their tiles", Casts::Points, quality(SHARE)),
    ]
    .map(|(name, casts, rule)| (name.to_owned(), Player { casts, rule }))
    .into();
    for (rho, theta) in RHO.into_iter().flat_map(|rho| THETA.map(|theta| (rho, theta))) {
        let rule = Rule::Errors(Weights { rho, theta, chi: 0.0 });
        let name = format!("points, errors at ρ = {rho}, ϑ = {theta}, their best");
        players.push((name, Player { casts: Casts::Points, rule }));
    }
    players
}
