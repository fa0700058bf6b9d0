//! Laws of the wire format: what goes in comes out, and nothing else comes out.

use super::*;
use crate::*;
use display_config::{
    BlackLevel, Display, Finish, Homography, LightMap, Mesh, Output, Projector, Raster, Response, Transfer,
    Turn,
};
use glam::{DAffine3, DMat3, DVec3, UVec2, UVec3, Vec2};
use optics::DebugView;
use optics::{
    BandPicker, Curve, Enhancer, ExtinctionUnit, Light, Mimda, MimdaForm, Optics, Quality, Ramp, Trapezoid,
};
use proptest::collection::vec;
use proptest::prelude::*;
use std::time::Instant;

prop_compose! {
    fn point()(x in any::<f64>(), y in any::<f64>(), z in any::<f64>()) -> DVec3 { DVec3::new(x, y, z) }
}

prop_compose! {
    fn curve()(mut points in vec((0.0..1.0, 0.0..1e6), 1..9)) -> Curve<f64> {
        points.sort_by(|a: &(f64, f64), b| a.0.total_cmp(&b.0));
        Curve::new(points).unwrap()
    }
}

prop_compose! {
    fn picker()(a in 0.0..0.4, width in 0.0..0.5, strength in 0.0..1.0) -> Enhancer {
        let band = Trapezoid::new([a, a, a + width, a + width]).unwrap();
        let facing = Ramp { low: a, high: 1.0 };
        Enhancer::BandPicker(BandPicker { band, axis_in_display: DVec3::NEG_Z, facing, strength })
    }
}

prop_compose! {
    fn optics()(
        extinction in curve(), importance in proptest::option::of(curve()), gamma in 0.0..1.0,
        refraction in proptest::option::of(curve()), enhancers in vec(picker(), 0..4), lit in any::<bool>(),
    ) -> Optics {
        let materials = lit.then(|| Curve::constant(Light::default().material()));
        let mimda = importance.map(|importance| Mimda { importance, gamma, form: MimdaForm::Paper });
        let colour = Curve::constant(DVec3::new(gamma, 0.5, 1.0));
        Optics { domain: (0.0, 255.0), extinction, extinction_unit: ExtinctionUnit::PerVoxel, colour, mimda, refraction, materials, enhancers }
    }
}

prop_compose! {
    fn mark()(points in vec(point(), 0..4), radius_m in any::<f64>(), text in ".*", kind in 0..3, rgb in any::<[f32; 3]>()) -> Mark {
        let paint = Paint { rgb, opacity: 0.5 };
        let shape = match kind {
            0 => MarkShape::Stroke { points_in_display: points, radius_m },
            1 => MarkShape::Sheet { corners_in_display: points },
            _ => MarkShape::Label { text, base_in_display: DVec3::X, em_m: radius_m, backing: (rgb[0] > 0.0).then_some(paint) },
        };
        Mark { shape, paint, is_depth_combined: kind == 1 }
    }
}

prop_compose! {
    fn frame()(
        index in any::<u32>(), time_s in any::<f64>(), at in point(), eta in 0.0..1.0, optics in optics(),
        lit in any::<bool>(), volume in proptest::option::of("[a-z]{1,9}"), marks in vec(mark(), 0..4),
    ) -> FromFrontend {
        FromFrontend::Frame(Box::new(FrameState {
            index, time_s, observer_in_display: at, eta,
            display_from_volume: DAffine3::from_translation(at),
            optics,
            light: lit.then(Light::default),
            quality: Quality::default(),
            volume: volume.map(|path| VolumeRef::Store(path.into())),
            sub_frame: SubFrame::ORDER.get(index as usize % 5).copied(),
            refinement: (index % 4 == 1).then_some(Refinement { configuration: index / 3, to: index % 65 }),
            welcomes_planes: index % 3 == 0,
            pace: if lit { Pace::Complete } else { Pace::Live { upload_bytes: 1 << 24, fade_s: 0.25 } },
            debug: DebugView::ALL.get(index as usize % 5).copied(),
            marks,
        }))
    }
}

prop_compose! {
    fn light_map()(width in 1_u32..6, height in 1_u32..6)(
        shares in vec(any::<u16>(), (width * height) as usize), width in Just(width), height in Just(height),
    ) -> LightMap {
        LightMap::new(width, height, shares).unwrap()
    }
}

prop_compose! {
    fn mesh()(columns in 2_u32..7, rows in 2_u32..7, bow in 0.0_f32..0.1) -> Mesh {
        let point = |x: u32, y: u32| Vec2::new(x as f32 * (1.0 + bow * y as f32), -(y as f32));
        Mesh::new(columns, rows, (0..columns * rows).map(|i| point(i % columns, i / columns)).collect()).unwrap()
    }
}

