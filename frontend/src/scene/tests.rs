//! Laws of scenes and of what they refuse.

use super::text::SceneText;
use super::*;
use bricks::volume::{Space, VolumeFrame};
use display_config::{Display, Finish, Homography, Projector, Raster};
use glam::{DAffine3, DMat3, DVec3, UVec3};
use protocol::VolumeRef;
use std::path::Path;

pub(super) fn display() -> Display {
    let raster = Raster { width: 8, height: 6, screen_from_pixel: Homography(DMat3::IDENTITY), output: None };
    let projector = Projector {
        name: "p".into(),
        centre_in_display: DVec3::new(0.0, 0.0, -6.0),
        raster,
        backend: 0,
        finish: Finish::default(),
    };
    Display {
        name: "test".into(),
        width_m: 1.6,
        height_m: 0.9,
        pixel_size_m: 1.5e-3,
        angular_accuracy: 0.014,
        observer_in_display: DVec3::new(0.0, 0.0, 3.0),
        eta: 1.0,
        rate_hz: 60.0,
        projectors: vec![projector],
        adapters: Vec::new(),
    }
}

pub(super) const FACTS: VolumeFacts = VolumeFacts {
    dims: UVec3::new(256, 256, 108),
    frame: VolumeFrame {
        axes_m: DMat3::from_cols(
            DVec3::new(0.957e-3, 0.0, 0.0),
            DVec3::new(0.0, 0.957e-3, 0.0),
            DVec3::new(0.0, 0.0, 1.5e-3),
        ),
        origin_m: DVec3::ZERO,
        space: Space::Unknown,
    },
    value_range: (-1024.0, 3033.0),
};

pub(super) fn read(text: &str) -> Result<Scene, SceneError> {
    read::scene_from_text(&SceneText { file: "a.toml".into(), text: text.into() }, "a", Path::new(""))
}

pub(super) fn refusal(text: &str) -> String {
    let said = read(text).unwrap_err().to_string();
    assert!(!said.contains('\n'), "not one sentence: {said}");
    said
}

pub(super) const OPTICS: &str = "[volume]\nsource = 'a.lloom'\n[optics]\nextinction_unit = 'per_metre'\n";

#[test]
fn the_examples_are_scenes() {
    for (name, text) in [
        ("shells", include_str!("../../scenes/shells.toml")),
        ("cranium", include_str!("../../scenes/cranium.toml")),
        ("illustration", include_str!("../../scenes/illustration.toml")),
    ] {
        let scene = read(text).unwrap_or_else(|e| panic!("{name}: {e}"));
        for index in 0..scene.frame_count {
            scene.frame(index, &display(), &FACTS).unwrap_or_else(|e| panic!("{name}: {e}"));
        }
    }
}

#[test]
fn every_built_in_name_is_a_scene() {
    for name in PROCEDURAL_NAMES {
        let scene = Scene::load(&format!("procedural:{name}@128")).unwrap();
        let facts = VolumeFacts { value_range: (0.0, 1.0), dims: UVec3::splat(128), ..FACTS };
        let frame = scene.frame(0, &display(), &facts).unwrap();
        assert!(!frame.optics.is_empty_on(0.0, 1.0));
        assert!(
            matches!(scene.volume_ref(), VolumeRef::Procedural { dims, .. } if dims == UVec3::splat(128))
        );
    }
}

#[test]
fn arguments_that_are_no_scenes_are_named() {
    for (argument, word) in [
        ("procedural:shell", "shells"),
        ("procedural:shells@0", "@"),
        ("procedural:shells@big", "big"),
        ("head.nii", "head.nii"),
        ("/nowhere/a.toml", "/nowhere/a.toml"),
        ("/nowhere/a.lloom", "lightloom import"),
    ] {
        let said = Scene::load(argument).unwrap_err().to_string();
        assert!(said.contains(word), "{said}");
    }
}

