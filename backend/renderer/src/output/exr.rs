//! OpenEXR: the linear numbers as they are.

use super::{OutputError, PictureRef, write_atomically};
use exr::prelude::{Encoding, Image, Layer, LayerAttributes, SpecificChannels, WritableImage};
use std::path::Path;

/// Writes the four f32 channels of a picture, losslessly; premultiplied, as OpenEXR expects.
pub fn write_exr(path: &Path, picture: PictureRef<'_>) -> Result<(), OutputError> {
    let size = (picture.width() as usize, picture.height() as usize);
    let pixel = |at: exr::math::Vec2<usize>| {
        let [r, g, b, a] = picture.pixel(at.x(), at.y());
        (r, g, b, a)
    };
    let channels = SpecificChannels::rgba(pixel);
    let image = Image::from_layer(Layer::new(
        size,
        LayerAttributes::named("lightloom"),
        Encoding::SMALL_FAST_LOSSLESS,
        channels,
    ));
    write_atomically(path, |file| {
        image.write().non_parallel().to_buffered(file).map_err(|e| OutputError::encode(path, e))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::read_first_rgba_layer_from_file;

    #[test]
    fn every_bit_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let rgba: Vec<f32> = (0..4 * 5 * 3).map(|i| 1e-7 * (i as f32).exp2()).collect();
        write_exr(&path, PictureRef::new(5, 3, &rgba).unwrap()).unwrap();
        let image = read_first_rgba_layer_from_file(
            &path,
            |size, _| vec![0.0f32; 4 * size.area()],
            |pixels, at, (r, g, b, a): (f32, f32, f32, f32)| {
                let i = 4 * (at.y() * 5 + at.x());
                pixels[i..i + 4].copy_from_slice(&[r, g, b, a]);
            },
        )
        .unwrap();
        assert_eq!(image.layer_data.channel_data.pixels, rgba);
    }
}
