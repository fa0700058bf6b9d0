//! A look of the library for one volume.

use super::draft::{Draft, Per, Points};
use super::{LookName, Values, ct, fitted, labels};
use crate::scene::DataLook;
use glam::{DVec3, UVec3};
use optics::{Curve, ExtinctionUnit, Light};

/// The voxels that a look is for.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// How many along each axis.
    pub dims: UVec3,
    /// Their edges, as the data say, metres.
    pub voxel_m: DVec3,
}

/// A look with its light.
#[derive(Clone, Debug, PartialEq)]
pub struct MadeLook {
    /// The transfer functions.
    pub look: DataLook,
    /// Gradient shading; None shows the plain colours.
    pub light: Option<Light>,
}

/// Patients are not smaller or larger than this, metres; volumes without a scale are.
const PATIENTS_M: (f64, f64) = (0.05, 2.0);

/// The look of this name for such values in such a grid.
pub fn make(name: LookName, values: &Values, grid: &Grid) -> MadeLook {
    let draft = match name {
        LookName::CtSkinBone => ct::skin_and_bone(),
        LookName::CtBone => ct::bone(),
        LookName::CtLung => ct::lung(),
        LookName::CtVessels => ct::vessels(),
        LookName::Mr => fitted::mr(values),
        LookName::Fluorescence => fitted::fluorescence(values),
        LookName::Tomogram => fitted::tomogram(values),
        LookName::Scalar => fitted::scalar(values),
        LookName::Labels => labels::labels(values),
    };
    draft.made(grid)
}

impl Draft {
    /// Extinctions become those per voxel: so the volume looks the same at any size in the display.
    fn made(self, grid: &Grid) -> MadeLook {
        let longest_m = (grid.dims.as_dvec3() * grid.voxel_m).max_element();
        // See `Optics::extinction_per_metre` for the voxel's edge.
        let voxels = longest_m / grid.voxel_m.element_product().cbrt();
        let across = match self.per {
            Per::Metre => longest_m.clamp(PATIENTS_M.0, PATIENTS_M.1),
            Per::Volume => 1.0,
        };
        let factor = across / voxels;
        let mut value = f64::NEG_INFINITY;
        let rising = self.points.into_iter().map(|(v, extinction, rgb)| {
            // Quantiles of few values may fall together, or back by a rounding.
            value = value.max(v);
            (value, extinction * factor, rgb)
        });
        let rising: Points = rising.collect();
        let extinction = rising.iter().map(|&(v, extinction, _)| (v, extinction)).collect();
        let colour = rising.iter().map(|&(v, _, rgb)| (v, DVec3::from_array(rgb))).collect();
        let fine = "the points of a look are finite and rise: a test makes all of them";
        let look = DataLook {
            domain: self.domain.filter(|&(low, high)| is_wide(low, high)),
            extinction: Curve::new(extinction).expect(fine),
            extinction_unit: ExtinctionUnit::PerVoxel,
            colour: Curve::new(colour).expect(fine),
            mimda: None,
            refraction: None,
            materials: None,
        };
        MadeLook { look, light: self.light }
    }
}

/// Whether f32 tells values of a domain apart.
fn is_wide(low: f64, high: f64) -> bool {
    high - low > 1e-4 * low.abs().max(high.abs())
}
