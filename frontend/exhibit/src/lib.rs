//! What an exhibit is, as its file says, and what a supervisor reads of its day.
//!
//! | file | what it is |
//! | --- | --- |
//! | `exhibit` | an exhibit that has been read and checked |
//! | `raw` | the entries of its file |
//! | `read`, `parts` | from the text of the file to an exhibit, with all that is wrong with it |
//! | `fault` | something that is wrong |
//! | `log` | what happened, line by line, in files that do not grow |
//! | `status` | how it goes, in a file that is always whole |

mod exhibit;
mod fault;
mod log;
mod parts;
mod raw;
mod read;
mod status;

pub use exhibit::{Exhibit, ItemWish, Looks, MarkWish, PresetWish, TapeWish};
pub use fault::Fault;
pub use log::{Log, LogLimits, time_text};
pub use status::{InputStatus, State, Status, StatusFile};
