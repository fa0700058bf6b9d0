//! The presented field is continuous: where two leaves touch, both show the same blend of levels.
//!
//! A leaf of depth d shows w V(d) + (1 − w) V(d − 1), with w between its corners. Every V is continuous across bricks, so
//! the field is where the two leaves at a point have the same share of every level. Leaves of an octree have a face, an
//! edge or a corner of the smaller one in common, on which shares are bilinear at most: the corners of leaves suffice.

use super::test_world::{Random, World, live_weights, optics, rule, rules};
use super::{Cut, CutNode, Family};
use super::{Feedback, Moment, WorkingSet};
use bricks::LodRule;
use bricks::{NodeKey, OctreeShape};
use glam::{IVec3, UVec3};
use optics::Optics;
use std::collections::{HashMap, HashSet};

const FRAME_S: f64 = 1.0 / 60.0;
/// Weights reach the device in so many steps.
const STEPS: f32 = 255.0;
/// More depths than the test's volume has.
const DEPTHS: usize = 8;

/// The shares of the levels at a point.
type Shares = [f32; DEPTHS];

/// What a leaf shows at a point, which is given in finest cells.
fn shares(shape: &OctreeShape, key: NodeKey, corners: &[f32; 8], point: IVec3) -> Shares {
    let edge = 1 << (shape.finest_depth() - key.depth);
    let at = (point - key.cell.as_ivec3() * edge).as_vec3() / edge as f32;
    let share = |corner: usize| {
        (0..3).map(|axis| if corner >> axis & 1 == 1 { at[axis] } else { 1.0 - at[axis] }).product::<f32>()
    };
    let own: f32 = (0..8).map(|corner| corners[corner] * share(corner)).sum();
    let mut shares = [0.0; DEPTHS];
    shares[usize::from(key.depth)] = own;
    if key.depth > 0 {
        shares[usize::from(key.depth) - 1] = 1.0 - own;
    }
    shares
}

/// Pairs of leaves at points, how many of them jump there, and by how much of a share at most.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Jumps {
    pairs: u64,
    jumps: u64,
    largest: f32,
}

impl Jumps {
    fn note(&mut self, jump: f32) {
        self.pairs += 1;
        if jump > 0.5 / STEPS {
            self.jumps += 1;
            self.largest = self.largest.max(jump);
        }
    }
}

impl std::fmt::Display for Jumps {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} of {} (largest {:.3})", self.jumps, self.pairs, self.largest)
    }
}

/// Jumps by what the leaves are.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    /// Between leaves that rays of the frame meet.
    met: Jumps,
    /// The same, one of them being finer than the rule of detail asks for: it is going.
    going: Jumps,
    /// The same, one of them touching a leaf that came into sight and still lacks its detail: until then the border was
    /// hidden.
    new: Jumps,
    /// Beside what no ray of the frame meets.
    unmet: Jumps,
    /// Beside what shows nothing.
    nothing: Jumps,
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { met, going, new, unmet, nothing } = self;
        write!(f, "met {met}; going {going}; new {new}; unmet {unmet}; nothing {nothing}")
    }
}

/// What rays see.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sight {
    /// What lies on one side of a plane.
    Side,
    /// What lies, along x, behind less than this many finest cells that show something.
    Depth(u32),
}

/// How bricks come.
#[derive(Clone, Copy, Debug)]
struct Disk {
    /// Frames until a brick is there, at most.
    late: u64,
    /// Bricks per frame.
    most: usize,
}

/// A sequence of frames.
struct Run {
    world: World,
    set: WorkingSet,
    optics: Optics,
    random: Random,
    sight: Sight,
    disk: Disk,
    fade_s: f64,
    /// Depth of the volume's centre at a time, metres.
    z: fn(f64) -> f64,
    /// Whether the display resolves the same at all depths.
    is_uniform: bool,
    /// When bricks that are on their way come.
    due: HashMap<NodeKey, u32>,
    /// What rays of the frame meet.
    met: HashSet<NodeKey>,
    /// What of it came into sight later than the first frame and has not had its detail since.
    new: HashSet<NodeKey>,
    frame: u32,
}

