//! A run: frames are drawn, their pictures become files, and a report says how it went.

mod earlier;
mod eyes;
mod frame;
mod pictures;

pub use eyes::Eye;
pub(crate) use eyes::EyeViews;

use crate::FrontendError;
use crate::progress::Progress;
use crate::report::{BackendSummary, EyeSummary, FrameSummary, Report, Subject, write_legend};
use crate::scene::{Scene, VolumeFacts};
use display_config::Display;
use earlier::remove_earlier_run;
use optics::DebugView;
use protocol::{Draw, FrameState, Pace};
use renderer::output::can_write_into;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// All that a run needs besides the thing that draws.
pub struct Job {
    /// The scene.
    pub scene: Scene,
    /// What is known of its volume.
    pub facts: VolumeFacts,
    /// The display.
    pub display: Display,
    /// Which frames of the scene. Each is made when it is drawn, since a long run of them takes much memory.
    pub frames: Range<u32>,
    /// Those of them that are not as the scene has them, by their numbers: what visitors made of it.
    pub remade: BTreeMap<u32, FrameState>,
    /// How they get their detail.
    pub pace: Pace,
    /// What they show of the working set instead of the pictures.
    pub debug: Option<DebugView>,
    /// The eyes whose views are wanted.
    pub eyes: Vec<Eye>,
    /// The output folder.
    pub out: PathBuf,
    /// Whether linear OpenEXR pictures are wanted too.
    pub exr: bool,
    /// Whether the codes that projectors are sent are wanted too.
    pub calibrated: bool,
}

impl Job {
    /// Makes the output folder and tries to write in it. Call it before any long work.
    pub fn prepare_output(out: &Path) -> Result<(), FrontendError> {
        Ok(can_write_into(out)?)
    }

    /// Draws all frames. Pictures are written as soon as they are final; after a failure, those written are complete.
    /// Reports and pictures of an earlier run are removed first: they would lie among those of this one.
    pub fn run(
        &self,
        source: &mut dyn Draw,
        progress: &mut Progress,
    ) -> Result<Vec<FrameSummary>, FrontendError> {
        remove_earlier_run(&self.out)?;
        if let Some(view) = self.debug {
            write_legend(view, &self.out)?;
        }
        let (mut summaries, mut before) = (Vec::new(), None);
        for (place, index) in self.frames.clone().enumerate() {
            let mut show = |part: f64| {
                let whole = (place as f64 + part) / self.frames.len() as f64;
                progress.set(whole, &format!("frame {} of {}", place + 1, self.frames.len()));
            };
            let frame = self.frame(index)?;
            summaries.push(self.draw(source, &frame, before.as_ref(), &mut show)?);
            before = Some(frame);
        }
        Ok(summaries)
    }

    fn frame(&self, index: u32) -> Result<FrameState, FrontendError> {
        let frame = match self.remade.get(&index) {
            Some(frame) => frame.clone(),
            None => self.scene.frame(index, &self.display, &self.facts)?,
        };
        Ok(FrameState { pace: self.pace, debug: self.debug, ..frame })
    }

    /// The report of its run.
    pub fn report(
        &self,
        backends: Vec<BackendSummary>,
        frames: Vec<FrameSummary>,
        wall: Duration,
    ) -> Result<Report, FrontendError> {
        let first_frame = &self.frame(self.frames.start)?;
        let subject = Subject { scene: &self.scene, facts: &self.facts, display: &self.display, first_frame };
        Ok(Report::new(&subject, self.eye_summaries(), backends, frames, wall))
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
