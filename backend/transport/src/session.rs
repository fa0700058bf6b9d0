//! A run as the front-end sees it: its back-ends set up once, then frame after frame.

use super::limits::{Limits, Patience};
use super::link::{Link, LinkError};
use super::session_error::SessionError;
use protocol::{
    DeviceInfo, Draw, DrawError, FrameReport, FrameState, FromBackend, FromFrontend, PROTOCOL_VERSION,
    RenderEvent, Setup,
};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// What a message means while the session waits for an answer from each back-end.
enum Answer<T> {
    Given(T),
    Pending,
    Misfit(&'static str),
}

/// How often to check for silence, and at the latest for a back-end's death.
const TICK: Duration = Duration::from_millis(200);

/// How often the front-end says that it is alive while it waits.
const ALIVE_INTERVAL: Duration = Duration::from_secs(1);

/// How long a back-end may take to leave off what it is drawing, once the run is stopped.
const LAST_PIECE: Duration = Duration::from_secs(20);

/// Back-ends that are set up and wait for frames.
pub struct Session {
    link: Box<dyn Link>,
    limits: Limits,
    activity: String,
    last_alive: Instant,
    devices: Vec<DeviceInfo>,
    /// True once somebody asks the run to end.
    stop: Arc<AtomicBool>,
    /// Whether a frame was left for that reason: what is still said of it does not matter.
    has_left_frame: bool,
    /// Whether back-ends write something that is complete only at the end.
    has_traces: bool,
}

impl Session {
    /// Sets the back-ends up, `setups[i]` for back-end i, and waits until all are ready. Once `stop` is true, the session
    /// waits for nothing but the end of what back-ends write.
    pub fn start(
        link: Box<dyn Link>,
        setups: Vec<Setup>,
        limits: Limits,
        stop: Arc<AtomicBool>,
    ) -> Result<Self, SessionError> {
        if setups.len() != link.backends() {
            return Err(SessionError::Count { setups: setups.len(), backends: link.backends() });
        }
        let mut session = Self::greet(link, limits, stop)?;
        session.has_traces = setups.iter().any(|setup| setup.trace.is_some());
        session.set_activity("opening its volume and device".to_owned());
        for (backend, setup) in setups.into_iter().enumerate() {
            let sent = session.link.send(backend, &FromFrontend::Setup(Box::new(setup)));
            sent.map_err(|error| session.lost(error))?;
        }
        session.devices = session.gather(|_, message| match message {
            FromBackend::Ready(info) => Answer::Given(info),
            _ => Answer::Misfit("it answered the setup with something other than ready"),
        })?;
        session.set_activity("waiting for the next frame".to_owned());
        Ok(session)
    }

    /// What to drive a display with, in place of drawing frame after frame.
    pub(crate) fn into_parts(self) -> (Box<dyn Link>, Arc<AtomicBool>) {
        (self.link, self.stop)
    }

    /// Lets back-ends go that nothing is asked of.
    pub fn dismiss(link: Box<dyn Link>, limits: Limits) -> Result<(), SessionError> {
        Self::greet(link, limits, Arc::default())?.part()
    }

    /// Waits until all back-ends have said hello.
    fn greet(link: Box<dyn Link>, limits: Limits, stop: Arc<AtomicBool>) -> Result<Self, SessionError> {
        let mut session = Self {
            link,
            limits,
            activity: String::new(),
            last_alive: Instant::now(),
            devices: Vec::new(),
            stop,
            has_left_frame: false,
            has_traces: false,
        };
        session.set_activity("starting".to_owned());
        session.gather(|_, message| match message {
            FromBackend::Hello(hello) if hello.protocol == PROTOCOL_VERSION => Answer::Given(()),
            FromBackend::Hello(_) => Answer::Misfit("it speaks another protocol"),
            _ => Answer::Misfit("it did not say hello"),
        })?;
        Ok(session)
    }

    /// What each back-end draws with.
    pub fn devices(&self) -> &[DeviceInfo] {
        &self.devices
    }

