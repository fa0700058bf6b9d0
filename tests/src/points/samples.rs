//! A pattern scaled into the tiles of a level, as rays of a picture.
//!
//! Level l has 2^l × 2^l tiles, each the whole pattern; beyond a tile its neighbours' samples are its own, moved by a tile.
//! Rays go through the middles of a raster that is some times as fine as the picture's, those nearest to the samples; the
//! samples count as lying there.

use super::Pattern;

/// Channels of a pixel: red, green, blue, opacity.
pub const CHANNELS: usize = 4;

/// The rays of a level.
#[derive(Clone, Debug)]
pub struct Samples {
    size: [u32; 2],
    /// How many times as fine the raster of rays is.
    parts: u32,
    depth: u32,
    per_tile: usize,
    /// Column and row of each ray in the fine raster, tile by tile.
    rays: Vec<[u32; 2]>,
    /// Of each pixel, where the rays in it begin in `order`; one more at the end.
    starts: Vec<u32>,
    order: Vec<u32>,
}

impl Samples {
    /// Of a picture of pixels along x and y, at a level.
    pub fn new(pattern: &Pattern, size: [u32; 2], parts: u32, depth: u32) -> Self {
        let across = 1 << depth;
        let tiles = (0..across).flat_map(|row| (0..across).map(move |column| [column, row]));
        let ray = |tile: [u32; 2], place: &[u32; 2]| {
            std::array::from_fn(|i| {
                // Tiles × 2³² steps span the fine raster.
                let along = (u64::from(tile[i]) << 32) + u64::from(place[i]);
                ((u128::from(along) * u128::from(size[i] * parts)) >> (32 + depth)) as u32
            })
        };
        let rays: Vec<[u32; 2]> =
            tiles.flat_map(|tile| pattern.places().iter().map(move |place| ray(tile, place))).collect();
        let mut samples = Self {
            size,
            parts,
            depth,
            per_tile: pattern.places().len(),
            rays,
            starts: Vec::new(),
            order: Vec::new(),
        };
        samples.sort();
        samples
    }

    fn sort(&mut self) {
        let pixel_of = |ray: &[u32; 2]| {
            (ray[1] / self.parts) as usize * self.size[0] as usize + (ray[0] / self.parts) as usize
        };
        self.order = (0..self.rays.len() as u32).collect();
        self.order.sort_by_key(|&ray| pixel_of(&self.rays[ray as usize]));
        self.starts = vec![0; self.size[0] as usize * self.size[1] as usize + 1];
        self.rays.iter().for_each(|ray| self.starts[pixel_of(ray) + 1] += 1);
        (1..self.starts.len()).for_each(|pixel| self.starts[pixel] += self.starts[pixel - 1]);
    }

    /// Pixels of the picture along x and y.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Its number, from 0.
    pub fn depth(&self) -> u32 {
        self.depth
    }

    /// Rays.
    pub fn count(&self) -> usize {
        self.rays.len()
    }

    /// Tiles along each axis.
    pub fn across(&self) -> u32 {
        1 << self.depth
    }

    /// The tile that casts a ray.
    pub fn tile_of_ray(&self, ray: u32) -> u32 {
        (ray as usize / self.per_tile) as u32
    }

    /// The tile in which the middle of a pixel lies.
    pub fn tile_of_pixel(&self, pixel: [u32; 2]) -> u32 {
        let [x, y] = [0, 1].map(|i| (2 * pixel[i] + 1) * self.across() / (2 * self.size[i]));
        y * self.across() + x
    }

    /// The distance between samples, pixels, were they a square lattice.
    pub fn spacing(&self) -> f64 {
        (f64::from(self.size[0] * self.size[1]) / self.rays.len() as f64).sqrt()
    }

    /// What its rays find, of a complete picture of the fine raster.
    ///
    /// # Panics
    /// If the picture is not of that raster.
    pub fn cast(&self, fine: &[f32]) -> Vec<[f32; CHANNELS]> {
        let width = (self.size[0] * self.parts) as usize;
        assert_eq!(fine.len(), CHANNELS * width * (self.size[1] * self.parts) as usize, "of the fine raster");
        let found = |&[x, y]: &[u32; 2]| {
            let at = CHANNELS * (y as usize * width + x as usize);
            std::array::from_fn(|i| fine[at + i])
        };
        self.rays.iter().map(found).collect()
    }

    /// The distance from the middle of a pixel within which so many samples lie, periodic copies beyond the rim included.
    pub fn reach(&self, pixel: [u32; 2], count: usize) -> f64 {
        let mut distance = self.spacing() * (0.6 + 0.6 * (count as f64).sqrt());
        loop {
            let mut squares = Vec::new();
            self.visit(pixel, distance, true, &mut |_, square| squares.push(square));
            if squares.len() >= count {
                squares.sort_unstable_by(f64::total_cmp);
                return squares[count - 1].sqrt();
            }
            distance *= 1.5;
        }
    }

