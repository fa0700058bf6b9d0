//! Laws of what a scene says of refraction, materials, bands, enhancers, detail and edits between frames.

use super::tests::{FACTS, OPTICS, display, read, refusal};
use super::*;
use glam::DVec3;
use optics::{Detail, Enhancer, Material, Ramp};
use protocol::FrameState;

/// A look from which all else hangs; line 5 and 6 of what begins with [`OPTICS`].
const LOOK: &str = "extinction = [[0, 0], [1000, 5]]\ncolour = [[0, 1, 1, 1]]\n";
const BANDS: &str = "[[band]]\nname = 'bone'\ncorners = [300, 500, 3000, 3000]\n\
                     [[band]]\nname = 'skin'\ncorners = [-400, -300, 0, 100]\n";
const DOMAIN: &str = "domain = [-1000, 3000]\n";

fn scene(rest: &str) -> Scene {
    read(&format!("{OPTICS}{LOOK}{rest}")).unwrap()
}

fn frame(scene: &Scene, index: u32) -> FrameState {
    scene.frame(index, &display(), &FACTS).unwrap()
}

fn refused(rest: &str) -> String {
    refusal(&format!("{OPTICS}{LOOK}{rest}"))
}

#[test]
fn curves_of_refraction_and_materials_keep_their_data_values() {
    let rest = "refraction = [[-500, 1], [500, 1.5]]\nmaterials = [[0, 0.1, 0.2, 0.3, 4], [100, 0.3, 0.2, 0.1, 8]]\n[light]\n";
    let optics = frame(&scene(&format!("{DOMAIN}{rest}")), 0).optics;
    assert!((optics.refraction.as_ref().unwrap().at(optics.normalise(0.0)) - 1.25).abs() < 1e-12);
    let material = optics.materials.as_ref().unwrap().at(optics.normalise(50.0));
    let expected = Material { ambient: 0.2, diffuse: 0.2, specular: 0.2, shininess: 6.0 };
    for (found, expected) in material.to_array().into_iter().zip(expected.to_array()) {
        assert!((found - expected).abs() < 1e-12, "{material:?}");
    }
}

#[test]
fn the_chain_is_in_order_with_defaults_and_bands_over_s() {
    let rest = format!(
        "{DOMAIN}{BANDS}[[enhancer]]\nkind = 'layer-opacity'\nband = 'skin'\nfacing = [-1, 1]\naway = 2\n\
         [[enhancer]]\nkind = 'clip-plane'\nstrength = 0.5\n[[enhancer]]\nkind = 'probe'\ncentre_m = [0, 0.1, 0.2]\naxis = [0, 0, -2]\n\
         [placement]\nscale = 1\ncentre_m = [0.1, 0.2, 0.3]\n"
    );
    let chain = frame(&scene(&rest), 0).optics.enhancers;
    let [Enhancer::LayerOpacity(layer), Enhancer::ClipPlane(plane), Enhancer::Probe(probe)] = chain[..]
    else {
        panic!("{chain:?}");
    };
    assert_eq!(layer.band.corners(), [0.15, 0.175, 0.25, 0.275]);
    assert_eq!(
        (layer.facing, layer.away, layer.axis_in_display),
        (Ramp { low: -1.0, high: 1.0 }, 2.0, DVec3::NEG_Z)
    );
    assert_eq!((plane.point_in_display, plane.strength), (DVec3::new(0.1, 0.2, 0.3), 0.5));
    assert_eq!(plane.normal_in_display, DVec3::Z, "what lies toward the viewers is cut away");
    assert_eq!((probe.centre_in_display, probe.axis_in_display), (DVec3::new(0.0, 0.1, 0.2), DVec3::NEG_Z));
}

#[test]
fn what_the_tool_carries_goes_with_it() {
    let rest = format!(
        "{BANDS}[tool]\nkind = 'pointer'\n[[enhancer]]\nkind = 'clip-plane'\ncarried = true\n\
         [[enhancer]]\nkind = 'probe'\ncarried = true\n[[enhancer]]\nkind = 'band-picker'\nband = 'bone'\ncarried = true\n\
         [frames]\ncount = 2\nrate_hz = 1\n[[keyframe]]\ntime_s = 0\n[[keyframe]]\ntime_s = 1\n\
         tool_tip_m = [0.1, 0, 0.4]\ntool_axis = [1, 0, 0]\n"
    );
    let chain = frame(&scene(&rest), 1).optics.enhancers;
    let [Enhancer::ClipPlane(plane), Enhancer::Probe(probe), Enhancer::BandPicker(picker)] = chain[..] else {
        panic!("{chain:?}");
    };
    let tip = DVec3::new(0.1, 0.0, 0.4);
    assert_eq!((plane.point_in_display, plane.normal_in_display), (tip, DVec3::NEG_X));
    assert_eq!((probe.centre_in_display, probe.axis_in_display), (tip, DVec3::X));
    assert_eq!(picker.axis_in_display, DVec3::X);
}

