//! How far the live cut falls short of the best one that the same slots could hold for the same rays.

use super::tests::{FRAME_S, POLICY, frames, header, world};
use super::*;
use crate::working_set::test_world::{optics, rules};
use crate::working_set::{Cut, Demand, TraceReader, refresh};
use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use glam::{DAffine3, DVec3, UVec3};
use optics::{Curve, Optics};
use protocol::VolumeRef;
use std::cell::RefCell;
use std::collections::{BinaryHeap, HashMap};

/// Rays that sample nodes, and the nodes above them.
struct Rays {
    at: HashMap<NodeKey, u64>,
    /// Nodes that rays sampled, with all of their rays.
    sampled: HashMap<NodeKey, u64>,
}

impl Rays {
    fn new(demand: &Demand) -> Self {
        let mut rays = Self { at: HashMap::new(), sampled: HashMap::new() };
        for node in demand.nodes() {
            rays.sampled.insert(node.key, u64::from(node.rays));
            for key in std::iter::successors(Some(node.key), |key| key.parent()) {
                *rays.at.entry(key).or_default() += u64::from(node.rays);
            }
        }
        rays
    }

    /// Rays that would sample a node in the cut.
    fn of(&self, key: NodeKey) -> Option<u64> {
        let above = || {
            let mut up = std::iter::successors(key.parent(), |key| key.parent());
            up.find_map(|up| self.sampled.get(&up).map(|rays| (rays >> (2 * (key.depth - up.depth))).max(1)))
        };
        self.at.get(&key).copied().or_else(above)
    }
}

/// The cut that is split from the root, the largest deficit first, then the most rays, as far as the slots go.
fn greedy(demand: &Demand, rules: &IndexRules, summary: &dyn Fn(NodeKey) -> NodeSummary, slots: u64) -> Cut {
    let rays = Rays::new(demand);
    let mut cut = Cut::new(summary(NodeKey::ROOT));
    refresh(&mut cut, rules, &[0]);
    let mut used = u64::from(cut.node(0).is_visible);
    let wish = |cut: &Cut, place: u32| {
        let node = cut.node(place);
        let rays = rays.of(node.key).filter(|_| node.is_visible && node.deficit > 0.0)?;
        // Positive numbers have the order of their bits.
        Some((node.deficit.to_bits(), rays, std::cmp::Reverse(node.key), place))
    };
    let mut wishes: BinaryHeap<_> = wish(&cut, 0).into_iter().collect();
    while let Some((.., place)) = wishes.pop() {
        if cut.node(place).first_child.is_some() {
            continue;
        }
        let splits = cut.splits_for(rules.shape, place);
        let below = |split: u32| (0..8).map(move |octant| (split, octant));
        let shows = |&(split, octant): &(u32, u32)| {
            let key = cut.node(split).key.child(octant);
            rules.shape.contains(key) && bricks::is_shown(rules.optics, summary(key))
        };
        let needed = splits.iter().copied().flat_map(below).filter(shows).count() as u64;
        if used + needed > slots {
            continue;
        }
        used += needed;
        for split in splits {
            let contains = |key| rules.shape.contains(key).then(|| summary(key));
            let first = cut.split(split, contains);
            let family: Vec<u32> = (first..first + 8).collect();
            refresh(&mut cut, rules, &family);
            wishes.extend(family.into_iter().filter_map(|child| wish(&cut, child)));
        }
    }
    cut
}

/// How coarse rays would find all of a cut, whether it is shown or not.
fn shortfall(cut: &Cut, demand: &Demand, rules: &IndexRules) -> Shortfall {
    let leaves = cut.walk().filter(|&p| cut.node(p).first_child.is_none() && cut.node(p).is_visible);
    let met = feedback_on(demand, rules.lod, rules.shape, leaves.map(|place| cut.node(place).key));
    let deficits = met.iter().map(|met| (met.rays, met.deficit));
    Shortfall::of(deficits).expect("rays meet something")
}

