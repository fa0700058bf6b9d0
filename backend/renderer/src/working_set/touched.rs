//! What the rays of one view sampled, gathered over its casts.

use super::Cut;
use bricks::NodeKey;
use layout::{FeedbackEntry, deficit_from_code};
use std::collections::HashSet;

/// A leaf that rays found too coarse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// Its place in the cut.
    pub place: u32,
    /// Levels it is too coarse by.
    pub deficit: f32,
    /// Rays that sampled it.
    pub rays: u32,
}

/// The nodes one view sampled.
#[derive(Clone, Debug, Default)]
pub struct Touched {
    keys: HashSet<NodeKey>,
}

impl Touched {
    /// Takes in the feedback of one cast, and returns what it asks for: the largest deficit first, then the most rays;
    /// the key breaks ties, so that the order never depends on the arena's history.
    pub fn take_in(&mut self, cut: &mut Cut, feedback: &[FeedbackEntry], cast: u64) -> Vec<Wanted> {
        let mut wanted = Vec::new();
        for (place, entry) in feedback.iter().enumerate() {
            let Some(deficit) = deficit_from_code(entry.deficit_code) else { continue };
            let place = place as u32;
            cut.touch(place, cast);
            self.keys.insert(cut.node(place).key);
            if deficit > 0.0 {
                wanted.push(Wanted { place, deficit, rays: entry.rays });
            }
        }
        wanted.sort_by(|a, b| {
            let key = |w: &Wanted| cut.node(w.place).key;
            b.deficit.total_cmp(&a.deficit).then(b.rays.cmp(&a.rays)).then_with(|| key(a).cmp(&key(b)))
        });
        wanted
    }

    /// The nodes sampled that are leaves in the final cut: the view's working set.
    pub fn leaves(&self, cut: &Cut) -> HashSet<NodeKey> {
        cut.walk()
            .map(|place| cut.node(place))
            .filter(|node| node.first_child.is_none() && self.keys.contains(&node.key))
            .map(|node| node.key)
            .collect()
    }
}