#[test]
fn an_enhancer_without_a_place_goes_with_the_volume() {
    let rest = "[[enhancer]]\nkind = 'probe'\n[frames]\ncount = 2\nrate_hz = 1\n\
                [[keyframe]]\ntime_s = 0\ncentre_m = [0, 0, 0]\n[[keyframe]]\ntime_s = 1\ncentre_m = [1, 0, 0]\n";
    let Enhancer::Probe(probe) = frame(&scene(rest), 1).optics.enhancers[0] else { panic!("it is a probe") };
    assert_eq!(probe.centre_in_display, DVec3::X);
}

#[test]
fn detail_and_quadrilinear_filtering_are_read() {
    let detail = |rest: &str| scene(&format!("[light]\n{rest}")).light.unwrap().detail;
    assert_eq!(detail(""), Detail::None);
    assert_eq!(detail("detail = 'unsharp'"), Detail::Unsharp { strength: 1.0 });
    assert_eq!(detail("detail = 'exaggerated'\ndetail_strength = 3"), Detail::Exaggerated { contrast: 3.0 });
    assert!(!scene("").quality.quadrilinear && scene("[quality]\nquadrilinear = true").quality.quadrilinear);
}

/// Edits at 1 s and 2 s; frames are a second apart.
fn edited() -> Scene {
    let rest = format!(
        "importance = [[0, 0], [1000, 1]]\n[mimda]\ngamma = 0.25\n{BANDS}[[enhancer]]\nkind = 'band-picker'\nband = 'bone'\n\
         [frames]\ncount = 4\nrate_hz = 1\n[[keyframe]]\ntime_s = 1\nextinction = [[0, 7]]\nimportance = [[0, 0.5]]\ngamma = 1\n\
         refraction = [[0, 1], [1, 1.5]]\npick = 'skin'\n[[keyframe]]\ntime_s = 2\ncolour = [[0, 0, 0, 1]]\npick = 'bone'\n"
    );
    scene(&format!("{DOMAIN}{rest}"))
}

#[test]
fn edits_hold_until_the_next_keyframe_that_says_otherwise() {
    let scene = edited();
    let optics = [0, 1, 2, 3].map(|index| frame(&scene, index).optics);
    assert_eq!(optics.each_ref().map(|o| o.extinction.at(1.0)), [5.0, 7.0, 7.0, 7.0]);
    assert_eq!(optics.each_ref().map(|o| o.colour.at(0.5)), [DVec3::ONE, DVec3::ONE, DVec3::Z, DVec3::Z]);
    assert_eq!(optics.each_ref().map(|o| o.mimda.as_ref().unwrap().gamma), [0.25, 1.0, 1.0, 1.0]);
    assert_eq!(optics.each_ref().map(|o| o.mimda.as_ref().unwrap().importance.at(1.0)), [1.0, 0.5, 0.5, 0.5]);
    assert_eq!(optics.each_ref().map(|o| o.refraction.is_some()), [false, true, true, true]);
    let picked = optics.each_ref().map(|o| match o.enhancers[0] {
        Enhancer::BandPicker(picker) => picker.band.corners()[0],
        _ => panic!("it is a picker"),
    });
    assert_eq!(picked, [0.325, 0.15, 0.325, 0.325]);
}

#[test]
fn every_look_of_a_scene_counts_for_what_it_shows() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let shows = |rest: &str, low: f64, high: f64| {
        std::fs::write(&path, format!("{OPTICS}{LOOK}{rest}")).unwrap();
        !Scene::visibility_in_file(&path).unwrap().iter().all(|optics| optics.is_empty_on(low, high))
    };
    assert!(!shows("", -800.0, 0.0), "no extinction there");
    let later = "[[keyframe]]\ntime_s = 3\nextinction = [[-900, 0], [-500, 1]]\n";
    assert!(shows(later, -800.0, 0.0), "a later look shows it");
    let bends = "refraction = [[-700, 1], [-600, 1.2]]\n";
    assert!(shows(bends, -800.0, -650.0) && !shows(bends, -800.0, -700.0) && !shows(bends, -590.0, 0.0));
    let picks = format!(
        "importance = [[0, 0]]\n[mimda]\ngamma = 1\n{BANDS}[[enhancer]]\nkind = 'band-picker'\nband = 'bone'\n"
    );
    assert!(!shows(&picks, -390.0, -350.0), "bone is picked");
    let then_skin = format!("{picks}[[keyframe]]\ntime_s = 1\npick = 'skin'\n");
    assert!(shows(&then_skin, -390.0, -350.0) && !shows(&then_skin, -800.0, -410.0));
}

