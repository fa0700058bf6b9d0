//! A working set that takes the place of another one.

use super::WorkingSet;
use super::expected::Expected;
use bricks::NodeKey;

impl WorkingSet {
    /// It takes the place of one of the same volume that showed these bricks.
    pub fn expect(&mut self, nodes: Vec<NodeKey>) {
        self.expected = Expected::new(nodes);
    }

    /// Takes rays to have met what is expected. A view of a complete frame has the cache to itself.
    pub(super) fn note_expected(&mut self) {
        if self.held.shares_views() {
            self.expected.update(&self.held.cut, self.held.now_s);
            self.held.note(&self.expected.met(&self.held.cut));
        }
    }

    /// The bricks that it shows.
    pub fn shown_bricks(&self) -> impl Iterator<Item = NodeKey> + '_ {
        let cut = self.cut();
        cut.walk_shown().map(|place| cut.node(place)).filter(|node| node.brick.is_some()).map(|node| node.key)
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_world::{Random, World, optics, rule, rules};
    use super::super::{Feedback, Moment, Showing, Supply};
    use super::*;
    use glam::UVec3;

    /// Bricks come at once, where there is room.
    struct AtOnce {
        ahead: Vec<NodeKey>,
    }

    impl Supply for AtOnce {
        fn want(&mut self, _: &WorkingSet, ahead: &[NodeKey]) {
            self.ahead = ahead.to_vec();
        }

        fn deliver(&mut self, set: &mut WorkingSet) {
            for key in set.wanted().to_vec() {
                set.arrived(key, 0.0, 1.0);
            }
        }
    }

    struct Scene {
        world: World,
    }

    impl Scene {
        fn new() -> Self {
            Self { world: World::new(UVec3::splat(448), &mut Random(5)) }
        }

        fn set(&self) -> WorkingSet {
            WorkingSet::new(self.world.summary(NodeKey::ROOT), 1 << 12)
        }

        /// One frame, of which rays meet `met`. What is read ahead.
        fn step(&self, set: &mut WorkingSet, frame: u32, met: &[Feedback]) -> Vec<NodeKey> {
            let (rule, optics) = (rule(&self.world.shape, 0.05), optics(0.5));
            let summary = |key| self.world.summary(key);
            let moment = Moment {
                rules: rules(&self.world.shape, &rule, &optics),
                summary: &summary,
                now_s: f64::from(frame) / 60.0,
                is_still: frame > 0,
                fade_s: 0.0,
                most_in_flight: 1 << 12,
            };
            let mut supply = AtOnce { ahead: Vec::new() };
            set.step(&moment, met, Showing::InTime { before: None }, &mut supply);
            supply.ahead
        }

        /// A working set that rays have brought to rest.
        fn at_rest(&self) -> WorkingSet {
            let mut set = self.set();
            for frame in 0..40 {
                let cut = set.cut();
                let met: Vec<_> = cut.shown_leaves().map(|at| Feedback::met(cut.node(at).key, 3)).collect();
                self.step(&mut set, frame, &met);
            }
            set
        }
    }

    fn shown(set: &WorkingSet) -> Vec<NodeKey> {
        let mut shown: Vec<NodeKey> = set.shown_bricks().collect();
        shown.sort_unstable();
        shown
    }

    #[test]
    fn what_another_showed_is_shown_before_any_ray_tells() {
        let scene = Scene::new();
        let before = shown(&scene.at_rest());
        let deepest = before.iter().map(|key| u32::from(key.depth)).max().unwrap();
        assert!(before.len() > 100 && deepest > 2, "{} {deepest}", before.len());
        let (mut new, mut alone) = (scene.set(), scene.set());
        new.expect(before.clone());
        let ahead = scene.step(&mut new, 0, &[]);
        assert!(ahead.len() > 8 && ahead.iter().all(|key| before.contains(key)), "{ahead:?}");
        for frame in 1..=2 * deepest {
            scene.step(&mut new, frame, &[]);
            scene.step(&mut alone, frame, &[]);
        }
        assert_eq!(shown(&new), before);
        assert_eq!(shown(&alone).len(), 1, "without rays there is the root alone");
    }

    #[test]
    fn what_does_not_come_is_not_waited_for() {
        let scene = Scene::new();
        let mut set = scene.set();
        // Nobody would see such detail of it.
        let far = NodeKey { depth: 30, cell: UVec3::splat(5) };
        set.expect(vec![far]);
        assert_eq!(scene.step(&mut set, 0, &[]), [], "it lies outside the volume");
        for (frame, is_awaited) in [(10, true), (299, true), (301, false), (302, false)] {
            scene.step(&mut set, frame, &[]);
            assert_eq!(set.expected.nodes().next().is_some(), is_awaited, "{frame}");
        }
    }
}
