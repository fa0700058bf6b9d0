//! The bricks of the cut that all casters draw.

use super::look::Look;
use crate::scene::Scene;
use bricks::{BRICK_EDGE, Codes, NodeKey, OVERLAP, OWN_EDGE};
use glam::{DAffine3, DVec3, Vec3};
use lightloom_tests::ideal_cut::ideal_cut;

/// Strides of the codes along x, y and z.
const STRIDES: [usize; 3] = [1, BRICK_EDGE, BRICK_EDGE * BRICK_EDGE];

/// What there is to be seen.
pub struct Content {
    pub leaves: Vec<Leaf>,
    pub look: Look,
    pub volume_from_display: DAffine3,
    /// The box in the display frame around all that is seen, metres.
    pub bounds: [DVec3; 2],
}

/// A leaf that shows anything.
pub struct Leaf {
    /// Its region, finest voxels.
    pub region: (DVec3, DVec3),
    /// The box around it in the display frame, metres.
    pub bounds: [DVec3; 2],
    /// Of its first sample, finest voxels.
    first: DVec3,
    /// Of a voxel, finest voxels.
    edge: f64,
    codes: Vec<u16>,
    low: f32,
    step: f32,
}

impl Content {
    pub fn of(scene: &Scene) -> Self {
        let (source, frame) = (&scene.source, &scene.frame);
        let (shape, all) = (source.shape(), 0..scene.display.projectors.len() as u32);
        let cut = ideal_cut(&**source, &scene.display, frame, &Vec::from_iter(all));
        let leaf = |key: NodeKey| {
            let brick = source.brick(key).expect("every brick of a test scene can be read");
            let codes = match brick.codes {
                Codes::U8(codes) => codes.into_iter().map(u16::from).collect(),
                Codes::U16(codes) => codes,
            };
            let edge = f64::from(1u32 << shape.level(key.depth));
            let first = key.cell.as_dvec3() * OWN_EDGE as f64 - OVERLAP as f64 + 0.5;
            let corners = shape.corners(key).map(|corner| frame.display_from_volume.transform_point3(corner));
            Leaf {
                region: shape.region(key),
                bounds: around(corners),
                first: first * edge,
                edge,
                codes,
                low: brick.low,
                step: brick.step,
            }
        };
        let leaves: Vec<Leaf> = cut.leaves.into_iter().map(leaf).collect();
        let bounds = around(leaves.iter().flat_map(|leaf| leaf.bounds));
        let volume_from_display = frame.display_from_volume.inverse();
        Self { leaves, look: Look::of(scene), volume_from_display, bounds }
    }
}

fn around(points: impl IntoIterator<Item = DVec3>) -> [DVec3; 2] {
    let nothing = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    points.into_iter().fold(nothing, |[low, high], point| [low.min(point), high.max(point)])
}

impl Leaf {
    /// What is shown at a point of its region, finest voxels.
    #[inline]
    pub fn shown(&self, point: DVec3, look: &Look) -> [f32; 4] {
        let place = ((point - self.first) / self.edge).as_vec3();
        // So far from the rim that there are differences on both sides.
        let low = place.floor().clamp(Vec3::ONE, Vec3::splat((BRICK_EDGE - 3) as f32));
        let part = (place - low).clamp(Vec3::ZERO, Vec3::ONE);
        let at = low.x as usize + STRIDES[1] * low.y as usize + STRIDES[2] * low.z as usize;
        let code = |at: usize| f32::from(self.codes[at]);
        let gradient = || {
            let along = STRIDES.map(|stride| between(at, part, |at| code(at + stride) - code(at - stride)));
            Vec3::from_array(along) * (0.5 * self.step / self.edge as f32)
        };
        look.shown(self.low + self.step * between(at, part, code), gradient)
    }
}

/// Trilinear interpolation of what is said of eight samples.
#[inline]
fn between(at: usize, part: Vec3, of: impl Fn(usize) -> f32) -> f32 {
    let mix = |a: f32, b: f32, part: f32| a + part * (b - a);
    let along = |at: usize| mix(of(at), of(at + 1), part.x);
    let across = |at: usize| mix(along(at), along(at + STRIDES[1]), part.y);
    mix(across(at), across(at + STRIDES[2]), part.z)
}
