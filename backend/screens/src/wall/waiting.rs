//! How long a wall waits for its window system.

use std::time::Duration;

/// A refresh takes less. What takes longer, as on an output that sleeps, is not waited for.
pub const SHOWN_WITHIN: Duration = Duration::from_millis(100);

/// How often it is looked whether something has been shown.
pub const LOOK_INTERVAL: Duration = Duration::from_micros(100);
