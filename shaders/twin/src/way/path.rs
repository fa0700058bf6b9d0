//! The path of a bent ray: straight ways, and what turns one into the next.

use crate::gradient::LEAST_SQUARE;
use crate::ray::Ray;
use crate::tables::{TablePlace, place_of};
use crate::{Casting, Real, vector::Vec3};
use needs::tables::{TABLE_CELLS, Tables};

/// See `wgsl/way/path.wgsl` for these four.
const TURN_ERROR: f64 = 3.0;
const SURFACE: f64 = 0.02;
const LONGEST_STRAIGHT: f64 = 1024.0;
const INDEX_ROUNDING: f64 = 2.5e-7;

/// What a bent ray carries along.
pub(super) struct Bent<F> {
    /// Straight from the last turn on.
    pub(super) ray: Ray<F>,
    /// Metres since that turn.
    pub(super) t: F,
    /// Metres of the whole way.
    pub(super) way: F,
    /// The indices before and beyond a surface that turned the ray and that it may not have passed yet.
    passing: Option<(F, F)>,
    /// ∇ν at the last turn, per finest voxel, display frame.
    pub(super) force: Vec3<F>,
    /// Metres since then.
    pub(super) since: F,
    /// The side of the jumps of ν that the ray is on, where that is known.
    pub(super) side: Option<Side>,
    /// Surfaces in a row that were met at once.
    pub(super) met_at_once: u32,
}

/// A side of the jumps of ν: how many of them lie at or below it. ν is seen from there.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Side(u32);

/// A jump of ν, as it is met from one side.
pub(super) struct Surface<F> {
    /// The scalar where it is.
    pub(super) at: F,
    from: F,
    to: F,
    beyond: Side,
}

impl Side {
    /// The side that a scalar lies on.
    #[inline(always)]
    pub(super) fn of<F: Real>(tables: &Tables, s: F) -> Self {
        Self(tables.index[place_of(tables, s).node].jumps)
    }

    /// ν at a scalar; beyond the jumps around this side it goes on with its value there.
    #[inline(always)]
    pub(super) fn index_at<F: Real>(self, tables: &Tables, s: F) -> F {
        let TablePlace { node, part, .. } = place_of(tables, s);
        let jumps = tables.index[node].jumps;
        if jumps != self.0 {
            let (below, above) = self.nodes_at_jump(tables, jumps > self.0);
            return F::of_f32(tables.index[if jumps > self.0 { below } else { above }].value);
        }
        let [a, b] = [node, node + 1].map(|node| F::of_f32(tables.index[node].value));
        a + (b - a) * part
    }

    /// The mean slope of ν between two scalars, where no jump lies: what the table says where that explains the change, for
    /// a small difference has no digits.
    #[inline(always)]
    pub(super) fn slope<F: Real>(self, tables: &Tables, s0: F, s1: F) -> F {
        let cells = F::of_u32(TABLE_CELLS as u32);
        let (n0, n1) = (self.index_at(tables, s0), self.index_at(tables, s1));
        let entry = tables.index[place_of(tables, F::of(0.5) * (s0 + s1)).node];
        let listed = F::of_f32(entry.slope) * cells;
        let is_own = entry.jumps == self.0;
        let unexplained = (n1 - n0 - listed * (s1 - s0)).abs();
        if is_own && unexplained <= F::of(INDEX_ROUNDING) * (n0 + n1) {
            listed
        } else if s1 != s0 {
            (n1 - n0) / (s1 - s0)
        } else {
            F::ZERO
        }
    }

    /// Whether the index may change between two scalars.
    #[inline(always)]
    pub(super) fn bends<F: Real>(self, tables: &Tables, s0: F, s1: F) -> bool {
        self.index_at(tables, s0) != self.index_at(tables, s1) || self.slope(tables, s0, s1) != F::ZERO
    }

    /// The first jump on the way to another side.
    pub(super) fn surface_to<F: Real>(self, tables: &Tables, other: Self) -> Surface<F> {
        let is_up = other.0 > self.0;
        let (below, above) = self.nodes_at_jump(tables, is_up);
        let (from, to) = if is_up { (below, above) } else { (above, below) };
        let value = |node: usize| F::of_f32(tables.index[node].value);
        Surface {
            at: F::of_f32(tables.optics[above].position) / F::of_u32(TABLE_CELLS as u32),
            from: value(from),
            to: value(to),
            beyond: Self(tables.index[to].jumps),
        }
    }

    /// The nodes below and above the next jump, up or down.
    #[inline(never)]
    fn nodes_at_jump(self, tables: &Tables, is_up: bool) -> (usize, usize) {
        let is_before = |jumps: u32| if is_up { jumps <= self.0 } else { jumps < self.0 };
        let above = tables.index.partition_point(|entry| is_before(entry.jumps));
        (above - 1, above)
    }
}

#[inline(always)]
fn normalize<F: Real>(v: Vec3<F>) -> Vec3<F> {
    let length = v.length();
    v.map(|c| c / length)
}

