//! Importance, light, materials and refraction at random.

use super::curves::{curve, points};
use super::{Wanted, sometimes};
use glam::DVec3;
use optics::{Curve, Detail, Light, Material, Mimda, MimdaForm};
use proptest::prelude::*;

/// What makes light of samples.
#[derive(Clone, Debug)]
pub(super) struct Look {
    pub(super) mimda: Option<Mimda>,
    pub(super) light: Option<Light>,
    pub(super) materials: Option<Curve<Material>>,
    pub(super) refraction: Refraction,
    /// Whether none of it jumps, nor has importance a peak between its ends.
    pub(super) is_even: bool,
}

/// Refraction indices.
#[derive(Clone, Debug)]
pub(super) struct Refraction {
    pub(super) curve: Option<Curve<f64>>,
    pub(super) is_gentle: bool,
}

pub(super) fn looks(wanted: Wanted) -> impl Strategy<Value = Look> {
    let share = |is_wanted: bool, share: f64| if is_wanted { share } else { 0.0 };
    (
        sometimes(0.35, importances()),
        sometimes(0.6, lights(wanted.detail)),
        sometimes(share(wanted.materials, 0.4), materials()),
        sometimes(share(wanted.refraction, 0.3), refractions()),
    )
        .prop_map(|(mimda, light, materials, refraction)| Look {
            is_even: mimda.as_ref().is_none_or(|(_, is_even)| *is_even),
            mimda: mimda.map(|(mimda, _)| mimda),
            light,
            materials,
            refraction: refraction.unwrap_or(Refraction { curve: None, is_gentle: true }),
        })
}

/// Importance, and whether it is even: a ray may turn within a peak, or pass it between two samples.
fn importances() -> impl Strategy<Value = (Mimda, bool)> {
    let gamma = prop_oneof![1 => Just(0.0), 1 => Just(1.0), 3 => 0.0..=1.0];
    let form = prop_oneof![3 => Just(MimdaForm::Consistent), 1 => Just(MimdaForm::Paper)];
    (points(0.3), gamma, form).prop_map(|((points, has_jump), gamma, form)| {
        let has_peak = points.windows(3).any(|three| three[1].1 > three[0].1 && three[1].1 > three[2].1);
        (Mimda { importance: curve(points), gamma, form }, gamma == 0.0 || !(has_jump || has_peak))
    })
}

/// Unit vectors.
pub(super) fn directions() -> impl Strategy<Value = DVec3> {
    let any = (-1.0..=1.0f64, 0.0..6.3f64).prop_map(|(z, turn)| {
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * turn.cos(), r * turn.sin(), z)
    });
    prop_oneof![8 => any, 1 => Just(DVec3::Z), 1 => Just(DVec3::X)]
}

fn lights(has_detail: bool) -> impl Strategy<Value = Light> {
    let detail = if has_detail { details().boxed() } else { Just(Detail::None).boxed() };
    (directions(), material(), -2.5..-0.5f64, detail).prop_map(|(toward, material, half, detail)| Light {
        toward_light_in_display: toward,
        ambient: material.ambient,
        diffuse: material.diffuse,
        specular: material.specular,
        shininess: material.shininess,
        gradient_half: 10f64.powf(half),
        detail,
    })
}

fn details() -> impl Strategy<Value = Detail> {
    prop_oneof![
        2 => Just(Detail::None),
        1 => (0.0..3.0).prop_map(|strength| Detail::Unsharp { strength }),
        1 => (0.0..8.0).prop_map(|contrast| Detail::Exaggerated { contrast }),
    ]
}

fn material() -> impl Strategy<Value = Material> {
    (0.0..1.0, 0.0..1.0, 0.0..0.6, 1.0..60.0).prop_map(|(ambient, diffuse, specular, shininess)| Material {
        ambient,
        diffuse,
        specular,
        shininess,
    })
}

fn materials() -> impl Strategy<Value = Curve<Material>> {
    (points(0.0), prop::collection::vec(material(), 8))
        .prop_map(|(points, materials)| curve(points.0.iter().map(|p| p.0).zip(materials).collect()))
}

/// Most of them gentle: a lens of a few per cent, without jumps. The others bend rays as they like.
fn refractions() -> impl Strategy<Value = Refraction> {
    let strength = prop_oneof![3 => (0.0..0.03, Just(true)), 1 => (0.03..1.5, Just(false))];
    (points(0.0), points(0.5), strength).prop_map(|(even, uneven, (strength, is_gentle))| {
        let (points, _) = if is_gentle { even } else { uneven };
        let points = points.into_iter().map(|(s, value)| (s, 1.0 + strength * value)).collect();
        Refraction { curve: Some(curve(points)), is_gentle }
    })
}
