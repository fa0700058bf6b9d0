//! The pictures of a frame that have become final, on their way to whoever shows them.

use super::account::milliseconds;
use super::engine::Engine;
use super::refining::Refining;
use super::work::Work;
use crate::device::{Device, DeviceError, DevicePicture, FinishJob, Patch, ShowJob};
use crate::present::{Layers, Raster, resampled};
use planes::RasterWarp;
use protocol::{CodesAt, DeviceCodes, ProjectorImage, ScreenImage, ScreenPicture};
use std::borrow::Cow;
use std::slice::from_ref;
use std::time::Instant;

/// Bytes of colours that are handed over together: those of 17 pictures of 800 × 600 pixels, or of one of 4K.
const MOST_COLOUR_BYTES: usize = 1 << 27;

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

impl Final {
    /// The picture, where the device has it as it is shown.
    fn on_device(&self) -> Option<DevicePicture> {
        match self.picture {
            Shown::Device(picture) => self.warp.is_none().then_some(picture),
            Shown::Filled => None,
        }
    }

    /// Its linear colours from those of the picture, with what is laid over them.
    fn rgba<'a>(&self, picture: Cow<'a, [f32]>, layers: &Layers) -> Cow<'a, [f32]> {
        let mut rgba = picture;
        if let Some(warp) = &self.warp {
            rgba = resampled(&rgba, warp).into();
        }
        for &(pixel, colour) in &self.patch {
            rgba.to_mut()[4 * pixel as usize..][..4].copy_from_slice(&colour);
        }
        if !layers.is_empty() {
            layers.lay_into(rgba.to_mut());
        }
        rgba
    }

    /// Bytes of its colours.
    fn bytes(&self) -> usize {
        4 * size_of::<f32>() * (self.size[0] * self.size[1]) as usize
    }
}

/// The pictures of some.
fn pictures<'a>(
    finals: &[Final],
    device: &'a mut Device,
    refining: &'a Refining,
) -> Result<Vec<Cow<'a, [f32]>>, DeviceError> {
    let on_device = finals.iter().filter_map(|of| match of.picture {
        Shown::Device(picture) => Some(picture),
        Shown::Filled => None,
    });
    let mut on_device = device.pictures(&on_device.collect::<Vec<_>>())?.into_iter();
    let picture = |of: &Final| match of.picture {
        Shown::Device(_) => on_device.next().expect("the device has handed over each"),
        Shown::Filled => refining.shown(of.view).into(),
    };
    Ok(finals.iter().map(picture).collect())
}

impl Engine {
    /// Has the device make what is shown of those of a frame, and hands them over as `give` gives them.
    pub(super) fn hand_over<T>(
        &mut self,
        work: &mut Work,
        sink: &mut dyn FnMut(T),
        give: impl Fn(&mut Self, &Work, &[Final], &mut dyn FnMut(T)) -> Result<(), DeviceError>,
    ) -> Result<(), DeviceError> {
        let projectors = std::mem::take(&mut work.finals);
        if projectors.is_empty() {
            return Ok(());
        }
        let started = Instant::now();
        let of_frame: Vec<(u32, usize)> = projectors
            .into_iter()
            .filter_map(|projector| Some((projector, work.view_of(projector)?)))
            .collect();
        for some in of_frame.chunks(self.device.pictures_at_once()) {
            let finals = self.finals(work, some)?;
            give(self, work, &finals, sink)?;
        }
        work.account.stages.readback_ms += milliseconds(started);
        Ok(())
    }

    /// What is shown of some projectors' views.
    fn finals(&mut self, work: &mut Work, of: &[(u32, usize)]) -> Result<Vec<Final>, DeviceError> {
        let shown = self.show(work, of)?;
        let is_of = |(&(projector, view), (picture, is_as_cast)): (&(u32, usize), (Shown, bool))| {
            let (size, warp) = (work.setting.own_raster(view), work.setting.warp(view).copied());
            let mended = work.mended.as_mut().filter(|_| is_as_cast);
            let patch = mended.map_or_else(Patch::default, |mended| std::mem::take(&mut mended[view]));
            Final { projector, view, size, picture, warp, patch }
        };
        Ok(of.iter().zip(shown).map(is_of).collect())
    }

