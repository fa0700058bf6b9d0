//! Scenes over a cut of two depths, for what happens between them.

use crate::closure_volume::ClosureVolume;
use crate::presented::{Corner, Presented};
use crate::scenes::{self, TestScene};
use bricks::{Brick, BrickError, BrickSource, Codes, NodeKey, NodeSummary, OctreeShape};
use display_config::Display;
use glam::{DQuat, DVec3, UVec3};
use optics::{Curve, Detail, Enhancer, Light, Mimda, MimdaForm};
use protocol::FrameState;
use std::collections::HashMap;
use std::sync::{Arc, Mutex};

/// Bumps fine enough that levels differ, 112 voxels along each axis: four leaves of the finest of three depths.
pub fn busy(display: &Display) -> TestScene {
    let bumps =
        |p: DVec3| 0.5 + 0.4 * (0.35 * p.x).sin() * (0.3 * p.y + 0.5).cos() * (0.25 * p.z + 1.0).sin();
    let source: Arc<dyn BrickSource> = Arc::new(ClosureVolume::new(UVec3::splat(112), (0.0, 1.0), bumps));
    let extinction = vec![(0.2, 0.0), (0.5, 0.02), (0.7, 0.05), (1.0, 0.2)];
    scene(display, "bumps", source, &extinction)
}

/// Stripes that only coarser levels sample, at whole numbers of voxels, in the half of which the finest level shows nothing;
/// each node knows the range of its own samples and of those below it.
pub fn half_hidden(display: &Display) -> TestScene {
    let field = |p: DVec3| {
        let wave = (0.2 * p.x).sin() * (0.15 * p.y + 0.5).cos();
        let stripes = (std::f64::consts::PI * p.x).cos().powi(2);
        if p.z < 56.0 {
            0.2 + 0.05 * wave + 0.3 * stripes * (1.0 + (0.1 * p.y).sin())
        } else {
            0.5 + 0.3 * wave
        }
    };
    let volume = ClosureVolume::new(UVec3::splat(112), (0.0, 1.0), field);
    let source: Arc<dyn BrickSource> = Arc::new(WithOwnRanges::new(volume));
    scene(display, "half hidden", source, &vec![(0.4, 0.0), (0.5, 0.02), (1.0, 0.1)])
}

fn scene(
    display: &Display,
    name: &'static str,
    source: Arc<dyn BrickSource>,
    extinction: &scenes::Points,
) -> TestScene {
    let colours = vec![(0.0, [1.0, 0.3, 0.1]), (0.5, [0.2, 0.9, 0.3]), (1.0, [0.3, 0.4, 1.0])];
    let optics = scenes::optics((0.0, 1.0), extinction, &colours);
    let place = scenes::placed(&*source, 0.6 * display.height_m, DQuat::from_rotation_y(0.4));
    let frame = scenes::frame(display, place, optics, None);
    TestScene { name, source, frame }
}

/// Half of the nodes of depth 1 are split, like the black squares of a chessboard.
pub fn is_split(key: NodeKey) -> bool {
    key.depth == 0 || (key.depth == 1 && key.cell.element_sum().is_multiple_of(2))
}

/// 0 where a coarser leaf touches the corner, 1 where a finer one does, which there shows the samples of this depth alone;
/// elsewhere anything.
pub fn weight(corner: Corner) -> f64 {
    if corner.touches_coarser {
        return 0.0;
    }
    if corner.touches_finer {
        return 1.0;
    }
    let [x, y, z] = corner.point.to_array().map(u64::from);
    let hash =
        (x + 11 * (y + 11 * (z + 11 * u64::from(corner.depth))) + 7).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (hash >> 40 & 0xff) as f64 / 255.0
}

/// A scene's cut with those weights.
pub fn presented(scene: &TestScene) -> Presented {
    Presented::new(Arc::clone(&scene.source), is_split, weight)
}

/// A change of a frame that makes it look at levels in another way.
type Change = fn(&mut FrameState);

/// Every way in which kernels look at levels, by name.
pub const LOOKS: [(&str, Change); 8] = [
    ("plain", |_| {}),
    ("Phong", |frame| frame.light = Some(Light::default())),
    ("MImDA", |frame| {
        let importance = Curve::new(vec![(0.3, 0.1), (0.7, 0.8)]).expect("the points rise");
        frame.optics.mimda = Some(Mimda { importance, gamma: 0.8, form: MimdaForm::Consistent });
    }),
    ("quadrilinear", |frame| {
        frame.quality.quadrilinear = true;
        frame.quality.lod_scale = 0.6;
    }),
    ("quadrilinear, Phong", |frame| {
        frame.light = Some(Light::default());
        frame.quality.quadrilinear = true;
        frame.quality.lod_scale = 0.6;
    }),
    ("refraction", |frame| {
        let index = Curve::new(vec![(0.15, 1.0), (0.5, 1.08), (0.9, 1.12)]).expect("the points rise");
        frame.optics.refraction = Some(index);
    }),
    ("unsharp masking", |frame| {
        frame.light = Some(Light { detail: Detail::Unsharp { strength: 1.0 }, ..Light::default() });
    }),
    ("a probe", |frame| {
        frame.light = Some(Light::default());
        frame.optics.enhancers = vec![Enhancer::Probe(crate::techniques::probe())];
    }),
];

/// A source of which every node tells the range of its own samples.
struct WithOwnRanges<V> {
    volume: ClosureVolume<V>,
    known: Mutex<HashMap<NodeKey, NodeSummary>>,
}

impl<V> WithOwnRanges<V> {
    fn new(volume: ClosureVolume<V>) -> Self {
        Self { volume, known: Mutex::default() }
    }
}

impl<V: Fn(DVec3) -> f64 + Send + Sync> BrickSource for WithOwnRanges<V> {
    fn shape(&self) -> OctreeShape {
        self.volume.shape()
    }

    fn frame(&self) -> bricks::volume::VolumeFrame {
        self.volume.frame()
    }

    fn value_range(&self) -> (f64, f64) {
        self.volume.value_range()
    }

    /// An inner node's is that of all below it, too.
    fn summary(&self, node: NodeKey) -> NodeSummary {
        let known = self.known.lock().expect("nobody fails while he holds it").get(&node).copied();
        known.unwrap_or_else(|| {
            let shape = self.shape();
            let brick = self.volume.brick(node).expect("a formula has every brick");
            let Codes::U16(codes) = &brick.codes else { panic!("16 bits are the default") };
            let (least, most) = codes.iter().fold((u16::MAX, 0), |(a, b), &c| (a.min(c), b.max(c)));
            let value = |code: u16| brick.low + brick.step * f32::from(code);
            let below = (0..8).map(|octant| node.child(octant));
            let below = below.filter(|child| node.depth < shape.finest_depth() && shape.contains(*child));
            let own = NodeSummary { min: value(least), max: value(most) };
            let all = below.map(|child| self.summary(child)).fold(own, |all, child| NodeSummary {
                min: all.min.min(child.min),
                max: all.max.max(child.max),
            });
            self.known.lock().expect("nobody fails while he holds it").insert(node, all);
            all
        })
    }

    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
        self.volume.brick(node)
    }
}