impl Run {
    fn new(slots: u32, sight: Sight, disk: Disk, fade_s: f64, z: fn(f64) -> f64) -> Self {
        let world = World::new(UVec3::splat(448), &mut Random(5));
        Self {
            set: WorkingSet::new(world.summary(NodeKey::ROOT), slots),
            world,
            optics: optics(0.5),
            random: Random(11),
            sight,
            disk,
            fade_s,
            z,
            is_uniform: false,
            due: HashMap::new(),
            met: HashSet::new(),
            new: HashSet::new(),
            frame: 0,
        }
    }

    fn rule(&self) -> LodRule {
        let rule = rule(&self.world.shape, (self.z)(f64::from(self.frame) * FRAME_S));
        if self.is_uniform { LodRule { angular_accuracy: 0.0, ..rule } } else { rule }
    }

    fn step(&mut self) {
        let now_s = f64::from(self.frame) * FRAME_S;
        let z = (self.z)(now_s);
        let rule = self.rule();
        let (world, optics) = (&self.world, &self.optics);
        let rules = rules(&world.shape, &rule, optics);
        let summary = |key| world.summary(key);
        let is_still = self.frame > 0 && z == (self.z)(now_s - FRAME_S);
        let moment =
            Moment { rules, summary: &summary, now_s, is_still, fade_s: self.fade_s, most_in_flight: 64 };
        let met: Vec<Feedback> = self.met.iter().map(|&key| Feedback::met(key, 1 + key.cell.x % 5)).collect();
        self.set.update(&moment, &met);
        let wanted: Vec<NodeKey> = self.set.wanted().to_vec();
        for &key in &wanted {
            let late = self.random.below(self.disk.late) as u32;
            self.due.entry(key).or_insert(self.frame + late);
        }
        self.due.retain(|key, _| wanted.contains(key));
        let frame = self.frame;
        let mut here: Vec<NodeKey> =
            self.due.iter().filter(|&(_, &due)| due <= frame).map(|(&key, _)| key).collect();
        // Neither the order of the hash nor that of the wishes.
        here.sort_unstable();
        for _ in 0..self.disk.most.min(here.len()) {
            let key = here.swap_remove(self.random.below(here.len() as u64) as usize);
            self.due.remove(&key);
            self.set.arrived(key, 0.0, 1.0);
        }
        self.set.show(&moment);
        let sees = self.sees();
        let new = |&key: &NodeKey| {
            let is_in = |of: &HashSet<NodeKey>| {
                let above = key.parent().is_some_and(|parent| of.contains(&parent));
                of.contains(&key) || above || (0..8).any(|octant| of.contains(&key.child(octant)))
            };
            let node = self.set.cut().node(self.set.cut().find_shown(key));
            let is_short = node.deficit > 0.0 || node.shown < 1.0;
            is_short && (is_in(&self.new) || (!self.met.is_empty() && !is_in(&self.met)))
        };
        (self.new, self.met) = (sees.iter().copied().filter(new).collect(), sees);
        self.frame += 1;
    }

    /// The leaves that rays meet.
    fn sees(&self) -> HashSet<NodeKey> {
        let cut = self.set.cut();
        if let Sight::Depth(most) = self.sight {
            return self.along_x(most);
        }
        let leaves = cut.shown_leaves().map(|place| cut.node(place));
        let is_seen = |key| {
            let (low, _) = self.world.shape.region(key);
            low.x + low.y < 300.0
        };
        let found = leaves.filter(|node| node.is_visible);
        found.map(|node| node.key).filter(|&key| is_seen(key)).collect()
    }

