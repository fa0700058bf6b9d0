//! The time of a whole update of the working set on one core: feedback, priorities, restriction, weights, index, and what
//! the device is given.
//!
//! `cargo bench -p lightloom-tests --bench working_set`; LIGHTLOOM_BENCH_ROUNDS=n measures n frames of each size (60). The
//! volume is a box of solid values that moves to and fro in front of the screen; rays meet every leaf, a tenth of the leaves
//! changes its depth in a second, and every brick comes at once. Every size is measured with room for all bricks, and with
//! room for half of them while rays meet a part of the leaves that wanders, so that families have to make way. A device's memory stands in for the device:
//! bricks that come and the index are copied, and what rays found is read from a table as it is downloaded.

use bricks::LodRule;
use bricks::{NodeKey, NodeSummary, OctreeShape};
use glam::{DAffine3, DVec3, UVec3};
use layout::{FeedbackEntry, code_from_deficit, deficit_from_code};
use lightloom_tests::results::{Program, Results};
use optics::{Curve, Optics};
use renderer::working_set::{
    Arrival, Feedback, IndexRules, Moment, SAMPLE_BYTES, Showing, Supply, WorkingSet, build_index,
    corner_weights,
};
use std::ops::Range;
use std::time::{Duration, Instant};

/// Finest voxels along an edge: eight levels.
const EDGE: u32 = 28 << 7;
/// Nodes asked for.
const SIZES: [usize; 6] = [1_000, 2_000, 5_000, 10_000, 30_000, 100_000];

fn optics() -> Optics {
    Optics::grey(Curve::constant(1.0))
}

/// A display like holo72 on which the volume, a metre wide, takes some number of nodes: the finer the detail, the more.
fn rule(lod_scale: f64, z: f64) -> LodRule {
    let scale = 1.0 / f64::from(EDGE);
    LodRule {
        display_from_volume: DAffine3::from_translation(DVec3::new(-0.5, -0.5, z - 0.5))
            * DAffine3::from_scale(DVec3::splat(scale)),
        pixel_size_m: 1.5e-3,
        angular_accuracy: 0.8_f64.to_radians(),
        lod_scale,
    }
}

/// The share of the bricks that a small cache has room for.
const ROOM: f64 = 0.5;
/// The share of the volume, along x, in which rays meet leaves then.
const SIGHT: f64 = 0.6;
/// Room for any number of bricks.
const AMPLE: u32 = 1 << 20;

/// Stands for a disk that has everything at once, and for the way to the device; it notes when it was asked and when it had
/// delivered, and how long bricks took on the way.
struct Disk {
    asked: Instant,
    delivered: Instant,
    uploading: Duration,
    brick: Vec<u16>,
    slot: Vec<u16>,
}

impl Supply for Disk {
    fn want(&mut self, _: &WorkingSet, _: &[NodeKey]) {
        self.asked = Instant::now();
    }

    fn deliver(&mut self, set: &mut WorkingSet) {
        for key in set.wanted().to_vec() {
            if let Arrival::Slot(_) = set.arrived(key, 0.0, 1.0) {
                let started = Instant::now();
                self.slot.copy_from_slice(&self.brick);
                std::hint::black_box(&mut self.slot);
                self.uploading += started.elapsed();
            }
        }
        self.delivered = Instant::now();
    }
}

/// The parts of a frame.
const PARTS: usize = 6;

/// One frame; milliseconds of taking in what rays found, of choosing, of showing, of weighing, of the index and of bricks.
fn frame(
    set: &mut WorkingSet,
    shape: &OctreeShape,
    rule: &LodRule,
    optics: &Optics,
    now_s: f64,
    sight: &Range<f64>,
) -> [f64; PARTS] {
    let summary = |_: NodeKey| NodeSummary { min: 0.4, max: 0.6 };
    let rules = IndexRules { blank_slot: Some(AMPLE), ..IndexRules::new(shape, rule, optics) };
    let moment =
        Moment { rules, summary: &summary, now_s, is_still: false, fade_s: 0.3, most_in_flight: 1 << 20 };
    let table: Vec<FeedbackEntry> = rays_found(set, shape, sight);
    let keys: Vec<NodeKey> = set.cut().nodes().iter().map(|node| node.key).collect();
    let started = Instant::now();
    let downloaded = std::hint::black_box(table.clone());
    let found = |(&key, entry): (&NodeKey, &FeedbackEntry)| {
        let deficit = f64::from(deficit_from_code(entry.deficit_code)?);
        Some(Feedback { key, rays: entry.rays, deficit })
    };
    let met: Vec<Feedback> = keys.iter().zip(&downloaded).filter_map(found).collect();
    let learning = started.elapsed();
    let started = Instant::now();
    let samples = SAMPLE_BYTES as usize / 2;
    let mut disk = Disk {
        asked: started,
        delivered: started,
        uploading: Duration::ZERO,
        brick: vec![1; samples],
        slot: vec![0; samples],
    };
    let started = Instant::now();
    set.step(&moment, &met, Showing::InTime { before: None }, &mut disk);
    let (chosen, shown) = (disk.asked - started, disk.delivered.elapsed());
    let started = Instant::now();
    let weights = corner_weights(set.cut(), &rules, &summary, |_| false);
    let weighing = started.elapsed();
    let started = Instant::now();
    let index = build_index(set.cut(), &weights, &rules);
    std::hint::black_box(index.clone());
    let indexing = started.elapsed();
    [learning, chosen, shown, weighing, indexing, disk.uploading].map(|spent| spent.as_secs_f64() * 1e3)
}

