//! What waits for whoever asks: bounded, however much arrives.

use crate::event::What;
use std::collections::{HashSet, VecDeque};
use std::time::{Duration, Instant};

/// Events that wait, at most.
pub(crate) const CAPACITY: usize = 4096;
/// Of each of two sorts, poses and axes or all else, so many of the newest stay when there are too many. Beside them stays
/// the newest of each sensor, axis, press and release (1025 at most), so that thinning always makes room.
const STAYING: usize = CAPACITY / 4;

/// An event that waits.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Waiting {
    pub at: Instant,
    pub measured: Option<Measured>,
    pub what: What,
}

/// When the device measured it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Measured {
    /// So many seconds before it arrived; less than 0 where the device's clock is ahead.
    Ago(f64),
    /// On its own clock.
    Own(Duration),
}

/// Events in the order of their arrival.
#[derive(Default)]
pub(crate) struct Queue {
    waiting: VecDeque<Waiting>,
    dropped: u64,
}

/// What a later event of the same makes an earlier one old.
#[derive(PartialEq, Eq, Hash)]
enum Subject {
    Sensor(u8),
    Axis(u8),
    Button(u8, bool),
    Presence,
}

impl Subject {
    const fn of(what: &What) -> Self {
        match what {
            What::Pose { sensor, .. } => Self::Sensor(*sensor),
            What::Axis { index, .. } => Self::Axis(*index),
            What::Button { index, is_down } => Self::Button(*index, *is_down),
            What::Found(_) | What::Lost(_) => Self::Presence,
        }
    }

    const fn passes(&self) -> bool {
        matches!(self, Self::Sensor(_) | Self::Axis(_))
    }
}

impl Queue {
    /// Adds an event. If there are too many, the oldest poses and positions of axes go. Presses and releases go only where
    /// nobody has asked during a thousand of them, and of each button the last ones stay.
    pub fn push(&mut self, event: Waiting) {
        if self.waiting.len() == CAPACITY {
            self.thin();
        }
        self.waiting.push_back(event);
    }

    fn thin(&mut self) {
        let (mut seen, mut passing, mut lasting) = (HashSet::new(), 0, 0);
        let before = self.waiting.len();
        let mut kept = VecDeque::with_capacity(CAPACITY);
        for event in self.waiting.drain(..).rev() {
            let subject = Subject::of(&event.what);
            let count = if subject.passes() { &mut passing } else { &mut lasting };
            if seen.insert(subject) || *count < STAYING {
                *count += 1;
                kept.push_front(event);
            }
        }
        self.dropped += (before - kept.len()) as u64;
        self.waiting = kept;
    }

    /// Takes all that waits.
    pub fn take(&mut self) -> VecDeque<Waiting> {
        std::mem::take(&mut self.waiting)
    }

    /// Events that went since the beginning because there were too many.
    pub const fn dropped(&self) -> u64 {
        self.dropped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(whats: impl Iterator<Item = What>) -> Queue {
        let mut queue = Queue::default();
        let at = Instant::now();
        whats.for_each(|what| queue.push(Waiting { at, measured: None, what }));
        queue
    }

    fn pose(sensor: u8) -> What {
        What::Pose { sensor, pose: None }
    }

    fn axis(value: f64) -> What {
        What::Axis { index: 0, value }
    }

    #[test]
    fn a_flood_drops_the_oldest_and_counts_them() {
        let mut queue = filled((0..100_000).map(|i| axis(f64::from(i))));
        let kept = queue.take();
        assert!(kept.len() <= CAPACITY && kept.len() >= STAYING);
        assert_eq!(kept.len() as u64 + queue.dropped(), 100_000);
        let first = 100_000 - kept.len() as i32;
        assert!(
            (first..).zip(&kept).all(|(i, event)| event.what == axis(f64::from(i))),
            "the newest, in order"
        );
    }

    #[test]
    fn releases_and_the_last_word_of_a_sensor_outlive_any_flood() {
        let rare = [pose(1), What::Found(String::new())];
        let press = |i: u32| What::Button { index: 5, is_down: i.is_multiple_of(2) };
        let flood =
            (0..200_000_u32).map(|i| if i.is_multiple_of(200) { press(i / 200) } else { axis(f64::from(i)) });
        let kept = filled(rare.clone().into_iter().chain(flood)).take();
        assert!(rare.iter().all(|what| kept.iter().any(|event| event.what == *what)));
        let buttons: Vec<What> = kept
            .iter()
            .map(|event| event.what.clone())
            .filter(|what| matches!(what, What::Button { .. }))
            .collect();
        assert_eq!(buttons, (0..1000).map(press).collect::<Vec<_>>(), "each of them, in order");
    }

    #[test]
    fn also_buttons_alone_stay_within_bounds_and_end_as_they_did() {
        let whats = |i: u32| What::Button { index: (i / 2) as u8, is_down: i.is_multiple_of(2) };
        let kept = filled((0..100_000).map(whats)).take();
        assert!(kept.len() <= CAPACITY);
        for index in 0..=u8::MAX {
            let last = kept
                .iter()
                .rev()
                .find(|event| matches!(event.what, What::Button { index: i, .. } if i == index));
            assert_eq!(last.unwrap().what, What::Button { index, is_down: false });
        }
    }

    #[test]
    fn every_subject_at_once_fits() {
        let everything = |i: u32| match (i / 256 % 4, i as u8) {
            (0, sensor) => pose(sensor),
            (1, index) => What::Axis { index, value: 0.0 },
            (kind, index) => What::Button { index, is_down: kind == 2 },
        };
        assert!(filled((0..50_000).map(everything)).take().len() <= CAPACITY);
    }
}
