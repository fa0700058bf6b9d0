//! The loop of a driven display.

use super::measures::Measures;
use super::plot::plot_of_beat;
use super::{
    BeatSummary, ControlSummary, Controlled, Input, KEYS, Recorder, Request, Screens, Status, Trial,
};
use crate::FrontendError;
use crate::report::plot::strip_of_control;
use crate::staging::Theatre;
use protocol::{FrameState, Refinement, Stages};
use serde::Serialize;
use std::time::{Duration, Instant};
use transport::beat::{Drive, Happening};
use world::Moment;

/// When a show ends, besides by somebody who ends it, and what it finds out.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// After so many frames.
    pub frames: Option<u32>,
    /// After so long.
    pub time: Option<Duration>,
    /// Finds the faster caster, where back-ends may choose it.
    pub trial: Option<Trial>,
    /// Decides what is cast and what is shown; without it each frame is drawn and shown.
    pub control: Option<Controlled>,
}

/// Why a show ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// Somebody asked it to, by a signal.
    Stopped,
    /// Somebody left, at the window.
    Left,
    /// It had its frames, or its time.
    Planned,
    /// The script is over.
    Script,
}

/// A show that is over.
#[derive(Clone, Debug, Serialize)]
pub struct Played {
    /// Why it ended.
    pub end: End,
    /// How long it lasted on the display's clock.
    #[serde(skip)]
    pub length: Duration,
    /// How the beat was kept.
    pub beat: BeatSummary,
    /// The same as a plot.
    #[serde(skip)]
    pub plot: String,
    /// How frames were controlled, if they were.
    pub control: Option<ControlSummary>,
    /// The same over time, as a strip.
    #[serde(skip)]
    pub strip: String,
    /// What each back-end spent on all that it drew.
    pub stages: Vec<Stages>,
    /// What became of back-ends that were lost, sentence by sentence; the latest of many.
    pub troubles: Vec<String>,
    /// Whether the last frame of each back-end was complete, or why not.
    pub shortfall: Vec<String>,
    /// What cast the rays of the last frame, a line for each kind.
    pub casters: Vec<String>,
}

/// Troubles that are kept.
const MOST_TROUBLES: usize = 100;

/// What comes into a show, and what is kept of it.
pub struct Desk<'a, 'b> {
    /// What is asked before each frame.
    pub inputs: Vec<&'a mut dyn Input>,
    /// What keeps a record.
    pub recorders: Vec<&'a mut dyn Recorder>,
    /// Told in sentences what goes wrong, and what keys there are.
    pub tell: &'b mut dyn FnMut(&str),
}

/// A show.
struct Show<'a, 'b> {
    drive: &'a mut Drive,
    theatre: &'a mut Theatre,
    desk: Desk<'a, 'b>,
    screens: &'a mut Screens<'b>,
    measures: Measures,
    trial: Option<Trial>,
    control: Option<Controlled>,
    stages: Vec<Stages>,
    lost: Vec<u64>,
    troubles: Vec<String>,
    /// Of each back-end's latest frame.
    latest: Vec<(String, String)>,
}

