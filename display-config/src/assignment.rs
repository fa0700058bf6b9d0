//! Which back-end drives which projectors.

use crate::{ConfigError, Display};
use std::ops::Range;

impl Display {
    /// The projectors of each of a number of back-ends, as indices: neighbours together, in order, in shares that
    /// differ by one at most.
    ///
    /// # Errors
    /// No back-end, or more back-ends than projectors.
    pub fn assign(&self, backends: usize) -> Result<Vec<Vec<u32>>, ConfigError> {
        let projectors = self.projectors.len();
        if backends == 0 || backends > projectors {
            return Err(ConfigError::Backends { backends, projectors });
        }
        Ok(shares(projectors, backends).map(|share| share.map(index).collect()).collect())
    }

    /// The projectors of each back-end as the display's own file assigns them, as indices.
    pub fn own_assignment(&self) -> Vec<Vec<u32>> {
        let backends = self.projectors.iter().map(|p| p.backend as usize + 1).max().unwrap_or(0);
        let mut assignment = vec![Vec::new(); backends];
        for (projector, entry) in self.projectors.iter().enumerate() {
            assignment[entry.backend as usize].push(index(projector));
        }
        assignment
    }
}

/// `count` things in order, cut into contiguous shares that differ by one at most.
pub(crate) fn shares(count: usize, parts: usize) -> impl Iterator<Item = Range<usize>> {
    (0..parts).map(move |part| part * count / parts..(part + 1) * count / parts)
}

fn index(projector: usize) -> u32 {
    u32::try_from(projector).expect("a display's file cannot list 2^32 projectors")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_whole_contiguous_and_equal_to_one() {
        let display = Display::load("holo72").unwrap();
        for backends in 1..=72 {
            let assignment = display.assign(backends).unwrap();
            assert_eq!(assignment.len(), backends);
            assert_eq!(assignment.concat(), (0..72).collect::<Vec<u32>>());
            let sizes = || assignment.iter().map(Vec::len);
            assert!(sizes().max().unwrap() - sizes().min().unwrap() <= 1);
        }
    }

    #[test]
    fn the_presets_own_assignment_is_the_equal_one() {
        for (name, backends) in [("holo72", 36), ("desk8", 4)] {
            let display = Display::load(name).unwrap();
            assert_eq!(display.own_assignment(), display.assign(backends).unwrap());
        }
    }

    #[test]
    fn too_many_back_ends_are_refused_in_a_sentence() {
        let display = Display::load("desk8").unwrap();
        let message = display.assign(9).unwrap_err().to_string();
        assert_eq!(message, "cannot share 8 projectors among 9 back-ends; start from 1 to 8 of them");
        assert!(matches!(display.assign(0), Err(ConfigError::Backends { backends: 0, projectors: 8 })));
    }
}
