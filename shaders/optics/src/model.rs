//! Everything that turns a scalar into light: transfer functions, importance, accumulation.

use super::{Curve, Enhancer, MOST_ENHANCERS, Material, OutOfBounds};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// What length the extinction's numbers are per.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ExtinctionUnit {
    /// Per metre of the display frame.
    PerMetre,
    /// Per edge of the finest voxel: the cube root of its volume in the display frame.
    PerVoxel,
}

/// Which form of Maximum Importance Difference Accumulation composites the samples.
///
/// Both replace front-to-back compositing by `[c* α*] ← β [c* α*] + (1 − β α*) [c α]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MimdaForm {
    /// β = 1 − γ max(ι − ι_max, 0), the published equation. Its picture depends on the step: as steps shrink, a
    /// rise of ι from a to b keeps exp(−γ (b − a)) of what lay before.
    Paper,
    /// β = (1 − γ ι) / (1 − γ ι_max) where ι > ι_max (1 if γ ι_max = 1): the product telescopes, so a rise from
    /// zero to b keeps 1 − γ b whatever the steps.
    Consistent,
}

/// Importance accumulation, where a scene uses it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mimda {
    /// Importance ι of the normalised scalar, in [0, 1].
    pub importance: Curve<f64>,
    /// γ in [0, 1]: 0 is ordinary compositing, 1 lets full importance erase what lies in front of it.
    pub gamma: f64,
    /// Which form.
    pub form: MimdaForm,
}

/// The optical model of a scene. The normalised scalar is `s = clamp((v − domain.0) / (domain.1 − domain.0), 0, 1)`
/// of the data value v; all curves are functions of s.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Optics {
    /// Data values that map to s = 0 and s = 1; finite, the first below the second.
    pub domain: (f64, f64),
    /// Extinction τ(s) ≥ 0, in `extinction_unit`.
    pub extinction: Curve<f64>,
    /// What the extinction is per.
    pub extinction_unit: ExtinctionUnit,
    /// Linear RGB colour c(s), not multiplied by anything.
    pub colour: Curve<DVec3>,
    /// Importance accumulation; None is ordinary compositing.
    pub mimda: Option<Mimda>,
    /// Refraction index ν(s) > 0; None leaves rays straight.
    ///
    /// Light follows the ray equation d(ν v)/dt = ∇ν along the way of length t, with ∇ν = dν/ds · g and g the gradient
    /// that shades (central differences). Where ν jumps, Snell's law holds with g / |g| as normal, and beyond the
    /// critical angle the surface is a mirror. The faces of the volume do not refract.
    pub refraction: Option<Curve<f64>>,
    /// Factors of the shading law over s, instead of the light's own.
    pub materials: Option<Curve<Material>>,
    /// The chain, in order; at most [`MOST_ENHANCERS`].
    pub enhancers: Vec<Enhancer>,
}

