//! What casts the rays of a frame.

use super::RenderError;
use crate::device::{Device, Sharing};
use glam::DVec3;
use needs::Needs;
use planes::{Fans, Planes};
use protocol::{Caster, CasterChoice, FrameState};
use twin::ProjectorRays;

/// Where fewer views share planes, sampling them takes about as long as casting the views' rays.
const FEWEST_VIEWS: usize = 24;
/// The least tolerance that planes are made for.
const LEAST_TOLERANCE: f64 = 3e-5;
const TOO_EXACT: &str =
    "the tolerance is below 3e-5, where row planes err by more than it allows or take longer than rays";
const TOO_FEW_VIEWS: &str = "the display has fewer than 24 projectors, too few for row planes to save time";
/// Where planes would need more shared samples than this for each voxel of the volume, rays draw the frame: of the looks of the library
/// on a CT, those with 1.7 and more take rays 1.2 to 2.3 times as long, which err a tenth of what planes do or less.
const MOST_SAMPLES: f64 = 1.0;
const BY_PIXEL: &str = "importance, enhancers, materials, detail and debug views go pixel by pixel through row planes, which saves no time";
const UNTIMED: &str = "on a GPU row planes have not been timed against rays yet";
const TOO_MANY_FANS: &str =
    "the display's projectors differ: fewer than 24 of them share row planes, too few to save time";

/// The caster of a frame, and how its views share planes where that is row planes.
#[derive(Debug)]
pub(super) struct CasterOfFrame {
    pub(super) caster: Caster,
    pub(super) fans: Option<Fans>,
}

impl CasterOfFrame {
    /// For the views of some projectors, of `all`; `closeness` tells how many samples planes take per voxel of the volume. The whole
    /// display and the whole volume decide, so that all back-ends cast alike.
    ///
    /// # Errors
    /// Planes were asked for and cannot serve the frame.
    pub(super) fn choose(
        asked: CasterChoice,
        device: &Device,
        needs: &Needs,
        (projectors, all): (&[u32], &[ProjectorRays<f32>]),
        frame: &FrameState,
        dims: DVec3,
        closeness: impl FnOnce() -> f64,
    ) -> Result<Self, RenderError> {
        let rays = |caster: Caster| Self { caster, fans: None };
        let because = |why: &str| rays(Caster::RaysBecause(why.to_owned()));
        let spares = asked == CasterChoice::Auto && !frame.welcomes_planes;
        if asked == CasterChoice::Rays {
            return Ok(rays(Caster::Rays));
        }
        if asked == CasterChoice::Auto && !device.is_cpu() {
            return Ok(because(UNTIMED));
        }
        if spares && all.len() < FEWEST_VIEWS {
            return Ok(because(TOO_FEW_VIEWS));
        }
        if spares && frame.quality.tolerance < LEAST_TOLERANCE {
            return Ok(because(TOO_EXACT));
        }
        if spares && Planes::refusal(needs).is_none() && needs.is_by_pixel() {
            return Ok(because(BY_PIXEL));
        }
        match (fans_of(device, needs, all, frame, dims), asked) {
            // Each fan takes about as long as so many views ray by ray.
            (Ok(fans), _) if spares && all.len() < FEWEST_VIEWS * fans.count() => Ok(because(TOO_MANY_FANS)),
            (Ok(fans), _) => {
                let samples = if spares { closeness() } else { 0.0 };
                if samples > MOST_SAMPLES {
                    let why = format!(
                        "its surfaces are so steep that row planes would need {samples:.1} shared samples for each voxel of the volume, and err more than rays"
                    );
                    return Ok(because(&why));
                }
                let views: Vec<usize> = projectors.iter().map(|&projector| projector as usize).collect();
                let fans = fans.only(&views);
                let [views, count, resampled] =
                    [views.len(), fans.count(), fans.resampled()].map(|count| count as u32);
                Ok(Self { caster: Caster::Planes { views, fans: count, resampled }, fans: Some(fans) })
            }
            (Err(why), CasterChoice::Planes) => Err(RenderError::Planes(why)),
            (Err(why), _) => Ok(because(why)),
        }
    }

    /// How the views share planes of the frame, where these are cast.
    pub(super) fn sharing<'a>(&'a self, frame: &'a FrameState) -> Option<Sharing<'a>> {
        self.fans.as_ref().map(|fans| Sharing { fans, enhancers: &frame.optics.enhancers })
    }
}

/// How all views share planes; or why these cannot serve the frame.
fn fans_of(
    device: &Device,
    needs: &Needs,
    all: &[ProjectorRays<f32>],
    frame: &FrameState,
    dims: DVec3,
) -> Result<Fans, &'static str> {
    if let Some(why) = Planes::refusal(needs) {
        return Err(why);
    }
    let fans = Fans::of(all)?;
    if let Some(why) = device.refuses_planes(needs) {
        return Err(why);
    }
    let corner = |i: u32| dims * DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
    let is_near = (0..8).all(|i| fans.reaches(frame.display_from_volume.transform_point3(corner(i)).z));
    if is_near { Ok(fans) } else { Err("the volume reaches to where all beams cross") }
}
