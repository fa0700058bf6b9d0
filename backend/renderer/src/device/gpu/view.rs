//! What the GPU keeps of one view's picture.

use super::arena::{Arena, Room};
use super::context::Context;
use super::storage::{Storage, Stretch};

/// Its place among the pictures, and what is shown of it.
#[derive(Debug)]
pub(super) struct ViewBuffers {
    /// None before it is first cast.
    pub(super) room: Option<Room>,
    /// What is shown of it.
    pub(super) shown: Storage,
    /// Whether any of that is behind the picture.
    pub(super) behind: Storage,
    /// Width and height of the picture, pixels.
    pub(super) raster: [u32; 2],
}

impl ViewBuffers {
    pub(super) fn new(context: &Context) -> Self {
        Self {
            room: None,
            shown: Storage::new(context, "shown pixels"),
            behind: Storage::new(context, "whether a picture is behind"),
            raster: [0, 0],
        }
    }

    /// Pixels of its picture.
    pub(super) fn pixel_count(&self) -> u64 {
        u64::from(self.raster[0]) * u64::from(self.raster[1])
    }

    /// The colours of what was cast.
    pub(super) fn cast_colours<'a>(&self, arenas: &'a [Arena]) -> Stretch<'a> {
        let room = self.room.expect("only pictures that were cast are looked at");
        arenas[room.arena].colours(&room, self.pixel_count())
    }
}
