//! The front-end's side of a driven display: frames on the beat, over a link.

use super::asking::{Asking, Say};
use super::attendance::{Attendance, Presence};
use super::clocks::OtherClock;
use super::happening::Happening;
use super::rhythm::{Beat, Rhythm, Step};
use super::time::Time;
use crate::link::{Link, LinkError};
use crate::session::Session;
use crate::session_error::SessionError;
use protocol::{DeviceInfo, FrameState, FromBackend, FromFrontend, PROTOCOL_VERSION, Setup};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How long to listen before anything else is looked after.
const TICK: Duration = Duration::from_millis(50);

/// What the run is doing, for sentences.
const ACTIVITY: &str = "driving the display";

/// How often back-ends hear that the front-end is alive, where it has no questions.
const ALIVE_INTERVAL: Duration = Duration::from_secs(1);

/// How long to wait for the next word of what is under way when the show is over.
const LONGEST_SETTLING: Duration = Duration::from_secs(5);

/// What an order needs besides the way of its message: a back-end looks for messages every millisecond.
const LEAD: Duration = Duration::from_millis(3);

/// Enough for every back-end of a machine to show its pictures before any of them draws again.
const BREATH: Duration = Duration::from_millis(1);

/// A display that is driven.
pub struct Drive {
    link: Box<dyn Link>,
    setups: Vec<Setup>,
    devices: Vec<DeviceInfo>,
    stop: Arc<AtomicBool>,
    beat: Beat,
    time: Time,
    clocks: Vec<OtherClock>,
    attendance: Vec<Attendance>,
    /// The latest frame that each was told to show and has drawn, until it says that it shows it.
    owes_show: Vec<Option<u32>>,
    asking: Asking,
    /// The latest frame that was asked for.
    latest: Option<FrameState>,
    /// The latest frame that all were told to show.
    ordered: Option<u32>,
    said_alive_at: Instant,
    /// Whether somebody decides of each frame whether it is shown.
    is_controlled: bool,
    /// The frame that waits for that, and when it would be shown.
    finished: Option<(u32, Duration)>,
}

impl Drive {
    /// Drives the display of a session's back-ends, which were set up with `setups`, a frame every `period` at best.
    pub fn new(session: Session, setups: Vec<Setup>, period: Duration, time: Time) -> Self {
        let devices = session.devices().to_vec();
        let (link, stop) = session.into_parts();
        let backends = link.backends();
        let [lead, breath] = if time.is_stepped() { [Duration::ZERO; 2] } else { [LEAD, BREATH] };
        Self {
            link,
            setups,
            devices,
            stop,
            beat: Beat::new(Rhythm { period, lead, breath }, backends, time.now()),
            time,
            clocks: vec![OtherClock::default(); backends],
            attendance: vec![Attendance::default(); backends],
            owes_show: vec![None; backends],
            asking: Asking::default(),
            latest: None,
            ordered: None,
            said_alive_at: Instant::now(),
            is_controlled: false,
            finished: None,
        }
    }

    /// Each frame is shown only if somebody decides so: see [`Happening::Finished`].
    #[must_use]
    pub fn controlled(self) -> Self {
        Self { is_controlled: true, ..self }
    }

    /// What each back-end draws with.
    pub fn devices(&self) -> &[DeviceInfo] {
        &self.devices
    }

    /// What the display's clock says.
    pub fn now(&self) -> Duration {
        self.time.now()
    }

    /// Frames that were shown without each back-end.
    pub fn late(&self) -> Vec<u64> {
        self.beat.late()
    }

    /// A back-end's name and place.
    pub fn name(&self, backend: usize) -> String {
        self.link.name(backend)
    }

