//! The CPU device: the kernels' f32 twin on all cores.

use super::mend::mend;
use super::rows::cast_rows;
use super::tiles::{TileFound, cast_tiles};
use super::under_way::UnderWay;
use super::{
    CastJob, CastOutcome, Codes, DeviceError, DevicePicture, FeedbackTag, FinishJob, Gather, ShortJob,
    ShortView, ShowJob, TaggedFeedback,
};
use crate::present::{Raster, Show, Thresholds};
use bricks::BRICK_VOXELS;
use layout::{NodeRecord, SHORT_RAYS};
use needs::Needs;
use needs::tables::Tables;
use protocol::CodesAt;
use rayon::prelude::*;
use std::borrow::Cow;
use twin::{Casting, FeedbackCell, Observer, ProjectorRays, ShortRay, Volume, cast_short};

/// The brick cache in main memory, and the pictures.
#[derive(Debug)]
pub struct CpuDevice {
    held: Held,
    tables: Tables,
    /// The colours of each picture.
    pictures: Vec<Vec<f32>>,
    /// What is shown of each.
    shown: Vec<Vec<f32>>,
    /// What the casts of this frame have told.
    frame_feedback: Vec<FeedbackCell>,
    /// The tables of earlier frames, which are there at once.
    tables_of_frames: UnderWay<TaggedFeedback>,
}

/// What rays sample.
#[derive(Debug)]
struct Held {
    atlas: Vec<u16>,
    /// Empty where bricks have none.
    deviations: Vec<u8>,
    nodes: Vec<NodeRecord>,
    cells: Vec<u32>,
}

impl Held {
    fn volume(&self) -> Volume<'_> {
        let Self { nodes, cells, atlas, deviations } = self;
        Volume { nodes, cells, atlas, deviations }
    }
}

impl CpuDevice {
    /// A device with room for `slots` bricks, and for their standard deviations if they have any.
    pub fn new(slots: u32, has_deviations: bool) -> Self {
        let held = Held {
            atlas: vec![0; slots as usize * BRICK_VOXELS],
            deviations: vec![0; if has_deviations { slots as usize * BRICK_VOXELS } else { 0 }],
            nodes: Vec::new(),
            cells: Vec::new(),
        };
        Self {
            held,
            tables: Tables::default(),
            pictures: Vec::new(),
            shown: Vec::new(),
            frame_feedback: Vec::new(),
            tables_of_frames: UnderWay::default(),
        }
    }

    pub(super) fn slots(&self) -> u32 {
        (self.held.atlas.len() / BRICK_VOXELS) as u32
    }