fn used(cut: &Cut) -> u64 {
    cut.walk().filter(|&place| cut.node(place).is_visible).count() as u64
}

/// Sums over some frames.
#[derive(Default)]
struct Sums {
    frames: f64,
    compared: f64,
    /// Mean and largest deficits: of what is shown, of what is resident, of the greedy cut; slots of the two.
    figures: [f64; 8],
    changes: [f64; 4],
}

impl Sums {
    fn add(&mut self, frame: &ReplayedFrame) {
        self.frames += 1.0;
        let now = [frame.splits, frame.collapses, frame.bricks_loaded, frame.loaded_again];
        self.changes.iter_mut().zip(now).for_each(|(sum, now)| *sum += now as f64);
    }

    fn compare(&mut self, shown: Shortfall, resident: Shortfall, best: Shortfall, slots: [u64; 2]) {
        self.compared += 1.0;
        let [slots, of_best] = slots.map(|slots| slots as f64);
        let now = [
            shown.mean,
            resident.mean,
            best.mean,
            shown.largest,
            resident.largest,
            best.largest,
            slots,
            of_best,
        ];
        self.figures.iter_mut().zip(now).for_each(|(sum, now)| *sum += now);
    }

    fn row(&self) -> String {
        let of = |sum: f64| sum / self.compared;
        let [a, b, c, d, e, f, g, h] = self.figures.map(of);
        let [splits, collapses, loads, again] = self.changes.map(|sum| sum / self.frames);
        format!(
            "{a:.3} | {b:.3} | {c:.3} | {d:.2} | {e:.2} | {f:.2} | {g:.0} | {h:.0} | \
             {splits:.2} | {collapses:.2} | {loads:.2} | {again:.2}"
        )
    }
}

/// Compares over the frames that move, but for the way from nothing, and at the end of a still view; prints a row of each.
fn compare(
    name: &str,
    header: &TraceHeader,
    summary: &dyn Fn(NodeKey) -> NodeSummary,
    frames: &[TracedFrame],
    policy: Policy,
) {
    const BEGINNING: usize = 20;
    let mut replay = Replay::new(header, ReplayVolume { summary, brick_bytes: 65536 }, policy);
    let shape = header.shape();
    let slots = policy.slots(&shape);
    let mut last_change = 0;
    let (mut moving, mut resting) = (Sums::default(), Sums::default());
    let still_from =
        (1..frames.len()).rev().find(|&n| !is_same_view(&frames[n - 1], &frames[n])).unwrap_or(0);
    for (n, frame) in frames.iter().enumerate() {
        let played = replay.play(frame);
        if (played.splits, played.collapses, played.bricks_loaded, replay.set.moving) != (0, 0, 0, 0) {
            last_change = n;
        }
        let (is_moving, is_end) = ((BEGINNING..=still_from).contains(&n), n + 10 > frames.len());
        let sums = if is_end { &mut resting } else { &mut moving };
        if is_moving || is_end {
            sums.add(&played);
        }
        let is_compared = (is_moving && n % 10 == 5) || n + 1 == frames.len();
        if let Some(shown) = played.shortfall.filter(|_| is_compared) {
            let lod = frame.lod_rule(header);
            let rules = rules(&shape, &lod, &frame.optics);
            let best = greedy(&frame.demand, &rules, summary, u64::from(slots));
            let resident = shortfall(replay.set.cut(), &frame.demand, &rules);
            let of_best = shortfall(&best, &frame.demand, &rules);
            sums.compare(shown, resident, of_best, [replay.set.slots().used(), used(&best)]);
        }
    }
    println!("| {name}, {slots} | moving | {} |", moving.row());
    let frames = last_change.saturating_sub(still_from);
    println!("| {name}, {slots} | at rest after {frames} frames | {} |", resting.row());
}

/// There and back again, twice, then still.
fn shuttle(recorded: &[TracedFrame], still: usize) -> Vec<TracedFrame> {
    let there = recorded.iter().chain(recorded.iter().rev().skip(1));
    let mut frames: Vec<TracedFrame> = there.clone().chain(there.skip(1)).cloned().collect();
    hold(&mut frames, still);
    frames
}

