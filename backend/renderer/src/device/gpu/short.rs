//! What short rays read and write: a list of them, each with a colour of its own, beside the pictures.

use super::readback::Readback;
use super::view::ViewBuffers;

/// Their buffers, a set for each view.
#[derive(Debug)]
pub(super) struct ShortRays {
    pub(super) buffers: Vec<ViewBuffers>,
    pub(super) colours_back: Readback,
}

impl ShortRays {
    pub(super) fn new() -> Self {
        Self { buffers: Vec::new(), colours_back: Readback::new() }
    }
}
