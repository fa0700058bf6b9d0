//! Writes the inputs that fuzzing starts from: stores of every kind, the volume files of the tests, messages and texts.

mod messages;
mod text;

use bricks::store::{BuildOptions, CodeBits, Codec, build};
use bricks::volume::{Element, Samples, VolumeError, VolumeFrame, VolumeInfo, VolumeReader};
use flate2::read::MultiGzDecoder;
use glam::{DVec3, UVec3};
use lightloom_fuzz::format::{FORMATS, Form, number};
use std::error::Error;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Longer files make fuzzing slow.
const LONGEST: usize = 100_000;

/// A smooth field in one corner, and nothing in the others.
struct Corner(VolumeInfo);

impl VolumeReader for Corner {
    fn info(&self) -> &VolumeInfo {
        &self.0
    }

    fn read_slab(&mut self, z: u32, slab: &mut Samples) -> Result<(), VolumeError> {
        let width = self.0.dims.x as usize;
        for i in 0..slab.len() {
            let (x, y) = (i % width, i / width);
            slab.set(i, if x < 32 { (x * y + z as usize) as f64 } else { 0.0 });
        }
        Ok(())
    }
}

fn corner(dims: UVec3) -> Corner {
    let frame = VolumeFrame::of_voxels(DVec3::splat(1e-3));
    Corner(VolumeInfo::unscaled("corner", dims, frame, Element::U16))
}

fn stores(out: &Path) -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("seed.lloom");
    for bits in [CodeBits::Eight, CodeBits::Sixteen] {
        for (codec, dims) in [
            (Codec::None, UVec3::new(5, 6, 4)),
            (Codec::Lz4, UVec3::new(90, 30, 3)),
            (Codec::Zstd, UVec3::new(90, 30, 3)),
        ] {
            for has_deviation in [false, true] {
                let options = BuildOptions { bits, codec, has_deviation, ..BuildOptions::default() };
                build(&mut corner(dims), &path, &options, &|_, _| {})?;
                let name = format!("{bits:?}_{codec:?}_{has_deviation}");
                fs::write(out.join(name), [vec![0], fs::read(&path)?].concat())?;
            }
        }
    }
    let old = fs::read("tests/data/version_1.lloom")?;
    fs::write(out.join("version_1"), [vec![0], old].concat())?;
    Ok(())
}

/// The files of a folder and of those in it.
fn files(folder: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            found.append(&mut files(&path)?);
        } else {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut unpacked = Vec::new();
    MultiGzDecoder::new(bytes).read_to_end(&mut unpacked)?;
    Ok(unpacked)
}

fn volumes(out: &Path) -> Result<(), Box<dyn Error>> {
    let data = Path::new("tests/data");
    for path in files(data)? {
        let (name, bytes) = (path.strip_prefix(data)?.to_string_lossy().replace('/', "_"), fs::read(&path)?);
        let seeds: Vec<(u8, Vec<u8>)> = if path.starts_with(data.join("dicom")) {
            vec![(number("input.dcm", Form::File), bytes.clone()), (number("slice.dcm", Form::Folder), bytes)]
        } else if let Some(name) = ["zarr.json", ".zarray"].into_iter().find(|name| path.ends_with(name)) {
            vec![(number(name, Form::Zarr), [bytes, vec![0; 65]].concat())]
        } else if name.ends_with(".tif") || name.ends_with(".tiff") {
            vec![(number("input.tif", Form::File), bytes.clone()), (number("slice.tif", Form::Folder), bytes)]
        } else if name.ends_with(".gz") && (name.contains(".nii") || name.contains(".hdr")) {
            let packed = if name.contains(".nii") { "input.nii.gz" } else { "input.hdr.gz" };
            vec![
                (number(packed, Form::Packed), unpacked(&bytes)?),
                (number("input.nii.gz", Form::File), bytes),
            ]
        } else {
            let ending = name.rsplit('.').next().unwrap_or_default();
            let is_same = |(input, form): &(&str, Form)| {
                *form == Form::File && input.rsplit('.').next() == Some(ending)
            };
            let found = FORMATS.iter().position(is_same);
            found.map(|place| (place as u8, bytes)).into_iter().collect()
        };
        for (format, bytes) in seeds.into_iter().filter(|(_, bytes)| bytes.len() <= LONGEST) {
            fs::write(out.join(format!("{format}_{name}")), [vec![format], bytes].concat())?;
        }
    }
    for (name, format, bytes) in hostile()? {
        fs::write(out.join(format!("{format}_{name}")), [vec![format], bytes].concat())?;
    }
    // The layout of raw voxels, as the target reads it: 4³ bytes of 1 mm after these 16.
    let layout = [4, 4, 4].into_iter().flat_map(u32::to_le_bytes).chain([0, 0, 1, 16]);
    let raw = number("input.raw", Form::Raw);
    fs::write(out.join("raw"), [raw].into_iter().chain(layout).chain(0..64).collect::<Vec<u8>>())?;
    Ok(())
}

/// What no file of the tests has: sequences deep in each other, of every coding, and gzip files of several members.
fn hostile() -> Result<Vec<(String, u8, Vec<u8>)>, Box<dyn Error>> {
    let folder = number("slice.dcm", Form::Folder);
    let mut seeds = Vec::new();
    for (name, syntax, begin) in [
        ("explicit", "1.2.840.10008.1.2.1\0", &b"\x08\0\x40\x11SQ\0\0"[..]),
        ("unknown", "1.2.840.10008.1.2.1\0", &b"\x09\0\x01\x10UN\0\0"[..]),
        ("implicit", "1.2.840.10008.1.2\0", &b"\x08\0\x40\x11"[..]),
    ] {
        let nested = [begin, &[0xff; 4], b"\xfe\xff\x00\xe0", &[0xff; 4]].concat();
        for depth in [40, 4000] {
            let length = [8 + syntax.len() as u8, 0, 0, 0];
            let meta =
                [b"\x02\0\0\0UL\x04\0", &length[..], b"\x02\0\x10\0UI", &[syntax.len() as u8, 0]].concat();
            let file = [&[0; 128], &b"DICM"[..], &meta, syntax.as_bytes(), &nested.repeat(depth)].concat();
            seeds.push((format!("{name}_{depth}"), folder, file));
        }
    }
    let packed = fs::read("tests/data/short_big.nii.gz")?;
    let gzip = number("input.nii.gz", Form::File);
    seeds.push(("two_members".into(), gzip, [&packed[..], &packed].concat()));
    seeds.push(("padded_member".into(), gzip, [&packed[..], &[0; 64]].concat()));
    Ok(seeds)
}

fn main() -> Result<(), Box<dyn Error>> {
    let out = PathBuf::from(std::env::args().nth(1).ok_or("name the folder for the seeds")?);
    let folder = |name: &str| -> Result<PathBuf, Box<dyn Error>> {
        fs::create_dir_all(out.join(name))?;
        Ok(out.join(name))
    };
    stores(&folder("store")?)?;
    volumes(&folder("volume")?)?;
    text::files(&folder("text")?)?;
    messages::packets(&folder("packets")?)?;
    messages::wire(&folder("wire")?)?;
    messages::tapes(&folder("tape")?)
}
