//! Voxels that are no numbers: a picture as if they were the smallest or the largest there is.

use bricks::BrickSource;
use bricks::store::{BuildOptions, CodeBits, Store};
use bricks::volume::{ByteOrder, Element};
use display_config::Display;
use glam::{DQuat, DVec3, UVec3};
use lightloom_tests::closure_volume::ClosureVolume;
use lightloom_tests::compare::{Limits, errors, truth};
use lightloom_tests::draw::{self, With, draw};
use lightloom_tests::scenes::{frame, optics, placed};
use optics::Light;
use std::path::Path;
use std::sync::Arc;
use volumes::{ImportOptions, import};
use volumes::{RawLayout, Selection};

/// Two bricks along one axis, and a length that is no multiple of 28 along the others.
const DIMS: UVec3 = UVec3::new(40, 20, 24);
/// Values of the voxels that are numbers.
const RANGE: (f64, f64) = (10.0, 250.0);
/// One projector from the side and one near the middle.
const PROJECTORS: [u32; 2] = [1, 5];
/// Edges from voxel to voxel, beside which a pixel shows a part of what the scalar between two samples hides; and the
/// 16 bits of the store's bricks.
const KEPT: Limits = Limits::of_255(0.5, 4.0, 12.0);

/// One voxel in seven is no number, and no two kinds of them look alike.
fn value(voxel: UVec3) -> f32 {
    let p = voxel.as_dvec3();
    let smooth = 0.5 + 0.5 * (0.4 * p.x).sin() * (0.3 * p.y + 0.5).cos() * (0.35 * p.z + 1.0).sin();
    match (voxel.x * 31 + voxel.y * 17 + voxel.z * 7) % 21 {
        0 => f32::NAN,
        7 => f32::INFINITY,
        14 => f32::NEG_INFINITY,
        // Both ends of the range are there.
        1 => RANGE.0 as f32,
        2 => RANGE.1 as f32,
        _ => (RANGE.0 + (RANGE.1 - RANGE.0) * smooth) as f32,
    }
}

fn imported(folder: &Path) -> Store {
    let index = |i: u32| UVec3::new(i % DIMS.x, i / DIMS.x % DIMS.y, i / (DIMS.x * DIMS.y));
    let bytes: Vec<u8> = (0..DIMS.element_product()).flat_map(|i| value(index(i)).to_le_bytes()).collect();
    let (raw, out) = (folder.join("a.raw"), folder.join("a.lloom"));
    std::fs::write(&raw, bytes).unwrap();
    let layout = RawLayout {
        dims: DIMS,
        element: Element::F32,
        byte_order: ByteOrder::Little,
        spacing_mm: DVec3::ONE,
        header_skip_bytes: 0,
    };
    let build = BuildOptions { bits: CodeBits::Sixteen, ..Default::default() };
    let options = ImportOptions { build, ..Default::default() };
    let selection = Selection { raw: Some(layout), ..Default::default() };
    let report = import(&raw, &selection, &out, &options, &|_, _| {}).unwrap();
    assert!(report.non_finite > 2000 && report.value_range == RANGE, "{report:?}");
    Store::open(&out).unwrap()
}

/// The same volume with `nan` in place of NaN, and the ends of the range in place of infinities.
fn replaced(nan: f64) -> Arc<dyn BrickSource> {
    let finite = move |p: DVec3| {
        let value = f64::from(value(p.floor().as_uvec3()));
        if value.is_nan() { nan } else { value.clamp(RANGE.0, RANGE.1) }
    };
    Arc::new(ClosureVolume::new(DIMS, RANGE, finite))
}

#[test]
fn what_is_no_number_is_seen_as_an_end_of_the_range() {
    let _turn = draw::turn();
    let folder = tempfile::tempdir().unwrap();
    let display = Display::load("desk8").unwrap().with_rasters(97, 73);
    let source: Arc<dyn BrickSource> = Arc::new(imported(folder.path()));
    let place = placed(&*source, 0.6 * display.height_m, DQuat::from_rotation_y(0.4));
    let optics = optics(
        RANGE,
        &vec![(10.0, 0.0), (250.0, 0.1)],
        &vec![(10.0, [1.0, 0.3, 0.1]), (130.0, [0.2, 0.9, 0.3]), (250.0, [0.3, 0.4, 1.0])],
    );
    let mut frame = frame(&display, place, optics, Some(Light::default()));
    // Coarser levels of a store are means, those of a formula are not.
    frame.quality.lod_scale = 0.0;
    let expected = truth(&display, &frame, &replaced(RANGE.0), &PROJECTORS, 2);
    let spoilt = truth(&display, &frame, &replaced(RANGE.1), &PROJECTORS, 2);
    for device in draw::devices() {
        let images = draw(&display, &frame, &source, &PROJECTORS, With::device(device)).images;
        assert!(images.iter().flat_map(|image| &image.rgba).all(|n| n.is_finite() && *n >= 0.0));
        let (found, other) = (errors(&images, &expected), errors(&images, &spoilt));
        println!("{device:?}: {found}; with NaN as the largest value: {other}");
        assert!(KEPT.hold(&found) && found.lit > 500, "{device:?}: {found}");
        assert!(!KEPT.hold(&other), "{device:?}: NaN as the largest value passes");
    }
}
