//! What can happen to a world.

use crate::scene::HeldTool;
use glam::DVec3;

/// One change.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// The tool in somebody's hand is here now.
    Tool(HeldTool),
    /// It takes hold of the volume, which then goes with it, or lets go.
    Grip(bool),
    /// The next look of the library that fits the volume.
    NextLook,
    /// The script stands still, or goes on.
    Pause,
    /// All is as the scene has it.
    Reset,
    /// Somebody wants to know what there is.
    Help,
    /// The show is over.
    Quit,
}
