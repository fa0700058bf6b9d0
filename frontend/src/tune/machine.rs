//! A machine of some speed that plays a scenario by a rule.
//!
//! It is simulated: a ray takes always the same time, whatever it meets, and what rays of a state find is taken from that
//! state's complete pictures. So a rule meets the same machine in every scenario and on every host.

use super::painter::{Lattices, Painter};
use super::{Footage, RATE_HZ};
use crate::report::plot::StripTick;
use control::{Budget, Control, Found, News, Rule, Work};
use protocol::{ProjectorImage, SubFrame};
use renderer::output::Picture;
use renderer::present::{Classes, Raster, Thresholds, lattice_of, reconstruct};
use std::time::Duration;

/// What a tick takes besides its rays: messages, reconstruction, and handing pictures to screens.
const OVERHEAD: Duration = Duration::from_millis(2);
/// From the order to show a picture to the moment it is shown.
const LEAD: Duration = Duration::from_millis(3);

/// A machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Machine {
    /// What complete pictures of all projectors take it.
    pub full: Duration,
}

/// How it decides what to cast and to show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contender {
    /// By frame control.
    Control(Rule),
    /// The same, with τ as the sum over all changes on the way, as the paper has it.
    ControlByPath(Rule),
    /// A quarter of the pixels of the newest state in every frame, the others reconstructed in space and time.
    Quincunx,
}

/// What happened in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// When it ended.
    pub at: Duration,
    /// The instant that it casts.
    pub instant: usize,
    /// The share of its rays that are cast.
    pub share: f64,
    /// ζ and τ of it.
    pub errors: [f64; 2],
    /// Whether it began a configuration.
    pub begins: bool,
    /// Whether what it made is shown.
    pub shows: bool,
}

/// How a scenario went.
#[derive(Clone, Debug, Default)]
pub struct Played {
    /// Tick by tick; none of quincunx.
    pub ticks: Vec<Tick>,
    /// How long rays were cast.
    pub busy: Duration,
    /// Pictures that were shown.
    pub shown: u32,
    /// Configurations that were begun.
    pub begun: u32,
}

/// Plays footage on a machine; `see` is given what the eye is shown at each instant.
pub fn play(
    footage: &Footage,
    contender: Contender,
    machine: Machine,
    see: &mut dyn FnMut(usize, &Picture),
) -> Played {
    let mut lattices = Lattices::new(footage);
    match contender {
        Contender::Control(rule) => play_painted(footage, &mut lattices, rule, machine, see),
        Contender::ControlByPath(rule) => {
            Controlled { by_path: true, ..Controlled::new(footage, &mut lattices, rule, machine) }.play(see)
        }
        Contender::Quincunx => {
            let mut screen = Screen::new(footage, see);
            let played = play_quincunx(footage, machine, &mut screen);
            screen.until(footage.len());
            played
        }
    }
}

/// The same by frame control, of what a painter makes of it.
pub fn play_painted(
    footage: &Footage,
    painter: &mut dyn Painter,
    rule: Rule,
    machine: Machine,
    see: &mut dyn FnMut(usize, &Picture),
) -> Played {
    Controlled::new(footage, painter, rule, machine).play(see)
}

/// What the eye is shown.
struct Screen<'a, 'b> {
    footage: &'a Footage,
    see: &'b mut dyn FnMut(usize, &Picture),
    /// The first instant that has not been seen.
    next: usize,
    picture: Picture,
}

impl<'a, 'b> Screen<'a, 'b> {
    fn new(footage: &'a Footage, see: &'b mut dyn FnMut(usize, &Picture)) -> Self {
        Self { footage, see, next: 0, picture: footage.truth(0).clone() }
    }

    /// These pictures are ready at a time, and shown at the next instant that leaves time for the order.
    fn show<'p>(&mut self, at: Duration, pictures: impl Iterator<Item = &'p [f32]>) {
        self.until(((at + LEAD).as_secs_f64() * RATE_HZ).ceil() as usize);
        self.picture = self.footage.eye(pictures);
    }

    /// The eye sees the same until an instant.
    fn until(&mut self, instant: usize) {
        for instant in self.next..instant.min(self.footage.len()) {
            (self.see)(instant, &self.picture);
        }
        self.next = self.next.max(instant);
    }
}

struct Controlled<'a> {
    footage: &'a Footage,
    painter: &'a mut dyn Painter,
    machine: Machine,
    control: Control,
    budget: Budget,
    by_path: bool,
    /// The instant that is cast, and how many units of it are.
    active: Option<(usize, u32)>,
    /// The instant that was looked at last, and how far the way to it is.
    path: (usize, f64),
    played: Played,
}

