//! The path of light through a volume, as a chain of chords.

use super::bending::Bending;
use super::interface::{Passed, pass};
use super::runge_kutta::{Pose, Stepped, step};
use crate::Ray;
use bricks::BrickError;
use glam::DVec3;
use std::ops::ControlFlow;

/// A way ends after this many diagonals of the volume: light that circles for ever is not followed for ever.
pub const LONGEST_WAY_DIAGONALS: f64 = 4.0;
/// Longest step, finest voxels: no feature of stored samples hides between its points.
const LONGEST_STEP_VOXELS: f64 = 1.0;
/// Shortest step, finest voxels: where one is not enough, the way is not known.
const SHORTEST_STEP_VOXELS: f64 = 1e-12;
/// Places on a step at which the scalar is looked at. Where it comes closer to another phase than at its neighbours, the closest
/// place between these is sought: a surface that is only grazed bends light as much as one that is crossed.
const LOOKS: usize = 8;
/// Times that the interval in which that place lies is narrowed, each by the golden section: to 1e-5 voxels.
const NARROWINGS: u32 = 20;
/// Share of an interval that the golden section leaves.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// A place may be closer to another phase by this many times what the looks around it differ by.
const MOST_DIP: f64 = 2.0;
/// Share of the deviation that a single step may always have, so that the kinks of the gradient between voxels do not
/// drive steps to nothing.
const SHARE_OF_A_STEP: f64 = 1e-3;
/// Indices closer than this share of them are one: light goes on as it was.
const ROUNDING: f64 = 1e-14;
/// Way that light must make for it to have left a surface, finest voxels.
const LEAVING_VOXELS: f64 = 1e-9;
/// Light that meets a surface so often without leaving it is not known to pass.
const MOST_MEETINGS: u32 = 8;
/// Steps at most.
const MOST_STEPS: f64 = 4_000_000.0;
/// Tried per step that is needed: some are too long, others end at surfaces.
const STEPS_PER_STEP: f64 = 4.0;

/// Takes a chord: a straight path and its length in metres. Breaks when it has seen enough.
pub type Take<'t> = &'t mut dyn FnMut(Ray, f64) -> Result<ControlFlow<()>, BrickError>;

/// How a way ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// As it should: outside, after the longest way, or when no more light was wanted.
    Followed,
    /// The steps became too small or too many.
    Lost,
}

/// How closely a way is followed.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Edge of the finest voxel, metres.
    pub voxel_m: f64,
    /// The volume's longest diagonal, metres.
    pub diagonal_m: f64,
    /// How far the chords may lie from the way, metres.
    pub deviation_m: f64,
}

impl Limits {
    /// Enough for light that turns by a radian in every voxel of its way: arcs of angle α and radius r bulge by r α² / 8.
    fn most_steps(&self) -> u32 {
        let Self { voxel_m, diagonal_m, deviation_m } = *self;
        let shortest_m = (8.0 * voxel_m * deviation_m).sqrt().min(LONGEST_STEP_VOXELS * voxel_m);
        let steps = STEPS_PER_STEP * LONGEST_WAY_DIAGONALS * diagonal_m / shortest_m;
        steps.min(MOST_STEPS).ceil() as u32
    }
}

/// Light on its way.
pub struct Follower<'a> {
    bending: &'a Bending<'a>,
    limits: Limits,
    pose: Pose,
    phase: usize,
    step_m: f64,
    meetings: u32,
    /// The chord that is still growing: where it starts, and its length.
    chord: (Pose, f64),
}

/// What comes of trying a step.
enum Trial {
    /// It leads to a place by so many metres.
    Reaches(Pose, f64),
    /// It was too long.
    TooLong,
    /// The scalar enters another phase on it.
    Meets(Meeting),
}

/// A surface on a step: the last place before it, the first one behind it, and the length of the way to it, metres.
struct Meeting {
    before: Pose,
    behind: Pose,
    length_m: f64,
}

impl<'a> Follower<'a> {
    /// At a point of the volume.
    pub fn new(bending: &'a Bending<'a>, limits: Limits, start: &Ray) -> Result<Self, BrickError> {
        let pose = Pose { point: start.origin_in_display, direction: start.direction_in_display };
        let phase = bending.phase(pose.point)?;
        let step_m = LONGEST_STEP_VOXELS * limits.voxel_m;
        Ok(Self { bending, limits, pose, phase, step_m, meetings: 0, chord: (pose, 0.0) })
    }