/// The last frame stays, so many frames long.
fn hold(frames: &mut Vec<TracedFrame>, still: usize) {
    let last = frames[frames.len() - 1].clone();
    frames.extend(std::iter::repeat_n(last, still));
    let times = frames.iter_mut().enumerate();
    times.for_each(|(n, frame)| frame.time_s = n as f64 * FRAME_S);
}

/// Skins like those of the scene of shells.
fn skins() -> Optics {
    let bands = [[0.085, 0.11, 0.14, 8.0], [0.31, 0.38, 0.43, 22.0], [0.62, 0.7, 0.76, 50.0]];
    let points = bands.iter().flat_map(|&[from, at, to, most]| [(from, 0.0), (at, most), (to, 0.0)]);
    let extinction = Curve::new(points.chain([(0.86, 0.0), (0.93, 250.0)]).collect()).unwrap();
    Optics { domain: (0.0, 1.0), extinction, ..optics(0.5) }
}

/// Shells three metres wide that pass in front of the screen of holo72: what rays of five projectors sample where all is as
/// fine as the display resolves, as far as there is light left.
fn pass(volume: &ProceduralVolume, header: &TraceHeader, count: u32) -> Vec<TracedFrame> {
    const SIZE_M: f64 = 3.0;
    let (shape, optics) = (header.shape(), skins());
    let voxels = f64::from(shape.dims().x);
    let frame = |index| {
        let time_s = f64::from(index) * FRAME_S;
        let centre = DVec3::new(-0.7 + 0.7 * time_s, 0.1, 0.05);
        let display_from_volume = DAffine3::from_translation(centre - 0.5 * SIZE_M)
            * DAffine3::from_scale(DVec3::splat(SIZE_M / voxels));
        let (optics, demand) = (optics.clone(), Demand::default());
        let frame =
            TracedFrame { index, time_s, display_from_volume, lod_scale: 1.0, optics: optics.into(), demand };
        let rule = frame.lod_rule(header);
        let leaf_at = |at: DVec3| {
            let edge = |depth| f64::from(28u32 << shape.level(depth));
            let keys = (0..=shape.finest_depth())
                .map(|depth| NodeKey { depth, cell: (at / edge(depth)).as_uvec3() });
            let is_leaf =
                |key: &NodeKey| key.depth == shape.finest_depth() || rule.is_fine_enough(&shape, *key);
            keys.into_iter().find(is_leaf).unwrap()
        };
        let mut sampled = Vec::new();
        for ray in 0..5 * 32 * 18 {
            let [projector, column, row] = [ray % 5, ray / 5 % 32, ray / 160].map(f64::from);
            let from = DVec3::new(-3.6 + 1.8 * projector, 0.0, -6.0);
            let to = DVec3::new(-0.8 + 0.05 * column, -0.45 + 0.05 * row, 0.0);
            let (mut depth, mut last) = (0.0, None);
            for z in (0..100).map(|step| 1.5 - 0.03 * f64::from(step)) {
                let at = display_from_volume.inverse().transform_point3(to + (to - from) * (z / 6.0));
                let is_inside = at.min_element() >= 0.0 && at.max_element() < voxels;
                let value = if is_inside { volume.field().value(at / voxels) } else { 0.0 };
                let extinction = frame.optics.extinction.at(value);
                if extinction > 0.0 && depth < 4.0 {
                    depth += 0.03 * extinction;
                    let leaf = Some(leaf_at(at)).filter(|&leaf| last != Some(leaf));
                    sampled.extend(leaf.map(|leaf| (leaf, 1)));
                    last = leaf.or(last);
                }
            }
        }
        TracedFrame { demand: Demand::new(sampled), ..frame }
    };
    (0..count).map(frame).collect()
}

