//! A mirrored volume is drawn as the mirror image: nothing assumes that a volume's axes are right-handed.

use super::test_scene::{Pictures, display, draw, frame, renderer};
use bricks::BrickSource;
use bricks::LodRule;
use bricks::procedural::ProceduralVolume;
use glam::{DAffine3, DMat3, DQuat, DVec3, UVec3};
use optics::Light;
use protocol::FrameState;
use reference::{Integrator, Reference};
use std::sync::Arc;

/// Two ways through the same samples in f32, in mirrored coordinates, may differ by rounding; linear colour.
const ROUNDING: f32 = 2e-4;

/// What the reference, in f64, may differ by: it integrates each ray to 1e-6.
const TOLERANCE: f64 = 1e-5;

fn source() -> Arc<dyn BrickSource> {
    Arc::new(ProceduralVolume::new("marschner-lobb", UVec3::new(61, 47, 53), 1e-3).unwrap())
}

/// The volume askew in front of the screen, with levels of detail and light as scenes have them; `across` is what becomes of
/// the display's x axis.
fn askew(across: f64) -> FrameState {
    let mirror = DMat3::from_diagonal(DVec3::new(across, 1.0, 1.0));
    let turn = DMat3::from_quat(DQuat::from_rotation_y(0.5) * DQuat::from_rotation_x(-0.8));
    let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.2, 1.0, 0.0), DVec3::new(0.0, 0.3, 0.9));
    let linear = mirror * turn * shear * 3e-3;
    let centre = mirror * DVec3::new(0.03, -0.02, 0.05) - linear * DVec3::new(30.5, 23.5, 26.5);
    let mut frame = frame(0.4);
    frame.display_from_volume = DAffine3::from_mat3_translation(linear, centre);
    frame.quality.lod_scale = 1.0;
    let light = Light::default();
    let toward_light_in_display = mirror * light.toward_light_in_display;
    frame.light = Some(Light { toward_light_in_display, ..light });
    frame
}

fn drawn(frame: &FrameState) -> Pictures {
    let (pictures, report) = draw(&mut renderer(source()), frame).unwrap();
    assert!(report.complete, "{}", report.shortfall);
    pictures
}

/// The picture seen in a mirror that stands upright.
fn mirrored(picture: &[f32]) -> Vec<f32> {
    picture.chunks_exact(4 * 48).flat_map(|row| row.chunks_exact(4).rev().flatten().copied()).collect()
}

fn largest_difference(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn the_renderer_draws_the_mirror_image() {
    let (plain, other) = (drawn(&askew(1.0)), drawn(&askew(-1.0)));
    assert!(askew(-1.0).display_from_volume.matrix3.determinant() < 0.0);
    // The projectors stand left and right of the middle: each takes the other's place.
    for (picture, counterpart) in [(&plain[0], &other[1]), (&plain[1], &other[0])] {
        let lit = picture.chunks_exact(4).filter(|pixel| pixel[3] > 0.5).count();
        assert!(lit > 100, "only {lit} pixels show anything");
        let difference = largest_difference(&mirrored(picture), counterpart);
        assert!(difference < ROUNDING, "{difference}");
        assert!(largest_difference(picture, counterpart) > 0.1, "the picture is its own mirror image");
    }
}

#[test]
fn the_reference_sees_the_mirror_image() {
    let display = display();
    let reference = |frame: &FrameState| {
        let rule = LodRule::new(&display, frame.display_from_volume, frame.quality.lod_scale);
        Reference::new(source(), frame, &rule, Integrator::default()).unwrap()
    };
    let (plain, other) = (reference(&askew(1.0)), reference(&askew(-1.0)));
    let flip = DVec3::new(-1.0, 1.0, 1.0);
    let mut lit = 0;
    for i in 0..40 {
        let at = DVec3::new(-0.15 + 0.0077 * f64::from(i), 0.09 - 0.0041 * f64::from(i), 0.0);
        let eye = DVec3::new(0.1, 0.0, -1.5);
        let direction = (at - eye).normalize();
        let seen = plain.radiance(eye, direction).unwrap();
        let in_mirror = other.radiance(flip * eye, flip * direction).unwrap();
        let difference = (seen.rgb - in_mirror.rgb).abs().max_element();
        assert!(difference < TOLERANCE, "{i}: {difference}");
        lit += usize::from(seen.opacity > 0.5);
    }
    assert!(lit > 5, "only {lit} rays meet anything");
}