#[test]
fn a_head_stands_upright_at_its_size() {
    let scene = read(
        "[volume]\nsource='a.lloom'\n[placement]\ncentre_m=[0.1,0,0.2]\nlongest_m=0.7\nup='+z'\nfront='-y'\n",
    )
    .unwrap();
    let map = scene.frame(0, &display(), &FACTS).unwrap().display_from_volume;
    assert!((map.transform_point3(0.5 * FACTS.dims.as_dvec3()) - DVec3::new(0.1, 0.0, 0.2)).length() < 1e-15);
    let up = map.transform_vector3(DVec3::new(0.0, 0.0, 108.0));
    assert!(up.y > 0.0 && up.x.abs() < 1e-15 && up.z.abs() < 1e-15);
    assert!((map.transform_vector3(DVec3::new(256.0, 0.0, 0.0)).length() - 0.7).abs() < 1e-12);
}

/// Where a volume of these facts is put by a scene at its true size, the centre 0.5 m in front of the screen.
fn placed(frame: VolumeFrame, rest: &str) -> DAffine3 {
    let text = format!("[volume]\nsource='a.lloom'\n{rest}");
    let facts = VolumeFacts { frame, ..FACTS };
    read(&text).unwrap().frame(0, &display(), &facts).unwrap().display_from_volume
}

/// A patient whose voxel axes lie along these directions (columns), voxels as in [`FACTS`].
fn patient(directions: DMat3) -> VolumeFrame {
    VolumeFrame { axes_m: directions * FACTS.frame.axes_m, space: Space::Patient, ..FACTS.frame }
}

const TRUE_SIZE: &str = "[placement]\nscale=1\ncentre_m=[0,0,0.5]\n";

#[track_caller]
fn assert_steps(map: &DAffine3, expected_mm: [[f64; 3]; 3]) {
    let found = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| 1e3 * map.transform_vector3(axis));
    for (found, expected) in found.iter().zip(expected_mm) {
        assert!((*found - DVec3::from_array(expected)).length() < 1e-12, "{found:?}, not {expected:?}");
    }
    let centre = map.transform_point3(0.5 * FACTS.dims.as_dvec3());
    assert!((centre - DVec3::new(0.0, 0.0, 0.5)).length() < 1e-15, "{centre}");
}

#[test]
fn a_patient_stands_upright_and_faces_the_viewers() {
    // Rows to the left hand, columns to the back, slices to the head: as most CT scanners write.
    let map = placed(patient(DMat3::IDENTITY), TRUE_SIZE);
    assert_steps(&map, [[0.957, 0.0, 0.0], [0.0, 0.0, -0.957], [0.0, 1.5, 0.0]]);
    // The middle of the face, and the left hand's side: 128 voxels of 0.957 mm from the centre.
    let face = map.transform_point3(DVec3::new(128.0, 0.0, 54.0));
    assert!((face - DVec3::new(0.0, 0.0, 0.5 + 0.122_496)).length() < 1e-12, "{face}");
    let left = map.transform_point3(DVec3::new(256.0, 128.0, 54.0));
    assert!((left - DVec3::new(0.122_496, 0.0, 0.5)).length() < 1e-12, "{left}");
}

#[test]
fn other_orders_of_slices_show_the_same_patient() {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    // Rows to the right hand, columns to the front: as NIfTI files mostly are.
    let right_front_up = placed(patient(DMat3::from_cols(-x, -y, z)), TRUE_SIZE);
    assert_steps(&right_front_up, [[-0.957, 0.0, 0.0], [0.0, 0.0, 0.957], [0.0, 1.5, 0.0]]);
    // Slices from the head down: a left-handed system, no mirrored patient.
    let downward = placed(patient(DMat3::from_cols(x, y, -z)), TRUE_SIZE);
    assert_steps(&downward, [[0.957, 0.0, 0.0], [0.0, 0.0, -0.957], [0.0, -1.5, 0.0]]);
    assert!(downward.matrix3.determinant() * right_front_up.matrix3.determinant() < 0.0);
    // A tilted gantry: slices are sheared along the back.
    let tilted = placed(patient(DMat3::from_cols(x, y, DVec3::new(0.0, 0.6, 0.8))), TRUE_SIZE);
    assert_steps(&tilted, [[0.957, 0.0, 0.0], [0.0, 0.0, -0.957], [0.0, 1.2, -0.9]]);
}

