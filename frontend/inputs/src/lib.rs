//! What trackers, controllers and programs say, as events.
//!
//! Bytes become [`reading`]s in a parser that knows no socket; a thread of each source stamps them and keeps them in a queue
//! that is bounded; a [`Hub`] hands them out as [`Event`]s, on the clock of whoever asks.
//!
//! | file | what it is |
//! | --- | --- |
//! | `event` | what happens at a source |
//! | `reading`, `pose`, `refusal` | what a message says, or why it is not taken |
//! | `vrpn`, `dtrack`, `osc`, `opentrackio`, `freed`, `gamepad`, `spacemouse` | a parser for each protocol |
//! | `datagrams`, `records`, `vrpn/link` | the sockets and devices that messages come from |
//! | `script` | a path that is written down |
//! | `worker`, `outbox`, `state`, `queue`, `pause` | the thread of a source, and what waits between it and the hub |
//! | `hub` | all sources, asked at once |
//! | `input`, `file`, `calibration`, `error` | what sources there are and where, as files say |

mod bytes;
mod calibration;
mod datagrams;
pub mod dtrack;
mod error;
mod event;
mod file;
#[cfg(test)]
mod fixed_seed;
pub mod freed;
pub mod gamepad;
mod hub;
mod input;
pub mod opentrackio;
pub mod osc;
mod outbox;
mod pause;
mod pose;
mod queue;
mod readable;
pub mod reading;
mod records;
mod refusal;
mod script;
pub mod spacemouse;
mod state;
pub mod vrpn;
mod worker;

pub use calibration::transform_text;
pub use datagrams::Port;
pub use error::{InputError, Place};
pub use event::{DeviceTime, Event, SourceId, What};
pub use hub::Hub;
pub use input::{Input, Kind};
pub use outbox::Counts;
pub use refusal::Refusal;
pub use script::Script;
pub use tracking::Pose;
