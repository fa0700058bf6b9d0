//! A renderer that takes the place of another one.

use super::Renderer;
use super::test_scene::{draw, frame, options};
use bricks::procedural::ProceduralVolume;
use bricks::{BrickSource, NodeKey};
use glam::UVec3;
use protocol::{FrameState, Pace};
use std::sync::Arc;
use std::time::Duration;

fn renderer() -> Renderer {
    let source: Arc<dyn BrickSource> =
        Arc::new(ProceduralVolume::new("shells", UVec3::splat(400), 2.5e-4).unwrap());
    Renderer::new(&options(), source).unwrap().0
}

/// Frames until a live picture has all its detail; between two of them all that was asked for comes.
fn frames_until_complete(renderer: &mut Renderer) -> u32 {
    for index in 0..200 {
        let pace = Pace::Live { upload_bytes: 64 << 20, fade_s: 0.0 };
        let live = FrameState { index, time_s: f64::from(index) / 60.0, pace, ..frame(0.3) };
        if draw(renderer, &live).unwrap().1.complete {
            return index;
        }
        while !renderer.engine.stock.loader.is_idle() {
            std::thread::sleep(Duration::from_millis(1));
        }
    }
    panic!("it is never complete");
}

#[test]
fn one_that_takes_the_place_of_another_fetches_what_that_showed() {
    let mut before = renderer();
    let alone = frames_until_complete(&mut before);
    let held: Vec<NodeKey> = before.shown_bricks().unwrap();
    assert_eq!(before.shown_bricks(), None, "nothing has changed since");
    let mut after = renderer();
    after.expect(held.clone());
    let soon = frames_until_complete(&mut after);
    println!("{} bricks: {alone} frames alone, {soon} after another", held.len());
    assert_eq!(after.shown_bricks().map(|bricks| bricks.len()), Some(held.len()));
    // Rays ask for each of four levels a frame or more after they have met the one before.
    assert!(soon + 3 <= alone, "{soon} {alone}");
}
