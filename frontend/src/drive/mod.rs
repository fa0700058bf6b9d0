//! A display that lives: inputs change the world, and its frames go out on the beat.
//!
//! | file | what it is |
//! | --- | --- |
//! | `request`, `input`, `tracked`, `taped` | what is asked for, and where that comes from |
//! | `recorder`, `bulletin`, `supervisor` | what keeps a record, and the state of things |
//! | `run` | the loop: inputs, world, frames, screens |
//! | `trial` | which caster is faster |
//! | `controlled` | what is cast next and what is shown, by frame control |
//! | `screens`, `sheet`, `desktop`, `dump` | what the front-end does with the pictures |
//! | `measures`, `energy`, `plot`, `status`, `report` | how well the beat is kept |

mod bulletin;
mod controlled;
mod desktop;
mod dump;
mod energy;
mod input;
mod measures;
mod plot;
mod recorder;
mod report;
mod request;
mod run;
mod screens;
mod sheet;
mod status;
mod supervisor;
mod taped;
mod tracked;
mod trial;

pub use bulletin::Bulletin;
pub use controlled::{ControlSummary, Controlled};
pub use desktop::{Desktop, Hands, KEYS};
pub use dump::Dump;
pub use energy::Energy;
pub use input::Input;
pub use measures::{BackendBeat, BeatSummary};
pub use recorder::Recorder;
pub use report::DriveReport;
pub use request::Request;
pub use run::{Desk, End, Plan, Played, run};
pub use screens::{Screens, Sink};
pub use sheet::Sheet;
pub use status::Status;
pub use supervisor::Supervisor;
pub use taped::{Remade, Taped};
pub use tracked::{Tracked, cast, one_hand};
pub use trial::Trial;
