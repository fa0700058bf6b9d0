//! A picture as screens show it: 8-bit sRGB over black.

use crate::output::srgb_codes;
use protocol::ScreenImage;
use rayon::prelude::*;

/// The codes that the picture of a projector is shown with; as PNG files have them.
pub fn screen_image(projector: u32, [width, height]: [u32; 2], rgba: &[f32]) -> ScreenImage {
    let mut rgb = vec![0; rgba.len() / 4 * 3];
    let row = width.max(1) as usize;
    rgb.par_chunks_mut(3 * row).zip(rgba.par_chunks(4 * row)).for_each(|(codes, colours)| {
        for (code, colour) in codes.chunks_exact_mut(3).zip(colours.chunks_exact(4)) {
            code.copy_from_slice(&srgb_codes(colour));
        }
    });
    ScreenImage { projector, width, height, rgb }
}
