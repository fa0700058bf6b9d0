//! Laws of damaged bricks: they are named, drawn from their parents, and nothing else changes.

use super::Renderer;
use super::brick_ranges::BrickRanges;
use super::rules::FrameRules;
use super::test_scene::{Pictures, display, draw, frame, renderer};
use super::views::{rays_of, scene_numbers};
use crate::device::{CastJob, CpuDevice, Device, DevicePicture, Gather, NEVER, Part};
use crate::working_set::{Cut, IndexRules, ResidentBrick, build_index, refresh, settle};
use bricks::LodRule;
use bricks::is_shown;
use bricks::procedural::ProceduralVolume;
use bricks::volume::VolumeFrame;
use bricks::{Brick, BrickError, BrickSource, CellRanges, Codes, NodeKey, NodeSummary, OctreeShape};
use glam::{DVec3, UVec3};
use needs::Needs;
use needs::tables::Tables;
use protocol::FrameState;
use reference::{Integrator, Reference};
use std::sync::Arc;
use std::sync::Mutex;
use std::time::Duration;
use twin::{Lattice, ProjectorRays};

/// The shells of 100³ voxels, some bricks of which cannot be read.
struct Spoiled {
    volume: ProceduralVolume,
    broken: Vec<NodeKey>,
    /// Every brick asked for, in order.
    asked: Mutex<Vec<NodeKey>>,
    /// Makes bricks arrive in another order.
    dawdle: u32,
}

impl Spoiled {
    fn shared(broken: &[NodeKey], dawdle: u32) -> Arc<Self> {
        let volume = ProceduralVolume::new("shells", UVec3::splat(100), 1e-3).unwrap();
        Arc::new(Self { volume, broken: broken.to_vec(), asked: Mutex::default(), dawdle })
    }

    fn asked(&self) -> Vec<NodeKey> {
        std::mem::take(&mut *self.asked.lock().unwrap())
    }
}

impl BrickSource for Spoiled {
    fn shape(&self) -> OctreeShape {
        self.volume.shape()
    }

    fn frame(&self) -> VolumeFrame {
        self.volume.frame()
    }

    fn value_range(&self) -> (f64, f64) {
        self.volume.value_range()
    }

    fn summary(&self, node: NodeKey) -> NodeSummary {
        self.volume.summary(node)
    }

    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
        self.asked.lock().unwrap().push(node);
        let late = node.cell.element_sum().wrapping_mul(self.dawdle) % 4;
        std::thread::sleep(Duration::from_millis(u64::from(late)));
        match self.broken.contains(&node) {
            true => Err(BrickError::damaged(format!("brick {node:?} of shells.lloom is spoiled"))),
            false => self.volume.brick(node),
        }
    }
}

fn key(depth: u8, x: u32, y: u32, z: u32) -> NodeKey {
    NodeKey { depth, cell: UVec3::new(x, y, z) }
}

/// A cut made without the renderer: as fine as it can be where no visible node is one of `broken`.
fn limited_cut(source: &dyn BrickSource, rules: &IndexRules, broken: &[NodeKey]) -> Cut {
    let mut cut = Cut::new(source.summary(NodeKey::ROOT));
    let mut places = vec![0];
    while let Some(place) = places.pop() {
        let node = *cut.node(place);
        let shown = |key: NodeKey| is_shown(rules.optics, source.summary(key));
        let is_held_up = broken.iter().any(|&key| key.parent() == Some(node.key) && shown(key));
        if !rules.is_empty(&node) && rules.deficit(&node) > 0.0 && !is_held_up {
            let first = cut.split(place, |key| rules.shape.contains(key).then(|| source.summary(key)));
            places.extend(first..first + 8);
        }
    }
    cut
}

