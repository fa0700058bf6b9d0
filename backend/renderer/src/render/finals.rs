//! The pictures of a frame that have become final, on their way to whoever shows them.

use super::account::milliseconds;
use super::engine::Engine;
use super::work::Work;
use crate::device::{DeviceError, DevicePicture, FinishJob, ShowJob};
use crate::present::Raster;
use protocol::{ProjectorImage, ScreenImage};
use std::time::Instant;

/// One of them.
pub(super) struct Final {
    projector: u32,
    view: usize,
    /// Pixels along x and y.
    size: [u32; 2],
    picture: DevicePicture,
}

impl Engine {
    /// Has the device make what is shown of those of a frame, and hands each over as `take` takes it.
    pub(super) fn hand_over<T>(
        &mut self,
        work: &mut Work,
        sink: &mut dyn FnMut(T),
        take: impl Fn(&mut Self, &Final) -> Result<T, DeviceError>,
    ) -> Result<(), DeviceError> {
        for projector in std::mem::take(&mut work.finals) {
            let started = Instant::now();
            let Some(view) = work.view_of(projector) else { continue };
            let (size, picture) = (work.setting.rays[view].raster, self.show(work, projector, view)?);
            let taken = take(self, &Final { projector, view, size, picture })?;
            work.account.stages.readback_ms += milliseconds(started);
            sink(taken);
        }
        Ok(())
    }

    /// What is shown of the picture of a view: it depends on the frames before where there are many.
    fn show(&mut self, work: &Work, projector: u32, view: usize) -> Result<DevicePicture, DeviceError> {
        let picture = work.picture_of(view);
        if !work.is_of_many() {
            return Ok(DevicePicture::Cast(picture));
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
        Ok(DevicePicture::Shown(picture))
    }

    /// Its linear colours.
    pub(super) fn colours(&mut self, of: &Final) -> Result<ProjectorImage, DeviceError> {
        let &Final { projector, size: [width, height], picture, .. } = of;
        let rgba = self.device.picture(picture)?.into_owned();
        Ok(ProjectorImage { projector, width, height, rgba })
    }

    /// The codes that its projector shows it with.
    pub(super) fn codes(&mut self, of: &Final) -> Result<ScreenImage, DeviceError> {
        let &Final { projector, view, size: [width, height], picture } = of;
        let (raster, finisher) = (Raster::of([width, height]), &self.finishers[view]);
        let rgb = self.device.codes(&FinishJob { picture, raster, view, finisher })?;
        Ok(ScreenImage { projector, width, height, rgb })
    }
}
