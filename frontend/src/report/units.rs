//! Numbers as people read them.

/// 1234567 as `1 234 567`, with narrow spaces that do not break.
pub fn count(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() * 2);
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// A size with a binary unit.
pub fn bytes(bytes: u64) -> String {
    const UNITS: [&str; 5] = ["B", "KiB", "MiB", "GiB", "TiB"];
    let (mut value, mut unit) = (bytes as f64, 0);
    while value >= 1024.0 && unit + 1 < UNITS.len() {
        value /= 1024.0;
        unit += 1;
    }
    if unit == 0 { format!("{bytes} B") } else { format!("{value:.1} {}", UNITS[unit]) }
}

/// A time in the unit that suits it.
pub fn milliseconds(ms: f64) -> String {
    match ms {
        ms if ms < 10.0 => format!("{ms:.2} ms"),
        ms if ms < 1e3 => format!("{ms:.0} ms"),
        ms if ms < 60e3 => format!("{:.2} s", ms / 1e3),
        ms => {
            let seconds = (ms / 1e3).round();
            format!("{} min {:.0} s", (seconds / 60.0).floor(), seconds % 60.0)
        }
    }
}

/// A rate per second with a prefix: 12.3 M.
pub fn per_second(count: u64, ms: f64) -> String {
    if ms <= 0.0 {
        return "–".to_owned();
    }
    match 1e3 * count as f64 / ms {
        rate if rate >= 1e9 => format!("{:.2} G/s", rate / 1e9),
        rate if rate >= 1e6 => format!("{:.2} M/s", rate / 1e6),
        rate if rate >= 1e3 => format!("{:.1} k/s", rate / 1e3),
        rate => format!("{rate:.0} /s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(count(1_234_567), "1\u{202f}234\u{202f}567");
        assert_eq!(count(0), "0");
        assert_eq!([bytes(17), bytes(1536), bytes(5 << 30)], ["17 B", "1.5 KiB", "5.0 GiB"]);
        assert_eq!(
            [1.5, 1500.0, 61e3, 179.9e3].map(milliseconds),
            ["1.50 ms", "1.50 s", "1 min 1 s", "3 min 0 s"]
        );
        assert_eq!(per_second(1_000_000, 100.0), "10.00 M/s");
        assert_eq!(per_second(5, 0.0), "–");
    }
}