impl<F: Real> Bent<F> {
    /// From where a ray from the eye enters the volume.
    #[inline(always)]
    pub(super) fn entering(casting: &Casting<F>, eye_ray: &Ray<F>, t: F) -> Self {
        let ray = turned_at(casting, eye_ray, t, eye_ray.direction_in_display);
        Self {
            ray,
            t: F::ZERO,
            way: F::ZERO,
            passing: None,
            force: Vec3::ZERO,
            since: F::ZERO,
            side: None,
            met_at_once: 0,
        }
    }

    /// A new origin where the last is far behind, so that no step is lost to rounding; whether there is one.
    #[inline(always)]
    pub(super) fn renew(&mut self, casting: &Casting<F>) -> bool {
        let is_long = self.t * self.ray.speed > F::of(LONGEST_STRAIGHT);
        if is_long {
            self.turn(casting, self.t, self.ray.direction_in_display);
        }
        is_long
    }

    /// Turns the ray at t.
    #[inline(always)]
    pub(super) fn turn(&mut self, casting: &Casting<F>, t: F, direction_in_display: Vec3<F>) {
        self.ray = turned_at(casting, &self.ray, t, direction_in_display);
        self.t = F::ZERO;
    }

    /// Goes straight on through what bends nothing.
    #[inline(always)]
    pub(super) fn advance(&mut self, length: F) {
        self.t = self.t + length;
        self.way = self.way + length;
        self.forget();
    }

    /// Forgets what was before something that bends nothing.
    #[inline(always)]
    pub(super) fn forget(&mut self) {
        (self.force, self.since, self.side) = (Vec3::ZERO, F::ZERO, None);
    }

    /// Whether a pair of steps of `step` metres, with `force` in its middle, turns the ray as closely as it has to.
    #[inline(always)]
    pub(super) fn is_smooth(&self, casting: &Casting<F>, force: Vec3<F>, step: F) -> bool {
        let scene = casting.scene;
        let change = (force - self.force).length() / (step + self.since);
        F::of(0.5) * change * step * step <= F::of(TURN_ERROR) * scene.tolerance * scene.voxel_m
    }

    /// The direction beyond the middle of a pair of steps, where the gradient of the scalar (per finest voxel) is
    /// `gradient` and the pair, straight on, would go from s0 to s2 over `length` metres.
    #[inline(always)]
    pub(super) fn direction_beyond(
        &mut self,
        casting: &Casting<F>,
        side: Side,
        gradient: Vec3<F>,
        (s0, s2): (F, F),
        length: F,
    ) -> Vec3<F> {
        let tables = casting.tables;
        let v = self.ray.direction_in_display;
        let (n0, n2) = (side.index_at(tables, s0), side.index_at(tables, s2));
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
            let bend = side.slope(tables, s0, s2) * length / casting.scene.voxel_m;
            return normalize(v * (F::of(0.5) * (n0 + n2)) + gradient * bend);
        }
        // From the index that the direction belongs to, so that the turns of a steep rise add up to Snell's law.
        match refracted(v, gradient, own, n2) {
            Some(beyond) => {
                self.passing = Some((n0, n2));
                beyond
            }
            None => mirrored(v, gradient),
        }
    }

    /// The direction beyond a surface, where the gradient of the scalar is `gradient`.
    #[inline(always)]
    pub(super) fn direction_through(&mut self, surface: &Surface<F>, gradient: Vec3<F>) -> Vec3<F> {
        let v = self.ray.direction_in_display;
        if gradient.dot(gradient) < F::of(LEAST_SQUARE) {
            self.side = Some(surface.beyond);
            return v;
        }
        match refracted(v, gradient, surface.from, surface.to) {
            Some(beyond) => {
                self.side = Some(surface.beyond);
                beyond
            }
            None => mirrored(v, gradient),
        }
    }
}

/// The normal of a surface with this gradient, along the direction v, and its cosine with it.
#[inline(always)]
fn normal_along<F: Real>(v: Vec3<F>, gradient: Vec3<F>) -> (Vec3<F>, F) {
    let size = gradient.length();
    let normal = gradient.map(|c| c / size);
    let towards = normal.dot(v);
    if towards < F::ZERO { (normal * -F::ONE, -towards) } else { (normal, towards) }
}

/// Snell's law; None beyond the critical angle.
#[inline(always)]
fn refracted<F: Real>(v: Vec3<F>, gradient: Vec3<F>, from: F, to: F) -> Option<Vec3<F>> {
    let (normal, towards) = normal_along(v, gradient);
    let along = from * towards;
    let beyond = along * along + to * to - from * from;
    (beyond >= F::ZERO).then(|| normalize(v * from + normal * (beyond.sqrt() - along)))
}

#[inline(always)]
fn mirrored<F: Real>(v: Vec3<F>, gradient: Vec3<F>) -> Vec3<F> {
    let (normal, towards) = normal_along(v, gradient);
    normalize(v - normal * (F::of(2.0) * towards))
}

/// The same ray, turned at t.
#[inline(always)]
fn turned_at<F: Real>(casting: &Casting<F>, ray: &Ray<F>, t: F, direction_in_display: Vec3<F>) -> Ray<F> {
    let next = Ray { origin_in_volume: ray.point(t), origin_in_display: ray.point_in_display(t), ..*ray };
    next.turned(casting.scene, direction_in_display)
}
