//! Whole scenes at random: a strategy for proptest, the same for the same seed, each scene printable.
//!
//! | file | what it is |
//! | --- | --- |
//! | `volume` | a field of some kind over a box of voxels |
//! | `curves` | transfer functions with spikes, jumps and flat parts |
//! | `look` | importance, light, materials, refraction |
//! | `enhancers` | chains of enhancers within the volume |
//! | `view` | placement, viewer, quality |
//! | `difference` | how far two pictures are apart |
//! | `truth` | what every pixel should show, and how well it is conditioned |
//! | `judge` | a picture against the truth, each pixel by its own condition |
//! | `check` | a scene drawn by every device, against the others and the truth |
//! | `run` | many of them |

mod check;
mod curves;
mod difference;
mod enhancers;
mod judge;
mod look;
mod run;
mod truth;
mod view;
mod volume;

pub use check::{Found, check, display};
pub use difference::{Difference, Limit};
pub use judge::{Judge, Verdict};
pub use run::{Plan, Summary, run};
pub use truth::Truth;
pub use view::Stand;
pub use volume::{RandomField, RandomVolume};

use crate::scenes;
use curves::Shape;
use display_config::Display;
use glam::{DAffine3, DVec3};
use look::Look;
use optics::{Enhancer, ExtinctionUnit, Light, MimdaForm, Optics, Quality};
use proptest::prelude::*;
use protocol::FrameState;

/// Features that scenes may have beyond those that every device and the reference know.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// Refraction indices.
    pub refraction: bool,
    /// Materials per scalar.
    pub materials: bool,
    /// Chains of enhancers.
    pub enhancers: bool,
    /// Filtering over node, parent and grandparent.
    pub quadrilinear: bool,
    /// Unsharp masking and exaggerated shading.
    pub detail: bool,
}

impl Wanted {
    /// All there are.
    pub const ALL: Self =
        Self { refraction: true, materials: true, enhancers: true, quadrilinear: true, detail: true };
}

/// A scene.
#[derive(Clone, Debug)]
pub struct RandomScene {
    /// Its volume.
    pub volume: RandomVolume,
    /// Where the volume and its viewer are.
    pub stand: Stand,
    /// Its optical model.
    pub optics: Optics,
    /// The most extinction per finest voxel.
    pub most_per_voxel: f64,
    /// Whether its transfer functions are without jumps and spikes, refraction apart.
    pub is_even: bool,
    /// Whether its refraction, if any, is gentle enough to compare kernel and twin.
    pub is_gentle: bool,
    /// Its light.
    pub light: Option<Light>,
    /// Its quality.
    pub quality: Quality,
}

/// Scenes with the features wanted.
pub fn scenes(wanted: Wanted) -> impl Strategy<Value = RandomScene> {
    (
        volume::volumes(),
        view::stands(),
        curves::shapes(),
        curves::colours(),
        look::looks(wanted),
        enhancers::chains(wanted.enhancers),
        view::qualities(wanted.quadrilinear),
        prop::bool::ANY,
    )
        .prop_map(|(volume, stand, extinction, colour, look, chain, quality, is_per_metre)| {
            assemble(volume, stand, (extinction, colour), look, chain, quality, is_per_metre)
        })
}

/// Some in this share of the scenes; proptest's own takes no share of 0.
fn sometimes<S>(share: f64, strategy: S) -> BoxedStrategy<Option<S::Value>>
where
    S: Strategy + 'static,
    S::Value: Clone,
{
    if share > 0.0 { proptest::option::weighted(share, strategy).boxed() } else { Just(None).boxed() }
}

