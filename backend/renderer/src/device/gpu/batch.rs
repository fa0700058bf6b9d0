//! How many tiles of a cast are handed to the driver at a time.

use std::num::NonZero;
use std::ops::Range;
use std::thread::available_parallelism;
use std::time::Duration;

/// Tiles of the first batch: few, because nobody knows yet how long they take.
const FIRST: usize = 256;
/// After a batch that took longer the next are smaller, however few tiles it had: a driver's watchdog waits for some seconds.
const LONGEST: Duration = Duration::from_millis(500);

/// Pixels of the views that a complete frame casts together, which no other frame is asked for: a GPU would wait for the longest
/// rays of each view alone. These are 17 views of 800 × 600, and 160 MiB.
const PIXELS_AT_ONCE: u64 = 1 << 23;

/// How many views of such rasters a complete frame casts together, one at least. A driver in software has no reason to.
pub(super) fn views_at_once(rasters: impl Iterator<Item = [u32; 2]>, is_software: bool) -> usize {
    let largest = rasters.map(|[width, height]| u64::from(width) * u64::from(height)).max();
    match largest {
        Some(pixels) if !is_software => (PIXELS_AT_ONCE / pixels.max(1)).max(1) as usize,
        _ => 1,
    }
}

/// Some neighbouring items of one of many lists.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Piece {
    pub(super) list: usize,
    pub(super) range: Range<usize>,
}

/// The next items of lists of such lengths, of which so many are done: at most so many, of as many lists as they take.
pub(super) fn next_pieces(lengths: &[usize], done: &[usize], most: usize) -> Vec<Piece> {
    let mut room = most;
    let mut pieces = Vec::new();
    for (list, (&length, &done)) in lengths.iter().zip(done).enumerate() {
        let end = length.min(done + room);
        if end > done {
            pieces.push(Piece { list, range: done..end });
            room -= end - done;
        }
    }
    pieces
}

/// A number of tiles that take about as long as a batch may, learnt from batch to batch. Whoever asks a cast to leave off
/// waits for no longer, and drivers give up on what takes seconds.
#[derive(Debug)]
pub(super) struct BatchSize {
    tiles: usize,
    aim: Duration,
    /// Of fewer tiles a GPU takes as long as its longest rays take, which smaller batches do not make shorter.
    few: usize,
    most: usize,
    /// Batches that the driver has at once.
    at_once: usize,
    /// Threads of a driver in software.
    threads: usize,
}

impl BatchSize {
    /// Before anything has been cast. On a driver in software batches take longer: it deals tiles out to its threads
    /// beforehand, which then wait for each other, so that small batches leave threads idle.
    pub fn new(is_software: bool) -> Self {
        let tiles = FIRST;
        if is_software {
            let threads = available_parallelism().map_or(1, NonZero::get);
            return Self { tiles, aim: Duration::from_secs(1), few: 1, most: 2048, at_once: 1, threads };
        }
        // A GPU would idle between two of them while the host hears of the first.
        Self { tiles, aim: Duration::from_millis(30), few: 1 << 13, most: 1 << 20, at_once: 2, threads: 1 }
    }

    /// A batch in the order in which it is handed over. A driver in software gives each thread one stretch of it: neighbours,
    /// which take about as long as each other, go to different ones.
    pub fn dealt(&self, runs: Vec<(u32, Range<u32>)>) -> Vec<(u32, Range<u32>)> {
        if self.threads == 1 {
            return runs;
        }
        let alone = |(view, run): (u32, Range<u32>)| run.map(move |tile| (view, tile..tile + 1));
        let tiles: Vec<_> = runs.into_iter().flat_map(alone).collect();
        (0..self.threads)
            .flat_map(|thread| tiles.iter().skip(thread).step_by(self.threads))
            .cloned()
            .collect()
    }

    /// How many batches the driver has at once.
    pub fn at_once(&self) -> usize {
        self.at_once
    }

    /// The next batch of lists of so many tiles, of which so many are done. What would be left for a small last one goes with
    /// it: the longest rays of a batch take as long however few there are.
    pub fn next(&self, lengths: &[usize], done: &[usize]) -> Vec<Piece> {
        let left: usize = lengths.iter().zip(done).map(|(length, done)| length - done).sum();
        let tiles = if 2 * left < 3 * self.tiles { left } else { self.tiles };
        next_pieces(lengths, done, tiles)
    }

