//! The feedback of a frame: one table for all its views, that nobody waits for.

use bricks::{BRICK_VOXELS, NodeKey};
use display_config::Display;
use layout::FeedbackEntry;
use lightloom_tests::draw;
use lightloom_tests::presented;
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::twin_scene::{TwinScene, View, view};
use protocol::{AdapterWish, DeviceChoice, FilterChoice};
use renderer::device::{
    CacheWish, CastJob, CastOutcome, Device, DevicePicture, FeedbackTag, Gather, NEVER, Part, TileList,
    open_device,
};
use std::time::{Duration, Instant};
use twin::Lattice;

/// A table that has not come by then never will.
const LONGEST_WAIT: Duration = Duration::from_secs(60);

/// A scene on a device, and two views of it.
struct Stage {
    scene: TwinScene,
    device: Device,
    views: Vec<View<f32>>,
}

impl Stage {
    fn new(choice: DeviceChoice) -> Self {
        let display = Display::load("desk8").unwrap().with_rasters(72, 54);
        let shells = scenes::shells(&display);
        let scene = TwinScene::new(&display, &shells.frame, &*shells.source);
        let slots = (scene.atlas.len() / BRICK_VOXELS) as u64;
        let cache = CacheWish { bytes: 1 << 30, slots_needed: slots, has_deviations: false };
        let device =
            open_device(choice, &AdapterWish::default(), FilterChoice::Exact, &cache).unwrap().device;
        let views = [1, 5].map(|p| view(&display, p, &shells.frame, &*shells.source).rounded()).to_vec();
        let mut stage = Self { scene, device, views };
        stage.load();
        stage
    }

    fn load(&mut self) {
        for (slot, samples) in (0..).zip(self.scene.atlas.chunks_exact(BRICK_VOXELS)) {
            self.device.write_brick(slot, samples);
        }
        self.device.write_tables(self.scene.tables.clone());
        self.device.write_index(&self.scene.nodes, &self.scene.cells);
    }

    /// The same volume from coarser bricks: an index of other nodes.
    fn coarsen(&mut self) {
        let display = Display::load("desk8").unwrap().with_rasters(72, 54);
        let TestScene { mut frame, source, .. } = scenes::shells(&display);
        frame.quality.lod_scale = 3.0;
        let nodes = self.scene.nodes.len();
        self.scene = TwinScene::new(&display, &frame, &*source);
        assert!(self.scene.nodes.len() < nodes, "the other index has as many nodes");
        self.load();
    }

    fn cast(&mut self, view: usize, gather: Gather, counts: bool) -> CastOutcome {
        presented::cast(&mut self.device, self.scene.needs, &self.views[view], gather, counts)
    }

    fn own(&mut self, view: usize) -> Vec<FeedbackEntry> {
        self.cast(view, Gather::Own, true).feedback
    }

    /// A frame of some views.
    fn frame(&mut self, views: &[usize]) {
        self.device.clear_feedback();
        for &view in views {
            assert!(self.cast(view, Gather::Frame, false).feedback.is_empty());
        }
        self.device.end_feedback(numbered(views.len()));
    }

