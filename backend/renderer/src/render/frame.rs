//! One frame: a coarse look by few rays to fetch what they need, then every pixel, again where something was missing.

use super::residency::{Residency, milliseconds};
use super::rules::FrameRules;
use super::views::{ProjectorView, scene_numbers, views};
use super::{RenderError, Renderer};
use crate::device::{CastJob, CastOutcome, Gather, Part};
use crate::working_set::Touched;
use bricks::LodRule;
use bricks::NodeKey;
use protocol::RenderEvent;
use protocol::{FrameReport, FrameState, ProjectorImage, Stages, Upkeep};
use shaders::compose::Needs;
use shaders::tables::Tables;
use shaders::twin::SceneNumbers;
use std::collections::HashSet;
use std::time::Instant;

/// The coarse look casts every 16th pixel along x and y.
const COARSE_STRIDE: u32 = 16;

/// Cells are kept with a margin of one voxel for half a pair of steps.
const LONGEST_STEP_THAT_PASSES_OVER: f64 = 1.0;

/// Damaged bricks that a report tells of one by one.
pub(super) const MOST_DAMAGES: usize = 16;

/// A frame being drawn.
struct Drawing<'a> {
    renderer: &'a mut Renderer,
    rules: FrameRules<'a>,
    scene: SceneNumbers<f32>,
    needs: Needs,
    stages: Stages,
    /// Number of the last cast; the cut remembers by it what was used when.
    cast: u64,
    rays: u64,
    samples: u64,
    /// Nodes that stayed too coarse, over all views.
    short: HashSet<NodeKey>,
}

pub(super) fn draw(
    renderer: &mut Renderer,
    frame: &FrameState,
    sink: &mut dyn FnMut(RenderEvent),
) -> Result<FrameReport, RenderError> {
    let started = Instant::now();
    let setting = Setting::new(renderer, frame)?;
    let total = setting.rays();
    let Setting { scene, views, needs, tables } = setting;
    let mut drawing = Drawing::new(renderer, frame, (scene, needs), &tables);
    drawing.start(frame)?;
    sink(RenderEvent::Progress { done: 0, total });
    drawing.look(&views, &mut || sink(RenderEvent::Progress { done: 0, total }))?;
    let mut working_sets = WorkingSets::default();
    let mut done = 0;
    for view in &views {
        let touched = drawing.settle(view)?;
        working_sets.add(touched);
        let image = drawing.picture(view)?;
        done += u64::from(image.width) * u64::from(image.height);
        sink(RenderEvent::Image(image));
        sink(RenderEvent::Progress { done, total });
    }
    Ok(drawing.report(frame, &working_sets, milliseconds(started)))
}

/// What a frame, which has been checked, is drawn with.
pub(super) struct Setting {
    pub(super) scene: SceneNumbers<f32>,
    pub(super) views: Vec<ProjectorView>,
    /// Blending apart, which the working set tells.
    pub(super) needs: Needs,
    pub(super) tables: Tables,
}

impl Setting {
    pub(super) fn new(renderer: &Renderer, frame: &FrameState) -> Result<Self, RenderError> {
        let views = views(&renderer.display, &renderer.projectors, frame)?;
        let scene = scene_numbers(&renderer.display, frame, &renderer.residency.shape());
        let needs =
            Needs { debug: frame.debug, ..Needs::of(&frame.optics, frame.light.as_ref(), &frame.quality) };
        Ok(Self { scene, views, needs, tables: Tables::new(&frame.optics, &needs) })
    }

    /// Rays of all views.
    pub(super) fn rays(&self) -> u64 {
        self.views.iter().map(|v| u64::from(v.rays.raster[0]) * u64::from(v.rays.raster[1])).sum()
    }
}

impl<'a> FrameRules<'a> {
    /// What a frame asks of the cut; nodes blend where borders between levels may be seen.
    pub(super) fn new(renderer: &Renderer, frame: &'a FrameState, tables: &'a Tables) -> Self {
        let lod = LodRule::new(&renderer.display, frame.display_from_volume, frame.quality.lod_scale);
        Self {
            lod,
            optics: &frame.optics,
            tables,
            can_pass_over: frame.quality.step_voxels <= LONGEST_STEP_THAT_PASSES_OVER,
            is_quadrilinear: frame.quality.quadrilinear,
            blends: frame.quality.blended && !lod.is_uniform(&renderer.residency.shape()),
        }
    }
}

/// What the views sampled: together, and each for itself.
#[derive(Debug, Default)]
struct WorkingSets {
    union: HashSet<NodeKey>,
    sum: u64,
}

impl WorkingSets {
    fn add(&mut self, view: HashSet<NodeKey>) {
        self.sum += view.len() as u64;
        self.union.extend(view);
    }
}

impl<'a> Drawing<'a> {
    fn new(
        renderer: &'a mut Renderer,
        frame: &'a FrameState,
        (scene, needs): (SceneNumbers<f32>, Needs),
        tables: &'a Tables,
    ) -> Self {
        // Casts are numbered across frames, so that detail of older frames is the first to go.
        let cast = renderer.residency.set.cut.node(0).last_used;
        let rules = FrameRules::new(renderer, frame, tables);
        Self {
            scene,
            needs,
            renderer,
            rules,
            stages: Stages::default(),
            cast,
            rays: 0,
            samples: 0,
            short: HashSet::new(),
        }
    }

    /// Uploads the transfer functions and a first index.
    fn start(&mut self, frame: &FrameState) -> Result<(), RenderError> {
        let started = Instant::now();
        self.renderer.device.write_tables(self.rules.tables.clone());
        self.stages.upload_ms += milliseconds(started);
        let Renderer { residency, device, .. } = &mut *self.renderer;
        residency.start_frame(frame, &self.rules, device, &mut self.stages)
    }

