//! A cache too small for the view: levels that differ for want of room blend as those that the display asks for.

use super::Renderer;
use super::test_scene::{draw, frame, options};
use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use glam::UVec3;
use protocol::{FrameState, Pace, RendererOptions};
use std::sync::Arc;

#[test]
fn levels_that_differ_for_want_of_room_blend_at_rest() {
    let source: Arc<dyn BrickSource> =
        Arc::new(ProceduralVolume::new("shells", UVec3::splat(100), 1e-3).unwrap());
    let few = RendererOptions { cache_bytes: 2 << 20, projectors: vec![0], ..options() };
    let mut renderer = Renderer::new(&few, source).unwrap().0;
    // All is asked for at one level.
    let mut view = frame(0.0);
    view.pace = Pace::Live { upload_bytes: 1 << 20, fade_s: 0.05 };
    view.quality.blended = true;
    let mut calm = 0;
    for index in 0..2000 {
        let time_s = f64::from(index) / 60.0;
        let (_, report) = draw(&mut renderer, &FrameState { index, time_s, ..view.clone() }).unwrap();
        let upkeep = report.upkeep.expect("this device draws live frames");
        let has_changed = upkeep.fading > 0 || upkeep.splits > 0 || upkeep.in_flight > 0 || index < 60;
        calm = if has_changed { 0 } else { calm + 1 };
        if calm == 30 {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    assert_eq!(calm, 30, "it comes to rest");
    let cut = renderer.engine.set.cut();
    let leaves = || cut.shown_leaves().map(|place| cut.node(place));
    let shows = |depth: u8| leaves().any(|node| node.is_visible && node.key.depth == depth);
    assert!(shows(1) && shows(2), "the cache has room for some of the finest level");
    assert!(renderer.engine.shelf.blends);
}
