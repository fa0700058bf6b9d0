//! Each way the finish of a projector can be wrong; each gets one sentence.

use crate::{BlackLevel, Display, Homography, MapFault, Projector, Transfer};
use glam::DVec2;
use image::{GrayImage, ImageBuffer, Luma, Rgb, RgbImage};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const HEAD: &str = r#"name = "one"
screen_width_m = 0.6
screen_height_m = 0.45
pixel_size_m = 0.0015
angular_accuracy_deg = 0.8
observer_m = [0.0, 0.0, 3.0]
eta = 1

[[projector]]
name = "left"
centre_m = [-1.0, 0.0, -6.0]
width_px = 8
height_px = 6
backend = 0
PLACE

[projector.finish]
"#;
/// Where the keys of the tests begin.
const LINE: usize = 18;

const MESH: &str = "# a mirrored projector\nmesh 3 2 # columns, rows\n0.3 0.2  0.0 0.21  -0.3 0.2\n\n0.3 -0.2 0 -21e-2 -0.3 -0.2\n";

/// A folder with a display that has these keys in the finish of its projector.
fn display(keys: &str, place: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("one.toml"), HEAD.replace("PLACE", place) + keys).unwrap();
    folder
}

fn load(folder: &TempDir) -> Result<Projector, String> {
    let path = folder.path().join("one.toml");
    let display = Display::load(&path.to_string_lossy()).map_err(|error| error.to_string())?;
    Ok(display.projectors[0].clone())
}

const RECT: &str = "screen_rect_m = [-0.3, -0.225, 0.6, 0.45]";

/// The message about keys, without the path of the display; files are written by `write`.
fn message(keys: &str, write: impl Fn(&Path)) -> String {
    let folder = display(keys, RECT);
    write(folder.path());
    let message = load(&folder).unwrap_err();
    assert!(!message.contains('\n'), "{message}");
    message.replace(&format!("{}/", folder.path().display()), "")
}

#[test]
fn a_whole_finish_is_read_with_files_beside_the_display() {
    let keys = "mesh = \"maps/left.mesh\"\nblend = \"maps/left.png\"\nblack_level = [0.01, 0, 0.02]\n\
                transfer = 2.2\ndither = true\n";
    let folder = display(keys, "");
    let maps = folder.path().join("maps");
    fs::create_dir(&maps).unwrap();
    fs::write(maps.join("left.mesh"), MESH).unwrap();
    GrayImage::from_raw(2, 1, vec![255, 51]).unwrap().save(maps.join("left.png")).unwrap();
    let projector = load(&folder).unwrap();
    let finish = &projector.finish;
    let mesh = finish.mesh.as_ref().unwrap();
    assert_eq!(mesh.size(), [3, 2]);
    assert!((mesh.screen(DVec2::new(0.0, 1.0)) - DVec2::new(0.3, -0.2)).length() < 1e-7);
    assert!((mesh.screen(DVec2::new(0.5, 0.0)) - DVec2::new(0.0, 0.21)).length() < 1e-7);
    let blend = finish.blend.as_ref().unwrap();
    assert_eq!((blend.size(), blend.shares()), ([2, 1], &[65535, 13107][..]));
    assert_eq!(finish.black, Some(BlackLevel::Level([0.01, 0.0, 0.02])));
    assert_eq!((&finish.transfer, finish.is_dithered), (&Transfer::Gamma(2.2), true));
    let whole =
        Homography::of_rectangle(DVec2::new(8.0, 6.0), DVec2::new(-0.3, -0.225), DVec2::new(0.6, 0.45));
    assert_eq!(
        projector.raster.screen_from_pixel, whole,
        "a mesh alone takes its light from the whole screen"
    );
}

#[test]
fn what_changes_nothing_is_left_out() {
    let keys = "blend = \"white.png\"\nblack_level = 0\ntransfer = \"srgb\"\ndither = false\n";
    let folder = display(keys, RECT);
    GrayImage::from_pixel(3, 3, Luma([255])).save(folder.path().join("white.png")).unwrap();
    assert_eq!(load(&folder).unwrap().finish, crate::Finish::default());
    let folder = display("black_level = \"black.png\"\n", RECT);
    GrayImage::new(3, 3).save(folder.path().join("black.png")).unwrap();
    assert_eq!(load(&folder).unwrap().finish, crate::Finish::default());
}