/// What is wrong with an optical model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OpticsError {
    /// The domain is not an interval.
    #[error("the transfer function's domain [{0:?}, {1:?}] is not a rising interval of finite numbers")]
    Domain(f64, f64),
    /// γ is outside [0, 1].
    #[error("gamma is {0:?}; it must lie in [0, 1]")]
    Gamma(f64),
    /// An importance is above 1.
    #[error("importance control point {index} is {value:?}; importances lie in [0, 1]")]
    Importance {
        /// Which control point, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A refraction index is out of reach.
    #[error("refraction control point {index} is {value:?}; refraction indices lie in [0.001, 1000]")]
    Refraction {
        /// Which control point, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A number is too large for kernels, which compute in f32.
    #[error("{curve} control point {index} is beyond {largest:e}; correct it, or take another unit")]
    TooLarge {
        /// Which curve.
        curve: &'static str,
        /// Which control point, from 0.
        index: usize,
        /// The largest there may be.
        largest: f64,
    },
    /// A material's highlight has an exponent below 1.
    #[error("material control point {index} has a shininess of {value:?}; it must be at least 1")]
    Shininess {
        /// Which control point, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// Too many enhancers.
    #[error("the scene chains {0} enhancers; at most {MOST_ENHANCERS} can be chained")]
    TooManyEnhancers(usize),
    /// An enhancer is not valid.
    #[error("enhancer {number}: {error}")]
    Enhancer {
        /// Which one, from 1.
        number: usize,
        /// What is wrong with it.
        error: OutOfBounds,
    },
}

/// Times a colour, and summed over a table, it must stay an f32.
const LARGEST_EXTINCTION: f64 = 1e24;
/// Of colours, and of the factors of materials and lights.
const LARGEST_LIGHT: f64 = 1e6;

fn too_large(
    curve: &'static str,
    largest: f64,
    mut values: impl Iterator<Item = f64>,
) -> Result<(), OpticsError> {
    match values.position(|value| value > largest) {
        Some(index) => Err(OpticsError::TooLarge { curve, index, largest }),
        None => Ok(()),
    }
}

impl Optics {
    /// A plain model, without importance, refraction, materials or enhancers; extinction is per finest voxel.
    pub fn plain(domain: (f64, f64), extinction: Curve<f64>, colour: Curve<DVec3>) -> Self {
        Self {
            domain,
            extinction,
            extinction_unit: ExtinctionUnit::PerVoxel,
            colour,
            mimda: None,
            refraction: None,
            materials: None,
            enhancers: Vec::new(),
        }
    }

    /// A plain model in which everything is white, over the domain [0, 1]; extinction is per finest voxel.
    pub fn grey(extinction: Curve<f64>) -> Self {
        Self::plain((0.0, 1.0), extinction, Curve::constant(DVec3::ONE))
    }

    /// Checks what the types do not.
    pub fn check(&self) -> Result<(), OpticsError> {
        let (lo, hi) = self.domain;
        if !(lo.is_finite() && hi.is_finite() && lo < hi) {
            return Err(OpticsError::Domain(lo, hi));
        }
        too_large("extinction", LARGEST_EXTINCTION, self.extinction.points().iter().map(|p| p.1))?;
        too_large("colour", LARGEST_LIGHT, self.colour.points().iter().map(|p| p.1.max_element()))?;
        let factors = self.materials.iter().flat_map(|m| m.points());
        too_large(
            "material",
            LARGEST_LIGHT,
            factors.map(|p| p.1.to_array().into_iter().fold(0.0, f64::max)),
        )?;
        if let Some(mimda) = &self.mimda {
            if !(0.0..=1.0).contains(&mimda.gamma) {
                return Err(OpticsError::Gamma(mimda.gamma));
            }
            let too_large = mimda.importance.points().iter().position(|p| p.1 > 1.0);
            if let Some(index) = too_large {
                return Err(OpticsError::Importance { index, value: mimda.importance.points()[index].1 });
            }
        }
        self.check_illustration()
    }

    /// Checks refraction, materials and enhancers.
    fn check_illustration(&self) -> Result<(), OpticsError> {
        for (index, &(_, value)) in self.refraction.iter().flat_map(|index| index.points()).enumerate() {
            if !(1e-3..=1e3).contains(&value) {
                return Err(OpticsError::Refraction { index, value });
            }
        }
        for (index, (_, material)) in self.materials.iter().flat_map(|m| m.points()).enumerate() {
            if material.shininess < 1.0 {
                return Err(OpticsError::Shininess { index, value: material.shininess });
            }
        }
        if self.enhancers.len() > MOST_ENHANCERS {
            return Err(OpticsError::TooManyEnhancers(self.enhancers.len()));
        }
        for (index, enhancer) in self.enhancers.iter().enumerate() {
            enhancer.check().map_err(|error| OpticsError::Enhancer { number: index + 1, error })?;
        }
        Ok(())
    }

    /// The normalised scalar of a data value; a value that is not a number counts as the domain's low end.
    pub fn normalise(&self, value: f64) -> f64 {
        let s = (value - self.domain.0) / (self.domain.1 - self.domain.0);
        if s.is_nan() { 0.0 } else { s.clamp(0.0, 1.0) }
    }

    /// Factor that turns the extinction curve's numbers into 1/metre, for a finest voxel of edge `voxel_m` metres.
    pub fn extinction_per_metre(&self, voxel_m: f64) -> f64 {
        match self.extinction_unit {
            ExtinctionUnit::PerMetre => 1.0,
            ExtinctionUnit::PerVoxel => 1.0 / voxel_m,
        }
    }

    /// Whether data values in [min, max] leave a picture as it is: no extinction, nor any importance, which acts
    /// on what lies in front of it even where there is nothing to see, nor any change of the refraction index.
    pub fn is_empty_on(&self, min: f64, max: f64) -> bool {
        let (lo, hi) = (self.normalise(min), self.normalise(max));
        let bends = self.refraction.as_ref().is_some_and(|index| !index.is_constant_on(lo, hi));
        self.extinction.max_on(lo, hi) == 0.0 && self.most_importance_on(lo, hi) == 0.0 && !bends
    }

    /// Importance accumulation, where it does anything: γ = 0 is ordinary compositing.
    pub fn accumulation(&self) -> Option<&Mimda> {
        self.mimda.as_ref().filter(|mimda| mimda.gamma > 0.0)
    }

    /// The largest importance that acts for scalars in [lo, hi]; 0 if importance does nothing.
    pub fn most_importance_on(&self, lo: f64, hi: f64) -> f64 {
        let Some(mimda) = self.accumulation() else { return 0.0 };
        let own = mimda.importance.max_on(lo, hi);
        self.enhancers.iter().fold(own, |told, enhancer| enhancer.most_importance(lo, hi, told))
    }

    /// The largest factor that the chain may multiply an extinction by in a box with these corners in the display frame, at
    /// least 1.
    pub fn most_factor(&self, corners: &[DVec3; 8]) -> f64 {
        self.enhancers.iter().map(|enhancer| enhancer.most_factor(corners)).product()
    }
}
