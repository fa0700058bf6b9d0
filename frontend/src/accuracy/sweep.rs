//! The settings that are tried: around the default one, or the whole product.

use super::{Family, Setting, Trial};
use optics::Quality;
use protocol::FilterChoice;

/// Longest step, voxels: from visibly coarse to well below the trilinear kernel's bend, about 1.6 apart. Above 1 a
/// renderer passes over no empty cells.
const STEPS_VOXELS: [f64; 6] = [2.0, 1.0, 0.65, 0.4, 0.25, 0.15];
/// Error that a step may have by its own estimate: from none that is asked for (steps of one length) to where f32
/// rounding takes over, about half a decade apart.
const TOLERANCES: [f64; 6] = [f64::INFINITY, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5];
/// Remaining opacity at which a ray ends: 4, 1, a quarter and a sixteenth of a code of 8 bits, and never.
const TERMINATIONS: [f64; 5] = [1.0 / 64.0, 1.0 / 256.0, 1.0 / 1024.0, 1.0 / 4096.0, 0.0];
/// Voxel edge that is fine enough, in units of the display's resolution: a factor of two is one level of the octree;
/// 0 is the finest level everywhere, which shows what levels cost at all.
const LEVEL_SCALES: [f64; 5] = [4.0, 2.0, 1.0, 0.5, 0.0];

/// What there is to choose from beside the renderer's knobs; the first of each is the default.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Offer {
    /// Interpolations that the device has.
    pub filters: Vec<FilterChoice>,
    /// Bits per sample at which the volume is available: as it is stored, and fewer.
    pub bits: Vec<u8>,
    /// Whether everything is tried at the finest level: levels then hide nothing of what steps err.
    pub is_finest: bool,
}

impl Offer {
    /// The default setting.
    pub fn default_setting(&self) -> Setting {
        let default = Quality::default();
        let lod_scale = if self.is_finest { 0.0 } else { default.lod_scale };
        let quality = Quality { lod_scale, ..default };
        Setting { quality, filter: self.filters[0], bits: self.bits[0] }
    }
}

/// Steps × tolerances, and everything else one at a time around the default; the default comes first. `scene` is the
/// scene's own quality.
pub fn around_default(offer: &Offer, scene: &Quality) -> Vec<Trial> {
    let default = offer.default_setting();
    let with = |quality| Setting { quality, ..default };
    let mut all = vec![Trial { family: Family::Steps, setting: default }];
    let mut add = |family, setting| {
        if all.iter().all(|trial: &Trial| trial.setting != setting) {
            all.push(Trial { family, setting });
        }
    };
    for quality in steps_and_tolerances(&default.quality) {
        add(Family::Steps, with(quality));
    }
    for termination in TERMINATIONS {
        add(Family::Termination, with(Quality { termination, ..default.quality }));
    }
    for lod_scale in LEVEL_SCALES {
        add(Family::Levels, with(Quality { lod_scale, ..default.quality }));
    }
    // At the finest level they are all the same.
    for lod_scale in LEVEL_SCALES.into_iter().filter(|&scale| scale > 0.0 && !offer.is_finest) {
        let quality = Quality { lod_scale, ..default.quality };
        add(Family::Quadrilinear, with(Quality { quadrilinear: true, ..quality }));
        add(Family::Unblended, with(Quality { blended: false, ..quality }));
        add(Family::Means, with(Quality { deviation: false, ..quality }));
    }
    for &filter in &offer.filters {
        add(Family::Filter, Setting { filter, ..default });
    }
    for &bits in &offer.bits {
        add(Family::Bits, Setting { bits, ..default });
    }
    add(Family::Scene, with(*scene));
    all
}

/// Every combination of the lists; the default comes first.
pub fn product(offer: &Offer) -> Vec<Trial> {
    let default = offer.default_setting();
    let mut all = vec![default];
    for &filter in &offer.filters {
        for &bits in &offer.bits {
            for quality in qualities(&default.quality) {
                let setting = Setting { quality, filter, bits };
                if setting != default {
                    all.push(setting);
                }
            }
        }
    }
    all.into_iter().map(|setting| Trial { family: Family::Product, setting }).collect()
}

