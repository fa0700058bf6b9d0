//! One live frame: it shows what there is, and asks for what later frames will show.

use super::frame::Setting;
use super::residency::milliseconds;
use super::rules::FrameRules;
use super::{RenderError, Renderer};
use crate::device::{CastJob, Gather, MOST_UNDER_WAY, Part};
use crate::working_set::{Arrival, LoadedBrick, Met, Moment, Shortfall, corner_weights, most_in_flight};
use bricks::LodRule;
use bricks::{BrickError, BrickErrorKind, NodeKey};
use layout::{FeedbackEntry, deficit_from_code};
use protocol::RenderEvent;
use protocol::{FrameReport, FrameState, ProjectorImage, Stages, Upkeep};
use shaders::compose::Needs;
use std::collections::VecDeque;
use std::time::Instant;

/// What a live frame may take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Bytes of bricks that it may move to the device.
    pub(super) upload_bytes: u64,
    /// Time of a whole fade, seconds.
    pub(super) fade_s: f64,
}

/// A live frame among others.
#[derive(Clone, Copy)]
struct Present<'a> {
    frame: &'a FrameState,
    limits: Limits,
    /// Whether it shows what the one before showed.
    is_still: bool,
}

/// What casting a frame came to.
#[derive(Clone, Copy, Default)]
struct Casts {
    rays: u64,
    samples: u64,
}

/// What live frames remember of each other.
#[derive(Debug, Default)]
pub(super) struct Live {
    /// The frame before.
    last: Option<FrameState>,
    /// By how much its own clock, which never runs back, is ahead of the frames', seconds.
    ahead_s: f64,
    /// Of each feedback table under way: the nodes of the index that its frame was cast with.
    tables: VecDeque<Vec<NodeKey>>,
    /// What the latest table told.
    met: Vec<Told>,
    /// Whether that was the table of the frame before.
    is_fresh: bool,
}

/// What rays told of a leaf.
#[derive(Clone, Copy, Debug)]
struct Told {
    key: NodeKey,
    rays: u32,
    /// Levels it was too coarse by.
    deficit: f64,
}

pub(super) fn draw(
    renderer: &mut Renderer,
    frame: &FrameState,
    limits: Limits,
    sink: &mut dyn FnMut(RenderEvent),
) -> Result<FrameReport, RenderError> {
    let started = Instant::now();
    let setting = Setting::new(renderer, frame)?;
    let mut live = match renderer.live.take() {
        Some(live) => live,
        None => Live::start(renderer)?,
    };
    let mut stages = Stages::default();
    let upload = Instant::now();
    renderer.device.write_tables(setting.tables.clone());
    stages.upload_ms += milliseconds(upload);
    let mut rules = FrameRules::new(renderer, frame, &setting.tables);
    let present = live.enter(frame, limits);
    let mut upkeep = live.keep_up(renderer, present, &rules, &mut stages)?;
    rules.blends |= frame.quality.blended && renderer.residency.set.blends();
    let weighing = Instant::now();
    let weights = if rules.blends { live_weights(renderer, &rules) } else { Vec::new() };
    stages.refine_ms += milliseconds(weighing);
    upkeep.update_ms = stages.refine_ms;
    renderer.residency.write_shown(&weights, &rules, &mut renderer.device, &mut stages);
    renderer.recording.began(frame, live.now_s(frame))?;
    let casts = live.cast(renderer, &setting, &mut stages, sink)?;
    let report = live.report(renderer, present, upkeep, stages, casts, milliseconds(started));
    live.last = Some(frame.clone());
    renderer.live = Some(live);
    Ok(report)
}

fn live_weights(renderer: &Renderer, rules: &FrameRules) -> Vec<[f32; 8]> {
    let residency = &renderer.residency;
    let index_rules = rules.for_index(&residency.shape, 0);
    let summary = |key| residency.source.summary(key);
    corner_weights(&residency.set.cut, &index_rules, &summary, |key| residency.set.is_lost(key))
}

impl Live {
    /// From the root alone: what complete frames left is no restricted cut, and tables of earlier frames are of no use.
    fn start(renderer: &mut Renderer) -> Result<Self, RenderError> {
        renderer.residency.set.restart();
        renderer.recording.forget();
        while renderer.device.wait_feedback()?.is_some() {}
        Ok(Self::default())
    }

