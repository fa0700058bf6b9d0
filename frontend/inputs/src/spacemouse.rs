//! SpaceMouse: what spacenavd sends to programs (protocol version 0 of its socket).

use crate::Refusal;
use crate::reading::{Parts, Said};

/// Bytes of an event: eight whole numbers of the machine.
pub const LENGTH: usize = 32;
const MOTION: i32 = 0;
const PRESS: i32 = 1;
const RELEASE: i32 = 2;
/// What a cap that is pushed or turned all the way gives, in counts.
const FULL_COUNTS: f64 = 350.0;

/// What an event says: axes 0 to 2 push, axes 3 to 5 turn about the same, each about 1 at most; or a button. Events of other
/// kinds say nothing.
///
/// # Errors
/// Another length; a button out of bounds.
pub fn parse(event: &[u8]) -> Result<Parts, Refusal> {
    let (words, rest) = event.as_chunks::<4>();
    let [kind, data @ ..] = words else { return Err(Refusal::Short) };
    let (kind, data) = (i32::from_ne_bytes(*kind), data.iter().copied().map(i32::from_ne_bytes));
    if data.len() != 7 || !rest.is_empty() {
        return Err(Refusal::Short);
    }
    let mut data = data;
    match kind {
        MOTION => {
            let axis = |(index, counts)| Said::axis(index, f64::from(counts) / FULL_COUNTS);
            Ok((0..6).zip(data).map(|counts| axis(counts).map(|said| said.at(None))).collect())
        }
        PRESS | RELEASE => {
            let index = data.next().and_then(|button| u8::try_from(button).ok()).ok_or(Refusal::Index)?;
            Ok(vec![Ok(Said::Button(index, kind == PRESS).at(None))])
        }
        _ => Ok(Parts::new()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(numbers: [i32; 8]) -> Vec<u8> {
        numbers.iter().flat_map(|number| number.to_ne_bytes()).collect()
    }

    #[test]
    fn motion_is_six_axes() {
        let parts = parse(&event([0, 350, -350, 0, 35, 0, -70, 16])).unwrap();
        let axes = [1.0, -1.0, 0.0, 0.1, 0.0, -0.2];
        let expected: Parts = (0..).zip(axes).map(|(i, value)| Ok(Said::Axis(i, value).at(None))).collect();
        assert_eq!(parts, expected);
    }

    #[test]
    fn buttons_go_down_and_up() {
        let button = |kind, index| parse(&event([kind, index, 0, 0, 0, 0, 0, 0]));
        assert_eq!(button(1, 3), Ok(vec![Ok(Said::Button(3, true).at(None))]));
        assert_eq!(button(2, 3), Ok(vec![Ok(Said::Button(3, false).at(None))]));
        assert_eq!([button(1, -1), button(2, 256)], [Err(Refusal::Index), Err(Refusal::Index)]);
        assert_eq!(button(3, 0), Ok(vec![]));
        assert_eq!([parse(&[0; 31]), parse(&[0; 33]), parse(&[])], [const { Err(Refusal::Short) }; 3]);
    }
}
