//! What a message quotes, at a length that can be read.

use std::borrow::Cow;

/// Characters of a quoted text, at most.
const MOST: usize = 160;

/// A text, cut off where it is too long to be read, and on one line.
pub fn brief_text(text: &str) -> Cow<'_, str> {
    let is_short = text.chars().nth(MOST).is_none();
    if is_short && !text.contains(char::is_control) {
        return text.into();
    }
    let shown = text.chars().take(MOST).map(|c| if c.is_control() { '\u{fffd}' } else { c });
    let end = if is_short { "" } else { "…" };
    (shown.collect::<String>() + end).into()
}

/// A number in as few digits as tell it exactly.
pub fn brief_number(number: f64) -> String {
    let is_plain = number == 0.0 || !number.is_finite() || (1e-5..1e15).contains(&number.abs());
    if is_plain { number.to_string() } else { format!("{number:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_people_write_is_quoted_as_it_is() {
        assert_eq!(brief_text("screen_width_m"), "screen_width_m");
        assert_eq!([0.3, -1200.5, 0.0, f64::NAN].map(brief_number), ["0.3", "-1200.5", "0", "NaN"]);
    }

    #[test]
    fn what_nobody_reads_is_cut_off() {
        let long = "λ".repeat(200_000);
        assert_eq!(brief_text(&long).chars().count(), MOST + 1);
        assert_eq!(brief_text("\u{1b}[31mred\n"), "\u{fffd}[31mred\u{fffd}");
        assert_eq!([1e300, -2.5e-300, 1e15].map(brief_number), ["1e300", "-2.5e-300", "1e15"]);
    }
}