    fn along_x(&self, most: u32) -> HashSet<NodeKey> {
        let (cut, shape) = (self.set.cut(), &self.world.shape);
        let depth = shape.finest_depth();
        let bricks = shape.level_bricks(depth);
        let mut found = HashSet::new();
        for (y, z) in (0..bricks.y).flat_map(|y| (0..bricks.z).map(move |z| (y, z))) {
            let leaves =
                (0..bricks.x).map(|x| cut.node(cut.find_shown(NodeKey { depth, cell: UVec3::new(x, y, z) })));
            found.extend(leaves.filter(|node| node.is_visible).take(most as usize).map(|node| node.key));
        }
        found
    }

    /// The leaves around every corner of a leaf, once each, by points in finest cells.
    fn points(&self) -> HashMap<IVec3, Vec<u32>> {
        let (cut, shape) = (self.set.cut(), &self.world.shape);
        let depth = shape.finest_depth();
        let bits = |octant: i32| IVec3::new(octant & 1, octant >> 1 & 1, octant >> 2);
        let mut found = HashMap::new();
        for node in cut.shown_leaves().map(|place| cut.node(place)) {
            for corner in 0..8 {
                let point = (node.key.cell.as_ivec3() + bits(corner)) * (1 << (depth - node.key.depth));
                found.entry(point).or_insert_with(|| {
                    let cells = (0..8).map(|octant| point - bits(octant));
                    let inside = cells.filter(|c| c.min_element() >= 0 && c.max_element() < 1 << depth);
                    let leaves: HashSet<u32> =
                        inside.map(|c| cut.find_shown(NodeKey { depth, cell: c.as_uvec3() })).collect();
                    leaves.into_iter().filter(|&place| cut.node(place).summary.is_some()).collect()
                });
            }
        }
        found
    }

    /// What jumps, by the weights given.
    fn measure(&self, weights: &[[f32; 8]], tally: &mut Tally) {
        let (cut, shape) = (self.set.cut(), &self.world.shape);
        let points = self.points();
        let is_new = |place: &u32| self.new.contains(&cut.node(*place).key);
        let touched: HashSet<u32> =
            points.values().filter(|around| around.iter().any(is_new)).flatten().copied().collect();
        for (&point, around) in &points {
            let at = |place: u32| shares(shape, cut.node(place).key, &weights[place as usize], point);
            for (index, &a) in around.iter().enumerate() {
                for &b in &around[index + 1..] {
                    let jump = at(a).iter().zip(at(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                    self.kind(cut, [a, b], &touched, tally).note(jump);
                }
            }
        }
    }

    /// Which kind of pair these are.
    fn kind<'a>(
        &self,
        cut: &Cut,
        pair: [u32; 2],
        touched: &HashSet<u32>,
        tally: &'a mut Tally,
    ) -> &'a mut Jumps {
        let any = |is: &dyn Fn(&CutNode) -> bool| pair.iter().any(|&place| is(cut.node(place)));
        let is_going = |node: &CutNode| {
            let parent = node.parent.map(|parent| cut.node(parent));
            parent.is_some_and(|parent| parent.deficit <= 0.0 || parent.family == Family::Going)
        };
        if any(&|node| !node.is_visible) {
            &mut tally.nothing
        } else if any(&|node| !self.met.contains(&node.key)) {
            &mut tally.unmet
        } else if pair.iter().any(|place| touched.contains(place)) {
            &mut tally.new
        } else if any(&is_going) {
            &mut tally.going
        } else {
            &mut tally.met
        }
    }

    /// The cut as if no border showed beside what rays do not meet: a canary.
    fn trusting_cut(&self) -> Cut {
        let mut cut = self.set.cut().clone();
        for place in self.set.cut().shown_leaves() {
            let node = cut.node_mut(place);
            if node.deficit > 0.0 && (!self.met.contains(&node.key) || self.new.contains(&node.key)) {
                node.permits = 1.0;
            }
        }
        cut
    }

