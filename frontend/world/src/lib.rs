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
//! | `menu` | lists from which visitors choose with a tool's tip |
//! | `turn` | rotations that are the same on every machine |
//! | `grip`, `easing` | how a volume goes with hands, and to a place |
//! | `tool_state`, `history` | what is known of a tool, and of what visitors did |
//! | `world` | what has happened |
//! | `happen` | what an input reports, done to it |
//! | `act` | what visitors ask for, done to it |
//! | `choices` | what menus list |
//! | `choose` | how visitors open menus, and choose |
//! | `holding`, `hold` | who holds what, and how that comes and goes |
//! | `step` | how time passes |
//! | `laws` | what it is, whatever they do |

mod act;
mod cast;
mod choices;
mod choose;
mod deed;
mod easing;
mod grip;
mod happen;
mod history;
mod hold;
mod holding;
mod laws;
mod menu;
mod programme;
mod rules;
mod stage;
mod step;
mod tool_state;
mod turn;
mod world;

pub use cast::{Action, Button, Cast, Dial, DialKind, Sensor, Tool, ToolId, ToolKind, Visitor, VisitorId};
pub use deed::{Change, Deed, Moment};
pub use menu::{Choice, Menu, MenuSize};
pub use programme::{Item, Preset, Programme};
pub use rules::{Attract, Rules};
pub use stage::{Handling, Phase, Refusal, ShownTool, Stage, Window};
pub use world::World;
