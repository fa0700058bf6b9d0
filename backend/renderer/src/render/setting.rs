//! What the rays of a frame are cast with.

use super::RenderError;
use super::caster::CasterOfFrame;
use super::engine::Engine;
use super::rules::FrameRules;
use super::views::{rays_of, scene_numbers};
use bricks::LodRule;
use needs::Needs;
use needs::tables::Tables;
use planes::RasterWarp;
use protocol::FrameState;
use std::sync::Arc;
use twin::{ProjectorRays, SceneNumbers};

/// Cells are kept with a margin of one voxel for half a pair of steps.
const LONGEST_STEP_THAT_PASSES_OVER: f64 = 1.0;

/// What a frame, which has been checked, is drawn with.
#[derive(Debug)]
pub(super) struct Setting {
    pub(super) scene: SceneNumbers<f32>,
    /// Index of each view's projector in the display.
    pub(super) projectors: Vec<u32>,
    /// Of each view, as they are cast: row planes may cast another raster than the projector's own.
    pub(super) rays: Vec<ProjectorRays<f32>>,
    /// The same of the projectors' own rasters.
    pub(super) own_rays: Vec<ProjectorRays<f32>>,
    /// Blending apart, which depends on the working set.
    pub(super) needs: Needs,
    pub(super) tables: Arc<Tables>,
    pub(super) lod: LodRule,
    pub(super) caster: CasterOfFrame,
    /// Whether the display asks for more than one level in this volume.
    has_borders: bool,
}

impl Setting {
    pub(super) fn new(engine: &mut Engine, frame: &FrameState) -> Result<Self, RenderError> {
        let (display, shape) = (&engine.options.display, engine.stock.shape);
        let projectors = engine.options.projectors.clone();
        let scene = scene_numbers(display, frame, &shape);
        let lod = LodRule::new(display, frame.display_from_volume, frame.quality.lod_scale);
        let needs =
            Needs { debug: frame.debug, ..Needs::of(&frame.optics, frame.light.as_ref(), &frame.quality) };
        let all = rays_of(display, frame)?;
        let dims = shape.dims().as_dvec3();
        let asked = engine.options.caster;
        let closeness = || engine.closeness.of(&*engine.stock.source, display, frame);
        let views = (&projectors[..], &all[..]);
        let caster = CasterOfFrame::choose(asked, &engine.device, &needs, views, frame, dims, closeness)?;
        let own_rays: Vec<_> = projectors.iter().map(|&projector| all[projector as usize]).collect();
        let rays = match &caster.fans {
            Some(fans) => fans.rays().collect(),
            None => own_rays.clone(),
        };
        Ok(Self {
            scene,
            rays,
            own_rays,
            caster,
            projectors,
            needs,
            tables: engine.tables.of(&frame.optics, &needs),
            has_borders: !lod.is_uniform(&shape),
            lod,
        })
    }

    /// Pixels of a view's own raster along x and y.
    pub(super) fn own_raster(&self, view: usize) -> [u32; 2] {
        self.own_rays[view].raster
    }

    /// The way from the raster that is cast of a view to its own; None where that is the same.
    pub(super) fn warp(&self, view: usize) -> Option<&RasterWarp> {
        self.caster.fans.as_ref()?.warp(view)
    }

    /// Rays of all views.
    pub(super) fn rays(&self) -> u64 {
        self.rays.iter().map(|rays| u64::from(rays.raster[0]) * u64::from(rays.raster[1])).sum()
    }

    /// What the frame asks of the cut; nodes blend where borders between levels may be seen.
    pub(super) fn rules<'a>(&'a self, frame: &'a FrameState) -> FrameRules<'a> {
        FrameRules {
            lod: self.lod,
            optics: &frame.optics,
            tables: &self.tables,
            can_pass_over: frame.quality.step_voxels <= LONGEST_STEP_THAT_PASSES_OVER,
            is_quadrilinear: frame.quality.quadrilinear,
            blends: frame.quality.blended && self.has_borders,
            spreads: frame.quality.deviation,
        }
    }
}
