//! The curves of an optical model, cut into bands on which all of them are linear.

use super::Cubic;
use glam::DVec3;
use shaders::optics::{Curve, CurveValue, Mimda, MimdaForm, Optics};

/// A function that is linear over a band: its value at the band's start, and its change over the band.
#[derive(Clone, Copy, Debug)]
pub struct Linear<V>(pub V, pub V);

/// An interval of the scalar on which every curve is linear. Positions in it are x = (s − start) / width.
#[derive(Clone, Copy, Debug)]
pub struct Band {
    start: f64,
    width: f64,
    /// Extinction, 1/metre.
    pub extinction: Linear<f64>,
    /// Colour, linear RGB.
    pub colour: Linear<DVec3>,
    /// Importance; 0 where the medium has none.
    pub importance: Linear<f64>,
}

impl Band {
    /// The place in the band of the scalar `s`.
    pub fn place(&self, s: f64) -> f64 {
        (s - self.start) / self.width
    }

    /// The place in the band along a way on which the scalar is a cubic.
    pub fn places(&self, scalar: &Cubic) -> Cubic {
        scalar.relative_to(self.start, self.width)
    }

    /// The importance at the scalar `s`.
    pub fn importance_at(&self, s: f64) -> f64 {
        (self.importance.0 + self.importance.1 * self.place(s)).clamp(0.0, 1.0)
    }

    /// The scalar at which the importance, which must change in this band, is `importance`.
    pub fn scalar_where(&self, importance: f64) -> f64 {
        self.start + self.width * ((importance - self.importance.0) / self.importance.1)
    }

    /// Whether nothing is visible anywhere in the band.
    pub fn is_empty(&self) -> bool {
        self.extinction.0 == 0.0 && self.extinction.1 == 0.0
    }
}

/// How strongly importance erases what lies before it.
#[derive(Clone, Copy, Debug)]
pub struct Erasure {
    /// γ in (0, 1].
    pub gamma: f64,
    /// Which form.
    pub form: MimdaForm,
    /// The largest importance there is.
    pub largest: f64,
}

impl Erasure {
    /// What is left of the past after ι_max rises from a to b > a by infinitely small steps: exp(−γ (b − a)) in the
    /// paper's form, (1 − γ b) / (1 − γ a) in the consistent one. A jump of ι at one point is taken as the limit of ever
    /// steeper rises, so that a curve with a jump and the same curve with a very steep flank show the same picture.
    pub fn kept(&self, a: f64, b: f64) -> f64 {
        match self.form {
            MimdaForm::Paper => (-self.gamma * (b - a)).exp(),
            MimdaForm::Consistent => kept_consistently(self.gamma, a, b),
        }
    }

    /// dP / dι at importance ι: the erasing of the past per rise of importance.
    pub fn rate(&self, importance: f64) -> f64 {
        match self.form {
            MimdaForm::Paper => self.gamma,
            MimdaForm::Consistent => self.gamma / (1.0 - self.gamma * importance),
        }
    }

    /// β of LFD eq. 3 for one step that finds importance `b` after a maximum of `a` < b.
    pub fn kept_by_one_step(&self, a: f64, b: f64) -> f64 {
        match self.form {
            MimdaForm::Paper => 1.0 - self.gamma * (b - a),
            MimdaForm::Consistent => kept_consistently(self.gamma, a, b),
        }
    }
}

fn kept_consistently(gamma: f64, a: f64, b: f64) -> f64 {
    if gamma * a == 1.0 { 1.0 } else { (1.0 - gamma * b) / (1.0 - gamma * a) }
}

/// An optical model made ready for integration.
///
/// A value that a curve takes at a single scalar only (the middle one of three points at one position) is never
/// seen, as the ray spends no length at it.
#[derive(Clone, Debug)]
pub struct Medium {
    optics: Optics,
    knots: Vec<f64>,
    bands: Vec<Band>,
    /// Importance accumulation, where it does anything.
    pub erasure: Option<Erasure>,
    /// The largest component of any colour.
    pub brightest: f64,
}

