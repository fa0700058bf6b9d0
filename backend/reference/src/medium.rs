//! The curves of an optical model, cut into bands on which all of them are linear.

use super::Cubic;
use super::band::{Band, Linear, linear};
use super::enhancer::Chain;
use glam::{DVec3, DVec4};
use optics::{Curve, Material, Mimda, MimdaForm, Optics};

/// How strongly importance erases what lies in front of it.
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
    /// One band of no width per knot, for values that stay on it.
    points: Vec<Band>,
    /// Importance accumulation, where it does anything.
    pub erasure: Option<Erasure>,
    /// The largest component of any colour.
    pub brightest: f64,
}

impl Medium {
    /// `optics`, which must have passed its check, for a finest voxel of edge `voxel_m`, as a `chain` of its enhancers
    /// leaves it.
    pub fn new(optics: &Optics, voxel_m: f64, chain: &Chain) -> Self {
        let knots = knots(optics, chain);
        let band = |s0: f64, s1: f64| band(optics, chain, voxel_m, s0, s1);
        let mut bands = vec![band(0.0, 0.0)];
        bands.extend(knots.windows(2).map(|pair| band(pair[0], pair[1])));
        bands.push(band(1.0, 1.0));
        let largest = optics.most_importance_on(0.0, 1.0);
        Self {
            points: knots.iter().map(|&knot| band(knot, knot)).collect(),
            knots,
            bands,
            erasure: optics.accumulation().map(|m| Erasure { gamma: m.gamma, form: m.form, largest }),
            brightest: optics.colour.points().iter().fold(0.0, |most, p| p.1.max_element().max(most)),
            optics: optics.clone(),
        }
    }

    /// The optical model it was made of.
    pub fn optics(&self) -> &Optics {
        &self.optics
    }

    /// The half-width, in scalars, of what a way's values stand for: see [`Medium::mean_light`]. None where they stand for
    /// themselves.
    pub fn spread(&self, deviation: Option<Cubic>) -> Option<Cubic> {
        let (low, high) = self.optics.domain;
        let spread = deviation?.scaled(0.0, 1.0 / (high - low));
        (spread.bounds().1 > 0.0).then_some(spread)
    }

    /// Mean extinction (1/metre) and mean of extinction times colour over the scalars [a, b], of equal share each.
    pub fn mean_light(&self, a: f64, b: f64) -> (f64, DVec3) {
        let light = |band: &Band, s: f64| {
            let (place, Linear(extinction, change)) = (band.place(s), band.extinction);
            let extinction = (extinction + change * place).max(0.0);
            DVec4::from(((band.colour.0 + band.colour.1 * place) * extinction, extinction))
        };
        let (mut sum, mut from) = (DVec4::ZERO, a);
        for to in self.knots_between(a, b).chain([b]) {
            let middle = 0.5 * (from + to);
            let band = if a < b { self.band(self.band_number(middle)) } else { self.band_at(a) };
            // Simpson's rule is exact: colour times extinction is quadratic in a band.
            let mean = (light(band, from) + 4.0 * light(band, middle) + light(band, to)) / 6.0;
            sum += mean * if a < b { (to - from) / (b - a) } else { 1.0 };
            from = to;
        }
        (sum.w, sum.truncate())
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

    /// The band for a stretch on which the scalar is `s` throughout: on a knot, what the curves are at that point.
    pub fn band_at(&self, s: f64) -> &Band {
        match self.knots.binary_search_by(|knot| knot.total_cmp(&s)) {
            Ok(index) => &self.points[index],
            Err(_) => self.band(self.band_number(s)),
        }
    }

    /// The mean importance over the scalars between `a` and `b`, summed band by band so that nothing cancels; its
    /// value at the point where they are equal.
    pub fn mean_importance(&self, a: f64, b: f64) -> f64 {
        let (low, high) = (a.min(b), a.max(b));
        if low == high {
            return self.band_at(low).importance_at(low);
        }
        let (mut sum, mut from) = (0.0, low);
        for to in self.knots_between(low, high).chain([high]) {
            let middle = 0.5 * (from + to);
            sum += self.band(self.band_number(middle)).importance_at(middle) * (to - from);
            from = to;
        }
        sum / (high - low)
    }

    /// The knots strictly between `from` and `to`, in the order in which they are met.
    pub fn knots_between(&self, from: f64, to: f64) -> impl Iterator<Item = f64> + '_ {
        let is_rising = to > from;
        let (low, high) = (from.min(to), from.max(to));
        let first = self.knots.partition_point(|&knot| knot <= low);
        let last = self.knots.partition_point(|&knot| knot < high).max(first);
        (first..last).map(move |i| self.knots[if is_rising { i } else { first + last - 1 - i }])
    }

