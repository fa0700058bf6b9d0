//! The best weights, the fixed rules and reconstruction in time, by what people see when they flip between what was shown and
//! what should have been.

use super::{PAGE, PROGRAM};
use control::{Rule, Weights};
use frontend::tune::{Contender, Footage, Machine, Scorer, Study, badness, play};
use lightloom_tests::results::Results;
use nv_flip::{FlipImageRgb8, FlipPool, flip};
use rayon::prelude::*;
use renderer::output::Picture;
use renderer::present::Finisher;
use std::time::Duration;

/// FLIP is judged at every so many instants.
pub const STRIDE: usize = 4;

/// What a contender errs in one scenario on one machine.
#[derive(Clone, Copy, Debug, Default)]
pub struct Judged {
    pub rms: f64,
    pub flip: f64,
    pub flicker: f64,
}

pub fn compare(study: &Study, best: Weights) -> Result<(), String> {
    let rate = |hz: f64| Contender::Control(Rule::Rate { period: Duration::from_secs_f64(1.0 / hz) });
    let quality = |share: f64| Contender::Control(Rule::Quality { share });
    let contenders = [
        ("errors", Contender::Control(Rule::Errors(best))),
        ("errors, τ along the way", Contender::ControlByPath(Rule::Errors(best))),
        ("10 a second", rate(10.0)),
        ("30 a second", rate(30.0)),
        ("5 % of the rays", quality(0.05)),
        ("20 % of the rays", quality(0.2)),
        ("quincunx", Contender::Quincunx),
    ];
    let cases: Vec<(Contender, &Footage, Machine)> = contenders
        .iter()
        .flat_map(|&(_, contender)| study.footage.iter().map(move |footage| (contender, footage)))
        .flat_map(|(contender, footage)| {
            study.machines.iter().map(move |&machine| (contender, footage, machine))
        })
        .collect();
    let judged: Vec<Judged> =
        cases.par_iter().map(|&(contender, footage, machine)| judge(contender, footage, machine)).collect();
    let rows: Vec<&[Judged]> = judged.chunks(study.runs_per_setting()).collect();
    let mut results = Results::new(PROGRAM, PAGE, "eyes");
    results.line("| contender | bad by RMS | by FLIP | by flicker | mean RMS | mean FLIP | best of the first and the fixed rules in |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    let measures: [fn(&Judged) -> f64; 3] = [|one| one.rms, |one| one.flip, |one| one.flicker];
    let errors = |of: fn(&Judged) -> f64| -> Vec<Vec<f64>> {
        rows.iter().map(|row| row.iter().map(of).collect()).collect()
    };
    // The paper's question: errors against the four fixed rules.
    let competes = |contender: usize| contender == 0 || (2..6).contains(&contender);
    let bad = measures.map(|of| badness(&errors(of), competes));
    let runs = study.runs_per_setting();
    for (place, (name, _)) in contenders.iter().enumerate() {
        let mean = |of: fn(&Judged) -> f64| rows[place].iter().map(of).sum::<f64>() / runs as f64;
        let wins = (0..runs)
            .filter(|&run| {
                let best = (0..rows.len()).filter(|&other| competes(other)).map(|other| rows[other][run].rms);
                competes(place) && rows[place][run].rms <= best.fold(f64::INFINITY, f64::min)
            })
            .count();
        let wins = if competes(place) { format!("{wins} of {runs}") } else { "–".to_owned() };
        results.line(format!(
            "| {name} | {:.3} | {:.3} | {:.3} | {:.2} | {:.4} | {wins} |",
            bad[0][place],
            bad[1][place],
            bad[2][place],
            255.0 * mean(measures[0]),
            mean(measures[1]),
        ));
    }
    results.line("");
    by_scenario(study, &contenders.map(|one| one.0), &rows, &mut results);
    results.finish()
}

/// RMS and FLIP of each scenario on each machine.
fn by_scenario(study: &Study, names: &[&str], rows: &[&[Judged]], results: &mut Results) {
    results.line(format!("| scenario, a complete picture takes | {} |", names.join(" | ")));
    results.line(format!("| --- |{}", " ---: |".repeat(names.len())));
    for (at, footage) in study.footage.iter().enumerate() {
        for (number, machine) in study.machines.iter().enumerate() {
            let run = at * study.machines.len() + number;
            let cells: Vec<String> = rows
                .iter()
                .map(|row| format!("{:.2} / {:.3}", 255.0 * row[run].rms, row[run].flip))
                .collect();
            results.line(format!(
                "| {}, {} s | {} |",
                footage.name,
                machine.full.as_secs_f64(),
                cells.join(" | ")
            ));
        }
    }
}

fn judge(contender: Contender, footage: &Footage, machine: Machine) -> Judged {
    let (mut scorer, mut flips, mut count) = (Scorer::new(footage), 0.0, 0);
    play(footage, contender, machine, &mut |instant, shown| {
        if instant % STRIDE == 0 {
            flips += f64::from(mean_flip(footage, shown, footage.truth(instant)));
            count += 1;
        }
        scorer.see(instant, shown);
    });
    let score = scorer.score();
    Judged { rms: score.rms, flicker: score.flicker, flip: flips / f64::from(count.max(1)) }
}

/// The mean FLIP difference of two pictures.
pub fn mean_flip(footage: &Footage, picture: &Picture, truth: &Picture) -> f32 {
    let display = footage.display();
    let plain = Finisher::new(&display.projectors[0]);
    let coded = |picture: &Picture| {
        FlipImageRgb8::with_data(picture.width, picture.height, &plain.codes(&picture.rgba))
    };
    let raster = display.canonical_raster();
    let degree_m = display.observer_in_display.z * 1.0_f64.to_radians().tan();
    let pixels_per_degree = (degree_m / (raster.size_m.x / f64::from(raster.width))) as f32;
    FlipPool::from_image(&flip(coded(truth), coded(picture), pixels_per_degree)).mean()
}
