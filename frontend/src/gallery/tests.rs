//! Laws of a gallery, with a source that draws even pictures instead of volumes.

use super::*;
use crate::adapter;
use crate::scene::{Scene, VolumeFacts};
use bricks::volume::VolumeFrame;
use glam::{DVec2, UVec3};
use optics::{Enhancer, Trapezoid};
use protocol::{Draw, DrawError, FrameReport, FrameState, ProjectorImage, RenderEvent, Stages};
use std::path::Path;

const SIZE: UVec2 = UVec2::new(16, 12);

fn facts() -> VolumeFacts {
    let frame = VolumeFrame::of_voxels(DVec3::splat(1e-3));
    VolumeFacts { dims: UVec3::splat(64), frame, value_range: (0.0, 1.0) }
}

fn display() -> Display {
    with_picture_size(adapter::load_display("desk8").unwrap(), SIZE)
}

fn subject_of(scene: &Scene) -> Subject {
    Subject::new(scene, &display(), &facts()).unwrap()
}

/// A scene file over values from 0 to 1.
fn scene(optics: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let text = format!("[volume]\nsource='procedural:shells'\nsize=64\n[placement]\nlongest_m=2\n{optics}");
    std::fs::write(&path, text).unwrap();
    Scene::load(&path.to_string_lossy()).unwrap()
}

/// A skin from 0.2 on and a hundred times denser core from 0.6 on, per metre.
const SKIN_AND_CORE: &str = "[optics]\ndomain=[0,1]\nextinction_unit='per_metre'\ncolour=[[0,1,1,1]]\n\
                             extinction=[[0.2,0],[0.3,5],[0.5,5],[0.6,500],[1,500]]\n";

/// Draws each projector's pictures in one grey, and remembers the frames.
#[derive(Default)]
struct Greys {
    frames: Vec<FrameState>,
    fails_after: Option<usize>,
}

impl Draw for Greys {
    fn draw(
        &mut self,
        frame: &FrameState,
        sink: &mut dyn FnMut(RenderEvent),
    ) -> Result<Vec<FrameReport>, DrawError> {
        if self.fails_after == Some(self.frames.len()) {
            return Err(DrawError("back-end 0 died".into()));
        }
        self.frames.push(frame.clone());
        for projector in 0..8 {
            let rgba = [0.1 * projector as f32, 0.5, 0.5, 1.0].repeat((SIZE.x * SIZE.y) as usize);
            sink(RenderEvent::Image(ProjectorImage { projector, width: SIZE.x, height: SIZE.y, rgba }));
        }
        Ok(vec![account(frame.index)])
    }
}

fn account(frame: u32) -> FrameReport {
    FrameReport {
        frame,
        backend: 0,
        caster: protocol::Caster::Rays,
        projectors: (0..8).collect(),
        rays: 1000,
        samples: 12_500,
        bricks_wanted: 1,
        bricks_resident: 1,
        bricks_loaded: 1,
        bytes_loaded: 1,
        working_set_union: 1,
        working_set_sum: Some(1),
        complete: false,
        shortfall: "the cache is full <b>".into(),
        upkeep: None,
        refined: None,
        damaged_bricks: 0,
        damaged: Vec::new(),
        stages: Stages::default(),
        total_ms: 1.0,
    }
}

fn gallery(out: &Path) -> Gallery {
    let scene = Scene::load("procedural:shells@64").unwrap();
    Gallery::new("Shells <i>", subject_of(&scene), display(), out).unwrap()
}

#[test]
fn every_technique_changes_a_valid_frame_of_every_scene() {
    let file = scene(SKIN_AND_CORE);
    let built_in =
        crate::scene::PROCEDURAL_NAMES.map(|n| Scene::load(&format!("procedural:{n}@64")).unwrap());
    for scene in built_in.iter().chain([&file]) {
        let subject = subject_of(scene);
        for technique in &TECHNIQUES {
            let off = (technique.off)(&subject);
            let mut on = off.clone();
            (technique.turn_on)(&subject, &mut on);
            assert_ne!(off, on, "{}", technique.name);
            for frame in [off, on] {
                frame.optics.check().unwrap_or_else(|e| panic!("{}, {}: {e}", scene.name, technique.name));
                assert!(!frame.optics.is_empty_on(0.0, 1.0), "{}, {}", scene.name, technique.name);
            }
        }
    }
}

#[test]
fn bands_are_derived_from_the_extinction_and_the_scenes_own_win() {
    let subject = subject_of(&scene(SKIN_AND_CORE));
    let ends = |band: Trapezoid| [band.corners()[1], band.corners()[2]];
    let [low, high] = ends(subject.inner);
    assert!((low - 0.51).abs() < 2e-3 && high == 1.0, "{:?}", subject.inner);
    assert_eq!(subject.outer.corners()[..2], [0.2, 0.2]);
    assert_eq!((subject.importance.at(0.3), subject.importance.at(0.8)), (0.0, 1.0));
    let bands =
        "[[band]]\nname='a'\ncorners=[0.7,0.8,0.9,0.9]\n[[band]]\nname='b'\ncorners=[0,0.1,0.2,0.3]\n";
    let given = subject_of(&scene(&format!("{SKIN_AND_CORE}{bands}")));
    assert_eq!(given.inner.corners(), [0.7, 0.8, 0.9, 0.9]);
    assert_eq!(given.outer.corners(), [0.0, 0.1, 0.2, 0.3]);
}

