//! A complete frame: view by view, rounds of casting and loading until nothing is missing.
//!
//! Each view has the cache to itself: what only others saw makes room for it. A coarse look by few rays comes first, and
//! fetches most of what is needed; then every pixel is cast, and again the tiles that missed something. A device that would
//! be idle between views casts some of them together, as long as the cache has room for all that these see: so it shows what
//! each would show alone.

use super::RenderError;
use super::account::milliseconds;
use super::engine::Engine;
use super::feedback::{feedback_of, keys_of};
use super::stock::{Clerk, Delivery};
use super::work::{Pending, Work};
use crate::device::{TileList, coarse};
use crate::working_set::{Feedback, Moment, Showing};
use bricks::NodeKey;
use protocol::{FrameReport, StopAsked};
use std::collections::HashSet;
use std::ops::Range;
use std::time::Instant;

/// The coarse look casts every 16th pixel along x and y.
const COARSE_STRIDE: u32 = 16;

/// And every so many of the views that are cast together.
const LOOKING_VIEWS: usize = 12;

/// Rounds of a view, at most: in each the cut grows by a level, or a family of a full cache makes room for another that is
/// needed more. Only a source whose answers change could take more.
const MOST_ROUNDS: u32 = 256;

/// Steps of a round, at most: a few make room, split and load; a round that cannot come to rest shows what there is.
const MOST_STEPS: u32 = 256;

/// Bricks that may be on their way: there is no limit.
const NO_LIMIT: usize = 1 << 40;

/// Where a view stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Stage {
    /// Nothing of it has been cast.
    #[default]
    Begun,
    /// Few rays are being cast.
    Looking,
    /// All rays are, or those again that missed something.
    Casting,
}

/// How far a complete frame has come.
#[derive(Debug, Default)]
pub(super) struct Complete {
    view: usize,
    stage: Stage,
    rounds: u32,
    /// The nodes that rays of this view sampled, one view's alone.
    sampled: HashSet<NodeKey>,
    /// The nodes that any view sampled, where they are leaves in the end.
    union: HashSet<NodeKey>,
    /// The same of each view, added up.
    sum: u64,
    /// Whether views were cast together, so that nobody knows what each of them sampled.
    has_joined_views: bool,
    /// Nodes that stayed too coarse for want of room, over all views.
    short: HashSet<NodeKey>,
    /// Bricks that would have made them fine enough.
    without_room: HashSet<NodeKey>,
    has_begun: bool,
    /// Whether the working set is not at rest since the last cast.
    is_in_round: bool,
}

impl Complete {
    /// What comes when all that was pending has been cast. The report, once the frame is done.
    pub(super) fn next(
        &mut self,
        work: &mut Work,
        engine: &mut Engine,
        stop: StopAsked,
    ) -> Result<Option<FrameReport>, RenderError> {
        if !std::mem::replace(&mut self.has_begun, true) {
            engine.leave_live()?;
            if work.glance.is_some() {
                // Nothing that is shown changes.
            } else if let Some(refinement) = work.frame.refinement {
                engine.easing.forget();
                engine.known.forget();
                if engine.refining.begin(refinement) > 0 {
                    // All of its pixels were cast when it was begun.
                    self.view = work.setting.rays.len();
                }
            } else if work.frame.sub_frame.is_none() {
                engine.easing.forget();
                engine.known.forget();
            } else {
                let lattice = work.lattice();
                work.known = engine.known.begin(&work.frame, true, &lattice);
            }
            engine.stock.damage.start_frame();
        }
        if self.view == work.setting.rays.len() {
            if work.frame.refinement.is_some() {
                engine.refine(work)?;
                work.finals.extend(&work.setting.projectors);
            } else if work.glance.is_none() {
                engine.known.end(work.known);
            }
            return Ok(Some(self.report(work, engine)));
        }
        let met = if self.is_in_round { Vec::new() } else { self.learn(work, engine) };
        self.is_in_round = true;
        let Some(has_changed) = self.round(work, engine, &met, stop)? else { return Ok(None) };
        self.is_in_round = false;
        match self.stage {
            Stage::Begun => self.cast(work, Stage::Looking, None),
            Stage::Looking if has_changed => self.cast(work, Stage::Looking, None),
            Stage::Looking => self.cast(work, Stage::Casting, None),
            Stage::Casting if has_changed && (work.mended.is_some() || self.hides_something(engine)) => {
                self.cast(work, Stage::Casting, None);
            }
            Stage::Casting if has_changed => {
                let missing = std::mem::take(&mut work.missing);
                self.cast(work, Stage::Casting, Some(missing));
            }
            Stage::Casting if work.begin_mending() => {}
            Stage::Casting => self.end_views(work, engine),
        }
        Ok(None)
    }

    /// What the rays of the cast found; of a view that has just begun, nothing.
    fn learn(&mut self, work: &Work, engine: &mut Engine) -> Vec<Feedback> {
        if self.stage == Stage::Begun {
            engine.set.begin_view(work.frame.time_s);
            return Vec::new();
        }
        let met = feedback_of(&keys_of(engine.set.cut()), &work.found);
        if self.stage == Stage::Casting {
            self.sampled.extend(met.iter().map(|met| met.key));
        }
        met
    }