    /// What is shown of the pictures of some projectors' views: it depends on the frames before where there are many. And whether
    /// that is all as it was cast, where all was.
    fn show(&mut self, work: &Work, of: &[(u32, usize)]) -> Result<Vec<(Shown, bool)>, DeviceError> {
        if work.refined.is_some() {
            return Ok(vec![(Shown::Filled, true); of.len()]);
        }
        if !work.is_of_many() {
            let cast = |&(_, view): &(u32, usize)| DevicePicture::Cast(work.picture_of(view));
            return Ok(of.iter().map(|of| (Shown::Device(cast(of)), true)).collect());
        }
        let (easing, now_s) = (&mut self.easing, self.live.now_s(&work.frame));
        let jobs: Vec<ShowJob> = of
            .iter()
            .map(|&(projector, view)| ShowJob {
                picture: work.picture_of(view),
                raster: Raster::of(work.setting.rays[view].raster),
                known: work.known,
                has_before: easing.has_shown(projector),
                most_change: if work.eases { easing.most_change(projector, now_s) } else { None },
            })
            .collect();
        let behind = self.device.show(&jobs)?;
        for (&(projector, _), &is_behind) in of.iter().zip(&behind) {
            easing.show(projector, now_s, is_behind);
        }
        let shown = |(job, is_behind): (&ShowJob, bool)| {
            (Shown::Device(DevicePicture::Shown(job.picture)), !is_behind)
        };
        Ok(jobs.iter().zip(behind).map(shown).collect())
    }

    /// Hands over linear colours.
    pub(super) fn colours(
        &mut self,
        work: &Work,
        finals: &[Final],
        sink: &mut dyn FnMut(ProjectorImage),
    ) -> Result<(), DeviceError> {
        let layers = self.layers(work, finals.iter().map(|of| of.view))?;
        let largest = finals.iter().map(Final::bytes).max().unwrap_or(1);
        let at_once = (MOST_COLOUR_BYTES / largest.max(1)).max(1);
        for (some, layers) in finals.chunks(at_once).zip(layers.chunks(at_once)) {
            let pictures = pictures(some, &mut self.device, &self.refining)?;
            for ((of, picture), layers) in some.iter().zip(pictures).zip(layers) {
                let &Final { projector, size: [width, height], .. } = of;
                let rgba = of.rgba(picture, layers).into_owned();
                sink(ProjectorImage { projector, width, height, rgba });
            }
        }
        Ok(())
    }

    /// Hands over the codes that projectors show pictures with, where they are wanted.
    pub(super) fn codes(
        &mut self,
        work: &Work,
        finals: &[Final],
        at: CodesAt,
        sink: &mut dyn FnMut(ScreenPicture),
    ) -> Result<(), DeviceError> {
        let layers = self.layers(work, finals.iter().map(|of| of.view))?;
        let finishers = &self.finishers;
        let jobs: Vec<FinishJob> = finals
            .iter()
            .zip(&layers)
            .filter_map(|(of, layers)| {
                let (raster, finisher) = (Raster::of(of.size), &finishers[of.view]);
                Some(FinishJob { picture: of.on_device()?, raster, layers, view: of.view, finisher })
            })
            .collect();
        let mut of_device = self.device.codes(&jobs, at)?.into_iter();
        for (of, layers) in finals.iter().zip(&layers) {
            let codes = match of.on_device().and_then(|_| of_device.next()) {
                Some(codes) => codes,
                None => {
                    let picture = pictures(from_ref(of), &mut self.device, &self.refining)?.remove(0);
                    let codes = finishers[of.view].codes(&of.rgba(picture, layers));
                    self.device.codes_of_host(codes, Raster::of(of.size), at)
                }
            };
            let &Final { projector, size: [width, height], .. } = of;
            if let Some(rgb) = codes.host {
                sink(ScreenPicture::Host(ScreenImage { projector, width, height, rgb }));
            }
            if let Some(codes) = codes.device {
                sink(ScreenPicture::Device(DeviceCodes { projector, codes }));
            }
        }
        Ok(())
    }
}
