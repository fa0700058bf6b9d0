//! Looks of the library, by rays and by planes, and which of them `auto` takes.

use crate::measure::{measure, renderer};
use crate::scene::{self, Scene};
use bricks::BrickSource;
use frontend::adapter::open_scene_volume;
use frontend::scene::{LookName, Scene as Described, VolumeFacts, read_values};
use lightloom_tests::data;
use lightloom_tests::results::{Program, Results};
use protocol::{Caster, CasterChoice};
use std::sync::Arc;

/// Looks that show something of the CT.
const OF_CT: [LookName; 7] = [
    LookName::CtBone,
    LookName::CtSkinBone,
    LookName::CtVessels,
    LookName::Tomogram,
    LookName::Mr,
    LookName::Scalar,
    LookName::Fluorescence,
];
/// Built-in volumes, drawn as they come.
const BUILT_IN: [&str; 4] = ["shells", "shells@64", "marschner-lobb", "sparse-vessels"];

pub fn run() -> Result<(), String> {
    let mut results = Results::new(Program::Bench("planes"), "planes", "looks");
    results.line("| scene | rays, s | RMS, 99.9 %, largest error of 255 | planes, s | RMS, 99.9 %, largest error of 255 | rays take times as long | `auto` takes |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: | --- |");
    let all: Vec<u32> = (0..72).collect();
    for scene in scenes()? {
        let by = |caster| {
            let (mut renderer, adapter) = renderer(&scene, caster, &all);
            (measure(&mut renderer, &scene.frame, scene.truth()), adapter)
        };
        let ((rays, adapter), (planes, _)) = (by(CasterChoice::Rays), by(CasterChoice::Planes));
        results.drawn_by(&adapter);
        results.line(format!(
            "| {} | {:.1} | {} | {:.1} | {} | {:.2} | {} |",
            scene.name,
            rays.seconds,
            rays.codes(),
            planes.seconds,
            planes.codes(),
            rays.seconds / planes.seconds,
            taken(&scene),
        ));
    }
    results.finish()
}

/// What `auto` takes. All views decide, whichever are drawn.
fn taken(scene: &Scene) -> String {
    let (mut renderer, _) = renderer(scene, CasterChoice::Auto, &[0]);
    match measure(&mut renderer, &scene.frame, &[]).report.caster {
        Caster::Planes { .. } => "planes".into(),
        rays @ (Caster::Rays | Caster::RaysBecause(_)) => rays.to_string(),
    }
}

fn scenes() -> Result<Vec<Scene>, String> {
    let mut scenes = Vec::new();
    if let Some(cranium) = data::cranium() {
        let path = cranium.path().to_string_lossy().into_owned();
        let source: Arc<dyn BrickSource> = Arc::new(cranium);
        let (values, facts) = (read_values(&*source), VolumeFacts::of(&*source));
        for look in OF_CT {
            let mut described = load(&path)?;
            described.take_look(look, &values, &facts);
            scenes.push(described_scene(format!("cranium, `{look}`"), &described, Arc::clone(&source))?);
        }
    }
    for name in BUILT_IN {
        let described = load(&format!("procedural:{name}"))?;
        let source = open_scene_volume(&described).map_err(|error| error.to_string())?;
        scenes.push(described_scene(format!("`procedural:{name}`"), &described, source)?);
    }
    Ok(scenes)
}

fn load(name: &str) -> Result<Described, String> {
    Described::load(name).map_err(|error| error.to_string())
}

fn described_scene(
    name: String,
    described: &Described,
    source: Arc<dyn BrickSource>,
) -> Result<Scene, String> {
    let display = scene::display();
    let frame = described.frame(0, &display, &VolumeFacts::of(&*source));
    Ok(Scene::new(name, display, source, frame.map_err(|error| error.to_string())?))
}
