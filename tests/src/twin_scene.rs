//! A scene for the twin, put together without the renderer: the ideal cut, every brick of it resident.

use crate::compare::lod_rule;
use bricks::{BRICK_VOXELS, BrickSource, Codes, NodeKey};
use display_config::Display;
use layout::{CELL_WORDS, NodeRecord};
use needs::Needs;
use needs::tables::Tables;
use protocol::FrameState;
use rayon::prelude::*;
use renderer::working_set::{Cut, IndexRules, ResidentBrick, build_index, refresh, settle, settled_weights};
use twin::{Cast, Casting, FeedbackCell, Observer, Placement, ProjectorRays, Real, SceneNumbers, Volume};
use twin_f64::Precision;

/// All that a twin reads of a scene, for any view of it. Fields are open so that tests can spoil them.
#[derive(Clone)]
pub struct TwinScene {
    /// The spatial index.
    pub nodes: Vec<NodeRecord>,
    /// The bricks, slot by slot.
    pub atlas: Vec<u16>,
    /// Their standard deviations; empty where bricks have none.
    pub deviations: Vec<u8>,
    /// The tables.
    pub tables: Tables,
    /// The visible cells, slot by slot: all of them, so that the twin here passes over nothing.
    pub cells: Vec<u32>,
    /// What the scene needs.
    pub needs: Needs,
}

/// Pixels that a thread casts before it takes more.
const PIXELS_PER_TASK: usize = 16;

/// A scene as one projector casts it.
#[derive(Clone, Copy, Debug)]
pub struct View<F> {
    /// What all projectors share.
    pub scene: SceneNumbers<F>,
    /// The projector's own.
    pub rays: ProjectorRays<F>,
}

impl View<f64> {
    /// The same in f32, as a kernel reads it.
    pub fn rounded(&self) -> View<f32> {
        self.within()
    }

    /// The same in the numbers of a twin.
    pub fn within<F: Real>(&self) -> View<F> {
        View { scene: self.scene.rounded(), rays: self.rays.rounded() }
    }
}

impl TwinScene {
    /// The scene of `frame` on `display`.
    pub fn new(display: &Display, frame: &FrameState, source: &dyn BrickSource) -> Self {
        let needs =
            Needs { debug: frame.debug, ..Needs::of(&frame.optics, frame.light.as_ref(), &frame.quality) };
        let shape = source.shape();
        let lod = lod_rule(display, frame);
        let is_quadrilinear = frame.quality.quadrilinear;
        let blends = frame.quality.blended && !lod.is_uniform(&shape);
        let needs = Needs { blends, ..needs };
        let mut rules = IndexRules { is_quadrilinear, ..IndexRules::new(&shape, &lod, &frame.optics) };
        let mut cut = Cut::new(source.summary(NodeKey::ROOT));
        let (mut atlas, mut deviations, mut largest) = (Vec::new(), Vec::new(), Vec::new());
        let spreads = frame.quality.deviation && source.has_deviation();
        let mut places = vec![0];
        while let Some(place) = places.pop() {
            let node = *cut.node(place);
            if rules.is_empty(&node) {
                continue;
            }
            // Ancestors are looked at by scenes that filter over levels.
            let brick = resident(source, node.key, &mut atlas);
            cut.set_brick(place, brick);
            if spreads {
                largest.push(add_deviations(source, node.key, &mut deviations));
            }
            if rules.deficit(&node) > 0.0 {
                let first = cut.split(place, |key| shape.contains(key).then(|| source.summary(key)));
                places.extend(first..first + 8);
            }
        }
        let order: Vec<u32> = cut.walk().collect();
        refresh(&mut cut, &rules, &order);
        settle(&mut cut);
        let mut weights = Vec::new();
        if blends {
            weights = settled_weights(&cut, &rules, &|key| source.summary(key));
            rules.blank_slot = Some((atlas.len() / BRICK_VOXELS) as u32);
            atlas.resize(atlas.len() + BRICK_VOXELS, 0);
        }
        let nodes = build_index(&cut, &weights, &IndexRules { deviations: &largest, ..rules });
        let needs = Needs { spreads: nodes.iter().any(|node| node.deviation_scale > 0.0), ..needs };
        Self {
            nodes,
            deviations,
            cells: vec![u32::MAX; atlas.len() / BRICK_VOXELS * CELL_WORDS],
            atlas,
            tables: Tables::new(&frame.optics, &needs),
            needs,
        }
    }

