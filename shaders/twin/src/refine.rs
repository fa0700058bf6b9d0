//! How many parts a step is split into, from what a pair of steps estimates of its own error.

use super::composite::{Composite, Sample};
use super::four::each;
use super::importance::MOST_PARTS;
use super::kernel::Kernel;
use super::levels::Brick;
use super::shade::Shade;
use super::spread::sample_over;
use super::tables::locate;
use super::traverse::voxel_edge;
use super::{Casting, Real, ray::Ray, real::Number};
use layout::NodeRecord;

/// The same for a pair whose parts are opaque: light comes from the first few of them.
const MOST_DEEP_PARTS: f64 = 1024.0;
/// Steps grow to this many voxels at most; see [`looseness`].
const LONGEST_STEP: f64 = 1.0;
/// A tolerance as tight as this, or tighter, has steps grow no further.
const TIGHT: f64 = 1e-4;
/// Others have them grow so many times as far, at most.
const MOST_LOOSE: f64 = 4.0;

/// How many times as far steps may grow at a tolerance as at a tight one: what hides between samples grows with the square of
/// how far apart they are.
#[inline(always)]
fn looseness<F: Number>(tolerance: F) -> F {
    (tolerance * tolerance.alike(1.0 / TIGHT))
        .sqrt()
        .most(tolerance.alike(1.0))
        .least(tolerance.alike(MOST_LOOSE))
}

/// The longest step, in voxels of the node: `shortest` where much may hide between two samples, more where the largest
/// optical depth of a voxel, `depth`, keeps what may hide small. Steps of one length (no `tolerance`) do not grow.
#[inline(always)]
pub fn step_voxels<F: Number>(shortest: F, depth: F, safe: F, tolerance: F) -> F {
    let loose = looseness(tolerance);
    let safe = safe * loose;
    let longest = shortest.most(depth.alike(LONGEST_STEP) * loose);
    let grown = (safe / depth.most(depth.alike(1e-30))).least(longest);
    let grown = (depth * shortest).choose(safe, grown, shortest);
    tolerance.choose(tolerance.alike(1.0), grown, shortest)
}

/// Share of what lies within reach of a pair, but not between its ends, that may have been passed by unseen.
const UNSEEN: f64 = 0.25;

/// A voxel of a node, as a ray meets it.
#[derive(Clone, Copy, Debug)]
pub struct Voxel<F> {
    /// Metres along the ray.
    pub edge: F,
    /// The largest extinction that the node may show, per metre.
    pub most_extinction: F,
}

impl<F: Real> Voxel<F> {
    /// Of a node.
    #[inline(always)]
    pub fn new(casting: &Casting<F>, node: &NodeRecord, ray: &Ray<F>) -> Self {
        let edge = voxel_edge::<F>(casting.scene.finest_depth, node.depth) / ray.speed;
        Self { edge, most_extinction: F::of_f32(node.most_extinction) * casting.scene.extinction_per_metre }
    }

    /// The longest step from t on, in metres, by the fractional level there; see the WGSL.
    #[inline(always)]
    pub fn longest_step<K: Kernel>(&self, casting: &Casting<F>, brick: &Brick<F>, ray: &Ray<F>, t: F) -> F {
        let has_fractions = brick.has_fractions::<K>();
        let edge = if has_fractions { self.edge * brick.fraction(casting, ray, t).exp2() } else { self.edge };
        let (scene, safe) = (casting.scene, F::of(K::Shade::safe_depth(casting.needs)));
        step_voxels(scene.step_voxels, self.most_extinction * edge, safe, scene.tolerance) * edge
    }
}

/// What a pair of steps shows, of one ray or of eight side by side.
#[derive(Clone, Copy, Debug)]
pub struct Pair<F> {
    /// The first step.
    pub first: Sample<F>,
    /// The second.
    pub second: Sample<F>,
    /// Both, taken as one segment.
    pub both: Sample<F>,
    /// All scalars within reach: see [`scalars_in_reach`].
    pub reach: Sample<F>,
}

