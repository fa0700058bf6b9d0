//! What a frame shows of a world.

use crate::menu::Menu;
use crate::turn::{about_x, about_y};
use crate::{ToolId, ToolKind, VisitorId};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// All that a frame shows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stage {
    /// Which item of the programme.
    pub item: usize,
    /// Time of its script, seconds.
    pub script_s: f64,
    /// How it is handled.
    pub handling: Handling,
    /// Which of its looks, from 0; None for its own.
    pub look: Option<usize>,
    /// Which of its bands band pickers bring out, from 0; None for their own.
    pub band: Option<usize>,
    /// Which values the look shows.
    pub window: Window,
    /// Where the clip plane of mouse and keys is: metres before the volume's centre; None where there is none.
    pub clip_m: Option<f64>,
    /// Tools of which there is something, by their numbers.
    pub tools: Vec<ShownTool>,
    /// Menus that are open, by the numbers of their tools.
    pub menus: Vec<Menu>,
    /// Whose hands the volume is in.
    pub held_by: Option<VisitorId>,
    /// Whether anybody is there.
    pub phase: Phase,
    /// What visitors wanted and did not get, while they are told of it.
    pub refusals: Vec<Refusal>,
}

/// How a volume is handled: turned, moved and scaled from where its scene puts it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Handling {
    /// A turn about the volume's centre, after the scene's own.
    pub turn: DQuat,
    /// A shift of its centre, metres, display frame.
    pub shift_m: DVec3,
    /// A factor of its size.
    pub scale: f64,
}

impl Default for Handling {
    /// As the scene has it.
    fn default() -> Self {
        Self { turn: DQuat::IDENTITY, shift_m: DVec3::ZERO, scale: 1.0 }
    }
}

impl Handling {
    /// Turned from where its scene puts it, by so many radians about the upright axis and before that about the level one.
    pub fn turned(right: f64, down: f64) -> Self {
        Self { turn: about_y(right) * about_x(down), ..Self::default() }
    }
}

/// Values that a look shows: those of value v look as (v − centre − shift × width) / stretch + centre did, where centre and
/// width are those of the look's domain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Window {
    /// In parts of the domain's width.
    pub shift: f64,
    /// Above 0.
    pub stretch: f64,
}

impl Default for Window {
    /// The look as it is.
    fn default() -> Self {
        Self { shift: 0.0, stretch: 1.0 }
    }
}

/// A tool as a frame shows it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShownTool {
    /// Which one.
    pub tool: ToolId,
    /// What it is now.
    pub kind: ToolKind,
    /// Its tip where it will be when the frame is seen, metres, display frame.
    pub tip_m: DVec3,
    /// From its own axes, in which it points along −z, to the display's.
    pub rotation: DQuat,
    /// How much of it is there, above 0 and at most 1.
    pub presence: f64,
    /// Whether it holds the volume.
    pub grabs: bool,
    /// Whether it moves the window of values.
    pub moves_window: bool,
}

/// Whether anybody is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// Visitors do things, or did a while ago.
    Open,
    /// Nobody is there.
    Attract,
}

/// Something that a visitor wanted and did not get.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Refusal {
    /// The volume, or its window of values, is in another's hands.
    Held {
        /// Who wanted it.
        wanted_by: VisitorId,
        /// Who has it.
        held_by: VisitorId,
    },
    /// Another has done something to the same thing since.
    ChangedSince {
        /// Who wanted to undo.
        wanted_by: VisitorId,
        /// Who did it.
        changed_by: VisitorId,
    },
}