    /// Whether no scalar in [low, high] shows.
    pub fn is_clear_on(&self, low: f64, high: f64) -> bool {
        (self.band_number(low)..=self.band_number(high)).all(|number| self.band(number).is_empty())
    }

    /// Whether data values in [low, high] neither show nor, with ι_max already at `importance`, erase anything.
    pub fn is_idle_on(&self, low: f64, high: f64, importance: f64) -> bool {
        let (s0, s1) = (self.optics.normalise(low), self.optics.normalise(high));
        let may_erase = self.erasure.is_some() && self.optics.most_importance_on(s0, s1) > importance;
        self.optics.is_empty_on(low, high) && !may_erase
    }
}

/// All positions at which a curve or a link of the chain may bend or jump, with the clamps of the scalar at 0 and 1.
fn knots(optics: &Optics, chain: &Chain) -> Vec<f64> {
    let mut knots = vec![0.0, 1.0];
    knots.extend(optics.extinction.knots_between(0.0, 1.0));
    knots.extend(optics.colour.knots_between(0.0, 1.0));
    knots.extend(optics.materials.iter().flat_map(|curve| curve.knots_between(0.0, 1.0)));
    let told = importance_told(optics, chain);
    knots.extend(told.iter().flat_map(|m| m.importance.knots_between(0.0, 1.0)));
    knots.extend(chain.knots().filter(|&s| s > 0.0 && s < 1.0));
    knots.sort_by(f64::total_cmp);
    knots.dedup();
    knots
}

/// Importance, where anything looks at it: what does not erase is looked at by enhancers alone.
fn importance_told<'a>(optics: &'a Optics, chain: &Chain) -> Option<&'a Mimda> {
    optics.accumulation().or(optics.mimda.as_ref().filter(|_| chain.weighs_importance()))
}

fn band(optics: &Optics, chain: &Chain, voxel_m: f64, s0: f64, s1: f64) -> Band {
    let per_metre = optics.extinction_per_metre(voxel_m);
    let Linear(extinction, change) = linear(&optics.extinction, s0, s1);
    let told = importance_told(optics, chain).map_or(Linear(1.0, 0.0), |m| linear(&m.importance, s0, s1));
    let shares = chain.shares(s0, s1);
    Band {
        start: s0,
        width: if s1 > s0 { s1 - s0 } else { 1.0 },
        extinction: Linear(extinction * per_metre, change * per_metre),
        colour: linear(&optics.colour, s0, s1),
        importance: optics.accumulation().map_or(Linear(0.0, 0.0), |_| chain.importance(told, &shares)),
        told,
        shares,
        material: optics.materials.as_ref().map(|curve| materials(curve, s0, s1)),
    }
}

fn materials(curve: &Curve<Material>, s0: f64, s1: f64) -> Linear<DVec4> {
    let start = DVec4::from_array(curve.at(s0).to_array());
    let end = if s1 > s0 { DVec4::from_array(curve.just_below(s1).to_array()) } else { start };
    Linear(start, end - start)
}

#[cfg(test)]
mod tests {
    use super::super::test_scene::{optics, with_importance};
    use super::*;
    use glam::DVec3;

    #[test]
    fn the_mean_of_a_curve_with_a_jump_is_its_integral_over_the_width() {
        let curve = Curve::new(vec![(0.2, 0.0), (0.4, 1.0), (0.4, 0.5), (1.0, 0.5)]).unwrap();
        let plain = optics(Curve::constant(1.0), Curve::constant(DVec3::ONE));
        let model = with_importance(plain, curve, 1.0, MimdaForm::Paper);
        let medium = Medium::new(&model, 1.0, &Chain::default());
        let exact = (0.1 + 0.5 * 0.2) / 0.6;
        assert!((medium.mean_importance(0.0, 0.6) - exact).abs() < 1e-15);
        assert!((medium.mean_importance(0.6, 0.0) - exact).abs() < 1e-15);
        assert_eq!(medium.mean_importance(0.4, 0.4), 0.5);
    }
}
