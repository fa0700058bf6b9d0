//! The observer of a cast: which nodes rays sample, and how much too coarse these are.

use layout::{FeedbackEntry, code_from_deficit};
use std::sync::atomic::{AtomicU32, Ordering};

/// Notes what rays sample.
#[derive(Clone, Copy, Debug)]
pub struct Observer<'a> {
    /// One per node.
    pub feedback: &'a [FeedbackCell],
}

impl Observer<'_> {
    /// Notes a ray that samples a node of this deficit.
    #[inline(always)]
    pub fn note(&self, node: u32, deficit: f32) {
        self.feedback[node as usize].note(deficit);
    }
}

/// Feedback of one node, written by many threads.
#[derive(Debug, Default)]
pub struct FeedbackCell {
    deficit_code: AtomicU32,
    rays: AtomicU32,
}

impl FeedbackCell {
    #[inline]
    fn note(&self, deficit: f32) {
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
