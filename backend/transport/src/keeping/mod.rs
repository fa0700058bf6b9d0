//! A rank that never draws: it keeps a renderer as its child, and starts it again when it ends.
//!
//! | file | what it is |
//! | --- | --- |
//! | `keeper` | what the rank does: passes messages on, and sees to it that there is a renderer |
//! | `renderer` | its child: a process and the messages to and from it |
//! | `kept` | the child's own side |
//! | `stream` | messages over the socket between the two |

mod keeper;
pub mod kept;
mod renderer;
mod stream;

pub(crate) use keeper::{Keeper, Taken};
