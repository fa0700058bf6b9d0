//! What scalars look like, before the volume is known.

use super::Edits;
use super::enhancer::normalised_enhancer;
use glam::DVec3;
use optics::{Curve, CurveError, CurveValue, Enhancer, ExtinctionUnit, Material, Mimda, Optics};
use world::Window;

/// A scene's look.
#[derive(Clone, Debug, PartialEq)]
pub enum Look {
    /// In data values, as scene files give it.
    InDataUnits(DataLook),
    /// In parts of the volume's value range and size, as the built-in ones are.
    Relative {
        /// Optical depth of the volume's longest edge, over the normalised scalar.
        depth_across: Curve<f64>,
        /// Linear RGB over the normalised scalar.
        colour: Curve<DVec3>,
    },
}

/// A look over data values.
#[derive(Clone, Debug, PartialEq)]
pub struct DataLook {
    /// Data values that become s = 0 and 1; None takes the volume's smallest and largest.
    pub domain: Option<(f64, f64)>,
    /// Extinction over data values.
    pub extinction: Curve<f64>,
    /// What the extinction is per.
    pub extinction_unit: ExtinctionUnit,
    /// Linear RGB over data values.
    pub colour: Curve<DVec3>,
    /// Importance accumulation, its curve over data values.
    pub mimda: Option<Mimda>,
    /// Refraction index over data values.
    pub refraction: Option<Curve<f64>>,
    /// Factors of the shading law over data values.
    pub materials: Option<Curve<Material>>,
}

impl Look {
    /// The look at a time, as keyframes have changed it until then.
    pub(super) fn edited(&self, edits: &Edits, time_s: f64) -> Self {
        match self {
            Look::InDataUnits(look) => Look::InDataUnits(look.edited(edits, time_s)),
            Look::Relative { .. } => self.clone(),
        }
    }

    /// Whether it may bend light.
    pub fn refracts(&self) -> bool {
        match self {
            Look::InDataUnits(look) => look.refraction.is_some(),
            Look::Relative { .. } => false,
        }
    }

    /// The look for a volume of those values, whose longest edge is `longest_m` metres in the display, through a window of
    /// values. The bands of `chain` are over data values. An error is a sentence's part.
    pub fn optics(
        &self,
        value_range: (f64, f64),
        longest_m: f64,
        window: Window,
        chain: &[Enhancer],
    ) -> Result<Optics, String> {
        let whole = match self {
            Look::InDataUnits(look) => {
                look.optics(look.domain.unwrap_or_else(|| interval(value_range)), &[])?
            }
            Look::Relative { depth_across, colour } => {
                relative(depth_across, colour, longest_m, interval(value_range))?
            }
        };
        let domain = windowed(whole.domain, window);
        checked(Ok(Optics { domain, enhancers: normalised_chain(chain, domain)?, ..whole }))
    }
}

fn relative(
    depth_across: &Curve<f64>,
    colour: &Curve<DVec3>,
    longest_m: f64,
    domain: (f64, f64),
) -> Result<Optics, String> {
    let per_metre = depth_across.points().iter().map(|&(s, depth)| (s, depth / longest_m)).collect();
    Ok(Optics {
        domain,
        extinction: Curve::new(per_metre).map_err(|e| e.to_string())?,
        extinction_unit: ExtinctionUnit::PerMetre,
        colour: colour.clone(),
        mimda: None,
        refraction: None,
        materials: None,
        enhancers: Vec::new(),
    })
}

/// The domain in which values look as those of `(low, high)` did before the window moved and was stretched.
fn windowed((low, high): (f64, f64), Window { shift, stretch }: Window) -> (f64, f64) {
    let (centre, width) = ((low + high) / 2.0, high - low);
    let at = |value: f64| value + shift * width + (value - centre) * (stretch - 1.0);
    (at(low), at(high))
}

fn normalised_chain(chain: &[Enhancer], domain: (f64, f64)) -> Result<Vec<Enhancer>, String> {
    let normalised = |enhancer: &Enhancer| normalised_enhancer(*enhancer, domain).map_err(|e| e.to_string());
    chain.iter().map(normalised).collect()
}

fn checked(optics: Result<Optics, String>) -> Result<Optics, String> {
    optics.and_then(|optics| optics.check().map_err(|e| e.to_string()).map(|()| optics))
}

impl DataLook {
    /// The look at a time, as keyframes have changed it until then.
    pub(super) fn edited(&self, edits: &Edits, time_s: f64) -> Self {
        let mimda = self.mimda.as_ref().map(|mimda| Mimda {
            importance: edits.importance.at(time_s).unwrap_or(&mimda.importance).clone(),
            gamma: *edits.gamma.at(time_s).unwrap_or(&mimda.gamma),
            form: mimda.form,
        });
        Self {
            domain: self.domain,
            extinction: edits.extinction.at(time_s).unwrap_or(&self.extinction).clone(),
            extinction_unit: self.extinction_unit,
            colour: edits.colour.at(time_s).unwrap_or(&self.colour).clone(),
            mimda,
            refraction: edits.refraction.at(time_s).or(self.refraction.as_ref()).cloned(),
            materials: self.materials.clone(),
        }
    }

