//! The subject of a gallery: a scene without techniques, and what techniques need to know of it.

use super::curves::{most, opaque_part, over_band, rise_in, scaled};
use crate::FrontendError;
use crate::scene::{Scene, VolumeFacts};
use display_config::Display;
use glam::{DAffine3, DVec3, UVec3};
use optics::{Curve, Detail, ExtinctionUnit, Light, Material, Ramp, Trapezoid};
use protocol::FrameState;

/// Optical depth that [`Subject::covered`] gives the outer band's densest part, were the volume full of it.
const COVERED_DEPTH: f64 = 200.0;
/// The same of [`Subject::glassy`].
const GLASSY_DEPTH: f64 = 5.0;
/// Refraction index of all that is seen, where a scene has none: strong enough to see, and too weak to
/// turn rays back in noise.
const GLASS: f64 = 1.12;
/// Width of a derived curve's flanks, parts of the domain.
const FLANK: f64 = 0.02;
/// Part of the viewing zone between an outer eye and the zone's end: beams are few there.
const INSET: f64 = 0.02;

/// A scene's first frame without any technique, and what is derived from it. Bands, importance, refraction index and
/// materials are the scene's where it gives them: its first band is what is looked for, its second what lies over it.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The frame: straight rays, ordinary compositing, no enhancers; shaded by `light`.
    pub frame: FrameState,
    /// The light, without a technique for detail.
    pub light: Light,
    /// What is looked for, a band over s: else, the values around the most opaque one that are at least a tenth as
    /// opaque.
    pub inner: Trapezoid,
    /// What lies over it, a band over s: else, the visible values below the inner band.
    pub outer: Trapezoid,
    /// Importance over s: else, the inner band's.
    pub importance: Curve<f64>,
    /// Refraction index over s: else, 1 if nothing is seen and that of thin glass from there on.
    pub refraction: Curve<f64>,
    /// Materials over s: else, matt outside and glossy inside.
    pub materials: Curve<Material>,
    /// The volume's centre, metres.
    pub centre: DVec3,
    /// Its longest edge, metres.
    pub longest_m: f64,
    /// Its extent along the display's z, metres.
    pub depth_m: f64,
    /// The eyes: left, middle, right, metres.
    pub eyes: [DVec3; 3],
}

impl Subject {
    /// The subject that a scene makes in front of a display, no larger than the screen's shorter edge.
    ///
    /// # Errors
    /// A look that does not fit the volume, or an observer that no eye has a viewing zone beside.
    pub fn new(scene: &Scene, display: &Display, facts: &VolumeFacts) -> Result<Self, FrontendError> {
        let mut frame = fitted(scene.frame(0, display, facts)?, facts.dims, display);
        let optics = &mut frame.optics;
        let (given_importance, given_refraction) = (optics.mimda.take(), optics.refraction.take());
        let given_materials = optics.materials.take();
        optics.enhancers.clear();
        frame.quality.quadrilinear = false;
        let light = Light { detail: Detail::None, ..frame.light.unwrap_or_default() };
        frame.light = Some(light);
        let bands = bands(scene, &frame)?;
        let visible_from = first_visible(&frame.optics.extinction);
        let edges = edges(&frame.display_from_volume, facts.dims);
        let [inner, outer] = bands;
        Ok(Self {
            importance: given_importance.map_or_else(|| rise_in(inner), |mimda| mimda.importance),
            refraction: given_refraction.unwrap_or_else(|| step(visible_from, 1.0, GLASS)),
            materials: given_materials.unwrap_or_else(|| step(inner.corners()[0], MATT, GLOSSY)),
            centre: frame.display_from_volume.transform_point3(0.5 * facts.dims.as_dvec3()),
            longest_m: edges.iter().map(|edge| edge.length()).fold(0.0, f64::max),
            depth_m: edges.iter().map(|edge| edge.z.abs()).sum(),
            eyes: eyes(display, frame.observer_in_display)?,
            light,
            inner,
            outer,
            frame,
        })
    }

    /// The frame with an outer band that hides most of what it covers.
    pub fn covered(&self) -> FrameState {
        self.with_outer_depth(COVERED_DEPTH)
    }

    /// The frame with an outer band like faintly tinted glass.
    pub fn glassy(&self) -> FrameState {
        self.with_outer_depth(GLASSY_DEPTH)
    }

    /// The frame with nothing but the inner band.
    pub fn inner_alone(&self) -> FrameState {
        self.with_extinction(over_band(&self.frame.optics.extinction, self.inner, 0.0, 1.0))
    }

