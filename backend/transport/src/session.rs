//! A run as the front-end sees it: its back-ends set up once, then frame after frame.

use super::link::{Link, LinkError};
use protocol::{
    DeviceInfo, Draw, DrawError, FrameReport, FrameState, FromBackend, FromFrontend, PROTOCOL_VERSION,
    RenderEvent, Setup,
};
use std::time::{Duration, Instant};

/// How long a back-end may be silent before it counts as lost. Only time in which the front-end listens counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Before it opened its volume and device.
    pub opening: Duration,
    /// While it draws.
    pub drawing: Duration,
}

impl Default for Limits {
    /// A minute: a procedural volume or one tile on a slow device may take that long. A process that dies is noticed
    /// in a second whatever these say; they are for one that lives and is stuck, and for other hosts.
    fn default() -> Self {
        Self { opening: Duration::from_secs(60), drawing: Duration::from_secs(60) }
    }
}

/// Why a run cannot go on: a sentence that names the back-end and what to do. The session is over after it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SessionError {
    /// There is not one setup for each back-end.
    #[error(
        "there are {setups} back-ends to set up and {backends} were started; start as many back-ends as the \
         display is assigned to, or assign it again"
    )]
    Count {
        /// Setups given.
        setups: usize,
        /// Back-ends there are.
        backends: usize,
    },
    /// A back-end is gone.
    #[error("{name} ended while {activity}: {how}")]
    Ended {
        /// Its name and place.
        name: String,
        /// What the run was doing.
        activity: String,
        /// What is known of it, and what to do.
        how: String,
    },
    /// A back-end lives, or is on a host that cannot be asked, and says nothing.
    #[error(
        "{name} has said nothing for {seconds} s while {activity}; see whether it is stuck or its host is down, or \
         allow more time"
    )]
    Silent {
        /// Its name and place.
        name: String,
        /// What the run was doing.
        activity: String,
        /// How long.
        seconds: u64,
    },
    /// A back-end said why it cannot go on.
    #[error("{name} failed while {activity}: {sentence}")]
    Failed {
        /// Its name and place.
        name: String,
        /// What the run was doing.
        activity: String,
        /// What it said.
        sentence: String,
    },
    /// A back-end is of another build, or answers what was not asked.
    #[error(
        "{name} does not fit this front-end: {what}; start lightloom and lightloom-backend from the same build"
    )]
    Misfit {
        /// Its name and place.
        name: String,
        /// What it did.
        what: String,
    },
    /// The connection itself.
    #[error("the connection failed while {activity}: {error}")]
    Link {
        /// What the run was doing.
        activity: String,
        /// Why.
        error: LinkError,
    },
}

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

/// Back-ends that are set up and wait for frames.
pub struct Session {
    link: Box<dyn Link>,
    limits: Limits,
    activity: String,
    last_alive: Instant,
    devices: Vec<DeviceInfo>,
    /// Whether back-ends write something that is complete only at the end.
    has_traces: bool,
}

impl Session {
    /// Sets the back-ends up, `setups[i]` for back-end i, and waits until all are ready.
    pub fn start(link: Box<dyn Link>, setups: Vec<Setup>, limits: Limits) -> Result<Self, SessionError> {
        if setups.len() != link.backends() {
            return Err(SessionError::Count { setups: setups.len(), backends: link.backends() });
        }
        let (activity, devices) = (String::new(), Vec::new());
        let has_traces = setups.iter().any(|setup| setup.trace.is_some());
        let mut session = Self { link, limits, activity, last_alive: Instant::now(), devices, has_traces };
        session.set_activity("starting".to_owned());
        session.gather(limits.opening, |_, message| match message {
            FromBackend::Hello(hello) if hello.protocol == PROTOCOL_VERSION => Answer::Given(()),
            FromBackend::Hello(_) => Answer::Misfit("it speaks another protocol"),
            _ => Answer::Misfit("it did not say hello"),
        })?;
        session.set_activity("opening its volume and device".to_owned());
        for (backend, setup) in setups.into_iter().enumerate() {
            let sent = session.link.send(backend, &FromFrontend::Setup(Box::new(setup)));
            sent.map_err(|error| session.lost(error))?;
        }
        session.devices = session.gather(limits.opening, |_, message| match message {
            FromBackend::Ready(info) => Answer::Given(info),
            _ => Answer::Misfit("it answered the setup with something other than ready"),
        })?;
        session.set_activity("waiting for the next frame".to_owned());
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
        let reports = self.gather(self.limits.drawing, |backend, message| {
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
        if self.has_traces {
            self.link.broadcast(&FromFrontend::Finish).map_err(|error| self.lost(error))?;
            self.gather(self.limits.drawing, |_, message| match message {
                FromBackend::Finished => Answer::Given(()),
                _ => Answer::Misfit("it answered the end with something other than its own"),
            })?;
        }
        self.link.broadcast(&FromFrontend::Quit).map_err(|error| self.lost(error))?;
        self.link.finish().map_err(|error| self.lost(error))
    }

    /// Waits until each back-end has answered, in whatever order.
    fn gather<T>(
        &mut self,
        limit: Duration,
        mut take: impl FnMut(usize, FromBackend) -> Answer<T>,
    ) -> Result<Vec<T>, SessionError> {
        let mut answers: Vec<Option<T>> = (0..self.link.backends()).map(|_| None).collect();
        let mut silences = vec![Duration::ZERO; answers.len()];
        while answers.iter().any(Option::is_none) {
            self.keep_alive()?;
            let since = Instant::now();
            let received = self.link.receive(TICK);
            // Receiving a large picture may take longer than a tick; that is this end's time, not their silence.
            let listened = since.elapsed().min(TICK);
            silences.iter_mut().for_each(|silence| *silence += listened);
            match received {
                Ok((backend, message)) => {
                    silences[backend] = Duration::ZERO;
                    self.note_answer(backend, message, &mut answers, &mut take)?;
                }
                Err(LinkError::Silent) => {}
                Err(error) => return Err(self.lost(error)),
            }
            let is_stuck = |b: &usize| answers[*b].is_none() && silences[*b] > limit;
            if let Some(backend) = (0..answers.len()).find(is_stuck) {
                let (name, activity) = (self.link.name(backend), self.activity.clone());
                return Err(SessionError::Silent { name, activity, seconds: limit.as_secs() });
            }
        }
        Ok(answers.into_iter().flatten().collect())
    }

    fn note_answer<T>(
        &self,
        backend: usize,
        message: FromBackend,
        answers: &mut [Option<T>],
        take: &mut impl FnMut(usize, FromBackend) -> Answer<T>,
    ) -> Result<(), SessionError> {
        if let FromBackend::Failed(sentence) = message {
            let (name, activity) = (self.link.name(backend), self.activity.clone());
            return Err(SessionError::Failed { name, activity, sentence });
        }
        match take(backend, message) {
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
        explain(error, self.activity.clone(), |backend| self.link.name(backend))
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

fn explain(error: LinkError, activity: String, name: impl Fn(usize) -> String) -> SessionError {
    match error {
        LinkError::Ended { backend, how } => SessionError::Ended { name: name(backend), activity, how },
        LinkError::Garbled { backend, error } => {
            SessionError::Misfit { name: name(backend), what: error.to_string() }
        }
        error => SessionError::Link { activity, error },
    }
}

#[cfg(test)]
#[path = "session_tests.rs"]
mod tests;
