//! VRPN: trackers, buttons and analog devices of a server (version 07 of its protocol).

mod link;
mod session;
pub mod wire;

pub(crate) use link::Client;
pub use session::Session;
