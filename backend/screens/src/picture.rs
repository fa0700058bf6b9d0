//! A picture as a window shows it.

/// Codes of 8 bits, rows from the top, x fastest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels along x.
    pub width: u32,
    /// Pixels along y.
    pub height: u32,
    /// `3 · width · height` codes: red, green, blue.
    pub rgb: Vec<u8>,
}

impl Picture {
    /// A black one.
    pub fn black(width: u32, height: u32) -> Self {
        Self { width, height, rgb: vec![0; 3 * width as usize * height as usize] }
    }

    /// Where it is put in a window: by how much its pixels are enlarged, a whole number of times so that they stay what
    /// they are, and the window's pixel at its top left. One that is larger than its window loses its right and lower
    /// edge.
    fn place(&self, window: [u32; 2]) -> (u32, [u32; 2]) {
        let fits = |window: u32, picture: u32| window / picture.max(1);
        let scale = fits(window[0], self.width).min(fits(window[1], self.height)).max(1);
        let free = |window: u32, picture: u32| window.saturating_sub(scale * picture) / 2;
        (scale, [free(window[0], self.width), free(window[1], self.height)])
    }

    /// Fills a window's pixels: 0x00RRGGBB, black where the picture is not.
    pub(crate) fn fill(&self, window: [u32; 2], pixels: &mut [u32]) {
        let (scale, [left, top]) = self.place(window);
        pixels.fill(0);
        let rows = pixels.chunks_exact_mut(window[0].max(1) as usize).skip(top as usize);
        for (y, row) in rows.take((scale * self.height) as usize).enumerate() {
            let from = &self.rgb[3 * (y / scale as usize) * self.width as usize..];
            let places = row.iter_mut().skip(left as usize).take((scale * self.width) as usize);
            for (x, pixel) in places.enumerate() {
                let [r, g, b] = [0, 1, 2].map(|c| u32::from(from[3 * (x / scale as usize) + c]));
                *pixel = r << 16 | g << 8 | b;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PICTURE: [u32; 6] = [0x010203, 0x040506, 0x070809, 0x0a0b0c, 0x0d0e0f, 0x101112];

    fn picture() -> Picture {
        Picture { width: 3, height: 2, rgb: (1..=18).collect() }
    }

    fn filled(window: [u32; 2]) -> Vec<u32> {
        let mut pixels = vec![9; (window[0] * window[1]) as usize];
        picture().fill(window, &mut pixels);
        pixels
    }

    #[test]
    fn a_window_of_its_size_shows_its_very_codes() {
        assert_eq!(filled([3, 2]), PICTURE);
    }

    #[test]
    fn in_a_larger_window_its_pixels_are_squares_in_the_middle() {
        let pixels = filled([8, 5]);
        let at = |x: usize, y: usize| pixels[8 * y + x];
        assert_eq!([at(1, 0), at(2, 0), at(1, 1), at(2, 1)], [PICTURE[0]; 4]);
        assert_eq!([at(5, 2), at(6, 3), at(0, 0), at(7, 3), at(1, 4)], [PICTURE[5], PICTURE[5], 0, 0, 0]);
    }

    #[test]
    fn in_a_smaller_window_it_loses_an_edge() {
        assert_eq!(filled([2, 1]), PICTURE[..2]);
        assert!(filled([0, 0]).is_empty());
    }
}
