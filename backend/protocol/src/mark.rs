//! What is drawn over the pictures: tools, handles, labels.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Something drawn over the picture of each projector, wherever the rays of its pixels meet it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mark {
    /// Where it is, and what it looks like.
    pub shape: MarkShape,
    /// Its colour.
    pub paint: Paint,
    /// Whether the volume before it hides it, as far as that is opaque, and it hides what lies behind it. Otherwise it shines
    /// through. Refused where light is refracted.
    pub is_depth_combined: bool,
}

/// What a mark is. Metres, display frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum MarkShape {
    /// Discs parallel to the screen about all points of a line: a dot, where the line has one point.
    Stroke {
        /// The corners of the line.
        points_in_display: Vec<DVec3>,
        /// Of the discs.
        radius_m: f64,
    },
    /// A flat surface.
    Sheet {
        /// Its corners, in order.
        corners_in_display: Vec<DVec3>,
    },
    /// A line of text, parallel to the screen.
    Label {
        /// What it says.
        text: String,
        /// The middle of its base line.
        base_in_display: DVec3,
        /// Its em: the distance between the base lines of text set solid.
        em_m: f64,
        /// What lies behind the letters, if anything does.
        backing: Option<Paint>,
    },
}

/// An even colour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Paint {
    /// Linear RGB, in [0, 1].
    pub rgb: [f32; 3],
    /// In [0, 1].
    pub opacity: f32,
}
