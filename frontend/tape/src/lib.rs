//! Everything that reached a world, on disk, as MCAP.
//!
//! The same tape gives the same frames again. Tools that know MCAP read it as well: its messages are JSON with schemas.
//!
//! | file | what it is |
//! | --- | --- |
//! | `head` | what a tape says of itself, and the files that go with it |
//! | `record` | what a tape holds, one after the other |
//! | `channels` | where each record stands in the file, and how it is written |
//! | `writer`, `part`, `names` | tapes that are written while a show goes on |
//! | `reader`, `flattened`, `records`, `fields` | tapes that are read, down to the lengths that they claim |
//! | `cut`, `export`, `info` | parts of tapes, tables of them, and what is on them |

mod channels;
mod cut;
mod error;
mod export;
mod fields;
mod flattened;
mod head;
mod info;
mod names;
mod part;
mod reader;
mod record;
mod records;
mod writer;

pub use cut::cut;
pub use error::TapeError;
pub use export::{Format, export};
pub use head::{AttachedFile, Head};
pub use info::{Ending, Info, info};
pub use reader::Tape;
pub use record::{Frame, Record, Said};
pub use writer::{Limits, Writer};
