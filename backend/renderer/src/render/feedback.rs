//! From the rows of a feedback table to what rays found of which node.

use crate::working_set::{Cut, Feedback};
use bricks::NodeKey;
use layout::{FeedbackEntry, deficit_from_code};
use std::collections::HashMap;

/// The nodes of an index by their places.
pub(super) fn keys_of(cut: &Cut) -> Vec<NodeKey> {
    cut.nodes().iter().map(|node| node.key).collect()
}

/// What rays found of the nodes that they sampled.
pub(super) fn feedback_of(keys: &[NodeKey], table: &[FeedbackEntry]) -> Vec<Feedback> {
    let found = |(&key, entry): (&NodeKey, &FeedbackEntry)| {
        let deficit = deficit_from_code(entry.deficit_code)?;
        Some(Feedback { key, rays: entry.rays, deficit: f64::from(deficit) })
    };
    keys.iter().zip(table).filter_map(found).collect()
}

/// What the rays of two casts found together: the largest deficits, and all rays.
pub(super) fn both(one: &[Feedback], other: Vec<Feedback>) -> Vec<Feedback> {
    let mut met = one.to_vec();
    let places: HashMap<NodeKey, usize> = met.iter().enumerate().map(|(at, met)| (met.key, at)).collect();
    for found in other {
        match places.get(&found.key) {
            Some(&at) => {
                met[at].deficit = met[at].deficit.max(found.deficit);
                met[at].rays += found.rays;
            }
            None => met.push(found),
        }
    }
    met
}
