//! Scenes: a volume, its place, its look, and how they move.

mod axis;
mod band;
mod builtin;
mod check;
mod contents;
mod edits;
mod enhancer;
mod error;
mod file;
mod fitting;
mod handling;
mod load;
mod look;
mod looks;
mod motion;
mod names;
mod placement;
mod quality;
mod read;
mod save;
mod text;
mod tool;
mod usual;
mod volume;

pub use axis::{VolumeAxes, VolumeAxis};
pub use band::Band;
pub use contents::Scene;
pub use edits::{Edits, Held};
pub use enhancer::{Anchor, SceneEnhancer, fade};
pub use error::SceneError;
pub use handling::{Handled, HeldLight, HeldTool};
pub use look::{DataLook, Look};
pub use looks::{LookChoice, LookName, LookWish, Values, Verdict, WishedLook, choose, read_values, verdict};
pub use motion::{Motion, Track};
pub use names::PROCEDURAL_NAMES;
pub(crate) use names::PROCEDURAL_PREFIX;
pub use placement::{Placement, Size};
pub use quality::QualityPreset;
pub use tool::{Tool, ToolKind};
pub use usual::{CLIP_CONTEXT, usual_enhancer};
pub use volume::{VolumeFacts, VolumeSource};

#[cfg(test)]
mod hostile_tests;
#[cfg(test)]
mod illustration_tests;
#[cfg(test)]
mod tests;
