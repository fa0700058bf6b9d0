//! The beat of a driven display: when the next frame begins, how long it is waited for, and when all show it.
//!
//! Pure: it knows neither messages nor clocks. Frames are shown on a grid of periods. A frame is shown once all back-ends
//! have drawn it that are not behind, or once the deadline has passed and any has. So a back-end that becomes slow holds up
//! one frame; then it is behind, and shows its own frames when they are ready, until it draws one fast enough again.

use std::time::Duration;

/// A frame may take so many times as long as back-ends of late.
const PATIENCE: u32 = 2;

/// The weight of the latest frame in what a back-end takes of late.
const LATEST: f64 = 0.25;

/// What the beat is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rhythm {
    /// From frame to frame, at best.
    pub period: Duration,
    /// From the order to show a frame to the moment it is shown: longer than a message takes.
    pub lead: Duration,
    /// From that moment to the beginning of the next frame: whoever shows a frame needs a core for an instant.
    pub breath: Duration,
}

/// What is to be done now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Begin a frame, which will be seen about then; say so with [`Beat::begin`].
    Begin {
        /// Its number.
        frame: u32,
        /// When it will be seen if it takes as long as those before.
        seen_at: Duration,
    },
    /// All show a frame at a time; those that have not drawn it show it once they have.
    Show {
        /// Its number.
        frame: u32,
        /// When.
        at: Duration,
    },
    /// Nothing before this time, unless something comes from a back-end.
    Wait {
        /// None is until something comes.
        until: Option<Duration>,
    },
}

/// One back-end, as far as the beat needs to know it.
#[derive(Clone, Debug, Default)]
struct Member {
    /// The latest frame that it was asked for, and when.
    asked: Option<(u32, Duration)>,
    /// The latest frame that it has drawn.
    drawn: Option<u32>,
    /// What a frame takes it of late, seconds.
    typical_s: Option<f64>,
    /// Whether the present frame waits for it.
    is_expected: bool,
    /// Whether it is behind: it missed a frame, and has not drawn one as fast as is waited for since.
    is_behind: bool,
    /// Whether it is gone.
    is_lost: bool,
    /// Frames that were shown without it.
    late: u64,
}

impl Member {
    fn is_busy(&self) -> bool {
        self.asked.is_some_and(|(frame, _)| self.drawn != Some(frame))
    }
}

/// A frame that is being drawn.
#[derive(Clone, Copy, Debug)]
struct Current {
    frame: u32,
    seen_at: Duration,
    deadline: Option<Duration>,
}

/// The beat.
#[derive(Clone, Debug)]
pub struct Beat {
    rhythm: Rhythm,
    members: Vec<Member>,
    next_frame: u32,
    next_begin: Duration,
    current: Option<Current>,
    /// When the latest frame is shown.
    last_shown: Option<Duration>,
    /// When the one before it is.
    shown_before: Option<Duration>,
}

impl Beat {
    /// The beat of so many back-ends, from `now` on.
    pub fn new(rhythm: Rhythm, backends: usize, now: Duration) -> Self {
        Self {
            rhythm,
            members: vec![Member::default(); backends],
            next_frame: 0,
            next_begin: now,
            current: None,
            last_shown: None,
            shown_before: None,
        }
    }

    /// What is to be done at a time. A frame that is due begins only when [`Beat::begin`] says so.
    pub fn step(&mut self, now: Duration) -> Step {
        let Some(current) = self.current else {
            return match now >= self.next_begin {
                true => Step::Begin { frame: self.next_frame, seen_at: self.seen_at(now) },
                false => Step::Wait { until: Some(self.next_begin) },
            };
        };
        let has_drawn = |member: &Member| member.drawn == Some(current.frame);
        let is_missing = |member: &&Member| member.is_expected && !member.is_lost && !has_drawn(member);
        let is_any_there = self.members.iter().any(has_drawn);
        let is_over = current.deadline.is_some_and(|deadline| now >= deadline);
        if !is_any_there && self.is_given_up(current.frame) {
            (self.current, self.next_begin) = (None, now);
            return Step::Wait { until: Some(now) };
        }
        let is_whole = !self.members.iter().any(|member| is_missing(&member));
        if !is_any_there || !(is_whole || is_over) {
            return Step::Wait { until: current.deadline.filter(|_| is_any_there) };
        }
        for member in self.members.iter_mut().filter(|member| !member.is_lost && !has_drawn(member)) {
            member.late += 1;
            member.is_behind = true;
        }
        let at = self.slot(current.seen_at.max(now + self.rhythm.lead));
        self.current = None;
        self.shown_before = self.last_shown.replace(at);
        // On the grid again, where there is time.
        let period = self.rhythm.period.as_nanos().max(1);
        let next = (self.next_begin + self.rhythm.period).as_nanos() / period * period;
        self.next_begin = now.max(nanoseconds(next) + self.rhythm.breath);
        Step::Show { frame: current.frame, at }
    }

