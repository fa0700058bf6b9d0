//! Marks in what is shown of a picture.

use layout::present::{Layer, MarkedPixel};

/// What is laid into the pixels of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    /// The pixels that have any, by their place.
    pixels: Vec<MarkedPixel>,
    /// All layers, those of a pixel one after the other.
    layers: Vec<Layer>,
}

impl Layers {
    /// Lays one more over what is there. Pixels come one after the other.
    pub fn push(&mut self, pixel: u32, layer: Layer) {
        match self.pixels.last_mut() {
            Some(last) if last.pixel == pixel => last.count += 1,
            _ => self.pixels.push(MarkedPixel { pixel, first: self.layers.len() as u32, count: 1 }),
        }
        self.layers.push(layer);
    }

    /// Whether nothing is laid.
    pub fn is_empty(&self) -> bool {
        self.layers.is_empty()
    }

    /// The pixels.
    pub fn pixels(&self) -> &[MarkedPixel] {
        &self.pixels
    }

    /// The layers of all of them.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// Lays them into a picture: linear colours, premultiplied by their opacity, 4 numbers per pixel.
    ///
    /// With an opaque layer the pixel is what its ray meets before it, over the layer; with one of opacity a, the mean of this and of
    /// what the pixel was, with weight a. That is what the ray sees if the layer is one more thing on its way.
    pub fn lay_into(&self, rgba: &mut [f32]) {
        for of in &self.pixels {
            let pixel = &mut rgba[4 * of.pixel as usize..][..4];
            for Layer { before, rgb: [r, g, b], opacity } in
                &self.layers[of.first as usize..][..of.count as usize]
            {
                let seen = 1.0 - before[3];
                let backed = [r, g, b, &1.0].into_iter().zip(before).map(|(own, before)| before + seen * own);
                pixel.iter_mut().zip(backed).for_each(|(part, backed)| {
                    *part = (1.0 - opacity) * *part + opacity * backed;
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOTHING: [f32; 4] = [0.0; 4];

    #[test]
    fn an_opaque_layer_backs_what_is_before_it() {
        let mut layers = Layers::default();
        layers.push(1, Layer { before: [0.25, 0.0, 0.0, 0.5], rgb: [0.0, 1.0, 0.0], opacity: 1.0 });
        let mut rgba = [0.9; 8];
        layers.lay_into(&mut rgba);
        assert_eq!(rgba, [0.9, 0.9, 0.9, 0.9, 0.25, 0.5, 0.0, 1.0]);
    }

    #[test]
    fn layers_go_one_over_the_other_and_a_clear_one_changes_nothing() {
        let mut layers = Layers::default();
        layers.push(0, Layer { before: NOTHING, rgb: [1.0, 0.0, 0.0], opacity: 0.5 });
        layers.push(0, Layer { before: NOTHING, rgb: [0.0, 0.0, 1.0], opacity: 0.25 });
        layers.push(0, Layer { before: [0.1; 4], rgb: [1.0; 3], opacity: 0.0 });
        assert_eq!((layers.pixels().len(), layers.layers().len()), (1, 3));
        let mut rgba = [0.0, 0.4, 0.0, 0.4];
        layers.lay_into(&mut rgba);
        let expected = [0.375, 0.15, 0.25, 0.775];
        assert!(rgba.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6_f32), "{rgba:?}");
    }
}
