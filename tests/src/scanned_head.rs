//! A head as a scanner gives it: 512 × 512 × 133 voxels of 16 bits.

use crate::head::head;
use crate::scenes::{frame, optics, placed};
use bricks::BrickSource;
use bricks::store::{BuildOptions, CodeBits, Store};
use bricks::volume::{ByteOrder, Element};
use display_config::Display;
use glam::{DQuat, DVec3, UVec3};
use optics::{Light, Optics};
use protocol::FrameState;
use std::f64::consts::FRAC_PI_2;
use std::path::Path;
use volumes::{ImportOptions, RawLayout, Selection, import};

/// Its voxels.
pub const DIMS: UVec3 = UVec3::new(512, 512, 133);

/// Its store, at eight bits, in a folder.
pub fn store(folder: &Path) -> Store {
    let raw = folder.join("head.raw");
    let index = |i: u32| UVec3::new(i % DIMS.x, i / DIMS.x % DIMS.y, i / (DIMS.x * DIMS.y));
    let bytes: Vec<u8> =
        (0..DIMS.element_product()).flat_map(|i| head(index(i), DIMS).to_le_bytes()).collect();
    std::fs::write(&raw, bytes).expect("a temporary folder takes 70 MB");
    let layout = RawLayout {
        dims: DIMS,
        element: Element::I16,
        byte_order: ByteOrder::Little,
        spacing_mm: DVec3::new(0.45, 0.45, 1.2),
        header_skip_bytes: 0,
    };
    let options = ImportOptions {
        build: BuildOptions { bits: CodeBits::Eight, ..Default::default() },
        ..Default::default()
    };
    let out = folder.join("head.lloom");
    let selection = Selection { raw: Some(layout), ..Default::default() };
    import(&raw, &selection, &out, &options, &|_, _| {}).expect("a whole file imports");
    Store::open(&out).expect("a store just built opens")
}

/// It before a display, 0.75 m wide, in the three ways that casters are compared with.
pub fn frames(display: &Display, head: &dyn BrickSource) -> [(&'static str, FrameState); 3] {
    let place = placed(head, 0.75, DQuat::from_rotation_x(-FRAC_PI_2));
    [
        ("head, semi-transparent", semi_transparent(), None),
        ("head, opaque", opaque(), None),
        ("head, opaque, shaded", opaque(), Some(Light::default())),
    ]
    .map(|(name, optics, light)| (name, frame(display, place, optics, light)))
}

/// Skin and bone that light passes through.
pub fn semi_transparent() -> Optics {
    optics(
        (-1024.0, 3071.0),
        &vec![(-400.0, 0.0), (-100.0, 0.006), (100.0, 0.004), (300.0, 0.008), (1500.0, 0.03)],
        &vec![(-400.0, [0.8, 0.45, 0.3]), (150.0, [0.8, 0.3, 0.2]), (700.0, [0.95, 0.9, 0.8])],
    )
}

/// Bone that hides what lies behind it.
pub fn opaque() -> Optics {
    optics(
        (-1024.0, 3071.0),
        &vec![(300.0, 0.0), (600.0, 0.8), (1500.0, 1.5)],
        &vec![(300.0, [0.9, 0.6, 0.4]), (900.0, [0.95, 0.9, 0.8])],
    )
}
