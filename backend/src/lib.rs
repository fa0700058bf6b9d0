//! The renderer: volume store, working set, devices, reference integrator, outputs, exports, protocol and transports.

pub mod device;
pub mod export;
pub mod output;
pub mod protocol;
pub mod reference;
pub mod render;
pub mod store;
mod temporary;
pub mod transport;
pub mod volume;
pub mod working_set;