#[test]
fn what_a_scene_says_wins_over_the_file() {
    let frame = patient(DMat3::from_cols(-DVec3::X, -DVec3::Y, DVec3::Z));
    let axes = format!("{TRUE_SIZE}up='+y'\nfront='+z'\n");
    assert_steps(&placed(frame, &axes), [[0.957, 0.0, 0.0], [0.0, 0.957, 0.0], [0.0, 0.0, 1.5]]);
    let size = format!("voxel_size_m=[0.002,0.001,0.003]\n{TRUE_SIZE}");
    assert_steps(&placed(frame, &size), [[-2.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 3.0, 0.0]]);
    // A quarter turn about the display's y comes after the patient was put upright: the front goes to the right.
    let turned = format!("{TRUE_SIZE}rotation_deg=[0,90,0]\n");
    assert_steps(&placed(frame, &turned), [[0.0, 0.0, 0.957], [0.957, 0.0, 0.0], [0.0, 1.5, 0.0]]);
}

#[test]
fn of_an_unknown_space_the_directions_count_as_they_are() {
    assert_steps(&placed(FACTS.frame, TRUE_SIZE), [[0.957, 0.0, 0.0], [0.0, 0.957, 0.0], [0.0, 0.0, 1.5]]);
    let turned =
        VolumeFrame { space: Space::Unknown, ..patient(DMat3::from_cols(DVec3::Y, DVec3::X, DVec3::Z)) };
    assert_steps(&placed(turned, TRUE_SIZE), [[0.0, 0.957, 0.0], [0.957, 0.0, 0.0], [0.0, 0.0, 1.5]]);
}

#[test]
fn a_look_relative_to_a_volume_cannot_say_what_is_empty() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let write = |text: &str| std::fs::write(&path, text).unwrap();
    write("[volume]\nsource='not-there-yet.lloom'\n");
    let said = Scene::visibility_in_file(&path).unwrap_err().to_string();
    assert!(said.contains("[optics]") && said.contains("--empty-below") && !said.contains('\n'), "{said}");
    write(&format!("{OPTICS}extinction = [[100, 0], [101, 5]]\ncolour = [[0, 1, 1, 1]]\n"));
    let shown = &Scene::visibility_in_file(&path).unwrap()[0];
    assert!(shown.is_empty_on(-5e3, 100.0) && !shown.is_empty_on(100.5, 100.6));
    assert!(Scene::load(&path.to_string_lossy()).is_err(), "its store is not there");
}

#[test]
fn keyframes_move_what_they_name_and_nothing_else() {
    let scene = read(
        "[volume]\nsource='a.lloom'\n[placement]\nscale=1\ncentre_m=[0,0,0.5]\n[frames]\ncount=3\nrate_hz=2\n\
         [[keyframe]]\ntime_s=0\nobserver_m=[-1,0,3]\n[[keyframe]]\ntime_s=1\nobserver_m=[1,0,3]\n",
    )
    .unwrap();
    let frame = |index| scene.frame(index, &display(), &FACTS).unwrap();
    assert_eq!(frame(1).observer_in_display, DVec3::new(0.0, 0.0, 3.0));
    assert_eq!(frame(2).observer_in_display.x, 1.0);
    assert_eq!(frame(0).display_from_volume, frame(2).display_from_volume);
    assert_eq!(frame(1).time_s, 0.5);
}

#[test]
fn what_is_wrong_is_said_with_line_and_key() {
    let points = "extinction = [\n[0, 0],\n[5, nan],\n]\ncolour = [[0, 1, 1, 1]]\n";
    assert_eq!(
        refusal(&format!("{OPTICS}{points}")),
        "a.toml, line 7: `optics.extinction`: control point 1 is not a finite number, or is negative; correct that point"
    );
    let said = refusal(&format!("{OPTICS}extinction = [[5, 0], [2, 1]]\ncolour = [[0, 1, 1, 1]]\n"));
    assert!(said.starts_with("a.toml, line 5: `optics.extinction`: control point 1 lies before"), "{said}");
    let said = refusal(&format!("{OPTICS}extinction = [[5, 0]]\ncolour = [[0, 1, 1]]\n"));
    assert!(said.starts_with("a.toml, line 6: `optics.colour`: a point has 3 numbers; give 4"), "{said}");
    let said = refusal("[volume]\nsource = 'a.lloom'\ncolor = 3\n");
    assert!(said.starts_with("a.toml, line 3: `volume.color`: unknown field"), "{said}");
    let said = refusal("[volume]\nsource = 3\n");
    assert!(said.starts_with("a.toml, line 2: `volume.source`: "), "{said}");
}

