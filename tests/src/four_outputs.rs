//! Four projectors on four outputs, each turned otherwise, and what is to be seen there.

use crate::program::{LIMIT, Running, SMALL_DISPLAY, lightloom, run};
use image::RgbImage;
use std::fs;
use std::path::{Path, PathBuf};

/// Of each projector: its place on its output, degrees that it is turned by, and whether it is mirrored.
const PLACES: [(i16, i16, u32, bool); 4] =
    [(0, 0, 0, false), (17, 30, 90, false), (300, 400, 180, true), (568, 5, 270, true)];
/// Pixels of each.
const SIZE: (usize, usize) = (96, 72);

/// Writes a display for the projectors on outputs of these names into a folder, two for each of two back-ends.
pub fn turned_display(folder: &Path, names: [&str; 4]) -> String {
    let place = |(index, (x, y, turn, mirrored)): (usize, (i16, i16, u32, bool))| {
        let name = names[index];
        let keys =
            format!("name = \"{name}\", x_px = {x}, y_px = {y}, turn_deg = {turn}, mirrored = {mirrored}");
        (index / 2, keys)
    };
    display_on_outputs(folder, &PLACES.into_iter().enumerate().map(place).collect::<Vec<_>>())
}

/// What is seen of a projector, turned back: rows of the picture from its top. `pixels` has a rectangle of its output, by its
/// place, width and height.
pub fn turned_back(projector: usize, pixels: impl Fn(i16, i16, u16, u16) -> Vec<u32>) -> Vec<u32> {
    let (x, y, turn, is_mirrored) = PLACES[projector];
    let (width, height) = if turn % 180 == 0 { SIZE } else { (SIZE.1, SIZE.0) };
    let seen = pixels(x, y, width as u16, height as u16);
    // The place of each of its pixels, found by walking the picture: to its right and down, as turned.
    let at = |column: usize, row: usize| {
        let column = if is_mirrored { SIZE.0 - 1 - column } else { column };
        let (u, v) = match turn {
            0 => (column, row),
            90 => (width - 1 - row, column),
            180 => (width - 1 - column, height - 1 - row),
            _ => (row, height - 1 - column),
        };
        seen[v * width + u]
    };
    (0..SIZE.1).flat_map(|row| (0..SIZE.0).map(move |column| (column, row))).map(|(c, r)| at(c, r)).collect()
}

/// The way of pictures into windows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The CPU draws them, and they come from main memory.
    Memory,
    /// A GPU draws them and paints the windows.
    Painted,
}

impl Way {
    fn device(self) -> &'static str {
        match self {
            Self::Memory => "cpu",
            Self::Painted => "gpu",
        }
    }

    /// The arguments of a show on the outputs.
    pub fn onto_outputs<'a>(self, display: &'a str, more: &[&'a str]) -> Vec<&'a str> {
        let scene = ["drive", "procedural:shells@32", "--display", display, "--device", self.device()];
        let fixed = ["--fade", "0", "--output", "outputs", "--rate", "20", "--caster", "rays", "--json"];
        let swapchain = if self == Self::Painted { &["--swapchain", "on"][..] } else { &[] };
        [&scene, &fixed[..], swapchain, more].concat()
    }

    /// What `simulate` draws of shells there: the pixels of each of so many projectors, 0x00RRGGBB.
    pub fn complete_pictures(self, display: &str, out: &Path, projectors: usize) -> Vec<Vec<u32>> {
        let folder = out.to_string_lossy();
        let fixed = ["simulate", "procedural:shells@32", "--display", display, "--device", self.device()];
        run(&mut lightloom(&[&fixed[..], &["--out", &folder, "--quiet"]].concat())).succeeded();
        let picture = |projector: usize| {
            // As many digits as the last projector has, two at least.
            let path = out.join(format!("frame-0000/projector-{projector:02}.png"));
            pixels_of(&path)
        };
        let pictures: Vec<Vec<u32>> = (0..projectors).map(picture).collect();
        let is_lit = |picture: &Vec<u32>| picture.iter().any(|&pixel| pixel != 0);
        assert!(pictures.iter().all(is_lit), "something is to be seen");
        pictures
    }
}

/// Writes a display into a folder whose projectors, of 96 × 72 pixels, are each on an output: each with its back-end, and the keys
/// of its output.
pub fn display_on_outputs(folder: &Path, places: &[(usize, String)]) -> String {
    let (head, _) = SMALL_DISPLAY.split_once("[projector_line]").expect("its projectors are on a line");
    let projector = |(index, (backend, place)): (usize, &(usize, String))| {
        format!(
            "[[projector]]\nname = \"p{index}\"\ncentre_m = [{}, 0.0, -1.5]\nwidth_px = 96\nheight_px = 72\n\
             screen_rect_m = [-0.3, -0.225, 0.6, 0.45]\nbackend = {backend}\n\
             output = {{ {place} }}\n",
            -0.36 + 0.24 * index as f64,
        )
    };
    let path = folder.join("outputs.toml");
    let text = head.to_owned() + &places.iter().enumerate().map(projector).collect::<String>();
    fs::write(&path, text).expect("a temporary folder can be written");
    path.to_string_lossy().into_owned()
}

/// The pixels of a PNG file as a server has them: 0x00RRGGBB, by rows.
pub fn pixels_of(path: &Path) -> Vec<u32> {
    packed(&image::open(path).expect("it was written").to_rgb8())
}

/// The pixels of a picture in the same way.
pub fn packed(picture: &RgbImage) -> Vec<u32> {
    picture.pixels().map(|p| u32::from(p[0]) << 16 | u32::from(p[1]) << 8 | u32::from(p[2])).collect()
}

/// What so many projectors showed last, by a dump. A frame in which a back-end was late, or that the end of a show cut short, has not
/// all of them.
pub fn last_dumped(dump: &str, projectors: usize) -> Vec<Vec<u32>> {
    let frames = fs::read_dir(dump).expect("it was written");
    let mut frames: Vec<PathBuf> = frames.map(|entry| entry.expect("it can be read").path()).collect();
    frames.sort();
    let last = |projector: usize| {
        let in_frame = |frame: &PathBuf| frame.join(format!("projector-{projector:02}.png"));
        let last = frames.iter().rev().map(in_frame).find(|picture| picture.exists());
        pixels_of(&last.expect("each projector has shown something"))
    };
    (0..projectors).map(last).collect()
}

/// Interrupts a show, which ends well, and yields what it has said.
pub fn ended(running: Running) -> String {
    running.interrupt();
    running.finish(LIMIT).succeeded().stderr
}