    /// Hands over the frame that is due, and what it is compared with.
    ///
    /// # Errors
    /// It cannot be sent.
    pub fn draw(&mut self, frame: &FrameState, newest: Option<FrameState>) -> Result<(), SessionError> {
        let newest = newest.map(Box::new);
        self.tell_all(&FromFrontend::Beat { frame: Box::new(frame.clone()), newest })?;
        self.beat.begin(self.time.now());
        for backend in self.there() {
            self.attendance[backend].asked(Instant::now());
        }
        self.latest = Some(frame.clone());
        Ok(())
    }

    /// There is nothing to draw when a frame is due.
    pub fn pass(&mut self) {
        self.beat.pass(self.time.now());
    }

    /// The frame that is finished is shown, or it is not.
    ///
    /// # Errors
    /// A back-end cannot be told.
    pub fn decide(&mut self, shows: bool) -> Result<Option<Happening>, SessionError> {
        let Some((frame, at)) = self.finished.take() else { return Ok(None) };
        if shows {
            return self.show(frame, at).map(Some);
        }
        self.beat.keep_back(self.time.now());
        Ok(None)
    }

    /// The next thing that happens. It waits for one.
    ///
    /// # Errors
    /// A back-end is lost and cannot be started again, or is of another build.
    pub fn await_next(&mut self) -> Result<Happening, SessionError> {
        loop {
            if self.stop.load(Ordering::SeqCst) {
                return Ok(Happening::Stopped);
            }
            if let Some(happening) = self.poll()? {
                return Ok(happening);
            }
        }
    }

    /// The same, but it waits no longer than a moment; None where nothing happened.
    fn poll(&mut self) -> Result<Option<Happening>, SessionError> {
        self.ask_clocks()?;
        if let Some(standstill) = self.look_for_standstill() {
            return Ok(Some(standstill));
        }
        let now = self.time.now();
        let until = match self.beat.step(now) {
            Step::Begin { .. } if self.time.is_stepped() && self.is_anything_under_way() => None,
            Step::Begin { frame, seen_at } => return Ok(Some(Happening::Due { frame, seen_at })),
            Step::Show { frame, at } if self.is_controlled => {
                self.finished = Some((frame, at));
                return Ok(Some(Happening::Finished { frame }));
            }
            Step::Show { frame, at } => return self.show(frame, at).map(Some),
            Step::Wait { until: Some(until) } if self.time.is_stepped() && !self.is_anything_under_way() => {
                self.time.jump(until);
                return Ok(None);
            }
            Step::Wait { until } => until.filter(|_| !self.time.is_stepped()),
        };
        let wait = until.map_or(TICK, |until| until.saturating_sub(now).min(TICK));
        self.listen(wait)
    }

    /// What comes from a back-end within a time, and means something.
    fn listen(&mut self, wait: Duration) -> Result<Option<Happening>, SessionError> {
        match self.link.receive(wait) {
            Ok((backend, message)) => self.heed(backend, message),
            Err(LinkError::Silent) => Ok(None),
            Err(LinkError::Ended { backend, how }) => self.revive(backend, how),
            Err(error) => Err(self.explain(error)),
        }
    }

    /// The next thing that happens of what is under way, without a new frame; None once nothing is, or it takes too long.
    ///
    /// # Errors
    /// See [`Drive::await_next`].
    pub fn settle(&mut self) -> Result<Option<Happening>, SessionError> {
        let since = Instant::now();
        while since.elapsed() < LONGEST_SETTLING && !self.stop.load(Ordering::SeqCst) {
            if let Step::Show { frame, at } = self.beat.step(self.time.now()) {
                return self.show(frame, at).map(Some);
            }
            if !self.is_anything_under_way() {
                break;
            }
            if let Some(happening) = self.listen(TICK)? {
                return Ok(Some(happening));
            }
        }
        Ok(None)
    }

    /// Whether a back-end is drawing, or about to show what it has drawn.
    fn is_anything_under_way(&self) -> bool {
        self.beat.owing().next().is_some()
            || (0..self.attendance.len()).any(|backend| {
                !self.attendance[backend].is_there()
                    || self.owes_show[backend]
                        .is_some_and(|frame| self.beat.latest_of(backend) >= Some(frame))
            })
    }

