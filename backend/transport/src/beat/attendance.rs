//! Whether a back-end takes part in the beat, since when it does not, and whether it gets anywhere.

use std::time::{Duration, Instant};

/// After so long without a drawn frame somebody may want to know. No reason to end it: a frame may honestly take minutes.
const STANDSTILL: Duration = Duration::from_secs(30);

/// Where a back-end is between being lost and drawing again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Presence {
    /// It takes part.
    #[default]
    There,
    /// It failed and was let go.
    Leaving,
    /// It is started again and has not said hello.
    Greeting,
    /// It opens its volume and device.
    Opening,
}

/// What is known of one back-end.
#[derive(Clone, Copy, Debug, Default)]
pub struct Attendance {
    presence: Presence,
    /// When it was lost, until it shows a frame again.
    lost_at: Option<Instant>,
    /// Since when it owes frames without a break.
    at_work_since: Option<Instant>,
    /// Whether somebody knows that it gets nowhere.
    is_noted: bool,
    /// The latest frame that it was asked for out of turn.
    caught_up_with: Option<u32>,
    /// Whether it ever drew a frame.
    has_drawn: bool,
}

impl Attendance {
    pub fn presence(&self) -> Presence {
        self.presence
    }

    pub fn is_there(&self) -> bool {
        self.presence == Presence::There
    }

    /// It is lost, and comes back by way of `presence`.
    pub fn lose(&mut self, presence: Presence, now: Instant) {
        let Self { caught_up_with, has_drawn, .. } = *self;
        let lost_at = self.lost_at.or(Some(now));
        *self = Self { presence, lost_at, caught_up_with, has_drawn, ..Self::default() };
    }

    /// It has come so far on its way back.
    pub fn comes(&mut self, presence: Presence) {
        self.presence = presence;
    }

    /// Whether it may be asked for a frame out of turn: once, for it may be what ended it.
    pub fn may_catch_up_with(&mut self, frame: u32) -> bool {
        self.caught_up_with.replace(frame) != Some(frame)
    }

    /// It is asked for a frame.
    pub fn asked(&mut self, now: Instant) {
        self.at_work_since.get_or_insert(now);
    }

    /// It has drawn a frame, and owes another or not.
    pub fn drew(&mut self, owes_more: bool, now: Instant) {
        self.at_work_since = owes_more.then_some(now);
        self.has_drawn = true;
    }

    /// Whether it ever drew a frame: what fails before is no accident, and would fail again.
    pub fn has_drawn(&self) -> bool {
        self.has_drawn
    }

    /// It shows a frame: how long it was away, if this is the first one since then.
    pub fn shows(&mut self, now: Instant) -> Option<Duration> {
        self.lost_at.take().map(|lost_at| now.saturating_duration_since(lost_at))
    }

    /// For how long it has drawn nothing of what it owes, once that is long; said once until it is lost.
    pub fn standstill(&mut self, now: Instant) -> Option<Duration> {
        let stands = now.saturating_duration_since(self.at_work_since?);
        let is_news = !self.is_noted && stands >= STANDSTILL;
        self.is_noted |= is_news;
        is_news.then_some(stands)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_away_from_its_loss_to_its_next_frame_however_often_it_is_lost_in_between() {
        let (mut one, start) = (Attendance::default(), Instant::now());
        let at = |ms| start + Duration::from_millis(ms);
        assert_eq!(one.shows(at(0)), None);
        one.lose(Presence::Greeting, at(10));
        one.comes(Presence::Opening);
        one.lose(Presence::Greeting, at(300));
        assert!(!one.is_there());
        assert_eq!([7, 7, 8].map(|frame| one.may_catch_up_with(frame)), [true, false, true]);
        one.comes(Presence::There);
        assert_eq!(one.shows(at(510)), Some(Duration::from_millis(500)));
        assert_eq!(one.shows(at(520)), None);
    }

    #[test]
    fn one_that_gets_nowhere_is_noted_once() {
        let (mut one, start) = (Attendance::default(), Instant::now());
        let at = |s| start + Duration::from_secs(s);
        assert_eq!(one.standstill(at(100)), None, "it owes nothing");
        one.asked(at(100));
        one.asked(at(120));
        assert_eq!(one.standstill(at(129)), None);
        one.drew(true, at(129));
        assert_eq!(one.standstill(at(158)), None, "it has drawn one meanwhile");
        assert_eq!(one.standstill(at(160)), Some(Duration::from_secs(31)));
        assert_eq!(one.standstill(at(200)), None, "it is known");
        one.lose(Presence::Greeting, at(201));
        one.comes(Presence::There);
        one.asked(at(202));
        assert!(one.standstill(at(240)).is_some(), "that is another one");
    }
}
