//! Laws of traces and of their replay.

use super::*;
use crate::working_set::Feedback;
use bricks::LodRule;
use bricks::{NodeKey, OctreeShape};
use glam::{DAffine3, DVec3, UVec3};
use optics::{Curve, Optics, Quality};
use proptest::prelude::*;
use protocol::{FrameState, VolumeRef};
use std::collections::HashSet;
use std::path::Path;

/// 16³ bricks of the finest level.
fn shape() -> OctreeShape {
    OctreeShape::new(UVec3::splat(28 * 16))
}

fn rule() -> LodRule {
    LodRule {
        display_from_volume: DAffine3::from_scale(DVec3::splat(1e-3)),
        pixel_size_m: 1.5e-3,
        angular_accuracy: 0.01,
        lod_scale: 1.0,
    }
}

/// The leaves of a tree that is split wherever a number says so.
fn leaves(splits: &[usize]) -> Vec<NodeKey> {
    let mut leaves = vec![NodeKey::ROOT];
    for split in splits {
        let at = split % leaves.len();
        if leaves[at].depth < shape().finest_depth() {
            let key = leaves.swap_remove(at);
            leaves.extend((0..8).map(|octant| key.child(octant)));
        }
    }
    leaves
}

fn is_above_or_same(above: NodeKey, key: NodeKey) -> bool {
    above.depth <= key.depth && key.cell >> UVec3::splat(u32::from(key.depth - above.depth)) == above.cell
}

fn overlap(a: NodeKey, b: NodeKey) -> bool {
    is_above_or_same(a, b) || is_above_or_same(b, a)
}

fn demand_of(keys: &[NodeKey], picks: &[(usize, u32)]) -> Demand {
    Demand::new(picks.iter().map(|&(pick, rays)| (keys[pick % keys.len()], rays)))
}

fn feedback(demand: &Demand, leaves: &[NodeKey]) -> Vec<Feedback> {
    feedback_on(demand, &rule(), &shape(), leaves.iter().copied())
}

fn splits() -> impl Strategy<Value = Vec<usize>> {
    prop::collection::vec(0..1000usize, 0..40)
}

fn picks(rays: std::ops::Range<u32>) -> impl Strategy<Value = Vec<(usize, u32)>> {
    prop::collection::vec((0..1000usize, rays), 0..30)
}

proptest! {
    #[test]
    fn a_leaf_is_seen_where_it_overlaps_a_demanded_node(of in splits(), on in splits(), picks in picks(0..20)) {
        let demand = demand_of(&leaves(&of), &picks);
        let on = leaves(&on);
        let seen: HashSet<NodeKey> = feedback(&demand, &on).iter().map(|s| s.key).collect();
        for &leaf in &on {
            let expected = demand.nodes().iter().any(|node| overlap(node.key, leaf));
            prop_assert_eq!(seen.contains(&leaf), expected, "{}", leaf);
        }
    }

    /// A node has more rays than the 16³ leaves it may lie over.
    #[test]
    fn rays_are_conserved(of in splits(), on in splits(), picks in picks(4096..1_000_000)) {
        let demand = demand_of(&leaves(&of), &picks);
        let after: u64 = feedback(&demand, &leaves(&on)).iter().map(|s| u64::from(s.rays)).sum();
        prop_assert_eq!(after, demand.rays());
    }

    #[test]
    fn few_rays_count_once_for_every_leaf_at_least(of in splits(), on in splits(), picks in picks(1..20)) {
        let demand = demand_of(&leaves(&of), &picks);
        let seen = feedback(&demand, &leaves(&on));
        prop_assert!(seen.iter().all(|s| s.rays >= 1));
        prop_assert!(seen.iter().map(|s| u64::from(s.rays)).sum::<u64>() >= demand.rays());
    }

    #[test]
    fn on_its_own_cut_a_demand_is_the_feedback(of in splits(), picks in picks(1..100)) {
        let on = leaves(&of);
        let demand = demand_of(&on, &picks);
        let mut found: Vec<_> = feedback(&demand, &on).iter().map(|s| (s.key, s.rays)).collect();
        found.sort_unstable();
        let expected: Vec<_> = demand.nodes().iter().map(|node| (node.key, node.rays)).collect();
        prop_assert_eq!(found, expected);
    }
}

#[test]
fn deficits_are_the_rule_s_and_end_at_the_finest_level() {
    let on = leaves(&[0]);
    let fine = on[3].child(0).child(0).child(0);
    let seen = feedback(&Demand::new([(fine, 5)]), &on);
    let expected = f64::from(rule().deficit(&shape(), on[3]) as f32);
    assert_eq!(seen, [Feedback { key: on[3], deficit: expected, rays: 5 }]);
    let strict = LodRule { lod_scale: 0.0, ..rule() };
    let seen = feedback_on(&Demand::new([(fine, 5)]), &strict, &shape(), std::iter::once(fine));
    assert_eq!(seen, [Feedback { key: fine, deficit: 0.0, rays: 5 }]);
}

fn optics(most: f64) -> Optics {
    Optics::grey(Curve::constant(most))
}

