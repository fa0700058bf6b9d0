//! Twins without the features that a scene does not need draw what the one with all of them does.

use display_config::Display;
use layout::TableEntry;
use lightloom_tests::draw;
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::techniques::{self, TECHNIQUES};
use lightloom_tests::twin_scene::{TwinScene, view};
use needs::Shading;
use optics::{Light, MimdaForm};

const PROJECTOR: u32 = 5;

/// The same scene, whose twin has to look for everything: for detail of no strength where it is lit, else for materials,
/// which nothing shows then.
fn in_full(mut twin: TwinScene) -> TwinScene {
    if twin.needs.shading == Shading::Plain {
        twin.needs.has_materials = true;
        twin.tables.materials = vec![TableEntry::default(); twin.tables.optics.len()];
    } else {
        twin.needs.shading = Shading::Unsharp;
    }
    twin
}

fn assert_same(display: &Display, scene: &TestScene) {
    let pixels: Vec<(u32, u32)> = (0..60).flat_map(|y| (y % 2..80).step_by(2).map(move |x| (x, y))).collect();
    let view = view(display, PROJECTOR, &scene.frame, &*scene.source).rounded();
    let lean = TwinScene::new(display, &scene.frame, &*scene.source);
    let full = in_full(lean.clone());
    let (lean, full) = (lean.cast(&view, &pixels), full.cast(&view, &pixels));
    let lit = lean.iter().filter(|rgba| rgba[3] > 0.0).count();
    assert!(lit > 100, "{}: {lit} pixels show anything", scene.name);
    let differ = lean.iter().zip(&full).filter(|(lean, full)| lean != full).count();
    assert_eq!(differ, 0, "{}, {:?}: pixels that differ", scene.name, scene.frame.light);
}

#[test]
fn lean_twins_draw_what_the_full_one_does_to_the_bit() {
    let _turn = draw::turn();
    let display = Display::load("desk8").unwrap().with_rasters(80, 60);
    let chains = [
        "clip plane",
        "probe",
        "band picker",
        "layer opacity",
        "picker, probe and clip plane with MImDA",
        "probe by importance",
    ];
    let base = techniques::bumps(&display);
    let mut all: Vec<TestScene> = TECHNIQUES
        .iter()
        .filter(|(name, _)| chains.contains(name))
        .map(|(name, _)| techniques::with(&base, name))
        .collect();
    for form in [MimdaForm::Paper, MimdaForm::Consistent] {
        all.extend(scenes::cranium_mimda(&display, form));
        let mut both = techniques::with(&base, chains[4]);
        both.frame.optics.enhancers.clear();
        both.frame.optics.mimda.as_mut().unwrap().form = form;
        all.push(both);
    }
    for mut scene in all {
        for light in [None, Some(Light::default())] {
            for blended in [true, false] {
                scene.frame.light = light;
                scene.frame.quality.blended = blended;
                assert_same(&display, &scene);
            }
        }
    }
}
