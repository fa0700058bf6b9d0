//! From a scene to the pictures of a display's projectors: `cargo run --release -p frontend --example minimal_simulate -- DIR`.

use frontend::FrontendError;
use frontend::adapter::{self, BackendOptions, Backends};
use frontend::progress::Progress;
use frontend::scene::{Scene, VolumeFacts};
use frontend::simulate::Job;
use protocol::{DeviceChoice, FilterChoice};
use std::path::PathBuf;

fn main() -> Result<(), FrontendError> {
    let out = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "pictures".to_owned()));

    // A scene is a volume, its place and its look: a TOML file, a store, or, as here, a built-in volume.
    let scene = Scene::load("procedural:shells@64")?;
    let display = adapter::load_display("desk8")?;
    // Only an open volume knows its size and values, which placement and transfer functions depend on.
    let volume = adapter::open_volume(&scene.volume_ref())?;
    let frame = scene.frame(0, &display, &VolumeFacts::of(volume.as_ref()))?;

    // One back-end in this process draws all projectors.
    let backends = Backends::connect(Some(1))?;
    let wiring = backends.wiring(&display)?;
    let options = BackendOptions {
        device: DeviceChoice::Cpu,
        filter: FilterChoice::Auto,
        cache_bytes: 256 << 20,
        traces: None,
    };
    let (mut source, _) = backends.start(&options, &scene.volume_ref(), &display, &wiring)?;

    // A job writes each picture as soon as it is final.
    let job = Job { display, frames: vec![frame], eyes: Vec::new(), out, exr: false };
    Job::prepare_output(&job.out)?;
    let frames = job.run(source.as_mut(), &mut Progress::new(false))?;
    source.finish()?;
    println!("{} pictures in {}", frames[0].pictures.len(), job.out.display());
    Ok(())
}
