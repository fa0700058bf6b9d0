//! From a scene to the pictures of a display's projectors: `cargo run --release -p frontend --example minimal_simulate -- DIR`.

use frontend::FrontendError;
use frontend::adapter::{self, BackendOptions, Backends};
use frontend::progress::Progress;
use frontend::scene::Scene;
use frontend::simulate::Job;
use protocol::{CasterChoice, DeviceChoice, FilterChoice, Pace};
use std::path::PathBuf;

fn main() -> Result<(), FrontendError> {
    let out = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "pictures".to_owned()));

    // A scene is a volume, its place and its look: a TOML file, a store, or, as here, a built-in volume.
    let mut scene = Scene::load("procedural:shells@64")?;
    let display = adapter::load_display("desk8")?;
    // Only an open volume knows its size and values, which placement and transfer functions depend on.
    let (facts, _) = adapter::meet_volume(&mut scene)?;

    // One back-end in this process draws all projectors.
    let backends = Backends::connect(Some(1), &display)?;
    let options = BackendOptions {
        device: DeviceChoice::Cpu,
        filter: FilterChoice::Auto,
        caster: CasterChoice::Auto,
        cache_bytes: 256 << 20,
        traces: None,
    };
    let mut drawing = backends.start(&options, &scene.volume_ref(), &display)?;

    // A job writes each picture as soon as it is final.
    let (frames, pace, debug, eyes) = (0..1, Pace::Complete, None, Vec::new());
    let remade = Default::default();
    let job =
        Job { scene, facts, display, frames, remade, pace, debug, eyes, out, exr: false, calibrated: false };
    Job::prepare_output(&job.out)?;
    let drawn = job.run(drawing.source.as_mut(), &mut Progress::new(false));
    let frames = drawing.finish(drawn)?;
    println!("{} pictures in {}", frames[0].pictures.len(), job.out.display());
    Ok(())
}
