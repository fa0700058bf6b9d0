//! What arrives from inputs, and how well.
//!
//! | file | what it is |
//! | --- | --- |
//! | `channel` | the counts of one sensor, button or axis |
//! | `meter` | those of all sources |
//! | `table` | the same as lines of text |

mod channel;
mod meter;
mod table;

pub use channel::{Channel, ChannelReport};
pub use meter::{InputsReport, Meter, SourceReport};
pub use table::table;
