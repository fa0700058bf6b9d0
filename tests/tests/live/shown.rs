//! What a GPU makes of its pictures on their way to a screen, against what the host makes of the same pictures.

use bricks::BRICK_VOXELS;
use display_config::Display;
use layout::present::Layer;
use lightloom_tests::presented::picture;
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::twin_scene::{TwinScene, view};
use lightloom_tests::{calibrated, draw};
use protocol::{AdapterWish, CodesAt, DeviceChoice, FilterChoice, SubFrame};
use renderer::device::{CacheWish, Device, DevicePicture, FinishJob, ShowJob, open_device};
use renderer::present::{Classes, Finisher, Layers, Raster, Thresholds, ease, lattice_of, reconstruct};

const SIZE: [u32; 2] = [97, 71];
/// A driver may fuse a product and a sum, and divide less exactly than the host; numbers are about 1.
const LARGEST: f32 = 4e-6;
/// Light that differs by that much crosses the edge between two codes in one pixel of some thousands.
const WRONG_CODES: f64 = 1e-3;

/// What was cast of each projector of a display, on a GPU that keeps one picture at a time.
struct Gpu {
    device: Device,
    scene: TestScene,
    twin: TwinScene,
    display: Display,
}

impl Gpu {
    fn new(display: Display) -> Self {
        let scene = scenes::shells(&display);
        let twin = TwinScene::new(&display, &scene.frame, &*scene.source);
        let slots_needed = (twin.atlas.len() / BRICK_VOXELS) as u64;
        let cache = CacheWish { bytes: 1 << 30, slots_needed, has_deviations: false };
        let open = open_device(DeviceChoice::Gpu, &AdapterWish::default(), FilterChoice::Exact, &cache);
        let mut device = open.unwrap().device;
        twin.load(&mut device);
        Self { device, scene, twin, display }
    }

    fn cast(&mut self, projector: u32) -> Vec<f32> {
        let view = view(&self.display, projector, &self.scene.frame, &*self.scene.source).rounded();
        picture(&mut self.device, self.twin.needs, &view).0
    }

    fn shown(&mut self) -> Vec<f32> {
        self.device.picture(DevicePicture::Shown(0)).unwrap().into_owned()
    }
}

/// The largest difference between two pictures.
fn apart(a: &[f32], b: &[f32]) -> f32 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

/// The pixels that are known after one sub-frame and after several, by rays and by rows.
fn known_sets() -> Vec<Classes> {
    let cast = |has_rows| SubFrame::ORDER.map(|sub| Classes::of_lattice(&lattice_of(Some(sub), has_rows)));
    let [rays, rows] = [cast(false), cast(true)];
    let columns = Classes::of_pixel(0, 0).with(Classes::of_pixel(0, 1));
    let several = [rays[0].with(rays[1]), rays[0].with(rays[1]).with(rays[2]), columns, Classes::ALL];
    rays.into_iter().chain([rows[0], rows[1]]).chain(several).collect()
}

#[test]
fn a_gpu_shows_what_the_host_would() {
    let _turn = draw::turn();
    if !draw::devices().contains(&DeviceChoice::Gpu) {
        return;
    }
    let mut gpu = Gpu::new(calibrated::display(SIZE));
    let raster = Raster::of(SIZE);
    let (mut before, mut largest, mut eased): (Option<Vec<f32>>, f32, u32) = (None, 0.0, 0);
    for (step, known) in known_sets().into_iter().cycle().take(30).enumerate() {
        // Another projector each time: what it sees moves.
        let cast = gpu.cast(step as u32 % 4);
        let most_change = [None, Some(0.02), Some(0.3)][step % 3];
        let has_before = before.is_some();
        let job = ShowJob { picture: 0, raster, known, has_before, most_change };
        let is_behind = gpu.device.show(&[job]).unwrap();
        let mut whole = reconstruct(&cast, before.as_deref(), raster, known, Thresholds::default());
        let behind = match (&before, most_change) {
            (Some(before), Some(most)) => ease(before, &mut whole, most),
            _ => false,
        };
        let shown = gpu.shown();
        assert_eq!(is_behind, [behind], "step {step}");
        eased += u32::from(behind);
        largest = largest.max(apart(&shown, &whole));
        if known == Classes::ALL && most_change.is_none() {
            assert_eq!(shown, cast, "what was cast is shown as it is");
        }
        before = Some(shown);
    }
    println!("largest difference {largest:.1e}, {eased} of 30 frames behind");
    assert!(eased > 5, "nothing was eased");
    assert!(largest <= LARGEST, "{largest:e}");
    // The same comparison with one pixel of another class.
    let cast = gpu.cast(0);
    let [known, other] = [0, 2].map(|i| known_sets()[i]);
    let job = ShowJob { picture: 0, raster, known, has_before: false, most_change: None };
    gpu.device.show(&[job]).unwrap();
    let spoiled = reconstruct(&cast, None, raster, other, Thresholds::default());
    assert!(apart(&gpu.shown(), &spoiled) > 1e3 * LARGEST, "a mistake passes");
}

