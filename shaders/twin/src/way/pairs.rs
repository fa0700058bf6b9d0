//! Pairs of steps of eight rays in the same brick, side by side.

use super::paths::Paths;
use super::segments::{Places, RAYS, Segment, first_of, means};
use super::walk::Walk;
use crate::Casting;
use crate::brick::{PairOfSteps, Straight, add_pair};
use crate::composite::{Composite, Sample};
use crate::enhance::Chain;
use crate::kernel::Kernel;
use crate::real::Number;
use crate::refine::{Pair, scalars_in_reach};
use crate::tables::is_vacant_between;
use lanes::*;

/// A pair of steps of each ray.
pub(super) struct Pairs<S: Simd> {
    pub(super) t: [f32x8<S>; 2],
    pub(super) length: f32x8<S>,
    pub(super) scalars: [f32x8<S>; 3],
    pub(super) range: (f32x8<S>, f32x8<S>),
    spreads: [f32x8<S>; 2],
}

impl<S: Simd> Pairs<S> {
    /// What those of some rays show, where nothing looks at importance.
    #[inline(always)]
    pub(super) fn shown<K: Kernel>(&self, casting: &Casting<f32>, rays: mask32x8<S>) -> Pair<f32x8<S>> {
        let ([s0, s1, s2], (low, high)) = (self.scalars, self.range);
        let are_wide = K::BLENDS && casting.needs.spreads;
        let segments = if are_wide {
            let [a, b] = self.spreads;
            [
                Segment::over([s0, s1], a),
                Segment::over([s1, s2], b),
                Segment::over([s0, s2], a.alike(0.5) * (a + b)),
                Segment::over([low, high], a.most(b)),
            ]
        } else {
            [
                Segment::between([s0, s1]),
                Segment::between([s1, s2]),
                Segment::between([s0, s2]),
                Segment::between([low, high]),
            ]
        };
        let [first, second, both, reach] = means(casting.tables, &segments, !are_wide, rays.to_bitmask());
        Pair {
            first: Sample::plain(first),
            second: Sample::plain(second),
            both: Sample::plain(both),
            reach: Sample::plain(reach),
        }
    }

    #[inline(always)]
    pub(super) fn new(
        t: [f32x8<S>; 2],
        length: f32x8<S>,
        scalars: [f32x8<S>; 3],
        spreads: [f32x8<S>; 2],
    ) -> Self {
        let [s0, s1, s2] = scalars;
        Self { t, length, scalars, range: scalars_in_reach(s0, s1, s2), spreads }
    }

    /// The rays of which nothing that they may have met changes a picture: see [`crate::tables::is_vacant_around`].
    #[inline(always)]
    pub(super) fn vacant(&self, casting: &Casting<f32>) -> u64 {
        let (low, high) = self.range;
        let spread = self.spreads[0].most(self.spreads[1]);
        let low = Places::of((low - spread).most(low.alike(0.0)));
        let high = Places::of((high + spread).least(high.alike(1.0)));
        let mut vacant = 0;
        for lane in 0..RAYS {
            // Those of a ray that is nowhere are none.
            let cells = [low.cell[lane].max(0) as usize, high.cell[lane].max(0) as usize];
            vacant |= u64::from(is_vacant_between(&casting.tables.cells, cells[0], cells[1])) << lane;
        }
        vacant
    }

    #[inline(always)]
    fn of<'a>(&self, lane: usize, way: Straight<'a, f32>) -> PairOfSteps<f32, Straight<'a, f32>> {
        PairOfSteps {
            first: way,
            second: way,
            t: [self.t[0][lane], self.t[1][lane]],
            length: self.length[lane],
            scalars: [self.scalars[0][lane], self.scalars[1][lane], self.scalars[2][lane]],
            range: (self.range.0[lane], self.range.1[lane]),
            spreads: [self.spreads[0][lane], self.spreads[1][lane]],
        }
    }
}

/// Adds the pairs of some rays one by one, of which enhancers change those of `acts`. Returns those of which nothing that follows can
/// be seen.
#[inline(always)]
pub(super) fn add_one_by_one<S: Simd, K: Kernel>(
    casting: &Casting<f32>,
    (chains, acts): (&[Chain<f32>; RAYS], u64),
    walks: &mut [Walk<f32>; RAYS],
    paths: &Paths<S>,
    pairs: &Pairs<S>,
    mut rays: u64,
) -> u64 {
    let mut ended = 0;
    while rays != 0 {
        let lane = first_of(&mut rays);
        let Some(way) = paths.ways[lane] else { continue };
        let (walk, chain, steps) = (&mut walks[lane], &chains[lane], pairs.of(lane, way));
        let (front, between) = if acts >> lane & 1 != 0 {
            add_pair::<f32, K, _>(casting, chain, walk.front, &steps)
        } else {
            add_pair::<f32, K::Plain, _>(casting, chain, walk.front, &steps)
        };
        walk.front = front;
        walk.cast.samples += between;
        ended |= u64::from(K::Composite::still_to_come(casting, front) < casting.scene.termination) << lane;
    }
    ended
}