prop_compose! {
    fn finish()(
        mesh in proptest::option::of(mesh()), blend in proptest::option::of(light_map()), map in light_map(), kind in 0..3,
        is_dithered in any::<bool>(),
    ) -> Finish {
        let response = Response::new(vec![(0.0, 1), (1.0, 250)]).unwrap();
        let black = [None, Some(BlackLevel::Level([0.1, 0.2, 0.3])), Some(BlackLevel::Map(map))];
        let measured = Transfer::Measured(Box::new([response.clone(), response.clone(), response]));
        let transfer = [Transfer::Srgb, Transfer::Gamma(2.2), measured];
        let kind = kind as usize;
        Finish { mesh, blend, black: black[kind].clone(), transfer: transfer[kind].clone(), is_dithered }
    }
}

prop_compose! {
    fn projector()(
        name in ".*", at in point(), size in any::<(u32, u32)>(), output in any::<Option<(Option<String>, u32, u32)>>(),
        finish in finish(),
    ) -> Projector {
        let screen_from_pixel = Homography(DMat3::from_cols(at, DVec3::Y, DVec3::Z));
        let output = output.map(|(connector, x, y)| {
            let turn = Turn { is_mirrored: x % 2 == 0, quarters: (y % 4) as u8 };
            Output { connector, first_px: UVec2::new(x, y), turn }
        });
        let raster = Raster { width: size.0, height: size.1, screen_from_pixel, output };
        Projector { name, centre_in_display: at, raster, backend: size.0, finish }
    }
}

fn held(n: u64) -> Held {
    let nodes = (0..n % 9).map(|i| (i as u8, UVec3::new(n as u32, i as u32, 0))).collect();
    Held { volume: VolumeRef::Store("held.lloom".into()), nodes }
}

prop_compose! {
    fn setup()(name in ".*", projectors in vec(projector(), 0..5), indices in vec(any::<u32>(), 0..80), n in any::<u64>())
        -> FromFrontend {
        let volume = if n % 2 == 0 { VolumeRef::Store(name.clone().into()) } else {
            VolumeRef::Procedural { name: name.clone(), dims: UVec3::splat(7), voxel_size_m: DVec3::ONE }
        };
        let display = Display {
            name, width_m: 1.6, height_m: 0.9, pixel_size_m: 1.5e-3, angular_accuracy: 0.014,
            observer_in_display: DVec3::Z, eta: 1.0, rate_hz: 60.0, projectors,
            adapters: vec![None, Some("card".into())],
        };
        let options = RendererOptions {
            display, projectors: indices, backend: 1, device: DeviceChoice::Cpu,
            adapter: AdapterWish { turn: 3, name: (n % 5 == 0).then(|| "card".into()) }, filter: FilterChoice::Exact,
            caster: CasterChoice::Planes, cache_bytes: n,
        };
        FromFrontend::Setup(Box::new(Setup {
            options, volume, screens: Screens { frontend: n % 2 == 0, outputs: n % 3 == 1, swapchain: SwapchainChoice::On }, trace: (n % 3 == 0).then(|| "traces/backend-1.trace".into()),
            is_kept: n % 7 == 0, held: (n % 11 == 0).then(|| Box::new(held(n))),
        }))
    }
}

fn from_frontend() -> impl Strategy<Value = FromFrontend> {
    prop_oneof![
        frame(),
        setup(),
        (frame(), any::<bool>()).prop_map(|(message, compares)| match message {
            FromFrontend::Frame(frame) => {
                FromFrontend::Beat { newest: compares.then(|| frame.clone()), frame }
            }
            other => other,
        }),
        (any::<u32>(), any::<Option<u64>>()).prop_map(|(frame, at_us)| FromFrontend::Show { frame, at_us }),
        any::<u64>().prop_map(|asked_us| FromFrontend::Clock { asked_us }),
        Just(FromFrontend::Alive),
        Just(FromFrontend::Finish),
        Just(FromFrontend::Quit)
    ]
}

prop_compose! {
    fn image()(projector in any::<u32>(), width in 0_u32..9, height in 0_u32..9)
        (rgba in vec(any::<f32>(), (4 * width * height) as usize), projector in Just(projector),
         width in Just(width), height in Just(height)) -> FromBackend {
        FromBackend::Image(ProjectorImage { projector, width, height, rgba })
    }
}

prop_compose! {
    fn screen()(projector in any::<u32>(), width in 0_u32..9, height in 0_u32..9)
        (rgb in vec(any::<u8>(), (3 * width * height) as usize), projector in Just(projector),
         width in Just(width), height in Just(height)) -> FromBackend {
        FromBackend::Screen(ScreenImage { projector, width, height, rgb })
    }
}

