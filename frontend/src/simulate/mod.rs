//! A run: frames are drawn, their pictures become files, and a report says how it went.

mod eyes;
mod frame;
mod legend;
mod pictures;
mod source;

pub use eyes::Eye;
pub(crate) use eyes::EyeViews;
pub use legend::{LEGEND, marks, number, shows};
pub use source::{Event, FrameSource};

use crate::FrontendError;
use crate::progress::Progress;
use crate::report::{EyeSummary, FrameSummary};
use display_config::Display;
use optics::DebugView;
use protocol::FrameState;
use renderer::output::{OutputError, can_write_into};
use std::path::{Path, PathBuf};

/// The contact sheet of the first frame, in the output folder.
pub const CONTACT_SHEET: &str = "contact-sheet.png";

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
        source: &mut dyn FrameSource,
        progress: &mut Progress,
    ) -> Result<Vec<FrameSummary>, FrontendError> {
        self.forget_earlier_run()?;
        if let Some(view) = self.debug_view() {
            legend::write(view, &self.out)?;
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

    /// What is shown instead of the pictures, the same in all frames.
    pub fn debug_view(&self) -> Option<DebugView> {
        self.frames.first()?.debug
    }

    fn forget_earlier_run(&self) -> Result<(), OutputError> {
        for name in [CONTACT_SHEET, LEGEND, crate::report::JSON, crate::report::HTML] {
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

    /// What the report says of the eyes.
    pub fn eye_summaries(&self) -> Vec<EyeSummary> {
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