    /// The colours of some pixels (x, y).
    pub fn cast<F: Precision>(&self, view: &View<F>, pixels: &[(u32, u32)]) -> Vec<[F; 4]> {
        self.cast_whole(view, pixels).into_iter().map(|cast| cast.rgba).collect()
    }

    /// All that the rays of some pixels (x, y) bring back.
    pub fn cast_whole<F: Precision>(&self, view: &View<F>, pixels: &[(u32, u32)]) -> Vec<Cast<F>> {
        let feedback: Vec<FeedbackCell> = self.nodes.iter().map(|_| FeedbackCell::default()).collect();
        let casting = self.casting(&view.scene, &feedback);
        let cast = |pixels| F::cast_pixels(&casting, &view.rays, pixels);
        pixels.par_chunks(PIXELS_PER_TASK).flat_map_iter(cast).collect()
    }

    /// All that a twin reads, with a table of feedback for the nodes.
    pub fn casting<'a, F>(
        &'a self,
        scene: &'a SceneNumbers<F>,
        feedback: &'a [FeedbackCell],
    ) -> Casting<'a, F> {
        Casting {
            scene,
            volume: Volume {
                nodes: &self.nodes,
                cells: &self.cells,
                atlas: &self.atlas,
                deviations: &self.deviations,
            },
            tables: &self.tables,
            needs: &self.needs,
            observer: Observer { feedback },
        }
    }
}

/// Puts a brick behind the others.
pub(crate) fn resident(source: &dyn BrickSource, key: NodeKey, atlas: &mut Vec<u16>) -> ResidentBrick {
    let brick = source.brick(key).expect("every brick of a test scene can be read");
    let slot = (atlas.len() / BRICK_VOXELS) as u32;
    let span = f64::from(brick.step) * f64::from(brick.codes.largest());
    match &brick.codes {
        Codes::U8(codes) => atlas.extend(codes.iter().map(|&code| u16::from(code) * 257)),
        Codes::U16(codes) => atlas.extend(codes),
    }
    ResidentBrick { slot, low: f64::from(brick.low), span }
}

/// Puts a brick's standard deviations behind the others; the largest that a code stands for, data units.
fn add_deviations(source: &dyn BrickSource, key: NodeKey, all: &mut Vec<u8>) -> f64 {
    let brick = source.brick(key).expect("every brick of a test scene can be read");
    let Some(deviation) = brick.deviation else {
        all.resize(all.len() + BRICK_VOXELS, 0);
        return 0.0;
    };
    all.extend(&deviation.codes);
    255.0 * f64::from(deviation.step)
}

/// The view of one projector.
pub fn view(display: &Display, projector: u32, frame: &FrameState, source: &dyn BrickSource) -> View<f64> {
    let law = display
        .beam_law(projector as usize, frame.observer_in_display, frame.eta)
        .expect("a test scene goes with its display");
    let shape = source.shape();
    let canonical = display.canonical_raster();
    let place = Placement {
        display_from_volume: frame.display_from_volume,
        dims: shape.dims(),
        finest_depth: shape.finest_depth(),
        voxel_m: frame.voxel_m(),
        resolution: display.resolution(),
    };
    View {
        scene: SceneNumbers::new(place, &frame.optics, frame.light, &frame.quality),
        rays: ProjectorRays::new(&canonical, &display.projectors[projector as usize], &law),
    }
}