    /// Whether those that were asked for a frame are lost, and one is there that was not.
    fn is_given_up(&self, frame: u32) -> bool {
        let mut there = self.members.iter().filter(|member| !member.is_lost).peekable();
        there.peek().is_some() && there.all(|member| member.asked.is_none_or(|asked| asked.0 != frame))
    }

    /// A frame that is due has been sent to all back-ends that are there.
    pub fn begin(&mut self, now: Duration) {
        let (frame, seen_at) = (self.next_frame, self.seen_at(now));
        let are_all_behind = self.members.iter().all(|member| member.is_lost || member.is_behind);
        for member in self.members.iter_mut().filter(|member| !member.is_lost) {
            member.is_expected = are_all_behind || !member.is_behind;
            member.asked = Some((frame, now));
        }
        self.next_frame += 1;
        let deadline = self.patience().map(|patience| now + patience);
        self.current = Some(Current { frame, seen_at, deadline });
    }

    /// The frame that was to be shown is not: the next may begin at once.
    pub fn keep_back(&mut self, now: Duration) {
        (self.last_shown, self.next_begin) = (self.shown_before, now);
    }

    /// There is nothing to draw: the next frame may begin a period later.
    pub fn pass(&mut self, now: Duration) {
        self.next_begin = now.max(self.next_begin) + self.rhythm.period;
    }

    /// A back-end has drawn a frame.
    pub fn drawn(&mut self, backend: usize, frame: u32, now: Duration) {
        let patience = self.patience();
        let member = &mut self.members[backend];
        member.drawn = Some(frame);
        if let Some((_, asked_at)) = member.asked.filter(|asked| asked.0 == frame) {
            let took = now.saturating_sub(asked_at);
            let before = member.typical_s.unwrap_or(took.as_secs_f64());
            member.typical_s = Some(before + LATEST * (took.as_secs_f64() - before));
            member.is_behind &= patience.is_none_or(|patience| took > patience);
        }
    }

    /// A back-end is gone: nothing waits for it.
    pub fn lost(&mut self, backend: usize) {
        self.members[backend] =
            Member { is_lost: true, late: self.members[backend].late, ..Member::default() };
    }

    /// A back-end that was gone is there again. It takes part from the next frame on, and is behind until it has drawn one:
    /// its volume is not loaded yet.
    pub fn returned(&mut self, backend: usize) {
        let member = &mut self.members[backend];
        (member.is_lost, member.is_behind) = (false, true);
    }

    /// A back-end was asked for a frame out of turn.
    pub fn asked(&mut self, backend: usize, frame: u32, now: Duration) {
        self.members[backend].asked = Some((frame, now));
    }

    /// Frames that were shown without each back-end.
    pub fn late(&self) -> Vec<u64> {
        self.members.iter().map(|member| member.late).collect()
    }

    /// The latest frame that a back-end has drawn, since it was last lost.
    pub fn latest_of(&self, backend: usize) -> Option<u32> {
        self.members[backend].drawn
    }

    /// Back-ends that owe a frame.
    pub fn owing(&self) -> impl Iterator<Item = usize> {
        self.members.iter().enumerate().filter(|(_, m)| !m.is_lost && m.is_busy()).map(|(i, _)| i)
    }

    /// Messages take longer or shorter than was thought.
    pub fn set_lead(&mut self, lead: Duration) {
        self.rhythm.lead = lead;
    }

    /// A back-end takes as long as the slower of the middle ones: of two, the faster.
    fn typical(&self) -> Option<Duration> {
        let there = self.members.iter().filter(|member| !member.is_lost);
        let mut times: Vec<f64> = there.filter_map(|member| member.typical_s).collect();
        times.sort_by(f64::total_cmp);
        times.get(times.len().checked_sub(1)? / 2).map(|&s| Duration::from_secs_f64(s))
    }

    /// How long a frame is waited for; None while nobody knows how long frames take.
    fn patience(&self) -> Option<Duration> {
        self.typical().map(|typical| (PATIENCE * typical).max(self.rhythm.period))
    }

    /// When a frame will be seen that begins now.
    fn seen_at(&self, now: Duration) -> Duration {
        self.slot(now + self.typical().unwrap_or_default() + self.rhythm.lead)
    }

    /// The first moment of the grid that is not before a time and after the latest frame shown.
    fn slot(&self, from: Duration) -> Duration {
        let period = self.rhythm.period.as_nanos().max(1);
        let free = self.last_shown.map_or(Duration::ZERO, |last| last + Duration::from_nanos(1));
        nanoseconds(from.max(free).as_nanos().div_ceil(period) * period)
    }
}

fn nanoseconds(nanos: u128) -> Duration {
    Duration::from_nanos(u64::try_from(nanos).unwrap_or(u64::MAX))
}

#[cfg(test)]
#[path = "rhythm_tests.rs"]
mod tests;
