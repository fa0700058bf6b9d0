//! The optical part of a frame, and what it is for rays that leave the eye in one direction.

use super::Ray;
use super::accumulator::{Integrator, Scene};
use super::course::Course;
use super::enhancer::Chain;
use super::field::Levels;
use super::medium::Medium;
use super::refraction_index::Index;
use super::shading::Shading;
use super::slopes::shading_from_gradient;
use glam::DAffine3;
use optics::Light;
use protocol::FrameState;

/// How closely a field without cubics of its own is fitted, as a share of the transfer function's domain.
const FIT_ACCURACY: f64 = 1e-10;

/// What all rays of a frame share.
pub struct Setting {
    /// How closely the model is followed.
    pub integrator: Integrator,
    /// The optics, without enhancers.
    pub medium: Medium,
    /// What bends light; None if it goes straight.
    pub index: Option<Index>,
    /// What shades.
    pub light: Option<Light>,
    /// Bounds every shaded colour component.
    pub brightest: f64,
    /// The volume's placement.
    pub volume_from_display: DAffine3,
    /// Edge of the finest voxel, metres.
    pub voxel_m: f64,
}

/// What a frame is for rays that leave the eye in one direction.
pub struct View<'a> {
    /// What other rays share.
    pub setting: &'a Setting,
    /// None if no enhancer changes the medium.
    medium: Option<Medium>,
    chain: Chain,
}

impl Setting {
    /// Of a frame whose optics have passed their check.
    pub fn new(frame: &FrameState, integrator: Integrator) -> Self {
        let voxel_m = frame.voxel_m();
        let medium = Medium::new(&frame.optics, voxel_m, &Chain::default());
        let light = frame.light;
        let brightest = light.map_or(medium.brightest, |light| {
            let own = frame.optics.materials.iter().flat_map(|curve| curve.points()).map(|point| point.1);
            Shading::brightest(own.chain([light.material()]), medium.brightest)
        });
        let index = frame.optics.refraction.as_ref().map(Index::new);
        let volume_from_display = frame.display_from_volume.inverse();
        Self { integrator, medium, index, light, brightest, volume_from_display, voxel_m }
    }

    /// For a ray that leaves the eye.
    pub fn view(&self, ray: &Ray) -> View<'_> {
        let chain = Chain::new(self.medium.optics(), ray.direction_in_display);
        let medium = (!chain.is_empty()).then(|| Medium::new(self.medium.optics(), self.voxel_m, &chain));
        View { setting: self, medium, chain }
    }

    /// How closely fields are fitted, data value.
    pub fn accuracy(&self) -> f64 {
        let (low, high) = self.medium.optics().domain;
        FIT_ACCURACY * (high - low)
    }
}

impl View<'_> {
    /// What light is gathered from.
    pub fn scene(&self) -> Scene<'_> {
        let Setting { integrator, light, brightest, .. } = *self.setting;
        let shades = light.map_or(Levels::Zero, |light| Shading::levels(&light));
        let levels = if self.chain.looks_along().is_some() { shades.max(Levels::One) } else { shades };
        let medium = self.medium.as_ref().unwrap_or(&self.setting.medium);
        Scene { integrator, medium, chain: &self.chain, brightest, levels }
    }

    /// A straight path of such a ray.
    pub fn course(&self, way: &Ray) -> Course {
        let setting = self.setting;
        let (low, high) = setting.medium.optics().domain;
        let linear = setting.volume_from_display.matrix3;
        let matrix = shading_from_gradient(linear, setting.voxel_m, high - low);
        Course::new(*way, setting.light, &self.chain, matrix)
    }
}
