//! Eases a still view into detail that comes: no pixel changes by much from one live frame to the next.
//!
//! Shares of levels move evenly in time, but pictures do not: where an opaque surface moves from one level to the next, a
//! pixel may go from dark to bright within a hundredth of a fade. So pictures of a still view, in which nothing but detail
//! changes, go no faster toward what rays see than [`MOST_PER_S`]. What moves is shown as it was cast.

use std::borrow::Cow;
use std::collections::HashMap;

/// What any of a pixel's numbers may change by in a second: 12/255 in a frame at 60 Hz.
const MOST_PER_S: f64 = 60.0 * 12.0 / 255.0;

/// The pictures last shown.
#[derive(Debug, Default)]
pub(super) struct Easing {
    shown: HashMap<u32, Shown>,
}

/// A picture as it was shown.
#[derive(Debug, Default)]
struct Shown {
    rgba: Vec<f32>,
    time_s: f64,
    /// Whether rays saw something else.
    is_behind: bool,
}

impl Easing {
    /// Whether a picture was shown that is still on its way to what rays saw.
    pub(super) fn is_behind(&self) -> bool {
        self.shown.values().any(|shown| shown.is_behind)
    }

    /// The picture of a projector that was shown last.
    pub(super) fn before(&self, projector: u32) -> Option<&[f32]> {
        self.shown.get(&projector).map(|shown| &shown.rgba[..])
    }

    /// Makes of a picture that has been cast the one to show; `eases` if the view is still.
    pub(super) fn show(&mut self, projector: u32, cast: Cow<'_, [f32]>, now_s: f64, eases: bool) -> &[f32] {
        let (mut cast, mut is_behind) = (cast, false);
        let shown = self.shown.entry(projector).or_default();
        if eases && shown.rgba.len() == cast.len() {
            let most = (MOST_PER_S * (now_s - shown.time_s).max(0.0)) as f32;
            is_behind = ease(&shown.rgba, cast.to_mut(), most);
        }
        match cast {
            Cow::Owned(cast) => shown.rgba = cast,
            Cow::Borrowed(cast) => {
                shown.rgba.clear();
                shown.rgba.extend_from_slice(cast);
            }
        }
        (shown.time_s, shown.is_behind) = (now_s, is_behind);
        &shown.rgba
    }

    /// Others show their own pictures now.
    pub(super) fn forget(&mut self) {
        self.shown.clear();
    }
}

/// Takes every pixel back toward what it was, so far that none of its numbers differs from that by more than `most`.
/// Whether any had to.
fn ease(before: &[f32], rgba: &mut [f32], most: f32) -> bool {
    let mut is_behind = false;
    for (before, pixel) in before.chunks_exact(4).zip(rgba.chunks_exact_mut(4)) {
        let change = pixel.iter().zip(before).fold(0.0_f32, |change, (a, b)| change.max((a - b).abs()));
        if change > most {
            // On a straight line: a mixture of the two, of no third colour.
            let share = most / change;
            pixel.iter_mut().zip(before).for_each(|(now, before)| *now = before + share * (*now - before));
            is_behind = true;
        }
    }
    is_behind
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME_S: f64 = 1.0 / 60.0;
    const MOST: f32 = 12.0 / 255.0;

    /// Two pixels.
    fn image(rgba: [f32; 4]) -> Vec<f32> {
        [[0.25; 4], rgba].concat()
    }

    fn show(easing: &mut Easing, image: &[f32], now_s: f64, eases: bool) -> Vec<f32> {
        let owned = easing.shown.is_empty();
        let cast = if owned { Cow::Owned(image.to_vec()) } else { Cow::Borrowed(image) };
        easing.show(3, cast, now_s, eases).to_vec()
    }

    #[test]
    fn a_still_view_goes_on_evenly_and_ends_at_what_was_cast() {
        let (mut easing, cast) = (Easing::default(), image([0.9, 0.1, 0.5, 0.7]));
        show(&mut easing, &image([0.0, 0.4, 0.5, 0.7]), 0.0, false);
        let mut last = [0.0, 0.4, 0.5, 0.7];
        for frame in 1..=40 {
            let shown = show(&mut easing, &cast, f64::from(frame) * FRAME_S, true);
            let pixel: [f32; 4] = shown[4..].try_into().unwrap();
            let change = pixel.iter().zip(last).fold(0.0_f32, |most, (a, b)| most.max((a - b).abs()));
            assert!(change <= MOST + 1e-6, "frame {frame}: {change}");
            // 0.9 takes 20 steps of 12/255.
            assert_eq!(easing.is_behind(), frame < 20, "frame {frame}");
            assert_eq!(shown == cast, frame >= 20);
            last = pixel;
        }
    }

    #[test]
    fn what_moves_and_what_is_new_is_shown_as_it_was_cast() {
        let mut easing = Easing::default();
        for (number, eases) in [(0.2, true), (0.9, false)] {
            let shown = show(&mut easing, &image([number; 4]), 0.0, eases);
            assert_eq!(shown, image([number; 4]));
            assert!(!easing.is_behind());
        }
        show(&mut easing, &image([0.1; 4]), FRAME_S, true);
        assert!(easing.is_behind());
        easing.forget();
        let shown = show(&mut easing, &image([0.1; 4]), 2.0 * FRAME_S, true);
        assert_eq!(shown, image([0.1; 4]));
    }
}
