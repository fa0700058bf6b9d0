//! How much rays see changed, told from a few of them all over a picture.

use super::whole;
use twin::Lattice;

/// The colours of a picture at the pixels of a lattice, row by row; red, green and blue.
pub fn sparse(rgba: &[f32], [width, height]: [u32; 2], lattice: Lattice) -> Vec<[f32; 3]> {
    let along = |axis: usize, pixels: u32| (lattice.first[axis]..pixels).step_by(lattice.step[axis] as usize);
    let pixel = move |(x, y): (u32, u32)| {
        let at = 4 * (y as usize * width as usize + x as usize);
        [rgba[at], rgba[at + 1], rgba[at + 2]]
    };
    along(1, height).flat_map(|y| along(0, width).map(move |x| (x, y))).map(pixel).collect()
}

/// The sum over such colours of how far each is from what it was, in [`super::ERROR_UNIT`]s.
pub fn change_at(now: &[[f32; 3]], before: &[[f32; 3]]) -> u64 {
    let distance = |(a, b): (&[f32; 3], &[f32; 3])| {
        whole((0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f32>().sqrt())
    };
    now.iter().zip(before).map(distance).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::refine::ERROR_UNIT;

    #[test]
    fn pixels_of_a_lattice_are_compared() {
        let size = [5, 3];
        let lattice = Lattice { step: [2, 2], first: [0, 0] };
        let picture: Vec<f32> = (0..60).map(|i| i as f32).collect();
        let seen = sparse(&picture, size, lattice);
        assert_eq!(seen.iter().map(|pixel| pixel[0]).collect::<Vec<_>>(), [0.0, 8.0, 16.0, 40.0, 48.0, 56.0]);
        let mut other = seen.clone();
        other[2] = [16.0 + 0.3, 17.0, 18.0 - 0.4];
        assert!((change_at(&other, &seen) as f64 * ERROR_UNIT - 0.5).abs() < 1e-5);
        assert_eq!(change_at(&seen, &seen), 0);
    }
}
