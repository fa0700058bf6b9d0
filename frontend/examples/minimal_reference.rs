//! One pixel as the 64-bit reference sees it: `cargo run --release -p frontend --example minimal_reference`.

use bricks::LodRule;
use frontend::adapter;
use frontend::scene::{Scene, VolumeFacts};
use reference::{Integrator, Reference};
use std::error::Error;

/// Near the middle of `desk8`.
const PROJECTOR: usize = 4;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Scene::load("procedural:shells@64")?;
    let display = adapter::load_display("desk8")?;
    let volume = adapter::open_scene_volume(&scene)?;
    let frame = scene.frame(0, &display, &VolumeFacts::of(volume.as_ref()))?;

    // The rule of detail says which levels the display asks for; the reference samples the very same ones.
    let rule = LodRule::new(&display, frame.display_from_volume, frame.quality.lod_scale);
    let reference = Reference::new(volume, &frame, &rule, Integrator::default())?;

    // The ray of the middle pixel of a projector, as the model defines it.
    let raster = &display.projectors[PROJECTOR].raster;
    let (x, y) = (raster.width / 2, raster.height / 2);
    let law = display.beam_law(PROJECTOR, frame.observer_in_display, frame.eta)?;
    let ray = law.ray(display.pixel_on_screen(PROJECTOR, x, y));

    let seen = reference.radiance(ray.origin_in_display, ray.direction_in_display)?;
    println!("pixel {x}, {y} of projector {PROJECTOR}");
    println!("linear colour {:.6}, opacity {:.6}", seen.rgb, seen.opacity);
    println!("estimated error {:.1e}; within the tolerance: {}", seen.error_estimate, seen.reached);
    Ok(())
}
