//! A bent ray's path through the volume: straight pairs of steps, with a turn in the middle of each.

use crate::twin::brick::{PairOfSteps, Straight, add_pair};
use crate::twin::composite::{Accumulated, Composite};
use crate::twin::enhance::Chain;
use crate::twin::gradient::{Gradients, LEAST_SQUARE};
use crate::twin::kernel::Kernel;
use crate::twin::levels::Brick;
use crate::twin::ray::{Ray, far};
use crate::twin::refine::{Voxel, scalars_in_reach};
use crate::twin::tables::is_vacant;
use crate::twin::traverse::{OWN_EDGE, node_low, voxel_edge};
use crate::twin::{Cast, Casting, Real, vector::Vec3};
use layout::{NO_NODE, NO_SLOT, NodeRecord};

/// See `wgsl/way/refracted.wgsl` for these eight.
const MOST_STEP: f64 = 0.5;
const LONGEST_STRAIGHT: f64 = 1024.0;
const LARGE_CHANGE: f64 = 0.004;
const MOST_HALVINGS: u32 = 4;
const SURFACE: f64 = 0.02;
const LONGEST_WAY_DIAGONALS: f64 = 4.0;
const LEAST_PAIR: f64 = 1e-3;
const LEAST_CELLS: f64 = 0.5;

/// What a bent ray carries along.
struct Bent<F> {
    /// Straight from the last turn on.
    ray: Ray<F>,
    /// Metres since that turn.
    t: F,
    /// Metres of the whole way.
    way: F,
    /// The indices before and beyond a surface that turned the ray and that it may not have passed yet.
    passing: Option<(F, F)>,
}

/// The refraction index at a scalar.
#[inline(always)]
fn index_at<F: Real>(table: &[f32], s: F) -> F {
    let u = s * F::of_u32(table.len() as u32 - 1);
    let cell = (u.to_index() as usize).min(table.len() - 2);
    let (a, b) = (F::of_f32(table[cell]), F::of_f32(table[cell + 1]));
    a + (b - a) * (u - F::of_u32(cell as u32))
}

/// Its mean slope between two scalars. The cell of a jump has none: surfaces are met by crossing them.
#[inline(always)]
fn index_slope<F: Real>(table: &[f32], s0: F, s1: F) -> F {
    let cells = F::of_u32(table.len() as u32 - 1);
    if (s1 - s0).abs() * cells >= F::of(LEAST_CELLS) {
        return (index_at(table, s1) - index_at(table, s0)) / (s1 - s0);
    }
    let cell = ((F::of(0.5) * (s0 + s1) * cells).to_index() as usize).min(table.len() - 2);
    let change = F::of_f32(table[cell + 1]) - F::of_f32(table[cell]);
    if change.abs() > F::of(SURFACE) { F::ZERO } else { change * cells }
}

#[inline(always)]
fn normalize<F: Real>(v: Vec3<F>) -> Vec3<F> {
    let length = v.length();
    v.map(|c| c / length)
}

impl<F: Real> Bent<F> {
    /// The direction beyond the middle of a pair of steps, where the gradient of the scalar (per finest voxel) is
    /// `gradient` and the pair, straight on, would go from s0 to s2 over `length` metres.
    #[inline(always)]
    fn direction_beyond(
        &mut self,
        casting: &Casting<F>,
        gradient: Vec3<F>,
        (s0, s2): (F, F),
        length: F,
    ) -> Vec3<F> {
        let table = &casting.tables.index;
        let v = self.ray.direction_in_display;
        let (n0, n2) = (index_at(table, s0), index_at(table, s2));
        // A ray that was turned by a surface and has not passed it yet goes straight on; then it has the index beyond.
        let mut own = n0;
        if let Some((before, beyond)) = self.passing {
            if (n0 - before).abs() < (n0 - beyond).abs() {
                return v;
            }
            own = beyond;
            self.passing = None;
        }
        let square = gradient.dot(gradient);
        if square < F::of(LEAST_SQUARE) {
            return v;
        }
        if (n2 - n0).abs() <= F::of(SURFACE) {
            let bend = index_slope(table, s0, s2) * length / casting.scene.voxel_m;
            return normalize(v * (F::of(0.5) * (n0 + n2)) + gradient * bend);
        }
        let size = square.sqrt();
        let mut normal = gradient.map(|c| c / size);
        let towards = normal.dot(v);
        if towards < F::ZERO {
            normal = normal * -F::ONE;
        }
        // From the index that the direction belongs to, so that the turns of a steep rise add up to Snell's law.
        let along = own * towards.abs();
        let beyond = along * along + n2 * n2 - own * own;
        if beyond < F::ZERO {
            return normalize(v - normal * (F::of(2.0) * towards.abs()));
        }
        self.passing = Some((n0, n2));
        normalize(v * own + normal * (beyond.sqrt() - along))
    }
}

