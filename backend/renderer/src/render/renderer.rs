//! What a renderer is made of, and how a frame goes through it.

use super::RenderError;
use super::account::Account;
use super::course::Course;
use super::engine::Engine;
use super::error::check;
use super::recording::Recording;
use super::setting::Setting;
use super::work::Work;
use crate::device::DevicePicture;
#[cfg(feature = "gpu")]
use crate::device::gpu::Swapchains;
use crate::present::resampled;
use bricks::{BrickSource, NodeKey};
use optics::Enhancer;
use protocol::{
    Advance, CodesAt, DeviceInfo, Draw, DrawError, FrameReport, FrameState, ProjectorImage, Render,
    RenderEvent, RendererOptions, ScreenPicture, StopAsked, VolumeRef,
};
use std::path::PathBuf;
use std::sync::Arc;

/// The renderer of one back-end.
pub struct Renderer {
    pub(super) engine: Engine,
    course: Option<Course>,
    /// The revision of the working set that was told last.
    told: Option<u64>,
}

impl Renderer {
    /// Opens the device; the volume is already open.
    ///
    /// # Errors
    /// There is no such device.
    pub fn new(
        options: &RendererOptions,
        source: Arc<dyn BrickSource>,
    ) -> Result<(Self, DeviceInfo), RenderError> {
        let (engine, info) = Engine::new(options, source)?;
        Ok((Self { engine, course: None, told: None }, info))
    }

    /// The bricks that live frames show, where these may be others than when it was last asked.
    pub fn shown_bricks(&mut self) -> Option<Vec<NodeKey>> {
        let revision = self.engine.set.revision();
        let is_new = self.told.replace(revision) != Some(revision);
        is_new.then(|| self.engine.set.shown_bricks().collect())
    }

    /// It takes the place of one that showed these bricks of its volume: live frames fetch them before rays ask for them.
    pub fn expect(&mut self, bricks: Vec<NodeKey>) {
        self.engine.set.expect(bricks);
    }

    /// From the next live frame on, writes a trace of what rays ask for, under this name once it is complete. Whoever
    /// reads it finds the volume by `volume`.
    pub fn record(&mut self, path: PathBuf, volume: &VolumeRef) {
        let Engine { stock, options, .. } = &self.engine;
        self.engine.recording = Recording::new(path, volume, &stock.shape, &options.display);
    }

    /// Draws one whole frame: until nothing is missing, or with what there is, as its pace says.
    ///
    /// # Errors
    /// The root's brick or the device fails, or the frame does not fit the display.
    pub fn draw(
        &mut self,
        frame: &FrameState,
        sink: &mut dyn FnMut(RenderEvent),
    ) -> Result<FrameReport, RenderError> {
        self.restart(frame)?;
        loop {
            let Advance { done, total, report, .. } = self.advance(&|| false)?;
            self.present(&mut |image| sink(RenderEvent::Image(image)))?;
            sink(RenderEvent::Progress { done, total });
            if let Some(report) = report {
                return Ok(*report);
            }
        }
    }

    /// Begins a frame, and drops what is unfinished of the one before.
    ///
    /// # Errors
    /// The frame does not fit the display, or its numbers are out of bounds; nothing has changed then but that the frame
    /// before is dropped.
    pub fn restart(&mut self, frame: &FrameState) -> Result<(), RenderError> {
        self.course = None;
        check(frame)?;
        let frame = self.in_reach(frame);
        if frame.refinement.is_none() {
            self.engine.refining.forget();
        }
        let setting = Setting::new(&mut self.engine, &frame)?;
        let Engine { tables, device, .. } = &mut self.engine;
        tables.write_if_new(device);
        let account = Account::new(setting.rays());
        self.course = Some(Course::new(Work::new(frame, setting, account, device)));
        Ok(())
    }

    /// What rays would see by now, if that is something else than the frame that was begun, where that is a part of the way to
    /// a picture: the report will say how far it is from that. What cannot be drawn is not compared.
    pub fn compare_with(&mut self, newest: &FrameState) {
        let newest = self.in_reach(newest);
        if let Some(Course { work, .. }) = self.course.as_mut().filter(|_| check(&newest).is_ok()) {
            work.newest = work.frame.refinement.map(|_| newest);
        }
    }

    /// Goes on with the frame until `stop` asks to leave off, a picture has become final, or the frame is done. `stop` is
    /// asked before each tile; on a GPU before each batch of tiles, which takes some tens of milliseconds, on a driver in software up
    /// to two seconds.
    ///
    /// # Errors
    /// The root's brick or the device fails. The frame is dropped.
    pub fn advance(&mut self, stop: StopAsked) -> Result<Advance, RenderError> {
        let Some(mut course) = self.course.take() else { return Ok(Advance::default()) };
        course.go_on(&mut self.engine, stop)?;
        let report = course.report();
        let (done, total) = course.work.rays();
        self.course = Some(course);
        Ok(Advance { done, total, lacking_bricks: self.engine.set.reserved() as u64, report })
    }

