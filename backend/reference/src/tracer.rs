//! The integration of a ray through a frame's scene: one call per ray.

use super::accumulator::{Accumulator, Integrator};
use super::refraction::BentLight;
use super::segmentation::{Published, Segment};
use super::setting::Setting;
use super::{Field, Radiance, Ray, Segmentation, StoredField};
use bricks::LodRule;
use bricks::{BrickError, BrickSource};
use glam::DVec3;
use optics::OpticsError;
use protocol::FrameState;
use std::sync::Arc;

/// The error for segments of a scene with refraction.
const BENT_SEGMENTS: &str =
    "segments are parts of a straight ray; remove the refraction from the scene, or ask for the whole ray";

/// Why a frame has no reference picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ReferenceError {
    /// The optical model is not valid.
    #[error("the frame's optical model: {0}")]
    Optics(#[from] OpticsError),
    /// The volume's placement has no inverse.
    #[error(
        "the volume's placement in the display frame flattens it or has a non-finite number; give it three independent axes"
    )]
    Placement,
    /// The tolerance is not a positive number.
    #[error("the tolerance is {0}; it must be a finite number above 0")]
    Tolerance(f64),
}

/// The optical part of a frame, ready to be integrated over any field.
pub struct Tracer {
    setting: Setting,
}

impl Tracer {
    /// The optics, light and placement of `frame`.
    pub fn new(frame: &FrameState, integrator: Integrator) -> Result<Self, ReferenceError> {
        frame.optics.check()?;
        let tolerance = integrator.tolerance;
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return Err(ReferenceError::Tolerance(tolerance));
        }
        let setting = Setting::new(frame, integrator);
        if !(setting.volume_from_display.is_finite() && setting.voxel_m > 0.0) {
            return Err(ReferenceError::Placement);
        }
        Ok(Self { setting })
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
        let view = self.setting.view(ray);
        if let Some(index) = &self.setting.index {
            return BentLight { view: &view, field, index }.radiance(ray, within_m);
        }
        let line = ray.line(&self.setting.volume_from_display);
        let Some(inside) = line.clip(field.extent(), within_m) else {
            return Ok(Radiance::NOTHING);
        };
        let course = view.course(ray);
        let mut light = Accumulator::new(view.scene(), &course);
        field.walk(&line, inside, self.setting.accuracy(), &mut light)?;
        Ok(light.radiance())
    }

    /// What a ray sees of `field` when LFD eq. 3 is applied to given segments, each composited alone beforehand to
    /// the tolerance. The published equation's picture depends on them; with no importance, or γ = 0, it does not.
    /// Refused for a scene with refraction.
    pub fn segmented_on(
        &self,
        field: &dyn Field,
        ray: &Ray,
        segmentation: &Segmentation,
    ) -> Result<Radiance, BrickError> {
        if self.setting.index.is_some() {
            return Err(BrickError::damaged(BENT_SEGMENTS));
        }
        let line = ray.line(&self.setting.volume_from_display);
        let view = self.setting.view(ray);
        let (scene, course) = (view.scene(), view.course(ray));
        let mut published = Published::new(scene.medium);
        for (start, end) in segmentation.segments() {
            let Some(inside) = line.clip(field.extent(), (start.max(0.0), end)) else {
                continue;
            };
            let mut segment = Segment::new(Accumulator::new(scene, &course));
            field.walk(&line, inside, self.setting.accuracy(), &mut segment)?;
            if let Some((light, ends)) = segment.seen() {
                published.add(light, ends);
            }
        }
        Ok(published.radiance())
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
        let tracer = Tracer::new(frame, integrator)?;
        Ok(Self { tracer, field: as_shown(StoredField::new(source, rule), frame, rule) })
    }

    /// The same over a source of which some bricks cannot be read: see [`StoredField::around_damage`].
    pub fn around_damage(
        source: Arc<dyn BrickSource>,
        frame: &FrameState,
        rule: &LodRule,
        integrator: Integrator,
    ) -> Result<Self, ReferenceError> {
        let tracer = Tracer::new(frame, integrator)?;
        let field = StoredField::around_damage(source, rule, &frame.optics);
        Ok(Self { tracer, field: as_shown(field, frame, rule) })
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

/// A field with what the frame's quality makes of it.
fn as_shown(field: StoredField, frame: &FrameState, rule: &LodRule) -> StoredField {
    let field = if frame.quality.blended { field.blended(rule, &frame.optics) } else { field };
    let field = if frame.quality.deviation { field } else { field.without_deviation() };
    if frame.quality.quadrilinear { field.filtered(rule) } else { field }
}
