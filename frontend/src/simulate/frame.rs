//! One frame of a run.

use super::Job;
use super::earlier::frame_folder;
use super::pictures::FramePictures;
use crate::FrontendError;
use crate::report::{CONTACT_SHEET, FrameSummary};
use protocol::{Draw, FrameReport, FrameState, ProjectorImage, RenderEvent};
use renderer::output::OutputError;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Pictures that may wait for a writer: more would only take memory.
const WAITING_PICTURES: usize = 2;
/// The most writers; a renderer on the same machine needs the cores, too.
const MOST_WRITERS: usize = 4;

impl Job {
    /// Draws a frame into its folder and returns its account; None is before the first. `show` gets the part that is done, 0
    /// to 1.
    pub(super) fn draw(
        &self,
        source: &mut dyn Draw,
        frame: &FrameState,
        before: Option<&FrameState>,
        show: &mut dyn FnMut(f64),
    ) -> Result<FrameSummary, FrontendError> {
        let started = Instant::now();
        let folder = PathBuf::from(frame_folder(frame.index));
        let path = self.out.join(&folder);
        std::fs::create_dir_all(&path).map_err(|source| OutputError::Write { path: path.clone(), source })?;
        let pictures = FramePictures::new(self, &path);
        let reports = render_and_write(source, frame, &pictures, show)?;
        pictures.finish(frame.index)?;
        self.write_sheets(&pictures, &path, before.is_none())?;
        let name = |name: String| folder.join(name).to_string_lossy().into_owned();
        Ok(FrameSummary::new(
            frame,
            before,
            reports,
            started.elapsed(),
            (0..self.display.projectors.len()).map(|p| name(pictures.projector_file(p, "png"))).collect(),
            (0..self.eyes.len()).map(|eye| name(FramePictures::eye_file(eye, "png"))).collect(),
        ))
    }

    fn write_sheets(
        &self,
        pictures: &FramePictures<'_>,
        folder: &Path,
        is_first: bool,
    ) -> Result<(), OutputError> {
        if is_first {
            pictures.write_sheet(&self.out.join(CONTACT_SHEET))?;
        }
        if self.frames.len() > 1 {
            pictures.write_sheet(&folder.join(CONTACT_SHEET))?;
        }
        Ok(())
    }
}

/// Renders on this thread while others write. After a failed write the frame still ends: back-ends draw whole frames.
fn render_and_write(
    source: &mut dyn Draw,
    frame: &FrameState,
    pictures: &FramePictures<'_>,
    show: &mut dyn FnMut(f64),
) -> Result<Vec<FrameReport>, FrontendError> {
    let (send, receive) = sync_channel::<ProjectorImage>(WAITING_PICTURES);
    let receive = Mutex::new(receive);
    let writers = std::thread::available_parallelism().map_or(1, usize::from).min(MOST_WRITERS);
    let reports = std::thread::scope(|scope| {
        for _ in 0..writers {
            scope.spawn(|| write_all(&receive, pictures));
        }
        let reports = source.draw(frame, &mut |event| match event {
            RenderEvent::Progress { done, total } => show(done as f64 / total.max(1) as f64),
            // Sending fails only where all writers are gone: then the picture is missed, and said to be, at the end.
            RenderEvent::Image(image) => drop(send.send(image)),
        });
        drop(send);
        reports
    })?;
    show(1.0);
    Ok(reports)
}

fn write_all(receive: &Mutex<Receiver<ProjectorImage>>, pictures: &FramePictures<'_>) {
    let next = || receive.lock().unwrap_or_else(PoisonError::into_inner).recv();
    while let Ok(image) = next() {
        pictures.take(&image);
    }
}