/// Drives a display until its end.
///
/// # Errors
/// The show cannot go on.
pub fn run<'a, 'b>(
    drive: &'a mut Drive,
    theatre: &'a mut Theatre,
    desk: Desk<'a, 'b>,
    screens: &'a mut Screens<'b>,
    plan: &Plan,
    status: &mut Status,
) -> Result<Played, FrontendError> {
    let backends = drive.devices().len();
    let began = drive.now();
    let mut show = Show {
        drive,
        theatre,
        desk,
        screens,
        measures: Measures::default(),
        trial: plan.trial.clone(),
        control: plan.control.clone(),
        stages: vec![Stages::default(); backends],
        lost: vec![0; backends],
        troubles: Vec::new(),
        latest: vec![Default::default(); backends],
    };
    let end = loop {
        let happening = show.drive.await_next()?;
        let now = show.drive.now();
        match happening {
            Happening::Stopped => break End::Stopped,
            Happening::Due { frame, seen_at } => {
                let is_planned = plan.frames.is_some_and(|frames| frame >= frames)
                    || plan.time.is_some_and(|time| now >= began + time);
                if is_planned {
                    break End::Planned;
                }
                if let Some(end) = show.begin(frame, seen_at, now)? {
                    break end;
                }
                let look = show.theatre.look().map(|look| format!(", look {look}")).unwrap_or_default();
                let control = show.control.as_ref().map(Controlled::line).unwrap_or_default();
                let what = control + &look;
                status.tell(now, &what, || show.measures.summary(&show.drive.late(), &show.lost));
            }
            other => show.heed(other, now)?,
        }
    };
    if end != End::Stopped {
        // What is under way is still to be seen.
        while let Some(happening) = show.drive.settle()? {
            let now = show.drive.now();
            show.heed(happening, now)?;
        }
    }
    let mut casters: Vec<String> = show.latest.iter().map(|latest| latest.0.clone()).collect();
    casters.dedup();
    Ok(Played {
        end,
        length: show.drive.now().saturating_sub(began),
        beat: show.measures.summary(&show.drive.late(), &show.lost),
        plot: plot_of_beat(&show.measures.interval, &show.measures.latency, &show.measures.skew),
        control: show.control.as_ref().map(Controlled::summary),
        strip: show
            .control
            .as_ref()
            .map(|control| strip_of_control("Frame control", &control.ticks()).svg())
            .unwrap_or_default(),
        stages: show.stages,
        troubles: show.troubles,
        shortfall: show.latest.into_iter().map(|latest| latest.1).filter(|why| !why.is_empty()).collect(),
        casters,
    })
}

impl Show<'_, '_> {
    /// Asks the inputs, and begins a frame. Why the show ends instead, if it does.
    fn begin(&mut self, frame: u32, seen_at: Duration, now: Duration) -> Result<Option<End>, FrontendError> {
        let (moment, mut requests, mut news) = (self.moment(now, seen_at), Vec::new(), Vec::new());
        for input in &mut self.desk.inputs {
            input.poll(moment, &mut requests);
            news.extend(input.news());
        }
        news.extend(self.desk.recorders.iter_mut().flat_map(|recorder| recorder.news()));
        news.iter().for_each(|sentence| self.say(moment.now, sentence));
        for request in requests {
            match request {
                Request::Quit => return Ok(Some(End::Left)),
                Request::Help => (self.desk.tell)(KEYS),
                Request::Deed(deed) => {
                    self.desk.recorders.iter_mut().for_each(|recorder| recorder.deed(moment.now, &deed));
                    self.theatre.apply(&deed);
                }
            }
        }
        if self.theatre.is_over() {
            return Ok(Some(End::Script));
        }
        let shown = |theatre: &Theatre| (theatre.stage().item, theatre.stage().look);
        let before = shown(self.theatre);
        let mut state = self.theatre.frame(frame, moment)?;
        self.desk.inputs.iter_mut().for_each(|input| input.made(&state));
        let counts: Vec<_> = self.desk.inputs.iter().flat_map(|input| input.counts()).collect();
        let beat = || self.measures.summary(&self.drive.late(), &self.lost);
        for recorder in &mut self.desk.recorders {
            recorder.inputs(counts.clone());
            recorder.frame(&state, moment, self.theatre, &beat)?;
        }
        if let Some(trial) = self.trial.as_mut().filter(|_| shown(self.theatre) != before) {
            trial.restart();
        }
        let Self { trial, control, .. } = self;
        let mut welcomes_planes = || trial.as_mut().is_some_and(|trial| trial.begin(frame));
        let Some(control) = control else {
            state.welcomes_planes = welcomes_planes();
            self.measures.began(frame, now);
            self.hand_over(&state, None)?;
            return Ok(None);
        };
        match control.next(state, now, welcomes_planes) {
            Some(task) => {
                self.measures.began(frame, task.asked_at);
                self.hand_over(&task.frame, task.newest)?;
            }
            None => self.drive.pass(),
        }
        Ok(None)
    }