#[test]
fn maps_of_all_kinds_say_the_same() {
    let shares = [[0.0_f32, 0.25, 1.0], [0.5, 0.75, 0.125]];
    let codes =
        shares.as_flattened().iter().map(|share| (share * 65535.0).round() as u16).collect::<Vec<_>>();
    let deep: ImageBuffer<Luma<u16>, _> = ImageBuffer::from_raw(3, 2, codes.clone()).unwrap();
    let pfm = |scale: &str, bytes: fn(f32) -> [u8; 4]| {
        let rows = shares.iter().rev().flatten().flat_map(|&share| bytes(share));
        format!("Pf\n3 2\n{scale}\n").into_bytes().into_iter().chain(rows).collect::<Vec<u8>>()
    };
    for name in ["deep.png", "little.pfm", "big.pfm"] {
        let folder = display(&format!("blend = \"{name}\"\n"), RECT);
        deep.save(folder.path().join("deep.png")).unwrap();
        fs::write(folder.path().join("little.pfm"), pfm("-1.0", f32::to_le_bytes)).unwrap();
        fs::write(folder.path().join("big.pfm"), pfm("1.0", f32::to_be_bytes)).unwrap();
        let blend = load(&folder).unwrap().finish.blend.unwrap();
        assert_eq!((blend.size(), blend.shares()), ([3, 2], &codes[..]), "{name}");
    }
}

#[test]
fn a_map_that_is_none_is_told_with_its_key_and_file() {
    let absent = message("blend = \"no.png\"\n", |_| {});
    assert!(
        absent.starts_with(&format!("one.toml, line {LINE}: `blend` names no.png, which cannot be read ("))
    );
    let told = |keys: &str, bytes: &[u8], end: &str| {
        let message = message(keys, |folder| fs::write(folder.join("map"), bytes).unwrap());
        let key = keys.split(' ').next().unwrap();
        assert_eq!(message, format!("one.toml, line {LINE}: `{key}` names map, {end}"));
    };
    let blend = "blend = \"map\"\n";
    told(blend, b"", "which is neither a PNG nor a PFM picture; give one of these");
    told("black_level = \"map\"\n", b"GIF89a", "which is neither a PNG nor a PFM picture; give one of these");
    let colours =
        "which has colours or transparency; give a grey picture: a PNG of 8 or 16 bits, or a PFM with `Pf`";
    told(blend, b"PF\n1 1\n-1\n000000000000", colours);
    let size = "give at least 1, and at most 16777216 of them";
    told(blend, b"Pf\n0 7\n-1\n", &format!("which has 0 × 7 pixels; {size}"));
    told(blend, b"Pf\n70000 70000\n-1\n", &format!("which has 70000 × 70000 pixels; {size}"));
    told(blend, b"Pf\n2 2\n-1\n0000", "which has 1 numbers for 2 × 2 pixels; make it again");
    let head = "which is damaged (its head is no `Pf`, width, height and scale); make it again";
    for wrong in ["Pf\n2 -2\n-1\n", "Pf\n2 2\n0\n", "Pf 2 2", "Pf\n2 2\nnan\n"] {
        told(blend, wrong.as_bytes(), head);
    }
    let one = |value: f32| [b"Pf\n1 1\n-1\n".as_slice(), &value.to_le_bytes()].concat();
    told(
        blend,
        &one(f32::NAN),
        "which has NaN at column 0 and row 0 from the top (from 0); give numbers from 0 to 1",
    );
    told(
        blend,
        &one(1.5),
        "which has 1.5 at column 0 and row 0 from the top (from 0); give numbers from 0 to 1",
    );
    let cut = message(blend, |folder| {
        GrayImage::new(9, 9).save(folder.join("whole.png")).unwrap();
        let bytes = fs::read(folder.join("whole.png")).unwrap();
        fs::write(folder.join("map"), &bytes[..bytes.len() / 2]).unwrap();
    });
    assert!(cut.contains("`blend` names map, which is damaged ("), "{cut}");
    let coloured = message(blend, |folder| {
        RgbImage::from_pixel(2, 2, Rgb([1, 2, 3])).save(folder.join("c.png")).unwrap();
        fs::rename(folder.join("c.png"), folder.join("map")).unwrap();
    });
    assert!(coloured.ends_with(colours), "{coloured}");
    let long =
        message(blend, |folder| fs::File::create(folder.join("map")).unwrap().set_len(1 << 30).unwrap());
    assert!(
        long.ends_with("which cannot be read (it is longer than 64 MiB); give the path of a readable file")
    );
}

