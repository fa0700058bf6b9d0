//! Real volumes, from the packages that carry them.

use bricks::procedural::ProceduralVolume;
use bricks::store::{BuildOptions, CodeBits, Store, build};
use bricks::volume::{ByteOrder, Element};
use glam::{DVec3, UVec3};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, OnceLock, PoisonError};
use volumes::{ImportOptions, import};
use volumes::{RawLayout, Selection};

/// A CT of a head, 256 × 256 × 108, 16 bit: a tar archive in Debian's package invesalius-examples.
const CRANIUM: &str = "/usr/share/doc/invesalius-examples/examples/Cranium.inv3";
/// An MRI of a head, 181 × 217 × 181, 8 bit: in Debian's package mricron-data.
const HEAD_MRI: &str = "/usr/share/mricron/templates/ch2.nii.gz";

/// Whether a file is there. If not, that is printed, and is a failure with LIGHTLOOM_REQUIRE_DATA=1.
fn has(path: &str, package: &str) -> bool {
    let is_there = Path::new(path).exists();
    if !is_there {
        println!("SKIPPED: {path} is missing; install the Debian package {package}");
        assert!(std::env::var("LIGHTLOOM_REQUIRE_DATA").as_deref() != Ok("1"), "{path} is required here");
    }
    is_there
}

/// How the cranium's voxels lie in its file.
pub fn cranium_layout() -> RawLayout {
    RawLayout {
        dims: UVec3::new(256, 256, 108),
        element: Element::I16,
        byte_order: ByteOrder::Little,
        spacing_mm: DVec3::new(0.957_031_2, 0.957_031_2, 1.5),
        header_skip_bytes: 0,
    }
}

/// The cranium's voxels as a raw file in `folder`, in place of what is there; None where the package is missing.
pub fn cranium_raw(folder: &Path) -> Option<PathBuf> {
    has(CRANIUM, "invesalius-examples").then(|| extract_cranium(folder))
}

fn extract_cranium(folder: &Path) -> PathBuf {
    let raw = folder.join("cranium.raw");
    let voxels = Command::new("tar")
        .args(["--extract", "--to-stdout", "--wildcards", "--file", CRANIUM, "*/matrix.dat"])
        .output()
        .expect("tar is part of Debian's essential packages");
    assert!(voxels.status.success(), "tar: {}", String::from_utf8_lossy(&voxels.stderr));
    std::fs::write(&raw, voxels.stdout).expect("a temporary folder takes 14 MB");
    raw
}

/// A folder that lives as long as the process; it holds the stores made for tests.
fn folder() -> &'static Path {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    FOLDER.get_or_init(|| tempfile::tempdir().expect("a temporary folder can be made")).path()
}

/// The store of this name in the folder, built by whoever asks first.
fn store(name: &str, make: impl FnOnce(&Path)) -> Store {
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let out = folder().join(name);
    if !out.exists() {
        make(&out);
    }
    Store::open(&out).expect("a store just built opens")
}

fn build_store(input: &Path, raw: Option<RawLayout>, bits: CodeBits, out: &Path) {
    let options = ImportOptions { build: BuildOptions { bits, ..Default::default() }, ..Default::default() };
    let selection = Selection { raw, ..Default::default() };
    import(input, &selection, out, &options, &|_, _| {}).expect("a whole file imports");
}

/// The cranium CT as a 16-bit store.
pub fn cranium() -> Option<Store> {
    cranium_of(CodeBits::Sixteen)
}

/// The cranium CT as a store of so many bits per voxel.
pub fn cranium_of(bits: CodeBits) -> Option<Store> {
    has(CRANIUM, "invesalius-examples").then(|| {
        store(&format!("cranium-{}.lloom", bits.bits()), |out| {
            let raw = extract_cranium(folder());
            build_store(&raw, Some(cranium_layout()), bits, out);
        })
    })
}

/// The cranium CT with twice the voxels along each axis, interpolated, as a store: LFD section 6 enlarges its CTs to get
/// volumes that no cache holds.
pub fn cranium_doubled() -> Option<Store> {
    has(CRANIUM, "invesalius-examples").then(|| store("cranium-doubled.lloom", build_doubled))
}

