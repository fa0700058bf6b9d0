//! A picture as the screen of a projector is sent it: 8-bit codes.

use super::Finisher;
use protocol::ScreenImage;

/// The codes that the picture of a projector is shown with; as PNG files have them where its finish is the identity.
pub fn screen_image(
    projector: u32,
    [width, height]: [u32; 2],
    rgba: &[f32],
    finisher: &Finisher,
) -> ScreenImage {
    ScreenImage { projector, width, height, rgb: finisher.codes(rgba) }
}
