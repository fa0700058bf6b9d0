//! What a twin reads, and the feedback it writes.

use super::{Real, View};
use crate::compose::Needs;
use crate::tables::Tables;
use layout::{CELL_WORDS, FeedbackEntry, NodeRecord, code_from_deficit};
use std::sync::atomic::{AtomicU32, Ordering};

/// Codes of one brick: 32³.
pub const BRICK_VOXELS: usize = 32 * 32 * 32;

/// A view of a scene, ready to cast.
#[derive(Clone, Copy)]
pub struct Scene<'a, F> {
    /// The view.
    pub view: &'a View<F>,
    /// The spatial index, root first.
    pub nodes: &'a [NodeRecord],
    /// The transfer functions.
    pub tables: &'a Tables,
    /// What the scene needs.
    pub needs: &'a Needs,
    /// Which 4³ cells of each slot's brick show anything: 16 words of bits a slot, see [`layout::CELL_WORDS`].
    pub cells: &'a [u32],
    /// The brick cache: slot i holds the codes from i · 32³.
    pub atlas: &'a [u16],
    /// One per node.
    pub feedback: &'a [FeedbackCell],
}

/// Feedback of one node, written by many threads.
#[derive(Debug, Default)]
pub struct FeedbackCell {
    deficit_code: AtomicU32,
    rays: AtomicU32,
}

impl FeedbackCell {
    /// Notes a ray that samples a node of this deficit.
    #[inline]
    pub fn note(&self, deficit: f32) {
        let code = code_from_deficit(deficit);
        // Most rays find the same code: look before the locked write.
        if self.deficit_code.load(Ordering::Relaxed) < code {
            self.deficit_code.fetch_max(code, Ordering::Relaxed);
        }
        self.rays.fetch_add(1, Ordering::Relaxed);
    }

    /// What was noted.
    pub fn entry(&self) -> FeedbackEntry {
        FeedbackEntry {
            deficit_code: self.deficit_code.load(Ordering::Relaxed),
            rays: self.rays.load(Ordering::Relaxed),
        }
    }
}

impl<'a, F: Real> Scene<'a, F> {
    /// The visible cells of a slot.
    #[inline(always)]
    pub fn cells(&self, slot: u32) -> &'a [u32; CELL_WORDS] {
        let start = slot as usize * CELL_WORDS;
        self.cells[start..start + CELL_WORDS].first_chunk().expect("a slot has 16 words of cells")
    }

    /// The codes of a slot.
    #[inline(always)]
    pub fn brick(&self, slot: u32) -> &'a [u16; BRICK_VOXELS] {
        let start = slot as usize * BRICK_VOXELS;
        self.atlas[start..start + BRICK_VOXELS].first_chunk().expect("a slot holds 32³ codes")
    }
}
