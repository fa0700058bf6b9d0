//! A run: frames are drawn, their pictures become files, and a report says how it went.

mod eyes;
mod frame;
mod pictures;

pub use eyes::Eye;
pub(crate) use eyes::EyeViews;

use crate::FrontendError;
use crate::progress::Progress;
use crate::report::{self, BackendSummary, EyeSummary, FrameSummary, Report, Subject, write_legend};
use crate::scene::{Scene, VolumeFacts};
use display_config::Display;
use optics::DebugView;
use protocol::{Draw, FrameState};
use renderer::output::{OutputError, can_write_into};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// All that a run needs besides the thing that draws.
pub struct Job {
    /// The display.
    pub display: Display,
    /// The frames, in order.
    pub frames: Vec<FrameState>,
    /// The eyes whose views are wanted.
    pub eyes: Vec<Eye>,
    /// The output folder.
    pub out: PathBuf,
    /// Whether linear OpenEXR pictures are wanted too.
    pub exr: bool,
}

impl Job {
    /// Makes the output folder and tries to write in it. Call it before any long work.
    pub fn prepare_output(out: &Path) -> Result<(), FrontendError> {
        Ok(can_write_into(out)?)
    }

    /// Draws all frames. Pictures are written as soon as they are final; after a failure, those written are complete.
    /// Reports of an earlier run are removed first: they would describe other pictures.
    pub fn run(
        &self,
        source: &mut dyn Draw,
        progress: &mut Progress,
    ) -> Result<Vec<FrameSummary>, FrontendError> {
        self.forget_earlier_run()?;
        if let Some(view) = self.debug_view() {
            write_legend(view, &self.out)?;
        }
        let mut summaries = Vec::with_capacity(self.frames.len());
        for (place, frame) in self.frames.iter().enumerate() {
            let mut show = |part: f64| {
                let whole = (place as f64 + part) / self.frames.len() as f64;
                progress.set(whole, &format!("frame {} of {}", place + 1, self.frames.len()));
            };
            summaries.push(self.draw(source, frame, place == 0, &mut show)?);
        }
        Ok(summaries)
    }

    /// What is shown in place of the pictures, the same in all frames.
    fn debug_view(&self) -> Option<DebugView> {
        self.frames.first()?.debug
    }

    fn forget_earlier_run(&self) -> Result<(), OutputError> {
        for name in report::FILES {
            let path = self.out.join(name);
            match std::fs::remove_file(&path) {
                Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
                    return Err(OutputError::Write { path, source });
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// The report of its run.
    pub fn report(
        &self,
        scene: &Scene,
        facts: &VolumeFacts,
        backends: Vec<BackendSummary>,
        frames: Vec<FrameSummary>,
        wall: Duration,
    ) -> Report {
        let subject = Subject { scene, facts, display: &self.display, first_frame: self.frames.first() };
        Report::new(&subject, self.eye_summaries(), backends, frames, wall)
    }

    /// What the report says of the eyes.
    fn eye_summaries(&self) -> Vec<EyeSummary> {
        let summary = |eye: &Eye| EyeSummary {
            position_m: eye.position_m.to_array(),
            projectors_seen: eye.plan.projectors_seen(),
            warning: eye.warning.clone(),
        };
        self.eyes.iter().map(summary).collect()
    }
}

#[cfg(test)]
mod tests;
