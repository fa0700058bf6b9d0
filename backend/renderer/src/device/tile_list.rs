//! Lists of tiles: mostly all of a raster, seldom some.

use std::ops::Range;

/// Numbers of tiles, in an order. Neighbours that follow each other are one run, so that all tiles of a raster take no more
/// room than one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TileList {
    runs: Vec<Range<u32>>,
    len: usize,
}

impl TileList {
    /// The tiles from 0 to before `count`.
    pub fn all(count: u32) -> Self {
        let runs = Vec::from_iter((count > 0).then_some(0..count));
        Self { runs, len: count as usize }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Empties it.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Adds one at the end.
    pub fn push(&mut self, tile: u32) {
        self.push_run(tile..tile + 1);
    }

    fn push_run(&mut self, run: Range<u32>) {
        self.len += run.len();
        match self.runs.last_mut() {
            Some(last) if last.end == run.start => last.end = run.end,
            _ => self.runs.push(run),
        }
    }

    /// Each of them.
    pub fn iter(&self) -> impl Iterator<Item = u32> {
        self.runs.iter().cloned().flatten()
    }

    /// Runs of neighbours, none empty.
    pub fn runs(&self) -> &[Range<u32>] {
        &self.runs
    }

    /// Those at some places of the list.
    pub fn part(&self, places: Range<usize>) -> Self {
        let mut part = Self::default();
        let mut first = 0;
        for run in &self.runs {
            let within = |place: usize| run.start + place.saturating_sub(first).min(run.len()) as u32;
            let (from, to) = (within(places.start), within(places.end));
            if from < to {
                part.push_run(from..to);
            }
            first += run.len();
            if first >= places.end {
                break;
            }
        }
        part
    }
}

impl FromIterator<u32> for TileList {
    fn from_iter<I: IntoIterator<Item = u32>>(tiles: I) -> Self {
        let mut list = Self::default();
        list.extend(tiles);
        list
    }
}

impl Extend<u32> for TileList {
    fn extend<I: IntoIterator<Item = u32>>(&mut self, tiles: I) {
        tiles.into_iter().for_each(|tile| self.push(tile));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_one_run_and_any_part_has_the_same_tiles() {
        let tiles = [3, 4, 5, 9, 1, 2, 3, 7, 8];
        let list: TileList = tiles.into_iter().collect();
        assert_eq!(list.runs(), [3..6, 9..10, 1..4, 7..9]);
        assert_eq!((list.len(), list.iter().collect::<Vec<_>>()), (9, tiles.to_vec()));
        for from in 0..=9 {
            for to in from..=9 {
                let part = list.part(from..to);
                assert_eq!(part, tiles[from..to].iter().copied().collect(), "{from} to {to}");
            }
        }
        assert_eq!(TileList::all(6), (0..6).collect());
        assert_eq!(TileList::all(0), TileList::default());
    }
}
