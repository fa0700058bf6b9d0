//! Sets of blocks of a row, whole words at a time.

use std::ops::Range;

/// A set of numbers from 0 to some length, less one.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Blocks {
    words: Vec<u64>,
    len: usize,
}

const BITS: usize = u64::BITS as usize;

impl Blocks {
    /// Makes it empty, for numbers below `len`.
    pub(crate) fn clear(&mut self, len: usize) {
        self.len = len;
        self.words.clear();
        self.words.resize(len.div_ceil(BITS), 0);
    }

    /// Makes it hold some of the numbers below `len`.
    pub(crate) fn fill(&mut self, len: usize, members: Range<usize>) {
        self.clear(len);
        members.for_each(|index| self.insert(index));
    }

    fn trim(&mut self) {
        let past = self.words.len() * BITS - self.len;
        if let Some(last) = self.words.last_mut() {
            *last &= u64::MAX >> past;
        }
    }

    pub(crate) fn insert(&mut self, index: usize) {
        self.words[index / BITS] |= 1 << (index % BITS);
    }

    pub(crate) fn remove(&mut self, index: usize) {
        self.words[index / BITS] &= !(1 << (index % BITS));
    }

    #[inline(always)]
    pub(crate) fn contains(&self, index: usize) -> bool {
        self.words[index / BITS] >> (index % BITS) & 1 != 0
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.words.iter().all(|&word| word == 0)
    }

    /// Keeps what `other` holds as well.
    pub(crate) fn intersect(&mut self, other: &Self) {
        self.words.iter_mut().zip(&other.words).for_each(|(word, other)| *word &= other);
    }

    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Adds the members of `other`, each moved by every number from `least` to `most`.
    pub(crate) fn add_moved(&mut self, other: &Self, [least, most]: [i64; 2]) {
        for by in least..=most {
            for (index, word) in self.words.iter_mut().enumerate() {
                *word |= other.moved_word(index, by);
            }
        }
        self.trim();
    }

    /// Keeps the members of `other`, each moved by every number from `least` to `most`.
    pub(crate) fn keep_moved(&mut self, other: &Self, [least, most]: [i64; 2]) {
        for (index, word) in self.words.iter_mut().enumerate() {
            *word &= (least..=most).fold(0, |all, by| all | other.moved_word(index, by));
        }
    }

    /// Takes out the members of `other`, each moved by every number from `least` to `most`.
    pub(crate) fn subtract_moved(&mut self, other: &Self, [least, most]: [i64; 2]) {
        for by in least..=most {
            for (index, word) in self.words.iter_mut().enumerate() {
                *word &= !other.moved_word(index, by);
            }
        }
    }

    /// A word of the set with all members moved.
    #[inline(always)]
    fn moved_word(&self, index: usize, by: i64) -> u64 {
        let (whole, part) = (by >> BITS.trailing_zeros(), by & (BITS as i64 - 1));
        let at = index as i64 - whole;
        let low = self.word(at) << part;
        if part == 0 { low } else { low | self.word(at - 1) >> (BITS as i64 - part) }
    }

    #[inline(always)]
    fn word(&self, index: i64) -> u64 {
        if index >= 0 && (index as usize) < self.words.len() { self.words[index as usize] } else { 0 }
    }

    /// Its members, from the lowest on.
    pub(crate) fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        self.words.iter().enumerate().flat_map(|(index, &word)| {
            let next = |&word: &u64| Some(word & (word - 1)).filter(|&rest| rest != 0);
            std::iter::successors(Some(word).filter(|&word| word != 0), next)
                .map(move |word| index * BITS + word.trailing_zeros() as usize)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(len: usize, members: &[usize]) -> Blocks {
        let mut blocks = Blocks::default();
        blocks.clear(len);
        members.iter().for_each(|&index| blocks.insert(index));
        blocks
    }

    #[test]
    fn members_move_across_words_and_fall_off_the_ends() {
        let start = of(100, &[0, 3, 62, 63, 64, 98]);
        for range in [[0, 0], [-2, 1], [1, 5], [-70, -60], [60, 66], [200, 201]] {
            let mut moved = of(130, &[]);
            moved.add_moved(&start, range);
            let all = start.iter().flat_map(|i| (range[0]..=range[1]).map(move |by| i as i64 + by));
            let mut truth: Vec<usize> = all.filter(|i| (0..130).contains(i)).map(|i| i as usize).collect();
            truth.sort_unstable();
            truth.dedup();
            assert_eq!(moved.iter().collect::<Vec<_>>(), truth, "{range:?}");
        }
    }

    #[test]
    fn sets_are_met_and_left() {
        let mut all = Blocks::default();
        all.fill(70, 0..70);
        assert_eq!(all.iter().count(), 70);
        all.subtract_moved(&of(70, &[0, 68]), [1, 1]);
        all.intersect(&of(70, &[0, 1, 68, 69]));
        assert_eq!(all, of(70, &[0, 68]));
        all.keep_moved(&of(90, &[2, 4, 70]), [-3, -2]);
        assert_eq!(all, of(70, &[0, 68]));
        all.insert(3);
        all.keep_moved(&of(90, &[2, 4, 70]), [-2, -1]);
        assert_eq!(all, of(70, &[0, 3, 68]));
        all.remove(3);
        all.remove(0);
        assert!(!all.is_empty() && all.contains(68));
        all.remove(68);
        assert!(all.is_empty());
    }
}
