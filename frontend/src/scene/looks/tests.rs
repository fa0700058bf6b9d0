//! Laws of choosing and making looks, on made-up values.

use super::values::{Pair, Sample};
use super::*;
use bricks::volume::Modality;
use glam::{DVec3, UVec3};

const GRID: Grid = Grid { dims: UVec3::new(256, 256, 108), voxel_m: DVec3::new(0.957e-3, 0.957e-3, 1.5e-3) };

/// Numbers from -1 to 1 around 0, denser in the middle, the same each time.
fn noise() -> impl FnMut() -> f32 {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1 << 23) as f32 - 1.0
    };
    move || (0..6).map(|_| uniform()).sum::<f32>() / 6.0
}

/// So many voxels in thousandths around a value, each as far from it as `spread` says, at most.
type Peak = (usize, f32, f32);

/// Values of some peaks, in 100,000 voxels.
fn peaks(peaks: &[Peak]) -> Values {
    let mut noise = noise();
    let mut sample = Sample::default();
    for &(count, middle, spread) in peaks {
        sample.values.extend((0..100 * count).map(|_| middle + spread * noise()));
    }
    of(sample)
}

fn of(mut sample: Sample) -> Values {
    sample.pairs = sample.values.windows(2).map(|two| Pair { here: two[0], beside: two[1] }).collect();
    let range = sample
        .values
        .iter()
        .fold((f64::MAX, f64::MIN), |(low, high), &v| (low.min(f64::from(v)), high.max(f64::from(v))));
    Values::new(&sample, None, 1.0, range)
}

const HEAD: &[Peak] =
    &[(500, -1000.0, 24.0), (30, -500.0, 500.0), (50, -100.0, 40.0), (350, 40.0, 60.0), (70, 900.0, 800.0)];
const CHEST: &[Peak] =
    &[(400, -1000.0, 20.0), (200, -800.0, 150.0), (100, -100.0, 40.0), (250, 45.0, 60.0), (50, 400.0, 400.0)];
const TISSUES: &[Peak] = &[(450, 6.0, 6.0), (150, 60.0, 60.0), (250, 110.0, 50.0), (150, 170.0, 40.0)];
const CELLS: &[Peak] = &[(960, 100.0, 40.0), (30, 700.0, 500.0), (10, 2500.0, 1500.0)];
const ICE: &[Peak] = &[(940, -3.0, 10.0), (60, -11.0, 6.0)];

fn regions() -> Values {
    let labels = (0..4000).map(|region| if region % 2 == 0 { 0.0 } else { ((region * 7) % 90) as f32 });
    of(Sample { values: labels.flat_map(|label| [label; 12]).collect(), ..Sample::default() })
}

/// As many voxels of each value.
fn even() -> Values {
    of(Sample {
        values: (0..50_000).map(|i| (i * 7919 % 50_000) as f32 * 1e-4).collect(),
        ..Sample::default()
    })
}

#[test]
fn values_choose_their_look() {
    for (values, expected) in [
        (peaks(HEAD), LookName::CtSkinBone),
        (peaks(CHEST), LookName::CtSkinBone),
        (peaks(TISSUES), LookName::Mr),
        (peaks(CELLS), LookName::Fluorescence),
        (peaks(ICE), LookName::Tomogram),
        (regions(), LookName::Labels),
        (even(), LookName::Scalar),
    ] {
        let choice = choose(&values);
        assert_eq!(choice.name, expected, "{choice}; {:?}", values.histogram);
    }
    assert_eq!(choose(&peaks(HEAD)).to_string(), "look `ct-skin-bone`: its values are Hounsfield units");
}

/// A head without air around it, and one that was never scaled, are CT if their file says so; so is no MR that looks like one.
#[test]
fn what_a_file_says_goes_before_its_values() {
    let inside: &[Peak] = &[(50, -100.0, 40.0), (850, 40.0, 60.0), (100, 900.0, 800.0)];
    for (values, modality, told, untold) in [
        (inside, Modality::Ct, LookName::CtSkinBone, LookName::Scalar),
        (TISSUES, Modality::Ct, LookName::CtSkinBone, LookName::Mr),
        (HEAD, Modality::Mr, LookName::Mr, LookName::CtSkinBone),
        (ICE, Modality::Mr, LookName::Mr, LookName::Tomogram),
    ] {
        assert_eq!(choose(&peaks(values)).name, untold, "{}", choose(&peaks(values)));
        let values = peaks(values).of_modality(modality);
        let choice = choose(&values);
        assert_eq!(choice.name, told);
        assert_eq!(choice.why, format!("its file says that it is {modality}"));
        assert!(!verdict(untold, &values).fits || untold == LookName::Scalar);
    }
    assert!(verdict(LookName::CtLung, &peaks(CHEST).of_modality(Modality::Ct)).fits);
    assert!(!verdict(LookName::CtLung, &peaks(HEAD).of_modality(Modality::Ct)).fits);
}

