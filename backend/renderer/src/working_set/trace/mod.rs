//! Recorded sequences of frames: what rays asked for in each, to compare policies without casting a ray.
//!
//! A trace records the demand, not the feedback on one cut: which regions rays sampled, and at which level. So a replay
//! can map it onto the cut that its own policy has made.
//!
//! The file has one JSON object per line. The first is a [`TraceHeader`]; each further one is a frame.

mod demand;
mod error;
mod feedback;
mod reader;
mod record;
#[cfg(test)]
mod tests;
mod writer;

pub use demand::{Demand, Demanded};
pub use error::TraceError;
pub use feedback::feedback_on;
pub use reader::TraceReader;
pub use record::{TraceHeader, TracedFrame};
pub use writer::TraceWriter;
