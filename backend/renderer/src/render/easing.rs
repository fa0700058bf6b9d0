//! Eases a still view into detail that comes: no pixel changes by much from one live frame to the next.
//!
//! Shares of levels move evenly in time, but pictures do not: where an opaque surface moves from one level to the next, a
//! pixel may go from dark to bright within a hundredth of a fade. So pictures of a still view, in which nothing but detail
//! changes, go no faster toward what rays see than [`MOST_PER_S`]. What moves is shown as it was cast.

use std::collections::HashMap;

/// What any of a pixel's numbers may change by in a second: 12/255 in a frame at 60 Hz.
const MOST_PER_S: f64 = 60.0 * 12.0 / 255.0;

/// What is known of the pictures last shown, by projectors.
#[derive(Debug, Default)]
pub(super) struct Easing {
    shown: HashMap<u32, Shown>,
}

/// Of a picture that is shown.
#[derive(Clone, Copy, Debug)]
struct Shown {
    time_s: f64,
    /// Whether rays saw something else.
    is_behind: bool,
}

impl Easing {
    /// Whether a picture was shown that is still on its way to what rays saw.
    pub(super) fn is_behind(&self) -> bool {
        self.shown.values().any(|shown| shown.is_behind)
    }

    /// Whether anything was shown for a projector.
    pub(super) fn has_shown(&self, projector: u32) -> bool {
        self.shown.contains_key(&projector)
    }

    /// What any number of the picture of a projector may change by until a time, if it is a still view's.
    pub(super) fn most_change(&self, projector: u32, now_s: f64) -> Option<f32> {
        let shown = self.shown.get(&projector)?;
        Some((MOST_PER_S * (now_s - shown.time_s).max(0.0)) as f32)
    }

    /// The picture of a projector is shown.
    pub(super) fn show(&mut self, projector: u32, time_s: f64, is_behind: bool) {
        self.shown.insert(projector, Shown { time_s, is_behind });
    }

    /// Others show their own pictures now.
    pub(super) fn forget(&mut self) {
        self.shown.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_may_change_by_what_the_time_since_it_was_shown_allows() {
        let mut easing = Easing::default();
        assert_eq!((easing.has_shown(3), easing.most_change(3, 1.0)), (false, None));
        easing.show(3, 1.0, true);
        let most = easing.most_change(3, 1.0 + 1.0 / 60.0).unwrap();
        assert!((most - 12.0 / 255.0).abs() < 1e-6, "{most}");
        assert_eq!(easing.most_change(3, 0.5), Some(0.0), "time does not run backwards");
        easing.show(4, 1.0, false);
        assert!(easing.is_behind());
        easing.show(3, 1.5, false);
        assert!(!easing.is_behind());
        easing.forget();
        assert!(!easing.has_shown(3));
    }
}
