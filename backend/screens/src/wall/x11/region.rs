//! Which outputs share a window.

use crate::Rectangle;

/// A part of the desktop that a window covers: one output, or several side by side.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Region {
    /// Where it is.
    pub place: Rectangle,
    /// Which outputs, by their numbers.
    pub heads: Vec<usize>,
}

impl Region {
    /// That of one output.
    pub fn of(head: usize, place: Rectangle) -> Self {
        Self { place, heads: vec![head] }
    }

    /// Both as one, where they are a rectangle together.
    fn joined(&self, other: &Self) -> Option<Self> {
        let (a, b) = (self.place, other.place);
        let right = i32::from(a.x) + i32::from(a.width) == i32::from(b.x);
        let below = i32::from(a.y) + i32::from(a.height) == i32::from(b.y);
        let place = if right && (a.y, a.height) == (b.y, b.height) {
            Rectangle { width: a.width.checked_add(b.width)?, ..a }
        } else if below && (a.x, a.width) == (b.x, b.width) {
            Rectangle { height: a.height.checked_add(b.height)?, ..a }
        } else {
            return None;
        };
        Some(Self { place, heads: [&self.heads[..], &other.heads].concat() })
    }
}

/// As few as there can be of edges up to `longest` pixels: neighbours are joined as long as any two are a rectangle together.
pub fn join(mut regions: Vec<Region>, longest: u32) -> Vec<Region> {
    let fits = |region: &Region| u32::from(region.place.width.max(region.place.height)) <= longest;
    loop {
        let pairs = (0..regions.len()).flat_map(|a| (0..regions.len()).map(move |b| (a, b)));
        let found = pairs
            .filter(|(a, b)| a != b)
            .find_map(|(a, b)| Some((a, b, regions[a].joined(&regions[b]).filter(fits)?)));
        let Some((a, b, joined)) = found else { return regions };
        regions[a] = joined;
        regions.remove(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NO_LIMIT: u32 = u32::MAX;

    fn regions(places: &[[i16; 4]]) -> Vec<Region> {
        let place = |&[x, y, width, height]: &[i16; 4]| Rectangle {
            x,
            y,
            width: width.unsigned_abs(),
            height: height.unsigned_abs(),
        };
        places.iter().enumerate().map(|(head, at)| Region::of(head, place(at))).collect()
    }

    fn heads(regions: &[Region]) -> Vec<Vec<usize>> {
        let sorted = |region: &Region| {
            let mut heads = region.heads.clone();
            heads.sort_unstable();
            heads
        };
        regions.iter().map(sorted).collect()
    }

    #[test]
    fn outputs_side_by_side_are_one_region_in_whatever_order() {
        let row = regions(&[[1600, 0, 800, 600], [0, 0, 800, 600], [800, 0, 800, 600]]);
        let joined = join(row, NO_LIMIT);
        assert_eq!(heads(&joined), [[0, 1, 2]]);
        assert_eq!(joined[0].place, Rectangle { x: 0, y: 0, width: 2400, height: 600 });
        let square = [[0, 0, 800, 600], [800, 0, 800, 600], [0, 600, 800, 600], [800, 600, 800, 600]];
        assert_eq!(heads(&join(regions(&square), NO_LIMIT)), [[0, 1, 2, 3]]);
    }

    #[test]
    fn what_is_no_rectangle_together_stays_apart() {
        let gap = regions(&[[0, 0, 800, 600], [801, 0, 800, 600]]);
        assert_eq!(join(gap.clone(), NO_LIMIT), gap);
        let heights = regions(&[[0, 0, 800, 600], [800, 0, 1024, 768]]);
        assert_eq!(join(heights.clone(), NO_LIMIT), heights);
        let mirrored = regions(&[[0, 0, 800, 600], [0, 0, 800, 600]]);
        assert_eq!(join(mirrored.clone(), NO_LIMIT), mirrored);
    }

    #[test]
    fn no_region_is_longer_than_can_be_painted() {
        let row: Vec<[i16; 4]> = (0..4).map(|head| [4096 * head, 0, 4096, 2160]).collect();
        let halves = join(regions(&row), 8192);
        assert_eq!(heads(&halves), [[0, 1], [2, 3]]);
    }
}
