//! The part of a volume that is resident: the cut's nodes, and the bricks that they show.

use layout::NodeRecord;
use layout::brick::{self, CELL_WORDS};

/// What rays sample.
#[derive(Clone, Copy, Debug)]
pub struct Volume<'a> {
    /// The spatial index, root first.
    pub nodes: &'a [NodeRecord],
    /// Which 4³ cells of each slot's brick show anything: 16 words of bits a slot, see [`layout::CELL_WORDS`].
    pub cells: &'a [u32],
    /// The brick cache: slot i holds the codes from i · 32³.
    pub atlas: &'a [u16],
    /// Their standard deviations, likewise; empty where no brick has any.
    pub deviations: &'a [u8],
}

impl<'a> Volume<'a> {
    /// The visible cells of a slot.
    #[inline(always)]
    pub fn cells(&self, slot: u32) -> &'a [u32; CELL_WORDS] {
        let start = slot as usize * CELL_WORDS;
        self.cells[start..start + CELL_WORDS].first_chunk().expect("a slot has 16 words of cells")
    }

    /// The standard deviations of a slot.
    #[inline(always)]
    pub fn deviations(&self, slot: u32) -> &'a [u8; brick::VOXELS] {
        let start = slot as usize * brick::VOXELS;
        self.deviations[start..start + brick::VOXELS].first_chunk().expect("a slot holds 32³ deviations")
    }

    /// The codes of a slot.
    #[inline(always)]
    pub fn brick(&self, slot: u32) -> &'a [u16; brick::VOXELS] {
        let start = slot as usize * brick::VOXELS;
        self.atlas[start..start + brick::VOXELS].first_chunk().expect("a slot holds 32³ codes")
    }
}
