//! Who holds the volume, and who its window of values.

use crate::cast::{ToolId, VisitorId};
use crate::grip::{Grip, Hand};
use crate::stage::Window;
use std::time::Duration;

/// How far values may be shifted, in widths of the domain.
const MOST_SHIFT: f64 = 2.0;
/// How much they may be stretched.
const STRETCHES: (f64, f64) = (1.0 / 16.0, 16.0);

/// A visitor holds the volume.
#[derive(Clone, Debug, PartialEq)]
pub struct Holding {
    /// Who.
    pub visitor: VisitorId,
    /// With one or two of their tools.
    pub tools: Vec<ToolId>,
    /// How the volume goes with these.
    pub grip: Grip,
    /// Since when.
    pub since: Duration,
}

impl Holding {
    /// Whether it is by this tool.
    pub fn is_by(&self, tool: ToolId) -> bool {
        self.tools.contains(&tool)
    }
}

/// A tool holds the window of values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowHolding {
    /// Which one.
    pub tool: ToolId,
    /// Where it was when that began, and the window then.
    pub began: Hand,
    /// See there.
    pub window: Window,
}

impl Window {
    /// This window within bounds.
    pub(crate) fn limited(self) -> Self {
        Self {
            shift: self.shift.clamp(-MOST_SHIFT, MOST_SHIFT),
            stretch: self.stretch.clamp(STRETCHES.0, STRETCHES.1),
        }
    }
}
