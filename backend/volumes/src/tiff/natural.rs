//! Names in the order in which people count: `z2` before `z10`.

/// A run of a name; numbers come before letters.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Run {
    /// Digits without leading zeros, shorter ones first.
    Number(usize, String),
    Text(char),
}

/// What names are sorted by; the name itself is last, so that no two names are equal.
pub(super) fn key(name: &str) -> (Vec<Run>, String) {
    (runs(name), name.to_owned())
}

/// The numbers and letters of a name.
pub(super) fn runs(name: &str) -> Vec<Run> {
    let mut runs = Vec::new();
    let mut rest = name;
    while let Some(first) = rest.chars().next() {
        let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
        if digits == 0 {
            runs.push(Run::Text(first));
            rest = &rest[first.len_utf8()..];
        } else {
            let number = rest[..digits].trim_start_matches('0');
            runs.push(Run::Number(number.len(), number.to_owned()));
            rest = &rest[digits..];
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_counted() {
        let mut names =
            ["z10.tif", "z2.tif", "z1.tif", "a30", "z02b.tif", "z", "99999999999999999999999", "ü7"];
        names.sort_by_cached_key(|name| key(name));
        assert_eq!(
            names,
            ["99999999999999999999999", "a30", "z", "z1.tif", "z2.tif", "z02b.tif", "z10.tif", "ü7"]
        );
    }
}
