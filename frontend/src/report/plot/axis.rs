//! A logarithmic axis.

/// An axis is at least this many decades long: the ticks 1, 2, 5 then show at least two numbers.
const SHORTEST: f64 = 0.75;
/// Beyond the values at both ends, as a share of their extent.
const PADDING: f64 = 0.04;
/// From so many decades on, only powers of ten are labelled.
const MANY_DECADES: f64 = 3.0;
/// Powers of ten that are labelled, at most.
const MOST_LABELS: i32 = 9;
/// What is shown where there is nothing to show.
const NOTHING: (f64, f64) = (-1.0, 1.0);

/// A logarithmic axis, from one power of ten to another; neither needs to be whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogAxis {
    low: f64,
    high: f64,
}

/// A place on an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Where.
    pub value: f64,
    /// What is written there; None for a small tick.
    pub label: Option<String>,
}

impl LogAxis {
    /// An axis that shows all values that have a logarithm, with some room around them.
    pub fn around(values: impl Iterator<Item = f64>) -> Self {
        let shown = values.filter(|value| value.is_finite() && *value > 0.0).map(f64::log10);
        let (low, high) =
            shown.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), l| (l.min(low), l.max(high)));
        let (low, high) = if low > high { NOTHING } else { (low, high) };
        let room = (PADDING * (high - low)).max(0.5 * (SHORTEST - (high - low)));
        Self { low: low - room, high: high + room }
    }

    /// Where a value lies: 0 at the low end, 1 at the high end; what lies beyond, or has no logarithm, is at an end.
    pub fn share(&self, value: f64) -> f64 {
        let share = (value.log10() - self.low) / (self.high - self.low);
        if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) }
    }

    /// The ticks from low to high: every whole multiple of a power of ten.
    pub fn ticks(&self) -> Vec<Tick> {
        let decades = self.low.floor() as i32..=self.high.ceil() as i32;
        let all = decades.flat_map(|power| (1..10).map(move |digit| (digit, power)));
        let is_shown = |&(digit, power): &(i32, i32)| {
            let place = f64::from(digit).log10() + f64::from(power);
            (self.low..=self.high).contains(&place)
        };
        let tick = |(digit, power): (i32, i32)| Tick {
            value: f64::from(digit) * 10f64.powi(power),
            label: self.is_labelled(digit, power).then(|| label(digit, power)),
        };
        all.filter(is_shown).map(tick).collect()
    }

    fn is_labelled(&self, digit: i32, power: i32) -> bool {
        let decades = self.high - self.low;
        if decades < MANY_DECADES {
            return matches!(digit, 1 | 2 | 5);
        }
        let every = (decades.ceil() as i32 / MOST_LABELS) + 1;
        digit == 1 && power.rem_euclid(every) == 0
    }
}

/// `digit` · 10^`power` as people write it.
fn label(digit: i32, power: i32) -> String {
    match power {
        0..=3 => format!("{digit}{}", "0".repeat(power as usize)),
        -3..0 => format!("0.{}{digit}", "0".repeat((-power - 1) as usize)),
        _ if digit == 1 => format!("10{}", raised(power)),
        _ => format!("{digit}·10{}", raised(power)),
    }
}

fn raised(number: i32) -> String {
    let raise = |letter: char| match letter {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' | '4'..='9' => char::from_u32(0x2070 + u32::from(letter) - u32::from('0')).unwrap_or(letter),
        other => other,
    };
    number.to_string().chars().map(raise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn labels(values: &[f64]) -> Vec<String> {
        LogAxis::around(values.iter().copied()).ticks().into_iter().filter_map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_suit_the_extent() {
        assert_eq!(labels(&[1e-5, 20.0]), ["10⁻⁵", "10⁻⁴", "0.001", "0.01", "0.1", "1", "10"]);
        assert_eq!(labels(&[0.12, 4.0]), ["0.2", "0.5", "1", "2"]);
        assert_eq!(labels(&[3e-5]), ["2·10⁻⁵", "5·10⁻⁵"]);
        assert!(labels(&[1e-30, 1e30]).len() <= MOST_LABELS as usize);
    }

    #[test]
    fn what_has_no_logarithm_is_at_an_end() {
        let axis = LogAxis::around([0.0, -1.0, f64::NAN, f64::INFINITY, 1.0, 10.0].into_iter());
        let ends = [0.0, -1.0, f64::NAN, f64::INFINITY].map(|value| axis.share(value));
        assert_eq!(ends, [0.0, 0.0, 0.0, 1.0]);
        assert!(!LogAxis::around(std::iter::empty()).ticks().is_empty());
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 200, rng_seed: proptest::test_runner::RngSeed::Fixed(7), failure_persistence: None, ..Default::default() })]

        #[test]
        fn an_axis_shows_its_values_and_at_least_two_numbers(
            powers in proptest::collection::vec(-12.0f64..6.0, 1..20)
        ) {
            let values: Vec<f64> = powers.iter().map(|power| 10f64.powf(*power)).collect();
            let axis = LogAxis::around(values.iter().copied());
            for &value in &values {
                let exact = (value.log10() - axis.low) / (axis.high - axis.low);
                prop_assert!((0.0..=1.0).contains(&exact) && (axis.share(value) - exact).abs() < 1e-12);
            }
            let ticks = axis.ticks();
            prop_assert!(ticks.is_sorted_by(|a, b| a.value < b.value));
            let labelled = ticks.iter().filter(|tick| tick.label.is_some()).count();
            prop_assert!((2..=10).contains(&labelled), "{:?}", ticks);
        }
    }
}
