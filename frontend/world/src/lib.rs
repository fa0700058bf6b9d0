//! What visitors do with their tools, and what becomes of the exhibit. Pure: the same events at the same times give the same
//! stage; no clock, no file, no network, no scene.
//!
//! | file | what it is |
//! | --- | --- |
//! | `cast` | who takes part: visitors and their tools |
//! | `programme` | what is shown, one item after the other |
//! | `rules` | what visitors may do, and what time undoes |
//! | `deed` | what can happen to a world |
//! | `stage` | what a frame shows of it |

mod cast;
mod deed;
mod programme;
mod rules;
mod stage;

pub use cast::{Action, Button, Cast, Dial, DialKind, Sensor, Tool, ToolId, ToolKind, Visitor, VisitorId};
pub use deed::{Change, Deed, Moment};
pub use programme::{Item, Preset, Programme};
pub use rules::{Attract, Rules};
pub use stage::{Handling, Phase, Refusal, ShownTool, Stage, Window};