    /// Plays some frames and measures each; the canary shows that the same frames jump where nothing blends.
    fn play(mut self, name: &str, frames: u32) -> Tally {
        let [mut tally, mut canary, mut trusting] = [Tally::default(); 3];
        let mut changes = 0;
        for _ in 0..frames {
            // As the renderer does.
            let blends = !self.rule().is_uniform(&self.world.shape);
            self.step();
            if self.set.cut().lacks(0) {
                continue;
            }
            changes += self.set.splits + self.set.collapses();
            let whole = vec![[1.0; 8]; self.set.cut().nodes().len()];
            let weights =
                if blends || self.set.blends() { live_weights(self.set.cut()) } else { whole.clone() };
            self.measure(&weights, &mut tally);
            if self.frame.is_multiple_of(4) {
                self.measure(&whole, &mut canary);
                self.measure(&live_weights(&self.trusting_cut()), &mut trusting);
            }
        }
        println!("{name}: {changes} changes; {tally}");
        println!("    without blending: {canary}");
        println!("    where what no ray meets lets neighbours be: {trusting}");
        assert_eq!(canary.met.largest, 1.0, "{name}: nothing jumps without blending");
        assert_eq!(
            trusting.new.jumps > 0,
            trusting.new.pairs > 0,
            "{name}: what is new shows no border anyway"
        );
        tally
    }
}

/// Keeps up with a slow motion.
const PROMPT: Disk = Disk { late: 2, most: 64 };
const LATE: Disk = Disk { late: 30, most: 4 };

fn still(_: f64) -> f64 {
    0.05
}

fn slowly(time_s: f64) -> f64 {
    0.3 - 0.04 * time_s
}

fn fast(time_s: f64) -> f64 {
    0.3 - 0.5 * time_s
}

fn to_and_fro(time_s: f64) -> f64 {
    0.15 + 0.15 * (8.0 * time_s).sin()
}

/// Whether nothing jumps that shows anything on both sides, met by rays or not.
fn is_continuous(tally: &Tally) -> bool {
    let Tally { met, going, new, unmet, .. } = tally;
    met.pairs > 0 && met.jumps + going.jumps + new.jumps + unmet.jumps == 0
}

#[test]
fn a_cold_start_is_continuous_between_all_leaves_that_rays_meet() {
    for fade_s in [0.1, 0.5] {
        let tally = Run::new(6000, Sight::Side, LATE, fade_s, still).play(&format!("cold, {fade_s} s"), 120);
        assert!(is_continuous(&tally));
        let behind = Run::new(6000, Sight::Depth(4), LATE, fade_s, still);
        assert!(is_continuous(&behind.play(&format!("cold, things in the way, {fade_s} s"), 120)));
    }
}

#[test]
fn motion_is_continuous_between_all_leaves_that_rays_meet() {
    for (sight, name) in [(Sight::Side, ""), (Sight::Depth(4), ", things in the way")] {
        let slow = Run::new(6000, sight, PROMPT, 0.1, slowly).play(&format!("slowly{name}"), 150);
        assert!(is_continuous(&slow));
        for z in [fast, to_and_fro] {
            let jumpy = Run::new(6000, sight, LATE, 0.2, z).play(&format!("fast{name}"), 120);
            assert!(is_continuous(&jumpy));
        }
    }
}

#[test]
fn a_small_cache_is_continuous_between_all_leaves_that_rays_meet() {
    for (slots, z, name) in
        [(60, still as fn(f64) -> f64, "still"), (150, slowly, "slowly"), (150, to_and_fro, "fast")]
    {
        let tally = Run::new(slots, Sight::Side, LATE, 0.1, z).play(&format!("{slots} slots, {name}"), 240);
        assert!(is_continuous(&tally));
    }
    // Where the display resolves the same everywhere, leaves differ for want of room alone.
    let uniform = Run { is_uniform: true, ..Run::new(150, Sight::Side, PROMPT, 0.1, still) };
    assert!(is_continuous(&uniform.play("150 slots, uniform", 180)));
}
