//! Feedback tables between the end of their frame and the moment they are taken.

use std::collections::VecDeque;

/// Tables that may be under way: one that is read, one that is copied, and one to spare.
const MOST_UNDER_WAY: usize = 3;

/// Tables under way, in the order of their frames.
#[derive(Debug)]
pub(super) struct UnderWay<T> {
    tables: VecDeque<T>,
}

impl<T> Default for UnderWay<T> {
    fn default() -> Self {
        Self { tables: VecDeque::with_capacity(MOST_UNDER_WAY) }
    }
}

impl<T> UnderWay<T> {
    /// Adds the table of the latest frame. If tables have not been taken for long, the oldest is dropped: tables never hold
    /// up a frame, and later ones repeat what it says.
    pub(super) fn start(&mut self, table: T) {
        if self.tables.len() == MOST_UNDER_WAY {
            self.tables.pop_front();
        }
        self.tables.push_back(table);
    }

    /// Whether nothing is under way.
    pub(super) fn is_empty(&self) -> bool {
        self.tables.is_empty()
    }

    /// The oldest table, where it has arrived; later ones are not looked at before.
    pub(super) fn take(&mut self, has_arrived: impl FnOnce(&T) -> bool) -> Option<T> {
        if has_arrived(self.tables.front()?) { self.tables.pop_front() } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn tables_come_in_the_order_of_their_frames() {
        let mut tables = UnderWay::default();
        assert_eq!(tables.take(|_| true), None::<u32>);
        tables.start(0);
        tables.start(1);
        assert_eq!(tables.take(|_| true), Some(0));
        tables.start(2);
        assert_eq!(tables.take(|_| true), Some(1));
        assert_eq!(tables.take(|_| true), Some(2));
        assert_eq!(tables.take(|_| true), None);
    }

    #[test]
    fn a_later_table_waits_for_an_earlier_one() {
        let mut tables = UnderWay::default();
        let arrived = [Cell::new(false), Cell::new(true)];
        tables.start(0);
        tables.start(1);
        let mut take = || tables.take(|&table: &usize| arrived[table].get());
        assert_eq!((take(), take()), (None, None));
        arrived[0].set(true);
        assert_eq!((take(), take(), take()), (Some(0), Some(1), None));
    }

    #[test]
    fn what_nobody_takes_is_given_up_oldest_first() {
        let mut tables = UnderWay::default();
        (0..10).for_each(|table| tables.start(table));
        let taken: Vec<u32> = std::iter::from_fn(|| tables.take(|_| true)).collect();
        assert_eq!(taken, [7, 8, 9]);
    }
}
