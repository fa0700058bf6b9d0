//! A live frame: one round that shows what there is, and asks for what later frames will show.

use super::RenderError;
use super::account::milliseconds;
use super::engine::Engine;
use super::feedback::{both, feedback_of, keys_of};
use super::live_memory::{Live, as_seen};
use super::rules::FrameRules;
use super::stock::{Clerk, Delivery};
use super::work::{Pending, Work};
use crate::device::FeedbackTag;
use crate::present::Classes;
use crate::working_set::{Feedback, Moment, Shortfall, Showing, most_in_flight};
use bricks::NodeKey;
use layout::FeedbackEntry;
use protocol::{FrameReport, FrameState, Refinement, Upkeep};
use std::collections::VecDeque;
use std::time::Instant;

/// A live frame under work.
#[derive(Debug)]
pub(super) struct LiveFrame {
    /// Bytes of bricks that it may move to the device.
    upload_bytes: u64,
    /// Time of a fade, seconds.
    fade_s: f64,
    upkeep: Option<Upkeep>,
    /// Whether it shows what the one before showed.
    is_still: bool,
    /// Casts that follow.
    casts: VecDeque<Pending>,
    /// Whether all is cast: what is shown of it is made and brought back before the report, which says how long it took.
    has_ended: bool,
}

impl LiveFrame {
    pub(super) fn new(upload_bytes: u64, fade_s: f64) -> Self {
        Self { upload_bytes, fade_s, upkeep: None, is_still: false, casts: VecDeque::new(), has_ended: false }
    }

    /// What comes when all that was pending has been cast: first the working set, then what is shown, then the report.
    pub(super) fn next(
        &mut self,
        work: &mut Work,
        engine: &mut Engine,
    ) -> Result<Option<FrameReport>, RenderError> {
        if let Some(upkeep) = self.upkeep {
            if let Some(pending) = self.casts.pop_front() {
                work.begin_cast(pending);
                return Ok(None);
            }
            if work.begin_mending() {
                return Ok(None);
            }
            if !std::mem::replace(&mut self.has_ended, true) {
                self.end(work, engine)?;
                return Ok(None);
            }
            return Ok(Some(self.report(work, engine, upkeep)));
        }
        engine.take_feedback()?;
        if let Some(refinement) = work.frame.refinement {
            self.refine(work, engine, refinement)?;
        } else {
            self.is_still = engine.live.enter(&work.frame);
            self.upkeep = Some(self.keep_up(work, engine)?);
            let lattice = work.lattice();
            work.known = engine.known.begin(&work.frame, !engine.shelf.has_changed, &lattice);
            self.casts.push_back(Pending::all(&work.setting, 0..work.setting.rays.len(), lattice));
        }
        engine.recording.begin()?;
        engine.device.clear_feedback();
        Ok(None)
    }

    /// Begins a part of the way to a picture. The working set is kept up where the picture begins, and stays as it is until
    /// that is complete or given up.
    fn refine(
        &mut self,
        work: &mut Work,
        engine: &mut Engine,
        refinement: Refinement,
    ) -> Result<(), RenderError> {
        let from = engine.refining.begin(refinement);
        self.upkeep = Some(if from > 0 {
            engine.restore(work)?;
            engine.upkeep()
        } else {
            engine.easing.forget();
            engine.known.forget();
            self.is_still = engine.live.enter(&work.frame);
            let upkeep = self.keep_up(work, engine)?;
            let Upkeep { in_flight, fading, .. } = upkeep;
            let has_more = in_flight > 0 || fading > 0 || engine.shelf.has_changed;
            engine.refining.is_stalled = self.is_still && !has_more;
            upkeep
        });
        if refinement.to < Refinement::UNITS {
            work.known = Classes::default();
        }
        self.casts = engine.casts_of(&work.setting, &(from..refinement.to)).into();
        Ok(())
    }

    /// Brings the working set up to the frame's time: what rays met, what to fetch, what has come, what is shown.
    fn keep_up(&self, work: &mut Work, engine: &mut Engine) -> Result<Upkeep, RenderError> {
        let Self { upload_bytes, fade_s, is_still, .. } = *self;
        let fade_s = if work.frame.quality.blended { fade_s } else { 0.0 };
        let before = engine.live.before(&engine.options.display);
        let Engine { set, stock, shelf, device, live, .. } = engine;
        stock.damage.start_frame();
        let rules = work.setting.rules(&work.frame);
        let (shape, source) = (stock.shape, std::sync::Arc::clone(&stock.source));
        let summary = |key| source.summary(key);
        let moment = Moment {
            rules: rules.for_index(&shape, shelf.blank_slot()),
            summary: &summary,
            now_s: live.now_s(&work.frame),
            is_still,
            // What is a part of the way to a picture is not eased, and so does not hurry.
            fade_s: Moment::fade_of(fade_s, is_still && work.frame.refinement.is_none()),
            most_in_flight: most_in_flight(upload_bytes),
        };
        let refined_before = work.account.stages.refine_ms;
        shelf.refresh_cells(set.cut(), &rules);
        let started = Instant::now();
        let mut clerk = Clerk::new(stock, shelf, device, &rules, Delivery::AsItComes { upload_bytes });
        set.step(&moment, &live.met, Showing::InTime { before }, &mut clerk);
        let cancelled = clerk.cancelled;
        clerk.settle_up(&mut work.account, milliseconds(started))?;
        let blends = rules.blends || (work.frame.quality.blended && set.blends());
        let stages = &mut work.account.stages;
        shelf.write_live(set, &moment, &FrameRules { blends, ..rules }, device, stages);
        let update_ms = stages.refine_ms - refined_before;
        Ok(Upkeep { cancelled, update_ms, ..engine.upkeep() })
    }