    /// A batch of so many tiles took so long. Small ones, at the end of a cast, tell nothing.
    pub fn learn(&mut self, tiles: usize, took: Duration) {
        let is_too_long = took > 2 * self.aim && (self.tiles > self.few || took > LONGEST);
        let aim = if self.tiles < self.few { self.aim.max(LONGEST / 2) } else { self.aim };
        if is_too_long {
            let share = self.aim.as_secs_f64() / took.as_secs_f64();
            let least = if took > LONGEST { 1 } else { self.few };
            self.tiles = ((tiles as f64 * share) as usize).clamp(least.min(self.tiles), self.tiles);
        } else if tiles >= self.tiles && 2 * took < aim {
            self.tiles = (2 * tiles).min(self.most);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sizes and times of the batches of a cast whose tiles each take so long.
    fn batches(size: &mut BatchSize, tiles: usize, each: Duration) -> Vec<(usize, Duration)> {
        let mut left = tiles;
        std::iter::from_fn(|| {
            let batch = left.min(size.tiles);
            left -= batch;
            let took = each * batch as u32;
            size.learn(batch, took);
            (batch > 0).then_some((batch, took))
        })
        .collect()
    }

    #[test]
    fn batches_grow_to_their_aim_and_no_further() {
        for (is_software, each, largest) in [
            (false, Duration::from_micros(10), 1 << 13),
            (false, Duration::from_micros(50), 4096),
            (false, Duration::from_nanos(1), 1 << 16),
            (true, Duration::from_micros(1), 2048),
            (true, Duration::from_millis(1), 512),
        ] {
            let mut size = BatchSize::new(is_software);
            let batches = batches(&mut size, 1 << 17, each);
            assert_eq!(batches.iter().map(|batch| batch.0).max(), Some(largest), "{each:?}");
            assert_eq!(batches.iter().map(|batch| batch.0).sum::<usize>(), 1 << 17);
        }
    }

    #[test]
    fn tiles_that_take_a_hundred_times_as_long_cost_one_long_batch() {
        let mut size = BatchSize::new(true);
        batches(&mut size, 1 << 14, Duration::from_micros(50));
        let slow = batches(&mut size, 1 << 12, Duration::from_millis(8));
        let long = slow.iter().filter(|(_, took)| *took > Duration::from_secs(2)).count();
        assert_eq!((long, slow[1].0), (1, 125), "{slow:?}");
    }

    #[test]
    fn each_thread_gets_a_share_of_every_neighbourhood() {
        let runs = vec![(0, 10..13), (1, 3..5)];
        let dealt = |threads| BatchSize { threads, ..BatchSize::new(true) }.dealt(runs.clone());
        let alone = |tiles: [(u32, u32); 5]| tiles.map(|(view, tile)| (view, tile..tile + 1));
        assert_eq!(dealt(1), runs);
        assert_eq!(dealt(2), alone([(0, 10), (0, 12), (1, 4), (0, 11), (1, 3)]));
        assert_eq!(dealt(8), alone([(0, 10), (0, 11), (0, 12), (1, 3), (1, 4)]));
    }

    #[test]
    fn pieces_go_through_all_lists_in_their_order() {
        let lengths = [5, 0, 3, 9];
        for most in [1, 2, 4, 7, 100] {
            let mut done = [0; 4];
            loop {
                let pieces = next_pieces(&lengths, &done, most);
                let items: usize = pieces.iter().map(|piece| piece.range.len()).sum();
                assert_eq!(items, most.min(17 - done.iter().sum::<usize>()));
                if pieces.is_empty() {
                    break;
                }
                for Piece { list, range } in pieces {
                    assert_eq!(range.start, done[list]);
                    assert!(done[..list] == lengths[..list]);
                    done[list] = range.end;
                }
            }
            assert_eq!(done, lengths);
        }
    }

    #[test]
    fn one_tile_is_always_cast() {
        let mut size = BatchSize::new(false);
        assert!(batches(&mut size, 1 << 10, Duration::from_secs(1)).iter().all(|(tiles, _)| *tiles >= 1));
        assert_eq!(size.tiles, 1);
    }
}
