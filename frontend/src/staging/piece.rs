//! A scene that is ready to be shown, in all its looks.

use crate::scene::{Anchor, LookName, Scene, SceneEnhancer, Values, VolumeFacts};
use glam::DVec3;
use optics::{Enhancer, EnhancerKind, Trapezoid};
use protocol::VolumeRef;
use std::time::Duration;
use world::{Item, Preset};

/// The looks that a scene can be shown in.
#[derive(Clone, Debug, Default)]
pub struct Looks {
    /// What the volume's values tell; None where the scene's own look stays.
    pub values: Option<Values>,
    /// Those that fit.
    pub names: Vec<LookName>,
    /// The one that it has, if it is one of these.
    pub shown: Option<LookName>,
}

/// A scene with its looks.
#[derive(Clone, Debug)]
pub struct Piece {
    own: Scene,
    own_look: Option<LookName>,
    looks: Vec<(LookName, Scene)>,
    facts: VolumeFacts,
    /// What tools of a kind carry, where the scene says so.
    templates: Vec<SceneEnhancer>,
}

impl Piece {
    /// A scene that may be shown in other looks.
    pub fn new(scene: Scene, facts: VolumeFacts, looks: &Looks) -> Self {
        let in_look = |&name: &LookName| {
            let values = looks.values.as_ref()?;
            let mut scene = scene.clone();
            scene.take_look(name, values, &facts);
            Some((name, scene))
        };
        let mut all: Vec<_> = looks.names.iter().filter_map(in_look).collect();
        // The next look is the one after that which is shown.
        let shown = looks.shown.and_then(|shown| all.iter().position(|look| look.0 == shown));
        all.rotate_left(shown.map_or(0, |shown| shown + 1));
        Self { own: scene, own_look: looks.shown, looks: all, facts, templates: Vec::new() }
    }

    /// The same for tools that carry things of their own: what the scene's tool carries is now what theirs look like.
    #[must_use]
    pub fn for_tools(mut self) -> Self {
        let is_carried = |enhancer: &SceneEnhancer| enhancer.anchor == Anchor::Tool;
        self.templates = self.own.enhancers.iter().copied().filter(is_carried).collect();
        for scene in std::iter::once(&mut self.own).chain(self.looks.iter_mut().map(|look| &mut look.1)) {
            scene.enhancers.retain(|enhancer| !is_carried(enhancer));
            scene.tool = None;
        }
        self
    }

    /// What it is in a programme, by its own name.
    pub fn item(&self, presets: Vec<Preset>, time: Option<Duration>) -> Item {
        let (looks, bands) = (self.looks.len(), self.own.bands.len());
        let own_look = self.own_look.and_then(|name| self.look_at(name));
        Item { title: self.own.name.clone(), looks, own_look, bands, presets, time }
    }

    /// What people call its scene.
    pub fn name(&self) -> &str {
        &self.own.name
    }

    /// Its volume.
    pub fn volume_ref(&self) -> VolumeRef {
        self.own.volume_ref()
    }

    /// What its volume is.
    pub fn facts(&self) -> &VolumeFacts {
        &self.facts
    }

    /// The scene in one of its looks, or in its own.
    pub fn scene(&self, look: Option<usize>) -> &Scene {
        look.and_then(|look| self.looks.get(look)).map_or(&self.own, |look| &look.1)
    }

    /// The name of a look, if it is one of the library.
    pub fn look_name(&self, look: Option<usize>) -> Option<LookName> {
        look.map_or(self.own_look, |look| self.looks.get(look).map(|look| look.0))
    }

    /// The place of a look by its name.
    pub fn look_at(&self, name: LookName) -> Option<usize> {
        self.looks.iter().position(|look| look.0 == name)
    }

    /// Where the centre of its volume is at a time of its script, metres, display frame.
    pub fn centre_at(&self, script_s: f64) -> DVec3 {
        self.own.centre_at(script_s)
    }

    /// A band, over data values.
    pub fn band(&self, band: Option<usize>) -> Option<Trapezoid> {
        self.own.bands.get(band.unwrap_or(0)).map(|band| band.values)
    }

    /// What a band is called.
    pub fn band_name(&self, band: usize) -> Option<&str> {
        self.own.bands.get(band).map(|band| band.name.as_str())
    }

    /// What the scene's own tool carries of a kind.
    pub(super) fn template(&self, kind: EnhancerKind) -> Option<Enhancer> {
        self.templates.iter().map(|carried| carried.numbers).find(|numbers| numbers.kind() == kind)
    }

    /// Time of the last frame of its script, seconds; None where nothing moves.
    pub(super) fn script_end_s(&self) -> Option<f64> {
        let last = self.own.frame_count.saturating_sub(1);
        (last > 0).then(|| f64::from(last) / self.own.rate_hz)
    }
}
