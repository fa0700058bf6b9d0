//! What short rays read and write: a list of them, each with a colour of its own, beside the pictures.

use super::context::Context;
use super::readback::Readback;
use super::view::ViewBuffers;

/// Their buffers.
#[derive(Debug)]
pub(super) struct ShortRays {
    pub(super) buffers: ViewBuffers,
    pub(super) colours_back: Readback,
}

impl ShortRays {
    pub(super) fn new(context: &Context) -> Self {
        Self { buffers: ViewBuffers::new(context), colours_back: Readback::new() }
    }
}
