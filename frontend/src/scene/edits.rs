//! What keyframes change of the look.

use glam::DVec3;
use optics::{Curve, Trapezoid};

/// Values that each hold from their time on until the next, seconds, rising.
#[derive(Clone, Debug, PartialEq)]
pub struct Held<T> {
    keys: Vec<(f64, T)>,
}

impl<T> Default for Held<T> {
    fn default() -> Self {
        Self { keys: Vec::new() }
    }
}

impl<T> Held<T> {
    /// Adds a value that is later than all before it.
    pub fn push(&mut self, time_s: f64, value: T) {
        debug_assert!(self.keys.last().is_none_or(|key| key.0 < time_s));
        self.keys.push((time_s, value));
    }

    /// The value that holds at a time; None before the first.
    pub fn at(&self, time_s: f64) -> Option<&T> {
        let after = self.keys.partition_point(|key| key.0 <= time_s);
        self.keys.get(after.checked_sub(1)?).map(|key| &key.1)
    }

    fn times(&self) -> impl Iterator<Item = f64> {
        self.keys.iter().map(|key| key.0)
    }
}

/// The edits of a scene's keyframes, over data values; if there are none, the scene's own look holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Edits {
    /// Extinction.
    pub extinction: Held<Curve<f64>>,
    /// Linear RGB.
    pub colour: Held<Curve<DVec3>>,
    /// Importance.
    pub importance: Held<Curve<f64>>,
    /// Refraction index.
    pub refraction: Held<Curve<f64>>,
    /// γ of importance accumulation.
    pub gamma: Held<f64>,
    /// The band that band-pickers pick.
    pub pick: Held<Trapezoid>,
}

impl Edits {
    /// A time before all edits, and then that of each; some may come twice.
    pub(super) fn times(&self) -> impl Iterator<Item = f64> {
        let curves = self.extinction.times().chain(self.importance.times()).chain(self.refraction.times());
        let rest = self.colour.times().chain(self.gamma.times()).chain(self.pick.times());
        std::iter::once(f64::NEG_INFINITY).chain(curves).chain(rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_holds_until_the_next() {
        let mut held = Held::default();
        held.push(1.0, 'a');
        held.push(2.0, 'b');
        let at = [0.9, 1.0, 1.999, 2.0, 9.0].map(|time_s| held.at(time_s).copied());
        assert_eq!(at, [None, Some('a'), Some('a'), Some('b'), Some('b')]);
    }
}
