//! A source for the loader's tests: it counts reads, waits at a gate, and fails on request.

use bricks::volume::VolumeFrame;
use bricks::{BRICK_VOXELS, Brick, BrickError, BrickSource, Codes, NodeKey, NodeSummary, OctreeShape};
use glam::{DVec3, UVec3};
use std::collections::HashMap;
use std::sync::{Arc, Condvar, Mutex};

/// How a read ends that does not bring the brick.
#[derive(Clone, Copy, Debug)]
pub enum Trouble {
    Unavailable,
    /// Codes are missing.
    Short,
    Panic,
}

#[derive(Debug, Default)]
struct Log {
    begun: Vec<NodeKey>,
    inside: Vec<NodeKey>,
    is_held: bool,
    has_doubled: bool,
    trouble: HashMap<NodeKey, Trouble>,
}

/// Every brick has one value: the x of its key.
#[derive(Debug, Default)]
pub struct TestSource {
    log: Mutex<Log>,
    changed: Condvar,
}

/// Key number `x`.
pub fn key(x: u32) -> NodeKey {
    NodeKey { depth: 9, cell: UVec3::new(x, 0, 0) }
}

/// Keys by their numbers.
pub fn keys(numbers: impl IntoIterator<Item = u32>) -> Vec<NodeKey> {
    numbers.into_iter().map(key).collect()
}

impl TestSource {
    pub fn shared() -> Arc<Self> {
        Arc::default()
    }

    /// All reads wait from now on.
    pub fn held() -> Arc<Self> {
        let source = Self::shared();
        source.log.lock().unwrap().is_held = true;
        source
    }

    pub fn release(&self) {
        self.log.lock().unwrap().is_held = false;
        self.changed.notify_all();
    }

    pub fn hold(&self) {
        self.log.lock().unwrap().is_held = true;
    }

    pub fn spoil(&self, key: NodeKey, trouble: Option<Trouble>) {
        let spoilt = &mut self.log.lock().unwrap().trouble;
        match trouble {
            Some(trouble) => spoilt.insert(key, trouble),
            None => spoilt.remove(&key),
        };
    }

    /// Waits until so many reads are at the gate.
    pub fn wait_inside(&self, count: usize) {
        drop(self.changed.wait_while(self.log.lock().unwrap(), |log| log.inside.len() != count).unwrap());
    }

    /// The keys read so far, in the order in which reads began.
    pub fn begun(&self) -> Vec<NodeKey> {
        self.log.lock().unwrap().begun.clone()
    }

    /// Whether any brick was being read twice at a time.
    pub fn has_doubled(&self) -> bool {
        self.log.lock().unwrap().has_doubled
    }
}

impl BrickSource for TestSource {
    fn shape(&self) -> OctreeShape {
        OctreeShape::new(UVec3::splat(28 << 9))
    }

    fn frame(&self) -> VolumeFrame {
        VolumeFrame::of_voxels(DVec3::ONE)
    }

    fn value_range(&self) -> (f64, f64) {
        (0.0, 1.0)
    }

    fn summary(&self, _: NodeKey) -> NodeSummary {
        NodeSummary { min: 0.0, max: 1.0 }
    }

    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
        let mut log = self.log.lock().unwrap();
        log.has_doubled |= log.inside.contains(&node);
        log.begun.push(node);
        log.inside.push(node);
        self.changed.notify_all();
        let mut log = self.changed.wait_while(log, |log| log.is_held).unwrap();
        log.inside.retain(|&inside| inside != node);
        let trouble = log.trouble.get(&node).copied();
        drop(log);
        self.changed.notify_all();
        let count = match trouble {
            None => BRICK_VOXELS,
            Some(Trouble::Short) => 7,
            Some(Trouble::Unavailable) => return Err(BrickError::unavailable("the disk is away")),
            Some(Trouble::Panic) => panic!("a panic that the test asked for"),
        };
        let mut brick = Brick::new(Codes::U8(vec![255; count]), 0.0, 1.0);
        brick.low = node.cell.x as f32;
        Ok(brick)
    }
}
