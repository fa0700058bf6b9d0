//! What shows pictures to people.

use crate::ScreenImage;
use display_config::Turn;
use glam::UVec2;
use std::any::Any;
use std::fmt;
use std::sync::Arc;

/// Why nothing can be shown any more: one sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct WallError(pub String);

/// The codes of a picture where its renderer made them: in the memory of a device.
#[derive(Clone)]
pub struct DeviceCodes {
    /// Index of the projector in the display.
    pub projector: u32,
    /// What only the renderer's own swapchains can read.
    pub codes: Arc<dyn Any + Send + Sync>,
}

impl fmt::Debug for DeviceCodes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DeviceCodes").field("projector", &self.projector).finish_non_exhaustive()
    }
}

/// A picture of a projector as codes, wherever these are.
#[derive(Clone, Debug)]
pub enum ScreenPicture {
    /// In main memory.
    Host(ScreenImage),
    /// In a device's memory.
    Device(DeviceCodes),
}

impl ScreenPicture {
    /// It, where it is in main memory.
    pub fn on_host(&self) -> Option<&ScreenImage> {
        match self {
            Self::Host(image) => Some(image),
            Self::Device(_) => None,
        }
    }

    /// It, where it is in a device's memory.
    pub fn on_device(&self) -> Option<&DeviceCodes> {
        match self {
            Self::Host(_) => None,
            Self::Device(codes) => Some(codes),
        }
    }
}

/// A picture in a window.
#[derive(Clone, Debug)]
pub struct PaintedPart {
    /// Its codes.
    pub codes: DeviceCodes,
    /// The window's pixel at its top left.
    pub first_px: UVec2,
    /// Pixels of the window that it may take from there; beyond them it is cut.
    pub room: UVec2,
    /// How it lies there.
    pub turn: Turn,
}

/// A window that a renderer's device paints.
pub trait Canvas: Send {
    /// Paints what is to be shown next, out of sight: these parts, and black elsewhere.
    ///
    /// # Errors
    /// The window cannot be painted any more, or the codes are another device's.
    fn ready(&mut self, parts: &[PaintedPart]) -> Result<(), WallError>;

    /// Shows what is painted, with the next refresh of the output. Whether there was anything to show.
    fn show(&mut self) -> bool;
}

/// The windows of a back-end, on the outputs of its projectors.
pub trait Wall: Send {
    /// Whether its windows are painted from the renderer's device, so that it takes [`ScreenPicture::Device`] and nothing else;
    /// otherwise it takes [`ScreenPicture::Host`].
    fn is_painted(&self) -> bool {
        false
    }

    /// Readies the pictures of the frame to be shown next, out of sight. A projector without one keeps what it shows.
    ///
    /// # Errors
    /// Nothing can be shown any more.
    fn ready(&mut self, pictures: &[ScreenPicture]) -> Result<(), WallError>;

    /// Shows what is ready, in all windows at once, and returns when the window system has done so.
    ///
    /// # Errors
    /// Nothing can be shown any more.
    fn show(&mut self) -> Result<(), WallError>;

    /// Looks after the windows: says in sentences what has happened to them and to their outputs.
    ///
    /// # Errors
    /// Nothing can be shown any more.
    fn tend(&mut self) -> Result<Vec<String>, WallError>;
}
