//! What a back-end has once it is set up.

use protocol::{DeviceInfo, Render, Wall};

/// What is opened for a setup.
pub struct Opened {
    /// What draws.
    pub renderer: Box<dyn Render>,
    /// What it draws with.
    pub device: DeviceInfo,
    /// What shows its pictures, where the setup asks for windows.
    pub wall: Option<Box<dyn Wall>>,
}

impl Opened {
    /// A renderer whose pictures go to the front-end, if anywhere.
    pub fn new(renderer: Box<dyn Render>, device: DeviceInfo) -> Self {
        Self { renderer, device, wall: None }
    }
}