    /// A new frame, whose clock may have run back.
    fn enter<'a>(&mut self, frame: &'a FrameState, limits: Limits) -> Present<'a> {
        let last_s = self.last.as_ref().map_or(0.0, |last| last.time_s);
        self.ahead_s += (last_s - frame.time_s).max(0.0);
        let is_still = self.last.as_ref().is_some_and(|last| is_same_view(last, frame));
        Present { frame, limits, is_still }
    }

    fn now_s(&self, frame: &FrameState) -> f64 {
        frame.time_s + self.ahead_s
    }

    /// Brings the working set up to the frame's time: what rays met, what to fetch, what has come, what is shown.
    fn keep_up(
        &mut self,
        renderer: &mut Renderer,
        Present { frame, limits, is_still }: Present,
        rules: &FrameRules,
        stages: &mut Stages,
    ) -> Result<Upkeep, RenderError> {
        self.take_feedback(renderer)?;
        let residency = &mut renderer.residency;
        (residency.bricks_loaded, residency.bytes_loaded) = (0, 0);
        residency.damage.start_frame();
        if self.last.as_ref().is_none_or(|last| last.optics != frame.optics || last.quality != frame.quality)
        {
            residency.refresh_cells(rules);
        }
        let (shape, source) = (residency.shape, std::sync::Arc::clone(&residency.source));
        let summary = |key| source.summary(key);
        let moment = Moment {
            rules: rules.for_index(&shape, 0),
            summary: &summary,
            now_s: self.now_s(frame),
            is_still,
            fade_s: limits.fade_s,
            most_in_flight: most_in_flight(limits.upload_bytes),
        };
        let started = Instant::now();
        let met: Vec<Met> = self.met.iter().map(|told| Met { key: told.key, rays: told.rays }).collect();
        residency.set.update(&moment, &met);
        stages.refine_ms += milliseconds(started);
        let before = self.last.as_ref().map(|last| {
            (
                LodRule::new(&renderer.display, last.display_from_volume, last.quality.lod_scale),
                self.now_s(last),
            )
        });
        let ahead = residency.set.ahead(&moment, self.met.iter().map(|told| told.key), before);
        let cancelled = residency.loader.want(residency.set.wanted(), &ahead) as u64;
        take_arrived(renderer, rules, limits, stages)?;
        let started = Instant::now();
        let residency = &mut renderer.residency;
        residency.set.show(&moment);
        stages.refine_ms += milliseconds(started);
        Ok(Upkeep { cancelled, ..self.upkeep(renderer) })
    }

    fn take_feedback(&mut self, renderer: &mut Renderer) -> Result<(), RenderError> {
        while let Some(table) = renderer.device.take_feedback()? {
            self.learn(renderer, &table)?;
        }
        self.is_fresh = self.last.is_some() && self.tables.is_empty();
        Ok(())
    }

    /// Waits for what rays of the latest frames told: none will follow.
    pub(super) fn take_last_feedback(&mut self, renderer: &mut Renderer) -> Result<(), RenderError> {
        while let Some(table) = renderer.device.wait_feedback()? {
            self.learn(renderer, &table)?;
        }
        Ok(())
    }

    fn learn(&mut self, renderer: &mut Renderer, table: &[FeedbackEntry]) -> Result<(), RenderError> {
        if let Some(keys) = self.tables.pop_front() {
            let told = |(key, entry): (&NodeKey, &FeedbackEntry)| {
                let deficit = deficit_from_code(entry.deficit_code)?;
                Some(Told { key: *key, rays: entry.rays, deficit: f64::from(deficit) })
            };
            self.met = keys.iter().zip(table).filter_map(told).collect();
            renderer.recording.told(self.met.iter().map(|told| (told.key, told.rays)))?;
        }
        Ok(())
    }

    /// Casts all views on what is shown; rays tell of all of them in one table.
    fn cast(
        &mut self,
        renderer: &mut Renderer,
        setting: &Setting,
        stages: &mut Stages,
        sink: &mut dyn FnMut(RenderEvent),
    ) -> Result<Casts, RenderError> {
        let Renderer { residency, device, .. } = renderer;
        self.tables.push_back(residency.set.cut.nodes().iter().map(|node| node.key).collect());
        let needs = Needs { blends: residency.blends, ..setting.needs };
        let mut casts = Casts::default();
        device.begin_feedback();
        for view in &setting.views {
            let [width, height] = view.rays.raster;
            let job = CastJob {
                scene: &setting.scene,
                views: std::slice::from_ref(&view.rays),
                first_picture: 0,
                needs,
                part: Part::Every { stride: 1 },
                gather: Gather::Frame,
                counts: true,
            };
            let cast = Instant::now();
            let outcome = device.cast(&job)?;
            stages.cast_ms += milliseconds(cast);
            casts.rays += outcome.rays;
            casts.samples += outcome.samples;
            let readback = Instant::now();
            let rgba = device.picture(0)?;
            stages.readback_ms += milliseconds(readback);
            sink(RenderEvent::Image(ProjectorImage { projector: view.projector, width, height, rgba }));
            sink(RenderEvent::Progress { done: casts.rays, total: setting.rays() });
        }
        device.end_feedback();
        // Of more tables the device gives up the oldest.
        while self.tables.len() > MOST_UNDER_WAY {
            self.tables.pop_front();
        }
        Ok(casts)
    }

    fn upkeep(&self, renderer: &Renderer) -> Upkeep {
        let set = &renderer.residency.set;
        let short = Shortfall::of(self.met.iter().map(|told| (told.rays, told.deficit)));
        Upkeep {
            nodes: set.cut.walk().count() as u64,
            leaves: set.cut.shown_leaves().count() as u64,
            splits: set.splits,
            collapses: set.collapses,
            in_flight: set.reserved() as u64,
            cancelled: 0,
            fading: set.moving,
            largest_deficit: short.map_or(0.0, |short| short.largest),
            mean_deficit: short.map_or(0.0, |short| short.mean),
            update_ms: 0.0,
        }
    }

    fn report(
        &self,
        renderer: &mut Renderer,
        Present { frame, is_still, .. }: Present,
        upkeep: Upkeep,
        stages: Stages,
        Casts { rays, samples }: Casts,
        total_ms: f64,
    ) -> FrameReport {
        let residency = &mut renderer.residency;
        let is_short = |told: &&Told| told.deficit > 0.0;
        for told in self.met.iter().filter(is_short) {
            let family: Vec<NodeKey> = (0..8).map(|octant| told.key.child(octant)).collect();
            residency.damage.note_missed(&family);
        }
        if residency.set.cut.lacks(0) {
            residency.damage.note_missed(&[NodeKey::ROOT]);
        }
        let short = self.met.iter().filter(is_short).count();
        let is_told = is_still && self.is_fresh && !residency.has_changed;
        let shortfall = super::frame::live_shortfall(short, is_told, &upkeep, residency);
        FrameReport {
            frame: frame.index,
            backend: renderer.backend,
            projectors: renderer.projectors.clone(),
            rays,
            samples,
            bricks_wanted: residency.resident() + upkeep.in_flight,
            bricks_resident: residency.resident(),
            bricks_loaded: residency.bricks_loaded,
            bytes_loaded: residency.bytes_loaded,
            working_set_union: self.met.len() as u64,
            working_set_sum: self.met.len() as u64,
            complete: shortfall.is_empty(),
            shortfall,
            damaged_bricks: residency.damage.missed(),
            damaged: residency.damage.sentences(super::frame::MOST_DAMAGES),
            upkeep: Some(upkeep),
            stages,
            total_ms,
        }
    }
}