    fn end(&self, work: &mut Work, engine: &mut Engine) -> Result<(), RenderError> {
        let time_s = engine.live.now_s(&work.frame);
        let frame = Some(Box::new(FrameState { time_s, ..work.frame.clone() }));
        let configuration = work.frame.refinement.map(|refinement| refinement.configuration);
        engine.device.end_feedback(FeedbackTag { keys: keys_of(engine.set.cut()), frame, configuration });
        if configuration.is_some() {
            // Of most devices it is there already.
            engine.take_feedback()?;
            engine.refine(work)?;
        } else {
            engine.known.end(work.known);
        }
        work.account.done = work.account.total;
        work.finals.extend(&work.setting.projectors);
        work.eases = self.is_still && self.fade_s > 0.0 && work.frame.quality.blended;
        engine.live.last = Some(as_seen(&work.frame));
        Ok(())
    }

    fn report(&self, work: &mut Work, engine: &mut Engine, upkeep: Upkeep) -> FrameReport {
        let Engine { stock, live, set, .. } = &mut *engine;
        let is_short = |met: &&Feedback| met.deficit > 0.0;
        for met in live.met.iter().filter(is_short) {
            let family: Vec<NodeKey> = (0..8).map(|octant| met.key.child(octant)).collect();
            stock.damage.note_missed(&family);
        }
        if set.cut().lacks(0) {
            stock.damage.note_missed(&[NodeKey::ROOT]);
        }
        let short = live.met.iter().filter(is_short).count();
        let sampled = live.met.len() as u64;
        let is_known = self.is_still && live.is_fresh && !engine.shelf.has_changed;
        let is_known = match work.frame.refinement {
            Some(refinement) => engine.live.met_of == Some(refinement.configuration),
            None => is_known,
        };
        let shortfall = engine.live_shortfall(short, is_known, &upkeep);
        if let Some(refined) = &mut work.refined {
            let is_under_way = upkeep.in_flight > 0 || upkeep.fading > 0;
            refined.has_detail = is_under_way || (shortfall.is_some() && !engine.refining.is_stalled);
        }
        let bricks_wanted = engine.set.slots().used() + upkeep.in_flight;
        let report = engine.frame_report(work, shortfall, Some(upkeep));
        FrameReport { bricks_wanted, working_set_union: sampled, ..report }
    }
}

impl Engine {
    /// Takes in what rays found whose tables have arrived; waits for none.
    fn take_feedback(&mut self) -> Result<(), RenderError> {
        while let Some((tag, table)) = self.device.take_feedback()? {
            self.learn(&tag, &table)?;
        }
        self.live.is_fresh = self.live.last.is_some() && !self.device.has_feedback_under_way();
        Ok(())
    }

    /// Waits for what rays of the latest frames found: none will follow.
    pub(super) fn take_last_feedback(&mut self) -> Result<(), RenderError> {
        while let Some((tag, table)) = self.device.wait_feedback()? {
            self.learn(&tag, &table)?;
        }
        Ok(())
    }

    fn learn(&mut self, tag: &FeedbackTag, table: &[FeedbackEntry]) -> Result<(), RenderError> {
        let met = feedback_of(&tag.keys, table);
        let is_more = tag.configuration.is_some() && self.live.met_of == tag.configuration;
        self.live.met = if is_more { both(&self.live.met, met) } else { met };
        self.live.met_of = tag.configuration;
        let sampled = self.live.met.iter().map(|met| (met.key, met.rays));
        tag.frame.as_ref().map_or(Ok(()), |frame| self.recording.add(frame, sampled))
    }

    /// A complete frame follows live ones: what is on its way to these is taken in, and they begin anew. The cache stays.
    pub(super) fn leave_live(&mut self) -> Result<(), RenderError> {
        self.take_last_feedback()?;
        self.stock.loader.want(&[], &[]);
        self.live = Live { ahead_s: self.live.ahead_s, ..Live::default() };
        Ok(())
    }

    pub(super) fn upkeep(&self) -> Upkeep {
        let set = &self.set;
        let short = Shortfall::of(self.live.met.iter().map(|met| (met.rays, met.deficit)));
        Upkeep {
            nodes: set.cut().walk().count() as u64,
            leaves: set.cut().shown_leaves().count() as u64,
            splits: set.splits,
            collapses: set.collapses(),
            in_flight: set.reserved() as u64,
            cancelled: 0,
            fading: set.moving,
            largest_deficit: short.map_or(0.0, |short| short.largest),
            mean_deficit: short.map_or(0.0, |short| short.mean),
            update_ms: 0.0,
        }
    }
}