fn shells(dims: UVec3) -> ProceduralVolume {
    ProceduralVolume::new("shells", dims, 1e-3).unwrap()
}

/// LIGHTLOOM_CACHE_MIB=64,256 tries other caches; LIGHTLOOM_TRACE=x.trace plays a recording of shells to and fro from frame
/// LIGHTLOOM_FROM on, instead of shells of 4096³ voxels that pass.
#[test]
#[ignore = "prints figures, some minutes long"]
fn figures() {
    let setting = |name: &str, default: &str| std::env::var(name).unwrap_or(default.into());
    let (header, frames, volume) = match std::env::var("LIGHTLOOM_TRACE") {
        Ok(path) => {
            let reader = TraceReader::open(path.as_ref()).unwrap();
            let header = reader.header().clone();
            let from = setting("LIGHTLOOM_FROM", "0").parse().unwrap();
            let recorded: Vec<TracedFrame> = reader.map(Result::unwrap).skip(from).collect();
            let volume = shells(header.dims);
            (header, shuttle(&recorded, 90), volume)
        }
        Err(_) => {
            let dims = UVec3::splat(4096);
            let volume = shells(dims);
            let header = TraceHeader {
                volume: VolumeRef::Store("made up".into()),
                dims,
                display: "like holo72".into(),
                pixel_size_m: 1.5e-3,
                angular_accuracy: 0.8_f64.to_radians(),
            };
            let mut frames = pass(&volume, &header, 60);
            hold(&mut frames, 90);
            (header, frames, volume)
        }
    };
    let known = RefCell::new(HashMap::new());
    let summary = |key| *known.borrow_mut().entry(key).or_insert_with(|| volume.summary(key));
    println!(
        "| slots | | mean shown | mean resident | mean best | largest shown | resident | best | slots used | best | \
         splits | collapses | loads | again |"
    );
    for mib in setting("LIGHTLOOM_CACHE_MIB", "64,128").split(',') {
        let policy = Policy { cache_bytes: mib.parse::<u64>().unwrap() << 20, ..POLICY };
        compare("at once", &header, &summary, &frames, Policy { fade_s: 0.0, ..policy });
        let disk = DiskModel { bytes_per_s: 500e6, latency_s: 5e-4, threads: 8 };
        compare("500 MB/s", &header, &summary, &frames, Policy { disk, ..policy });
    }
}

#[test]
fn what_nobody_sees_any_more_soon_makes_room() {
    let world = world();
    let (header, summary) = (header(&world.shape), |key| world.summary(key));
    // Rays turn from one half of a volume, which hardly moves, to the other.
    let mut frames = frames(&world, 60, 1e-4);
    let sees = |frame: usize, key: NodeKey| (key.cell.x < 8) == (frame < 40);
    for (n, frame) in frames.iter_mut().enumerate() {
        let seen = frame.demand.nodes().iter().filter(|node| sees(n, node.key));
        frame.demand = Demand::new(seen.map(|node| (node.key, node.rays)));
    }
    let policy = Policy { cache_bytes: 32 << 20, ..POLICY };
    let volume = ReplayVolume { summary: &summary, brick_bytes: 65536 };
    let mut replay = Replay::new(&header, volume, Policy { fade_s: 0.0, ..policy });
    let shown: Vec<f64> = frames.iter().map(|frame| replay.play(frame).shortfall.unwrap().mean).collect();
    let lod = frames[59].lod_rule(&header);
    let rules = rules(&world.shape, &lod, &frames[59].optics);
    let best = greedy(&frames[59].demand, &rules, &summary, u64::from(policy.slots(&world.shape)));
    let best = shortfall(&best, &frames[59].demand, &rules).mean;
    // What counts is forgotten after five frames; two more, and the detail is there.
    assert!(shown[47..].iter().all(|mean| *mean < best + 0.03), "{shown:.2?}, at best {best:.2}");
    // The canaries: the turn is seen, and the cache is too small.
    assert!(shown[40] > best + 0.3 && best > 0.1);
}
