//! A ray's path through one brick: light and steps.

use super::along::Along;
use super::composite::{Accumulated, Composite, Light, Sample};
use super::debug::debug_light;
use super::enhance::{Chain, Segment};
use super::features::Features;
use super::gradient::Gradients;
use super::kernel::Kernel;
use super::levels::Brick;
use super::material::{material_between, material_of_pair};
use super::refine::{Pair, parts_of_step};
use super::shade::{Lighting, Shade};
use super::spread::sample_over;
use super::tables::{attenuation_mean, locate};
use super::{Casting, Real, ray::Ray, real::Number, vector::Vec3};
use layout::{CELL_EDGE, CELLS_ACROSS};

/// Texels along the edge of a cell.
pub(super) const CELL: f64 = CELL_EDGE as f64;
/// A step of a voxel is no longer than this much more.
const ROUNDED_VOXELS: f64 = 1e-3;
/// Cells along the edge of a brick.
pub(super) const ACROSS: u32 = CELLS_ACROSS as u32;

impl<F: Real> Brick<'_, F> {
    /// Whether anything shows within a voxel of the cell around a point.
    #[inline(always)]
    fn is_visible_at(&self, point: Vec3<F>) -> bool {
        let [x, y, z] = point.0.map(|c| (c * F::of(1.0 / CELL)).to_index() & (ACROSS - 1));
        let cell = (z * ACROSS + y) * ACROSS + x;
        self.cells[(cell >> 5) as usize] >> (cell & 31) & 1 != 0
    }

    /// Pairs of steps of `length` metres until the middle of one lies beyond the cell around `middle`; at least 1.
    #[inline(always)]
    fn pairs_across(&self, middle: Vec3<F>, length: F) -> u32 {
        let mut way = F::of(1e30);
        for axis in 0..3 {
            let in_cells = middle.0[axis] * F::of(1.0 / CELL);
            let low = F::of_u32(in_cells.to_index()) * F::of(CELL);
            let face = if self.own.slope.0[axis] >= F::ZERO { low + F::of(CELL) } else { low };
            way = way.least((face - middle.0[axis]).abs() * self.pace.0[axis]);
        }
        (way / length).ceil().most(F::ONE).least(F::of(1e6)).to_index()
    }
}

impl<F: Real> Brick<'_, F> {
    /// Whether a pair at `t` may show something, and how many from there on say the same; of nodes that no ancestor has a share
    /// of.
    #[inline(always)]
    pub fn pairs_alike(&self, t: F, length: F) -> (bool, u32) {
        let middle = self.own.point(t + length);
        (self.is_visible_at(middle), self.pairs_across(middle, F::of(2.0) * length))
    }

    /// Pairs from `t` on that show nothing, where the first has steps of `length` metres; 0 if it may show something.
    /// A cell is kept with a margin of one voxel, and as many points of a pair are asked as leave none of it farther than a
    /// voxel, but for rounding.
    #[inline(always)]
    pub fn pairs_unseen(&self, t: F, length: F) -> u32 {
        let both = F::of(2.0) * length;
        let points = points_asked(self.own.slope.0, length);
        let each = both / points;
        let mut unseen = u32::MAX;
        for j in 0..points.to_index() {
            let point = self.own.point(t + each * (F::of_u32(j) + F::of(0.5)));
            if self.is_visible_at(point) {
                return 0;
            }
            unseen = unseen.min(self.pairs_across(point, both));
        }
        unseen
    }
}

/// Points of a pair with steps of `length` metres that are asked what they see, on a way of so many texels per metre.
#[inline(always)]
pub(super) fn points_asked<F: Number>([x, y, z]: [F; 3], length: F) -> F {
    let voxels = length * x.abs().most(y.abs()).most(z.abs());
    (voxels - length.alike(ROUNDED_VOXELS)).ceil().most(length.alike(1.0))
}

/// A straight path through a brick.
#[derive(Clone, Copy)]
pub(super) struct Straight<'a, F> {
    pub(super) brick: &'a Brick<'a, F>,
    pub(super) ray: &'a Ray<F>,
}

impl<F: Real> Along<F> for Straight<'_, F> {
    #[inline(always)]
    fn ray(&self) -> &Ray<F> {
        self.ray
    }

    #[inline(always)]
    fn scalar_at<K: Features>(&self, casting: &Casting<F>, t: F) -> F {
        self.brick.scalar_at::<K>(casting, self.ray, t)
    }

    #[inline(always)]
    fn spread_at<K: Features>(&self, casting: &Casting<F>, t: F) -> F {
        self.brick.spread_at::<K>(casting, self.ray, t)
    }

    #[inline(always)]
    fn gradients_at<K: Features>(&self, casting: &Casting<F>, t: F) -> Gradients<F> {
        Gradients::new::<K>(casting, self.brick, self.ray, t)
    }
}