/// The same ray, turned at t.
#[inline(always)]
fn turned_at<F: Real>(casting: &Casting<F>, ray: &Ray<F>, t: F, direction_in_display: Vec3<F>) -> Ray<F> {
    let next = Ray { origin_in_volume: ray.point(t), origin_in_display: ray.point_in_display(t), ..*ray };
    next.turned(casting.scene, direction_in_display)
}

/// Where the ray, which is inside, leaves the volume.
#[inline(always)]
fn exit_of_volume<F: Real>(casting: &Casting<F>, ray: &Ray<F>) -> F {
    let mut t = far::<F>();
    for axis in 0..3 {
        if !ray.is_parallel(axis) {
            let face = if ray.is_forward(axis) { casting.scene.dims.0[axis] } else { F::ZERO };
            t = t.least((face - ray.origin_in_volume.0[axis]) * ray.inverse.0[axis]);
        }
    }
    t
}

#[inline(always)]
fn is_in_box<F: Real>(point: Vec3<F>, low: Vec3<F>, high: Vec3<F>) -> bool {
    (0..3).all(|axis| point.0[axis] >= low.0[axis] && point.0[axis] <= high.0[axis])
}

#[inline(always)]
fn is_in_node<F: Real>(casting: &Casting<F>, node: &NodeRecord, point: Vec3<F>) -> bool {
    let finest = casting.scene.finest_depth;
    let low = node_low::<F>(finest, node);
    let edge = F::of(OWN_EDGE) * voxel_edge::<F>(finest, node.depth);
    is_in_box(point, low, low + Vec3::splat(edge))
}

/// Whether the index may change between two scalars.
#[inline(always)]
fn bends<F: Real>(table: &[f32], s0: F, s1: F) -> bool {
    index_at(table, s0) != index_at(table, s1) || index_slope(table, s0, s1) != F::ZERO
}