    /// Shows `take` one chord after the other, until the light leaves the volume, has gone too far, or `take` breaks.
    pub fn follow(mut self, take: Take) -> Result<End, BrickError> {
        let mut left_m = LONGEST_WAY_DIAGONALS * self.limits.diagonal_m;
        for _ in 0..self.limits.most_steps() {
            if left_m <= 0.0 {
                return self.finish(End::Followed, take);
            }
            if self.step_m < SHORTEST_STEP_VOXELS * self.limits.voxel_m || self.meetings > MOST_MEETINGS {
                break;
            }
            let (end, length_m) = match self.attempt(self.step_m.min(left_m))? {
                Trial::TooLong => continue,
                Trial::Reaches(end, length_m) => (end, length_m),
                Trial::Meets(meeting) => self.pass(meeting)?,
            };
            left_m -= length_m;
            if self.go(end, take)?.is_break() {
                return self.finish(End::Followed, take);
            }
        }
        self.finish(End::Lost, take)
    }

    /// Tries a step, and sets the length of the next one.
    fn attempt(&mut self, length_m: f64) -> Result<Trial, BrickError> {
        let whole = self.step(length_m)?;
        if self.scale_by_chord(&whole, length_m) < 1.0 {
            return Ok(self.judged(&whole, length_m));
        }
        let Some(meeting) = self.meeting(&whole, length_m)? else {
            return Ok(self.judged(&whole, length_m));
        };
        let next_m = self.step_m;
        let until = self.step(meeting.length_m)?;
        match self.judged(&until, meeting.length_m) {
            Trial::TooLong => Ok(Trial::TooLong),
            Trial::Reaches(..) | Trial::Meets(_) => {
                self.step_m = next_m;
                Ok(Trial::Meets(meeting))
            }
        }
    }

    fn step(&self, length_m: f64) -> Result<Stepped, BrickError> {
        step(self.pose, length_m, &|pose: Pose| self.bending.turning(self.phase, pose))
    }

    /// Whether a step is exact enough; sets the length of the next one.
    fn judged(&mut self, stepped: &Stepped, length_m: f64) -> Trial {
        let Limits { diagonal_m, deviation_m, voxel_m } = self.limits;
        let error = stepped.error.0 + stepped.error.1 * diagonal_m;
        let allowed = deviation_m * (length_m / diagonal_m + SHARE_OF_A_STEP);
        let by_error = if error.is_finite() { (allowed / error).powf(0.2) } else { 0.0 };
        let scale = by_error.min(self.scale_by_chord(stepped, length_m));
        self.step_m = (length_m * (0.9 * scale).clamp(0.1, 4.0)).min(LONGEST_STEP_VOXELS * voxel_m);
        if scale >= 1.0 { Trial::Reaches(stepped.end, length_m) } else { Trial::TooLong }
    }

    /// By what a step may grow for its chord to lie close enough: an arc that turns by a small angle bulges an eighth of
    /// angle times length.
    fn scale_by_chord(&self, stepped: &Stepped, length_m: f64) -> f64 {
        let turn = (stepped.end.direction - self.pose.direction).length();
        (8.0 * self.limits.deviation_m / (turn * length_m)).sqrt()
    }

    /// The first surface on a step.
    fn meeting(&self, whole: &Stepped, length_m: f64) -> Result<Option<Meeting>, BrickError> {
        if !self.bending.index.has_knots() {
            return Ok(None);
        }
        let part = |look: usize| look as f64 / LOOKS as f64;
        let mut margins = [0.0; LOOKS + 1];
        for (look, margin) in margins.iter_mut().enumerate() {
            *margin = self.margin(whole, part(look))?;
        }
        for look in 0..=LOOKS {
            let (before, after) = (look.saturating_sub(1), (look + 1).min(LOOKS));
            if look > 0 && margins[look] < 0.0 {
                return self.bisect(length_m, (part(before), part(look))).map(Some);
            }
            let rises = [before, after].map(|other| margins[other] - margins[look]);
            let may_dip = margins[look] <= MOST_DIP * rises[0].max(rises[1]);
            if may_dip
                && rises.iter().all(|&rise| rise >= 0.0)
                && let Some(behind) = self.dip(whole, (part(before), part(after)))?
            {
                return self.bisect(length_m, (part(before), behind)).map(Some);
            }
        }
        Ok(None)
    }

