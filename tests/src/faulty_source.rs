//! A volume on a disk that fails: some bricks are late, damaged or away, and all reads can be held.

use crate::random::Random;
use bricks::volume::VolumeFrame;
use bricks::{Brick, BrickError, BrickSource, Codes, NodeKey, NodeSummary, OctreeShape};
use std::collections::HashMap;
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::time::Duration;

/// What is wrong with a brick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The first so many reads fail as those of a busy disk do; with [`FOR_EVER`] all do.
    Away(u32),
    /// Each read takes so long.
    Late(Duration),
    /// Each read finds that its checksum differs.
    Damaged,
    /// Each read brings too few samples.
    Short,
    /// Each read panics.
    Panic,
}

/// More reads than anybody tries.
pub const FOR_EVER: u32 = u32::MAX;

/// Faults, and how many of a thousand bricks have each.
pub type Rates = Vec<(Fault, u64)>;

/// The bricks of another source, some with a fault, the same ones for the same seed. The root has none unless it is
/// given one: nothing is drawn without it.
pub struct FaultySource {
    source: Arc<dyn BrickSource>,
    seed: u64,
    rates: Rates,
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    given: HashMap<NodeKey, Option<Fault>>,
    reads: HashMap<NodeKey, u32>,
    inside: Vec<NodeKey>,
    has_doubled: bool,
    is_held: bool,
    is_away: bool,
}

impl FaultySource {
    /// Spoils a source.
    pub fn shared(source: Arc<dyn BrickSource>, seed: u64, rates: Rates) -> Arc<Self> {
        let (state, changed) = (Mutex::default(), Condvar::new());
        Arc::new(Self { source, seed, rates, state, changed })
    }

    /// What is wrong with a brick, if anything.
    pub fn fault(&self, node: NodeKey) -> Option<Fault> {
        let given = self.state().given.get(&node).copied();
        given.unwrap_or_else(|| self.drawn(node))
    }

    /// Gives a brick a fault, or none, in place of the one it has.
    pub fn give(&self, node: NodeKey, fault: Option<Fault>) {
        self.state().given.insert(node, fault);
    }

    /// Whether all reads fail, as when a cable is pulled.
    pub fn set_away(&self, is_away: bool) {
        self.state().is_away = is_away;
    }

    /// All reads that begin from now on wait until they are released.
    pub fn hold(&self) {
        self.state().is_held = true;
    }

    /// Lets all reads go on.
    pub fn release(&self) {
        self.state().is_held = false;
        self.changed.notify_all();
    }

    /// Waits until at least so many reads are under way.
    pub fn wait_inside(&self, count: usize) {
        let waits = |state: &mut State| state.inside.len() < count;
        drop(self.changed.wait_while(self.state(), waits).expect("no test panics with the lock"));
    }

    /// Reads that began.
    pub fn reads(&self) -> u64 {
        self.state().reads.values().map(|&count| u64::from(count)).sum()
    }

    /// Reads of one brick that began.
    pub fn reads_of(&self, node: NodeKey) -> u32 {
        self.state().reads.get(&node).copied().unwrap_or_default()
    }

    /// Whether any brick was being read twice at a time.
    pub fn has_doubled(&self) -> bool {
        self.state().has_doubled
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().expect("no test panics with the lock")
    }

    fn drawn(&self, node: NodeKey) -> Option<Fault> {
        if node == NodeKey::ROOT {
            return None;
        }
        let mut random = Random(self.seed);
        for number in [u32::from(node.depth), node.cell.x, node.cell.y, node.cell.z] {
            random.0 = random.0.wrapping_add(u64::from(number)).rotate_left(23);
            random.below(1);
        }
        let mut lot = random.below(1000);
        for &(fault, rate) in &self.rates {
            if lot < rate {
                return Some(fault);
            }
            lot -= rate;
        }
        None
    }

    /// Counts a read, and waits while all are held; tells which read of its brick it is, from 1, and whether the disk
    /// is away.
    fn enter(&self, node: NodeKey) -> (u32, bool) {
        let mut state = self.state();
        let count = state.reads.entry(node).or_default();
        *count += 1;
        let count = *count;
        state.has_doubled |= state.inside.contains(&node);
        state.inside.push(node);
        self.changed.notify_all();
        let waits = |state: &mut State| state.is_held;
        let state = self.changed.wait_while(state, waits).expect("no test panics with the lock");
        (count, state.is_away)
    }
}

/// A read under way: it ends however the read does.
struct Inside<'a>(&'a FaultySource, NodeKey);

impl Drop for Inside<'_> {
    fn drop(&mut self) {
        let mut state = self.0.state();
        if let Some(at) = state.inside.iter().position(|&node| node == self.1) {
            state.inside.swap_remove(at);
        }
    }
}

impl BrickSource for FaultySource {
    fn shape(&self) -> OctreeShape {
        self.source.shape()
    }

