//! A display whose projectors are calibrated in every way that a display file knows: its files, and what they were made of.

use display_config::{BlackLevel, Display, Projector, Transfer};
use glam::DVec2;
use image::{ImageBuffer, Luma};
use std::fs;
use std::path::Path;

/// Half of the screen, metres.
const HALF_M: DVec2 = DVec2::new(0.3, 0.225);
/// Projectors: mirrored at a corner pin with a blend; through a lens with a black level, a measured curve and dither; through
/// a lens that mirrors, with all stages; and as the first displays were.
pub const CORNERS: usize = 0;
/// See [`CORNERS`].
pub const LENS: usize = 1;
/// See [`CORNERS`].
pub const MIRRORED_LENS: usize = 2;

/// Where a lens throws a place of the raster, from −1 to 1 (right, down), metres: a barrel that reaches beyond the screen.
pub fn lens(at: DVec2) -> DVec2 {
    let bent = 1.13 * at * (1.0 - 0.05 * at.length_squared());
    HALF_M * DVec2::new(bent.x + 0.012 * at.y, -bent.y + 0.008 * at.x)
}

/// The same, with left and right exchanged.
pub fn mirrored_lens(at: DVec2) -> DVec2 {
    lens(at * DVec2::new(-1.0, 1.0))
}

/// The place of a raster, in pixels, that a lens throws onto a point of the screen: by Newton's method on the lens itself.
pub fn thrown_from(lens: impl Fn(DVec2) -> DVec2, screen: DVec2, size: DVec2) -> DVec2 {
    let mut at = DVec2::ZERO;
    for _ in 0..20 {
        let miss = lens(at) - screen;
        let [along_x, along_y] = [DVec2::X, DVec2::Y].map(|axis| (lens(at + 1e-6 * axis) - lens(at)) / 1e-6);
        at -= DVec2::new(miss.perp_dot(along_y), along_x.perp_dot(miss)) / along_x.perp_dot(along_y);
    }
    (at + 1.0) / 2.0 * size
}

/// Writes the display, with projectors of so many pixels, and the maps that it names; the path of its file.
pub fn write(folder: &Path, [width, height]: [u32; 2]) -> String {
    let write = |name: &str, text: String| {
        fs::write(folder.join(name), text).expect("a temporary folder can be written")
    };
    write("lens.mesh", mesh(lens));
    write("mirrored.mesh", mesh(mirrored_lens));
    // Bright at the lower right alone: a map that is turned shows.
    let ramp =
        |x: u32, y: u32| Luma([(65535.0 * (0.5 + 0.5 * f64::from(x * y) / (15.0 * 11.0))).round() as u16]);
    let ramp: ImageBuffer<Luma<u16>, Vec<u16>> = ImageBuffer::from_fn(16, 12, ramp);
    ramp.save(folder.join("blend.png")).expect("a temporary folder can be written");
    let projector = |name: &str, x: f64, keys: &str| {
        format!(
            "[[projector]]\nname = \"{name}\"\ncentre_m = [{x}, 0.0, -1.5]\nwidth_px = {width}\nheight_px = {height}\n\
             backend = {}\n{keys}\n",
            i32::from(x > 0.0)
        )
    };
    let display =
        "name = \"calibrated\"\nscreen_width_m = 0.60\nscreen_height_m = 0.45\npixel_size_m = 0.003\n\
                   angular_accuracy_deg = 9.0\nobserver_m = [0.0, 0.0, 1.2]\neta = 1.0\n"
            .to_owned()
            + &projector(
                "corners",
                -0.36,
                "corners_m = [[0.32, 0.24], [-0.31, 0.26], [-0.33, -0.23], [0.31, -0.25]]\n[projector.finish]\n\
             blend = \"blend.png\"\ntransfer = 2.2",
            )
            + &projector(
                "lens",
                -0.12,
                "[projector.finish]\nmesh = \"lens.mesh\"\nblack_level = [0.01, 0.02, 0.03]\n\
             transfer = [[0.0, 2], [0.1, 80], [0.5, 180], [1.1, 255]]\ndither = true",
            )
            + &projector(
                "mirrored",
                0.12,
                "[projector.finish]\nmesh = \"mirrored.mesh\"\nblend = \"blend.png\"\nblack_level = 0.02\ndither = true",
            )
            + &projector("plain", 0.36, "screen_rect_m = [-0.3, -0.225, 0.6, 0.45]");
    write("calibrated.toml", display);
    folder.join("calibrated.toml").to_string_lossy().into_owned()
}

/// The display in memory.
pub fn display(size: [u32; 2]) -> Display {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    Display::load(&write(folder.path(), size)).expect("the display is right")
}

/// The text of a mesh of 33 × 25 points.
fn mesh(lens: impl Fn(DVec2) -> DVec2) -> String {
    let along = |i: u32, count: u32| 2.0 * f64::from(i) / f64::from(count - 1) - 1.0;
    let points = (0..25).flat_map(|y| (0..33).map(move |x| DVec2::new(along(x, 33), along(y, 25))));
    let lines = points.map(lens).map(|point| format!("{:.7} {:.7}\n", point.x, point.y));
    "# x and y in metres, from the top left\nmesh 33 25\n".to_owned() + &lines.collect::<String>()
}

/// The light that a code of a channel stands for, once the projector's finish is undone at a pixel: blend and black are
/// those of the display's files.
pub fn undone(projector: &Projector, [x, y]: [f64; 2], channel: usize, code: u8) -> f64 {
    let share = f64::from(code) / 255.0;
    let light = match &projector.finish.transfer {
        Transfer::Srgb if share <= 0.040_45 => share / 12.92,
        Transfer::Srgb => ((share + 0.055) / 1.055).powf(2.4),
        Transfer::Gamma(gamma) => share.powf(*gamma),
        Transfer::Measured(responses) => {
            let knots = responses[channel].knots();
            let code = f64::from(code);
            let pair = knots.windows(2).find(|pair| code <= f64::from(pair[1].1)).unwrap_or(&knots[..2]);
            let part = (code - f64::from(pair[0].1)) / f64::from(pair[1].1 - pair[0].1);
            pair[0].0 + part * (pair[1].0 - pair[0].0)
        }
    };
    let black = match &projector.finish.black {
        Some(BlackLevel::Level(level)) => f64::from(level[channel]),
        _ => 0.0,
    };
    let blend = projector.finish.blend.as_ref().map_or(1.0, |_| 0.5 + 0.5 * texel(x, 16.0) * texel(y, 12.0));
    (light - black) / (1.0 - black) / blend
}

/// How far a share of the raster is from the first pixel's centre of a map to the last one's.
fn texel(share: f64, count: f64) -> f64 {
    (share * count - 0.5).clamp(0.0, count - 1.0) / (count - 1.0)
}