#[test]
fn a_mesh_that_is_none_is_told_with_its_line() {
    let told = |text: &str, end: &str| {
        let message =
            message("mesh = \"a.mesh\"\n", |folder| fs::write(folder.join("a.mesh"), text).unwrap());
        assert_eq!(message, format!("one.toml, line {LINE}: `mesh` names a.mesh, {end}"));
    };
    let head = MapFault::MeshHead.to_string();
    for wrong in ["", "# mesh 3 2\n", "3 2\n", "mesh 1 2\n", "mesh 3 1026\n", "mesh 3 2 1\n", "mesh 3 x\n"] {
        told(wrong, &head);
    }
    for wrong in ["0.1 x", "0.1 nan", "inf 0"] {
        let end = "which has a line 3 with other things than ordinary numbers of metres; correct it";
        told(&MESH.replacen("0.3 0.2", wrong, 1), end);
    }
    told(
        &MESH.replacen("0.3 0.2", "0.3", 1),
        "which has 11 numbers for a mesh of 3 × 2 points; give x and y of each",
    );
    told(
        "mesh 1025 1025\n0 0\n",
        "which has 2 numbers for a mesh of 1025 × 1025 points; give x and y of each",
    );
    let far = "which has a point farther away than 1000000 metres, or at no place at all; correct it";
    told(&MESH.replacen("0.3 0.2", "1e30 0.2", 1), far);
    let folded = "which folds over, or has no area, in the cell right of and below column 1 and row 0 (from 0); measure \
                  it again";
    told(&MESH.replacen("-0.3 0.2", "0.1 0.2", 1), folded);
}

#[test]
fn wrong_levels_and_curves_are_told_with_their_line() {
    let told = |keys: &str, start: &str| {
        let message = message(keys, |_| {});
        assert!(message.starts_with(&format!("one.toml, line {LINE}: {start}")), "{message}");
    };
    told(
        "black_level = 0.7\n",
        "`black_level` is 0.7; give a number of linear light from 0 to 0.5, or three of them",
    );
    told("black_level = [0.1, -0.1, 0]\n", "`black_level` is -0.1; give a number");
    told("black_level = nan\n", "`black_level` has an infinite number or NaN; give an ordinary number");
    told(
        "black_level = [0.1, 0.1]\n",
        "`black_level` cannot have this value (expected a number of linear light",
    );
    told("transfer = 0\n", "`transfer` is 0; give a gamma from 0.1 to 10");
    told("transfer = inf\n", "`transfer` has an infinite number or NaN");
    told(
        "transfer = \"rec709\"\n",
        "`transfer` cannot have this value (expected \"srgb\", a gamma from 0.1 to 10, a list",
    );
    let pairs = "`transfer` cannot have this value (expected two or more pairs of light (0 or more) and code";
    for wrong in [
        "[]",
        "[[0.0, 0]]",
        "[[0.0, 0], [0.5, 300]]",
        "[[0.0, 0], [0.5, 9.5]]",
        "[[0.0, 0], [0.6, 100], [0.5, 200]]",
        "[[0.0, 0], [0.5, 100], [0.6, 100]]",
        "{ red = [[0, 0], [1, 255]], green = [[0, 0], [1, 255]] }",
    ] {
        told(&format!("transfer = {wrong}\n"), pairs);
    }
    told("dither = 1\n", "`dither` cannot have this value");
    told(
        "gamma = 1\n",
        "`gamma` is not a key of this table; remove it, or use `mesh`, `blend`, `black_level`, `transfer`, `dither`",
    );
}

#[test]
fn measured_curves_are_read_for_one_or_three_channels() {
    let curve = "[[0.0, 0], [0.25, 100], [1.25, 255]]";
    let read = |value: &str| load(&display(&format!("transfer = {value}\n"), RECT)).unwrap().finish.transfer;
    let Transfer::Measured(all) = read(curve) else { panic!("not measured") };
    let Transfer::Measured(each) =
        read(&format!("{{ red = [[0, 3], [1, 250]], green = {curve}, blue = {curve} }}"))
    else {
        panic!("not measured")
    };
    assert_eq!((each[1].knots(), &each[2]), (&[(0.0, 0), (0.25, 100), (1.25, 255)][..], &all[0]));
    assert_eq!(each[0].knots(), [(0.0, 3), (1.0, 250)]);
}

#[test]
fn a_line_of_projectors_shares_one_finish_and_a_back_end_gets_its_own_alone() {
    let text = HEAD.split("[[projector]]").next().unwrap().to_owned()
        + "[projector_line]\ncount = 3\nfrom_m = [-1, 0, -6]\nto_m = [1, 0, -6]\nwidth_px = 8\nheight_px = 6\n\
           covers = \"screen\"\nbackends = 1\nfinish = { transfer = 1.8, dither = true }\n";
    let display = Display::from_toml(&text, "line.toml").unwrap();
    let transfers = |display: &Display| -> Vec<_> {
        display.projectors.iter().map(|projector| projector.finish.transfer.clone()).collect()
    };
    assert_eq!(transfers(&display), vec![Transfer::Gamma(1.8); 3]);
    let of_one = display.with_finishes_of(&[1]);
    assert_eq!(transfers(&of_one), [Transfer::Srgb, Transfer::Gamma(1.8), Transfer::Srgb]);
}