    fn frame(&self) -> VolumeFrame {
        self.source.frame()
    }

    fn has_deviation(&self) -> bool {
        self.source.has_deviation()
    }

    fn value_range(&self) -> (f64, f64) {
        self.source.value_range()
    }

    /// Summaries are never at fault.
    fn summary(&self, node: NodeKey) -> NodeSummary {
        self.source.summary(node)
    }

    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
        let (count, is_away) = self.enter(node);
        let _inside = Inside(self, node);
        if is_away {
            return Err(BrickError::unavailable(format!("brick {node}: the disk is away")));
        }
        match self.fault(node) {
            Some(Fault::Away(times)) if count <= times => {
                Err(BrickError::unavailable(format!("brick {node}: the disk is busy")))
            }
            Some(Fault::Damaged) => Err(BrickError::damaged(format!("brick {node} is damaged"))),
            Some(Fault::Panic) => panic!("brick {node}: a panic that the test asked for"),
            Some(Fault::Short) => Ok(shortened(self.source.brick(node)?)),
            Some(Fault::Late(delay)) => {
                std::thread::sleep(delay);
                self.source.brick(node)
            }
            Some(Fault::Away(_)) | None => self.source.brick(node),
        }
    }
}

/// The brick without its last sample.
fn shortened(mut brick: Brick) -> Brick {
    match &mut brick.codes {
        Codes::U8(codes) => codes.truncate(codes.len() - 1),
        Codes::U16(codes) => codes.truncate(codes.len() - 1),
    }
    brick
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closure_volume::ClosureVolume;
    use bricks::BrickErrorKind;
    use glam::UVec3;

    fn source(seed: u64, rates: Rates) -> Arc<FaultySource> {
        let volume = ClosureVolume::new(UVec3::splat(28 * 16), (0.0, 1.0), |point| point.x / 448.0);
        FaultySource::shared(Arc::new(volume), seed, rates)
    }

    fn nodes(source: &FaultySource) -> Vec<NodeKey> {
        let shape = source.shape();
        (0..=4).flat_map(|depth| shape.nodes(depth)).collect()
    }

    #[test]
    fn faults_come_at_their_rates_and_are_the_same_for_the_same_seed() {
        let rates = || vec![(Fault::Away(2), 100), (Fault::Damaged, 50), (Fault::Panic, 10)];
        let (one, same, other) = (source(1, rates()), source(1, rates()), source(2, rates()));
        let nodes = nodes(&one);
        let faults = |source: &FaultySource| nodes.iter().map(|&node| source.fault(node)).collect::<Vec<_>>();
        assert_eq!(faults(&one), faults(&same));
        assert_ne!(faults(&one), faults(&other));
        // 4681 nodes: three standard deviations.
        for (fault, rate) in rates() {
            let (count, all) =
                (faults(&one).iter().filter(|&&f| f == Some(fault)).count(), nodes.len() as f64);
            let share = rate as f64 / 1000.0;
            let off = (count as f64 - share * all).abs();
            assert!(off <= 3.0 * (share * all).sqrt(), "{fault:?}: {count}");
        }
        assert_eq!(one.fault(NodeKey::ROOT), None);
    }

    #[test]
    fn each_fault_is_what_it_says() {
        let source = source(1, Vec::new());
        let node = NodeKey::ROOT;
        let kind = || source.brick(node).err().map(|error| error.kind);
        source.give(node, Some(Fault::Away(2)));
        let away = Some(BrickErrorKind::Unavailable);
        assert_eq!([kind(), kind(), kind()], [away, away, None]);
        source.give(node, Some(Fault::Damaged));
        assert_eq!(kind(), Some(BrickErrorKind::Damaged));
        source.give(node, Some(Fault::Short));
        let Codes::U16(codes) = source.brick(node).unwrap().codes else { panic!("16 bits") };
        assert_eq!(codes.len(), 32 * 32 * 32 - 1);
        source.give(node, Some(Fault::Panic));
        let panicked = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| source.brick(node)));
        assert!(panicked.is_err());
        source.give(node, None);
        source.set_away(true);
        assert_eq!(kind(), away);
        source.set_away(false);
        assert_eq!((kind(), source.reads(), source.reads_of(node)), (None, 8, 8));
        assert!(!source.has_doubled());
    }

    #[test]
    fn held_reads_wait_until_they_are_released() {
        let source = source(1, Vec::new());
        source.hold();
        std::thread::scope(|scope| {
            let read = || source.brick(NodeKey::ROOT).is_ok();
            let (one, two) = (scope.spawn(read), scope.spawn(read));
            source.wait_inside(2);
            assert!(!one.is_finished() && !two.is_finished() && source.has_doubled());
            source.release();
            assert!(one.join().unwrap() && two.join().unwrap());
        });
    }
}
