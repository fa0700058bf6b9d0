//! The resident bricks: it carries out on the device what the cut asks for.

use super::RenderError;
use crate::device::Device;
use crate::protocol::{FrameState, Stages};
use crate::store::{BrickSource, CellRanges, NodeKey, NodeSummary, OctreeShape};
use crate::working_set::{
    Cut, IndexRules, LoadedBrick, Loader, LodRule, ResidentBrick, SlotPool, Wanted, build_index,
};
use shaders::layout::CELL_WORDS;
use shaders::optics::Optics;
use shaders::tables::Tables;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use std::time::Instant;

/// The cut, its slots and its loader.
pub(super) struct Residency {
    pub(super) cut: Cut,
    source: Arc<dyn BrickSource>,
    shape: OctreeShape,
    slots: SlotPool,
    loader: Loader,
    /// Of each slot: the ranges of its cells.
    ranges: Vec<Option<CellRanges>>,
    /// Of each slot: the bits of its visible cells in this frame.
    cells: Vec<u32>,
    /// Bricks asked for in the current frame, resident or not.
    pub(super) wanted: HashSet<NodeKey>,
    pub(super) bricks_loaded: u64,
    pub(super) bytes_loaded: u64,
}

/// What one frame asks of the cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameRules<'a> {
    pub(super) lod: LodRule,
    pub(super) optics: &'a Optics,
    pub(super) tables: &'a Tables,
    /// Whether steps are short enough for the margin that cells are kept with.
    pub(super) can_pass_over: bool,
}

impl FrameRules<'_> {
    /// The bits of the cells of a brick that show anything.
    fn visible_cells(&self, ranges: &CellRanges, brick: ResidentBrick) -> [u32; CELL_WORDS] {
        let (low, high) = self.optics.domain;
        let scalar =
            |sample: u16| (brick.low + brick.span * f64::from(sample) / 65535.0 - low) / (high - low);
        ranges
            .visible(|least, most| !self.can_pass_over || !self.tables.is_vacant(scalar(least), scalar(most)))
    }
}

impl Residency {
    pub(super) fn new(source: Arc<dyn BrickSource>, loader: Loader, slots: u32) -> Self {
        let shape = source.shape();
        Self {
            cut: Cut::new(source.summary(NodeKey::ROOT)),
            source,
            shape,
            slots: SlotPool::new(slots),
            loader,
            ranges: vec![None; slots as usize],
            cells: vec![0; slots as usize * CELL_WORDS],
            wanted: HashSet::new(),
            bricks_loaded: 0,
            bytes_loaded: 0,
        }
    }

    pub(super) fn shape(&self) -> OctreeShape {
        self.shape
    }

    /// Bricks in the cache.
    pub(super) fn resident(&self) -> u64 {
        self.slots.used()
    }

    fn rules<'a>(&'a self, rules: &'a FrameRules) -> IndexRules<'a> {
        IndexRules { shape: &self.shape, lod: &rules.lod, optics: rules.optics }
    }

    /// Starts a frame: counters at zero, and a brick for every node of the cut that this frame's transfer functions
    /// show and an earlier frame's did not.
    pub(super) fn start_frame(
        &mut self,
        frame: &FrameState,
        rules: &FrameRules,
        device: &mut Device,
        stages: &mut Stages,
    ) -> Result<(), RenderError> {
        self.wanted.clear();
        (self.bricks_loaded, self.bytes_loaded) = (0, 0);
        let newly_visible = |this: &Self| -> Vec<u32> {
            this.cut
                .walk()
                .filter(|&p| {
                    this.cut.node(p).brick.is_none() && !this.rules(rules).is_empty(this.cut.node(p))
                })
                .collect()
        };
        let mut places = newly_visible(self);
        // Where the cache does not hold them, give up the least recently used detail; the root alone always fits.
        while places.len() > self.slots.free() {
            let Some(&oldest) = self.cut.collapsible(u64::MAX).first() else { break };
            self.collapse(oldest);
            places = newly_visible(self);
        }
        tracing::debug!(frame = frame.index, bricks = places.len(), "bricks that became visible");
        self.refresh_cells(rules);
        let keys: Vec<(NodeKey, u32)> = places.iter().map(|&p| (self.cut.node(p).key, p)).collect();
        self.load(&keys, rules, device, stages)?;
        self.write_index(rules, device, stages);
        Ok(())
    }

