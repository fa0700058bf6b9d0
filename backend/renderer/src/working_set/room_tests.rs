//! Laws of the room in the cache.

use super::live::{Met, Moment, WorkingSet};
use super::test_world::{Random, World, optics, rule, rules};
use bricks::LodRule;
use bricks::NodeKey;
use glam::UVec3;

#[test]
fn a_family_that_a_split_rests_on_stays() {
    let world = World::new(UVec3::splat(448), &mut Random(5));
    let (lod, optics) = (LodRule { lod_scale: 0.0, ..rule(&world.shape, 0.0) }, optics(0.1));
    let summary = |key| world.summary(key);
    let rules = rules(&world.shape, &lod, &optics);
    let mut set = WorkingSet::new(world.summary(NodeKey::ROOT), 2000);
    let frame = |set: &mut WorkingSet, n: u32, met: &[Met]| {
        let now_s = f64::from(n) * 0.001;
        let moment =
            Moment { rules, summary: &summary, now_s, is_still: false, fade_s: 0.0, most_in_flight: 1000 };
        set.update(&moment, met);
        for key in set.wanted().to_vec() {
            set.arrived(key, 0.0, 1.0);
        }
        set.show(&moment);
    };
    // Two levels below the root, everywhere.
    for n in 0..12 {
        let shown = set.cut.walk_shown().map(|place| set.cut.node(place).key);
        let coarse = shown.filter(|key| key.depth < 2).map(|key| Met { key, rays: 1 });
        let coarse: Vec<Met> = coarse.collect();
        frame(&mut set, n, &coarse);
    }
    let leaving = set.cut.find(NodeKey { depth: 1, cell: UVec3::X });
    assert!(set.cut.node(leaving).shown_child().is_some());
    set.cut.node_mut(leaving).is_leaving = true;
    // A leaf beside it is split.
    let key = NodeKey { depth: 2, cell: UVec3::X };
    frame(&mut set, 12, &[Met { key, rays: 1 }]);
    assert!(set.cut.node(set.cut.find(key)).first_child.is_some());
    assert!(!set.cut.node(leaving).is_leaving, "it could not go, and its room would be waited for");
}
