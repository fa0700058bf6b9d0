//! What someone sees first of a volume: imported and drawn without any option, on `desk8`, by an eye in front of it.
//!
//! ```text
//! cargo run --release -p lightloom-tests --example first_pictures
//! ```
//!
//! Writes `first_pictures.png` beside its page, or into the present folder.

use image::{RgbImage, imageops};
use lightloom_tests::phantoms::{self, Phantom, layout_arguments};
use lightloom_tests::program::lightloom;
use lightloom_tests::results::{self, Program, Results};
use lightloom_tests::{data, program};
use std::path::{Path, PathBuf};

/// Pixels of a picture on the page.
const SIZE: [u32; 2] = [400, 300];

/// What somebody has: a file, and what has to be said of one that says nothing itself.
struct Input {
    name: &'static str,
    path: PathBuf,
    layout: Vec<String>,
}

fn main() -> Result<(), String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let mut results = Results::new(Program::Study("first_pictures"), "first_pictures", "pictures");
    results.line("| volume | what the program says of it |");
    results.line("| --- | --- |");
    let mut row = RgbImage::new(0, SIZE[1]);
    for input in inputs(folder.path()) {
        let (picture, said) = first_picture(&input, folder.path())?;
        results.line(format!("| {} | {said} |", input.name));
        row = beside(&row, &picture);
    }
    let path = results::folder().unwrap_or_default().join("first_pictures.png");
    row.save(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    results.finish()
}

fn inputs(folder: &Path) -> Vec<Input> {
    let phantoms = [phantoms::chest(), phantoms::nuclei()].map(|phantom| raw(&phantom, folder));
    let cranium = data::cranium_raw(folder).map(|path| {
        let layout = data::cranium_layout();
        Input { name: "cranium, CT", path, layout: layout_arguments(layout.dims, layout.spacing_mm) }
    });
    let mri = data::head_mri_file().map(|path| Input { name: "head, MRI", path, layout: Vec::new() });
    phantoms.into_iter().chain(cranium).chain(mri).collect()
}

/// A phantom as a raw file.
fn raw(phantom: &Phantom, folder: &Path) -> Input {
    let path = phantom.write_raw(folder);
    Input { name: phantom.name, path, layout: layout_arguments(phantom.dims, phantom.spacing_mm) }
}

/// The picture, and the program's own line about the look that it chose.
fn first_picture(input: &Input, folder: &Path) -> Result<(RgbImage, String), String> {
    let store = folder.join("first.lloom").to_string_lossy().into_owned();
    let out = folder.join("out").to_string_lossy().into_owned();
    let mut import =
        vec!["import".to_owned(), input.path.to_string_lossy().into_owned(), "-o".into(), store.clone()];
    import.extend(input.layout.clone());
    run(&import)?;
    let simulate = ["simulate", &store, "--display", "desk8", "--eye", "0,0,1.2", "--out", &out];
    let said = run(&simulate)?;
    let look = said.lines().find(|line| line.starts_with("look")).unwrap_or("no look").to_owned();
    let picture = Path::new(&out).join("frame-0000/eye-0.png");
    let picture = image::open(&picture).map_err(|error| format!("{}: {error}", picture.display()))?;
    let picture = picture.to_rgb8();
    Ok((imageops::resize(&picture, SIZE[0], SIZE[1], imageops::FilterType::Triangle), look))
}

fn run<S: AsRef<str>>(arguments: &[S]) -> Result<String, String> {
    let ran = program::run(&mut lightloom(arguments));
    if ran.code == Some(0) { Ok(ran.stdout + &ran.stderr) } else { Err(ran.stderr) }
}

fn beside(row: &RgbImage, picture: &RgbImage) -> RgbImage {
    let mut wider = RgbImage::new(row.width() + picture.width(), SIZE[1]);
    imageops::replace(&mut wider, row, 0, 0);
    imageops::replace(&mut wider, picture, i64::from(row.width()), 0);
    wider
}