    /// Optics that show the same data values as this look does of any volume. Where the look has no domain, one that
    /// reaches beyond all control points will do: outside them curves are constant. An error is a sentence's part.
    pub(super) fn visibility(&self, chain: &[Enhancer]) -> Result<Optics, String> {
        let importance = self.mimda.iter().flat_map(|mimda| mimda.importance.points());
        let refraction = self.refraction.iter().flat_map(|index| index.points());
        let values = self.extinction.points().iter().chain(importance).chain(refraction).map(|point| point.0);
        let corners = chain.iter().filter_map(|enhancer| enhancer.band()).flat_map(|band| band.corners());
        let widen = |(a, b): (f64, f64), v| (a.min(v), b.max(v));
        let (low, high) = interval(values.chain(corners).fold((f64::INFINITY, f64::NEG_INFINITY), widen));
        let domain = self.domain.unwrap_or((low - (high - low), high + (high - low)));
        checked(self.optics(domain, chain))
    }

    fn optics(&self, domain: (f64, f64), chain: &[Enhancer]) -> Result<Optics, String> {
        let mimda = match &self.mimda {
            None => None,
            Some(mimda) => {
                Some(Mimda { importance: named("importance", &mimda.importance, domain)?, ..mimda.clone() })
            }
        };
        let refraction = self.refraction.as_ref().map(|index| named("refraction", index, domain));
        let materials = self.materials.as_ref().map(|materials| named("materials", materials, domain));
        Ok(Optics {
            domain,
            extinction: named("extinction", &self.extinction, domain)?,
            extinction_unit: self.extinction_unit,
            colour: named("colour", &self.colour, domain)?,
            mimda,
            refraction: refraction.transpose()?,
            materials: materials.transpose()?,
            enhancers: normalised_chain(chain, domain)?,
        })
    }
}

/// A curve over data values as one over s; what goes wrong is said with the curve's name.
fn named<V: CurveValue>(name: &str, curve: &Curve<V>, domain: (f64, f64)) -> Result<Curve<V>, String> {
    normalised(curve, domain).map_err(|error| format!("{name}: {error}"))
}

/// A curve over data values as one over s.
fn normalised<V: CurveValue>(curve: &Curve<V>, (low, high): (f64, f64)) -> Result<Curve<V>, CurveError> {
    Curve::new(curve.points().iter().map(|&(value, v)| ((value - low) / (high - low), v)).collect())
}

/// A value range as a rising interval: a volume of one value lies in the middle of a unit interval, or of one so wide that
/// f32 tells its ends apart.
fn interval((low, high): (f64, f64)) -> (f64, f64) {
    let half = (low.abs() * 16.0 * f64::from(f32::EPSILON)).max(0.5);
    if low < high { (low, high) } else { (low - half, low + half) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn look(domain: Option<(f64, f64)>) -> Look {
        Look::InDataUnits(DataLook {
            domain,
            extinction: Curve::new(vec![(-500.0, 0.0), (500.0, 10.0)]).unwrap(),
            extinction_unit: ExtinctionUnit::PerMetre,
            colour: Curve::constant(DVec3::ONE),
            mimda: None,
            refraction: None,
            materials: None,
        })
    }

    #[test]
    fn a_data_value_keeps_its_look_in_any_domain() {
        for domain in [None, Some((-1000.0, 1000.0)), Some((0.0, 100.0))] {
            let optics = look(domain).optics((-1024.0, 3033.0), 0.7, Window::default(), &[]).unwrap();
            let at = |v: f64| optics.extinction.at(optics.normalise(v));
            assert!((at(50.0) - 5.5).abs() < 1e-9, "{domain:?}");
        }
    }

    #[test]
    fn a_window_moves_the_values_that_a_look_shows() {
        let window = Window { shift: 0.25, stretch: 2.0 };
        for domain in [None, Some((-1000.0, 1000.0)), Some((0.0, 100.0))] {
            let (low, high) = domain.unwrap_or((-1024.0, 3033.0));
            let [still, moved] = [Window::default(), window]
                .map(|window| look(domain).optics((-1024.0, 3033.0), 0.7, window, &[]).unwrap());
            assert_eq!(still.domain, (low, high), "to the bit");
            let (centre, width) = ((low + high) / 2.0, high - low);
            for value in [low, centre, 0.3 * low + 0.7 * high] {
                let now = centre + window.shift * width + (value - centre) * window.stretch;
                let at = |optics: &Optics, v: f64| optics.extinction.at(optics.normalise(v));
                assert!((at(&moved, now) - at(&still, value)).abs() < 1e-9, "{domain:?} {value}");
            }
        }
    }

    #[test]
    fn what_a_look_shows_is_known_before_any_volume() {
        for domain in [None, Some((-1000.0, 1000.0))] {
            let Look::InDataUnits(look) = look(domain) else { panic!("it is in data units") };
            let shown = look.visibility(&[]).unwrap();
            assert!(shown.is_empty_on(-3000.0, -500.0) && !shown.is_empty_on(-3000.0, -499.0), "{domain:?}");
            assert!(!shown.is_empty_on(7000.0, 9000.0), "{domain:?}");
        }
    }

    #[test]
    fn a_constant_volume_and_a_broken_one() {
        let domain = look(None).optics((7.0, 7.0), 0.7, Window::default(), &[]).unwrap().domain;
        assert_eq!(domain, (6.5, 7.5));
        for value in [1e16, -1e30, 9_223_372_036_854_775_808.0, f64::from(f32::MAX)] {
            let optics = look(None).optics((value, value), 0.7, Window::default(), &[]).unwrap();
            assert_eq!(optics.normalise(value), 0.5, "{value}");
        }
        let error = look(None).optics((0.0, f64::INFINITY), 0.7, Window::default(), &[]).unwrap_err();
        assert!(error.contains("domain") || error.contains("finite"), "{error}");
    }
}
