//! How a scene gets a look of the library, once it meets its volume.

use super::looks::{Grid, LookChoice, LookName, Values, WishedLook, choose, make, read_values};
use super::{Look, Scene, VolumeFacts};
use bricks::BrickSource;

impl Scene {
    /// Wishes for a look of the library, in place of any other but that of the scene file's own `[optics]`: then nothing
    /// changes, and the answer is false.
    pub fn wish_for(&mut self, name: LookName) -> bool {
        let is_free = self.wish.look != WishedLook::Own;
        if is_free {
            self.wish.look = WishedLook::Named(name);
        }
        is_free
    }

    /// Takes the look that it wishes for from the library, fitted to its volume; None if it wishes for none of those. Until
    /// then, a scene that wishes for one has a look that spans all values.
    pub fn fit_look(&mut self, volume: &dyn BrickSource) -> Option<LookChoice> {
        let name = match self.wish.look {
            WishedLook::Own | WishedLook::BuiltIn => return None,
            WishedLook::Best => None,
            WishedLook::Named(name) => Some(name),
        };
        let values = read_values(volume);
        let asked = |name| LookChoice { name, why: "it was asked for".to_owned() };
        let choice = name.map_or_else(|| choose(&values), asked);
        self.take_look(choice.name, &values, &VolumeFacts::of(volume));
        Some(choice)
    }

    /// Takes a look of the library for a volume of such values.
    pub fn take_look(&mut self, name: LookName, values: &Values, facts: &VolumeFacts) {
        let voxel_m = self.voxel_size_m.unwrap_or(facts.voxel_size_m());
        let made = make(name, values, &Grid { dims: facts.dims, voxel_m });
        self.look = Look::InDataUnits(made.look);
        if !self.wish.keeps_light {
            self.light = made.light;
        }
    }
}