/// Scale and offset mean nothing, except to Hounsfield units.
#[test]
fn only_hounsfield_units_have_a_scale() {
    let changed = |peaks: &[Peak], factor: f32, offset: f32| -> Vec<Peak> {
        peaks.iter().map(|&(n, middle, spread)| (n, factor * middle + offset, factor * spread)).collect()
    };
    for (values, expected) in
        [(TISSUES, LookName::Mr), (CELLS, LookName::Fluorescence), (ICE, LookName::Tomogram)]
    {
        for (factor, offset) in [(1e-3, 0.0), (300.0, -5000.0), (1.0, 1e4)] {
            assert_eq!(choose(&peaks(&changed(values, factor, offset))).name, expected, "{factor}, {offset}");
        }
    }
    for (factor, offset) in [(1.0, 1024.0), (0.5, 0.0), (-1.0, 0.0)] {
        let choice = choose(&peaks(&changed(HEAD, factor, offset)));
        assert_ne!(choice.name, LookName::CtSkinBone, "{factor}, {offset}");
    }
}

#[test]
fn noise_of_any_width_is_no_ct() {
    for spread in [300.0, 1000.0, 2000.0, 4000.0] {
        let choice = choose(&peaks(&[(1000, 0.0, spread)]));
        assert_eq!(choice.name, LookName::Tomogram, "{spread}");
    }
}

#[test]
fn lungs_are_told_from_a_head() {
    let fits = |values: &[Peak]| verdict(LookName::CtLung, &peaks(values));
    assert!(fits(CHEST).fits && !fits(HEAD).fits && !fits(TISSUES).fits);
    assert_eq!(fits(TISSUES).why, "its values are not Hounsfield units");
}

/// Air is not shown; bone is.
#[test]
fn looks_of_ct_show_what_they_say() {
    let values = peaks(HEAD);
    let at = |name, value| make(name, &values, &GRID).look.extinction.at(value);
    for name in [LookName::CtSkinBone, LookName::CtBone, LookName::CtLung, LookName::CtVessels] {
        assert_eq!(at(name, -1000.0), 0.0, "{name}");
        assert!(at(name, 1000.0) > 0.0, "{name}");
    }
    assert!(at(LookName::CtBone, 100.0) == 0.0 && at(LookName::CtLung, -800.0) > 0.0);
    assert!(at(LookName::CtSkinBone, 1000.0) > 20.0 * at(LookName::CtSkinBone, -200.0));
    assert!(at(LookName::CtVessels, 350.0) > at(LookName::CtVessels, 1000.0));
}

/// The background shows nothing in the looks that know one, wherever it lies.
#[test]
fn fitted_looks_hide_the_background() {
    for (values, name) in [
        (peaks(TISSUES), LookName::Mr),
        (peaks(CELLS), LookName::Fluorescence),
        (peaks(ICE), LookName::Tomogram),
        (regions(), LookName::Labels),
        (peaks(CELLS), LookName::Scalar),
        (peaks(&[(960, 900.0, 40.0), (40, 300.0, 200.0)]), LookName::Scalar),
    ] {
        let made = make(name, &values, &GRID);
        let at = |value| made.look.extinction.at(value);
        assert_eq!(at(values.histogram.background()), 0.0, "{name}: {:?}", made.look.extinction);
        let shown = values.quantile(0.0).min(values.histogram.low);
        let most = (0..=1000).map(|i| at(shown + f64::from(i) * 1e-3 * (values.quantile(1.0) - shown)));
        assert!(most.fold(0.0, f64::max) > 0.0, "{name} shows nothing");
    }
}

/// Every look can be made of whatever values, and no look leaves f32.
#[test]
fn looks_can_be_made_of_anything() {
    let single = |value: f32| of(Sample { values: vec![value; 100], ..Sample::default() });
    let spike = || (0..10_000).map(|i| if i == 77 { 1e30 } else { 0.0 }).collect();
    let nothing = Values::new(&Sample::default(), None, 1.0, (0.0, 1.0));
    let infinite = of(Sample { values: vec![f32::NAN, f32::INFINITY, 3.0], ..Sample::default() });
    let all = [
        peaks(HEAD),
        peaks(ICE),
        regions(),
        even(),
        single(0.0),
        single(-1e30),
        nothing,
        infinite,
        of(Sample { values: spike(), ..Sample::default() }),
    ];
    for values in &all {
        let range = (values.quantile(0.0), values.quantile(1.0));
        for name in LookName::ALL {
            for dims in [UVec3::ONE, UVec3::new(1, 1, 5000), GRID.dims] {
                let made = make(name, values, &Grid { dims, ..GRID });
                let optics = crate::scene::Look::InDataUnits(made.look).optics(
                    range,
                    0.5,
                    world::Window::default(),
                    &[],
                );
                assert!(optics.is_ok(), "{name} of {range:?}: {optics:?}");
                assert!(made.light.is_none_or(|light| light.check().is_ok()), "{name} of {range:?}");
            }
        }
        assert!(LookName::ALL.into_iter().any(|name| verdict(name, values).fits));
    }
}

/// A volume of more voxels looks the same: extinctions are those across it.
#[test]
fn a_look_does_not_depend_on_the_number_of_voxels() {
    let values = peaks(HEAD);
    let fine = Grid { dims: 2 * GRID.dims, voxel_m: 0.5 * GRID.voxel_m };
    for name in LookName::ALL {
        let [coarse, fine] =
            [&GRID, &fine].map(|grid| make(name, &values, grid).look.extinction.max_on(-2e3, 4e3));
        assert!((coarse / fine - 2.0).abs() < 1e-9, "{name}: {coarse}, {fine}");
    }
}