    /// Has all back-ends draw one frame; pictures and progress, summed over all of them, go to `sink` as they come.
    fn render(
        &mut self,
        frame: &FrameState,
        sink: &mut dyn FnMut(RenderEvent),
    ) -> Result<Vec<FrameReport>, SessionError> {
        self.set_activity(format!("drawing frame {}", frame.index));
        self.link
            .broadcast(&FromFrontend::Frame(Box::new(frame.clone())))
            .map_err(|error| self.lost(error))?;
        let mut parts = vec![(0, 0); self.link.backends()];
        let reports = self.gather(|backend, message| {
            match message {
                FromBackend::Progress { done, total } => {
                    parts[backend] = (done, total);
                    let (done, total) =
                        parts.iter().fold((0, 0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
                    sink(RenderEvent::Progress { done, total });
                }
                FromBackend::Image(image) => sink(RenderEvent::Image(image)),
                FromBackend::Done(report) if report.frame == frame.index => return Answer::Given(*report),
                FromBackend::Done(_) => return Answer::Misfit("it drew another frame than it was asked for"),
                _ => return Answer::Misfit("it answered a frame with something else than pictures"),
            }
            Answer::Pending
        })?;
        self.set_activity("waiting for the next frame".to_owned());
        Ok(reports)
    }

    /// Shows the back-ends that the front-end is alive. Call it now and then in long work between frames.
    pub fn keep_alive(&mut self) -> Result<(), SessionError> {
        if self.last_alive.elapsed() < ALIVE_INTERVAL {
            return Ok(());
        }
        self.last_alive = Instant::now();
        self.link.broadcast(&FromFrontend::Alive).map_err(|error| self.lost(error))
    }

    /// Lets the back-ends go, once all that they write is complete.
    fn part(&mut self) -> Result<(), SessionError> {
        self.set_activity("finishing".to_owned());
        let has_left_frame = self.has_left_frame;
        // Who asked the run to end wants what back-ends write to be complete, and that soon.
        self.stop = Arc::default();
        if has_left_frame {
            self.limits.standstill = self.limits.standstill.min(LAST_PIECE);
        }
        if self.has_traces {
            self.link.broadcast(&FromFrontend::Finish).map_err(|error| self.lost(error))?;
            self.gather(|_, message| match message {
                FromBackend::Finished => Answer::Given(()),
                FromBackend::Progress { .. } | FromBackend::Image(_) | FromBackend::Done(_)
                    if has_left_frame =>
                {
                    Answer::Pending
                }
                _ => Answer::Misfit("it answered the end with something other than its own"),
            })?;
        }
        self.link.broadcast(&FromFrontend::Quit).map_err(|error| self.lost(error))?;
        self.link.finish().map_err(|error| self.lost(error))
    }

    /// Waits until each back-end has answered, in whatever order.
    fn gather<T>(
        &mut self,
        mut take: impl FnMut(usize, FromBackend) -> Answer<T>,
    ) -> Result<Vec<T>, SessionError> {
        let mut answers: Vec<Option<T>> = (0..self.link.backends()).map(|_| None).collect();
        let mut patience = vec![Patience::default(); answers.len()];
        while answers.iter().any(Option::is_none) {
            self.check_stop()?;
            self.keep_alive()?;
            let since = Instant::now();
            let received = self.link.receive(TICK);
            // Receiving a large picture may take longer than a tick; that is this end's time, not theirs.
            let listened = since.elapsed().min(TICK);
            patience.iter_mut().for_each(|patience| patience.waited(listened));
            match received {
                Ok((backend, message)) => {
                    patience[backend].heard(!matches!(message, FromBackend::Alive));
                    self.note_answer(backend, message, &mut answers, &mut take)?;
                }
                Err(LinkError::Silent) => {}
                Err(error) => return Err(self.lost(error)),
            }
            for backend in (0..answers.len()).filter(|&backend| answers[backend].is_none()) {
                self.check_patience(backend, patience[backend])?;
            }
        }
        Ok(answers.into_iter().flatten().collect())
    }

    fn check_stop(&mut self) -> Result<(), SessionError> {
        if !self.stop.load(Ordering::SeqCst) {
            return Ok(());
        }
        self.has_left_frame = true;
        Err(SessionError::Stopped { activity: self.activity.clone() })
    }

    fn check_patience(&self, backend: usize, waited: Patience) -> Result<(), SessionError> {
        let Limits { silence, standstill } = self.limits;
        let (name, activity) = (|| self.link.name(backend), || self.activity.clone());
        if waited.silence > silence {
            return Err(SessionError::Silent {
                name: name(),
                activity: activity(),
                seconds: silence.as_secs(),
            });
        }
        if waited.standstill > standstill {
            return Err(SessionError::Stuck {
                name: name(),
                activity: activity(),
                seconds: standstill.as_secs(),
            });
        }
        Ok(())
    }

    fn note_answer<T>(
        &self,
        backend: usize,
        message: FromBackend,
        answers: &mut [Option<T>],
        take: &mut impl FnMut(usize, FromBackend) -> Answer<T>,
    ) -> Result<(), SessionError> {
        let taken = match message {
            FromBackend::Alive => Answer::Pending,
            FromBackend::Failed(sentence) | FromBackend::Lost(sentence) => {
                let (name, activity) = (self.link.name(backend), self.activity.clone());
                return Err(SessionError::Failed { name, activity, sentence });
            }
            message => take(backend, message),
        };
        match taken {
            Answer::Given(answer) if answers[backend].is_none() => answers[backend] = Some(answer),
            Answer::Given(_) => return Err(self.misfit(backend, "it answered twice")),
            Answer::Pending => {}
            Answer::Misfit(what) => return Err(self.misfit(backend, what)),
        }
        Ok(())
    }

    fn set_activity(&mut self, activity: String) {
        self.link.set_activity(&activity);
        self.activity = activity;
    }

    fn misfit(&self, backend: usize, what: &str) -> SessionError {
        SessionError::Misfit { name: self.link.name(backend), what: what.to_owned() }
    }

    fn lost(&self, error: LinkError) -> SessionError {
        SessionError::of_link(error, self.activity.clone(), |backend| self.link.name(backend))
    }
}

impl Draw for Session {
    fn draw(
        &mut self,
        frame: &FrameState,
        sink: &mut dyn FnMut(RenderEvent),
    ) -> Result<Vec<FrameReport>, DrawError> {
        self.render(frame, sink).map_err(|error| DrawError(error.to_string()))
    }

    fn finish(&mut self) -> Result<(), DrawError> {
        self.part().map_err(|error| DrawError(error.to_string()))
    }
}

#[cfg(test)]
#[path = "session_tests.rs"]
mod tests;
