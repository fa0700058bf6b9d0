//! Which look fits a volume, and why.

use super::{LookName, Values};
use bricks::volume::Modality;
use std::fmt;

/// A look that was taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LookChoice {
    /// Which one.
    pub name: LookName,
    /// Why.
    pub why: String,
}

/// Whether a look fits a volume.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verdict {
    /// Whether it does.
    pub fits: bool,
    /// Why, or why not.
    pub why: String,
}

impl fmt::Display for LookChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "look `{}`: {}", self.name, self.why)
    }
}

/// The looks that are chosen without being asked for, the most special ones first; the last fits all volumes.
const BY_ITSELF: [LookName; 6] = [
    LookName::CtSkinBone,
    LookName::Labels,
    LookName::Fluorescence,
    LookName::Mr,
    LookName::Tomogram,
    LookName::Scalar,
];

/// The look that fits best.
pub fn choose(values: &Values) -> LookChoice {
    let fitting = BY_ITSELF.into_iter().map(|name| (name, verdict(name, values)));
    let found = fitting.into_iter().find(|(_, verdict)| verdict.fits);
    let (name, verdict) = found.unwrap_or_else(|| (LookName::Scalar, verdict(LookName::Scalar, values)));
    LookChoice { name, why: verdict.why }
}

/// Whether a look fits, by what the volume's file says, or else by what its values tell.
pub fn verdict(name: LookName, values: &Values) -> Verdict {
    match values.modality {
        Modality::Unknown => by_values(name, values),
        modality => by_modality(name, modality, values),
    }
}

fn by_modality(name: LookName, modality: Modality, values: &Values) -> Verdict {
    let said = format!("its file says that it is {modality}");
    let (fits, why) = match (modality, name) {
        (Modality::Ct, LookName::CtSkinBone | LookName::CtBone) | (Modality::Mr, LookName::Mr) => {
            (true, said)
        }
        (Modality::Ct, LookName::CtVessels) => (true, said + ", if a contrast agent was given"),
        (Modality::Ct, LookName::CtLung) if has_lungs(values) => {
            (true, said + ", and many of its values are those of lungs")
        }
        (Modality::Ct, LookName::CtLung) => (false, said + ", but few of its values are those of lungs"),
        (_, LookName::Scalar) => (true, "it fits all volumes".to_owned()),
        _ => (false, said),
    };
    Verdict { fits, why }
}

fn by_values(name: LookName, values: &Values) -> Verdict {
    let (fits, yes, no) = match name {
        LookName::CtSkinBone | LookName::CtBone => {
            (are_hounsfield(values), "its values are Hounsfield units", NO_CT)
        }
        LookName::CtLung if are_hounsfield(values) => (
            has_lungs(values),
            "its values are Hounsfield units, and many are those of lungs",
            "its values are Hounsfield units, but few are those of lungs",
        ),
        LookName::CtLung => (false, "", NO_CT),
        LookName::CtVessels => {
            (are_hounsfield(values), "its values are Hounsfield units, if a contrast agent was given", NO_CT)
        }
        LookName::Mr => (
            is_tissue(values),
            "its values are a dark background and brighter tissue",
            "its values are not a dark background and peaks of brighter tissue",
        ),
        LookName::Fluorescence => (
            is_sparse(values),
            "its values are a dark background and a sparse, bright signal",
            "its values are not a dark background and a sparse, bright signal",
        ),
        LookName::Tomogram => (
            is_noise(values),
            "its values are symmetric noise around one peak",
            "its values are not symmetric noise around one peak",
        ),
        LookName::Labels => (
            are_labels(values),
            "its values are few whole numbers in even regions",
            "its values are not few whole numbers in even regions",
        ),
        LookName::Scalar => (true, "its values tell of nothing more special", ""),
    };
    Verdict { fits, why: if fits { yes } else { no }.to_owned() }
}

const NO_CT: &str = "its values are not Hounsfield units";

/// Air at -1000 and soft tissue around 0 stand out of what lies between. Scanners write down to -1024, and below that, down
/// to -3024, what is outside their circle.
fn are_hounsfield(values: &Values) -> bool {
    let least = values.quantile(0.0);
    let air = values.share(-1100.0, -850.0);
    let between = values.density(-700.0, -350.0);
    let (air_density, soft_density) = (values.density(-1100.0, -850.0), values.density(-150.0, 150.0));
    let has_range = (-3100.0..=-850.0).contains(&least) && values.quantile(1.0) >= 100.0;
    let has_peaks = air_density > 2.0 * between && soft_density > 2.0 * between;
    let soft = values.share(0.0, 100.0);
    has_range && has_peaks && air >= 0.02 && soft >= 0.03
}

fn has_lungs(values: &Values) -> bool {
    values.share(-950.0, -600.0) >= 0.05
}

/// Each region has one value: voxels beside each other are equal, except at borders.
fn are_labels(values: &Values) -> bool {
    values.labels.as_ref().is_some_and(|labels| labels.len() > 1) && values.flat >= 0.6
}

/// Where the background lies near the low end of the range.
fn is_dark(values: &Values) -> bool {
    let histogram = &values.histogram;
    histogram.width() > 0.0 && histogram.place(histogram.background()) <= 0.1
}

fn is_sparse(values: &Values) -> bool {
    let histogram = &values.histogram;
    let bright = histogram.low + 0.3 * histogram.width();
    is_dark(values) && values.share(bright, f64::INFINITY) < 0.06
}

fn is_tissue(values: &Values) -> bool {
    let histogram = &values.histogram;
    let tissue = values.share(histogram.threshold(), f64::INFINITY);
    is_dark(values) && (0.08..0.85).contains(&tissue) && histogram.has_second_peak()
}

/// As much above the middle as below it, and denser there than even values are.
fn is_noise(values: &Values) -> bool {
    let [low, quarter, half, three, high] = [0.01, 0.25, 0.5, 0.75, 0.99].map(|q| values.quantile(q));
    let histogram = &values.histogram;
    let is_middle = (histogram.background() - half).abs() < 0.15 * (high - low);
    let is_even = (high - half) < 2.0 * (half - low) && (half - low) < 2.0 * (high - half);
    let is_peaked = three > quarter && (high - low) > 2.6 * (three - quarter);
    is_middle && is_even && is_peaked && !histogram.has_second_peak()
}