/// What is laid into every third pixel of a projector's picture, more than one row of the list, and up to three things each; nothing
/// into the first projector's.
fn layers(projector: u32) -> Layers {
    let mut layers = Layers::default();
    for pixel in (0..SIZE[0] * SIZE[1]).step_by(3).take(if projector == 0 { 0 } else { usize::MAX }) {
        for one in 0..=pixel / 3 % 3 {
            let part = |of: u32| ((pixel * 7 + one * 5) % of) as f32 / of as f32;
            let alpha = part(11);
            let before = [alpha * part(3), alpha * part(5), alpha * part(13), alpha];
            layers.push(pixel, Layer { before, rgb: [part(17), part(19), part(23)], opacity: part(29) });
        }
    }
    layers
}

#[test]
fn a_gpu_makes_the_codes_that_the_host_would() {
    let _turn = draw::turn();
    if !draw::devices().contains(&DeviceChoice::Gpu) {
        return;
    }
    let mut gpu = Gpu::new(calibrated::display(SIZE));
    let raster = Raster::of(SIZE);
    let finishers: Vec<Finisher> = gpu.display.projectors.iter().map(Finisher::new).collect();
    let projectors = finishers.len() as u32;
    let layers: Vec<Layers> = (0..projectors).map(layers).collect();
    for seen in 0..projectors {
        // As if each projector showed what this one sees, all at once.
        let bare = gpu.cast(seen);
        let picture = DevicePicture::Cast(0);
        let jobs: Vec<FinishJob> = (finishers.iter().zip(&layers).enumerate())
            .map(|(view, (finisher, layers))| FinishJob { picture, raster, layers, view, finisher })
            .collect();
        let found = gpu.device.codes(&jobs, CodesAt::HOST).unwrap();
        let found: Vec<Vec<u8>> = found.into_iter().filter_map(|codes| codes.host).collect();
        assert_eq!(found.len(), jobs.len());
        for (job, codes) in jobs.iter().zip(&found) {
            let mut marked = bare.clone();
            job.layers.lay_into(&mut marked);
            let differ = |finisher: &Finisher, rgba: &[f32]| {
                let of_host = finisher.codes(rgba);
                assert_eq!(codes.len(), of_host.len());
                let pairs = || codes.iter().zip(&of_host);
                let wrong = pairs().filter(|(a, b)| a != b).count() as f64 / codes.len() as f64;
                (wrong, pairs().map(|(a, b)| a.abs_diff(*b)).max().unwrap())
            };
            let (wrong, largest) = differ(job.finisher, &marked);
            let what = format!("what {seen} sees by {}", job.view);
            println!("{what}: {wrong:.1e} of the codes differ, by {largest} at most");
            assert!(codes.iter().any(|&code| code > 100), "it is black");
            assert!(wrong <= WRONG_CODES && largest <= 1, "{what}: {wrong}, {largest}");
            if !job.layers.is_empty() {
                let (spoiled, _) = differ(job.finisher, &bare);
                assert!(spoiled > 10.0 * WRONG_CODES, "a picture without its marks passes: {spoiled}");
            }
            let (spoiled, _) = differ(&finishers[(job.view + 1) % finishers.len()], &marked);
            assert!(spoiled > 10.0 * WRONG_CODES, "another projector's finish passes: {spoiled}");
        }
    }
}