    /// Tells all to show a frame.
    fn show(&mut self, frame: u32, at: Duration) -> Result<Happening, SessionError> {
        let at_us = at.as_micros() as u64;
        self.ordered = Some(frame);
        for backend in self.there() {
            let there_us = (!self.time.is_stepped()).then(|| self.clocks[backend].there(at_us));
            self.tell(backend, &FromFrontend::Show { frame, at_us: there_us })?;
            self.owes_show[backend] = Some(frame);
        }
        Ok(Happening::Ordered { frame, at })
    }

    /// A back-end that has drawn nothing for long, if that is not known yet.
    fn look_for_standstill(&mut self) -> Option<Happening> {
        let now = Instant::now();
        let mut each = self.attendance.iter_mut().enumerate();
        each.find_map(|(backend, one)| Some(Happening::Standstill { backend, time: one.standstill(now)? }))
    }

    /// Asks for clocks, now and then; where time only steps it just says that somebody is there.
    fn ask_clocks(&mut self) -> Result<(), SessionError> {
        if self.time.is_stepped() {
            if self.said_alive_at.elapsed() < ALIVE_INTERVAL {
                return Ok(());
            }
            self.said_alive_at = Instant::now();
            return self.tell_all(&FromFrontend::Alive);
        }
        let now = self.time.now();
        match self.asking.say(now, self.link.is_at_rest()) {
            Say::Nothing => return Ok(()),
            Say::Alive => return self.tell_all(&FromFrontend::Alive),
            Say::Question => {}
        }
        let slowest = self.clocks.iter().filter_map(OtherClock::usual_trip_us).max().unwrap_or(0);
        self.beat.set_lead(LEAD + Duration::from_micros(slowest));
        self.tell_all(&FromFrontend::Clock { asked_us: now.as_micros() as u64 })
    }

    /// What a message means.
    fn heed(&mut self, backend: usize, message: FromBackend) -> Result<Option<Happening>, SessionError> {
        let now = self.time.now();
        let misfit = |drive: &Self, what: &str| {
            Err(SessionError::Misfit { name: drive.link.name(backend), what: what.to_owned() })
        };
        Ok(match (message, self.attendance[backend].presence()) {
            (FromBackend::Failed(sentence), _) if !self.attendance[backend].has_drawn() => {
                let (name, activity) = (self.link.name(backend), ACTIVITY.to_owned());
                return Err(SessionError::Failed { name, activity, sentence });
            }
            (FromBackend::Failed(why), _) => {
                self.tell(backend, &FromFrontend::Quit)?;
                Some(self.lose(backend, Presence::Leaving, why))
            }
            (FromBackend::Lost(why), _) => Some(self.lose(backend, Presence::Greeting, why)),
            (FromBackend::Hello(hello), Presence::Greeting) if hello.protocol == PROTOCOL_VERSION => {
                self.attendance[backend].comes(Presence::Opening);
                let setup = self.setups[backend].clone();
                self.tell(backend, &FromFrontend::Setup(Box::new(setup)))?;
                None
            }
            (FromBackend::Ready(info), Presence::Opening) => {
                self.devices[backend] = info;
                self.welcome(backend)?;
                None
            }
            (FromBackend::Alive | FromBackend::Progress { .. }, _) => None,
            // What is left of one that was let go.
            (_, Presence::Leaving) => None,
            (FromBackend::Drawn(report), Presence::There) => {
                self.beat.drawn(backend, report.frame, now);
                let owes_more = self.beat.owing().any(|owing| owing == backend);
                self.attendance[backend].drew(owes_more, Instant::now());
                Some(Happening::Drawn { backend, report })
            }
            (FromBackend::Screen(image), Presence::There) => Some(Happening::Screen { backend, image }),
            (FromBackend::Said(sentence), _) => Some(Happening::Said { backend, sentence }),
            (FromBackend::Shown { frame, at_us }, Presence::There) => {
                self.owes_show[backend] = self.owes_show[backend].filter(|&owed| owed > frame);
                let at = match self.time.is_stepped() {
                    true => now,
                    false => Duration::from_micros(self.clocks[backend].here(at_us)),
                };
                let away = self.attendance[backend].shows(Instant::now());
                Some(Happening::Shown { backend, frame, at, away })
            }
            (FromBackend::Clock { asked_us, here_us }, Presence::There) => {
                self.clocks[backend].learn(asked_us, here_us, now.as_micros() as u64);
                None
            }
            _ => return misfit(self, "it answered the beat with something else"),
        })
    }