    /// The picture of a projector of this frame as it stands now, final or not: what has not been cast is as it was before.
    /// A complete frame keeps the one that it works at. What is resampled is not mended here.
    ///
    /// # Errors
    /// The device stopped answering.
    pub fn picture(&mut self, projector: u32) -> Result<Option<ProjectorImage>, RenderError> {
        let Some(Course { work, .. }) = &self.course else { return Ok(None) };
        let Some(view) = work.view_of(projector) else { return Ok(None) };
        let [width, height] = work.setting.own_raster(view);
        let cast = self.engine.device.picture(DevicePicture::Cast(work.picture_of(view)))?;
        let rgba = match work.setting.warp(view) {
            Some(warp) => resampled(&cast, warp),
            None => cast.into_owned(),
        };
        Ok(Some(ProjectorImage { projector, width, height, rgba }))
    }

    /// Rays of the present frame that have been cast, repeated ones counted again.
    #[cfg(test)]
    pub(super) fn rays_cast(&self) -> u64 {
        self.course.as_ref().map_or(0, |course| course.work.account.rays)
    }

    /// As a device that casts so many views of a complete frame together.
    #[cfg(test)]
    pub(super) fn cast_together(&mut self, views: usize) {
        self.course.iter_mut().for_each(|course| course.work.views_at_once = views);
    }

    /// Hands over the pictures that have become final since it was last called.
    ///
    /// # Errors
    /// The device stopped answering.
    pub fn present(&mut self, sink: &mut dyn FnMut(ProjectorImage)) -> Result<(), RenderError> {
        let Some(Course { work, .. }) = &mut self.course else { return Ok(()) };
        Ok(self.engine.hand_over(work, sink, Engine::colours)?)
    }

    /// The same, as screens show them: each picture once for each place where its codes are wanted.
    ///
    /// # Errors
    /// The device stopped answering.
    pub fn present_on_screens(
        &mut self,
        at: CodesAt,
        sink: &mut dyn FnMut(ScreenPicture),
    ) -> Result<(), RenderError> {
        let Some(Course { work, .. }) = &mut self.course else { return Ok(()) };
        Ok(self
            .engine
            .hand_over(work, sink, |engine, work, finals, sink| engine.codes(work, finals, at, sink))?)
    }

    /// What makes swapchains that show codes which stay on its device; None where it is no GPU.
    #[cfg(feature = "gpu")]
    pub fn swapchains(&self) -> Option<Swapchains> {
        self.engine.device.swapchains()
    }

    /// No frame follows: completes the trace, where one is wanted.
    ///
    /// # Errors
    /// The device fails, or the trace cannot be written.
    pub fn finish(&mut self) -> Result<(), RenderError> {
        self.course = None;
        self.engine.take_last_feedback()?;
        self.engine.recording.finish()
    }

    /// The frame without enhancers that the volume is out of reach of: tools cost nothing while nobody holds them to the
    /// volume.
    fn in_reach(&self, frame: &FrameState) -> FrameState {
        let corners = self.engine.stock.shape.corners(NodeKey::ROOT);
        let corners = corners.map(|corner| frame.display_from_volume.transform_point3(corner));
        let mut frame = frame.clone();
        frame.optics.enhancers.retain(|enhancer: &Enhancer| enhancer.may_act_within(&corners));
        frame
    }
}

impl Render for Renderer {
    fn restart(&mut self, frame: &FrameState) -> Result<(), DrawError> {
        Ok(Self::restart(self, frame)?)
    }

    fn compare_with(&mut self, newest: &FrameState) {
        Self::compare_with(self, newest);
    }

    fn advance(&mut self, stop: StopAsked) -> Result<Advance, DrawError> {
        Ok(Self::advance(self, stop)?)
    }

    fn present(&mut self, sink: &mut dyn FnMut(ProjectorImage)) -> Result<(), DrawError> {
        Ok(Self::present(self, sink)?)
    }

    fn present_on_screens(
        &mut self,
        at: CodesAt,
        sink: &mut dyn FnMut(ScreenPicture),
    ) -> Result<(), DrawError> {
        Ok(Self::present_on_screens(self, at, sink)?)
    }

    fn finish(&mut self) -> Result<(), DrawError> {
        Ok(Self::finish(self)?)
    }
}

impl Draw for Renderer {
    fn draw(
        &mut self,
        frame: &FrameState,
        sink: &mut dyn FnMut(RenderEvent),
    ) -> Result<Vec<FrameReport>, DrawError> {
        Ok(vec![Self::draw(self, frame, sink)?])
    }

    fn finish(&mut self) -> Result<(), DrawError> {
        Ok(Self::finish(self)?)
    }
}
