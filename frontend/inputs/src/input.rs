//! What a source is, as its entry in a file says.

use crate::datagrams::Port;
use crate::script::Script;
use std::path::PathBuf;
use tracking::RigidTransform;

/// A source.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// What people call it; unique in its file.
    pub name: String,
    /// What it is.
    pub kind: Kind,
    /// From its frame to the display's, where it was calibrated.
    pub display_from_tracker: Option<RigidTransform>,
}

/// A protocol, and where it is spoken.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A device of a VRPN server.
    Vrpn {
        /// Host and port of the server.
        address: String,
        /// The device's name at the server.
        device: String,
        /// Whether the server may send datagrams, which come sooner than what a lossy network repeats.
        takes_datagrams: bool,
    },
    /// The targets of a DTrack system.
    Dtrack(Port),
    /// Messages of programs.
    Osc(Port),
    /// A camera by OpenTrackIO.
    OpenTrackIo(Port),
    /// Cameras by FreeD.
    Freed(Port),
    /// A gamepad or joystick, by its path.
    Gamepad(PathBuf),
    /// A SpaceMouse, by the path of spacenavd's socket.
    Spacemouse(PathBuf),
    /// A path that is written down.
    Script(Script),
}

impl Kind {
    /// As files call it.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Vrpn { .. } => "vrpn",
            Self::Dtrack(_) => "dtrack",
            Self::Osc(_) => "osc",
            Self::OpenTrackIo(_) => "opentrackio",
            Self::Freed(_) => "freed",
            Self::Gamepad(_) => "gamepad",
            Self::Spacemouse(_) => "spacemouse",
            Self::Script(_) => "script",
        }
    }
}
