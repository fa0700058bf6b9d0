//! A pair of steps of a bent ray, with a turn in its middle.

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

/// See `wgsl/way/pair.wgsl` for these four.
const LARGE_CHANGE_SQUARED: f64 = 0.16;
const MOST_HALVINGS: u32 = 8;
const SURFACE_STEPS: u32 = 8;
const LEAST_STEP: f64 = 0.01;

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

/// What turns a ray in the middle of a pair; with the gradient of the scalar there.
enum Turn<F> {
    Nothing,
    /// The index, which changes.
    Change(Side, Vec3<F>),
    Surface(Surface<F>, Vec3<F>),
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
        let direction = match turn {
            Turn::Nothing => ray.direction_in_display,
            Turn::Change(side, gradient) => {
                self.bent.direction_beyond(casting, side, gradient, (s0, s2), F::of(2.0) * step)
            }
            Turn::Surface(surface, gradient) => self.bent.direction_through(&surface, gradient),
        };
        let is_turned = direction != ray.direction_in_display;
        let mut next_brick = *brick;
        if is_turned {
            self.bent.turn(casting, t1, direction);
            self.chain.follow(casting, &self.bent.ray);
            next_brick = Brick::new::<K>(casting, node, &self.bent.ray);
            t1 = F::ZERO;
            s2 = next_brick.scalar_at::<K>(casting, &self.bent.ray, step);
            self.cast.samples += 1;
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
        if is_vacant_around(&casting.tables.cells, range, spreads[0].most(spreads[1])) {
            return Taken { is_last: false, is_turned };
        }
        let steps = PairOfSteps {
            first: Straight { brick, ray: &ray },
            second: Straight { brick: &next_brick, ray: &self.bent.ray },
            t: [t0, t1],
            length: step,
            scalars: [s0, s1, s2],
            range,
            spreads,
        };
        let (added, between) = add_pair::<F, K, _>(casting, &self.chain, self.front, &steps);
        self.front = added;
        self.cast.samples += between;
        let is_last = K::Composite::still_to_come(casting, self.front) < casting.scene.termination;
        Taken { is_last, is_turned }
    }

    /// Lays a pair straight on, halved while the index changes much between its ends, or its slope since the last turn; where
    /// a surface lies on it, its middle is there.
    #[inline(always)]
    fn lay<K: Kernel>(&mut self, casting: &Casting<F>, brick: &Brick<F>, mut step: F) -> Laid<F> {
        let (ray, t0, two) = (self.bent.ray, self.bent.t, F::of(2.0));
        let tables = casting.tables;
        let s0 = self.known.unwrap_or_else(|| brick.scalar_at::<K>(casting, &ray, t0));
        let side = *self.bent.side.get_or_insert_with(|| Side::of(tables, s0));
        let mut s2 = brick.scalar_at::<K>(casting, &ray, t0 + two * step);
        let mut s1 = brick.scalar_at::<K>(casting, &ray, t0 + step);
        self.cast.samples += 3;
        for left in (0..=MOST_HALVINGS).rev() {
            let change = side.index_at(tables, s2) - side.index_at(tables, s0);
            let most = F::of(LARGE_CHANGE_SQUARED) * casting.scene.tolerance;
            if left == 0 || change * change <= most {
                let bends = side.bends(tables, s0, s2);
                let gradient = bends.then(|| Gradients::new::<K>(casting, brick, &ray, t0 + step).at);
                let force = gradient.map_or(Vec3::ZERO, |g| g * side.slope(tables, s0, s2));
                if left == 0 || self.bent.is_smooth(casting, force, step) {
                    (self.bent.force, self.bent.since) = (force, step);
                    let beyond = Side::of(tables, s2);
                    if beyond != side {
                        let surface = side.surface_to(tables, beyond);
                        return self.lay_over::<K>(casting, brick, surface, (s0, s2), step);
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

    /// Lays a pair whose middle is where the ray meets a surface within the steps given, between scalars s0 and s2.
    #[inline(never)]
    fn lay_over<K: Kernel>(
        &mut self,
        casting: &Casting<F>,
        brick: &Brick<F>,
        surface: Surface<F>,
        (s0, s2): (F, F),
        step: F,
    ) -> Laid<F> {
        let (ray, t0, two) = (self.bent.ray, self.bent.t, F::of(2.0));
        let scalar = |t: F| brick.scalar_at::<K>(casting, &ray, t0 + t);
        let (mut low, mut high) = ((F::ZERO, s0 - surface.at), (two * step, s2 - surface.at));
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
        // Where the surface lies behind the ray by now, it is met at once.
        let least = F::of(LEAST_STEP) * step;
        let step = if t > least && t <= two * step { t } else { least };
        let gradient = Gradients::new::<K>(casting, brick, &ray, t0 + step).at;
        let scalars = [s0, scalar(step), scalar(two * step)];
        Laid { step, scalars, turn: Turn::Surface(surface, gradient) }
    }
}
