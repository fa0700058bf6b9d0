//! A picture in memory.

use super::OutputError;
use protocol::ProjectorImage;

/// A borrowed picture: linear RGB premultiplied by opacity, with that opacity; rows from the top, x fastest.
#[derive(Clone, Copy, Debug)]
pub struct PictureRef<'a> {
    width: u32,
    height: u32,
    rgba: &'a [f32],
}

impl<'a> PictureRef<'a> {
    /// Checks that there are `4 · width · height` numbers and at least one pixel.
    pub fn new(width: u32, height: u32, rgba: &'a [f32]) -> Result<Self, OutputError> {
        let needed = (width as usize).checked_mul(height as usize).and_then(|n| n.checked_mul(4));
        if needed != Some(rgba.len()) || rgba.is_empty() {
            return Err(OutputError::Size { width, height, numbers: rgba.len() });
        }
        Ok(Self { width, height, rgba })
    }

    /// The picture of a projector.
    pub fn of(image: &'a ProjectorImage) -> Result<Self, OutputError> {
        Self::new(image.width, image.height, &image.rgba)
    }

    /// Pixels along x.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Pixels along y.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All numbers.
    pub fn rgba(&self) -> &'a [f32] {
        self.rgba
    }

    /// The four numbers of pixel (x, y).
    pub fn pixel(&self, x: usize, y: usize) -> [f32; 4] {
        let at = 4 * (y * self.width as usize + x);
        [self.rgba[at], self.rgba[at + 1], self.rgba[at + 2], self.rgba[at + 3]]
    }
}

/// A picture that owns its numbers; see [`PictureRef`] for their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels along x.
    pub width: u32,
    /// Pixels along y.
    pub height: u32,
    /// `4 · width · height` numbers.
    pub rgba: Vec<f32>,
}

impl Picture {
    /// A view of it.
    pub fn view(&self) -> Result<PictureRef<'_>, OutputError> {
        PictureRef::new(self.width, self.height, &self.rgba)
    }
}