prop_compose! {
    fn done()(n in any::<[u64; 7]>(), projectors in vec(any::<u32>(), 0..80), shortfall in ".*", ms in 0.0..1e6)
        -> FromBackend {
        FromBackend::Done(Box::new(FrameReport {
            frame: 3, backend: 1, caster: Caster::RaysBecause(shortfall.clone()), rays: n[0], samples: n[1], bricks_wanted: n[2], bricks_resident: n[3],
            bricks_loaded: n[4], bytes_loaded: n[5], working_set_union: n[6],
            working_set_sum: projectors.first().map(|_| n[6]), projectors,
            complete: shortfall.is_empty(), upkeep: None, refined: (n[0] % 2 == 0).then(|| Refined { done: n[0] as u32 % 65, pixels: n[0], spatial: n[0], compared: n[0], change: n[0], has_detail: n[0] % 3 == 0 }), damaged_bricks: n[0], damaged: vec![shortfall.clone(); 2], shortfall,
            stages: Stages { cast_ms: ms, ..Stages::default() }, total_ms: ms,
        }))
    }
}

fn from_backend() -> impl Strategy<Value = FromBackend> {
    prop_oneof![
        (any::<u32>(), ".*", any::<u32>()).prop_map(|(protocol, host, process)| FromBackend::Hello(Hello {
            protocol,
            host,
            process
        })),
        (".*", ".*", ".*", any::<u64>()).prop_map(|(adapter, reason, filter, cache_bytes)| {
            FromBackend::Ready(DeviceInfo { adapter, reason, filter, cache_bytes })
        }),
        Just(FromBackend::Alive),
        any::<u64>().prop_map(|n| FromBackend::Held(Box::new(held(n)))),
        (any::<u64>(), any::<u64>()).prop_map(|(done, total)| FromBackend::Progress { done, total }),
        image(),
        screen(),
        done(),
        (any::<u32>(), any::<u64>()).prop_map(|(frame, at_us)| FromBackend::Shown { frame, at_us }),
        (any::<u64>(), any::<u64>()).prop_map(|(asked_us, here_us)| FromBackend::Clock { asked_us, here_us }),
        ".*".prop_map(FromBackend::Failed),
        ".*".prop_map(FromBackend::Lost),
        ".*".prop_map(FromBackend::Said),
    ]
}

proptest! {
    #[test]
    fn what_the_front_end_says_arrives(message in from_frontend()) {
        prop_assert_eq!(decode::<FromFrontend>(&encode(&message).unwrap()).unwrap(), message);
    }

    #[test]
    fn what_a_back_end_says_arrives(message in from_backend()) {
        let bytes = encode(&message).unwrap();
        // A picture of no pixels has no numbers either.
        let has_numbers = match &message {
            FromBackend::Image(image) => !image.rgba.is_empty(),
            FromBackend::Screen(image) => !image.rgb.is_empty(),
            _ => false,
        };
        prop_assert_eq!(has_picture(&bytes), has_numbers);
        prop_assert_eq!(decode::<FromBackend>(&bytes).unwrap(), message);
    }

    #[test]
    fn random_bytes_are_an_error_and_no_panic(bytes in vec(any::<u8>(), 0..300)) {
        prop_assert!(decode::<FromBackend>(&bytes).is_err());
        prop_assert!(decode::<FromFrontend>(&bytes).is_err());
        let _ = has_picture(&bytes);
    }

    #[test]
    fn a_random_body_is_no_panic(body in vec(any::<u8>(), 0..300), tail in vec(any::<u8>(), 0..40)) {
        let mut bytes = header(PROTOCOL_VERSION, body.len() as u32);
        bytes.extend(body);
        bytes.extend(tail);
        // A few random bodies are messages; those must encode to the same bytes again.
        if let Ok(message) = decode::<FromBackend>(&bytes) {
            prop_assert_eq!(encode(&message).unwrap(), bytes.clone());
        }
        let _ = decode::<FromFrontend>(&bytes);
    }

    #[test]
    fn a_changed_byte_is_no_panic(message in from_backend(), at in any::<prop::sample::Index>(), to in any::<u8>()) {
        let mut bytes = encode(&message).unwrap();
        let at = at.index(bytes.len());
        bytes[at] = to;
        let _ = decode::<FromBackend>(&bytes);
    }

    #[test]
    fn a_cut_or_lengthened_message_is_an_error(message in from_backend(), at in any::<prop::sample::Index>()) {
        let mut bytes = encode(&message).unwrap();
        prop_assert!(decode::<FromBackend>(&bytes[..at.index(bytes.len())]).is_err());
        bytes.push(0);
        prop_assert!(decode::<FromBackend>(&bytes).is_err());
    }
}

