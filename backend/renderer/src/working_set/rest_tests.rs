//! A still view comes to rest: at the picture that an unlimited cache gives, or as evenly short of it as the cache is small.

use super::live::{Arrival, Met, Moment, WorkingSet};
use super::test_world::{Random, World, live_weights, optics, rule, rules};
use super::{Family, settle, settled_weights};
use bricks::LodRule;
use bricks::NodeKey;
use glam::UVec3;
use optics::Optics;
use std::collections::BTreeMap;

const FADE_S: f64 = 0.1;
const FRAME_S: f64 = 1.0 / 60.0;

/// A still view of a world.
struct Still {
    world: World,
    set: WorkingSet,
    rule: LodRule,
    optics: Optics,
    random: Random,
    frame: u32,
    /// Frames since the last change of view.
    still: u32,
    looks_away: bool,
}

impl Still {
    fn new(slots: u32, seed: u64) -> Self {
        let world = World::new(UVec3::splat(448), &mut Random(5));
        let rule = rule(&world.shape, 0.05);
        let set = WorkingSet::new(world.summary(NodeKey::ROOT), slots);
        Self {
            set,
            rule,
            optics: optics(0.5),
            world,
            random: Random(seed),
            frame: 0,
            still: 0,
            looks_away: false,
        }
    }

    /// Rays see what lies on one side of a plane: no more than that of any node.
    fn sees(&self, key: NodeKey) -> bool {
        let (low, high) = self.world.shape.region(key);
        if self.looks_away { high.x + high.y > 700.0 } else { low.x + low.y < 300.0 }
    }

    /// Looks somewhere else.
    fn turn(&mut self) {
        (self.looks_away, self.still) = (!self.looks_away, 0);
    }

    /// One frame, of whose wanted bricks some come.
    fn step(&mut self) {
        let seen: Vec<NodeKey> = self.seen_leaves();
        let Self { world, set, rule, optics, random, .. } = self;
        let rules = rules(&world.shape, rule, optics);
        let summary = |key| world.summary(key);
        let now_s = f64::from(self.frame) * FRAME_S;
        let moment = Moment {
            rules,
            summary: &summary,
            now_s,
            is_still: self.still > 0,
            fade_s: FADE_S,
            most_in_flight: 64,
        };
        let rays = |key: NodeKey| 1 + (key.cell.x * 7 + key.cell.z) % 5;
        let met: Vec<Met> = seen.into_iter().map(|key| Met { key, rays: rays(key) }).collect();
        set.update(&moment, &met);
        for key in set.wanted().to_vec() {
            if random.below(3) > 0 {
                let _: Arrival = set.arrived(key, 0.0, 1.0);
            }
        }
        set.show(&moment);
        self.frame += 1;
        self.still += 1;
    }

    fn seen_leaves(&self) -> Vec<NodeKey> {
        self.seen_places().map(|place| self.set.cut.node(place).key).collect()
    }

    fn seen_places(&self) -> impl Iterator<Item = u32> {
        let cut = &self.set.cut;
        cut.shown_leaves().filter(|&place| cut.node(place).is_visible && self.sees(cut.node(place).key))
    }

    /// What rays meet, with weights.
    fn shown(&self) -> BTreeMap<NodeKey, [f32; 8]> {
        let weights = live_weights(&self.set.cut);
        self.seen_places().map(|place| (self.set.cut.node(place).key, weights[place as usize])).collect()
    }
}

#[test]
fn a_large_cache_comes_to_rest_at_what_the_rule_asks_for_whatever_came_first() {
    let mut seen = Vec::new();
    for seed in [1, 2] {
        let mut still = Still::new(6000, seed);
        (0..400).for_each(|_| still.step());
        let shown = still.shown();
        let depth = |key: &NodeKey| still.rule.is_fine_enough(&still.world.shape, *key);
        assert!(shown.keys().all(depth), "every node that is seen is fine enough");
        // By the rule alone, at once: the same nodes, the same weights.
        let before = still.set.cut.clone();
        settle(&mut still.set.cut);
        let Still { world, rule, optics, set, .. } = &still;
        let rules = rules(&world.shape, rule, optics);
        let weights = settled_weights(&set.cut, &rules, &|key| world.summary(key));
        for place in set.cut.shown_leaves() {
            let node = set.cut.node(place);
            if let Some(live) = shown.get(&node.key) {
                assert_eq!(*live, weights[place as usize], "{}", node.key);
                assert_eq!(before.node(place).shown, node.shown);
            }
        }
        assert!(shown.values().any(|corners| *corners != [1.0; 8]), "some borders are blended");
        seen.push(shown);
    }
    assert_eq!(seen[0], seen[1]);
}

#[test]
fn a_small_cache_comes_to_rest_evenly_short_of_it() {
    for slots in [20, 60, 150] {
        let mut still = Still::new(slots, 3);
        (0..600).for_each(|_| still.step());
        let rest = still.shown();
        for _ in 0..1000 {
            still.step();
            assert_eq!(
                (still.set.splits, still.set.collapses),
                (0, 0),
                "{slots} slots, frame {}",
                still.frame
            );
        }
        assert_eq!(still.shown(), rest, "nothing flickers");
        let cut = &still.set.cut;
        let deficits = rest.keys().map(|&key| cut.node(cut.find(key)).deficit);
        let largest = deficits.fold(f64::NEG_INFINITY, f64::max);
        assert!(largest > 0.0, "{slots} slots are enough");
        // No family whose parent would be clearly less short than that holds its room.
        for place in cut.walk() {
            let node = cut.node(place);
            let shows = node.family == Family::Shown && still.set.cut.may_collapse(&still.world.shape, place);
            let is_seen = still.sees(node.key);
            if shows && is_seen {
                assert!(node.deficit > largest - 0.26, "{} at {} for {largest}", node.key, node.deficit);
            }
        }
        println!("{slots} slots: largest deficit {largest:.2}, {} nodes seen", rest.len());
    }
}

#[test]
fn a_view_comes_to_rest_at_what_the_rule_asks_for_wherever_it_looked_before() {
    let mut cold = Still::new(6000, 4);
    (0..400).for_each(|_| cold.step());
    let rest = cold.shown();
    // Room for this view, and for little of any other.
    let slots = cold.set.slots.used() as u32 + 40;
    for seed in 0..6 {
        let mut still = Still::new(slots, seed);
        for _ in 0..12 {
            (0..5 + still.random.below(40)).for_each(|_| still.step());
            still.turn();
        }
        (0..500).for_each(|_| still.step());
        assert_eq!(still.shown(), rest, "seed {seed}, {slots} slots");
    }
}