    /// Steps the working set until it is at rest. Whether rays see anything else then; None where `stop` asked to leave off
    /// before.
    fn round(
        &mut self,
        work: &mut Work,
        engine: &mut Engine,
        met: &[Feedback],
        stop: StopAsked,
    ) -> Result<Option<bool>, RenderError> {
        if self.rounds == MOST_ROUNDS {
            return Ok(Some(false));
        }
        let Engine { set, stock, shelf, device, .. } = engine;
        let rules = work.setting.rules(&work.frame);
        let (shape, source) = (stock.shape, std::sync::Arc::clone(&stock.source));
        let summary = |key| source.summary(key);
        let moment = Moment {
            rules: rules.for_index(&shape, shelf.blank_slot()),
            summary: &summary,
            now_s: work.frame.time_s,
            is_still: true,
            fade_s: 0.0,
            most_in_flight: NO_LIMIT,
        };
        shelf.refresh_cells(set.cut(), &rules);
        let mut met = met;
        for _ in 0..MOST_STEPS {
            let started = Instant::now();
            let mut clerk = Clerk::new(stock, shelf, device, &rules, Delivery::All(stop));
            set.step(&moment, met, Showing::AtOnce, &mut clerk);
            clerk.settle_up(&mut work.account, milliseconds(started))?;
            met = &[];
            if set.is_at_rest() {
                break;
            }
            if stop() {
                return Ok(None);
            }
        }
        stock.check_root(set)?;
        shelf.write_settled(set, &moment, &rules, device, &mut work.account.stages);
        self.rounds += 1;
        Ok(Some(shelf.has_changed))
    }

    /// Casts few rays, all, or some tiles again.
    fn cast(&mut self, work: &mut Work, stage: Stage, tiles: Option<Vec<TileList>>) {
        self.stage = stage;
        let views = self.views(work);
        let lattice = if stage == Stage::Looking { coarse(COARSE_STRIDE) } else { work.lattice() };
        let mut pending = Pending::all(&work.setting, views, lattice);
        if stage == Stage::Looking {
            pending.counts = false;
            // Views that share their rows see much the same.
            pending
                .tiles
                .iter_mut()
                .enumerate()
                .filter(|(i, _)| i % LOOKING_VIEWS != 0)
                .for_each(|(_, t)| t.clear());
        }
        if let Some(tiles) = tiles {
            pending.tiles = tiles;
        }
        work.begin_cast(pending);
    }

    /// Whether a node that rays of this view sampled has made room for others: then any tile may look otherwise.
    fn hides_something(&self, engine: &Engine) -> bool {
        let cut = engine.set.cut();
        self.sampled.iter().any(|&key| cut.node(cut.find_shown(key)).key != key)
    }

    /// The views that are cast together now.
    fn views(&self, work: &Work) -> Range<usize> {
        self.view..work.setting.rays.len().min(self.view + work.views_at_once)
    }

    fn end_views(&mut self, work: &mut Work, engine: &mut Engine) {
        let cut = engine.set.cut();
        let is_leaf = |key: &NodeKey| {
            let node = cut.node(cut.find_shown(*key));
            (node.key == *key && node.shown_child().is_none()).then_some(node)
        };
        let leaves: Vec<_> = self.sampled.iter().filter_map(is_leaf).collect();
        let mut short = Vec::new();
        for node in leaves.iter().filter(|node| node.is_visible && node.deficit > 0.0) {
            let family: Vec<NodeKey> = (0..8).map(|octant| node.key.child(octant)).collect();
            if !engine.stock.damage.note_missed(&family) {
                short.push((node.key, family));
            }
        }
        let views = self.views(work);
        let is_full = !short.is_empty() || self.rounds == MOST_ROUNDS;
        if is_full && views.len() > 1 && work.setting.caster.fans.is_none() {
            // Each may have room enough where all have not: they begin again, one by one.
            work.views_at_once = 1;
            self.begin(views.start);
            return;
        }
        self.has_joined_views |= views.len() > 1;
        self.sum += leaves.len() as u64;
        self.union.extend(leaves.iter().map(|node| node.key));
        for (key, family) in short {
            self.short.insert(key);
            self.without_room.extend(engine.stock.shown(&family, &work.frame.optics));
        }
        for view in views.clone() {
            let [width, height] = work.setting.rays[view].raster;
            work.account.done += u64::from(width) * u64::from(height);
            if work.frame.refinement.is_none() {
                work.finals.push(work.setting.projectors[view]);
            }
        }
        self.begin(views.end);
    }

    /// A view is next.
    fn begin(&mut self, view: usize) {
        self.sampled.clear();
        (self.view, self.stage, self.rounds) = (view, Stage::Begun, 0);
    }

    fn report(&self, work: &Work, engine: &mut Engine) -> FrameReport {
        let full = (!self.short.is_empty()).then(|| {
            format!(
                "the brick cache is full: {} nodes are shown coarser than the display resolves; make the cache larger",
                self.short.len()
            )
        });
        let resident = engine.set.slots().used();
        let report = engine.frame_report(work, full, None);
        FrameReport {
            bricks_wanted: resident + self.without_room.len() as u64,
            working_set_union: self.union.len() as u64,
            working_set_sum: (!self.has_joined_views).then_some(self.sum),
            ..report
        }
    }
}
