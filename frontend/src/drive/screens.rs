//! The pictures of driven frames on their way from back-ends to what the front-end does with them.

use crate::FrontendError;
use protocol::ScreenImage;
use std::collections::BTreeMap;
use std::time::Duration;

/// Something that takes pictures that are shown.
pub trait Sink {
    /// These pictures are shown from a time of the display's clock on, which says `now`.
    ///
    /// # Errors
    /// They cannot be shown or written.
    fn show(
        &mut self,
        frame: u32,
        images: &[ScreenImage],
        at: Duration,
        now: Duration,
    ) -> Result<(), FrontendError>;
}

/// Pictures that have come and are not shown yet.
#[derive(Default)]
pub struct Screens<'a> {
    sinks: Vec<&'a mut dyn Sink>,
    /// Of each back-end, those of the frame that it draws.
    coming: BTreeMap<usize, Vec<ScreenImage>>,
    /// Those of drawn frames, by frame.
    drawn: BTreeMap<u32, Vec<ScreenImage>>,
    /// The latest frame that is to be shown, and when.
    ordered: Option<(u32, Duration)>,
}

impl<'a> Screens<'a> {
    /// For these sinks.
    pub fn new(sinks: Vec<&'a mut dyn Sink>) -> Self {
        Self { sinks, ..Self::default() }
    }

    /// Whether anybody wants pictures.
    pub fn is_wanted(&self) -> bool {
        !self.sinks.is_empty()
    }

    /// A picture of the frame that a back-end draws.
    pub fn take(&mut self, backend: usize, image: ScreenImage) {
        self.coming.entry(backend).or_default().push(image);
    }

    /// What a back-end was drawing is lost.
    pub fn forget(&mut self, backend: usize) {
        self.coming.remove(&backend);
    }

    /// A back-end has drawn a frame. One that is late is shown at once.
    ///
    /// # Errors
    /// See [`Sink::show`].
    pub fn drawn(&mut self, backend: usize, frame: u32, now: Duration) -> Result<(), FrontendError> {
        let images = self.coming.remove(&backend).unwrap_or_default();
        if self.ordered.is_some_and(|(ordered, _)| frame <= ordered) {
            let at =
                self.ordered.filter(|ordered| ordered.0 == frame).map_or(now, |ordered| ordered.1.max(now));
            return self.show(frame, &images, at, now);
        }
        self.drawn.entry(frame).or_default().extend(images);
        Ok(())
    }

    /// A frame is not shown at all.
    pub fn kept_back(&mut self, frame: u32) {
        self.drawn.remove(&frame);
    }

    /// A frame is shown from a time on.
    ///
    /// # Errors
    /// See [`Sink::show`].
    pub fn ordered(&mut self, frame: u32, at: Duration, now: Duration) -> Result<(), FrontendError> {
        self.ordered = Some((frame, at));
        let later = self.drawn.split_off(&(frame + 1));
        let images = std::mem::replace(&mut self.drawn, later).remove(&frame).unwrap_or_default();
        self.show(frame, &images, at, now)
    }

    fn show(
        &mut self,
        frame: u32,
        images: &[ScreenImage],
        at: Duration,
        now: Duration,
    ) -> Result<(), FrontendError> {
        self.sinks.iter_mut().try_for_each(|sink| sink.show(frame, images, at, now))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Default)]
    struct Seen(Vec<(u32, Vec<u32>, u64)>);

    impl Sink for Seen {
        fn show(
            &mut self,
            frame: u32,
            images: &[ScreenImage],
            at: Duration,
            _: Duration,
        ) -> Result<(), FrontendError> {
            let projectors = images.iter().map(|image| image.projector).collect();
            self.0.push((frame, projectors, at.as_millis() as u64));
            Ok(())
        }
    }

    #[test]
    fn pictures_are_shown_with_their_frame_and_late_ones_at_once() {
        let (mut seen, ms) = (Seen::default(), Duration::from_millis);
        let mut screens = Screens::new(vec![&mut seen]);
        let image = |projector| ScreenImage { projector, width: 1, height: 1, rgb: vec![0; 3] };
        for backend in 0..3 {
            screens.take(backend, image(10 + backend as u32));
        }
        screens.drawn(0, 4, ms(1)).unwrap();
        screens.drawn(1, 4, ms(2)).unwrap();
        screens.ordered(4, ms(20), ms(3)).unwrap();
        screens.take(0, image(10));
        screens.drawn(2, 4, ms(30)).unwrap();
        screens.drawn(0, 5, ms(31)).unwrap();
        screens.take(1, image(11));
        screens.forget(1);
        screens.drawn(1, 5, ms(31)).unwrap();
        screens.ordered(5, ms(40), ms(32)).unwrap();
        let expected = [(4, vec![10, 11], 20), (4, vec![12], 30), (5, vec![10], 40)];
        assert_eq!(seen.0, expected);
    }
}