    /// By how much the scalar is within its phase, part of a step ahead; negative beyond.
    fn margin(&self, whole: &Stepped, part: f64) -> Result<f64, BrickError> {
        let scalar = self.bending.local(self.pose.point.lerp(whole.end.point, part))?.scalar;
        Ok(self.bending.index.margin(self.phase, scalar))
    }

    /// A place beyond the phase between two parts of a step, between which the scalar comes closest to another.
    fn dip(&self, whole: &Stepped, (mut low, mut high): (f64, f64)) -> Result<Option<f64>, BrickError> {
        for _ in 0..NARROWINGS {
            let places = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
            let margins = [self.margin(whole, places[0])?, self.margin(whole, places[1])?];
            if let Some(beyond) = (0..2).find(|&i| margins[i] < 0.0) {
                return Ok(Some(places[beyond]));
            }
            if margins[0] < margins[1] { high = places[1] } else { low = places[0] }
        }
        Ok(None)
    }

    /// Where, between two parts of a step, the scalar enters another phase.
    fn bisect(&self, length_m: f64, (mut low, mut high): (f64, f64)) -> Result<Meeting, BrickError> {
        let at = |part: f64| Ok::<_, BrickError>(self.step(part * length_m)?.end);
        while high - low > f64::EPSILON {
            let middle = 0.5 * (low + high);
            let strays = self.bending.phase(at(middle)?.point)? != self.phase;
            if strays { high = middle } else { low = middle }
        }
        Ok(Meeting { before: at(low)?, behind: at(high)?, length_m: high * length_m })
    }

    /// Takes light through a surface, or back from it; returns where it stands then, and how far it went.
    fn pass(&mut self, Meeting { before, behind, length_m }: Meeting) -> Result<(Pose, f64), BrickError> {
        self.meetings += 1;
        let local = self.bending.local(behind.point)?;
        let next = self.bending.index.phase(local.scalar);
        let [from, to] = [self.phase, next].map(|phase| self.bending.index.at(phase, local.scalar).0);
        if (from - to).abs() <= ROUNDING * from {
            self.phase = next;
            return Ok((behind, length_m));
        }
        Ok(match pass(behind.direction, local.gradient, from, to) {
            Passed::Through(direction) => {
                self.phase = next;
                (Pose { direction, ..behind }, length_m)
            }
            Passed::Mirrored(direction) => (Pose { direction, ..before }, length_m),
        })
    }

    /// Goes to where a step or a surface leads; breaks where the way ends.
    fn go(&mut self, end: Pose, take: Take) -> Result<ControlFlow<()>, BrickError> {
        let offset = end.point - self.pose.point;
        let is_straight = end.direction == self.pose.direction;
        if !is_straight && self.show_chord(take)?.is_break() {
            return Ok(ControlFlow::Break(()));
        }
        if !is_straight {
            self.chord.0 = Pose { point: self.pose.point, direction: offset.normalize_or_zero() };
        }
        let way = Ray::new(self.pose.point, self.chord.0.direction);
        let exit_m = self.exit_m(&way);
        self.chord.1 += offset.length().min(exit_m);
        if offset.length() > LEAVING_VOXELS * self.limits.voxel_m {
            self.meetings = 0;
        }
        if exit_m <= offset.length() {
            return Ok(ControlFlow::Break(()));
        }
        self.pose = end;
        if is_straight {
            return Ok(ControlFlow::Continue(()));
        }
        let shown = self.show_chord(take)?;
        self.chord.0 = end;
        Ok(shown)
    }

    /// How far along a straight path from inside the volume it ends, metres.
    fn exit_m(&self, way: &Ray) -> f64 {
        let line = way.line(&self.bending.volume_from_display);
        line.exit(DVec3::ZERO, self.bending.field.extent()).max(0.0)
    }

    /// Shows the chord that was growing, and starts one of no length.
    fn show_chord(&mut self, take: Take) -> Result<ControlFlow<()>, BrickError> {
        let (start, length_m) = self.chord;
        self.chord.1 = 0.0;
        if length_m <= 0.0 {
            return Ok(ControlFlow::Continue(()));
        }
        take(Ray { origin_in_display: start.point, direction_in_display: start.direction }, length_m)
    }

    fn finish(mut self, end: End, take: Take) -> Result<End, BrickError> {
        self.show_chord(take).map(|_| end)
    }
}
