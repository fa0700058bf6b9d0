//! What casts the rays of a frame.

use super::RenderError;
use crate::device::Device;
use glam::DVec3;
use needs::Needs;
use planes::{Fan, Planes};
use protocol::{Caster, CasterChoice, FrameState};
use twin::ProjectorRays;

/// Where a display has fewer views, sampling planes for them takes about as long as casting their rays.
const FEWEST_VIEWS: usize = 24;
const TOO_FEW_VIEWS: &str = "the display has fewer than 24 projectors, too few for row planes to save time";

/// The caster of a frame, and what its rows share where that is row planes.
#[derive(Debug)]
pub(super) struct CasterOfFrame {
    pub(super) caster: Caster,
    pub(super) fan: Option<Fan>,
}

impl CasterOfFrame {
    /// For some views of a display: `rays`, of `all`. The whole display decides, so that all back-ends cast alike.
    ///
    /// # Errors
    /// Planes were asked for and cannot serve the frame.
    pub(super) fn choose(
        asked: CasterChoice,
        device: &Device,
        needs: &Needs,
        [rays, all]: [&[ProjectorRays<f32>]; 2],
        frame: &FrameState,
        dims: DVec3,
    ) -> Result<Self, RenderError> {
        let because = |why: &str| Self { caster: Caster::RaysBecause(why.to_owned()), fan: None };
        match asked {
            CasterChoice::Rays => return Ok(Self { caster: Caster::Rays, fan: None }),
            CasterChoice::Auto if all.len() < FEWEST_VIEWS && !frame.welcomes_planes => {
                return Ok(because(TOO_FEW_VIEWS));
            }
            CasterChoice::Auto | CasterChoice::Planes => {}
        }
        match (shared_fan(device, needs, [rays, all], frame, dims), asked) {
            (Ok(fan), _) => Ok(Self { caster: Caster::Planes { views: rays.len() as u32 }, fan: Some(fan) }),
            (Err(why), CasterChoice::Planes) => Err(RenderError::Planes(why)),
            (Err(why), _) => Ok(because(why)),
        }
    }
}

/// What the views' rows share; or why planes cannot serve the frame.
fn shared_fan(
    device: &Device,
    needs: &Needs,
    [rays, all]: [&[ProjectorRays<f32>]; 2],
    frame: &FrameState,
    dims: DVec3,
) -> Result<Fan, &'static str> {
    if !device.has_planes() {
        return Err("a GPU has no kernels for them yet, --device cpu has");
    }
    if let Some(why) = Planes::refusal(needs) {
        return Err(why);
    }
    Fan::of(all)?;
    let fan = Fan::of(rays)?;
    let corner = |i: u32| dims * DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
    let is_near = (0..8).all(|i| fan.reaches(frame.display_from_volume.transform_point3(corner(i)).z));
    if is_near { Ok(fan) } else { Err("the volume reaches to where all beams cross") }
}
