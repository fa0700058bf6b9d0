//! What is drawn for all views of `holo72`.

use bricks::BrickSource;
use display_config::Display;
use lightloom_tests::compare::{self, TruePixel};
use lightloom_tests::{askew, scanned_head, scenes};
use protocol::FrameState;
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// Views whose pictures are compared with the reference.
pub const COMPARED: [u32; 3] = [6, 35, 60];
/// Every so many pixels of them, along x and y.
const COMPARED_STRIDE: u32 = 12;

/// The calibration of the projectors in scenes that are drawn calibrated, too.
const SEED: u64 = 7;
const CALIBRATED: [&str; 3] = ["head, semi-transparent", "head, opaque, shaded", "shells, shaded"];

/// A scene of a display.
pub struct Scene {
    pub name: String,
    pub display: Display,
    pub source: Arc<dyn BrickSource>,
    pub frame: FrameState,
    truth: OnceLock<Vec<TruePixel>>,
}

impl Scene {
    /// A scene whose truth is found once it is asked for.
    pub fn new(name: String, display: Display, source: Arc<dyn BrickSource>, frame: FrameState) -> Self {
        Self { name, display, source, frame, truth: OnceLock::new() }
    }

    /// What the compared pixels should show.
    pub fn truth(&self) -> &[TruePixel] {
        let of = || compare::truth(&self.display, &self.frame, &self.source, &COMPARED, COMPARED_STRIDE);
        self.truth.get_or_init(of)
    }
}

/// The display of them all.
pub fn display() -> Display {
    Display::load("holo72").expect("a preset")
}

/// Those of the table that are wanted, with stores in a folder.
pub fn wanted(folder: &Path) -> Vec<Scene> {
    let names = std::env::var("LIGHTLOOM_BENCH_SCENES").unwrap_or_default();
    let is_wanted = |scene: &Scene| names.is_empty() || names.split(';').any(|name| name == scene.name);
    all(folder).into_iter().filter(is_wanted).collect()
}

fn all(folder: &Path) -> Vec<Scene> {
    let display = display();
    let head: Arc<dyn BrickSource> = Arc::new(scanned_head::store(folder));
    let of_head = scanned_head::frames(&display, &*head);
    let mut all: Vec<_> = of_head.map(|(name, frame)| (name, Arc::clone(&head), frame)).into();
    let shells = scenes::shells(&display);
    all.push(("shells, shaded", shells.source, shells.frame));
    if let Some(cranium) = scenes::cranium(&display) {
        let plain = FrameState { light: None, ..cranium.frame.clone() };
        all.push(("cranium", Arc::clone(&cranium.source), plain));
        all.push(("cranium, shaded", cranium.source, cranium.frame));
    }
    let calibrated = askew::calibrated(display.clone(), SEED);
    let mut scenes = Vec::new();
    for (name, source, frame) in all {
        let scene = |name: String, display: &Display| {
            Scene::new(name, display.clone(), Arc::clone(&source), frame.clone())
        };
        scenes.push(scene(name.to_owned(), &display));
        if CALIBRATED.contains(&name) {
            scenes.push(scene(format!("{name}, calibrated"), &calibrated));
        }
    }
    scenes
}