#[inline(never)]
pub(super) fn cast_ray<F: Real, K: Kernel>(casting: &Casting<F>, eye_ray: &Ray<F>) -> Cast<F> {
    let mut front = Accumulated::NOTHING;
    let mut cast = Cast::NOTHING;
    let span = eye_ray.clip_to_volume(casting.scene.dims);
    if !matches!(span.0.partial_cmp(&span.1), Some(std::cmp::Ordering::Less)) {
        return cast;
    }
    let mut chain = Chain::start::<K>(casting, eye_ray);
    let ray = turned_at(casting, eye_ray, span.0, eye_ray.direction_in_display);
    let mut bent = Bent { ray, t: F::ZERO, way: F::ZERO, passing: None };
    chain.follow(casting, &bent.ray);
    let longest_way = casting.scene.diagonal_m * F::of(LONGEST_WAY_DIAGONALS);
    let mut at = casting.leaf_at(bent.ray.origin_in_volume, &bent.ray);
    let mut reported = NO_NODE;
    let mut known = None;
    while at != NO_NODE && bent.way < longest_way {
        let node = &casting.volume.nodes[at as usize];
        if bent.t * bent.ray.speed > F::of(LONGEST_STRAIGHT) {
            bent.ray = turned_at(casting, &bent.ray, bent.t, bent.ray.direction_in_display);
            bent.t = F::ZERO;
            chain.follow(casting, &bent.ray);
        }
        let exit = casting.exit_of(node, &bent.ray);
        let t_out = exit.t.least(exit_of_volume(casting, &bent.ray));
        if node.slot == NO_SLOT {
            known = None;
            bent.way = bent.way + (t_out - bent.t).most(F::ZERO);
            bent.t = t_out.most(bent.t);
            if t_out < exit.t {
                break;
            }
            at = casting.leaf_beyond(node, exit.axis, bent.ray.point(bent.t), &bent.ray);
            continue;
        }
        if reported != at {
            reported = at;
            known = None;
            casting.observer.note(at, node.deficit);
            cast.is_missing |= node.deficit > 0.0;
        }
        let brick = Brick::new::<K>(casting, node, &bent.ray);
        let voxel = Voxel::new(casting, node, &bent.ray);
        // As many equal pairs as lie between here and the border or the next break; one of them is taken.
        let span_left =
            (t_out.least(chain.next_break::<K>(bent.t)) - bent.t).most(F::of(LEAST_PAIR) * voxel.edge);
        let two = F::of(2.0);
        let longest = voxel.longest_step::<K>(casting, &brick, &bent.ray, bent.t);
        let longest = longest.least(F::of(MOST_STEP) * voxel.edge);
        let pairs = (span_left / (two * longest)).ceil().most(F::ONE);
        let mut step = F::of(0.5) * span_left / pairs;
        let t0 = bent.t;
        let unseen = brick.pairs_unseen::<K>(t0, step);
        if unseen > 0 {
            known = None;
            let skipped = F::of_u32(unseen).least(pairs) * two * step;
            bent.t = bent.t + skipped;
            bent.way = bent.way + skipped;
            if bent.t >= t_out {
                if t_out < exit.t {
                    break;
                }
                at = casting.leaf_beyond(node, exit.axis, bent.ray.point(bent.t), &bent.ray);
            }
            continue;
        }
        let ray = bent.ray;
        let s0 = known.unwrap_or_else(|| brick.scalar_at::<K>(casting, &ray, t0));
        let table = &casting.tables.index;
        let mut s2 = brick.scalar_at::<K>(casting, &ray, t0 + two * step);
        for _ in 0..MOST_HALVINGS {
            if (index_at(table, s2) - index_at(table, s0)).abs() <= F::of(LARGE_CHANGE) {
                break;
            }
            step = F::of(0.5) * step;
            s2 = brick.scalar_at::<K>(casting, &ray, t0 + two * step);
            cast.samples += 1;
        }
        let mut t1 = t0 + step;
        let s1 = brick.scalar_at::<K>(casting, &ray, t1);
        cast.samples += 3;
        let mut next_brick = brick;
        let mut is_turned = false;
        if bends(table, s0, s2) {
            let gradient = Gradients::new::<K>(casting, &brick, &ray, t1).at;
            let direction = bent.direction_beyond(casting, gradient, (s0, s2), two * step);
            is_turned = direction != ray.direction_in_display;
            if is_turned {
                bent.ray = turned_at(casting, &ray, t1, direction);
                chain.follow(casting, &bent.ray);
                next_brick = Brick::new::<K>(casting, node, &bent.ray);
                t1 = F::ZERO;
                s2 = next_brick.scalar_at::<K>(casting, &bent.ray, step);
                cast.samples += 1;
            }
        }
        known = Some(s2);
        bent.t = t1 + step;
        bent.way = bent.way + two * step;
        let range = scalars_in_reach(s0, s1, s2);
        if !is_vacant(&casting.tables.occupied, range.0, range.1) {
            let steps = PairOfSteps {
                first: Straight { brick: &brick, ray: &ray },
                second: Straight { brick: &next_brick, ray: &bent.ray },
                t: [t0, t1],
                length: step,
                scalars: [s0, s1, s2],
                range,
            };
            let (added, parts) = add_pair::<F, K>(casting, &chain, front, &steps);
            front = added;
            cast.samples += 2 * (parts.to_index() - 1);
            if K::Composite::still_to_come(casting, front) < casting.scene.termination {
                break;
            }
        }
        let point = bent.ray.point(bent.t);
        if is_turned {
            if !is_in_box(point, Vec3::ZERO, casting.scene.dims) {
                break;
            }
            if !is_in_node(casting, node, point) {
                at = casting.leaf_at(point, &bent.ray);
            }
        } else if bent.t >= t_out {
            if t_out < exit.t {
                break;
            }
            at = casting.leaf_beyond(node, exit.axis, point, &bent.ray);
        }
    }
    cast.with_colours(front)
}
