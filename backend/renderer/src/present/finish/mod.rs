//! From the picture of one projector to its codes: warp, blend, black level, transfer curve, dither; each left out where it
//! is the identity.

mod black;
mod blend;
mod dither;
mod spread;
mod transfer;
mod warp;

use black::Black;
use blend::Blend;
use display_config::Projector;
use rayon::prelude::*;
use transfer::Curve;
use warp::Warp;

/// The stages of one projector, with tables for its pixels.
pub struct Finisher {
    size: [usize; 2],
    warp: Option<Warp>,
    blend: Option<Blend>,
    black: Option<Black>,
    curve: Curve,
}

/// The stages as tables for a kernel, rows from the top.
#[cfg(feature = "gpu")]
pub struct FinishTables<'a> {
    /// Where each pixel takes its light from, pixels.
    pub places: Option<&'a [[f32; 2]]>,
    /// The factor of each pixel's light.
    pub blend: Option<&'a [f32]>,
    /// The black level of each pixel.
    pub black: Option<&'a [f32]>,
    /// That of all pixels, where there is no other.
    pub black_level: [f32; 3],
    /// The transfer curves: see [`layout::binding::CURVES`].
    pub curves: Vec<f32>,
    /// Whether codes are dithered.
    pub is_dithered: bool,
}

impl Finisher {
    /// The stages that the display file asks for. Tables take up to 12 bytes a pixel.
    pub fn new(projector: &Projector) -> Self {
        let (raster, finish) = (&projector.raster, &projector.finish);
        let size = [raster.width as usize, raster.height as usize];
        Self {
            size,
            warp: finish.mesh.as_ref().map(|mesh| Warp::new(mesh, raster)),
            blend: finish.blend.as_ref().map(|map| Blend::new(map, size)),
            black: finish.black.as_ref().map(|black| Black::new(black, size)),
            curve: Curve::new(&finish.transfer, finish.is_dithered),
        }
    }

    /// What a kernel needs to do the same.
    #[cfg(feature = "gpu")]
    pub fn tables(&self) -> FinishTables<'_> {
        let (level, black) = match &self.black {
            None => ([0.0; 3], None),
            Some(Black::Level(level)) => (*level, None),
            Some(Black::Map(map)) => ([0.0; 3], Some(&map[..])),
        };
        FinishTables {
            places: self.warp.as_ref().map(|warp| &warp.places[..]),
            blend: self.blend.as_ref().map(|blend| &blend.factors[..]),
            black,
            black_level: level,
            curves: self.curve.numbers(),
            is_dithered: self.curve.is_dithered(),
        }
    }

    /// The codes of a picture: linear colours, four to a pixel, become three codes. A pixel that the picture lacks is black.
    pub fn codes(&self, rgba: &[f32]) -> Vec<u8> {
        let [width, height] = self.size;
        let mut rgb = vec![0; 3 * width * height];
        // Most of a picture is black.
        let black = self.curve.of_black();
        rgb.par_chunks_mut(3 * width.max(1)).enumerate().for_each(|(y, row)| {
            for (x, codes) in row.chunks_exact_mut(3).enumerate() {
                let light = self.light(rgba, x, y);
                let known = black.filter(|_| light == [0.0; 3]);
                codes.copy_from_slice(&known.unwrap_or_else(|| self.curve.codes(light, [x, y])));
            }
        });
        rgb
    }

    /// The linear light of a pixel.
    fn light(&self, rgba: &[f32], x: usize, y: usize) -> [f32; 3] {
        let at = y * self.size[0] + x;
        let seen = match &self.warp {
            Some(warp) => warp.colour(rgba, self.size, at),
            None => rgba.get(4 * at..4 * at + 3).map_or([0.0; 3], |rgb| [rgb[0], rgb[1], rgb[2]]),
        };
        // A projector's white is white also where it is one of several. Not `clamp`: it hands NaN on, while this comparison
        // sends it to black.
        let mut light = seen.map(|channel| if channel > 0.0 { channel.min(1.0) } else { 0.0 });
        if let Some(blend) = &self.blend {
            light = blend.apply(light, at);
        }
        match &self.black {
            Some(black) => black.apply(light, at),
            None => light,
        }
    }
}

#[cfg(test)]
mod tests;
