//! A frame under work: what it is drawn with, which rays are still to be cast, and what they have found.

use super::RenderError;
use super::account::{Account, milliseconds};
use super::engine::Engine;
use super::setting::Setting;
use crate::device::{CastJob, Device, Gather, Part, Patch, TileGrid, TileList};
use crate::present::{Classes, lattice_of};
use layout::FeedbackEntry;
use needs::Needs;
use protocol::{FrameState, Pace, Refined, Refinement, StopAsked};
use std::ops::Range;
use std::time::Instant;
use twin::Lattice;

/// Rays that are still to be cast.
#[derive(Debug)]
pub(super) struct Pending {
    /// Of these views.
    pub(super) views: Range<usize>,
    /// These pixels.
    pub(super) lattice: Lattice,
    /// Whether to count their samples and to list tiles that missed something.
    pub(super) counts: bool,
    /// Whether they mend what was resampled; the pixels are then those of the projectors' own rasters.
    pub(super) mends: bool,
    /// These tiles of each.
    pub(super) tiles: Vec<TileList>,
}

impl Pending {
    /// None.
    fn none() -> Self {
        Self { views: 0..0, lattice: Lattice::ALL, counts: false, mends: false, tiles: Vec::new() }
    }

    /// All tiles of some views.
    pub(super) fn all(setting: &Setting, views: Range<usize>, lattice: Lattice) -> Self {
        let rasters = setting.rays[views.clone()].iter().map(|rays| rays.raster);
        Self { lattice, counts: true, mends: false, tiles: every_tile(rasters, lattice), views }
    }

    /// Those that mend the pictures of all views.
    fn mending(setting: &Setting) -> Self {
        let (views, lattice) = (0..setting.rays.len(), Lattice::ALL);
        let rasters = views.clone().map(|view| setting.own_raster(view));
        Self { lattice, counts: true, mends: true, tiles: every_tile(rasters, lattice), views }
    }

    /// Whether these only look ahead: nothing is shown of them.
    fn is_look(&self) -> bool {
        !self.counts
    }

    pub(super) fn is_empty(&self) -> bool {
        self.tiles.iter().all(TileList::is_empty)
    }
}

/// All tiles of some rasters, those of each in a list.
fn every_tile(rasters: impl Iterator<Item = [u32; 2]>, lattice: Lattice) -> Vec<TileList> {
    rasters.map(|[width, height]| TileList::all(TileGrid::new(width, height, lattice).count())).collect()
}

/// A frame under work.
#[derive(Debug)]
pub(super) struct Work {
    pub(super) frame: FrameState,
    pub(super) setting: Setting,
    pub(super) account: Account,
    pub(super) pending: Pending,
    /// What the rays of the cast under way found, by places of the index; a live frame leaves it on the device.
    pub(super) found: Vec<FeedbackEntry>,
    /// View by view, the pixels of final pictures that were mended; none before.
    pub(super) mended: Option<Vec<Patch>>,
    /// Tiles of the cast under way of which a ray met a node that is too coarse, view by view.
    pub(super) missing: Vec<TileList>,
    /// Projectors whose pictures are final and have not been presented.
    pub(super) finals: Vec<u32>,
    /// Their pixels that are as rays see them now; the others are to be reconstructed.
    pub(super) known: Classes,
    /// Whether these are shown by and by.
    pub(super) eases: bool,
    /// What rays would see by now, where the frame is compared with that.
    pub(super) newest: Option<FrameState>,
    /// What is known of its pictures, where they are a part of the way to complete ones.
    pub(super) refined: Option<Refined>,
    /// Views of a complete frame that are cast together.
    pub(super) views_at_once: usize,
    /// Whether it only looks at a few pixels, which go to pictures of their own and are not shown: these.
    pub(super) glance: Option<Lattice>,
}

impl Work {
    pub(super) fn new(frame: FrameState, setting: Setting, account: Account, device: &Device) -> Self {
        let views_at_once = match setting.caster.fans {
            Some(_) => setting.rays.len(),
            None => device.views_at_once(&setting.rays),
        };
        Self {
            frame,
            setting,
            account,
            pending: Pending::none(),
            found: Vec::new(),
            mended: None,
            missing: Vec::new(),
            finals: Vec::new(),
            known: Classes::ALL,
            eases: false,
            newest: None,
            refined: None,
            views_at_once,
            glance: None,
        }
    }