fn assemble(
    volume: RandomVolume,
    stand: Stand,
    (extinction, colour): (Shape, curves::Colours),
    look: Look,
    chain: Vec<Enhancer>,
    quality: Quality,
    is_per_metre: bool,
) -> RandomScene {
    let place = stand.place(volume.dims);
    let voxel_m = place.matrix3.determinant().abs().cbrt();
    let (unit, per_unit) = if is_per_metre {
        (ExtinctionUnit::PerMetre, 1.0 / voxel_m)
    } else {
        (ExtinctionUnit::PerVoxel, 1.0)
    };
    let optics = Optics {
        domain: volume.domain(),
        extinction: extinction.curve(per_unit),
        extinction_unit: unit,
        colour: colour.curve,
        mimda: look.mimda,
        refraction: look.refraction.curve,
        materials: look.materials,
        enhancers: chain.into_iter().map(|link| enhancers::placed(link, &place, volume.dims)).collect(),
    };
    let corners = std::array::from_fn(|corner| {
        let share = [0, 1, 2].map(|axis| f64::from(corner as u32 >> axis & 1));
        place.transform_point3(DVec3::from(share) * volume.dims.as_dvec3())
    });
    RandomScene {
        most_per_voxel: extinction.most() * optics.most_factor(&corners),
        is_even: extinction.is_even() && colour.is_even && look.is_even,
        is_gentle: look.refraction.is_gentle && (optics.refraction.is_none() || volume.is_smooth()),
        volume,
        stand,
        optics,
        light: look.light,
        quality,
    }
}

impl RandomScene {
    /// Volume frame to display frame.
    pub fn place(&self) -> DAffine3 {
        self.stand.place(self.volume.dims)
    }

    /// Its one frame.
    pub fn frame(&self, display: &Display) -> FrameState {
        let mut frame = scenes::frame(display, self.place(), self.optics.clone(), self.light);
        (frame.observer_in_display, frame.eta) = (self.stand.observer_in_display, self.stand.eta);
        frame.quality = self.quality;
        frame
    }

    /// Whether a reference tells its picture: MImDA as published depends on the step, which has no limit to compare with
    /// but its own, and steps longer than by default promise nothing.
    pub fn has_truth(&self) -> bool {
        let is_paper = |m: &optics::Mimda| m.form == MimdaForm::Paper && m.gamma > 0.0;
        !self.optics.mimda.as_ref().is_some_and(is_paper) && !self.has_coarse_quality()
    }

    /// Whether it asks for less than default quality.
    fn has_coarse_quality(&self) -> bool {
        let most = Quality::default();
        self.quality.step_voxels > most.step_voxels
            || self.quality.tolerance > most.tolerance
            || self.quality.termination > most.termination
    }

    /// Whether nothing in it is steep: neither the field nor a transfer function, nor a skin thinner than a voxel.
    pub fn is_tame(&self) -> bool {
        self.volume.is_smooth() && self.is_even && self.most_per_voxel <= 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;

    #[test]
    fn every_scene_is_valid_and_every_feature_occurs() {
        let mut runner = TestRunner::deterministic();
        let mut draw = |wanted| scenes(wanted).new_tree(&mut runner).unwrap().current();
        let some: Vec<RandomScene> = (0..300).map(|_| draw(Wanted::ALL)).collect();
        assert!(some.iter().all(|scene| scene.optics.check() == Ok(())));
        let features: [fn(&RandomScene) -> bool; 9] = [
            |s| s.optics.refraction.is_some() && s.is_gentle && s.has_truth(),
            |s| s.optics.refraction.is_some() && !s.is_gentle,
            |s| s.optics.materials.is_some() && s.light.is_some(),
            |s| s.optics.enhancers.len() == 3,
            |s| s.quality.quadrilinear,
            |s| s.light.is_some_and(|light| light.detail != optics::Detail::None),
            |s| s.optics.mimda.as_ref().is_some_and(|mimda| mimda.gamma == 1.0),
            RandomScene::is_tame,
            |s| s.volume.has_deviation && s.quality.lod_scale > 2.0,
        ];
        for (i, has) in features.iter().enumerate() {
            assert!(some.iter().filter(|scene| has(scene)).count() > 3, "feature {i} is too rare");
        }
        for scene in (0..100).map(|_| draw(Wanted::default())) {
            assert!(features[..6].iter().all(|has| !has(&scene)), "{scene:?}");
        }
    }
}
