//! How well frames are controlled: recorded interaction, played to simulated machines by one rule after the other, against
//! what an eye should have seen at each instant.
//!
//! | file | what it is |
//! | --- | --- |
//! | `scenario` | an interaction: what rays see at each sixtieth of a second |
//! | `taped` | one that was recorded, also those that come with the program |
//! | `footage` | the complete pictures of one, of the projectors that an eye sees |
//! | `painter` | what a machine casts and shows of an instant |
//! | `machine` | a machine of some speed that plays it by a rule |
//! | `score` | what the eye is shown against what it should see |
//! | `setting`, `study` | what is tried, and which is best over all scenarios |
//! | `report`, `page`, `charts`, `write` | what is said of it |

mod charts;
mod footage;
mod machine;
mod page;
mod painter;
mod report;
mod scenario;
mod score;
mod setting;
mod study;
mod taped;
mod write;

pub use footage::Footage;
pub use machine::{Contender, Machine, Played, Tick, play, play_painted};
pub use painter::{Lattices, Painter};
pub use report::TuneReport;
pub use scenario::{Motion, RATE_HZ, Scenario};
pub use score::{Score, Scorer};
pub use setting::{Setting, Stage, badness, stage_of_chi, stage_of_rho, stage_of_theta};
pub use study::{Run, Study};
pub use taped::{SHIPPED, open_shipped, recorded};
pub use write::{TUNE_HTML, write};
