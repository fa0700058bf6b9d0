//! The light of a ray that the refraction index bends.

use super::bending::Bending;
use super::follower::{End, Follower, Limits};
use crate::accumulator::{Accumulator, Integrator, Progress, Scene};
use crate::refraction_index::Index;
use crate::setting::View;
use crate::{Field, Radiance, Ray};
use bricks::BrickError;
use glam::{DVec3, DVec4};
use std::ops::ControlFlow;

/// How often a way is laid again, closer to the true one.
const MOST_TRIES: u32 = 7;
/// The first try's deviation from the way, finest voxels, for a tolerance of 1: it falls with the tolerance's root.
const FIRST_DEVIATION_VOXELS: f64 = 0.1;
/// How much closer the second try is.
const SECOND_TRY: f64 = 0.25;
/// The closest of all tries, finest voxels.
const LEAST_DEVIATION_VOXELS: f64 = 1e-11;
/// Light moves by this share of what it moved by before, or less, when its way is laid closer again; else that was in vain.
const LEAST_GAIN: f64 = 0.5;
/// Tries in vain, one after the other, after which light is taken for scattered: it moves however close its way is laid.
const MOST_IN_VAIN: u32 = 2;
/// Share of the tolerance that the light of a way is known to.
const LIGHT_SHARE: f64 = 0.25;
/// Share of the tolerance that the way's deviation is meant to make.
const WAY_SHARE: f64 = 0.2;

/// A ray through a field with a refraction index.
///
/// Its way is laid as chords that lie within a deviation δ of it, and light is gathered along them. What light misses by
/// that is proportional to δ, so two ways of different δ show how much: with R the light and δ' < δ, it is about
/// |R − R'| δ' / (δ − δ'). The estimate doubles it. δ falls until the estimate and the light's own error stay within the
/// tolerance, until two ways in turn could not be followed, or until light proves to be scattered.
pub struct BentLight<'a> {
    /// The scene.
    pub view: &'a View<'a>,
    /// The scalar.
    pub field: &'a dyn Field,
    /// The refraction index.
    pub index: &'a Index,
}

/// A way and its light.
struct Laid {
    light: Radiance,
    deviation_m: f64,
    is_followed: bool,
}

impl BentLight<'_> {
    /// What `ray` sees between two lengths of its way, metres.
    pub fn radiance(&self, ray: &Ray, within_m: (f64, f64)) -> Result<Radiance, BrickError> {
        let line = ray.line(&self.view.setting.volume_from_display);
        let Some((entry_m, _)) = line.clip(self.field.extent(), (0.0, f64::INFINITY)) else {
            return Ok(Radiance::NOTHING);
        };
        let start = Ray { origin_in_display: ray.at(entry_m), ..*ray };
        let within_m = (within_m.0 - entry_m, within_m.1 - entry_m);
        let tolerance = self.view.setting.integrator.tolerance;
        let voxel_m = self.view.setting.voxel_m;
        let first_m = FIRST_DEVIATION_VOXELS * tolerance.min(1.0).sqrt() * voxel_m;
        let mut coarse = self.lay(&start, within_m, first_m)?;
        let mut next_m = SECOND_TRY * first_m;
        let mut seen = coarse.light;
        let (mut moved_before, mut in_vain) = (f64::INFINITY, 0);
        for _ in 1..MOST_TRIES {
            let fine = self.lay(&start, within_m, next_m)?;
            let moved = distance(&fine.light, &coarse.light);
            let per_metre = moved / (coarse.deviation_m - fine.deviation_m);
            let error = fine.light.error_estimate + 2.0 * per_metre * fine.deviation_m;
            let reached = fine.is_followed && error <= tolerance;
            seen = Radiance { error_estimate: error, reached, ..fine.light };
            let is_lost = !coarse.is_followed && !fine.is_followed;
            let has_gained = moved <= tolerance.max(LEAST_GAIN * moved_before);
            in_vain = if has_gained { 0 } else { in_vain + 1 };
            if reached || is_lost || in_vain >= MOST_IN_VAIN || next_m <= LEAST_DEVIATION_VOXELS * voxel_m {
                break;
            }
            let wanted_m = WAY_SHARE * tolerance / per_metre;
            next_m = wanted_m.clamp(0.01 * next_m, SECOND_TRY * next_m).max(LEAST_DEVIATION_VOXELS * voxel_m);
            (coarse, moved_before) = (fine, moved);
        }
        Ok(seen)
    }

    /// Gathers light along chords that lie within `deviation_m` of the way from `start`.
    fn lay(&self, start: &Ray, within_m: (f64, f64), deviation_m: f64) -> Result<Laid, BrickError> {
        let setting = self.view.setting;
        let bending = Bending {
            field: self.field,
            index: self.index,
            optics: setting.medium.optics(),
            volume_from_display: setting.volume_from_display,
        };
        let limits = Limits { voxel_m: setting.voxel_m, diagonal_m: self.diagonal_m(), deviation_m };
        let scene = self.scene();
        let (mut progress, mut gone_m) = (Progress::START, 0.0);
        let mut take = |way: Ray, length_m: f64| {
            let within = (within_m.0 - gone_m, (within_m.1 - gone_m).min(length_m));
            gone_m += length_m;
            if within.1 <= 0.0 {
                return Ok(ControlFlow::Break(()));
            }
            self.gather(scene, &way, within, &mut progress)
        };
        let end = Follower::new(&bending, limits, start)?.follow(&mut take)?;
        let course = self.view.course(start);
        let light = Accumulator::resuming(scene, &course, progress).radiance();
        Ok(Laid { light, deviation_m, is_followed: end == End::Followed })
    }

    /// The light of a part of one chord.
    fn gather(
        &self,
        scene: Scene,
        way: &Ray,
        within_m: (f64, f64),
        progress: &mut Progress,
    ) -> Result<ControlFlow<()>, BrickError> {
        let setting = self.view.setting;
        let line = way.line(&setting.volume_from_display);
        let within_m = (within_m.0.max(0.0), within_m.1);
        let Some(inside) = line.clip(self.field.extent(), within_m) else {
            return Ok(ControlFlow::Continue(()));
        };
        let course = self.view.course(way);
        let mut light = Accumulator::resuming(scene, &course, *progress);
        self.field.walk(&line, inside, setting.accuracy(), &mut light)?;
        *progress = light.progress();
        Ok(if light.is_finished() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }

    /// The scene, with a tolerance that leaves room for the way's.
    fn scene(&self) -> Scene<'_> {
        let scene = self.view.scene();
        let Integrator { tolerance, max_depth } = scene.integrator;
        Scene { integrator: Integrator { tolerance: LIGHT_SHARE * tolerance, max_depth }, ..scene }
    }

    /// The longest diagonal of the volume, metres.
    fn diagonal_m(&self) -> f64 {
        let display_from_volume = self.view.setting.volume_from_display.matrix3.inverse();
        let corner = |x: f64, y: f64| self.field.extent() * DVec3::new(x, y, 1.0);
        let corners = [corner(1.0, 1.0), corner(-1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0)];
        corners.into_iter().map(|corner| (display_from_volume * corner).length()).fold(0.0, f64::max)
    }
}

/// The largest difference of any of the four numbers.
fn distance(a: &Radiance, b: &Radiance) -> f64 {
    let four = |radiance: &Radiance| DVec4::from((radiance.rgb, radiance.opacity));
    (four(a) - four(b)).abs().max_element()
}
