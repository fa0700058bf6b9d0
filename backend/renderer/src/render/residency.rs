//! The resident bricks: it carries out on the device what the cut asks for.

use super::RenderError;
use super::ancestors::{Ancestor, MOST_ANCESTORS};
use super::damage::Damage;
use super::rules::FrameRules;
use crate::device::Device;
use crate::working_set::{
    LoadedBrick, Loader, ResidentBrick, Wanted, WorkingSet, build_index, refresh, settle, settled_weights,
};
use bricks::is_shown;
use bricks::{BrickError, BrickSource, CellRanges, NodeKey, OctreeShape};
use layout::{CELL_WORDS, FULL_WEIGHTS, NodeRecord};
use protocol::{FrameState, Stages};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use std::time::Instant;

/// The cut, its slots and its loader.
pub(super) struct Residency {
    pub(super) set: WorkingSet,
    pub(super) source: Arc<dyn BrickSource>,
    pub(super) shape: OctreeShape,
    pub(super) loader: Arc<Loader>,
    /// The slot that holds no brick.
    blank_slot: u32,
    /// Of each slot: the ranges of its cells.
    ranges: Vec<Option<CellRanges>>,
    /// Of each slot: the bits of its visible cells in this frame.
    cells: Vec<u32>,
    /// Of each slot: whether its cells are those of a node that blends with its parent.
    has_blended_cells: Vec<bool>,
    /// Whether the device has other cells.
    are_cells_stale: bool,
    /// The index that the device has.
    index: Vec<NodeRecord>,
    /// Whether any node of it blends with its parent.
    pub(super) blends: bool,
    /// Whether that has changed since the device last got it.
    pub(super) has_changed: bool,
    /// Whether the cut differs from the device's index.
    is_index_stale: bool,
    pub(super) damage: Damage,
    /// Bricks asked for in the current frame, resident or not.
    pub(super) wanted: HashSet<NodeKey>,
    pub(super) bricks_loaded: u64,
    pub(super) bytes_loaded: u64,
}

/// What became of what rays found too coarse.
#[derive(Debug, Default)]
pub(super) struct Refined {
    /// Whether anything was tried: another cast may find more, or find what has become free.
    pub(super) has_changed: bool,
    /// Nodes for whose children the cache has no room.
    pub(super) without_room: Vec<NodeKey>,
}