/// A pair of steps of equal length, of which the second may take another way.
pub(super) struct PairOfSteps<F, W> {
    pub(super) first: W,
    pub(super) second: W,
    /// Where each begins on its way.
    pub(super) t: [F; 2],
    /// Metres of each.
    pub(super) length: F,
    /// The scalars at the ends and in the middle.
    pub(super) scalars: [F; 3],
    /// All that may have been met.
    pub(super) range: (F, F),
    /// Half-width of the scalars that the samples of each stand for.
    pub(super) spreads: [F; 2],
}

/// One step along a way.
struct Step<F, W> {
    way: W,
    /// All of it as one segment.
    whole: Sample<F>,
    scalars: (F, F),
    t0: F,
    length: F,
    /// Whether enhancers look at its gradient.
    enhancers_look: bool,
}

/// Light of a segment, composited alone; `thickness` is metres times the extinction per metre where the table says 1.
#[inline(always)]
fn light_of<F: Real>(sample: &Sample<F>, thickness: F, light: Lighting<F>) -> Light<F> {
    segment_light(sample.k, (sample.lit, sample.brightness), thickness, light)
}

/// The same of a mean (τ c, τ), the share of the shading that acts on it, and the factor of the light that it emits.
#[inline(always)]
pub(super) fn segment_light<F: Number>(
    [r, g, b, extinction]: [F; 4],
    (share, brightness): (F, F),
    thickness: F,
    light: Lighting<F>,
) -> Light<F> {
    let depth = extinction * thickness;
    let mean = attenuation_mean(depth);
    let body = share.alike(1.0) - share + share * light.body;
    let lit = Vec3([r, g, b]) * body + Vec3::splat(extinction * (share * light.highlight));
    Light { rgb: lit * (thickness * mean * brightness), alpha: depth * mean }
}

/// Adds one step with its middle `at` a place on a ray, lit as given.
#[inline(always)]
fn add_whole<F: Real, K: Kernel>(
    casting: &Casting<F>,
    front: Accumulated<F>,
    sample: &Sample<F>,
    thickness: F,
    light: Lighting<F>,
    at: (&Ray<F>, F),
) -> Accumulated<F> {
    if K::Composite::is_clear(sample.k[3]) {
        return front;
    }
    let light = debug_light::<F, K>(casting, light_of(sample, thickness, light), at);
    K::Composite::composite(casting, front, light, sample)
}

/// Adds one step, split into parts, as far as anything can be seen. Returns what was gathered, and the number of samples taken.
#[inline(always)]
fn add_parts<F: Real, K: Kernel, W: Along<F>>(
    casting: &Casting<F>,
    chain: &Chain<F>,
    front: Accumulated<F>,
    step: &Step<F, W>,
    parts: F,
) -> (Accumulated<F>, u32) {
    if K::IS_FULL {
        add_parts_apart::<F, K, W>(casting, chain, front, step, parts)
    } else {
        add_parts_here::<F, K, W>(casting, chain, front, step, parts)
    }
}

/// The same, not inlined: there is much of it in kernels with everything.
#[inline(never)]
fn add_parts_apart<F: Real, K: Kernel, W: Along<F>>(
    casting: &Casting<F>,
    chain: &Chain<F>,
    front: Accumulated<F>,
    step: &Step<F, W>,
    parts: F,
) -> (Accumulated<F>, u32) {
    add_parts_here::<F, K, W>(casting, chain, front, step, parts)
}

#[inline(always)]
fn add_parts_here<F: Real, K: Kernel, W: Along<F>>(
    casting: &Casting<F>,
    chain: &Chain<F>,
    mut front: Accumulated<F>,
    step: &Step<F, W>,
    parts: F,
) -> (Accumulated<F>, u32) {
    let (way, ray) = (&step.way, step.way.ray());
    let line = ray.line();
    let part = step.length / parts;
    let thickness = casting.scene.extinction_per_metre * part;
    let half = F::of(0.5);
    let mut alone = Light::NONE;
    let (mut from, end) = step.scalars;
    let mut from_located = locate(casting.tables, from);
    let count = parts.to_index();
    let mut samples = 0;
    for j in 1..=count {
        let t = step.t0 + F::of_u32(j) * part;
        let mut to = end;
        if j < count {
            to = way.scalar_at::<K>(casting, t);
            samples += 1;
        }
        let to_located = locate(casting.tables, to);
        let middle = t - half * part;
        let spread = way.spread_at::<K>(casting, middle);
        let located = [&from_located, &to_located];
        let plain = sample_over::<F, K::Composite>(casting, located, (from, to), spread);
        if !K::Composite::is_clear(plain.k[3]) {
            let mut gradients = Gradients::NONE;
            let are_read = K::Shade::reads_gradients(casting.needs) || step.enhancers_look;
            if plain.k[3] > F::ZERO && are_read {
                gradients = way.gradients_at::<K>(casting, middle);
            }
            let mut enhanced = [plain];
            let gradient = gradients.at;
            let segment = Segment { line: &line, t: middle, length: part, scalars: (from, to), gradient };
            chain.enhance::<K, 1>(casting, &mut enhanced, &[segment]);
            let [sample] = enhanced;
            let light = if sample.k[3] > F::ZERO {
                let material = material_between::<F, K>(casting, from, to);
                K::Shade::lighting(casting, &gradients, ray, material)
            } else {
                Lighting::NONE
            };
            let light = light_of(&sample, thickness, light);
            let light = debug_light::<F, K>(casting, light, (ray, middle));
            if K::Composite::ONCE_PER_STEP {
                alone = alone.then(light);
            } else {
                front = K::Composite::composite(casting, front, light, &sample);
                if K::Composite::still_to_come(casting, front) < casting.scene.termination {
                    break;
                }
            }
        }
        (from, from_located) = (to, to_located);
    }
    if K::Composite::ONCE_PER_STEP {
        front = K::Composite::composite(casting, front, alone, &step.whole);
    }
    (front, samples)
}

