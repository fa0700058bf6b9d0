//! What casts the rays of a frame.

use super::RenderError;
use crate::device::Device;
use glam::DVec3;
use needs::Needs;
use planes::{Fan, Planes};
use protocol::{Caster, CasterChoice, FrameState};
use twin::ProjectorRays;

/// Why planes have to be asked for.
const LESS_EXACT: &str =
    "row planes err more than rays at the same tolerance: ask for them where speed counts more";

/// The caster of a frame, and what its rows share where that is row planes.
#[derive(Debug)]
pub(super) struct CasterOfFrame {
    pub(super) caster: Caster,
    pub(super) fan: Option<Fan>,
}

impl CasterOfFrame {
    /// # Errors
    /// Planes were asked for and cannot serve the frame.
    pub(super) fn choose(
        asked: CasterChoice,
        device: &Device,
        needs: &Needs,
        rays: &[ProjectorRays<f32>],
        frame: &FrameState,
        dims: DVec3,
    ) -> Result<Self, RenderError> {
        match asked {
            CasterChoice::Rays => return Ok(Self { caster: Caster::Rays, fan: None }),
            CasterChoice::Auto => {
                return Ok(Self { caster: Caster::RaysBecause(LESS_EXACT.to_owned()), fan: None });
            }
            CasterChoice::Planes => {}
        }
        let serving = if device.has_planes() {
            Planes::refusal(needs).map_or_else(|| Fan::of(rays), Err)
        } else {
            Err("a GPU has no kernels for them yet, --device cpu has")
        };
        let reaches = |fan: Fan| {
            let corner =
                |i: u32| dims * DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
            let is_near =
                (0..8).all(|i| fan.reaches(frame.display_from_volume.transform_point3(corner(i)).z));
            if is_near { Ok(fan) } else { Err("the volume reaches to where all beams cross") }
        };
        let fan = serving.and_then(reaches).map_err(RenderError::Planes)?;
        Ok(Self { caster: Caster::Planes { views: rays.len() as u32 }, fan: Some(fan) })
    }
}
