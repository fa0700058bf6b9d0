//! What is known of pictures that become finer from frame to frame.

use crate::device::Patch;
use crate::refine::{Filled, Grain, Order};
use protocol::Refinement;
use std::sync::Arc;

/// The colours of a view at the pixels that its first unit casts.
pub(super) type FewPixels = Vec<[f32; 3]>;

/// What is known of the pictures under way.
#[derive(Debug, Default)]
pub(super) struct Refining {
    /// Of the rasters that have been met.
    orders: Vec<Arc<Order>>,
    /// Which picture the device has, and how many units of it.
    configuration: Option<u32>,
    pub(super) done: u32,
    /// Of each view, as it was cast last.
    pub(super) few: Vec<FewPixels>,
    /// Of each view: what is shown, and what was of the picture before, at its end.
    pub(super) filled: Vec<Filled>,
    pub(super) before: Vec<Filled>,
    /// What was mended of the pictures, where they were cast whole when they were begun.
    pub(super) mended: Option<Vec<Patch>>,
    /// Whether the device has index and tables of another state.
    pub(super) is_disturbed: bool,
    /// Whether the picture was begun with all the detail that there is room for and that can be read.
    pub(super) is_stalled: bool,
}

impl Refining {
    /// A frame of another kind uses the pictures.
    pub(super) fn forget(&mut self) {
        *self = Self { orders: std::mem::take(&mut self.orders), ..Self::default() };
    }

    /// A part begins: how many units of its picture are cast already.
    pub(super) fn begin(&mut self, refinement: Refinement) -> u32 {
        if self.configuration != Some(refinement.configuration) {
            self.configuration = Some(refinement.configuration);
            self.done = 0;
            self.is_disturbed = false;
            self.mended = None;
            self.before = std::mem::take(&mut self.filled);
        }
        self.done
    }

    /// What is shown of a view.
    pub(super) fn shown(&self, view: usize) -> &[f32] {
        &self.filled[view].rgba
    }

    /// The order of a raster.
    pub(super) fn order(&mut self, grain: Grain, size: [u32; 2]) -> Arc<Order> {
        let known = self.orders.iter().find(|order| order.grain() == grain && order.size() == size);
        if let Some(order) = known {
            return Arc::clone(order);
        }
        let order = Arc::new(Order::new(grain, size));
        self.orders.push(Arc::clone(&order));
        order
    }
}
