//! PNG: 8-bit sRGB over black.

use super::{OutputError, PictureRef, srgb_codes, write_atomically};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use std::io::Write;
use std::path::Path;

/// Writes a picture. Its colours are premultiplied, so over black they are what is shown; values above 1 clamp.
pub fn write_png(path: &Path, picture: PictureRef<'_>) -> Result<(), OutputError> {
    write_atomically(path, |file| {
        encode_png(file, picture).map_err(|reason| OutputError::encode(path, reason))
    })
}

/// Encodes a picture into any writer; the error is the encoder's sentence.
pub fn encode_png(into: impl Write, picture: PictureRef<'_>) -> Result<(), String> {
    let mut rgb = Vec::with_capacity(picture.rgba().len() / 4 * 3);
    for pixel in picture.rgba().chunks_exact(4) {
        rgb.extend_from_slice(&srgb_codes(pixel));
    }
    encode_codes(into, picture.width(), picture.height(), &rgb)
}

/// Writes a picture of codes, three to a pixel.
pub fn write_codes(path: &Path, width: u32, height: u32, rgb: &[u8]) -> Result<(), OutputError> {
    write_atomically(path, |file| {
        encode_codes(file, width, height, rgb).map_err(|reason| OutputError::encode(path, reason))
    })
}

fn encode_codes(into: impl Write, width: u32, height: u32, rgb: &[u8]) -> Result<(), String> {
    PngEncoder::new_with_quality(into, CompressionType::Fast, FilterType::Adaptive)
        .write_image(rgb, width, height, ExtendedColorType::Rgb8)
        .map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_comes_back_as_its_codes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let rgba = [0.0, 0.25, 1.0, 1.0, 3.0, -1.0, f32::NAN, 0.5];
        write_png(&path, PictureRef::new(2, 1, &rgba).unwrap()).unwrap();
        let back = image::open(&path).unwrap().to_rgb8();
        assert_eq!(back.get_pixel(0, 0).0, [0, 137, 255]);
        assert_eq!(back.get_pixel(1, 0).0, [255, 0, 0]);
    }
}