    fn lose(&mut self, backend: usize, presence: Presence, why: String) -> Happening {
        self.attendance[backend].lose(presence, Instant::now());
        self.owes_show[backend] = None;
        self.beat.lost(backend);
        Happening::Lost { backend, why }
    }

    /// A back-end that was lost takes part again: it draws the present frame, however far the next one is.
    fn welcome(&mut self, backend: usize) -> Result<(), SessionError> {
        self.attendance[backend].comes(Presence::There);
        self.clocks[backend] = OtherClock::default();
        self.beat.returned(backend);
        if !self.time.is_stepped() {
            // Without it nobody knows when anything is for a process that has just begun.
            let asked_us = self.time.now().as_micros() as u64;
            self.tell(backend, &FromFrontend::Clock { asked_us })?;
        }
        let Some(frame) = self.latest.clone() else { return Ok(()) };
        let index = frame.index;
        if !self.attendance[backend].may_catch_up_with(index) {
            return Ok(());
        }
        self.tell(backend, &FromFrontend::Beat { frame: Box::new(frame), newest: None })?;
        if self.ordered >= Some(index) {
            self.tell(backend, &FromFrontend::Show { frame: index, at_us: None })?;
            self.owes_show[backend] = Some(index);
        }
        self.beat.asked(backend, index, self.time.now());
        self.attendance[backend].asked(Instant::now());
        Ok(())
    }

    /// A back-end has ended: starts it again.
    fn revive(&mut self, backend: usize, how: String) -> Result<Option<Happening>, SessionError> {
        let was_known = self.attendance[backend].presence() == Presence::Leaving;
        if !self.link.revive(backend).map_err(|error| self.explain(error))? {
            return Err(self.explain(LinkError::Ended { backend, how }));
        }
        let lost = self.lose(backend, Presence::Greeting, how);
        Ok((!was_known).then_some(lost))
    }

    /// Lets the back-ends go.
    ///
    /// # Errors
    /// They cannot be reached any more.
    pub fn finish(&mut self) -> Result<(), SessionError> {
        // Also to those that are away: their keepers are there.
        self.link.broadcast(&FromFrontend::Quit).map_err(|error| self.explain(error))?;
        self.link.finish().map_err(|error| self.explain(error))
    }

    fn there(&self) -> Vec<usize> {
        (0..self.attendance.len()).filter(|&backend| self.attendance[backend].is_there()).collect()
    }

    fn tell_all(&mut self, message: &FromFrontend) -> Result<(), SessionError> {
        let there = self.there();
        let told = match there.len() == self.attendance.len() {
            true => self.link.broadcast(message),
            false => there.into_iter().try_for_each(|backend| self.link.send(backend, message)),
        };
        told.map_err(|error| self.explain(error))
    }

    fn tell(&mut self, backend: usize, message: &FromFrontend) -> Result<(), SessionError> {
        self.link.send(backend, message).map_err(|error| self.explain(error))
    }

    fn explain(&self, error: LinkError) -> SessionError {
        SessionError::of_link(error, ACTIVITY.to_owned(), |backend| self.link.name(backend))
    }
}

#[cfg(test)]
#[path = "drive_tests.rs"]
mod tests;