fn build_doubled(out: &Path) {
    let raw = std::fs::read(extract_cranium(folder())).expect("a file just written can be read");
    let layout = cranium_layout();
    let dims = 2 * layout.dims;
    let doubled = folder().join("cranium-doubled.raw");
    std::fs::write(&doubled, doubled_voxels(&raw, layout.dims)).expect("a temporary folder takes 113 MB");
    let layout = RawLayout { dims, spacing_mm: 0.5 * layout.spacing_mm, ..layout };
    build_store(&doubled, Some(layout), CodeBits::Sixteen, out);
    // The store has it all.
    std::fs::remove_file(doubled).expect("a file just written can be removed");
}

/// Little-endian 16-bit voxels at twice the resolution: each is trilinear between the centres of the eight around it.
fn doubled_voxels(raw: &[u8], dims: UVec3) -> Vec<u8> {
    let value = |p: UVec3| {
        let at = 2 * (p.x + dims.x * (p.y + dims.y * p.z)) as usize;
        i32::from(i16::from_le_bytes([raw[at], raw[at + 1]]))
    };
    // Between voxels i / 2 and the one before or after it, three quarters of the way toward the former.
    let near_far = |i: u32, n: u32| {
        (i / 2, if i.is_multiple_of(2) { (i / 2).saturating_sub(1) } else { (i / 2 + 1).min(n - 1) })
    };
    let voxel = |x, y, z| {
        let [xs, ys, zs] = [near_far(x, dims.x), near_far(y, dims.y), near_far(z, dims.z)];
        let along_x = |y, z| 3 * value(UVec3::new(xs.0, y, z)) + value(UVec3::new(xs.1, y, z));
        let along_y = |z| 3 * along_x(ys.0, z) + along_x(ys.1, z);
        ((3 * along_y(zs.0) + along_y(zs.1)) >> 6) as i16
    };
    (0..2 * dims.z)
        .into_par_iter()
        .flat_map_iter(|z| (0..2 * dims.y).flat_map(move |y| (0..2 * dims.x).map(move |x| (x, y, z))))
        .flat_map_iter(|(x, y, z)| voxel(x, y, z).to_le_bytes())
        .collect()
}

/// Vessels of about a voxel, or none: what coarse voxels lose most of.
pub fn vessels() -> Store {
    store("vessels.lloom", |out| {
        let vessels = ProceduralVolume::new("sparse-vessels", UVec3::splat(192), 1e-3);
        let mut vessels = vessels.expect("the name is one of ours");
        build(&mut vessels, out, &BuildOptions::default(), &|_, _| {}).expect("a procedural volume builds");
    })
}

/// Voxels that know nothing of each other.
pub fn noise() -> Store {
    let dims = UVec3::splat(112);
    store("noise.lloom", |out| {
        let hash = |i: u32| (i.wrapping_mul(2_654_435_761) ^ i >> 7).wrapping_mul(0x9e37_79b1) >> 24;
        let voxel = |i: u32| ((hash(4 * i) + hash(4 * i + 1) + hash(4 * i + 2) + hash(4 * i + 3)) / 4) as u8;
        let raw = folder().join("noise.raw");
        let voxels: Vec<u8> = (0..dims.element_product()).map(voxel).collect();
        std::fs::write(&raw, voxels).expect("a temporary folder takes 2 MB");
        let layout = RawLayout { dims, element: Element::U8, spacing_mm: DVec3::ONE, ..cranium_layout() };
        build_store(&raw, Some(layout), CodeBits::Eight, out);
    })
}

/// The head MRI's file, of which nobody but its reader knows anything.
pub fn head_mri_file() -> Option<PathBuf> {
    has(HEAD_MRI, "mricron-data").then(|| HEAD_MRI.into())
}

/// The head MRI as an 8-bit store.
pub fn head_mri() -> Option<Store> {
    head_mri_file().map(|file| store("head.lloom", |out| build_store(&file, None, CodeBits::Eight, out)))
}
