//! What is shown, one item after the other.

use crate::stage::Handling;
use std::time::Duration;

/// The items, at least one; after the last comes the first.
#[derive(Clone, Debug, PartialEq)]
pub struct Programme(pub Vec<Item>);

/// A scene for some time.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// What visitors read of it.
    pub title: String,
    /// How many looks it has besides its own.
    pub looks: usize,
    /// Which of these its own is, from 0; None where it is none of them.
    pub own_look: Option<usize>,
    /// How many bands of values its band pickers go through; 0 where they keep their own.
    pub bands: usize,
    /// Placements that somebody prepared.
    pub presets: Vec<Preset>,
    /// How long it is shown; None until somebody asks for the next.
    pub time: Option<Duration>,
}

/// A placement that somebody prepared.
#[derive(Clone, Debug, PartialEq)]
pub struct Preset {
    /// What visitors read of it.
    pub title: String,
    /// The placement.
    pub handling: Handling,
    /// The look, from 0 among the item's looks; None for its own.
    pub look: Option<usize>,
}
