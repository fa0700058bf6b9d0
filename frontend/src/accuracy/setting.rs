//! One way to draw a scene.

use optics::Quality;
use protocol::FilterChoice;
use serde::Serialize;
use std::fmt;

/// All that is varied.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Setting {
    /// The knobs of the renderer; in JSON an infinite tolerance is null.
    #[serde(flatten)]
    pub quality: Quality,
    /// How voxels are interpolated: `Hardware` or `Exact`.
    pub filter: FilterChoice,
    /// Bits per stored sample.
    pub bits: u8,
}

/// Why a setting is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Family {
    /// Step length and step tolerance, everything else as by default; the default is one of them.
    Steps,
    /// Only the filter differs from the default.
    Filter,
    /// Only the bits per sample differ from the default.
    Bits,
    /// Only the termination threshold differs from the default.
    Termination,
    /// Only the level tolerance differs from the default.
    Levels,
    /// The same, and samples are filtered over levels.
    Quadrilinear,
    /// The same, without blending into coarser neighbours.
    Unblended,
    /// The same, without the standard deviations of coarse voxels.
    Means,
    /// The scene's own quality, where it is not the default.
    Scene,
    /// A part of the whole product.
    Product,
}

/// A setting that is tried.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Trial {
    /// Why.
    pub family: Family,
    /// What.
    #[serde(flatten)]
    pub setting: Setting,
}

/// All of it in one line.
impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Quality { step_voxels, termination, .. } = self.quality;
        write!(
            f,
            "step {step_voxels}, tolerance {}, termination {}, levels {}, {}, {} bits",
            small(self.quality.tolerance),
            small(termination),
            levels_of(&self.quality),
            filter_name(self.filter),
            self.bits
        )
    }
}

/// The level tolerance, and how the filtering over levels differs from the default.
pub fn levels_of(quality: &Quality) -> String {
    let odd = [
        (quality.quadrilinear, " quadrilinear"),
        (!quality.blended, " unblended"),
        (!quality.deviation, " of means"),
    ];
    let odd: String = odd.into_iter().filter_map(|(is_so, name)| is_so.then_some(name)).collect();
    format!("{}{odd}", quality.lod_scale)
}

/// What people call a filter.
pub fn filter_name(filter: FilterChoice) -> &'static str {
    match filter {
        FilterChoice::Auto => "auto",
        FilterChoice::Hardware => "hardware",
        FilterChoice::Exact => "exact",
    }
}

/// A number that is often small: 1e-4, 0, ∞.
pub fn small(number: f64) -> String {
    match number {
        n if n.is_infinite() => "∞".to_owned(),
        0.0 => "0".to_owned(),
        n => {
            let text = format!("{n:.1e}");
            text.replace(".0e", "e")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_read_well() {
        let quality = Quality { tolerance: f64::INFINITY, termination: 0.0, ..Quality::default() };
        let setting = Setting { quality, filter: FilterChoice::Exact, bits: 16 };
        assert_eq!(setting.to_string(), "step 0.4, tolerance ∞, termination 0, levels 1, exact, 16 bits");
        let odd = Quality { lod_scale: 2.0, quadrilinear: true, deviation: false, ..quality };
        assert_eq!(levels_of(&odd), "2 quadrilinear of means");
        assert_eq!([small(1e-4), small(2.5e-5), small(1.0 / 1024.0)], ["1e-4", "2.5e-5", "9.8e-4"]);
    }
}
