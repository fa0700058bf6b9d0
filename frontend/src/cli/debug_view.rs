//! The argument that names a debug view.

use clap::ValueEnum;
use optics::DebugView;

/// See [`DebugView`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DebugViewArg {
    /// Light in the colour of the level it comes from: the finest is blue, 4 levels above it yellow.
    Lod,
    /// Light in the colour of its node's deficit: fine enough is blue, 4 levels too coarse yellow.
    Deficit,
    /// How many samples a ray took: none is black, 1024 and more white.
    Samples,
    /// Light in the colour of its node's own share: all from its parent is blue, all its own is yellow.
    Weights,
}

impl From<DebugViewArg> for DebugView {
    fn from(view: DebugViewArg) -> Self {
        match view {
            DebugViewArg::Lod => DebugView::Lod,
            DebugViewArg::Deficit => DebugView::Deficit,
            DebugViewArg::Samples => DebugView::Samples,
            DebugViewArg::Weights => DebugView::Weights,
        }
    }
}
