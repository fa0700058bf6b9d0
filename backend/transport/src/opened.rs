//! What a back-end draws with once it is set up.

use protocol::{DeviceInfo, Render};

/// An opened renderer and what it draws with.
pub type Opened = (Box<dyn Render>, DeviceInfo);