    /// Rays that are final, and all rays of the frame.
    pub(super) fn rays(&self) -> (u64, u64) {
        (self.account.done, self.account.total)
    }

    /// The device's picture of a view: those of a complete frame that are cast together follow others in the same pictures,
    /// which have been presented before. A coarse look at views whose pixels are kept goes to others.
    pub(super) fn picture_of(&self, view: usize) -> usize {
        match self.glance {
            Some(_) => self.setting.rays.len() + view,
            None if self.is_of_many() => view,
            None => view % self.views_at_once,
        }
    }

    /// Whether what it shows depends on the frames before, so that each view keeps its picture.
    pub(super) fn is_of_many(&self) -> bool {
        let FrameState { pace, sub_frame, refinement, .. } = &self.frame;
        *pace != Pace::Complete || sub_frame.is_some() || refinement.is_some()
    }

    /// The pixels that it shows as they are cast.
    pub(super) fn lattice(&self) -> Lattice {
        self.glance.unwrap_or_else(|| lattice_of(self.frame.sub_frame, self.setting.caster.fans.is_some()))
    }

    /// The view of a projector.
    pub(super) fn view_of(&self, projector: u32) -> Option<usize> {
        self.setting.projectors.iter().position(|&known| known == projector)
    }

    /// Begins to mend what is resampled of pictures that are completely cast. Whether there is anything to mend that is not yet.
    pub(super) fn begin_mending(&mut self) -> bool {
        let is_whole = match (self.frame.pace, self.frame.refinement) {
            // Of a complete frame every pixel is cast when its picture is begun.
            (Pace::Live { .. }, Some(refinement)) => refinement.to >= Refinement::UNITS,
            _ => self.known == Classes::ALL,
        };
        let is_resampled = self.setting.caster.fans.as_ref().is_some_and(|fans| fans.resampled() > 0);
        let begins = is_whole && is_resampled && self.glance.is_none() && self.mended.is_none();
        if begins {
            self.begin_cast(Pending::mending(&self.setting));
            self.mended = Some(vec![Patch::default(); self.setting.rays.len()]);
        }
        begins
    }

    /// Begins another cast.
    pub(super) fn begin_cast(&mut self, pending: Pending) {
        self.pending = pending;
        self.mended = None;
        self.found.clear();
        self.missing.clear();
    }

    /// Casts what is pending, as far as `stop` allows.
    pub(super) fn cast(&mut self, engine: &mut Engine, stop: StopAsked) -> Result<(), RenderError> {
        let started = Instant::now();
        let Pending { views, lattice, counts, mends, tiles } = &self.pending;
        let rays = if *mends { &self.setting.own_rays } else { &self.setting.rays };
        let outcome = engine.device.cast(&CastJob {
            scene: &self.setting.scene,
            views: &rays[views.clone()],
            mends: *mends,
            first_picture: match self.pending.is_look() && self.is_of_many() {
                true => self.setting.rays.len(),
                false => self.picture_of(views.start),
            },
            sharing: self.setting.caster.sharing(&self.frame),
            needs: Needs { blends: engine.shelf.blends, spreads: engine.shelf.spreads, ..self.setting.needs },
            part: Part::Tiles { lattice: *lattice, tiles },
            gather: if self.frame.pace == Pace::Complete { Gather::Own } else { Gather::Frame },
            counts: *counts,
            stop,
        })?;
        add(&mut self.found, &outcome.feedback);
        for (known, found) in self.mended.iter_mut().flatten().zip(outcome.mended) {
            known.extend(found);
        }
        self.account.rays += outcome.rays;
        self.account.samples += outcome.samples;
        self.account.cut += outcome.cut;
        self.missing.resize(self.pending.tiles.len(), TileList::default());
        for (known, found) in self.missing.iter_mut().zip(outcome.missing_tiles) {
            known.extend(found.iter());
        }
        self.pending.tiles = outcome.left;
        self.account.stages.cast_ms += milliseconds(started);
        Ok(())
    }
}

/// Adds what more rays found: the largest deficit, and all rays.
fn add(known: &mut Vec<FeedbackEntry>, found: &[FeedbackEntry]) {
    known.resize(known.len().max(found.len()), FeedbackEntry::default());
    for (known, found) in known.iter_mut().zip(found) {
        known.deficit_code = known.deficit_code.max(found.deficit_code);
        known.rays += found.rays;
    }
}