impl Medium {
    /// `optics`, which must have passed its check, for a finest voxel of edge `voxel_m`.
    pub fn new(optics: &Optics, voxel_m: f64) -> Self {
        let mimda = optics.mimda.as_ref().filter(|mimda| mimda.gamma > 0.0);
        let largest = |mimda: &Mimda| mimda.importance.max_on(0.0, 1.0);
        let knots = knots(optics, mimda);
        let band = |s0: f64, s1: f64| band(optics, mimda, voxel_m, s0, s1);
        let mut bands = vec![band(0.0, 0.0)];
        bands.extend(knots.windows(2).map(|pair| band(pair[0], pair[1])));
        bands.push(band(1.0, 1.0));
        Self {
            knots,
            bands,
            erasure: mimda.map(|m| Erasure { gamma: m.gamma, form: m.form, largest: largest(m) }),
            brightest: optics.colour.points().iter().fold(0.0, |most, p| p.1.max_element().max(most)),
            optics: optics.clone(),
        }
    }

    /// The optical model it was made of.
    pub fn optics(&self) -> &Optics {
        &self.optics
    }

    /// The scalar, not clamped, along a way on which the data value is a cubic.
    pub fn scalar(&self, value: &Cubic) -> Cubic {
        let (low, high) = self.optics.domain;
        if value.is_finite() {
            value.relative_to(low, high - low)
        } else {
            Cubic::constant(self.optics.normalise(value.0[0]))
        }
    }

    /// Number of the band that holds the scalar `s`; on a knot, the upper one, as [`Curve::at`] has it.
    pub fn band_number(&self, s: f64) -> usize {
        self.knots.partition_point(|&knot| knot <= s)
    }

    /// A band by its number.
    pub fn band(&self, number: usize) -> &Band {
        &self.bands[number]
    }

    /// The knots strictly between `from` and `to`, in the order in which they are met.
    pub fn knots_between(&self, from: f64, to: f64) -> impl Iterator<Item = f64> + '_ {
        let is_rising = to > from;
        let (low, high) = (from.min(to), from.max(to));
        let first = self.knots.partition_point(|&knot| knot <= low);
        let last = self.knots.partition_point(|&knot| knot < high).max(first);
        (first..last).map(move |i| self.knots[if is_rising { i } else { first + last - 1 - i }])
    }

    /// Whether data values in [low, high] neither show nor, with ι_max already at `importance`, erase anything.
    pub fn is_idle_on(&self, low: f64, high: f64, importance: f64) -> bool {
        let raises = |mimda: &Mimda| {
            let (s0, s1) = (self.optics.normalise(low), self.optics.normalise(high));
            mimda.importance.max_on(s0, s1) > importance
        };
        let may_erase = self.erasure.is_some() && self.optics.mimda.as_ref().is_some_and(raises);
        self.optics.is_empty_on(low, high) && !may_erase
    }
}

/// All positions at which a curve may bend or jump, with the clamps of the scalar at 0 and 1.
fn knots(optics: &Optics, mimda: Option<&Mimda>) -> Vec<f64> {
    let mut knots = vec![0.0, 1.0];
    knots.extend(optics.extinction.knots_between(0.0, 1.0));
    knots.extend(optics.colour.knots_between(0.0, 1.0));
    knots.extend(mimda.iter().flat_map(|m| m.importance.knots_between(0.0, 1.0)));
    knots.sort_by(f64::total_cmp);
    knots.dedup();
    knots
}

fn band(optics: &Optics, mimda: Option<&Mimda>, voxel_m: f64, s0: f64, s1: f64) -> Band {
    let per_metre = optics.extinction_per_metre(voxel_m);
    let Linear(extinction, change) = linear(&optics.extinction, s0, s1);
    Band {
        start: s0,
        width: if s1 > s0 { s1 - s0 } else { 1.0 },
        extinction: Linear(extinction * per_metre, change * per_metre),
        colour: linear(&optics.colour, s0, s1),
        importance: mimda.map_or(Linear(0.0, 0.0), |m| linear(&m.importance, s0, s1)),
    }
}

fn linear<V: CurveValue + std::ops::Sub<Output = V>>(curve: &Curve<V>, s0: f64, s1: f64) -> Linear<V> {
    let start = curve.at(s0);
    let end = if s1 > s0 { curve.just_below(s1) } else { start };
    Linear(start, end - start)
}
