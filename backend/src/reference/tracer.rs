//! The integration of a ray through a frame's scene: one call per ray.

use super::accumulator::{Accumulator, Integrator};
use super::medium::Medium;
use super::segmentation::{Published, Segment};
use super::shading::Shading;
use super::{Field, Radiance, Ray, Segmentation, StoredField};
use crate::protocol::FrameState;
use crate::store::{BrickError, BrickSource};
use crate::working_set::LodRule;
use glam::{DAffine3, DVec3};
use shaders::optics::{Light, OpticsError};
use std::sync::Arc;

/// How closely a field without cubics of its own is fitted, as a share of the transfer function's domain.
const FIT_ACCURACY: f64 = 1e-10;

/// Why a frame has no reference picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ReferenceError {
    /// The optical model is not valid.
    #[error("the frame's optical model: {0}")]
    Optics(#[from] OpticsError),
    /// The volume's placement has no inverse.
    #[error(
        "the volume's placement in the display frame flattens it or is not finite; give it three independent axes"
    )]
    Placement,
    /// The tolerance is not a positive number.
    #[error("the tolerance is {0}; it must be a finite number above 0")]
    Tolerance(f64),
}

/// The optical part of a frame, ready to be integrated over any field.
pub struct Tracer {
    integrator: Integrator,
    medium: Medium,
    light: Option<Light>,
    brightest: f64,
    volume_from_display: DAffine3,
    voxel_m: f64,
}

impl Tracer {
    /// The optics, light and placement of `frame`.
    pub fn new(frame: &FrameState, integrator: Integrator) -> Result<Self, ReferenceError> {
        frame.optics.check()?;
        let tolerance = integrator.tolerance;
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return Err(ReferenceError::Tolerance(tolerance));
        }
        let volume_from_display = frame.display_from_volume.inverse();
        let voxel_m = frame.voxel_m();
        if !(volume_from_display.is_finite() && voxel_m > 0.0) {
            return Err(ReferenceError::Placement);
        }
        let medium = Medium::new(&frame.optics, voxel_m);
        let light = frame.light_in_effect();
        let brightest = light.map_or(medium.brightest, |light| Shading::brightest(&light, medium.brightest));
        Ok(Self { integrator, medium, light, brightest, volume_from_display, voxel_m })
    }

    /// What a ray sees of `field`, by the continuous model.
    pub fn radiance_on(&self, field: &dyn Field, ray: &Ray) -> Result<Radiance, BrickError> {
        self.radiance_within(field, ray, (0.0, f64::INFINITY))
    }

    /// The same for the part of the ray between two t in metres.
    pub fn radiance_within(
        &self,
        field: &dyn Field,
        ray: &Ray,
        within_m: (f64, f64),
    ) -> Result<Radiance, BrickError> {
        let line = ray.line(&self.volume_from_display);
        let Some(inside) = line.clip(field.extent(), within_m) else {
            return Ok(Radiance::NOTHING);
        };
        let shading = self.shading(ray);
        let mut light = self.accumulator(shading.as_ref());
        field.walk(&line, inside, self.accuracy(), &mut light)?;
        Ok(light.radiance())
    }

    /// What a ray sees of `field` when LFD eq. 3 is applied to given segments, each composited alone beforehand to
    /// the tolerance. The published equation's picture depends on them; with no importance, or γ = 0, it does not.
    pub fn segmented_on(
        &self,
        field: &dyn Field,
        ray: &Ray,
        segmentation: &Segmentation,
    ) -> Result<Radiance, BrickError> {
        let line = ray.line(&self.volume_from_display);
        let shading = self.shading(ray);
        let mut published = Published::new(self.medium.optics());
        for (start, end) in segmentation.segments() {
            let Some(inside) = line.clip(field.extent(), (start.max(0.0), end)) else {
                continue;
            };
            let mut segment = Segment::new(self.accumulator(shading.as_ref()));
            field.walk(&line, inside, self.accuracy(), &mut segment)?;
            if let Some((light, ends)) = segment.seen() {
                published.add(light, ends, self.medium.erasure);
            }
        }
        Ok(published.radiance())
    }

    fn accumulator<'a>(&'a self, shading: Option<&'a Shading>) -> Accumulator<'a> {
        Accumulator::new(self.integrator, &self.medium, shading, self.brightest)
    }

    fn shading(&self, ray: &Ray) -> Option<Shading> {
        let (low, high) = self.medium.optics().domain;
        let linear = self.volume_from_display.matrix3;
        self.light
            .map(|light| Shading::new(light, ray.direction_in_display, linear, self.voxel_m, high - low))
    }

    fn accuracy(&self) -> f64 {
        let (low, high) = self.medium.optics().domain;
        FIT_ACCURACY * (high - low)
    }
}

/// The truth of a frame: its scene over the samples of a store. It may be asked from many threads at once.
pub struct Reference {
    tracer: Tracer,
    field: StoredField,
}

impl Reference {
    /// The scene of `frame` over `source`, on the cut that `rule` asks for; `rule` must place the volume as `frame` does.
    pub fn new(
        source: Arc<dyn BrickSource>,
        frame: &FrameState,
        rule: &LodRule,
        integrator: Integrator,
    ) -> Result<Self, ReferenceError> {
        Ok(Self { tracer: Tracer::new(frame, integrator)?, field: StoredField::new(source, rule) })
    }

    /// The same over a source of which some bricks cannot be read: see [`StoredField::around_damage`].
    pub fn around_damage(
        source: Arc<dyn BrickSource>,
        frame: &FrameState,
        rule: &LodRule,
        integrator: Integrator,
    ) -> Result<Self, ReferenceError> {
        let field = StoredField::around_damage(source, rule, &frame.optics);
        Ok(Self { tracer: Tracer::new(frame, integrator)?, field })
    }

    /// What the ray from `origin_in_display` along `direction_in_display` sees.
    pub fn radiance(
        &self,
        origin_in_display: DVec3,
        direction_in_display: DVec3,
    ) -> Result<Radiance, BrickError> {
        self.tracer.radiance_on(&self.field, &Ray::new(origin_in_display, direction_in_display))
    }

    /// The same, with LFD eq. 3 applied to given segments: see [`Tracer::segmented_on`].
    pub fn segmented(&self, ray: &Ray, segmentation: &Segmentation) -> Result<Radiance, BrickError> {
        self.tracer.segmented_on(&self.field, ray, segmentation)
    }

    /// The scene's optics, for other fields.
    pub fn tracer(&self) -> &Tracer {
        &self.tracer
    }

    /// The store's field.
    pub fn field(&self) -> &StoredField {
        &self.field
    }
}