/// The pictures of that cut, every brick of which is resident.
fn limited_pictures(frame: &FrameState, broken: &[NodeKey]) -> Pictures {
    let source = Spoiled::shared(&[], 0);
    let (display, shape) = (display(), source.shape());
    let needs = Needs::of(&frame.optics, frame.light.as_ref(), &frame.quality);
    let tables = Tables::new(&frame.optics, &needs);
    let lod = LodRule::new(&display, frame.display_from_volume, frame.quality.lod_scale);
    let rules = IndexRules::new(&shape, &lod, &frame.optics);
    let frame_rules = FrameRules {
        lod,
        optics: &frame.optics,
        tables: &tables,
        can_pass_over: true,
        is_quadrilinear: false,
        blends: false,
        spreads: false,
    };
    let mut cut = limited_cut(&*source, &rules, broken);
    let leaves: Vec<u32> = cut.walk().filter(|&p| !rules.is_empty(cut.node(p))).collect();
    let mut device = Device::Cpu(Box::new(CpuDevice::new(leaves.len() as u32, false)));
    let mut cells = Vec::new();
    for (slot, &place) in (0..).zip(&leaves) {
        let brick = source.brick(cut.node(place).key).unwrap();
        let Codes::U16(samples) = brick.codes else { panic!("procedural bricks have 16 bits") };
        device.write_brick(slot, &samples);
        let brick = ResidentBrick { slot, low: f64::from(brick.low), span: f64::from(brick.step) * 65535.0 };
        cut.set_brick(place, brick);
        cells.extend({
            let samples = CellRanges::of_samples(&samples);
            frame_rules.visible_cells(&BrickRanges { brick, samples: &samples, deviations: None }, &[])
        });
    }
    device.write_tables(tables.clone());
    let order: Vec<u32> = cut.walk().collect();
    refresh(&mut cut, &rules, &order);
    settle(&mut cut);
    device.write_index(&build_index(&cut, &[], &rules), &cells);
    let scene = scene_numbers(&display, frame, &shape);
    let rays = rays_of(&display, frame).unwrap();
    let picture = |rays: &ProjectorRays<f32>| {
        let (views, part) = (std::slice::from_ref(rays), Part::Every(Lattice::ALL));
        let (gather, counts) = (Gather::Own, true);
        device
            .cast(&CastJob {
                scene: &scene,
                views,
                first_picture: 0,
                needs,
                sharing: None,
                mends: false,
                part,
                gather,
                counts,
                stop: NEVER,
            })
            .unwrap();
        device.picture(DevicePicture::Cast(0)).unwrap().into_owned()
    };
    rays.iter().map(picture).collect()
}

/// The largest error of a picture of projector 0 against a reference, every fourth pixel along x and y.
fn largest_error(picture: &[f32], frame: &FrameState, reference: &Reference) -> f64 {
    let display = display();
    let law = display.beam_law(0, frame.observer_in_display, frame.eta).unwrap();
    let pixels = (0..36u32).step_by(4).flat_map(|y| (0..48u32).step_by(4).map(move |x| (x, y)));
    let error = |(x, y)| {
        let ray = law.ray(display.pixel_on_screen(0, x, y));
        let truth = reference.radiance(ray.origin_in_display, ray.direction_in_display).unwrap();
        let at = 4 * (y * 48 + x) as usize;
        let found = DVec3::from_array([0, 1, 2].map(|c| f64::from(picture[at + c])));
        (found - truth.rgb).abs().max_element()
    };
    pixels.map(error).fold(0.0, f64::max)
}

/// Bricks that the cut of a renderer holds: each has a slot, and no slot is held by nothing.
#[track_caller]
fn assert_no_slot_is_lost(renderer: &Renderer) {
    let cut = renderer.engine.set.cut();
    let held = cut.walk().filter(|&place| cut.node(place).brick.is_some()).count();
    assert_eq!(renderer.engine.set.slots().used(), held as u64);
}

#[test]
fn a_damaged_brick_is_drawn_from_its_parent() {
    let (broken, frame) = ([key(2, 1, 2, 1), key(2, 2, 1, 2), key(2, 2, 2, 2)], frame(0.05));
    let whole = draw(&mut renderer(Spoiled::shared(&[], 0)), &frame).unwrap();
    assert!(whole.1.complete && whole.1.damaged.is_empty(), "{:?}", whole.1);
    assert_eq!(whole.0, limited_pictures(&frame, &[]));

    let mut renderer = renderer(Spoiled::shared(&broken, 0));
    let (pictures, report) = draw(&mut renderer, &frame).unwrap();
    assert!(!report.complete && pictures != whole.0);
    assert_eq!((report.damaged_bricks, report.damaged.len()), (3, 3));
    assert!(report.damaged[0].contains(&format!("{:?}", broken[0])), "{report:?}");
    assert!(report.shortfall.contains("3 bricks cannot be read"), "{}", report.shortfall);
    assert!(!report.shortfall.contains("cache"), "{}", report.shortfall);
    assert_eq!(pictures, limited_pictures(&frame, &broken));
    assert_no_slot_is_lost(&renderer);
}

