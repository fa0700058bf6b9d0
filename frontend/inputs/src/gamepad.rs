//! Gamepads and joysticks, by the kernel's joystick interface (Linux, `linux/joystick.h`).
//!
//! It needs no library of the system, so that the program still builds with a compiler alone. Buttons have numbers, not names.

use crate::Refusal;
use crate::reading::{Parts, Said, Stamp};
use std::time::Duration;

/// Bytes of an event.
pub const LENGTH: usize = 8;
/// Kinds of events. With the bit of a beginning an event says how things stood when the device was opened.
const BUTTON: u8 = 1;
const AXIS: u8 = 2;
const BEGINNING: u8 = 0x80;

/// What an event says: its time in milliseconds, its value, its kind and its number. Axes go from −1 to 1.
///
/// # Errors
/// Another length or kind.
pub fn parse(event: &[u8]) -> Result<Parts, Refusal> {
    let &[t0, t1, t2, t3, v0, v1, kind, index] = event else { return Err(Refusal::Short) };
    let value = i16::from_ne_bytes([v0, v1]);
    let said = match kind & !BEGINNING {
        BUTTON => Said::Button(index, value != 0),
        AXIS => Said::axis(index, (f64::from(value) / f64::from(i16::MAX)).max(-1.0))?,
        _ => return Err(Refusal::Form),
    };
    let time = Duration::from_millis(u64::from(u32::from_ne_bytes([t0, t1, t2, t3])));
    Ok(vec![Ok(said.at(Some(Stamp::Own(time))))])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(time_ms: u32, value: i16, kind: u8, index: u8) -> Vec<u8> {
        [&time_ms.to_ne_bytes()[..], &value.to_ne_bytes(), &[kind, index]].concat()
    }

    #[test]
    fn events_are_buttons_and_axes() {
        let stamp = Some(Stamp::Own(Duration::from_millis(1234)));
        for (value, kind, said) in [
            (1, 1, Said::Button(5, true)),
            (0, 0x81, Said::Button(5, false)),
            (i16::MAX, 2, Said::Axis(5, 1.0)),
            (i16::MIN, 0x82, Said::Axis(5, -1.0)),
            (0, 2, Said::Axis(5, 0.0)),
        ] {
            assert_eq!(parse(&event(1234, value, kind, 5)), Ok(vec![Ok(said.at(stamp))]));
        }
        assert_eq!(parse(&event(0, 1, 3, 0)), Err(Refusal::Form));
        assert_eq!(parse(&[0; 7]), Err(Refusal::Short));
    }
}