/// Moves what has come to the device, first things first.
fn take_arrived(
    renderer: &mut Renderer,
    rules: &FrameRules,
    limits: Limits,
    stages: &mut Stages,
) -> Result<(), RenderError> {
    let started = Instant::now();
    for (key, fetched) in renderer.residency.loader.arrived(limits.upload_bytes) {
        match fetched {
            Ok(brick) => put(renderer, key, brick, rules),
            Err(error) => note_failure(renderer, key, error)?,
        }
    }
    stages.upload_ms += milliseconds(started);
    Ok(())
}

fn put(renderer: &mut Renderer, key: NodeKey, brick: LoadedBrick, rules: &FrameRules) {
    let Renderer { residency, device, .. } = renderer;
    residency.damage.forget(key);
    if let Arrival::Slot(slot) = residency.set.arrived(key, brick.low, brick.span) {
        let place = residency.set.cut.find(key);
        residency.fill(place, slot, brick, rules, device);
    }
}

/// What is away is asked for again after a while; what is damaged is not.
fn note_failure(renderer: &mut Renderer, key: NodeKey, error: BrickError) -> Result<(), RenderError> {
    let is_damaged = error.kind == BrickErrorKind::Damaged;
    let is_first = renderer.residency.set.failed(key, error.kind);
    if key == NodeKey::ROOT && is_damaged {
        return Err(error.into());
    }
    if is_first {
        renderer.residency.damage.learn(key, error);
    }
    Ok(())
}

/// Whether two frames show the same, whatever the time.
fn is_same_view(a: &FrameState, b: &FrameState) -> bool {
    *a == FrameState { index: a.index, time_s: a.time_s, ..b.clone() }
}
