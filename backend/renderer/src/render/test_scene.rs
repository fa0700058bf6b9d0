//! A small display and a cloud, for the tests of the renderer.

use super::{RenderError, Renderer};
use bricks::BrickSource;
use display_config::{Display, Finish, Homography, Projector, Raster};
use glam::{DAffine3, DVec2, DVec3};
use optics::{Curve, Light, Optics, Quality};
use protocol::{CasterChoice, FrameReport, FrameState, RenderEvent, RendererOptions};
use std::sync::Arc;

/// Two projectors of 48 × 36 pixels, one the mirror image of the other.
pub(super) fn display() -> Display {
    let raster = |width, height| Raster {
        width,
        height,
        screen_from_pixel: Homography::of_rectangle(
            DVec2::new(f64::from(width), f64::from(height)),
            DVec2::new(-0.2, -0.15),
            DVec2::new(0.4, 0.3),
        ),
        output: None,
    };
    let projector = |x| Projector {
        name: format!("p{x}"),
        centre_in_display: DVec3::new(x, 0.0, -1.5),
        raster: raster(48, 36),
        backend: 0,
        finish: Finish::default(),
    };
    Display {
        name: "test".into(),
        width_m: 0.4,
        height_m: 0.3,
        pixel_size_m: 1e-3,
        angular_accuracy: 0.01,
        observer_in_display: DVec3::new(0.0, 0.0, 1.2),
        eta: 1.0,
        rate_hz: 60.0,
        projectors: vec![projector(-0.2), projector(0.2)],
        adapters: Vec::new(),
    }
}

/// A cloud of all values from `least` up, on the finest level everywhere.
pub(super) fn frame(least: f64) -> FrameState {
    let placed = DAffine3::from_scale(DVec3::splat(2e-3)) * DAffine3::from_translation(DVec3::splat(-50.0));
    let extinction = Curve::new(vec![(least, 0.0), (1.0, 0.08)]).unwrap();
    let colour = Curve::new(vec![(0.0, DVec3::X), (1.0, DVec3::new(0.2, 0.7, 1.0))]).unwrap();
    let optics = Optics::plain((0.0, 1.0), extinction, colour);
    FrameState {
        light: Some(Light::default()),
        quality: Quality { lod_scale: 0.0, ..Quality::default() },
        ..FrameState::still(DVec3::new(0.0, 0.0, 1.2), placed, optics)
    }
}

/// Both projectors on the CPU, with a cache that holds any volume of these tests.
pub(super) fn options() -> RendererOptions {
    RendererOptions::in_process(display(), vec![0, 1])
}

/// Ways to cast: rays, row planes, and row planes of projectors that hang askew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Way {
    Rays,
    Planes,
    CalibratedPlanes,
}

impl Way {
    pub(super) const ALL: [Self; 3] = [Self::Rays, Self::Planes, Self::CalibratedPlanes];

    /// The options of [`options`], cast this way.
    pub(super) fn options(self) -> RendererOptions {
        let mut options = options();
        options.caster = if self == Self::Rays { CasterChoice::Rays } else { CasterChoice::Planes };
        if self == Self::CalibratedPlanes {
            for (projector, turn) in options.display.projectors.iter_mut().zip([0.03, -0.02]) {
                let askew = DVec2::from_angle(turn);
                let corners = [(-0.21, 0.16), (0.205, 0.15), (0.2, -0.155), (-0.2, -0.15)];
                let corners = corners.map(|corner| askew.rotate(DVec2::from(corner)));
                let map = Homography::of_corners(projector.raster.size(), corners).unwrap();
                projector.raster.screen_from_pixel = map;
            }
        }
        options
    }
}

/// The renderer of these options.
pub(super) fn renderer(source: Arc<dyn BrickSource>) -> Renderer {
    Renderer::new(&options(), source).unwrap().0
}

/// A picture per projector, four numbers per pixel.
pub(super) type Pictures = Vec<Vec<f32>>;

/// Draws one frame.
pub(super) fn draw(
    renderer: &mut Renderer,
    frame: &FrameState,
) -> Result<(Pictures, FrameReport), RenderError> {
    let mut pictures = Vec::new();
    let report = renderer.draw(frame, &mut |event| {
        if let RenderEvent::Image(image) = event {
            pictures.push(image.rgba);
        }
    })?;
    Ok((pictures, report))
}