    /// Tells all back-ends what to draw, and counts how long that keeps the front-end.
    fn hand_over(&mut self, frame: &FrameState, newest: Option<FrameState>) -> Result<(), FrontendError> {
        let start = Instant::now();
        self.drive.draw(frame, newest)?;
        self.measures.handed_over(start.elapsed());
        Ok(())
    }

    /// The moment of the frame that is due: that of the display's clock, unless an input has its own.
    fn moment(&mut self, now: Duration, seen_at: Duration) -> Moment {
        let own = self.desk.inputs.iter_mut().find_map(|input| input.moment());
        own.unwrap_or(Moment { now, seen_at })
    }

    /// Tells a sentence, and keeps it.
    fn say(&mut self, now: Duration, sentence: &str) {
        (self.desk.tell)(sentence);
        self.desk.recorders.iter_mut().for_each(|recorder| recorder.said(now, sentence));
    }

    fn heed(&mut self, happening: Happening, now: Duration) -> Result<(), FrontendError> {
        match happening {
            Happening::Screen { backend, image } => self.screens.take(backend, image),
            Happening::Drawn { backend, report } => {
                self.measures.drawn(backend, report.frame, report.total_ms);
                self.stages[backend] = self.stages[backend] + report.stages;
                // Of a part of a picture: as if it were a quarter.
                let units = self.control.as_ref().map(|control| control.units_of(report.frame));
                let of_quarter = match units {
                    None => Some(1.0),
                    Some(units) => units.map(|units| f64::from(Refinement::UNITS / 4) / f64::from(units)),
                };
                if let (Some(trial), Some(factor)) = (&mut self.trial, of_quarter) {
                    trial.drawn(report.frame, &report.caster, factor * report.total_ms, now);
                }
                self.control.iter_mut().for_each(|control| control.drawn(&report));
                self.screens.drawn(backend, report.frame, now)?;
                self.latest[backend] = (report.caster.to_string(), report.shortfall);
            }
            Happening::Finished { frame } => {
                let shows = self.control.as_mut().is_none_or(|control| control.finished(now));
                match self.drive.decide(shows)? {
                    Some(ordered) => self.heed(ordered, now)?,
                    None => self.screens.kept_back(frame),
                }
            }
            Happening::Ordered { frame, at } => {
                self.measures.ordered(frame);
                self.screens.ordered(frame, at, now)?;
            }
            Happening::Shown { backend, frame, at, away } => {
                self.measures.shown(backend, frame, at);
                if let Some(away) = away {
                    self.measures.came_back(backend, away);
                    let (count, seconds) = (self.lost[backend], away.as_secs_f64());
                    self.trouble(
                        backend,
                        &format!(
                            " shows again, {seconds:.2} s after it was lost (loss {count} of this show)"
                        ),
                    );
                }
            }
            Happening::Said { backend, sentence } => self.trouble(backend, &format!(": {sentence}")),
            Happening::Lost { backend, why } => {
                self.lost[backend] += 1;
                self.screens.forget(backend);
                self.measures.lost(backend);
                self.trouble(backend, &format!(" is lost, and is started again: {why}"));
            }
            Happening::Standstill { backend, time } => {
                let seconds = time.as_secs();
                self.trouble(
                    backend,
                    &format!(
                        " has drawn nothing for {seconds} s; a frame is that much work for it, or its graphics driver \
                         or the disk with the volume is stuck"
                    ),
                );
            }
            Happening::Due { .. } | Happening::Stopped => {}
        }
        Ok(())
    }

    /// Tells what has become of a back-end: its name, and what follows that in a sentence.
    fn trouble(&mut self, backend: usize, rest: &str) {
        let sentence = self.drive.name(backend) + rest;
        let now = self.drive.now();
        self.say(now, &sentence);
        if self.troubles.len() == MOST_TROUBLES {
            self.troubles.remove(0);
        }
        self.troubles.push(sentence);
    }
}