    #[expect(clippy::unused_self, reason = "as other devices have it")]
    pub(super) fn refuses_planes(&self, _needs: &Needs) -> Option<&'static str> {
        None
    }

    pub(super) fn write_brick(&mut self, slot: u32, samples: &[u16]) {
        let start = slot as usize * BRICK_VOXELS;
        self.held.atlas[start..start + BRICK_VOXELS].copy_from_slice(samples);
    }

    pub(super) fn write_deviations(&mut self, slot: u32, codes: &[u8]) {
        let start = slot as usize * BRICK_VOXELS;
        self.held.deviations[start..start + BRICK_VOXELS].copy_from_slice(codes);
    }

    pub(super) fn write_index(&mut self, nodes: &[NodeRecord], cells: &[u32]) {
        self.held.nodes = nodes.to_vec();
        self.held.cells = cells.to_vec();
        // What was gathered says nothing of another index.
        self.clear_feedback();
    }

    pub(super) fn write_tables(&mut self, tables: Tables) {
        self.tables = tables;
    }

    /// One view after the other: every core casts each of them.
    #[expect(clippy::unused_self, reason = "as other devices have it")]
    pub(super) fn views_at_once(&self, _views: &[ProjectorRays<f32>]) -> usize {
        1
    }

    pub(super) fn cast(&mut self, job: &CastJob) -> Result<CastOutcome, DeviceError> {
        let own = match job.gather {
            Gather::Own => no_feedback(&self.held.nodes),
            Gather::Frame => Vec::new(),
        };
        let casting = Casting {
            scene: job.scene,
            volume: self.held.volume(),
            tables: &self.tables,
            needs: &job.needs,
            observer: Observer {
                feedback: if job.gather == Gather::Own { &own } else { &self.frame_feedback },
            },
        };
        if let Some(sharing) = job.sharing.filter(|_| job.mends) {
            let outcome = mend(&casting, job, sharing.fans, &self.pictures[job.first_picture..]);
            return Ok(CastOutcome { feedback: own.iter().map(FeedbackCell::entry).collect(), ..outcome });
        }
        self.pictures.resize_with(self.pictures.len().max(job.first_picture + job.views.len()), Vec::new);
        if let Some(sharing) = job.sharing.filter(|_| job.lattice().step[0] == 1) {
            let pictures = &mut self.pictures[job.first_picture..][..job.views.len()];
            let outcome = cast_rows(&casting, job, sharing, pictures);
            return Ok(CastOutcome { feedback: own.iter().map(FeedbackCell::entry).collect(), ..outcome });
        }
        let mut outcome = CastOutcome::nothing(job);
        for (index, view) in job.view_jobs() {
            let found = cast_tiles(&casting, &view, job.stop, &mut self.pictures[view.picture]);
            for (tile, found) in view.tiles.iter().zip(found) {
                let Some(TileFound { rays, samples, is_missing }) = found else {
                    outcome.left[index].push(tile);
                    continue;
                };
                outcome.rays += rays;
                if job.counts {
                    outcome.samples += samples;
                    if is_missing {
                        outcome.missing_tiles[index].push(tile);
                    }
                }
            }
        }
        outcome.feedback = own.iter().map(FeedbackCell::entry).collect();
        Ok(outcome)
    }

    pub(super) fn cast_short(&mut self, job: &ShortJob) -> Result<Vec<Vec<[f32; 4]>>, DeviceError> {
        let unread = no_feedback(&self.held.nodes);
        let casting = Casting {
            scene: job.scene,
            volume: self.held.volume(),
            tables: &self.tables,
            needs: &job.needs,
            observer: Observer { feedback: &unread },
        };
        let colours = |view: &ShortView| {
            let cast =
                |short: &[ShortRay]| cast_short(&casting, view.rays, short).into_iter().map(|cast| cast.rgba);
            view.short.par_chunks(SHORT_RAYS as usize).flat_map_iter(cast).collect()
        };
        Ok(job.views.iter().map(colours).collect())
    }

    pub(super) fn clear_feedback(&mut self) {
        self.frame_feedback = no_feedback(&self.held.nodes);
    }

    pub(super) fn end_feedback(&mut self, tag: FeedbackTag) {
        self.tables_of_frames.start((tag, self.frame_feedback.iter().map(FeedbackCell::entry).collect()));
    }

    pub(super) fn take_feedback(&mut self) -> Result<Option<TaggedFeedback>, DeviceError> {
        Ok(self.tables_of_frames.take(|_| true))
    }

    pub(super) fn wait_feedback(&mut self) -> Result<Option<TaggedFeedback>, DeviceError> {
        self.take_feedback()
    }

    pub(super) fn has_feedback_under_way(&self) -> bool {
        !self.tables_of_frames.is_empty()
    }

    pub(super) fn show(&mut self, jobs: &[ShowJob]) -> Result<Vec<bool>, DeviceError> {
        Ok(jobs.iter().map(|job| self.show_one(job)).collect())
    }

    fn show_one(&mut self, job: &ShowJob) -> bool {
        let &ShowJob { picture, raster, known, has_before, most_change } = job;
        self.shown.resize_with(self.shown.len().max(picture + 1), Vec::new);
        let (cast, thresholds) = (&self.pictures[picture], Thresholds::default());
        Show { cast, raster, known, thresholds, most_change }.over(&mut self.shown[picture], has_before)
    }

    pub(super) fn pictures(&self, pictures: &[DevicePicture]) -> Result<Vec<Cow<'_, [f32]>>, DeviceError> {
        Ok(pictures.iter().map(|&picture| self.picture(picture).into()).collect())
    }

    fn picture(&self, picture: DevicePicture) -> &[f32] {
        match picture {
            DevicePicture::Cast(index) => &self.pictures[index],
            DevicePicture::Shown(index) => &self.shown[index],
        }
    }

    #[expect(clippy::unnecessary_wraps, reason = "as other devices have it")]
    pub(super) fn codes(&self, jobs: &[FinishJob], _at: CodesAt) -> Result<Vec<Codes>, DeviceError> {
        Ok(jobs.iter().map(|job| Codes::on_host(self.codes_of(job))).collect())
    }

    #[expect(clippy::unused_self, reason = "as other devices have it")]
    pub(super) fn codes_of_host(&self, codes: Vec<u8>, _raster: Raster, _at: CodesAt) -> Codes {
        Codes::on_host(codes)
    }

    fn codes_of(&self, job: &FinishJob) -> Vec<u8> {
        let mut rgba = Cow::Borrowed(self.picture(job.picture));
        if !job.layers.is_empty() {
            job.layers.lay_into(rgba.to_mut());
        }
        job.finisher.codes(&rgba)
    }
}

/// An empty table for an index.
fn no_feedback(nodes: &[NodeRecord]) -> Vec<FeedbackCell> {
    nodes.iter().map(|_| FeedbackCell::default()).collect()
}
