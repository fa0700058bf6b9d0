//! The slots of the brick cache.

/// Which slots are free.
#[derive(Clone, Debug)]
pub struct SlotPool {
    free: Vec<u32>,
    capacity: u32,
}

impl SlotPool {
    /// `capacity` free slots.
    pub fn new(capacity: u32) -> Self {
        Self { free: (0..capacity).rev().collect(), capacity }
    }

    /// Slots that are free.
    pub fn free(&self) -> usize {
        self.free.len()
    }

    /// Slots in use.
    pub fn used(&self) -> u64 {
        u64::from(self.capacity) - self.free.len() as u64
    }

    /// Takes a slot.
    pub fn take(&mut self) -> Option<u32> {
        self.free.pop()
    }

    /// Gives a slot back.
    pub fn give(&mut self, slot: u32) {
        self.free.push(slot);
    }
}
