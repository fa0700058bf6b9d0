//! All that the rays of a cast read, whichever projector they belong to.

use super::observer::Observer;
use super::scene::SceneNumbers;
use super::volume::Volume;
use needs::Needs;
use needs::tables::Tables;

/// A scene, ready to cast.
#[derive(Clone, Copy, Debug)]
pub struct Casting<'a, F> {
    /// The scene's numbers.
    pub scene: &'a SceneNumbers<F>,
    /// What rays sample.
    pub volume: Volume<'a>,
    /// The transfer functions.
    pub tables: &'a Tables,
    /// What the scene needs.
    pub needs: &'a Needs,
    /// What notes the nodes that rays sample.
    pub observer: Observer<'a>,
}