#[test]
fn impossible_values_are_refused() {
    let volume = "[volume]\nsource = 'a.lloom'\n";
    for (rest, place) in [
        ("[placement]\nlongest_m=1\nscale=2\n", "line 5: `placement.scale`"),
        ("[placement]\ncentre_m=[0,0,0]\n", "line 3: `placement`"),
        ("[placement]\nscale=1\nup='+z'\nfront='-z'\n", "line 5: `placement.up`"),
        ("[placement]\nscale=1\nfront='+x'\nright='+x'\n", "line 5: `placement.front`"),
        ("[placement]\nscale=-1\n", "line 4: `placement.scale`"),
        ("[display]\neta=1.5\n", "line 4: `display.eta`"),
        ("[display]\nobserver_m=[0,0,-3]\n", "line 4: `display.observer_m`"),
        ("[light]\ntoward=[0,0,0]\n", "line 4: `light.toward`"),
        ("[mimda]\ngamma=1\n", "line 3: `mimda`"),
        ("[frames]\ncount=0\n", "line 4: `frames.count`"),
        ("[[keyframe]]\ntime_s=1\n[[keyframe]]\ntime_s=1\n", "line 6: `keyframe.time_s`"),
        ("[[keyframe]]\ntime_s=1\ntool_tip_m=[0,0,1]\n", "line 5: `keyframe.tool_tip_m`"),
        ("[quality]\nstep_voxels=0\n", "line 4: `quality.step_voxels`"),
        ("[frames]\nrate_hz=1e-300\n", "line 4: `frames.rate_hz`"),
        ("this is not toml\n", "line 3"),
    ] {
        let said = refusal(&format!("{volume}{rest}"));
        assert!(said.contains(place), "{said}");
    }
}

/// What the renderer would refuse is told with its line, before there is a renderer.
#[test]
fn numbers_beyond_the_renderer_are_refused_with_line_and_key() {
    let plain = "extinction = [[0, 1]]\ncolour = [[0, 1, 1, 1]]\n";
    let light = "[light]\nambient=0.5\n";
    for (rest, place) in [
        (
            "extinction = [\n[0, 1],\n[5, 1e25],\n]\ncolour = [[0, 1, 1, 1]]\n".to_owned(),
            "line 7: `optics.extinction`",
        ),
        ("extinction = [[0, 1]]\ncolour = [[0, 1, 2e6, 1]]\n".to_owned(), "line 6: `optics.colour`"),
        (
            format!("{plain}refraction = [[0, 1], [1, 1e300]]\n"),
            "line 7: `optics.refraction`: refraction control point 1 is 1e300;",
        ),
        (format!("{plain}materials = [[0, 1, 1, 1, 2e6]]\n{light}"), "line 7: `optics.materials`"),
        (format!("{plain}[light]\nambient=1e30\n"), "line 8: `light.ambient`: ambient is 1e30; it must be"),
        (format!("{plain}[light]\ngradient_half=1e-13\n"), "line 8: `light.gradient_half`"),
        (
            format!("{plain}[light]\ndetail='unsharp'\ndetail_strength=2e6\n"),
            "line 9: `light.detail_strength`",
        ),
        (format!("{plain}[quality]\nlod_scale=2e6\n"), "line 8: `quality.lod_scale`"),
        (format!("{plain}[[enhancer]]\nkind='probe'\nradius_m=2e6\n"), "line 9: `enhancer.radius_m`"),
        (format!("{plain}[[enhancer]]\nkind='probe'\nedges=[0, 1e-60]\n"), "line 9: `enhancer.edges`"),
        (format!("{plain}[[enhancer]]\nkind='clip-plane'\nboost=2e6\n"), "line 9: `enhancer.boost`"),
        (
            format!("{plain}[[enhancer]]\nkind='clip-plane'\npoint_m=[0, 2e6, 0]\n"),
            "line 9: `enhancer.point_m`",
        ),
        (format!("{plain}[placement]\nscale=1\ncentre_m=[0, 0, -1e300]\n"), "line 9: `placement.centre_m`"),
        (format!("{plain}[[keyframe]]\ntime_s=0\nextinction=[[0, 1e25]]\n"), "line 9: `keyframe.extinction`"),
    ] {
        let said = refusal(&format!("{OPTICS}{rest}"));
        assert!(said.contains(place), "{said}");
        assert!(said.len() < 300, "{said}");
    }
}

