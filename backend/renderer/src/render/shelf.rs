//! What the device has of the resident bricks: their slots and visible cells, and the index that rays traverse.

use super::account::milliseconds;
use super::ancestors::{Ancestor, MOST_ANCESTORS};
use super::brick_ranges::BrickRanges;
use super::rules::FrameRules;
use crate::device::Device;
use crate::working_set::{
    Cut, IndexRules, LoadedBrick, Moment, ResidentBrick, WorkingSet, build_index, corner_weights,
    settled_weights,
};
use bricks::{CellRanges, LodRule};
use layout::{CELL_WORDS, FULL_WEIGHTS, NO_NODE, NodeRecord};
use optics::Optics;
use protocol::Stages;
use std::time::Instant;

/// Slots, cells and index.
pub(super) struct Shelf {
    /// The slot that holds no brick.
    blank_slot: u32,
    /// Of each slot: the ranges of its cells.
    ranges: Vec<Option<CellRanges>>,
    /// Of each slot: the ranges of its deviations around each cell.
    deviation_ranges: Vec<Option<CellRanges>>,
    /// Of each slot: its largest standard deviation, data units; 0 where samples stand for themselves.
    deviations: Vec<f64>,
    /// Of each slot: the bits of its visible cells in this frame.
    cells: Vec<u32>,
    /// Of each slot: whether its cells are those of a node that blends with its parent.
    has_blended_cells: Vec<bool>,
    /// Whether the device has other cells.
    are_cells_stale: bool,
    /// What cells were judged by.
    cells_by: Option<CellRules>,
    /// The index that the device has.
    index: Vec<NodeRecord>,
    /// What it was made from.
    index_by: Option<IndexInputs>,
    /// Whether any node of it blends with its parent.
    pub(super) blends: bool,
    /// Whether samples of any leaf stand for more than themselves.
    pub(super) spreads: bool,
    /// Whether the last write changed what rays meet.
    pub(super) has_changed: bool,
}

/// What decides which cells are visible, the bricks apart.
#[derive(Clone, Debug, PartialEq)]
struct CellRules {
    optics: Optics,
    can_pass_over: bool,
    is_quadrilinear: bool,
    spreads: bool,
}

/// What decides the index.
#[derive(Clone, Debug, PartialEq)]
struct IndexInputs {
    revision: u64,
    lod: LodRule,
    optics: Optics,
    is_quadrilinear: bool,
    blends: bool,
    spreads: bool,
    is_settled: bool,
}

impl Shelf {
    pub(super) fn new(slots: u32) -> Self {
        Self {
            blank_slot: slots - 1,
            ranges: vec![None; slots as usize],
            deviation_ranges: vec![None; slots as usize],
            deviations: vec![0.0; slots as usize],
            // Everything shows in the blank slot, which is never written to.
            cells: vec![u32::MAX; slots as usize * CELL_WORDS],
            has_blended_cells: vec![false; slots as usize],
            are_cells_stale: true,
            cells_by: None,
            index: Vec::new(),
            index_by: None,
            blends: false,
            spreads: false,
            has_changed: true,
        }
    }

    pub(super) fn blank_slot(&self) -> u32 {
        self.blank_slot
    }

    /// Puts a brick into the slot that its node has been given.
    pub(super) fn fill(
        &mut self,
        cut: &Cut,
        place: u32,
        slot: u32,
        loaded: LoadedBrick,
        rules: &FrameRules,
        device: &mut Device,
    ) {
        device.write_brick(slot, &loaded.samples);
        let LoadedBrick { cells, deviation, .. } = loaded;
        let at = slot as usize;
        self.ranges[at] = Some(cells);
        self.deviations[at] = deviation.as_ref().map_or(0.0, |deviation| deviation.largest);
        if let Some(deviation) = &deviation {
            device.write_deviations(slot, &deviation.codes);
        }
        self.deviation_ranges[at] = deviation.map(|deviation| deviation.cells);
        self.refresh_cells_of(cut, place, rules, false);
    }

    /// Judges the cells of all resident bricks anew, where the transfer functions or the filter are others.
    pub(super) fn refresh_cells(&mut self, cut: &Cut, rules: &FrameRules) {
        let by = CellRules {
            optics: rules.optics.clone(),
            can_pass_over: rules.can_pass_over,
            is_quadrilinear: rules.is_quadrilinear,
            spreads: rules.spreads,
        };
        if self.cells_by.as_ref() == Some(&by) {
            return;
        }
        self.cells_by = Some(by);
        for place in cut.walk() {
            self.refresh_cells_of(cut, place, rules, false);
        }
        // Nodes that blend have other cells.
        self.index_by = None;
    }

    /// Judges the cells of one brick, which blends with its parent or does not.
    fn refresh_cells_of(&mut self, cut: &Cut, place: u32, rules: &FrameRules, blends: bool) {
        let Some(brick) = cut.node(place).brick else { return };
        let slot = brick.slot as usize;
        let Some(own) = self.brick_ranges(brick) else { return };
        let cells = rules.visible_cells(&own, &self.ancestors(cut, place, rules, blends));
        let known = &mut self.cells[slot * CELL_WORDS..(slot + 1) * CELL_WORDS];
        self.are_cells_stale |= *known != cells;
        known.copy_from_slice(&cells);
        self.has_blended_cells[slot] = blends;
    }

