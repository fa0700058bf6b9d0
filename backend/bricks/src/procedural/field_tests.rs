//! Laws of the procedural fields.

use super::*;
use crate::{BrickSource, NodeKey};
use glam::{DVec3, UVec3};
use proptest::prelude::*;

/// Step of the finite differences: their error is about h² f''' / 6, some 1e-5 for vessels 0.003 wide; kinks of the
/// third derivative at rims add no more.
const DIFFERENCE_STEP: f64 = 1e-6;
/// Relative to the gradient, or absolute where that is under 1.
const GRADIENT_TOLERANCE: f64 = 2e-4;

fn fields() -> Vec<(&'static str, Box<dyn Field>)> {
    let extent = DVec3::new(1.0, 0.75, 0.9);
    FIELD_NAMES.iter().map(|&name| (name, field_named(name, extent).unwrap())).collect()
}

fn point() -> impl Strategy<Value = DVec3> {
    (0.0..1.0f64, 0.0..0.75f64, 0.0..0.9f64).prop_map(DVec3::from)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, rng_seed: proptest::test_runner::RngSeed::Fixed(7), failure_persistence: None, ..Default::default() })]

    #[test]
    fn gradients_agree_with_differences(p in point()) {
        for (name, field) in fields_cached() {
            let difference = DVec3::from_array(DVec3::AXES.map(|axis| {
                let h = axis * DIFFERENCE_STEP;
                (field.value(p + h) - field.value(p - h)) / (2.0 * DIFFERENCE_STEP)
            }));
            let gradient = field.gradient(p);
            let tolerance = GRADIENT_TOLERANCE * (1.0 + gradient.length());
            prop_assert!((difference - gradient).length() < tolerance, "{name} at {p}: {difference} and {gradient}");
        }
    }

    #[test]
    fn values_lie_within_the_bounds_of_their_box(a in point(), size in 0.0..0.3f64, inside in prop::array::uniform3(0.0..=1.0f64)) {
        for (name, field) in fields_cached() {
            let (low, high) = field.range_in_box(a, a + size);
            let value = field.value(a + DVec3::from_array(inside) * size);
            prop_assert!(low <= value && value <= high, "{name}: {value} outside [{low}, {high}]");
            prop_assert!(0.0 <= low && high <= 1.0);
        }
    }
}

/// The fields are made once: the vessels' grid takes a while in a debug build.
fn fields_cached() -> &'static [(&'static str, Box<dyn Field>)] {
    static FIELDS: std::sync::OnceLock<Vec<(&'static str, Box<dyn Field>)>> = std::sync::OnceLock::new();
    FIELDS.get_or_init(fields)
}

/// Gradients where random points rarely are: in vessels, and on the axis of symmetry.
#[test]
fn gradients_agree_in_a_vessel_and_on_the_axis() {
    for (name, field) in fields_cached() {
        for p in [DVec3::new(0.505, 0.38, 0.1), DVec3::new(0.5, 0.375, 0.45), DVec3::new(0.49, 0.37, 0.2)] {
            let difference = DVec3::from_array(DVec3::AXES.map(|axis| {
                let h = axis * DIFFERENCE_STEP;
                (field.value(p + h) - field.value(p - h)) / (2.0 * DIFFERENCE_STEP)
            }));
            let error = (difference - field.gradient(p)).length();
            assert!(error < GRADIENT_TOLERANCE * (1.0 + difference.length()), "{name} at {p}: {error}");
        }
    }
}

/// Every level's stored samples, overlap and all, lie within the summary of their node and of all nodes above it.
#[test]
fn summaries_bound_the_stored_samples() {
    for name in FIELD_NAMES {
        let volume = ProceduralVolume::new(name, UVec3::new(100, 70, 57), 1e-3).unwrap();
        let shape = volume.shape();
        for node in (0..=shape.finest_depth()).flat_map(|depth| shape.nodes(depth)) {
            let brick = volume.brick(node).unwrap();
            let values = || (0..crate::BRICK_VOXELS).map(|index| brick.value(index));
            let (min, max) = (values().fold(f64::MAX, f64::min), values().fold(f64::MIN, f64::max));
            let mut above: Option<NodeKey> = Some(node);
            while let Some(key) = above {
                let summary = volume.summary(key);
                assert!(
                    f64::from(summary.min) <= min && max <= f64::from(summary.max),
                    "{name} {node:?} in {key:?}"
                );
                above = key.parent();
            }
        }
    }
}

#[test]
fn vessels_are_sparse_and_the_rest_is_exactly_empty() {
    let volume = ProceduralVolume::new("sparse-vessels", UVec3::splat(1024), 1e-3).unwrap();
    let shape = volume.shape();
    let nodes: Vec<_> = shape.nodes(shape.finest_depth()).collect();
    let empty = nodes.iter().filter(|&&node| volume.summary(node).max == 0.0).count();
    let part = empty as f64 / nodes.len() as f64;
    assert!(part > 0.8 && part < 0.99, "{part} of the finest nodes are empty");
}

#[test]
fn a_huge_volume_gives_the_same_brick_twice() {
    for name in FIELD_NAMES {
        let volume = ProceduralVolume::new(name, UVec3::splat(4096), 1e-4).unwrap();
        let depth = volume.shape().finest_depth();
        let node = NodeKey { depth, cell: UVec3::new(73, 73, 12) };
        assert_eq!(volume.brick(node).unwrap(), volume.brick(node).unwrap());
        assert!(volume.brick(NodeKey { depth, cell: UVec3::splat(147) }).is_err());
    }
}

#[test]
fn the_signal_has_the_papers_values() {
    let field = MarschnerLobb::new(DVec3::ONE);
    // At the origin: (1 + α (1 + cos 12π)) / (2 (1 + α)) = 1.5 / 2.5.
    assert!((field.value(DVec3::splat(0.5)) - 0.6).abs() < 1e-12);
    // At z = 1: sin = 1, so α · 2 / 2.5 = 0.2 on the axis.
    assert!((field.value(DVec3::new(0.5, 0.5, 1.0)) - 0.2).abs() < 1e-12);
}

#[test]
fn unknown_names_and_sizes_are_refused() {
    let said = |name, dims| ProceduralVolume::new(name, dims, 1e-3).err().unwrap().to_string();
    assert!(said("shell", UVec3::ONE).contains("shells, marschner-lobb, sparse-vessels"));
    assert!(said("shells", UVec3::ZERO).contains("must be from 1"));
}