fn frame(index: u32, optics: Optics) -> FrameState {
    let quality = Quality { lod_scale: 0.5, ..Quality::default() };
    let time_s = f64::from(index) * 0.25;
    FrameState { index, time_s, quality, ..FrameState::still(DVec3::Z, rule().display_from_volume, optics) }
}

fn header() -> TraceHeader {
    TraceHeader {
        volume: VolumeRef::Store("a.lloom".into()),
        dims: shape().dims(),
        display: "desk8".into(),
        pixel_size_m: 1.5e-3,
        angular_accuracy: 0.0140625,
    }
}

/// Two frames of different optics, and a third like the second.
fn write(path: &Path) {
    let mut writer = TraceWriter::create(path, header()).unwrap();
    let child = NodeKey::ROOT.child(5);
    for (index, most) in [(0, 1.0), (1, 2.0), (2, 2.0)] {
        let sampled = [(child, 3 + index), (NodeKey::ROOT, 0), (child, 1)];
        writer.frame(&frame(index, optics(most)), sampled.into_iter()).unwrap();
    }
    assert!(!path.exists(), "an unfinished trace has no name");
    writer.finish().unwrap();
}

#[test]
fn a_trace_comes_back_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.trace");
    write(&path);
    let reader = TraceReader::open(&path).unwrap();
    assert_eq!(reader.header(), &header());
    let frames: Vec<TracedFrame> = reader.map(Result::unwrap).collect();
    assert_eq!(frames.len(), 3);
    for (index, found) in (0..).zip(&frames) {
        assert_eq!((found.index, found.time_s, found.lod_scale), (index, f64::from(index) * 0.25, 0.5));
        assert_eq!(found.display_from_volume, rule().display_from_volume);
        assert_eq!(*found.optics, optics(if index == 0 { 1.0 } else { 2.0 }));
        let node = Demanded { key: NodeKey::ROOT.child(5), rays: 4 + index };
        assert_eq!(found.demand.nodes(), [node], "rays add up, and nodes without rays go");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(text.matches("\"optics\"").count(), 2, "optics are written once");
}

#[test]
fn a_trace_that_is_given_up_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    drop(TraceWriter::create(&folder.path().join("a.trace"), header()).unwrap());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// The first error of a trace with one line changed.
fn fault(line: usize, spoil: impl Fn(&str) -> String) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.trace");
    write(&path);
    let text = std::fs::read_to_string(&path).unwrap();
    let lines = text.lines().zip(1..).map(|(text, at)| if at == line { spoil(text) } else { text.into() });
    std::fs::write(&path, lines.collect::<Vec<String>>().join("\n")).unwrap();
    let error = match TraceReader::open(&path) {
        Err(error) => error,
        Ok(mut reader) => reader.find_map(Result::err).expect("a spoiled line is found"),
    };
    let text = error.to_string();
    assert!(text.contains("a.trace") && !text.contains('\n'), "{text}");
    text
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(ProptestConfig::default().cases.max(2000)))]
    #[test]
    fn spoiled_bytes_are_told_in_a_sentence(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..3u8), 1..6),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.trace");
        write(&path);
        let mut bytes = std::fs::read(&path).unwrap();
        for (at, by, change) in changes {
            let at = at.index(bytes.len());
            match change {
                0 => bytes[at] = by,
                1 => bytes.insert(at, by),
                _ => bytes.truncate(at.max(1)),
            }
        }
        std::fs::write(&path, bytes).unwrap();
        let error = match TraceReader::open(&path) {
            Err(error) => Some(error),
            Ok(mut reader) => reader.find_map(Result::err),
        };
        let is_sentence = |text: String| text.contains("a.trace") && !text.contains('\n');
        prop_assert!(error.is_none_or(|error| is_sentence(error.to_string())));
    }
}

#[test]
fn a_spoiled_line_is_told_by_file_and_number() {
    for (line, from, to, why) in [
        (1, "lightloom trace", "another", "line 1: the file does not begin with the header"),
        (1, "\"version\":1", "\"version\":7", "line 1: it has version 7"),
        (1, "448", "0", "line 1: dims [0, 0, 0] are no size"),
        (2, "{", "", "line 2: "),
        (2, "\"optics\"", "\"other\"", "line 2: the first frame has no `optics`"),
        (3, "[1,1,0,1,5]", "[9,1,0,1,5]", "line 3: the volume has no node 9/1,0,1"),
        (3, "[1,1,0,1,5]", "[1,1,0,1]", "line 3: "),
        (4, "0.5,", "-0.5,", "line 4: "),
        (4, "\"lod_scale\":0.5", "\"lod_scale\":-1", "line 4: lod_scale -1 is not"),
    ] {
        let text = fault(line, |text| {
            assert!(text.contains(from), "{text}");
            text.replace(from, to)
        });
        assert!(text.contains(why), "{text}");
    }
    assert!(fault(3, |line| line[..line.len() / 2].into()).contains("line 3: EOF while parsing"));
    assert!(TraceReader::open(Path::new("nowhere.trace")).unwrap_err().to_string().contains("nowhere.trace"));
}