proptest! {
    #[test]
    fn a_setup_whose_maps_are_cut_or_lengthened_is_an_error(message in setup(), at in any::<prop::sample::Index>()) {
        let mut bytes = encode(&message).unwrap();
        prop_assert!(decode::<FromFrontend>(&bytes[..at.index(bytes.len())]).is_err());
        bytes.push(0);
        prop_assert!(decode::<FromFrontend>(&bytes).is_err());
    }

    #[test]
    fn a_setup_with_a_changed_byte_is_no_panic(message in setup(), at in any::<prop::sample::Index>(), to in any::<u8>()) {
        let mut bytes = encode(&message).unwrap();
        let at = at.index(bytes.len());
        bytes[at] = to;
        let _ = decode::<FromFrontend>(&bytes);
    }
}

fn header(version: u32, body_bytes: u32) -> Vec<u8> {
    [MAGIC, version, body_bytes].iter().flat_map(|word| word.to_le_bytes()).collect()
}

#[test]
fn a_progress_message_has_the_bytes_the_layout_says() {
    let mut expected = header(PROTOCOL_VERSION, 20);
    expected.extend(2_u32.to_le_bytes());
    expected.extend(5_u64.to_le_bytes());
    expected.extend(9_u64.to_le_bytes());
    assert_eq!(encode(&FromBackend::Progress { done: 5, total: 9 }).unwrap(), expected);
}

#[test]
fn numbers_keep_their_bits_even_where_they_are_not_numbers() {
    let rgba = vec![f32::NAN, f32::INFINITY, -0.0, f32::from_bits(0x7fa0_0001)];
    let bits: Vec<u32> = rgba.iter().map(|x| x.to_bits()).collect();
    let sent = FromBackend::Image(ProjectorImage { projector: 0, width: 1, height: 1, rgba });
    let FromBackend::Image(came) = decode(&encode(&sent).unwrap()).unwrap() else { panic!("not an image") };
    assert_eq!(came.rgba.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), bits);
}

#[test]
fn another_version_is_named() {
    let bytes = header(PROTOCOL_VERSION + 1, 0);
    assert_eq!(decode::<FromBackend>(&bytes), Err(WireError::Version { theirs: PROTOCOL_VERSION + 1 }));
}

#[test]
fn a_huge_length_in_a_short_message_is_an_error() {
    let hostile_text = [5_u32.to_le_bytes().as_slice(), &(1_u64 << 40).to_le_bytes()].concat();
    let bytes = [header(PROTOCOL_VERSION, hostile_text.len() as u32), hostile_text].concat();
    assert!(matches!(decode::<FromBackend>(&bytes), Err(WireError::Damaged(_))));
    assert!(matches!(
        decode::<FromBackend>(&header(PROTOCOL_VERSION, u32::MAX)),
        Err(WireError::TooLong { .. })
    ));
}

#[test]
fn a_picture_must_fill_its_raster_and_stay_under_the_limit() {
    let image = |width, height, numbers| {
        FromBackend::Image(ProjectorImage { projector: 4, width, height, rgba: vec![0.0; numbers] })
    };
    assert!(matches!(encode(&image(2, 2, 15)), Err(WireError::Raster { projector: 4, numbers: 15, .. })));
    assert!(matches!(encode(&image(u32::MAX, u32::MAX, 0)), Err(WireError::Raster { .. })));
    let codes = FromBackend::Screen(ScreenImage { projector: 1, width: 2, height: 2, rgb: vec![0; 11] });
    assert!(matches!(encode(&codes), Err(WireError::Raster { numbers: 11, per_pixel: 3, .. })));
    // Zeros that nobody writes to take no memory.
    assert!(matches!(encode(&image(8192, 8225, 4 * 8192 * 8225)), Err(WireError::TooLong { .. })));
}

/// Prints what a picture costs; run it with `--release -- --ignored --nocapture`.
#[test]
#[ignore = "a measurement, not a law"]
fn cost_of_a_picture() {
    let rgba = (0..4 * 800 * 600).map(|i| i as f32).collect();
    let message = FromBackend::Image(ProjectorImage { projector: 0, width: 800, height: 600, rgba });
    for _ in 0..3 {
        let start = Instant::now();
        let bytes = encode(&message).unwrap();
        let encoded = start.elapsed();
        let start = Instant::now();
        let back: FromBackend = decode(&bytes).unwrap();
        let decoded = start.elapsed();
        assert_eq!(back, message);
        let start = Instant::now();
        let plain = bincode::serde::encode_to_vec(&message, bincode::config::standard()).unwrap();
        let plainly = start.elapsed();
        let start = Instant::now();
        let (again, _): (FromBackend, usize) =
            bincode::serde::decode_from_slice(&plain, bincode::config::standard()).unwrap();
        let plainly_back = start.elapsed();
        assert_eq!(again, message);
        println!("encode {encoded:?}, decode {decoded:?}; bincode alone {plainly:?}, {plainly_back:?}");
    }
}
