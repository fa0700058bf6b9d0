//! What can happen to a world.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Something that happens: what a tape keeps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Deed {
    /// At a source of inputs. Its times are on the clock of [`Moment`].
    Event(inputs::Event),
    /// At the mouse and the keys of whoever looks after the display. These give way to nobody.
    Change(Change),
}

/// What mouse and keys do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// The volume turns about the display's axes, by so many radians about the upright and the level one.
    Turn {
        /// About y: the front goes to the right.
        right: f64,
        /// About x: the front goes down.
        down: f64,
    },
    /// It moves, metres.
    Move(DVec3),
    /// It becomes so many times as large.
    Scale(f64),
    /// The clip plane, which faces the viewers, comes or goes.
    Clip,
    /// It moves toward the viewers, metres.
    MoveClip(f64),
    /// The next look.
    NextLook,
    /// The next item of the programme.
    NextItem,
    /// The script stands still, or goes on.
    Pause,
    /// All is as the scene has it.
    Reset,
}

/// The frame to which a world steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// When it is made, on the display's clock.
    pub now: Duration,
    /// When it is to be seen.
    pub seen_at: Duration,
}