impl Residency {
    pub(super) fn new(source: Arc<dyn BrickSource>, loader: Loader, slots: u32) -> Self {
        let shape = source.shape();
        Self {
            set: WorkingSet::new(source.summary(NodeKey::ROOT), slots - 1),
            source,
            shape,
            loader: Arc::new(loader),
            blank_slot: slots - 1,
            ranges: vec![None; slots as usize],
            // Everything shows in the blank slot, which is never written to.
            cells: vec![u32::MAX; slots as usize * CELL_WORDS],
            has_blended_cells: vec![false; slots as usize],
            are_cells_stale: true,
            index: Vec::new(),
            blends: false,
            has_changed: true,
            is_index_stale: true,
            damage: Damage::default(),
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
        self.set.slots.used()
    }

    /// Starts a frame: counters at zero, and a brick for every node of the cut that this frame's transfer functions
    /// show and an earlier frame's did not.
    ///
    /// # Errors
    /// The root's brick cannot be read: then there is nothing to draw any node from.
    pub(super) fn start_frame(
        &mut self,
        frame: &FrameState,
        rules: &FrameRules,
        device: &mut Device,
        stages: &mut Stages,
    ) -> Result<(), RenderError> {
        self.wanted.clear();
        self.damage.start_frame();
        (self.bricks_loaded, self.bytes_loaded) = (0, 0);
        self.forget_hidden(rules);
        let known: Vec<u32> =
            self.newly_visible().into_iter().filter(|&p| self.known_damage(p).is_some()).collect();
        self.give_up(&known)?;
        let mut places = self.newly_visible();
        // Where the cache does not hold them, give up the least recently used detail; the root alone always fits.
        while places.len() > self.set.slots.free() {
            let Some(&oldest) = self.set.cut.collapsible(u64::MAX).first() else { break };
            self.collapse(oldest);
            places = self.newly_visible();
        }
        tracing::debug!(frame = frame.index, bricks = places.len(), "bricks that became visible");
        self.load(&places, rules, device, stages)?;
        self.refresh_cells(rules);
        self.write_index(rules, device, stages);
        Ok(())
    }

    /// Splits what rays found too coarse, as far as the cache goes and bricks can be read. Families that cast
    /// `protect` or a later one used stay.
    ///
    /// # Errors
    /// The loader ended.
    pub(super) fn refine(
        &mut self,
        wanted: &[Wanted],
        protect: u64,
        rules: &FrameRules,
        device: &mut Device,
        stages: &mut Stages,
    ) -> Result<Refined, RenderError> {
        let started = Instant::now();
        let mut to_load = Vec::new();
        let mut families = Vec::new();
        let mut refined = Refined::default();
        for want in wanted {
            let key = self.set.cut.node(want.place).key;
            let visible: Vec<NodeKey> =
                (0..8).map(|o| key.child(o)).filter(|&k| self.is_visible(k, rules)).collect();
            self.wanted.extend(&visible);
            if self.damage.note_missed(&visible) {
                continue;
            }
            if !self.make_room(visible.len() + to_load.len(), protect) {
                refined.without_room.push(key);
                continue;
            }
            let first = self.split(want.place);
            to_load.extend((0..8).filter(|&o| visible.contains(&key.child(o))).map(|o| first + o));
            families.extend(visible);
            refined.has_changed = true;
        }
        stages.refine_ms += milliseconds(started);
        self.load(&to_load, rules, device, stages)?;
        self.damage.note_missed(&families);
        if self.is_index_stale {
            self.write_index(rules, device, stages);
        }
        Ok(refined)
    }

    /// Gives up what this frame does not ask for and would have to load for it to be asked for.
    fn forget_hidden(&mut self, rules: &FrameRules) {
        let order: Vec<u32> = self.set.cut.walk().collect();
        let shape = self.shape;
        let index_rules = rules.for_index(&shape, self.blank_slot);
        refresh(&mut self.set.cut, &index_rules, &order);
        for &place in order.iter().rev() {
            let node = self.set.cut.node(place);
            let is_asked_for = node.is_visible && node.deficit > 0.0;
            let Some(first) = node.first_child.filter(|_| !is_asked_for) else { continue };
            if (first..first + 8).any(|child| self.set.cut.lacks(child)) {
                self.collapse(place);
            }
        }
    }

    /// Nodes of the cut that the frame shows and that have no brick.
    fn newly_visible(&self) -> Vec<u32> {
        self.set.cut.walk().filter(|&place| self.set.cut.lacks(place)).collect()
    }

    /// Recomputes the visible cells of all resident bricks: the transfer functions may have changed.
    pub(super) fn refresh_cells(&mut self, rules: &FrameRules) {
        for place in self.set.cut.walk().collect::<Vec<_>>() {
            self.refresh_cells_of(place, rules, false);
        }
    }

    /// Recomputes the visible cells of one brick, which blends with its parent or does not.
    fn refresh_cells_of(&mut self, place: u32, rules: &FrameRules, blends: bool) {
        let Some(brick) = self.set.cut.node(place).brick else { return };
        let slot = brick.slot as usize;
        let Some(ranges) = &self.ranges[slot] else { return };
        let cells = rules.visible_cells(ranges, brick, &self.ancestors(place, rules, blends));
        let known = &mut self.cells[slot * CELL_WORDS..(slot + 1) * CELL_WORDS];
        self.are_cells_stale |= *known != cells;
        known.copy_from_slice(&cells);
        self.has_blended_cells[slot] = blends;
    }

    /// The bricks above a node that its samples are blended with.
    fn ancestors(&self, place: u32, rules: &FrameRules, blends: bool) -> Vec<Ancestor<'_>> {
        let most = if rules.is_quadrilinear { MOST_ANCESTORS } else { usize::from(blends) };
        let mut found = Vec::new();
        let mut at = self.set.cut.node(place).parent;
        while let Some(above) = at.filter(|_| found.len() < most) {
            let node = self.set.cut.node(above);
            let Some(brick) = node.brick else { break };
            let Some(ranges) = &self.ranges[brick.slot as usize] else { break };
            found.push(Ancestor::new(self.set.cut.node(place).key, node.key, brick, ranges));
            at = node.parent;
        }
        found
    }

    fn is_visible(&self, key: NodeKey, rules: &FrameRules) -> bool {
        self.shape.contains(key) && is_shown(rules.optics, self.source.summary(key))
    }

    fn known_damage(&self, place: u32) -> Option<&BrickError> {
        self.damage.of(self.set.cut.node(place).key)
    }

    /// Frees slots until `needed` are free; returns whether that worked.
    fn make_room(&mut self, needed: usize, protect: u64) -> bool {
        while self.set.slots.free() < needed {
            let Some(&oldest) = self.set.cut.collapsible(protect).first() else { return false };
            self.collapse(oldest);
        }
        true
    }

    fn split(&mut self, place: u32) -> u32 {
        self.is_index_stale = true;
        let (shape, source) = (self.shape, &self.source);
        self.set.cut.split(place, |k| shape.contains(k).then(|| source.summary(k)))
    }

    fn collapse(&mut self, place: u32) {
        self.is_index_stale = true;
        for slot in self.set.cut.collapse_all(place) {
            self.set.slots.give(slot);
        }
    }