#[test]
fn a_damaged_brick_is_asked_for_once() {
    let source = Spoiled::shared(&[key(2, 1, 2, 1)], 0);
    let mut renderer = renderer(source.clone());
    let first = draw(&mut renderer, &frame(0.05)).unwrap();
    assert_eq!(source.asked().iter().filter(|&&node| node == key(2, 1, 2, 1)).count(), 1);
    let again = draw(&mut renderer, &frame(0.05)).unwrap();
    assert_eq!(source.asked(), []);
    assert_eq!((again.0, again.1.damaged, again.1.shortfall), (first.0, first.1.damaged, first.1.shortfall));
    assert!(!again.1.complete);
    assert_no_slot_is_lost(&renderer);
}

/// Also with damage above damage, and with a whole family.
#[test]
fn the_order_of_arrival_and_other_frames_before_change_nothing() {
    let family = (0..8).map(|octant| key(1, 1, 0, 1).child(octant));
    let broken: Vec<_> = family.chain([key(2, 0, 0, 1), key(1, 0, 1, 1), key(2, 1, 3, 3)]).collect();
    let expected = limited_pictures(&frame(0.05), &broken);
    for dawdle in [0, 1, 3] {
        let mut renderer = renderer(Spoiled::shared(&broken, dawdle));
        // Little is shown first: families are whole as far as they are seen, and fall apart when more is.
        for least in [0.9, 0.6, 0.05] {
            let (pictures, report) = draw(&mut renderer, &frame(least)).unwrap();
            assert_eq!(pictures, limited_pictures(&frame(least), &broken), "{dawdle}, {least}");
            assert!(least > 0.05 || !report.complete);
            assert_no_slot_is_lost(&renderer);
        }
        assert_eq!(draw(&mut renderer, &frame(0.05)).unwrap().0, expected);
        assert_eq!(draw(&mut renderer, &frame(0.9)).unwrap().0, limited_pictures(&frame(0.9), &broken));
        assert_no_slot_is_lost(&renderer);
    }
}

/// The limit is what a cloud of default quality keeps, linear colour; the whole volume is another picture.
#[test]
fn the_reference_goes_around_damage_too() {
    let (frame, source) = (frame(0.05), Spoiled::shared(&[key(2, 1, 2, 1), key(1, 1, 0, 1)], 0));
    let lod = LodRule::new(&display(), frame.display_from_volume, frame.quality.lod_scale);
    let (pictures, _) = draw(&mut renderer(source.clone()), &frame).unwrap();
    let around = Reference::around_damage(source, &frame, &lod, Integrator::default()).unwrap();
    let error = largest_error(&pictures[0], &frame, &around);
    assert!(error < 2.0 / 255.0, "{error}");
    let whole = Reference::new(Spoiled::shared(&[], 0), &frame, &lod, Integrator::default()).unwrap();
    let canary = largest_error(&pictures[0], &frame, &whole);
    assert!(canary > 8.0 / 255.0, "{canary}");
}

#[test]
fn all_children_of_the_root_may_be_damaged() {
    let broken: Vec<_> = (0..8).map(|octant| NodeKey::ROOT.child(octant)).collect();
    let mut renderer = renderer(Spoiled::shared(&broken, 1));
    let (pictures, report) = draw(&mut renderer, &frame(0.05)).unwrap();
    assert_eq!((report.damaged_bricks, report.bricks_resident, report.complete), (8, 1, false));
    assert_eq!(pictures, limited_pictures(&frame(0.05), &broken));
    assert!(pictures[0].chunks_exact(4).any(|pixel| pixel[3] > 0.1), "the root is drawn");
}

#[test]
fn without_the_root_there_is_no_picture() {
    let source = Spoiled::shared(&[NodeKey::ROOT], 0);
    let mut renderer = renderer(source.clone());
    for _ in 0..2 {
        let error = draw(&mut renderer, &frame(0.05)).unwrap_err().to_string();
        assert!(error.contains("of shells.lloom is spoiled"), "{error}");
    }
    assert_eq!(source.asked(), [NodeKey::ROOT]);
    assert_eq!(renderer.engine.set.slots().used(), 0);
}
