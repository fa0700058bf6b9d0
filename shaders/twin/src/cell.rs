//! A stretch of a ray whose ends are known: row planes sample these, and all that follows a sample is the ray's own code.

use super::along::Along;
use super::brick::{PairOfSteps, add_pair};
use super::composite::{Accumulated, Composite, Consistent, Mimda, Over, Paper};
use super::enhance::Chain;
use super::features::Features;
use super::gradient::Gradients;
use super::kernel::{Full, Kernel};
use super::shade::AnyShade;
use super::tables::is_vacant_around;
use super::vector::Vec3;
use super::{Casting, ProjectorRays, ray::Ray, real::Number};
use needs::Compositing;
use optics::MimdaForm;

/// A ray on its way, and what enhancers make of its direction.
#[derive(Clone, Copy, Debug)]
pub struct RayOnItsWay {
    ray: Ray<f32>,
    chain: Chain<f32>,
}

impl RayOnItsWay {
    /// The ray of a projector's pixel (x, y).
    pub fn of_pixel(casting: &Casting<f32>, rays: &ProjectorRays<f32>, x: u32, y: u32) -> Self {
        let ray = Ray::of_pixel(casting.scene, rays, x as f32 + 0.5, y as f32 + 0.5);
        Self { ray, chain: Chain::start::<Everything<Over<false>>>(casting, &ray) }
    }

    /// t of the place at a depth, display frame.
    pub fn t_at(&self, z: f32) -> f32 {
        (z - self.ray.origin_in_display.0[2]) / self.ray.direction_in_display.0[2]
    }
}

/// A stretch of a ray, straight from what is known at one end to what is at the other.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// Its ends.
    pub t: [f32; 2],
    /// The part of it that the ray passes within the volume.
    pub within: [f32; 2],
    /// The scalars at its ends.
    pub scalars: [f32; 2],
    /// Half-widths of the scalars that these stand for.
    pub spreads: [f32; 2],
    /// The gradients there, where the scene's needs ask for any.
    pub gradients: [Gradients<f32>; 2],
}

type Everything<C> = Full<AnyShade, C>;

/// A part of a cell, on its ray.
#[derive(Clone, Copy)]
struct CellOnRay<'a> {
    cell: &'a Cell,
    ray: &'a Ray<f32>,
}

impl CellOnRay<'_> {
    #[inline(always)]
    fn share(&self, t: f32) -> f32 {
        let [from, to] = self.cell.t;
        if to > from { (t - from) / (to - from) } else { 0.0 }
    }

    #[inline(always)]
    fn between(&self, [a, b]: [f32; 2], t: f32) -> f32 {
        a + (b - a) * self.share(t)
    }
}

impl Along<f32> for CellOnRay<'_> {
    fn ray(&self) -> &Ray<f32> {
        self.ray
    }

    fn scalar_at<K: Features>(&self, _: &Casting<f32>, t: f32) -> f32 {
        self.between(self.cell.scalars, t)
    }

    fn spread_at<K: Features>(&self, _: &Casting<f32>, t: f32) -> f32 {
        self.between(self.cell.spreads, t)
    }

    fn gradients_at<K: Features>(&self, _: &Casting<f32>, t: f32) -> Gradients<f32> {
        let ([a, b], share) = (self.cell.gradients, self.share(t));
        let between = |a: Vec3<f32>, b: Vec3<f32>| a.lerp(b, share);
        Gradients {
            at: between(a.at, b.at),
            coarse: between(a.coarse, b.coarse),
            coarsest: between(a.coarsest, b.coarsest),
        }
    }
}

/// What a cell adds to what lies in front of it, part by part between the places where the law of an enhancer is not smooth.
pub fn add_cell(
    casting: &Casting<f32>,
    way: &RayOnItsWay,
    front: Accumulated<f32>,
    cell: &Cell,
) -> Accumulated<f32> {
    match casting.needs.compositing {
        Compositing::Over if casting.needs.tells_importance => {
            add_with::<Everything<Over<true>>>(casting, way, front, cell)
        }
        Compositing::Over => add_with::<Everything<Over<false>>>(casting, way, front, cell),
        Compositing::Mimda(MimdaForm::Paper) => {
            add_with::<Everything<Mimda<Paper>>>(casting, way, front, cell)
        }
        Compositing::Mimda(MimdaForm::Consistent) => {
            add_with::<Everything<Mimda<Consistent>>>(casting, way, front, cell)
        }
    }
}

/// The opacity that what follows may still add.
pub fn still_to_come(casting: &Casting<f32>, front: Accumulated<f32>) -> f32 {
    match casting.needs.compositing {
        Compositing::Over => Over::<false>::still_to_come(casting, front),
        Compositing::Mimda(MimdaForm::Paper) => Mimda::<Paper>::still_to_come(casting, front),
        Compositing::Mimda(MimdaForm::Consistent) => Mimda::<Consistent>::still_to_come(casting, front),
    }
}

#[inline(never)]
fn add_with<K: Kernel>(
    casting: &Casting<f32>,
    RayOnItsWay { ray, chain }: &RayOnItsWay,
    mut front: Accumulated<f32>,
    cell: &Cell,
) -> Accumulated<f32> {
    let way = CellOnRay { cell, ray };
    let [mut t, end] = cell.within;
    while t < end {
        let until = chain.next_break::<K, f32>(casting, t).least(end);
        let step = 0.5 * (until - t);
        let scalars = [t, t + step, until].map(|t| way.scalar_at::<K>(casting, t));
        let spreads = [0.5, 1.5].map(|steps| way.spread_at::<K>(casting, t + steps * step));
        // Straight on, it meets nothing beside its ends.
        let range = (scalars[0].least(scalars[2]), scalars[0].most(scalars[2]));
        if !is_vacant_around(&casting.tables.cells, range, spreads[0].most(spreads[1])) {
            let steps = PairOfSteps {
                first: way,
                second: way,
                t: [t, t + step],
                length: step,
                scalars,
                range,
                spreads,
            };
            front = add_pair::<f32, K, _>(casting, chain, front, &steps).0;
        }
        t = until;
    }
    front
}