fn steps_and_tolerances(default: &Quality) -> impl Iterator<Item = Quality> + use<> {
    let default = *default;
    let steps = with_default(&STEPS_VOXELS, default.step_voxels);
    let tolerances = with_default(&TOLERANCES, default.tolerance);
    steps.into_iter().flat_map(move |step_voxels| {
        tolerances.clone().into_iter().map(move |tolerance| Quality { step_voxels, tolerance, ..default })
    })
}

fn qualities(default: &Quality) -> impl Iterator<Item = Quality> + use<> {
    let terminations = with_default(&TERMINATIONS, default.termination);
    let scales = with_default(&LEVEL_SCALES, default.lod_scale);
    let ends: Vec<(f64, f64)> =
        terminations.iter().flat_map(|&t| scales.iter().map(move |&scale| (t, scale))).collect();
    steps_and_tolerances(default).flat_map(move |quality| {
        ends.clone().into_iter().map(move |(termination, lod_scale)| Quality {
            termination,
            lod_scale,
            ..quality
        })
    })
}

/// A falling list with the default among it.
fn with_default(list: &[f64], default: f64) -> Vec<f64> {
    let mut all = list.to_vec();
    if !all.contains(&default) {
        all.push(default);
        all.sort_by(|a, b| b.total_cmp(a));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offer() -> Offer {
        Offer {
            filters: vec![FilterChoice::Hardware, FilterChoice::Exact],
            bits: vec![16, 8],
            is_finest: false,
        }
    }

    #[test]
    fn lists_fall_and_hold_the_default() {
        let default = Quality::default();
        for (list, default) in [
            (&STEPS_VOXELS[..], default.step_voxels),
            (&TOLERANCES, default.tolerance),
            (&TERMINATIONS, default.termination),
            (&LEVEL_SCALES, default.lod_scale),
        ] {
            assert!(list.is_sorted_by(|a, b| a > b), "{list:?}");
            assert!(list.contains(&default), "{default} is not in {list:?}");
            assert!(list.iter().all(|&n| n >= 0.0));
        }
        assert_eq!(with_default(&[4.0, 1.0], 2.0), [4.0, 2.0, 1.0]);
    }

    #[test]
    fn the_default_comes_first_and_nothing_twice() {
        for trials in [around_default(&offer(), &Quality::default()), product(&offer())] {
            assert_eq!(trials[0].setting, offer().default_setting());
            for (i, a) in trials.iter().enumerate() {
                assert!(trials[i + 1..].iter().all(|b| b.setting != a.setting), "{} twice", a.setting);
            }
        }
    }

    #[test]
    fn one_at_a_time_is_what_it_says() {
        let draft = Quality { step_voxels: 3.0, ..Quality::default() };
        let trials = around_default(&offer(), &draft);
        assert_eq!(trials.len(), 6 * 6 + 4 + 4 + 3 * 4 + 1 + 1 + 1);
        let default = trials[0].setting;
        let is_of_levels = |family: &Family| {
            [Family::Levels, Family::Quadrilinear, Family::Unblended, Family::Means].contains(family)
        };
        for Trial { family, setting } in &trials[1..] {
            let (a, b) = (setting.quality, default.quality);
            let differs = [
                a.step_voxels != b.step_voxels || a.tolerance != b.tolerance,
                a.termination != b.termination,
                is_of_levels(family),
                setting.filter != default.filter,
                setting.bits != default.bits,
            ];
            assert_eq!(differs.iter().filter(|d| **d).count(), 1, "{family:?}: {setting}");
            let [a, b] = [a, b].map(|quality| (quality.quadrilinear, quality.blended, quality.deviation));
            let odd = [a.0 != b.0, a.1 != b.1, a.2 != b.2];
            let is_one = [Family::Quadrilinear, Family::Unblended, Family::Means].contains(family);
            assert_eq!(odd.iter().filter(|d| **d).count(), usize::from(is_one), "{family:?}: {setting}");
        }
        assert_eq!(product(&offer()).len(), 2 * 2 * 6 * 6 * 5 * 5);
        let scene = around_default(&offer(), &Quality::default());
        assert!(scene.iter().all(|trial| trial.family != Family::Scene));
    }
}