impl<'a> Controlled<'a> {
    fn new(footage: &'a Footage, painter: &'a mut dyn Painter, rule: Rule, machine: Machine) -> Self {
        Self {
            footage,
            machine,
            control: Control::new(rule, painter.units()),
            painter,
            budget: Budget::of_time(Duration::from_secs_f64(1.0 / RATE_HZ)),
            by_path: false,
            active: None,
            path: (0, 0.0),
            played: Played::default(),
        }
    }

    fn play(mut self, see: &mut dyn FnMut(usize, &Picture)) -> Played {
        let mut screen = Screen::new(self.footage, see);
        let mut now = Duration::ZERO;
        while let Some(newest) = self.footage.instant_at(now) {
            now = self.tick(now, newest, &mut screen);
        }
        screen.until(self.footage.len());
        self.played
    }

    /// A tick that begins at a time; when it ends.
    fn tick(&mut self, began: Duration, newest: usize, screen: &mut Screen) -> Duration {
        let has_changed = self.active.is_none_or(|(active, _)| !self.footage.is_same(active, newest));
        let news = News { has_changed, has_detail: false };
        let (before, begins, from) = match self.control.next(news, began) {
            Work::Rest => return began + Duration::from_secs_f64(1.0 / RATE_HZ),
            Work::Begin => (self.active, true, 0),
            Work::Refine { from } => (self.active, false, from),
        };
        let active = if begins { newest } else { before.map_or(newest, |active| active.0) };
        let done = (from + self.budget.units()).min(self.painter.units());
        self.active = Some((active, done));
        // A look at the newest state costs as many rays as the first unit.
        let looks = !begins && has_changed;
        let look = if looks { self.painter.cost(0, 1) } else { 0.0 };
        let rays = self.machine.full.mul_f64(self.painter.cost(from, done) + look);
        self.budget.took(done - from + u32::from(looks), OVERHEAD + rays, rays);
        self.played.busy += rays;
        let now = began + OVERHEAD + rays;
        let change = match (begins, before) {
            (true, Some((before, _))) => Some(self.painter.change(active, before)),
            (false, _) if looks => Some(self.change_on_the_way(newest, active)),
            _ => None,
        };
        if begins {
            self.painter.begin();
            self.path = (active, 0.0);
            self.played.begun += 1;
        }
        let spatial = self.painter.paint(active, done);
        let news = News { has_changed: looks, has_detail: false };
        let shows = self.control.found(Found { done, spatial, change, news }, now);
        if shows {
            screen.show(now, self.painter.pictures().into_iter());
            self.played.shown += 1;
        }
        let errors = self.control.errors().unwrap_or_default();
        let share = f64::from(done) / f64::from(self.painter.units());
        self.played.ticks.push(Tick { at: now, instant: active, share, errors, begins, shows });
        now
    }

    /// How far the newest state is from the active one, directly or by way of those between.
    fn change_on_the_way(&mut self, newest: usize, active: usize) -> f64 {
        if !self.by_path {
            return self.painter.change(newest, active);
        }
        let (last, length) = self.path;
        self.path = (newest, length + self.painter.change(newest, last));
        self.path.1
    }
}

fn play_quincunx(footage: &Footage, machine: Machine, screen: &mut Screen) -> Played {
    let (mut played, mut now, mut number) = (Played::default(), Duration::ZERO, 0);
    let mut shown: Vec<ProjectorImage> = footage.pictures(0).to_vec();
    let (mut known, mut active) = (Classes::default(), None);
    while let Some(newest) = footage.instant_at(now) {
        let is_same = active.is_some_and(|active| footage.is_same(active, newest));
        if is_same && known == Classes::ALL {
            now += Duration::from_secs_f64(1.0 / RATE_HZ);
            continue;
        }
        let cast = Classes::of_lattice(&lattice_of(Some(SubFrame::of_frame(number)), false));
        known = if is_same { known } else { Classes::default() }.with(cast);
        let rays = machine.full / 4;
        now += OVERHEAD + rays;
        played.busy += rays;
        for (shown, cast) in shown.iter_mut().zip(footage.pictures(newest)) {
            let raster = Raster::of([cast.width, cast.height]);
            shown.rgba = reconstruct(&cast.rgba, Some(&shown.rgba), raster, known, Thresholds::default());
        }
        screen.show(now, shown.iter().map(|one| &one.rgba[..]));
        (active, number) = (Some(newest), number.wrapping_add(1));
        played.shown += 1;
        played.begun += u32::from(!is_same);
    }
    played
}

/// A tick as a strip shows it.
pub(super) fn strip_tick(tick: &Tick) -> StripTick {
    let Tick { at, share, errors, begins, shows, .. } = *tick;
    StripTick { at_s: at.as_secs_f64(), share, errors: errors.map(|error| 255.0 * error), begins, shows }
}
