//! Row planes of displays whose projectors differ: at several distances from the screen, and calibrated.

use super::planes::promised;
use display_config::Display;
use lightloom_tests::askew;
use lightloom_tests::compare::{Errors, errors, truth};
use lightloom_tests::draw::{self, With, draw};
use lightloom_tests::scenes::{self, TestScene};
use protocol::{Caster, CasterChoice};

const ALL: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];
const COMPARED: [u32; 2] = [4, 5];
const SEED: u64 = 7;

fn calibrated() -> Display {
    askew::calibrated(scenes::small_desk8(160, 120), SEED)
}

/// Errors of a scene's pictures, and what cast them.
fn drawn(display: &Display, scene: &TestScene, with: With) -> (Errors, Caster) {
    let truth = truth(display, &scene.frame, &scene.source, &COMPARED, 3);
    let drawn = draw(display, &scene.frame, &scene.source, &ALL, with);
    assert!(drawn.report.complete, "{}", drawn.report.shortfall);
    (errors(&drawn.images, &truth), drawn.report.caster)
}

#[test]
fn projectors_at_several_distances_share_planes_with_those_at_their_own() {
    let _turn = draw::turn();
    let even = scenes::small_desk8(64, 48);
    let display = askew::in_rows(even.clone(), &[0.0, 10.0, 0.0]);
    for (scene, _) in promised(&display) {
        let (found, caster) = drawn(&display, &scene, With::PLANES);
        let (alike, _) = drawn(&even, &scene, With::PLANES);
        println!("{:20} {found}; of one distance {alike}", scene.name);
        assert_eq!(caster, Caster::Planes { views: 8, fans: 2, resampled: 0 });
        assert_eq!(caster.to_string(), "row planes in 2 groups, for 8 views");
        // Pixels whose rays differ err as differently as the scene's parts; by chance, not by grouping.
        assert!(found.rms < 1.5 * alike.rms, "{}: {found}, {alike}", scene.name);
    }
}

#[test]
fn calibrated_projectors_keep_what_planes_promise() {
    let _turn = draw::turn();
    let display = calibrated();
    let even = scenes::small_desk8(160, 120);
    for (scene, limits) in promised(&display) {
        let (found, caster) = drawn(&display, &scene, With::PLANES);
        let (level, _) = drawn(&even, &scene, With::PLANES);
        println!("{:20} {found}; level {level}", scene.name);
        assert_eq!(caster, Caster::Planes { views: 8, fans: 1, resampled: 8 });
        assert!(limits.hold(&found), "{}: {found}", scene.name);
    }
    assert!(
        drawn(&display, &scenes::shells(&display), With::PLANES)
            .1
            .to_string()
            .contains("8 pictures are resampled")
    );
}

#[test]
fn a_calibration_that_is_not_followed_is_found() {
    let _turn = draw::turn();
    let (display, even) = (calibrated(), scenes::small_desk8(160, 120));
    let (scene, limits) = promised(&display).swap_remove(1);
    let truth = truth(&display, &scene.frame, &scene.source, &COMPARED, 3);
    let spoiled = errors(&draw(&even, &scene.frame, &scene.source, &ALL, With::PLANES).images, &truth);
    assert!(!limits.hold(&spoiled), "{spoiled}");
}

fn a_view_is_the_same_whoever_draws_the_others(display: &Display, with: With) {
    let scene = scenes::marschner_lobb(display);
    let together = draw(display, &scene.frame, &scene.source, &ALL, with).images;
    let alone = draw(display, &scene.frame, &scene.source, &[5, 2], with).images;
    for picture in &alone {
        assert!(picture.rgba == together[picture.projector as usize].rgba, "{}", picture.projector);
        assert!(picture.rgba.iter().any(|&c| c > 0.1), "a black picture proves nothing");
    }
}

#[test]
fn resampled_pictures_are_the_same_whoever_draws_the_other_projectors() {
    let _turn = draw::turn();
    a_view_is_the_same_whoever_draws_the_others(&calibrated(), With::PLANES);
}

#[test]
fn calibrated_projectors_keep_it_on_a_gpu_too() {
    if !draw::has_gpu() {
        return;
    }
    let _turn = draw::turn();
    let even = scenes::small_desk8(64, 48);
    let display = askew::calibrated(even.clone(), SEED);
    let rows = askew::in_rows(even, &[0.0, 10.0, 0.0]);
    for (scene, limits) in promised(&display) {
        let (found, caster) = drawn(&display, &scene, With::PLANES_ON_GPU);
        println!("{:20} {found}", scene.name);
        assert_eq!(caster, Caster::Planes { views: 8, fans: 1, resampled: 8 });
        assert!(limits.hold(&found), "{}: {found}", scene.name);
        // The canary: pictures for projectors that are not calibrated.
        let (level, caster) = drawn(&rows, &scene, With::PLANES_ON_GPU);
        assert_eq!(caster, Caster::Planes { views: 8, fans: 2, resampled: 0 });
        assert!(limits.hold(&level), "{}: {level}", scene.name);
        let truth = truth(&display, &scene.frame, &scene.source, &COMPARED, 3);
        let spoiled =
            errors(&draw(&rows, &scene.frame, &scene.source, &ALL, With::PLANES_ON_GPU).images, &truth);
        assert!(!limits.hold(&spoiled), "{}: {spoiled}", scene.name);
    }
    a_view_is_the_same_whoever_draws_the_others(&display, With::PLANES_ON_GPU);
}

#[test]
fn auto_counts_the_views_that_share_planes() {
    let _turn = draw::turn();
    let wide = Display::load("holo72").unwrap().with_rasters(32, 24);
    let caster = |display: Display| {
        let scene = scenes::shells(&display);
        let with = With { caster: CasterChoice::Auto, ..With::PLANES };
        draw(&display, &scene.frame, &scene.source, &[0, 5, 70], with).report.caster.to_string()
    };
    assert_eq!(caster(askew::in_rows(wide.clone(), &[0.0, 10.0])), "row planes in 2 groups, for 3 views");
    let few =
        "rays: the display's projectors differ: fewer than 24 of them share row planes, too few to save time";
    assert_eq!(caster(askew::in_rows(wide.clone(), &[0.0, 5.0, 10.0, 15.0])), few);
    let resampled = "row planes, each for 3 views; 3 pictures are resampled to calibrated rasters";
    assert_eq!(caster(askew::calibrated(wide, SEED)), resampled);
}