    /// Makes the parents of unreadable nodes leaves again: siblings, and what is below them, go. A picture then does
    /// not depend on what earlier frames had loaded, nor on which brick of a family came first.
    ///
    /// # Errors
    /// The root is among them: nothing is coarser.
    fn give_up(&mut self, unreadable: &[u32]) -> Result<(), BrickError> {
        let mut lost_root = Ok(());
        for &place in unreadable {
            let node = self.set.cut.node(place);
            match (node.parent, self.damage.of(node.key)) {
                // An unreadable sibling or uncle may have taken the family away already.
                (Some(parent), _) if self.set.cut.node(parent).first_child.is_none() => {}
                (Some(parent), _) => self.collapse(parent),
                (None, error) => lost_root = error.cloned().map_or(Ok(()), Err),
            }
        }
        lost_root
    }

    /// Fetches the bricks of some places of the cut, coarse ones first, and puts them into the cache; families with a
    /// brick that cannot be read are given up.
    ///
    /// # Errors
    /// The root's brick cannot be read, or the loader ended.
    fn load(
        &mut self,
        wanted: &[u32],
        rules: &FrameRules,
        device: &mut Device,
        stages: &mut Stages,
    ) -> Result<(), BrickError> {
        if wanted.is_empty() {
            return Ok(());
        }
        let started = Instant::now();
        let mut upload_ms = 0.0;
        let keys: Vec<NodeKey> = wanted.iter().map(|&place| self.set.cut.node(place).key).collect();
        let places: HashMap<NodeKey, u32> = keys.iter().copied().zip(wanted.iter().copied()).collect();
        let loader = Arc::clone(&self.loader);
        loader.fetch(&keys, |(key, fetched)| match fetched {
            Ok(brick) => {
                let upload = Instant::now();
                self.put(places[&key], brick, rules, device);
                upload_ms += milliseconds(upload);
            }
            Err(error) => self.damage.learn(key, error),
        })?;
        stages.upload_ms += upload_ms;
        stages.load_ms += milliseconds(started) - upload_ms;
        let unreadable: Vec<u32> =
            wanted.iter().copied().filter(|&place| self.known_damage(place).is_some()).collect();
        self.give_up(&unreadable)
    }

    /// Puts a brick into a free slot.
    fn put(&mut self, place: u32, loaded: LoadedBrick, rules: &FrameRules, device: &mut Device) {
        let slot = self.set.slots.take().expect("room was made before loading");
        let brick = ResidentBrick { slot, low: loaded.low, span: loaded.span };
        self.set.cut.set_brick(place, brick);
        self.fill(place, slot, loaded, rules, device);
    }

    /// Puts a brick into the slot that its node has been given.
    pub(super) fn fill(
        &mut self,
        place: u32,
        slot: u32,
        loaded: LoadedBrick,
        rules: &FrameRules,
        device: &mut Device,
    ) {
        device.write_brick(slot, &loaded.samples);
        self.ranges[slot as usize] = Some(loaded.cells);
        self.refresh_cells_of(place, rules, false);
        self.bricks_loaded += 1;
        self.bytes_loaded += loaded.bytes;
    }

    /// The index of what is resident, as the rule of detail asks for it.
    fn write_index(&mut self, rules: &FrameRules, device: &mut Device, stages: &mut Stages) {
        let started = Instant::now();
        let order: Vec<u32> = self.set.cut.walk().collect();
        let shape = self.shape;
        let index_rules = rules.for_index(&shape, self.blank_slot);
        refresh(&mut self.set.cut, &index_rules, &order);
        settle(&mut self.set.cut);
        let summary = |key| self.source.summary(key);
        let weights =
            if rules.blends { settled_weights(&self.set.cut, &index_rules, &summary) } else { Vec::new() };
        stages.refine_ms += milliseconds(started);
        self.write_shown(&weights, rules, device, stages);
    }

    /// The index of what is shown.
    pub(super) fn write_shown(
        &mut self,
        weights: &[[f32; 8]],
        rules: &FrameRules,
        device: &mut Device,
        stages: &mut Stages,
    ) {
        let started = Instant::now();
        for place in self.set.cut.walk_shown().collect::<Vec<_>>() {
            let Some(brick) = self.set.cut.node(place).brick else { continue };
            let blends = rules.blends && weights[place as usize] != [1.0; 8];
            if self.has_blended_cells[brick.slot as usize] != blends {
                self.refresh_cells_of(place, rules, blends);
            }
        }
        let index = build_index(&self.set.cut, weights, &rules.for_index(&self.shape, self.blank_slot));
        stages.refine_ms += milliseconds(started);
        // Where no leaf has less than all weight, a kernel without blending gives the same bits in half the time.
        self.blends = self.set.cut.walk_shown().any(|place| index[place as usize].weights != FULL_WEIGHTS);
        let started = Instant::now();
        let is_other = bytemuck::cast_slice::<_, u8>(&index) != bytemuck::cast_slice::<_, u8>(&self.index);
        self.has_changed = is_other || self.are_cells_stale;
        if self.has_changed {
            device.write_index(&index, &self.cells);
        }
        (self.index, self.are_cells_stale, self.is_index_stale) = (index, false, false);
        stages.upload_ms += milliseconds(started);
    }
}

pub(super) fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