#[test]
fn lists_have_as_many_numbers_as_their_keys_take() {
    let volume = "[volume]\nsource = 'a.lloom'\n";
    for (rest, place) in [
        ("[placement]\nscale=1\ncentre_m=[0, 0, 0, nan]\n", "line 5: `placement.centre_m`"),
        ("[placement]\nscale=1\nrotation_deg=[0, 0, 0, 'a']\n", "line 5: `placement.rotation_deg`"),
        ("[[band]]\nname='a'\ncorners=[0.1, 0.2, 0.3, 0.4, 0.5]\n", "line 5: `band.corners`"),
        ("[display]\nobserver_m=[0, 0, 1, 1]\n", "line 4: `display.observer_m`"),
        ("[light]\ntoward=[0, 0, 1, 1]\n", "line 4: `light.toward`"),
        ("[[enhancer]]\nkind='probe'\nfacing=[0, 1, 2]\n", "line 5: `enhancer.facing`"),
        ("[tool]\nkind='pointer'\ntip_m=[0, 0, 1, 1]\n", "line 5: `tool.tip_m`"),
        ("[[keyframe]]\ntime_s=0\ntool_axis=[0, 0, 1, 1]\n", "line 5: `keyframe.tool_axis`"),
    ] {
        let said = refusal(&format!("{volume}{rest}"));
        assert!(said.contains(place), "{said}");
    }
    for list in ["size = [8, 8, 8, 8]", "voxel_size_m = [1, 1, 1, 1]", "voxel_size_m = [1, 1]"] {
        let said = refusal(&format!("[volume]\nsource = 'procedural:shells'\n{list}\n"));
        assert!(said.contains("line 3: `volume."), "{said}");
    }
    let domain = format!("{OPTICS}domain = [0, 1, 2]\nextinction = [[0, 1]]\ncolour = [[0, 1, 1, 1]]\n");
    assert!(refusal(&domain).contains("line 5: `optics.domain`: invalid length 3"));
}

#[test]
fn what_is_nearly_known_is_suggested() {
    let volume = "[volume]\nsource = 'a.lloom'\n";
    let band = "[[band]]\nname = 'bone'\ncorners = [0, 1, 2, 3]\n[[enhancer]]\nkind = 'band-picker'\nband = 'bones'\n";
    for (text, suggestion) in [
        ("[volume]\nsource = 'procedural:shell'\n".to_owned(), "`shell` (did you mean `shells`?)"),
        ("[volume]\nsorce = 'a.lloom'\n".to_owned(), "`sorce` (did you mean `source`?)"),
        (format!("{volume}[placement]\nscale=1\nup='+Z'\n"), "`+Z` (did you mean `+z`?)"),
        (format!("{volume}[placment]\nscale=1\n"), "`placment` (did you mean `placement`?)"),
        (format!("{volume}[quality]\npreset='finest'\n"), "`finest` (did you mean `fine`?)"),
        (format!("{volume}[[enhancer]]\nkind='clipplane'\n"), "`clipplane` (did you mean `clip-plane`?)"),
        (format!("{volume}{band}"), "`bones` (did you mean `bone`?)"),
    ] {
        let said = refusal(&text);
        assert!(said.contains(suggestion), "{said}");
    }
    assert!(!refusal(&format!("{volume}[[enhancer]]\nkind='lens'\n")).contains("did you mean"));
}

#[test]
fn a_volume_that_is_not_there_is_told_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let said = |source: &str| {
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, format!("[volume]\n\nsource = '{source}'\n")).unwrap();
        Scene::load(&path.to_string_lossy()).unwrap_err().to_string()
    };
    assert!(said("nope.lloom").contains("scene.toml, line 3: `volume.source`: there is no volume "));
    assert!(said("").contains("scene.toml, line 3: `volume.source`: it is empty"));
    assert!(said(".").contains("scene.toml, line 3: `volume.source`: there is no volume "));
}

#[test]
fn a_store_is_a_scene_whatever_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("head");
    std::fs::write(&path, "").unwrap();
    let scene = Scene::load(&path.to_string_lossy()).unwrap();
    assert_eq!((scene.name.as_str(), scene.volume), ("head", VolumeSource::Store(path)));
}