    /// Gives `each` the rays inside the picture within a distance of the middle of a pixel, with its square.
    pub fn around(&self, pixel: [u32; 2], distance: f64, each: &mut dyn FnMut(u32, f64)) {
        self.visit(pixel, distance, false, each);
    }

    fn visit(&self, pixel: [u32; 2], distance: f64, wraps: bool, each: &mut dyn FnMut(u32, f64)) {
        let reach = distance.ceil() as i64;
        let sizes = self.size.map(i64::from);
        let [x, y] = pixel.map(i64::from);
        for row in y - reach..=y + reach {
            for column in x - reach..=x + reach {
                let is_inside = (0..sizes[0]).contains(&column) && (0..sizes[1]).contains(&row);
                if !is_inside && !wraps {
                    continue;
                }
                // How far a copy is moved; what lies inside is not.
                let copy = [column - column.rem_euclid(sizes[0]), row - row.rem_euclid(sizes[1])];
                let at = ((row - copy[1]) * sizes[0] + column - copy[0]) as usize;
                for &ray in &self.order[self.starts[at] as usize..self.starts[at + 1] as usize] {
                    let square = self.square(ray, [x - copy[0], y - copy[1]]);
                    if square <= distance * distance {
                        each(ray, square);
                    }
                }
            }
        }
    }

    /// The square of the distance of a ray from the middle of a pixel, pixels.
    fn square(&self, ray: u32, pixel: [i64; 2]) -> f64 {
        let along = |i: usize| {
            let place = f64::from(2 * self.rays[ray as usize][i] + 1) / f64::from(2 * self.parts);
            place - (pixel[i] as f64 + 0.5)
        };
        along(0) * along(0) + along(1) * along(1)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Torus;
    use super::*;

    const SIZE: [u32; 2] = [40, 30];
    const PARTS: u32 = 5;

    fn samples(depth: u32) -> Samples {
        Samples::new(&Pattern::white(Torus { edges: [4, 3] }, 12, 1), SIZE, PARTS, depth)
    }

    #[test]
    fn each_tile_is_the_pattern_and_casts_its_own() {
        for depth in 0..4 {
            let samples = samples(depth);
            assert_eq!(samples.count(), 12 << (2 * depth));
            for ray in 0..samples.count() as u32 {
                let pixel = samples.rays[ray as usize].map(|along| along / PARTS);
                assert!(pixel[0] < SIZE[0] && pixel[1] < SIZE[1]);
                let (tile, own) = (samples.tile_of_pixel(pixel), samples.tile_of_ray(ray));
                // The pixel may lie across a border; the ray does not.
                let apart = |tile: u32| [tile % samples.across(), tile / samples.across()];
                let ([x, y], [own_x, own_y]) = (apart(tile), apart(own));
                assert!(x.abs_diff(own_x) <= 1 && y.abs_diff(own_y) <= 1, "{depth}: {ray}");
            }
        }
        // At level 1 of 200 × 150 places, the next tile's are 100 further.
        let of = samples(1);
        assert_eq!(of.rays[12], [of.rays[0][0] + 100, of.rays[0][1]]);
    }

    #[test]
    fn rays_find_the_pixels_of_the_fine_raster() {
        let fine: Vec<f32> = (0..200 * 150).flat_map(|at| [at as f32; 4]).collect();
        let samples = samples(0);
        for (found, [x, y]) in samples.cast(&fine).iter().zip(&samples.rays) {
            assert_eq!(found, &[(200 * y + x) as f32; 4]);
        }
    }

    #[test]
    fn what_is_around_is_what_all_rays_say() {
        let samples = samples(1);
        for pixel in [[0, 0], [20, 15], [39, 29], [3, 28]] {
            for distance in [2.0, 9.5] {
                let mut found = Vec::new();
                samples.around(pixel, distance, &mut |ray, _| found.push(ray));
                found.sort_unstable();
                let is_near = |&ray: &u32| samples.square(ray, pixel.map(i64::from)) <= distance * distance;
                assert_eq!(found, (0..48).filter(is_near).collect::<Vec<_>>());
            }
            let reach = samples.reach(pixel, 3);
            let mut found = 0;
            samples.visit(pixel, reach + 1e-6, true, &mut |_, _| found += 1);
            assert!(found >= 3);
            let mut fewer = 0;
            samples.visit(pixel, reach - 1e-6, true, &mut |_, _| fewer += 1);
            assert!(fewer < 3);
        }
    }
}
