//! What a policy makes of traces, in a few numbers.

use super::ReplayedFrame;

/// What became of one trace.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReplayRun {
    /// Its frames.
    pub frames: Vec<ReplayedFrame>,
    /// Bricks read from the disk, including those that were no longer wanted.
    pub bricks_read: u64,
    /// The same in bytes as the disk holds them.
    pub bytes_read: u64,
}

/// What became of all traces, those of several back-ends taken together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account {
    /// Frames, those of every back-end counted.
    pub frames: u64,
    /// Bricks that came into a cache.
    pub bricks_loaded: u64,
    /// Those among them that had been there before.
    pub loaded_again: u64,
    /// Bytes that disks read.
    pub bytes_read: u64,
    /// The mean over frames of what rays found too coarse on average, levels; 0 if no rays met anything.
    pub mean_deficit: f64,
    /// That of the frame that 99 in 100 do not exceed.
    pub high_deficit: f64,
    /// The largest deficit in the last frame, levels.
    pub deficit_at_end: f64,
    /// From the first frame to the first one in which rays found nothing too coarse, seconds; of several back-ends the
    /// longest. None if one never came so far.
    pub seconds_to_rest: Option<f64>,
    /// Families that came.
    pub splits: u64,
    /// Families that went.
    pub collapses: u64,
    /// Mean time of an update, milliseconds on one core: the only number that another replay does not repeat.
    pub update_ms: f64,
}

impl Account {
    /// Of the traces of one or several back-ends.
    pub fn of(runs: &[ReplayRun]) -> Self {
        let frames = || runs.iter().flat_map(|run| &run.frames);
        let sum = |number: fn(&ReplayedFrame) -> u64| frames().map(number).sum::<u64>();
        let mut means: Vec<f64> = frames().filter_map(|frame| Some(frame.shortfall?.mean)).collect();
        means.sort_by(f64::total_cmp);
        let times: Vec<f64> = frames().map(|frame| frame.update_ms).collect();
        let rests = runs.iter().map(seconds_to_rest);
        Self {
            frames: frames().count() as u64,
            bricks_loaded: sum(|frame| frame.bricks_loaded),
            loaded_again: sum(|frame| frame.loaded_again),
            bytes_read: runs.iter().map(|run| run.bytes_read).sum(),
            mean_deficit: mean(&means),
            high_deficit: no_worse(&means, 0.99),
            deficit_at_end: runs.iter().map(deficit_at_end).fold(0.0, f64::max),
            seconds_to_rest: rests.reduce(|a, b| Some(a?.max(b?))).flatten(),
            splits: sum(|frame| frame.splits),
            collapses: sum(|frame| frame.collapses),
            update_ms: mean(&times),
        }
    }
}

fn deficit_at_end(run: &ReplayRun) -> f64 {
    run.frames.iter().rev().find_map(|frame| frame.shortfall).map_or(0.0, |shortfall| shortfall.largest)
}

fn seconds_to_rest(run: &ReplayRun) -> Option<f64> {
    let at_rest = |frame: &&ReplayedFrame| frame.shortfall.is_some_and(|shortfall| shortfall.largest == 0.0);
    Some(run.frames.iter().find(at_rest)?.time_s - run.frames.first()?.time_s)
}

fn mean(numbers: &[f64]) -> f64 {
    if numbers.is_empty() { 0.0 } else { numbers.iter().sum::<f64>() / numbers.len() as f64 }
}

/// The smallest of some ascending numbers that is at least as large as `part` of them; 0 if there are none.
fn no_worse(rising: &[f64], part: f64) -> f64 {
    let place = (part * rising.len() as f64).ceil() as usize;
    rising.get(place.saturating_sub(1)).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::working_set::Shortfall;

    fn run(deficits: &[Option<f64>]) -> ReplayRun {
        let frame = |(index, deficit): (usize, &Option<f64>)| ReplayedFrame {
            time_s: 2.0 + index as f64,
            shortfall: deficit.map(|mean| Shortfall { mean, largest: 2.0 * mean }),
            bricks_loaded: 3,
            ..ReplayedFrame::default()
        };
        ReplayRun { frames: deficits.iter().enumerate().map(frame).collect(), bricks_read: 4, bytes_read: 40 }
    }

    #[test]
    fn back_ends_count_together() {
        let fast = run(&[None, Some(1.0), Some(0.0), Some(0.5)]);
        let slow = run(&[Some(3.0), Some(2.0), Some(1.0), Some(0.0)]);
        let both = Account::of(&[fast.clone(), slow]);
        assert_eq!((both.frames, both.bricks_loaded, both.bytes_read), (8, 24, 80));
        assert_eq!((both.mean_deficit, both.high_deficit), (7.5 / 7.0, 3.0));
        assert_eq!((both.deficit_at_end, both.seconds_to_rest), (1.0, Some(3.0)));
        assert_eq!(Account::of(std::slice::from_ref(&fast)).seconds_to_rest, Some(2.0));
        assert_eq!(Account::of(&[fast, run(&[Some(1.0)])]).seconds_to_rest, None);
    }

    #[test]
    fn frames_without_rays_tell_nothing() {
        let none = Account::of(&[run(&[None, None])]);
        assert_eq!((none.mean_deficit, none.high_deficit, none.deficit_at_end), (0.0, 0.0, 0.0));
        assert_eq!(none.seconds_to_rest, None);
        assert_eq!(Account::of(&[]), Account::default());
    }

    #[test]
    fn ninety_nine_of_a_hundred_are_no_worse() {
        let rising: Vec<f64> = (1..=200).map(f64::from).collect();
        assert_eq!(no_worse(&rising, 0.99), 198.0);
        assert_eq!(no_worse(&rising[..1], 0.99), 1.0);
    }
}