    /// What is known of the cells of a resident brick.
    fn brick_ranges(&self, brick: ResidentBrick) -> Option<BrickRanges<'_>> {
        let slot = brick.slot as usize;
        let deviations = self.deviation_ranges[slot].as_ref().map(|ranges| (ranges, self.deviations[slot]));
        Some(BrickRanges { brick, samples: self.ranges[slot].as_ref()?, deviations })
    }

    /// The bricks above a node that its samples are blended with.
    fn ancestors(&self, cut: &Cut, place: u32, rules: &FrameRules, blends: bool) -> Vec<Ancestor<'_>> {
        let most = if rules.is_quadrilinear { MOST_ANCESTORS } else { usize::from(blends) };
        let mut found = Vec::new();
        let mut at = cut.node(place).parent;
        while let Some(above) = at.filter(|_| found.len() < most) {
            let node = cut.node(above);
            let Some(brick) = node.brick else { break };
            let Some(ranges) = self.brick_ranges(brick) else { break };
            found.push(Ancestor::new(cut.node(place).key, node.key, ranges));
            at = node.parent;
        }
        found
    }

    /// Writes the index of a working set that shows all at once; nodes blend by the rule of detail alone.
    pub(super) fn write_settled(
        &mut self,
        set: &WorkingSet,
        moment: &Moment,
        rules: &FrameRules,
        device: &mut Device,
        stages: &mut Stages,
    ) {
        let weigh = || settled_weights(set.cut(), &moment.rules, moment.summary);
        self.write(set, moment, rules, true, device, stages, weigh);
    }

    /// Writes the index of a working set that fades.
    pub(super) fn write_live(
        &mut self,
        set: &WorkingSet,
        moment: &Moment,
        rules: &FrameRules,
        device: &mut Device,
        stages: &mut Stages,
    ) {
        let weigh = || corner_weights(set.cut(), &moment.rules, moment.summary, |key| set.is_lost(key));
        self.write(set, moment, rules, false, device, stages, weigh);
    }

    /// Writes the index, where it may be another one than the device has.
    fn write(
        &mut self,
        set: &WorkingSet,
        moment: &Moment,
        rules: &FrameRules,
        is_settled: bool,
        device: &mut Device,
        stages: &mut Stages,
        weigh: impl FnOnce() -> Vec<[f32; 8]>,
    ) {
        let inputs = IndexInputs {
            revision: set.revision(),
            lod: rules.lod,
            optics: rules.optics.clone(),
            is_quadrilinear: rules.is_quadrilinear,
            blends: rules.blends,
            spreads: rules.spreads,
            is_settled,
        };
        // What cannot be read now may be worth another try as time goes on.
        if self.index_by.as_ref() == Some(&inputs) && !self.are_cells_stale && !set.has_failures() {
            self.has_changed = false;
            return;
        }
        self.index_by = Some(inputs);
        let started = Instant::now();
        let weights = if rules.blends { weigh() } else { Vec::new() };
        self.refresh_blended_cells(set.cut(), &weights, rules);
        let deviations = if rules.spreads { &self.deviations[..] } else { &[] };
        let index_rules = IndexRules { deviations, ..rules.for_index(moment.rules.shape, self.blank_slot) };
        let index = build_index(set.cut(), &weights, &index_rules);
        self.spreads =
            set.cut().walk_shown().any(|place| stands_for_more(&index, place, rules.is_quadrilinear));
        // Where no leaf has less than all weight, a kernel without blending gives the same bits in half the time.
        self.blends = set.cut().walk_shown().any(|place| index[place as usize].weights != FULL_WEIGHTS);
        stages.refine_ms += milliseconds(started);
        let started = Instant::now();
        let is_other = bytemuck::cast_slice::<_, u8>(&index) != bytemuck::cast_slice::<_, u8>(&self.index);
        self.has_changed = is_other || self.are_cells_stale;
        if self.has_changed {
            device.write_index(&index, &self.cells);
        }
        (self.index, self.are_cells_stale) = (index, false);
        stages.upload_ms += milliseconds(started);
    }

    /// Judges the cells of nodes anew that have begun or ceased to blend with their parents.
    fn refresh_blended_cells(&mut self, cut: &Cut, weights: &[[f32; 8]], rules: &FrameRules) {
        for place in cut.walk_shown() {
            let Some(brick) = cut.node(place).brick else { continue };
            let blends = rules.blends && weights[place as usize] != [1.0; 8];
            if self.has_blended_cells[brick.slot as usize] != blends {
                self.refresh_cells_of(cut, place, rules, blends);
            }
        }
    }
}

/// Whether samples of a leaf, or of those above that it blends with, stand for more than themselves.
fn stands_for_more(index: &[NodeRecord], place: u32, is_quadrilinear: bool) -> bool {
    let node = &index[place as usize];
    let has_share = is_quadrilinear || node.weights != FULL_WEIGHTS;
    let parent = index.get(node.parent as usize).filter(|_| has_share && node.parent != NO_NODE);
    let stands_for_more = |node: &NodeRecord| node.deviation_scale > 0.0;
    node.first_child == NO_NODE && (stands_for_more(node) || parent.is_some_and(stands_for_more))
}
