//! How somebody handles a volume: turned, moved and scaled from where its scene puts it.

use super::Placement;
use glam::{DQuat, DVec3};

/// A turn, a shift and a scale on top of a scene's own placement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Handling {
    /// A turn about the volume's centre, after the scene's own.
    pub turn: DQuat,
    /// A shift of its centre, metres, display frame.
    pub shift_m: DVec3,
    /// A factor of its size.
    pub scale: f64,
    /// The tool in somebody's hand, in place of the scene's; None where nobody has ever held one.
    pub tool: Option<HeldTool>,
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

impl HeldTool {
    /// Unit vector along which it points, display frame.
    pub(super) fn axis(&self) -> DVec3 {
        self.rotation * DVec3::NEG_Z
    }
}

impl Default for Handling {
    /// As the scene has it.
    fn default() -> Self {
        Self { turn: DQuat::IDENTITY, shift_m: DVec3::ZERO, scale: 1.0, tool: None }
    }
}

impl Handling {
    /// The placement with its centre and turn handled; the size is the frame's affair.
    pub(super) fn applied(&self, place: Placement) -> Placement {
        let Self { turn, shift_m, .. } = *self;
        Placement { centre_m: place.centre_m + shift_m, rotation: turn * place.rotation, ..place }
    }
}