impl<F: Real> Pair<F> {
    /// Over scalars s0 to s1 to s2, with `reach` from [`scalars_in_reach`], each step standing for those within one of `spreads`
    /// of it.
    #[inline(always)]
    pub fn new<C: Composite>(
        casting: &Casting<F>,
        [s0, s1, s2]: [F; 3],
        reach: (F, F),
        spreads: [F; 2],
    ) -> Self {
        let tables = casting.tables;
        let (l0, l1, l2) = (locate(tables, s0), locate(tables, s1), locate(tables, s2));
        let (low, high) = (locate(tables, reach.0), locate(tables, reach.1));
        Self {
            first: sample_over::<F, C>(casting, [&l0, &l1], (s0, s1), spreads[0]),
            second: sample_over::<F, C>(casting, [&l1, &l2], (s1, s2), spreads[1]),
            both: sample_over::<F, C>(casting, [&l0, &l2], (s0, s2), F::of(0.5) * (spreads[0] + spreads[1])),
            reach: sample_over::<F, C>(casting, [&low, &high], reach, spreads[0].most(spreads[1])),
        }
    }
}

impl<F: Number> Pair<F> {
    /// What it emits.
    #[inline(always)]
    pub fn emitted(&self) -> Emitted<F> {
        Emitted {
            first: self.first.emitted(),
            second: self.second.emitted(),
            both: self.both.emitted(),
            reach: self.reach.emitted(),
        }
    }
}

/// What a pair of steps emits: (τ c, τ) with its brightness, of the segments of a [`Pair`].
pub struct Emitted<F> {
    /// The first step.
    pub first: [F; 4],
    /// The second.
    pub second: [F; 4],
    /// Both, taken as one segment.
    pub both: [F; 4],
    /// All scalars within reach.
    pub reach: [F; 4],
}

/// Parts of each step of a pair, where a step has `thickness`, `visible` is the opacity that may still be added and
/// `spread` how much shading varies within a step; see the WGSL for what errs how.
#[inline(always)]
pub fn parts_of_step<F: Number>(emitted: Emitted<F>, thickness: F, visible: F, spread: F, tolerance: F) -> F {
    let Emitted { first, second, both, reach } = emitted;
    let (one, two, share) = (thickness.alike(1.0), thickness.alike(2.0), thickness.alike(UNSEEN));
    let depth = (first[3] + second[3]) * thickness;
    let bend_scale = thickness / (one + depth);
    let order_scale = thickness * thickness / (one + depth * depth);
    let bend: [F; 4] = each!(C => {
        (first[C] + second[C] - two * both[C]).abs().most((reach[C] - both[C]).abs() * share)
    });
    let order: [F; 4] = each!(C => (first[C] * second[3] - second[C] * first[3]).abs());
    let uneven = first[3] * second[3] * spread;
    let worst_order = order[0].most(order[1]).most(order[2].most(uneven)) * order_scale;
    let worst = (bend[0].most(bend[1]).most(bend[2].most(bend[3])) * bend_scale).most(worst_order);
    parts_by_errors(worst * visible / tolerance, depth, thickness.alike(MOST_PARTS))
}

/// Parts of a step that errs by so many times what it may, and is so deep with another: `most`, or more if each is opaque.
#[inline(always)]
pub fn parts_by_errors<F: Number>(errors: F, depth: F, most: F) -> F {
    let parts = errors.sqrt().ceil().most(errors.alike(1.0)).least(most);
    let deep =
        (errors.alike(2.0) * errors).least(depth).ceil().least(errors.alike(MOST_DEEP_PARTS)).most(parts);
    parts.choose(depth, deep, parts)
}

/// The scalars that a pair of steps may have met between its samples: the samples' own range, widened by half the
/// larger step at both ends, as far as a kink of the trilinear field between two samples goes.
#[inline(always)]
pub fn scalars_in_reach<F: Number>(s0: F, s1: F, s2: F) -> (F, F) {
    let margin = s0.alike(0.5) * (s1 - s0).abs().most((s2 - s1).abs());
    let (low, high) = (s0.least(s1).least(s2), s0.most(s1).most(s2));
    ((low - margin).most(s0.alike(0.0)), (high + margin).least(s0.alike(1.0)))
}