    /// Asks again and again, and waits for nothing.
    fn taken(&mut self) -> Vec<FeedbackEntry> {
        let started = Instant::now();
        while started.elapsed() < LONGEST_WAIT {
            if let Some((_, table)) = self.device.take_feedback().unwrap() {
                return table;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        panic!("no table came in {LONGEST_WAIT:?}");
    }
}

/// A tag that can be told from others by its number.
fn numbered(number: usize) -> FeedbackTag {
    FeedbackTag { keys: vec![NodeKey::ROOT; number], ..FeedbackTag::default() }
}

fn union(a: &[FeedbackEntry], b: &[FeedbackEntry]) -> Vec<FeedbackEntry> {
    let both = |(a, b): (&FeedbackEntry, &FeedbackEntry)| FeedbackEntry {
        deficit_code: a.deficit_code.max(b.deficit_code),
        rays: a.rays + b.rays,
    };
    a.iter().zip(b).map(both).collect()
}

#[test]
fn a_frame_s_table_is_the_union_of_its_views() {
    let _turn = draw::turn();
    for choice in draw::devices() {
        let mut stage = Stage::new(choice);
        let own = [stage.own(0), stage.own(1)];
        assert!(own[0] != own[1], "two views that sample alike tell nothing here");
        let both = union(&own[0], &own[1]);
        stage.frame(&[0, 1]);
        assert!(stage.device.wait_feedback().unwrap().unwrap() == (numbered(2), both.clone()), "{choice:?}");
        // A cast of its own in the midst of a frame neither adds to the frame's table nor clears it.
        stage.device.clear_feedback();
        stage.cast(0, Gather::Frame, false);
        assert!(stage.own(1) == own[1], "{choice:?}");
        stage.cast(1, Gather::Frame, true);
        stage.device.end_feedback(numbered(2));
        assert!(stage.taken() == both, "{choice:?}");
        assert_eq!(stage.device.wait_feedback().unwrap(), None);
    }
}

#[test]
fn a_cast_of_a_frame_draws_the_same_and_counts_where_it_is_asked() {
    let _turn = draw::turn();
    for choice in draw::devices() {
        let mut stage = Stage::new(choice);
        let own = stage.cast(0, Gather::Own, true);
        let picture = stage.device.picture(DevicePicture::Cast(0)).unwrap().into_owned();
        let counted = stage.cast(0, Gather::Frame, true);
        assert_eq!((counted.rays, counted.samples), (own.rays, own.samples), "{choice:?}");
        assert!(own.samples > 0 && own.rays == 72 * 54);
        let plain = stage.cast(0, Gather::Frame, false);
        assert!(stage.device.picture(DevicePicture::Cast(0)).unwrap().into_owned() == picture, "{choice:?}");
        assert_eq!((plain.rays, plain.samples, plain.missing_tiles.len()), (own.rays, 0, 0), "{choice:?}");
    }
}

#[test]
fn views_cast_together_are_views_cast_one_by_one() {
    let _turn = draw::turn();
    for choice in draw::devices() {
        let mut stage = Stage::new(choice);
        let alone = [0, 1].map(|view| {
            (stage.own(view), stage.device.picture(DevicePicture::Cast(0)).unwrap().into_owned())
        });
        assert!(alone[0].1 != alone[1].1, "two views that look alike tell nothing here");
        let views = [0, 1].map(|view| stage.views[view].rays);
        let job = CastJob {
            scene: &stage.views[0].scene,
            views: &views,
            first_picture: 1,
            needs: stage.scene.needs,
            sharing: None,
            mends: false,
            part: Part::Every(Lattice::ALL),
            gather: Gather::Own,
            counts: true,
            stop: NEVER,
        };
        let both = stage.device.cast(&job).unwrap();
        assert_eq!((both.rays, both.missing_tiles.len()), (2 * 72 * 54, 2), "{choice:?}");
        assert!(both.feedback == union(&alone[0].0, &alone[1].0), "{choice:?}");
        assert!(
            stage.device.picture(DevicePicture::Cast(0)).unwrap().into_owned() == alone[1].1,
            "the picture of another cast stays"
        );
        for (index, (_, picture)) in alone.iter().enumerate() {
            assert!(
                stage.device.picture(DevicePicture::Cast(1 + index)).unwrap().into_owned() == *picture,
                "{choice:?}, view {index}"
            );
        }
        // A view without tiles keeps its picture.
        let tiles = [TileList::default(), TileList::all(1)];
        let job = CastJob {
            views: &[views[1], views[0]],
            part: Part::Tiles { lattice: Lattice::ALL, tiles: &tiles },
            ..job
        };
        assert_eq!(stage.device.cast(&job).unwrap().rays, 64, "{choice:?}");
        assert!(
            stage.device.picture(DevicePicture::Cast(1)).unwrap().into_owned() == alone[0].1,
            "{choice:?}"
        );
        let mixed = stage.device.picture(DevicePicture::Cast(2)).unwrap().into_owned();
        let pixels = |picture: &[f32]| [picture[..4 * 8].to_vec(), picture[4 * 72 * 54 - 4..].to_vec()];
        let expected = [&pixels(&alone[0].1)[0], &pixels(&alone[1].1)[1]].map(Clone::clone);
        assert!(pixels(&mixed) == expected, "{choice:?}");
    }
}

#[test]
fn tables_come_in_the_order_of_frames() {
    let _turn = draw::turn();
    for choice in draw::devices() {
        let mut stage = Stage::new(choice);
        let own = [stage.own(0), stage.own(1)];
        // Two frames are under way when the first table is asked for.
        stage.frame(&[0]);
        stage.frame(&[1]);
        assert!(stage.taken() == own[0], "{choice:?}");
        stage.frame(&[0, 1]);
        assert!(stage.taken() == own[1], "{choice:?}");
        assert!(stage.taken() == union(&own[0], &own[1]), "{choice:?}");
        assert_eq!(stage.device.take_feedback().unwrap(), None);
    }
}

#[test]
fn another_index_between_frames_is_safe() {
    let _turn = draw::turn();
    for choice in draw::devices() {
        let mut stage = Stage::new(choice);
        let fine = stage.own(0);
        stage.frame(&[0]);
        stage.coarsen();
        stage.frame(&[0]);
        let coarse = stage.own(0);
        assert!(coarse.len() < fine.len());
        assert!(stage.taken() == fine && stage.taken() == coarse, "{choice:?}");
        // An index written within a frame: what was gathered before belongs to other nodes.
        stage.device.clear_feedback();
        stage.cast(1, Gather::Frame, false);
        let TwinScene { nodes, cells, .. } = stage.scene.clone();
        stage.device.write_index(&nodes, &cells);
        stage.cast(0, Gather::Frame, false);
        stage.device.end_feedback(numbered(2));
        assert!(stage.taken() == coarse, "{choice:?}");
    }
}
