//! What people have made of a scene in a frame.

use super::Placement;
use glam::{DQuat, DVec3};
use optics::{Enhancer, Light, Trapezoid};
use world::{Handling, Window};

/// What hands and tools do to a scene, on top of what its file says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Handled {
    /// How the volume is turned, moved and scaled.
    pub handling: Handling,
    /// The scene's own tool in somebody's hand; None where nobody has ever held it.
    pub tool: Option<HeldTool>,
    /// What other tools carry, in their places, bands over data values. They come before the scene's own enhancers.
    pub carried: Vec<Enhancer>,
    /// Where other tools have the light come from.
    pub light: Option<HeldLight>,
    /// Which values the look shows.
    pub window: Window,
    /// What band pickers bring out, over data values; None leaves them their own.
    pub picked: Option<Trapezoid>,
}

/// A tool in a hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldTool {
    /// Its tip, display frame, metres.
    pub tip_m: DVec3,
    /// From its own axes, in which it points along −z, to the display's.
    pub rotation: DQuat,
    /// How much of it is there, from 0 to 1: what it carries acts by so much.
    pub presence: f64,
}

/// A light in a hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldLight {
    /// Unit vector toward it, display frame.
    pub toward: DVec3,
    /// How much of it is there, above 0 and at most 1.
    pub presence: f64,
}

impl HeldTool {
    /// Unit vector along which it points, display frame.
    pub fn axis(&self) -> DVec3 {
        self.rotation * DVec3::NEG_Z
    }
}

impl Handled {
    /// The placement with its centre and turn handled; the size is the frame's affair.
    pub(super) fn applied(&self, place: Placement) -> Placement {
        let Handling { turn, shift_m, .. } = self.handling;
        Placement { centre_m: place.centre_m + shift_m, rotation: turn * place.rotation, ..place }
    }

    /// The light of a scene with that in a hand: it comes from there by as much of it as is there.
    pub(super) fn lit(&self, light: Option<Light>) -> Option<Light> {
        let Some(HeldLight { toward, presence }) = self.light else { return light };
        let rest = light.map_or(toward, |light| light.toward_light_in_display);
        let between = rest.lerp(toward, presence).try_normalize().unwrap_or(toward);
        Some(Light { toward_light_in_display: between, ..light.unwrap_or_default() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_in_a_hand_comes_and_goes_by_as_much_of_it_as_is_there() {
        let held = |presence| Some(HeldLight { toward: DVec3::X, presence });
        let lit = |presence, light| Handled { light: held(presence), ..Handled::default() }.lit(light);
        let rest = Light { toward_light_in_display: DVec3::Z, ..Light::default() };
        let toward = |light: Option<Light>| light.unwrap().toward_light_in_display;
        assert_eq!(toward(lit(1.0, Some(rest))), DVec3::X);
        assert!(toward(lit(1e-9, Some(rest))).distance(DVec3::Z) < 1e-8);
        assert_eq!(toward(lit(0.5, None)), DVec3::X, "a scene without a light gets one");
        let opposite = Light { toward_light_in_display: DVec3::NEG_X, ..rest };
        assert_eq!(toward(lit(0.5, Some(opposite))), DVec3::X, "half way between opposites is no direction");
        assert_eq!(Handled::default().lit(Some(rest)), Some(rest));
    }
}
