//! A picture as screens show it: 8-bit sRGB over black.

use crate::output::srgb_code;
use protocol::{ProjectorImage, ScreenImage};
use rayon::prelude::*;

/// The codes that a picture is shown with; as PNG files have them.
pub fn screen_image(image: &ProjectorImage) -> ScreenImage {
    let mut rgb = vec![0; image.rgba.len() / 4 * 3];
    let row = image.width.max(1) as usize;
    rgb.par_chunks_mut(3 * row).zip(image.rgba.par_chunks(4 * row)).for_each(|(codes, colours)| {
        for (code, colour) in codes.chunks_exact_mut(3).zip(colours.chunks_exact(4)) {
            code.copy_from_slice(&[srgb_code(colour[0]), srgb_code(colour[1]), srgb_code(colour[2])]);
        }
    });
    ScreenImage { projector: image.projector, width: image.width, height: image.height, rgb }
}