#[test]
fn the_volume_fits_the_screen_and_stays_as_opaque() {
    let scene = scene(SKIN_AND_CORE);
    let subject = subject_of(&scene);
    assert!((subject.longest_m - 0.45).abs() < 1e-12, "{}", subject.longest_m);
    let full = scene.frame(0, &display(), &facts()).unwrap();
    let depth = subject.frame.optics.extinction.at(0.8) * subject.longest_m;
    assert!((depth - full.optics.extinction.at(0.8) * 2.0).abs() < 1e-9, "{depth}");
    let covered = subject.covered().optics.extinction;
    assert!((covered.at(0.4) * subject.longest_m - 200.0).abs() < 0.1, "{}", covered.at(0.4));
    assert_eq!(covered.at(0.9), subject.frame.optics.extinction.at(0.9));
    let alone = subject.inner_alone().optics.extinction;
    assert_eq!((alone.at(0.3), alone.at(0.9)), (0.0, subject.frame.optics.extinction.at(0.9)));
}

#[test]
fn eyes_spread_over_the_viewing_zone() {
    let subject = subject_of(&Scene::load("procedural:shells@64").unwrap());
    let [left, middle, right] = subject.eyes;
    let (low, high) = display().viewing_zone(1.2).unwrap();
    assert!(low < left.x && left.x < low + 0.01 && high - 0.01 < right.x && right.x < high);
    assert!(middle.x.abs() < 1e-9 && [left, middle, right].iter().all(|eye| eye.y == 0.0 && eye.z == 1.2));
    let along = |eye| subject.look_of(eye).dot(subject.look_of(0));
    let facing = subject.facing();
    assert_eq!((facing.at(along(0)), facing.at(along(2))), (1.0, 0.0));
    assert!((0.1..0.9).contains(&facing.at(along(1))), "{}", facing.at(along(1)));
}

#[test]
fn pictures_and_page_appear_and_equal_frames_are_drawn_once() {
    let folder = tempfile::tempdir().unwrap();
    let (gallery, mut source) = (gallery(folder.path()), Greys::default());
    // An earlier gallery drew what this one has drawn already.
    let earlier =
        TECHNIQUES.iter().flat_map(|technique| technique.shots()).map(|shot| format!("{shot}-left.png"));
    earlier.for_each(|name| std::fs::write(folder.path().join(name), "of an earlier gallery").unwrap());
    gallery.prepare_output().unwrap();
    let exhibits = gallery.draw(&mut source, &mut Progress::new(false)).unwrap();
    let page = std::fs::read_to_string(gallery.write_page(&exhibits, &[]).unwrap()).unwrap();
    let drawn = source.frames.len();
    assert!(drawn < 2 * TECHNIQUES.len(), "{drawn}");
    let files = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(files, 3 * drawn + 1, "three eyes a frame, and the page");
    assert!(source.frames.iter().enumerate().all(|(i, frame)| !source.frames[..i].contains(frame)));
    assert_eq!(page.matches("<img ").count(), 2 * 3 * TECHNIQUES.len());
    assert!(page.contains("12.5 samples per ray") && page.contains("Shells &lt;i&gt; before desk8"));
    assert!(page.contains("the cache is full &lt;b&gt;"));
    assert!(!page.contains("http://") && !page.contains("https://") && !page.contains("src=\"gr"));
}

#[test]
fn a_failure_leaves_whole_pictures_and_no_page() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(HTML), "of an earlier gallery").unwrap();
    let gallery = gallery(folder.path());
    gallery.prepare_output().unwrap();
    let mut source = Greys { fails_after: Some(2), ..Greys::default() };
    let error = gallery.draw(&mut source, &mut Progress::new(false)).err().unwrap().to_string();
    assert_eq!(error, "back-end 0 died");
    let names: Vec<PathBuf> =
        std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(names.len(), 6, "{names:?}");
    names.iter().for_each(|name| drop(image::open(name).unwrap()));
}

#[test]
fn an_observer_without_a_viewing_zone_is_told_so() {
    let near = scene("[display]\nobserver_m=[0,0,0.1]\n");
    let error = Subject::new(&near, &display(), &facts()).err().unwrap().to_string();
    assert!(error.contains("0.1 m") && error.contains("viewing zone") && !error.contains('\n'), "{error}");
}

#[test]
fn other_picture_sizes_light_the_same_screen() {
    let (before, after) = (adapter::load_display("desk8").unwrap(), display());
    for (old, new) in before.projectors.iter().zip(&after.projectors) {
        assert_eq!((new.raster.width, new.raster.height), (SIZE.x, SIZE.y));
        for share in [DVec2::ZERO, DVec2::new(0.3, 0.8), DVec2::ONE] {
            let on_screen =
                |raster: &display_config::Raster| raster.screen_from_pixel.apply(share * raster.size());
            assert!((on_screen(&old.raster) - on_screen(&new.raster)).length() < 1e-12);
        }
    }
}

#[test]
fn the_chain_has_three_links() {
    let subject = subject_of(&Scene::load("procedural:shells@64").unwrap());
    let mut frame = subject.covered();
    (TECHNIQUES[12].turn_on)(&subject, &mut frame);
    let [Enhancer::ClipPlane(_), Enhancer::Probe(_), Enhancer::LayerOpacity(_)] = frame.optics.enhancers[..]
    else {
        panic!("{:?}", frame.optics.enhancers);
    };
}
