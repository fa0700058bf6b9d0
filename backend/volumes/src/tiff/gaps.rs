//! Whether the names of slices number them without a gap.

use super::natural::{Run, runs};

/// The first two names, of those in order, between which something seems to be missing or to begin; None if their numbers
/// rise evenly, or they have none.
pub(super) fn gap<'a>(names: &[&'a str]) -> Option<(&'a str, &'a str)> {
    if !names.iter().any(|name| name.contains(|letter: char| letter.is_ascii_digit())) {
        return None;
    }
    let steps: Vec<Option<u128>> = names.windows(2).map(|pair| step(pair[0], pair[1])).collect();
    let usual = steps.iter().flatten().min().copied();
    let odd = steps.iter().position(|step| step.is_none() || *step != usual)?;
    Some((names[odd], names[odd + 1]))
}

/// How much larger the number in which two names differ is in the second; None if they differ in more.
fn step(a: &str, b: &str) -> Option<u128> {
    let (a, b) = (runs(a), runs(b));
    let mut differing = a.iter().zip(&b).filter(|(a, b)| a != b);
    match (differing.next()?, differing.next(), a.len() == b.len()) {
        ((Run::Number(_, a), Run::Number(_, b)), None, true) => value(b)?.checked_sub(value(a)?),
        _ => None,
    }
}

/// The number that digits without leading zeros make; None where it is beyond all measure.
fn value(digits: &str) -> Option<u128> {
    if digits.is_empty() { Some(0) } else { digits.parse().ok() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_rise_evenly_have_no_gap() {
        for names in [
            &["s001.tif", "s002.tif", "s003.tif"][..],
            &["z0.tif", "z5.tif", "z10.tif", "z15.tif"],
            &["t1_z8", "t1_z9", "t1_z10"],
            &["a.tif", "b.tiff"],
            &["only7.tif"],
        ] {
            assert_eq!(gap(names), None, "{names:?}");
        }
    }

    #[test]
    fn what_is_missing_or_of_another_stack_is_seen() {
        for (names, found) in [
            (&["s001", "s002", "s003", "s005", "s006"][..], ("s003", "s005")),
            (&["s001", "s003", "s004"], ("s001", "s003")),
            (&["s0", "s1", "s2", "t0", "t1", "t2"], ("s2", "t0")),
            (&["c1_z1", "c1_z2", "c2_z1", "c2_z2"], ("c1_z2", "c2_z1")),
            (&["a.tif", "s1.tif"], ("a.tif", "s1.tif")),
        ] {
            assert_eq!(gap(names), Some(found), "{names:?}");
        }
    }
}
