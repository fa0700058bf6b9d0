//! Pixels as window systems take them.

use crate::ScreenError;
use display_config::Turn;
use glam::UVec2;
use protocol::ScreenImage;
use x11rb::protocol::xproto::{ImageOrder, Screen, Setup, VisualClass};

/// Red, green and blue of a pixel.
const MASKS: [u32; 3] = [0xff_0000, 0xff00, 0xff];

/// How a pixel is laid out: 32 bits, 8 for each colour. Every desktop of today has it so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Bits that count.
    pub depth: u8,
    /// Whether its bytes are blue, green, red; else they are the other way round, after one that is nothing.
    is_blue_first: bool,
}

impl Layout {
    /// Bytes are blue, green, red and nothing: XRGB8888 of Wayland, and X servers on most processors.
    pub const BLUE_FIRST: Self = Self { depth: 24, is_blue_first: true };

    /// That of a screen of an X server.
    ///
    /// # Errors
    /// It has another one.
    pub fn of(setup: &Setup, screen: &Screen) -> Result<Self, ScreenError> {
        let depth = screen.root_depth;
        let visuals = screen.allowed_depths.iter().flat_map(|allowed| &allowed.visuals);
        let is_plain = visuals.filter(|visual| visual.visual_id == screen.root_visual).any(|visual| {
            visual.class == VisualClass::TRUE_COLOR
                && [visual.red_mask, visual.green_mask, visual.blue_mask] == MASKS
        });
        let has_words = setup.pixmap_formats.iter().any(|f| f.depth == depth && f.bits_per_pixel == 32);
        match is_plain && has_words {
            true => Ok(Self { depth, is_blue_first: setup.image_byte_order == ImageOrder::LSB_FIRST }),
            false => Err(ScreenError::Server {
                what: "screen of 8 bits for each colour",
                advice: "start it with a depth of 24",
            }),
        }
    }

    /// A picture as it lies on its output: 4 bytes a pixel, by rows.
    pub fn bytes(self, image: &ScreenImage, turn: Turn) -> Vec<u8> {
        let picture = UVec2::new(image.width, image.height);
        let size = turn.size(picture);
        let mut bytes = Vec::with_capacity(4 * (size.x * size.y) as usize);
        let index = |x: i32, y: i32| 3 * (y as isize * picture.x as isize + x as isize);
        // A row of the output is a row or a column of the picture, in one direction or the other.
        let [right, _] = turn.steps();
        let step = index(right.x, right.y);
        for y in 0..size.y {
            let [x, y] = turn.source(UVec2::new(0, y), picture).as_ivec2().to_array();
            let first = index(x, y);
            bytes.extend((0..size.x as isize).flat_map(|x| {
                let at = (first + x * step) as usize;
                let [r, g, b] = [0, 1, 2].map(|c| image.rgb[at + c]);
                if self.is_blue_first { [b, g, r, 0] } else { [0, r, g, b] }
            }));
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_as_the_server_orders_them() {
        let image = ScreenImage { projector: 0, width: 2, height: 1, rgb: vec![1, 2, 3, 4, 5, 6] };
        let upright = Turn::default();
        let little = Layout::BLUE_FIRST;
        assert_eq!(little.bytes(&image, upright), [3, 2, 1, 0, 6, 5, 4, 0]);
        assert_eq!(
            Layout { is_blue_first: false, ..little }.bytes(&image, upright),
            [0, 1, 2, 3, 0, 4, 5, 6]
        );
        let mirrored = Turn { is_mirrored: true, quarters: 0 };
        assert_eq!(little.bytes(&image, mirrored), [6, 5, 4, 0, 3, 2, 1, 0]);
    }
}
