//! The pictures of a frame that have become final, on their way to whoever shows them.

use super::account::milliseconds;
use super::engine::Engine;
use super::work::Work;
use crate::device::{DeviceError, DevicePicture, FinishJob, Patch, ShowJob};
use crate::present::{Raster, resampled};
use planes::RasterWarp;
use protocol::{ProjectorImage, ScreenImage};
use std::time::Instant;

/// One of them.
pub(super) struct Final {
    projector: u32,
    view: usize,
    /// Pixels along x and y.
    size: [u32; 2],
    picture: Shown,
    /// The way to its raster from the one that was cast; None where that is the same.
    warp: Option<RasterWarp>,
    /// Pixels of its own.
    patch: Patch,
}

/// What is shown of a view.
#[derive(Clone, Copy)]
enum Shown {
    /// A picture that the device has.
    Device(DevicePicture),
    /// One that was filled on the host.
    Filled,
}

impl Engine {
    /// Has the device make what is shown of those of a frame, and hands each over as `take` takes it.
    pub(super) fn hand_over<T>(
        &mut self,
        work: &mut Work,
        sink: &mut dyn FnMut(T),
        take: impl Fn(&mut Self, &Work, &Final) -> Result<T, DeviceError>,
    ) -> Result<(), DeviceError> {
        for projector in std::mem::take(&mut work.finals) {
            let started = Instant::now();
            let Some(view) = work.view_of(projector) else { continue };
            let (size, warp) = (work.setting.own_raster(view), work.setting.warp(view).copied());
            let (picture, is_as_cast) = self.show(work, projector, view)?;
            let mended = work.mended.as_mut().filter(|_| is_as_cast);
            let patch = mended.map_or_else(Patch::default, |mended| std::mem::take(&mut mended[view]));
            let taken = take(self, work, &Final { projector, view, size, picture, warp, patch })?;
            work.account.stages.readback_ms += milliseconds(started);
            sink(taken);
        }
        Ok(())
    }

    /// What is shown of the picture of a view: it depends on the frames before where there are many. And whether that is all as it
    /// was cast, where all was.
    fn show(&mut self, work: &Work, projector: u32, view: usize) -> Result<(Shown, bool), DeviceError> {
        let picture = work.picture_of(view);
        if work.refined.is_some() {
            return Ok((Shown::Filled, true));
        }
        if !work.is_of_many() {
            return Ok((Shown::Device(DevicePicture::Cast(picture)), true));
        }
        let (easing, now_s) = (&mut self.easing, self.live.now_s(&work.frame));
        let is_behind = self.device.show(&ShowJob {
            picture,
            raster: Raster::of(work.setting.rays[view].raster),
            known: work.known,
            has_before: easing.has_shown(projector),
            most_change: if work.eases { easing.most_change(projector, now_s) } else { None },
        })?;
        easing.show(projector, now_s, is_behind);
        Ok((Shown::Device(DevicePicture::Shown(picture)), !is_behind))
    }

    /// Its linear colours.
    pub(super) fn colours(&mut self, work: &Work, of: &Final) -> Result<ProjectorImage, DeviceError> {
        let &Final { projector, view, size: [width, height], picture, ref warp, ref patch } = of;
        let shown = match picture {
            Shown::Device(picture) => self.device.picture(picture)?,
            Shown::Filled => self.refining.shown(view).into(),
        };
        let mut rgba = match warp {
            Some(warp) => resampled(&shown, warp),
            None => shown.into_owned(),
        };
        for &(pixel, colour) in patch {
            rgba[4 * pixel as usize..][..4].copy_from_slice(&colour);
        }
        self.layers(work, view)?.lay_into(&mut rgba);
        Ok(ProjectorImage { projector, width, height, rgba })
    }

    /// The codes that its projector shows it with.
    pub(super) fn codes(&mut self, work: &Work, of: &Final) -> Result<ScreenImage, DeviceError> {
        let &Final { projector, view, size: [width, height], picture, ref warp, .. } = of;
        let rgb = match picture {
            Shown::Device(picture) if warp.is_none() => {
                let (raster, layers) = (Raster::of([width, height]), &self.layers(work, view)?);
                let finisher = &self.finishers[view];
                self.device.codes(&FinishJob { picture, raster, layers, view, finisher })?
            }
            Shown::Filled if work.frame.marks.is_empty() && warp.is_none() => {
                self.finishers[view].codes(self.refining.shown(view))
            }
            Shown::Device(_) | Shown::Filled => {
                let rgba = self.colours(work, of)?.rgba;
                self.finishers[view].codes(&rgba)
            }
        };
        Ok(ScreenImage { projector, width, height, rgb })
    }
}
