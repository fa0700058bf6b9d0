//! What a chain of enhancers is given of a sample, and what it makes of it.

use crate::band::Band;
use glam::DVec3;
use optics::MOST_ENHANCERS;

/// Which smooth part of a link's law holds on a stretch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Zone {
    /// None: it leaves samples as they are.
    Idle,
    /// That of samples before the plane, or in the front half of the sphere.
    Before,
    /// That of samples behind the plane, or in the back half of the sphere.
    Behind,
    /// The only one there is.
    Everywhere,
}

/// The zones of all links; those that a chain lacks are idle.
pub type Zones = [Zone; MOST_ENHANCERS];

/// A sample as the chain takes it.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// Metres, display frame.
    pub point: DVec3,
    /// Change of the scalar per finest voxel, display frame.
    pub gradient: DVec3,
    /// The band of the scalar.
    pub band: &'a Band,
    /// The scalar's place in the band.
    pub at: f64,
}

/// What the chain makes of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Factor of the extinction, and so of the light that it emits.
    pub extinction: f64,
    /// Factor of the emitted light alone.
    pub colour: f64,
    /// Importance.
    pub importance: f64,
    /// Factor of the shading weight.
    pub shading: f64,
}
