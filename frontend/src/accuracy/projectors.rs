//! Which projectors' pictures are compared.

use super::AccuracyError;
use display_config::Display;

/// One from the side and one near the middle: from left to right, an eighth of the way and half of it.
pub fn two_projectors(display: &Display) -> Vec<u32> {
    let x = |&index: &u32| display.projectors[index as usize].centre_in_display.x;
    let mut all: Vec<u32> = (0..display.projectors.len() as u32).collect();
    all.sort_by(|a, b| x(a).total_cmp(&x(b)));
    let mut two = vec![all[all.len() / 8], all[all.len() / 2]];
    two.dedup();
    two
}

/// Whether the display has these projectors, each named once.
pub fn check_projectors(display: &Display, projectors: &[u32]) -> Result<(), AccuracyError> {
    let count = display.projectors.len();
    if let Some(&projector) = projectors.iter().find(|&&projector| projector as usize >= count) {
        return Err(AccuracyError::Projector { projector, count });
    }
    let twice = projectors.iter().enumerate().find(|(at, projector)| projectors[..*at].contains(projector));
    twice.map_or(Ok(()), |(_, &projector)| Err(AccuracyError::Twice(projector)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_eight_the_second_and_the_fifth_and_of_one_the_one() {
        let mut desk8 = Display::load("desk8").unwrap();
        assert_eq!(two_projectors(&desk8), [1, 4]);
        desk8.projectors.truncate(1);
        assert_eq!(two_projectors(&desk8), [0]);
    }

    #[test]
    fn projectors_are_there_and_named_once() {
        let desk8 = Display::load("desk8").unwrap();
        assert_eq!(check_projectors(&desk8, &[0, 7]), Ok(()));
        assert_eq!(
            check_projectors(&desk8, &[0, 8]),
            Err(AccuracyError::Projector { projector: 8, count: 8 })
        );
        assert_eq!(check_projectors(&desk8, &[3, 1, 3]), Err(AccuracyError::Twice(3)));
    }
}