    /// The direction in which an eye looks at the volume's centre: 0 left, 1 middle, 2 right.
    pub fn look_of(&self, eye: usize) -> DVec3 {
        (self.centre - self.eyes[eye]).normalize_or(DVec3::NEG_Z)
    }

    /// Limits of the cosine of the angle to one outer eye's look: all for that eye, a part for the middle one, nothing
    /// for the other.
    pub fn facing(&self) -> Ramp {
        let between = self.look_of(0).angle_between(self.look_of(2)).max(1e-3);
        Ramp { low: (0.85 * between).cos(), high: (0.25 * between).cos() }
    }

    fn with_outer_depth(&self, depth: f64) -> FrameState {
        let optics = &self.frame.optics;
        let per_metre = optics.extinction_per_metre(self.frame.voxel_m());
        let densest = most(&over_band(&optics.extinction, self.outer, 0.0, 1.0)) * per_metre * self.longest_m;
        // A curve that is next to nothing stays finite.
        let factor = if densest > 0.0 { (depth / densest).min(1e12) } else { 1.0 };
        self.with_extinction(over_band(&optics.extinction, self.outer, 1.0, factor))
    }

    fn with_extinction(&self, extinction: Curve<f64>) -> FrameState {
        let mut frame = self.frame.clone();
        frame.optics.extinction = extinction;
        frame
    }
}

const MATT: Material = Material { ambient: 0.35, diffuse: 0.7, specular: 0.0, shininess: 4.0 };
const GLOSSY: Material = Material { ambient: 0.15, diffuse: 0.7, specular: 0.9, shininess: 40.0 };

/// One value below `s` and another above it.
fn step<V: optics::CurveValue>(s: f64, below: V, above: V) -> Curve<V> {
    Curve::new(vec![(s - FLANK, below), (s + FLANK, above)])
        .expect("the values are constants, and s is a finite point of a curve or band")
}

/// The first s from which on something is seen.
fn first_visible(extinction: &Curve<f64>) -> f64 {
    let points = extinction.points();
    let first = points.iter().position(|point| point.1 > 0.0).unwrap_or(0);
    points[first.saturating_sub(1)].0
}

/// The inner and the outer band over s.
fn bands(scene: &Scene, frame: &FrameState) -> Result<[Trapezoid; 2], FrontendError> {
    let optics = &frame.optics;
    let given = scene.bands_over(optics.domain)?;
    let (low, high) = opaque_part(&optics.extinction);
    let inner = given.first().copied().unwrap_or_else(|| band([low - FLANK, low, high, high + FLANK]));
    let [from, full, ..] = inner.corners();
    let first = first_visible(&optics.extinction).min(from);
    let outer = given.get(1).copied().unwrap_or_else(|| band([first, first, from, full]));
    Ok([inner, outer])
}

fn band(corners: [f64; 4]) -> Trapezoid {
    Trapezoid::new(corners).expect("the corners are finite and in order: see where they come from")
}

/// The frame with a volume whose longest edge is at most the screen's shorter one, as opaque across as it was.
fn fitted(mut frame: FrameState, dims: UVec3, display: &Display) -> FrameState {
    let longest_m = edges(&frame.display_from_volume, dims).iter().map(|e| e.length()).fold(0.0, f64::max);
    let factor = (display.width_m.min(display.height_m) / longest_m).min(1.0);
    let centre_in_volume = 0.5 * dims.as_dvec3();
    let centre = frame.display_from_volume.transform_point3(centre_in_volume);
    let linear = frame.display_from_volume.matrix3 * factor;
    frame.display_from_volume = DAffine3::from_mat3_translation(linear, centre - linear * centre_in_volume);
    if frame.optics.extinction_unit == ExtinctionUnit::PerMetre {
        frame.optics.extinction = scaled(&frame.optics.extinction, 1.0 / factor);
    }
    frame
}

/// The volume's edges in the display, metres.
fn edges(display_from_volume: &DAffine3, dims: UVec3) -> [DVec3; 3] {
    let (linear, dims) = (display_from_volume.matrix3, dims.as_dvec3().to_array());
    [0, 1, 2].map(|axis| linear.col(axis) * dims[axis])
}

/// Eyes at the observer's height and distance: at the left end of the viewing zone, in its middle, at its right end.
fn eyes(display: &Display, observer: DVec3) -> Result<[DVec3; 3], FrontendError> {
    let z_m = observer.z;
    let (low, high) = display.viewing_zone(z_m).ok_or(FrontendError::NoViewingZone { distance_m: z_m })?;
    Ok([INSET, 0.5, 1.0 - INSET].map(|share| DVec3::new(low + share * (high - low), observer.y, z_m)))
}
