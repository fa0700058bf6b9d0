//! A map spread over a raster of another size.

use display_config::LightMap;
use rayon::prelude::*;

/// The map's share at each pixel, from 0 to 1: both lie edge to edge; bilinear between the centres of the map's own pixels,
/// constant in the outer half of those at its rim.
pub(super) fn spread(map: &LightMap, [width, height]: [usize; 2]) -> Vec<f32> {
    let [map_width, map_height] = map.size().map(|along| along as usize);
    let share = |x: usize, y: usize| f32::from(map.shares()[y * map_width + x]) / f32::from(u16::MAX);
    let columns: Vec<_> = (0..width).map(|x| neighbours(x, width, map_width)).collect();
    let mut spread = vec![0.0; width * height];
    spread.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, row)| {
        let (top, bottom, down) = neighbours(y, height, map_height);
        for (into, &(left, right, across)) in row.iter_mut().zip(&columns) {
            let along = |y| share(left, y) * (1.0 - across) + share(right, y) * across;
            *into = along(top) * (1.0 - down) + along(bottom) * down;
        }
    });
    spread
}

/// The two pixels of a map around the centre of a raster's pixel, and the part of the second.
fn neighbours(pixel: usize, count: usize, map_count: usize) -> (usize, usize, f32) {
    let place = (pixel as f64 + 0.5) / count as f64 * map_count as f64 - 0.5;
    let place = place.clamp(0.0, (map_count - 1) as f64);
    let first = place as usize;
    (first, (first + 1).min(map_count - 1), (place - first as f64) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_of_the_raster_s_size_is_itself_and_another_is_interpolated() {
        let map = LightMap::new(2, 2, vec![0, 65535, 13107, 65535]).unwrap();
        assert_eq!(spread(&map, [2, 2]), [0.0, 1.0, 0.2, 1.0]);
        let wide = spread(&map, [4, 1]);
        let expected = [0.1, 0.325, 0.775, 1.0];
        assert!(
            wide.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-6),
            "{wide:?}"
        );
        let one = LightMap::new(1, 1, vec![65535]).unwrap();
        assert_eq!(spread(&one, [3, 2]), [1.0; 6]);
    }
}
