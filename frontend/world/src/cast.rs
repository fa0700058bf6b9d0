//! Who takes part: visitors and their tools.

use inputs::SourceId;
use serde::{Deserialize, Serialize};
use tracking::{RigidTransform, TrackSettings};

/// A visitor's place in the cast, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct VisitorId(pub u16);

/// A tool's place in the cast, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ToolId(pub u16);

/// All who take part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cast {
    /// Visitors, by their numbers.
    pub visitors: Vec<Visitor>,
    /// Tools, by their numbers.
    pub tools: Vec<Tool>,
}

impl Cast {
    /// Whose tool it is.
    pub fn holder(&self, tool: ToolId) -> VisitorId {
        self.tools[usize::from(tool.0)].holder
    }

    /// Who that is.
    pub fn visitor(&self, visitor: VisitorId) -> &Visitor {
        &self.visitors[usize::from(visitor.0)]
    }
}

/// Somebody with tools in their hands.
#[derive(Clone, Debug, PartialEq)]
pub struct Visitor {
    /// What the exhibit calls them.
    pub name: String,
    /// Linear RGB of what is drawn of their tools.
    pub colour: [f64; 3],
}

/// A tool in a visitor's hand.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    /// What the exhibit calls it.
    pub name: String,
    /// In whose hand it is.
    pub holder: VisitorId,
    /// Where it is tracked.
    pub sensor: Sensor,
    /// From the tip's frame, in which the tool points along −z, to the sensor's.
    pub sensor_from_tip: RigidTransform,
    /// What it can be, at least one thing; the first is what it is at the beginning.
    pub kinds: Vec<ToolKind>,
    /// What the buttons of its source do.
    pub buttons: Vec<Button>,
    /// What the axes of its source do.
    pub dials: Vec<Dial>,
    /// How its poses are filtered and predicted.
    pub track: TrackSettings,
}

/// Where a tool is tracked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensor {
    /// By one sensor.
    Of {
        /// The sensor's source; the tool's buttons and axes are those of this source.
        source: SourceId,
        /// Its number there.
        sensor: u8,
    },
    /// By the first sensor that has a pose, of whatever source.
    First,
}

/// What a tool can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ToolKind {
    /// It only points.
    Pointer,
    /// Light comes from where it is held: from where its axis points back to.
    Light,
    /// It cuts.
    ClipPlane,
    /// It opens a view to what lies deeper.
    Probe,
    /// It brings out a band of values.
    BandPicker,
    /// It fades layers by the direction in which they are seen.
    LayerOpacity,
}

impl ToolKind {
    /// Whether it looks at the band of values that visitors pick.
    pub fn picks_band(self) -> bool {
        matches!(self, Self::BandPicker | Self::LayerOpacity)
    }
}

/// A button of a tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Button {
    /// Its number at the source.
    pub index: u8,
    /// What it does.
    pub action: Action,
}

/// What a button does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Action {
    /// While it is down, the volume goes with the tool; two tools of one visitor also scale it.
    Grab,
    /// While it is down, the tool's moves shift and stretch the values that the look shows.
    Window,
    /// While it is down, what its holder can do is listed beside the tool's tip, to be chosen from when it is released.
    Menu,
    /// While it is down, the bands of values are listed there, and that under the tip is tried out.
    PickBand,
    /// The tool becomes the next thing that it can be.
    NextKind,
    /// The next look.
    NextLook,
    /// The look before.
    PreviousLook,
    /// The next band of values that a band picker brings out.
    NextBand,
    /// The next placement of those that somebody prepared.
    NextPreset,
    /// The visitor's latest deed is undone.
    Undo,
    /// All is as the scene has it.
    Reset,
    /// The next item of the programme.
    NextItem,
}

/// An axis of a tool's source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dial {
    /// Its number at the source.
    pub index: u8,
    /// What it does.
    pub kind: DialKind,
    /// How much, at full deflection, per second: radians, metres, e-foldings of the size, parts of the values.
    pub per_s: f64,
}

/// What an axis does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DialKind {
    /// Turns the volume about the upright axis.
    TurnRight,
    /// Turns it about the level one.
    TurnDown,
    /// Moves it to the right.
    MoveRight,
    /// Moves it up.
    MoveUp,
    /// Moves it toward the viewers.
    MoveNear,
    /// Scales it.
    Scale,
    /// Shifts the values that the look shows.
    Shift,
    /// Stretches them.
    Stretch,
}