#[test]
fn what_cannot_be_illustrated_is_refused_with_line_and_key() {
    let (picker, probe) = ("[[enhancer]]\nkind = 'band-picker'\n", "[[enhancer]]\nkind = 'probe'\n");
    let carried = format!("[tool]\nkind = 'pointer'\n{probe}carried = true\n");
    let key = "[[keyframe]]\ntime_s = 0\n";
    for (rest, parts) in [
        ("refraction = [[0, 0]]\n".to_owned(), ["line 7: `optics.refraction`", "not above 0"]),
        ("materials = [[0, 1, 1, 1, 0.5]]\n[light]\n".to_owned(), ["line 7: `optics.materials`", "below 1"]),
        ("materials = [[0, 1, 1, 1, 1]]\n".to_owned(), ["line 7: `optics.materials`", "[light]"]),
        ("materials = [[0, 1, 1]]\n[light]\n".to_owned(), ["line 7: `optics.materials`", "give 5"]),
        (format!("{BANDS}{BANDS}"), ["line 14: `band.name`", "already"]),
        (
            "[[band]]\nname = 'a'\ncorners = [0, 2, 1, 3]\n".to_owned(),
            ["line 9: `band.corners`", "in ascending order"],
        ),
        ("[[enhancer]]\nkind = 'lens'\n".to_owned(), ["line 8: `enhancer.kind`", "unknown variant"]),
        (format!("{probe}radius = 1\n"), ["line 9: `enhancer.radius`", "unknown field"]),
        (format!("{probe}normal = [0, 0, 1]\n"), ["line 9: `enhancer.normal`", "a probe has no normal"]),
        (format!("{probe}strength = 2\n"), ["line 9: `enhancer.strength`", "from 0 to 1"]),
        (format!("{probe}facing = [1, 0]\n"), ["line 9: `enhancer.facing`", "rising"]),
        (format!("{probe}axis = [0, 0, 0]\n"), ["line 9: `enhancer.axis`", "no length"]),
        (format!("{probe}carried = true\n"), ["line 9: `enhancer.carried`", "[tool]"]),
        (format!("{carried}{probe}carried = true\n"), ["line 14: `enhancer.carried`", "at most one"]),
        (format!("{carried}centre_m = [0, 0, 0]\n"), ["line 12: `enhancer.centre_m`", "remove this line"]),
        (picker.to_owned(), ["line 8: `enhancer.kind`", "add band"]),
        (format!("{picker}band = 'bone'\n"), ["line 9: `enhancer.band`", "add a [[band]]"]),
        (format!("{BANDS}{picker}band = 'bon'\n"), ["line 15: `enhancer.band`", "bone, skin"]),
        (probe.repeat(9), ["line 24: `enhancer.kind`", "at most 8"]),
        ("[light]\ndetail_strength = 1\n".to_owned(), ["line 8: `light.detail_strength`", "unsharp"]),
        ("[light]\ndetail = 'sharp'\n".to_owned(), ["line 8: `light.detail`", "unknown variant"]),
        (format!("{key}gamma = 1\n"), ["line 9: `keyframe.gamma`", "[mimda]"]),
        (format!("{key}importance = [[0, 1]]\n"), ["line 9: `keyframe.importance`", "[mimda]"]),
        (format!("{key}refraction = [[0, -1]]\n"), ["line 9: `keyframe.refraction`", "not above 0"]),
        (format!("{BANDS}{key}pick = 'bone'\n"), ["line 15: `keyframe.pick`", "no band picker"]),
    ] {
        let said = refused(&rest);
        assert!(parts.iter().all(|part| said.contains(part)), "{parts:?}: {said}");
    }
    let said = refusal("[volume]\nsource = 'a.lloom'\n[[keyframe]]\ntime_s = 0\nextinction = [[0, 1]]\n");
    assert!(said.contains("line 5: `keyframe.extinction`") && said.contains("[optics]"), "{said}");
}
