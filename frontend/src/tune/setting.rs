//! What is tried, and how bad each is over all scenarios.

use super::Contender;
use control::{Rule, Weights};
use serde::Serialize;
use std::time::Duration;

/// Which number is varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// ρ; beside it the fixed rules, and reconstruction in time.
    Rho,
    /// ϑ, at the best ρ.
    Theta,
    /// χ, at the best ρ and ϑ.
    Chi,
}

/// A contender with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// What it is called.
    pub name: String,
    /// The number that is varied; None of those beside.
    pub value: Option<f64>,
    /// The contender.
    pub contender: Contender,
}

/// ϑ and χ that are tried: those of the paper's section 6.2, and larger ones, since ζ falls to 0 here.
const SMALL: [f64; 11] = [0.0, 1e-3, 5e-3, 0.01, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9];
const IDLE: [f64; 7] = [0.0, 5e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02];

fn by_errors(name: String, value: f64, weights: Weights) -> Setting {
    Setting { name, value: Some(value), contender: Contender::Control(Rule::Errors(weights)) }
}

/// ρ from 0.1 to 0.9 and, beside it, the paper's four fixed rules and what is shown without control. Around a ϑ and χ.
pub fn stage_of_rho(around: Weights) -> Vec<Setting> {
    let fixed = |name: &str, rule| Setting {
        name: name.to_owned(),
        value: None,
        contender: Contender::Control(rule),
    };
    let rate = |hz: f64| Rule::Rate { period: Duration::from_secs_f64(1.0 / hz) };
    let mut settings: Vec<Setting> = (1..10)
        .map(|tenth| f64::from(tenth) / 10.0)
        .map(|rho| by_errors(format!("ρ = {rho}"), rho, Weights { rho, ..around }))
        .collect();
    settings.extend([
        fixed("10 a second", rate(10.0)),
        fixed("30 a second", rate(30.0)),
        fixed("5 % of the rays", Rule::Quality { share: 0.05 }),
        fixed("20 % of the rays", Rule::Quality { share: 0.2 }),
    ]);
    settings.push(Setting { name: "quincunx".to_owned(), value: None, contender: Contender::Quincunx });
    settings
}

/// ϑ from 0 to 0.9, around a ρ and χ.
pub fn stage_of_theta(around: Weights) -> Vec<Setting> {
    let setting = |theta| by_errors(format!("ϑ = {theta}"), theta, Weights { theta, ..around });
    SMALL.into_iter().map(setting).collect()
}

/// χ from 0 to 0.02, around a ρ and ϑ.
pub fn stage_of_chi(around: Weights) -> Vec<Setting> {
    let setting = |chi| by_errors(format!("χ = {chi}"), chi, Weights { chi, ..around });
    IDLE.into_iter().map(setting).collect()
}

/// How bad each setting is over all scenarios: the sum of the squares of how much more it errs than the best setting of each
/// scenario (STE eq. 3, which prints the index of the best wrong). `errors` has a row for each setting, with an error for
/// each scenario; those that `competes` says no to are judged, but are nobody's measure.
pub fn badness(errors: &[Vec<f64>], competes: impl Fn(usize) -> bool) -> Vec<f64> {
    let scenarios = errors.first().map_or(0, Vec::len);
    let best = |scenario: usize| {
        let of = errors.iter().enumerate().filter(|&(setting, _)| competes(setting));
        of.map(|(_, row)| row[scenario]).fold(f64::INFINITY, f64::min).max(1e-12)
    };
    let best: Vec<f64> = (0..scenarios).map(best).collect();
    let of = |row: &Vec<f64>| row.iter().zip(&best).map(|(error, best)| (error / best - 1.0).powi(2)).sum();
    errors.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_everywhere_has_no_badness_and_nobody_else() {
        let errors = [vec![1.0, 2.0], vec![2.0, 2.0], vec![1.5, 6.0]];
        let badness = badness(&errors, |_| true);
        assert_eq!(badness, [0.0, 1.0, 4.25]);
    }

    #[test]
    fn who_does_not_compete_is_judged_by_the_others() {
        let errors = [vec![1.0], vec![2.0]];
        assert_eq!(badness(&errors, |setting| setting == 1), [0.25, 0.0]);
    }

    #[test]
    fn stages_vary_one_number() {
        let around = Weights { rho: 0.4, theta: 0.1, chi: 0.0 };
        assert_eq!(stage_of_rho(around).len(), 14);
        for setting in stage_of_theta(around) {
            let Contender::Control(Rule::Errors(weights)) = setting.contender else { panic!("{setting:?}") };
            assert_eq!((weights.rho, Some(weights.theta)), (0.4, setting.value));
        }
        assert!(stage_of_chi(around).iter().all(|setting| setting.value.is_some()));
    }
}
