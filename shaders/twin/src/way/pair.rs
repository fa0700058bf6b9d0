//! A pair of steps of a bent ray, with a turn in its middle, or at its end where it meets a surface.

use super::path::{Side, Surface};
use super::refracted::Walk;
use crate::brick::{PairOfSteps, Straight, add_pair};
use crate::composite::Composite;
use crate::gradient::Gradients;
use crate::kernel::Kernel;
use crate::levels::Brick;
use crate::refine::scalars_in_reach;
use crate::tables::is_vacant_around;
use crate::{Casting, Real, vector::Vec3};
use layout::NodeRecord;
use needs::tables::Tables;

/// See `wgsl/way/pair.wgsl` for these eight.
const LARGE_CHANGE_SQUARED: f64 = 0.16;
const MOST_HALVINGS: u32 = 8;
const GRAZING_HALVINGS: u32 = 3;
const TURNING_BEND: f64 = 4.0;
const NEAREST_DIP: f64 = 0.05;
const SURFACE_STEPS: u32 = 8;
const LEAST_STEP: f64 = 0.01;
const MOST_AT_ONCE: u32 = 7;

/// What a pair of steps led to.
pub(super) struct Taken {
    /// Whether nothing that follows can be seen.
    pub(super) is_last: bool,
    /// Whether the ray was turned.
    pub(super) is_turned: bool,
}

/// A pair straight on.
struct Laid<F> {
    /// Metres of each step.
    step: F,
    /// At its ends and in its middle.
    scalars: [F; 3],
    turn: Turn<F>,
}

/// What turns a ray on a pair; with the gradient of the scalar there.
enum Turn<F> {
    Nothing,
    /// In its middle: the index, which changes.
    Change(Side, Vec3<F>),
    /// At its end.
    Surface(Surface<F>, Vec3<F>),
}

/// Scalars at the ends of a pair and in its middle, the ends on one side of the jumps of the index.
struct Profile<F> {
    scalars: [F; 3],
    rise: F,
    bend: F,
}

impl<F: Real> Profile<F> {
    #[inline(always)]
    fn new(scalars: [F; 3]) -> Self {
        let [s0, s1, s2] = scalars;
        Self { scalars, rise: s2 - s0, bend: s2 - (s1 + s1) + s0 }
    }

    #[inline(always)]
    fn is_off(side: Side, tables: &Tables, s: F) -> bool {
        Side::of(tables, s.most(F::ZERO).least(F::ONE)) != side
    }

    /// Whether a ray seems to turn back before a jump that is no farther than the scalar goes on the pair.
    #[inline(always)]
    fn grazes(&self, side: Side, tables: &Tables) -> bool {
        let [s0, s1, s2] = self.scalars;
        let (low, high) = (s0.least(s1).least(s2), s0.most(s1).most(s2));
        let reach = high - low;
        self.rise.abs() < F::of(TURNING_BEND) * self.bend.abs()
            && (Self::is_off(side, tables, low - reach) || Self::is_off(side, tables, high + reach))
    }

    /// Where it may be beyond one, steps from the start.
    #[inline(always)]
    fn dip(&self, side: Side, tables: &Tables) -> Option<F> {
        let Self { scalars: [_, s1, _], rise, bend } = *self;
        if Self::is_off(side, tables, s1) {
            return Some(F::ONE);
        }
        let at = F::ONE - F::of(0.5) * rise / bend;
        // Where a parabola through the three turns back, and as far again.
        let turns_back = s1 - F::of(0.25) * rise * rise / bend;
        (at > F::of(NEAREST_DIP) && at < F::of(2.0) && Self::is_off(side, tables, turns_back)).then_some(at)
    }
}

impl<F: Real> Walk<F> {
    /// Takes a pair of steps of at most `step` metres each.
    #[inline(always)]
    pub(super) fn take_pair<K: Kernel>(
        &mut self,
        casting: &Casting<F>,
        node: &NodeRecord,
        brick: &Brick<F>,
        step: F,
    ) -> Taken {
        let (ray, t0) = (self.bent.ray, self.bent.t);
        let Laid { step, scalars: [s0, s1, mut s2], turn } = self.lay::<K>(casting, brick, step);
        let mut t1 = t0 + step;
        let mut next_brick = *brick;
        let mut is_turned = false;
        if let Turn::Change(side, gradient) = turn {
            let both = F::of(2.0) * step;
            let direction = self.bent.direction_beyond(casting, side, gradient, (s0, s2), both);
            is_turned = direction != ray.direction_in_display;
            if is_turned {
                self.turn(casting, t1, direction);
                next_brick = Brick::new::<K>(casting, node, &self.bent.ray);
                t1 = F::ZERO;
                s2 = next_brick.scalar_at::<K>(casting, &self.bent.ray, step);
                self.cast.samples += 1;
            }
        }
        let half = F::of(0.5) * step;
        let spreads = [
            brick.spread_at::<K>(casting, &ray, t0 + half),
            next_brick.spread_at::<K>(casting, &self.bent.ray, t1 + half),
        ];
        self.known = Some(s2);
        self.bent.t = t1 + step;
        self.bent.way = self.bent.way + F::of(2.0) * step;
        let range = scalars_in_reach(s0, s1, s2);
        let mut is_last = false;
        if !is_vacant_around(&casting.tables.cells, range, spreads[0].most(spreads[1])) {
            let next_ray = self.bent.ray;
            let steps = PairOfSteps {
                first: Straight { brick, ray: &ray },
                second: Straight { brick: &next_brick, ray: &next_ray },
                t: [t0, t1],
                length: step,
                scalars: [s0, s1, s2],
                range,
                spreads,
            };
            let (added, between) = add_pair::<F, K, _>(casting, &self.chain, self.front, &steps);
            self.front = added;
            self.cast.samples += between;
            is_last = K::Composite::still_to_come(casting, self.front) < casting.scene.termination;
        }
        if let Turn::Surface(surface, gradient) = turn {
            let direction = self.bent.direction_through(&surface, gradient);
            is_turned = direction != ray.direction_in_display;
            if is_turned {
                self.turn(casting, self.bent.t, direction);
            }
        }
        Taken { is_last, is_turned }
    }