/// Adds a pair of steps. Returns what was gathered, and the number of samples taken between those given.
#[inline(always)]
pub(super) fn add_pair<F: Real, K: Kernel, W: Along<F> + Copy>(
    casting: &Casting<F>,
    chain: &Chain<F>,
    front: Accumulated<F>,
    steps: &PairOfSteps<F, W>,
) -> (Accumulated<F>, u32) {
    let scene = casting.scene;
    let PairOfSteps { first, second, t: [t0, t1], length, scalars: [s0, s1, s2], range, spreads } = *steps;
    let thickness = scene.extinction_per_metre * length;
    let mut pair = Pair::new::<K::Composite>(casting, [s0, s1, s2], range, spreads);
    let middle = t0 + length;
    let half = F::of(0.5) * length;
    let mut own = [Gradients::NONE; 2];
    // Breaks are known of the way that the second takes.
    let enhancers_look = chain.looks::<K, F>(casting, t1) > F::ZERO;
    if K::ENHANCES {
        // Each step is seen by its own gradient: so the pair tells how much what is made of it varies.
        let mut gradients = Gradients::NONE;
        if enhancers_look && pair.reach.k[3].most(pair.both.k[3]) > F::ZERO {
            own = [first.gradients_at::<K>(casting, t0 + half), second.gradients_at::<K>(casting, t1 + half)];
            gradients = own[0].halfway(&own[1]);
        }
        let both = F::of(2.0) * length;
        let lines = [first.ray().line(), second.ray().line()];
        let segment = |way: usize, t, length, scalars, gradients: &Gradients<F>| Segment {
            line: &lines[way],
            t,
            length,
            scalars,
            gradient: gradients.at,
        };
        let segments = [
            segment(0, t0 + half, length, (s0, s1), &own[0]),
            segment(1, t1 + half, length, (s1, s2), &own[1]),
            segment(0, middle, both, (s0, s2), &gradients),
            segment(0, middle, both, range, &gradients),
        ];
        let mut samples = [pair.first, pair.second, pair.both, pair.reach];
        chain.enhance::<K, 4>(casting, &mut samples, &segments);
        [pair.first, pair.second, pair.both, pair.reach] = samples;
    }
    let visible = K::Composite::still_to_come(casting, front);
    let spread = F::of(K::Shade::spread(casting.needs));
    let parts = parts_of_step(pair.emitted(), thickness, visible, spread, scene.tolerance)
        .most(K::Composite::parts_of_rise(casting, front, &pair.reach));
    if parts > F::ONE {
        let step = Step { way: first, whole: pair.first, scalars: (s0, s1), t0, length, enhancers_look };
        let (front, near) = add_parts::<F, K, W>(casting, chain, front, &step, parts);
        let step =
            Step { way: second, whole: pair.second, scalars: (s1, s2), t0: t1, length, enhancers_look };
        let (front, far) = add_parts::<F, K, W>(casting, chain, front, &step, parts);
        return (front, near + far);
    }
    // The light in the middle of the pair serves both steps, unless the gradient is known in the middle of each.
    let mut lights = [Lighting::NONE; 2];
    if K::Shade::reads_gradients(casting.needs) && pair.first.k[3].most(pair.second.k[3]) > F::ZERO {
        let material = material_of_pair::<F, K>(casting, [s0, s1, s2]);
        let light = |gradients: &Gradients<F>| K::Shade::lighting(casting, gradients, first.ray(), material);
        lights = if enhancers_look {
            own.each_ref().map(light)
        } else {
            [light(&first.gradients_at::<K>(casting, middle)); 2]
        };
    }
    let front =
        add_whole::<F, K>(casting, front, &pair.first, thickness, lights[0], (first.ray(), t0 + half));
    (add_whole::<F, K>(casting, front, &pair.second, thickness, lights[1], (second.ray(), t1 + half)), 0)
}