    fn cast(&mut self, view: &ProjectorView, part: Part) -> Result<CastOutcome, RenderError> {
        let started = Instant::now();
        let job = CastJob {
            scene: &self.scene,
            views: std::slice::from_ref(&view.rays),
            first_picture: 0,
            needs: Needs { blends: self.renderer.residency.blends, ..self.needs },
            part,
            gather: Gather::Own,
            counts: true,
        };
        let outcome = self.renderer.device.cast(&job)?;
        self.cast += 1;
        self.rays += outcome.rays;
        self.samples += outcome.samples;
        self.stages.cast_ms += milliseconds(started);
        Ok(outcome)
    }

    /// Casts few rays of every view, and fetches what they miss, until they miss nothing or the cache is full.
    fn look(&mut self, views: &[ProjectorView], alive: &mut dyn FnMut()) -> Result<(), RenderError> {
        let first_cast = self.cast + 1;
        loop {
            let mut changed = false;
            for view in views {
                let outcome = self.cast(view, Part::Every { stride: COARSE_STRIDE })?;
                let Renderer { residency, device, .. } = &mut *self.renderer;
                let wanted = Touched::default().take_in(&mut residency.set.cut, &outcome.feedback, self.cast);
                let refined = residency.refine(&wanted, first_cast, &self.rules, device, &mut self.stages)?;
                changed |= refined.has_changed;
                alive();
            }
            if !changed {
                return Ok(());
            }
        }
    }

    /// Casts every pixel of a view, and again the tiles that missed something, until none does or the cache is full.
    fn settle(&mut self, view: &ProjectorView) -> Result<HashSet<NodeKey>, RenderError> {
        let mut missing: Option<Vec<Vec<u32>>> = None;
        let mut touched = Touched::default();
        let first_cast = self.cast + 1;
        loop {
            let part = missing.as_deref().map_or(Part::Every { stride: 1 }, Part::Tiles);
            let outcome = self.cast(view, part)?;
            let Renderer { residency, device, .. } = &mut *self.renderer;
            let wanted = touched.take_in(&mut residency.set.cut, &outcome.feedback, self.cast);
            if wanted.is_empty() {
                break;
            }
            let refined = residency.refine(&wanted, first_cast, &self.rules, device, &mut self.stages)?;
            if !refined.has_changed {
                self.short.extend(refined.without_room);
                break;
            }
            if outcome.missing_tiles.iter().all(Vec::is_empty) {
                break;
            }
            missing = Some(outcome.missing_tiles);
        }
        Ok(touched.leaves(&self.renderer.residency.set.cut))
    }

    fn picture(&mut self, view: &ProjectorView) -> Result<ProjectorImage, RenderError> {
        let started = Instant::now();
        let rgba = self.renderer.device.picture(0)?;
        self.stages.readback_ms += milliseconds(started);
        let [width, height] = view.rays.raster;
        Ok(ProjectorImage { projector: view.projector, width, height, rgba })
    }

    fn report(self, frame: &FrameState, working_sets: &WorkingSets, total_ms: f64) -> FrameReport {
        let residency = &mut self.renderer.residency;
        residency.wanted.extend(&working_sets.union);
        let shortfall = shortfall(self.short.len(), residency);
        FrameReport {
            frame: frame.index,
            backend: self.renderer.backend,
            projectors: self.renderer.projectors.clone(),
            rays: self.rays,
            samples: self.samples,
            bricks_wanted: residency.wanted.len() as u64,
            bricks_resident: residency.resident(),
            bricks_loaded: residency.bricks_loaded,
            bytes_loaded: residency.bytes_loaded,
            working_set_union: working_sets.union.len() as u64,
            working_set_sum: working_sets.sum,
            complete: shortfall.is_empty(),
            shortfall,
            damaged_bricks: residency.damage.missed(),
            damaged: residency.damage.sentences(MOST_DAMAGES),
            upkeep: None,
            stages: self.stages,
            total_ms,
        }
    }
}

/// Why a frame is not complete; empty where it is.
fn shortfall(without_room: usize, residency: &Residency) -> String {
    let full = (without_room > 0).then(|| {
        format!(
            "the brick cache is full: {without_room} nodes are shown coarser than the display resolves; make the cache larger"
        )
    });
    full.into_iter().chain(damages(residency)).collect::<Vec<_>>().join("; ")
}

/// The same of a live frame, by what rays of the frame before told, if it showed the same.
pub(super) fn live_shortfall(short: usize, is_told: bool, upkeep: &Upkeep, residency: &Residency) -> String {
    let Upkeep { in_flight, fading, .. } = upkeep;
    let root = residency.set.cut.node(0);
    let first = if root.brick.is_none() && root.is_visible {
        Some("the volume's coarsest brick has not come yet".to_owned())
    } else if short > 0 {
        Some(format!(
            "{short} nodes are shown coarser than the display resolves, {in_flight} bricks are on their way"
        ))
    } else if *fading > 0 {
        Some(format!("the detail of {fading} nodes is coming or going"))
    } else {
        (!is_told).then(|| "rays have not told yet what this frame lacks".to_owned())
    };
    first.into_iter().chain(damages(residency)).collect::<Vec<_>>().join("; ")
}

fn damages(residency: &Residency) -> Option<String> {
    let first = residency.damage.sentences(1).pop()?;
    Some(match residency.damage.missed() {
        1 => format!("a brick cannot be read, and what is coarser is shown in its place: {first}"),
        bricks => format!(
            "{bricks} bricks cannot be read, and what is coarser is shown in their place; the first of them: {first}"
        ),
    })
}