/// A table in which rays met every leaf that begins within these shares of the volume along x.
fn rays_found(set: &WorkingSet, shape: &OctreeShape, sight: &Range<f64>) -> Vec<FeedbackEntry> {
    let mut table = vec![FeedbackEntry::default(); set.cut().nodes().len()];
    let is_met = |place: &u32| {
        let key = set.cut().node(*place).key;
        shape.contains(key) && sight.contains(&(shape.region(key).0.x / f64::from(EDGE)))
    };
    for place in set.cut().shown_leaves().filter(is_met) {
        let deficit_code = code_from_deficit(set.cut().node(place).deficit as f32);
        table[place as usize] = FeedbackEntry { deficit_code, rays: 1 + place % 97 };
    }
    table
}

/// A working set at rest.
fn at_rest(slots: u32, scale: f64, shape: &OctreeShape, optics: &Optics, most: usize) -> WorkingSet {
    let mut set = WorkingSet::new(NodeSummary { min: 0.4, max: 0.6 }, slots);
    let mut before = 0;
    for n in 0..200 {
        frame(&mut set, shape, &rule(scale, 0.7), optics, f64::from(n) * 0.1, &(0.0..1.0));
        let now = set.cut().walk().count();
        if (now == before && n > 12) || now > most {
            break;
        }
        before = now;
    }
    set
}

/// The scale of detail with which about so many nodes are resident, and a working set at rest with it.
fn settled(shape: &OctreeShape, optics: &Optics, nodes: usize) -> (f64, WorkingSet) {
    let (mut low, mut high) = (0.01, 10.0);
    loop {
        let scale = f64::sqrt(low * high);
        let set = at_rest(AMPLE, scale, shape, optics, 2 * nodes);
        let found = set.cut().walk().count();
        if found.abs_diff(nodes) * 8 < nodes || high / low < 1.0001 {
            return (scale, set);
        }
        if found > nodes { low = scale } else { high = scale }
    }
}

/// The row of a working set whose volume moves to and fro.
fn measured(
    is_small: bool,
    mut set: WorkingSet,
    rounds: u32,
    scale: f64,
    shape: &OctreeShape,
    optics: &Optics,
) -> String {
    let room = if is_small { format!("{:.0} %", 100.0 * ROOM) } else { "all".to_owned() };
    let (mut times, mut nodes, mut changes) = (Vec::new(), 0, 0);
    for n in 0..rounds {
        let z = 0.7 + 0.05 * (f64::from(n) * 0.1).sin();
        let now_s = 100.0 + f64::from(n) / 60.0;
        let from = if is_small { (1.0 - SIGHT) * (0.5 + 0.5 * (f64::from(n) * 0.1).sin()) } else { 0.0 };
        let sight = if is_small { from..from + SIGHT } else { 0.0..1.0 };
        times.push(frame(&mut set, shape, &rule(scale, z), optics, now_s, &sight));
        nodes += set.cut().walk().count();
        changes += set.splits + set.collapses();
    }
    let nodes = nodes as f64 / f64::from(rounds);
    let median = |part: usize| quantile(times.iter().map(|parts: &[f64; PARTS]| parts[part]), 0.5);
    let parts: Vec<String> = (0..PARTS).map(|part| format!("{:.3}", median(part))).collect();
    let all = |share| quantile(times.iter().map(|parts| parts.iter().sum()), share);
    format!(
        "| {nodes:.0} | {room} | {:.1} | {} | {:.3} | {:.3} | {:.1} |",
        changes as f64 / f64::from(rounds),
        parts.join(" | "),
        all(0.5),
        all(0.9),
        1e6 * all(0.5) / (nodes * nodes.log2())
    )
}

fn main() -> Result<(), String> {
    let mut results = Results::new(Program::Bench("working_set"), "working_set", "updates");
    let rounds: u32 = std::env::var("LIGHTLOOM_BENCH_ROUNDS")
        .map_or(60, |text| text.parse().expect("the number of rounds is a whole number"));
    let (shape, optics) = (OctreeShape::new(UVec3::splat(EDGE)), optics());
    results.line(format!("One update on one core, the median and the 90th percentile of {rounds} frames\n"));
    results.line(
        "| nodes | room for | came or went a frame: families | feedback, ms | choosing | showing | weights | index | bricks | all | 90 % | ns per n log2 n |",
    );
    results.line("| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for size in SIZES {
        let (scale, set) = settled(&shape, &optics, size);
        let slots = (set.slots().used() as f64 * ROOM) as u32;
        results.line(measured(false, set, rounds, scale, &shape, &optics));
        let small = at_rest(slots, scale, &shape, &optics, usize::MAX);
        results.line(measured(true, small, rounds, scale, &shape, &optics));
    }
    results.finish()
}

/// What a share of some numbers stays within.
fn quantile(numbers: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut numbers: Vec<f64> = numbers.collect();
    numbers.sort_by(f64::total_cmp);
    numbers[((numbers.len() - 1) as f64 * share) as usize]
}
