//! The time of a whole update of the working set on one core: feedback, priorities, restriction, weights.
//!
//! `cargo bench -p lightloom-tests --bench working_set`; LIGHTLOOM_BENCH_ROUNDS=n measures n frames of each size (60). The
//! volume is a box of solid values that moves to and fro in front of the screen; rays meet every leaf, a tenth of the leaves
//! changes its depth in a second, and every brick comes at once.

use bricks::LodRule;
use bricks::{NodeKey, NodeSummary, OctreeShape};
use glam::{DAffine3, DVec3, UVec3};
use lightloom_tests::results::{Program, Results};
use optics::{Curve, Optics};
use renderer::working_set::{Feedback, IndexRules, Moment, Showing, Supply, WorkingSet, corner_weights};
use std::time::Instant;

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

/// Stands for a disk that has everything at once; it notes when it was asked and when it had delivered.
struct Disk {
    asked: Instant,
    delivered: Instant,
}

impl Supply for Disk {
    fn want(&mut self, _: &WorkingSet, _: &[NodeKey]) {
        self.asked = Instant::now();
    }

    fn deliver(&mut self, set: &mut WorkingSet) {
        for key in set.wanted().to_vec() {
            set.arrived(key, 0.0, 1.0);
        }
        self.delivered = Instant::now();
    }
}

/// One frame; milliseconds of choosing, showing and weighing, without what stands for rays and disk.
fn frame(set: &mut WorkingSet, shape: &OctreeShape, rule: &LodRule, optics: &Optics, now_s: f64) -> [f64; 3] {
    let summary = |_: NodeKey| NodeSummary { min: 0.4, max: 0.6 };
    let rules =
        IndexRules { shape, lod: rule, optics, is_quadrilinear: false, blank_slot: None, deviations: &[] };
    let moment =
        Moment { rules, summary: &summary, now_s, is_still: false, fade_s: 0.3, most_in_flight: 1 << 20 };
    let leaf = |place: &u32| {
        let node = set.cut().node(*place);
        node.shown_child().is_none() && shape.contains(node.key)
    };
    let met: Vec<Feedback> = set
        .cut()
        .walk_shown()
        .filter(leaf)
        .map(|place| Feedback::met(set.cut().node(place).key, place % 97))
        .collect();
    let started = Instant::now();
    let mut disk = Disk { asked: started, delivered: started };
    set.step(&moment, &met, Showing::InTime { before: None }, &mut disk);
    let (chosen, shown) = (disk.asked - started, disk.delivered.elapsed());
    let started = Instant::now();
    std::hint::black_box(corner_weights(set.cut(), &rules, &summary, |_| false));
    [chosen, shown, started.elapsed()].map(|spent| spent.as_secs_f64() * 1e3)
}

/// The scale of detail with which about so many nodes are resident, and a working set at rest with it.
fn settled(shape: &OctreeShape, optics: &Optics, nodes: usize) -> (f64, WorkingSet) {
    let (mut low, mut high) = (0.01, 10.0);
    loop {
        let scale = f64::sqrt(low * high);
        let mut set = WorkingSet::new(NodeSummary { min: 0.4, max: 0.6 }, 1 << 20);
        let mut before = 0;
        for n in 0..200 {
            frame(&mut set, shape, &rule(scale, 0.7), optics, f64::from(n) * 0.1);
            let now = set.cut().walk().count();
            if (now == before && n > 12) || now > 2 * nodes {
                break;
            }
            before = now;
        }
        let found = set.cut().walk().count();
        if found.abs_diff(nodes) * 8 < nodes || high / low < 1.0001 {
            return (scale, set);
        }
        if found > nodes { low = scale } else { high = scale }
    }
}

fn main() -> Result<(), String> {
    let mut results = Results::new(Program::Bench("working_set"), "working_set", "updates");
    let rounds: u32 = std::env::var("LIGHTLOOM_BENCH_ROUNDS")
        .map_or(60, |text| text.parse().expect("the number of rounds is a whole number"));
    let (shape, optics) = (OctreeShape::new(UVec3::splat(EDGE)), optics());
    results.line(format!("One update on one core, the median and the 90th percentile of {rounds} frames\n"));
    results.line(
        "| nodes | families that came or went a frame | choosing, ms | showing, ms | weights, ms | all, ms | 90 %, ms | ns per n log2 n |",
    );
    results.line("| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for size in SIZES {
        let (scale, mut set) = settled(&shape, &optics, size);
        let (mut times, mut nodes, mut changes) = (Vec::new(), 0, 0);
        for n in 0..rounds {
            let z = 0.7 + 0.05 * (f64::from(n) * 0.1).sin();
            let now_s = 100.0 + f64::from(n) / 60.0;
            times.push(frame(&mut set, &shape, &rule(scale, z), &optics, now_s));
            nodes += set.cut().walk().count();
            changes += set.splits + set.collapses();
        }
        let nodes = nodes as f64 / f64::from(rounds);
        let [choosing, showing, weighing] =
            [0, 1, 2].map(|part| quantile(times.iter().map(|parts: &[f64; 3]| parts[part]), 0.5));
        let all = |share| quantile(times.iter().map(|parts| parts.iter().sum()), share);
        results.line(format!(
            "| {nodes:.0} | {:.1} | {choosing:.3} | {showing:.3} | {weighing:.3} | {:.3} | {:.3} | {:.1} |",
            changes as f64 / f64::from(rounds),
            all(0.5),
            all(0.9),
            1e6 * all(0.5) / (nodes * nodes.log2())
        ));
    }
    results.finish()
}

/// What a share of some numbers stays within.
fn quantile(numbers: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut numbers: Vec<f64> = numbers.collect();
    numbers.sort_by(f64::total_cmp);
    numbers[((numbers.len() - 1) as f64 * share) as usize]
}
