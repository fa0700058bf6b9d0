//! A pair of steps of a bent ray, with a turn in its middle.

use super::path::{bends, index_at};
use super::refracted::Walk;
use crate::brick::{PairOfSteps, Straight, add_pair};
use crate::composite::Composite;
use crate::gradient::Gradients;
use crate::kernel::Kernel;
use crate::levels::Brick;
use crate::refine::scalars_in_reach;
use crate::tables::is_vacant_around;
use crate::{Casting, Real};
use layout::NodeRecord;

/// See `wgsl/way/pair.wgsl` for these two.
const LARGE_CHANGE: f64 = 0.004;
const MOST_HALVINGS: u32 = 4;

/// What a pair of steps led to.
pub(super) struct Taken {
    /// Whether nothing that follows can be seen.
    pub(super) is_last: bool,
    /// Whether the ray was turned.
    pub(super) is_turned: bool,
}

/// A pair straight on: the length of its steps, and the scalars at its ends.
struct Ends<F> {
    step: F,
    s0: F,
    s2: F,
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
        let Ends { step, s0, mut s2 } = self.ends::<K>(casting, brick, step);
        let mut t1 = t0 + step;
        let s1 = brick.scalar_at::<K>(casting, &ray, t1);
        self.cast.samples += 3;
        let turned = self.turn::<K>(casting, node, brick, (s0, s2), step);
        let is_turned = turned.is_some();
        let next_brick = turned.unwrap_or(*brick);
        if is_turned {
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
        let (added, parts) = add_pair::<F, K>(casting, &self.chain, self.front, &steps);
        self.front = added;
        self.cast.samples += 2 * (parts.to_index() - 1);
        let is_last = K::Composite::still_to_come(casting, self.front) < casting.scene.termination;
        Taken { is_last, is_turned }
    }

    /// The ends of a pair straight on, halved while the index changes much between them.
    #[inline(always)]
    fn ends<K: Kernel>(&mut self, casting: &Casting<F>, brick: &Brick<F>, mut step: F) -> Ends<F> {
        let (ray, t0, two) = (&self.bent.ray, self.bent.t, F::of(2.0));
        let tables = casting.tables;
        let s0 = self.known.unwrap_or_else(|| brick.scalar_at::<K>(casting, ray, t0));
        let mut s2 = brick.scalar_at::<K>(casting, ray, t0 + two * step);
        for _ in 0..MOST_HALVINGS {
            if (index_at(tables, s2) - index_at(tables, s0)).abs() <= F::of(LARGE_CHANGE) {
                break;
            }
            step = F::of(0.5) * step;
            s2 = brick.scalar_at::<K>(casting, ray, t0 + two * step);
            self.cast.samples += 1;
        }
        Ends { step, s0, s2 }
    }

    /// Turns the ray in the middle of a pair; the brick along its new way, None where it goes straight on.
    #[inline(always)]
    fn turn<'a, K: Kernel>(
        &mut self,
        casting: &Casting<'a, F>,
        node: &NodeRecord,
        brick: &Brick<'a, F>,
        scalars: (F, F),
        step: F,
    ) -> Option<Brick<'a, F>> {
        if !bends(casting.tables, scalars.0, scalars.1) {
            return None;
        }
        let (ray, t1) = (self.bent.ray, self.bent.t + step);
        let gradient = Gradients::new::<K>(casting, brick, &ray, t1).at;
        let direction = self.bent.direction_beyond(casting, gradient, scalars, F::of(2.0) * step);
        if direction == ray.direction_in_display {
            return None;
        }
        self.bent.turn(casting, t1, direction);
        self.chain.follow(casting, &self.bent.ray);
        Some(Brick::new::<K>(casting, node, &self.bent.ray))
    }
}