    /// Turns the ray at t.
    #[inline(always)]
    fn turn(&mut self, casting: &Casting<F>, t: F, direction: Vec3<F>) {
        self.bent.turn(casting, t, direction);
        self.chain.follow(casting, &self.bent.ray);
    }

    /// Lays a pair straight on, halved while the index changes much between its ends, or its slope since the last turn; where
    /// a surface lies on it, its end is there.
    #[inline(always)]
    fn lay<K: Kernel>(&mut self, casting: &Casting<F>, brick: &Brick<F>, longest: F) -> Laid<F> {
        let (ray, t0, two) = (self.bent.ray, self.bent.t, F::of(2.0));
        let mut step = longest;
        let tables = casting.tables;
        let s0 = self.known.unwrap_or_else(|| brick.scalar_at::<K>(casting, &ray, t0));
        let side = *self.bent.side.get_or_insert_with(|| Side::of(tables, s0));
        let mut s2 = brick.scalar_at::<K>(casting, &ray, t0 + two * step);
        let mut s1 = brick.scalar_at::<K>(casting, &ray, t0 + step);
        self.cast.samples += 3;
        for left in (0..=MOST_HALVINGS).rev() {
            let change = side.index_at(tables, s2) - side.index_at(tables, s0);
            let most = F::of(LARGE_CHANGE_SQUARED) * casting.scene.tolerance;
            let mut beyond = Side::of(tables, s2);
            let profile = Profile::new([s0, s1, s2]);
            let is_close =
                left + GRAZING_HALVINGS > MOST_HALVINGS && beyond == side && profile.grazes(side, tables);
            if left == 0 || (change * change <= most && !is_close) {
                let bends = side.bends(tables, s0, s2);
                let gradient = bends.then(|| Gradients::new::<K>(casting, brick, &ray, t0 + step).at);
                let force = gradient.map_or(Vec3::ZERO, |g| g * side.slope(tables, s0, s2));
                if left == 0 || self.bent.is_smooth(casting, force, step) {
                    (self.bent.force, self.bent.since) = (force, step);
                    if beyond == side
                        && let Some(at) = profile.dip(side, tables)
                    {
                        let there = brick.scalar_at::<K>(casting, &ray, t0 + at * step);
                        self.cast.samples += 1;
                        beyond = Side::of(tables, there);
                        if beyond != side {
                            (step, s2) = (F::of(0.5) * at * step, there);
                        }
                    }
                    if beyond != side {
                        let surface = side.surface_to(tables, beyond);
                        return self.lay_over::<K>(casting, brick, surface, (s0, s2), (step, longest));
                    }
                    let turn = gradient.map_or(Turn::Nothing, |gradient| Turn::Change(side, gradient));
                    return Laid { step, scalars: [s0, s1, s2], turn };
                }
            }
            (step, s2) = (F::of(0.5) * step, s1);
            s1 = brick.scalar_at::<K>(casting, &ray, t0 + step);
            self.cast.samples += 1;
        }
        unreachable!("the last pair is taken whatever it is")
    }

    /// Lays a pair whose end is where the ray meets a surface within the steps given, between scalars s0 and s2.
    #[inline(never)]
    fn lay_over<K: Kernel>(
        &mut self,
        casting: &Casting<F>,
        brick: &Brick<F>,
        surface: Surface<F>,
        (s0, s2): (F, F),
        (step, longest): (F, F),
    ) -> Laid<F> {
        let (ray, t0, two) = (self.bent.ray, self.bent.t, F::of(2.0));
        let scalar = |t: F| brick.scalar_at::<K>(casting, &ray, t0 + t);
        let (mut low, mut high) = ((F::ZERO, s0 - surface.at), (two * step, s2 - surface.at));
        // A ray that has just passed a surface may see its scalar behind it yet.
        if (low.1 < F::ZERO) == (high.1 < F::ZERO) {
            low.1 = -high.1;
        }
        let between = |low: (F, F), high: (F, F)| low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1);
        let mut t = between(low, high);
        // Regula falsi; the far end counts half where it has stayed (Illinois).
        let mut was_low = None;
        for _ in 0..SURFACE_STEPS {
            let found = scalar(t) - surface.at;
            let is_low = (found < F::ZERO) == (low.1 < F::ZERO);
            let half = if was_low == Some(is_low) { F::of(0.5) } else { F::ONE };
            if is_low {
                (low, high.1) = ((t, found), half * high.1);
            } else {
                (high, low.1) = ((t, found), half * low.1);
            }
            was_low = Some(is_low);
            t = between(low, high);
        }
        self.cast.samples += SURFACE_STEPS + 2;
        // Where the surface lies behind the ray by now, or just ahead, it is met at once; light that does so again and again goes
        // farther each time, so that its way goes on.
        let least = F::of(LEAST_STEP) * longest * F::of_u32(1 << self.bent.met_at_once);
        let is_ahead = t > least && t <= two * step;
        self.bent.met_at_once = if is_ahead { 0 } else { MOST_AT_ONCE.min(self.bent.met_at_once + 1) };
        let both = if is_ahead { t } else { least };
        let step = F::of(0.5) * both;
        let gradient = Gradients::new::<K>(casting, brick, &ray, t0 + both).at;
        Laid { step, scalars: [s0, scalar(step), scalar(both)], turn: Turn::Surface(surface, gradient) }
    }
}
