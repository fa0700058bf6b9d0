//! The path of a bent ray: straight ways, and what turns one into the next.

use crate::gradient::LEAST_SQUARE;
use crate::ray::Ray;
use crate::tables::{TablePlace, place_of};
use crate::{Casting, Real, vector::Vec3};
use needs::tables::{TABLE_CELLS, Tables};

/// See `wgsl/way/path.wgsl` for these three.
const SURFACE: f64 = 0.02;
const LONGEST_STRAIGHT: f64 = 1024.0;
const LEAST_CELLS: f64 = 0.5;

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
}

/// The refraction index at a scalar.
#[inline(always)]
pub(super) fn index_at<F: Real>(tables: &Tables, s: F) -> F {
    let TablePlace { node, part, .. } = place_of(tables, s);
    let (a, b) = (F::of_f32(tables.index[node]), F::of_f32(tables.index[node + 1]));
    a + (b - a) * part
}

/// Its mean slope between two scalars. A surface has none, nor has a piece of the table that is as steep as one: they are
/// met by crossing them.
#[inline(always)]
fn index_slope<F: Real>(tables: &Tables, s0: F, s1: F) -> F {
    let cells = F::of_u32(TABLE_CELLS as u32);
    if (s1 - s0).abs() * cells >= F::of(LEAST_CELLS) {
        return (index_at(tables, s1) - index_at(tables, s0)) / (s1 - s0);
    }
    let node = place_of(tables, F::of(0.5) * (s0 + s1)).node;
    let [from, to] = [node, node + 1].map(|node| F::of_f32(tables.optics[node].position));
    let change = F::of_f32(tables.index[node + 1]) - F::of_f32(tables.index[node]);
    if change.abs() > F::of(SURFACE) || to <= from { F::ZERO } else { change * cells / (to - from) }
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
        Self { ray, t: F::ZERO, way: F::ZERO, passing: None }
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

    /// Goes straight on.
    #[inline(always)]
    pub(super) fn advance(&mut self, length: F) {
        self.t = self.t + length;
        self.way = self.way + length;
    }

    /// The direction beyond the middle of a pair of steps, where the gradient of the scalar (per finest voxel) is
    /// `gradient` and the pair, straight on, would go from s0 to s2 over `length` metres.
    #[inline(always)]
    pub(super) fn direction_beyond(
        &mut self,
        casting: &Casting<F>,
        gradient: Vec3<F>,
        (s0, s2): (F, F),
        length: F,
    ) -> Vec3<F> {
        let tables = casting.tables;
        let v = self.ray.direction_in_display;
        let (n0, n2) = (index_at(tables, s0), index_at(tables, s2));
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
            let bend = index_slope(tables, s0, s2) * length / casting.scene.voxel_m;
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

/// Whether the index may change between two scalars.
#[inline(always)]
pub(super) fn bends<F: Real>(tables: &Tables, s0: F, s1: F) -> bool {
    index_at(tables, s0) != index_at(tables, s1) || index_slope(tables, s0, s1) != F::ZERO
}