    /// Splits what rays found too coarse, as far as the cache goes; tells whether anything changed. Families that
    /// cast `protect` or a later one used stay.
    pub(super) fn refine(
        &mut self,
        wanted: &[Wanted],
        protect: u64,
        rules: &FrameRules,
        device: &mut Device,
        stages: &mut Stages,
    ) -> Result<bool, RenderError> {
        let started = Instant::now();
        let mut to_load = Vec::new();
        let mut any = false;
        for want in wanted {
            let key = self.cut.node(want.place).key;
            let visible: Vec<NodeKey> =
                (0..8).map(|o| key.child(o)).filter(|&k| self.is_visible(k, rules)).collect();
            self.wanted.extend(&visible);
            if !self.make_room(visible.len() + to_load.len(), protect) {
                continue;
            }
            let (shape, source) = (self.shape, &self.source);
            let first = self.cut.split(want.place, |k| shape.contains(k).then(|| source.summary(k)));
            to_load.extend((0..8).map(|o| (key.child(o), first + o)).filter(|(k, _)| visible.contains(k)));
            any = true;
        }
        stages.refine_ms += milliseconds(started);
        self.load(&to_load, rules, device, stages)?;
        if any {
            self.write_index(rules, device, stages);
        }
        Ok(any)
    }

    /// Tells the visible cells of all resident bricks anew: the transfer functions may have changed.
    fn refresh_cells(&mut self, rules: &FrameRules) {
        for place in self.cut.walk().collect::<Vec<_>>() {
            let Some(brick) = self.cut.node(place).brick else { continue };
            let Some(ranges) = &self.ranges[brick.slot as usize] else { continue };
            let start = brick.slot as usize * CELL_WORDS;
            self.cells[start..start + CELL_WORDS].copy_from_slice(&rules.visible_cells(ranges, brick));
        }
    }

    fn is_visible(&self, key: NodeKey, rules: &FrameRules) -> bool {
        self.shape.contains(key) && {
            let NodeSummary { min, max } = self.source.summary(key);
            !rules.optics.is_empty_on(f64::from(min), f64::from(max))
        }
    }

    /// Frees slots until `needed` are free; tells whether that worked.
    fn make_room(&mut self, needed: usize, protect: u64) -> bool {
        while self.slots.free() < needed {
            let Some(&oldest) = self.cut.collapsible(protect).first() else { return false };
            self.collapse(oldest);
        }
        true
    }

    fn collapse(&mut self, place: u32) {
        for slot in self.cut.collapse(place) {
            self.slots.give(slot);
        }
    }

    /// Fetches the bricks of some places of the cut and puts them into the cache.
    fn load(
        &mut self,
        wanted: &[(NodeKey, u32)],
        rules: &FrameRules,
        device: &mut Device,
        stages: &mut Stages,
    ) -> Result<(), RenderError> {
        if wanted.is_empty() {
            return Ok(());
        }
        let started = Instant::now();
        let mut upload_ms = 0.0;
        let places: HashMap<NodeKey, u32> = wanted.iter().copied().collect();
        let keys: Vec<NodeKey> = wanted.iter().map(|&(key, _)| key).collect();
        let (cut, slots) = (&mut self.cut, &mut self.slots);
        let (ranges, all_cells) = (&mut self.ranges, &mut self.cells);
        let (bricks_loaded, bytes_loaded) = (&mut self.bricks_loaded, &mut self.bytes_loaded);
        let outcome = self.loader.fetch(&keys, |LoadedBrick { key, samples, cells, low, span, bytes }| {
            let upload = Instant::now();
            let slot = slots.take().expect("room was made before loading");
            device.write_brick(slot, &samples);
            let brick = ResidentBrick { slot, low, span };
            cut.set_brick(places[&key], brick);
            let start = slot as usize * CELL_WORDS;
            all_cells[start..start + CELL_WORDS].copy_from_slice(&rules.visible_cells(&cells, brick));
            ranges[slot as usize] = Some(cells);
            *bricks_loaded += 1;
            *bytes_loaded += bytes;
            upload_ms += milliseconds(upload);
        });
        stages.upload_ms += upload_ms;
        stages.load_ms += milliseconds(started) - upload_ms;
        Ok(outcome?)
    }

    fn write_index(&mut self, rules: &FrameRules, device: &mut Device, stages: &mut Stages) {
        let started = Instant::now();
        let index = build_index(&self.cut, &self.rules(rules));
        stages.refine_ms += milliseconds(started);
        let started = Instant::now();
        device.write_index(&index, &self.cells);
        stages.upload_ms += milliseconds(started);
    }
}

pub(super) fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
