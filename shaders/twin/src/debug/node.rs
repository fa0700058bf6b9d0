//! Debug views of nodes: light in the colour of the node that it comes from, as opaque as it is.

use super::heat;
use crate::composite::Light;
use crate::traverse::{OWN_EDGE, node_low, voxel_edge};
use crate::{Casting, Real, ray::Ray, vector::Vec3};
use layout::NodeRecord;
use optics::DebugView;

/// Share of the node's own samples at a point, between its eight corners.
fn weight<F: Real>(finest: u32, node: &NodeRecord, point: Vec3<F>) -> F {
    let edge = F::of(OWN_EDGE) * voxel_edge::<F>(finest, node.depth);
    let [x, y, z] = (point - node_low(finest, node)).map(|c| (c / edge).most(F::ZERO).least(F::ONE)).0;
    let corner = |i: usize| F::of_u32(node.weights[i / 4] >> (8 * (i % 4)) & 255) / F::of(255.0);
    let mix = |a: F, b: F, share: F| a + (b - a) * share;
    let face = |i: usize| mix(corner(i), corner(i + 4), z);
    mix(mix(face(0), face(2), y), mix(face(1), face(3), y), x)
}

/// What a view shows of a node, in its own unit.
fn value<F: Real>(finest: u32, view: DebugView, node: &NodeRecord, point: Vec3<F>) -> F {
    match view {
        DebugView::Lod => F::of_u32(finest - node.depth),
        DebugView::Deficit => F::of_f32(node.deficit),
        DebugView::Weights | DebugView::Samples => weight(finest, node, point),
    }
}

/// A segment's light around t, as a view shows it.
#[inline(never)]
pub(super) fn light<F: Real>(
    casting: &Casting<F>,
    view: DebugView,
    light: Light<F>,
    (ray, t): (&Ray<F>, F),
) -> Light<F> {
    let point = ray.point(t);
    // From the root, so that nothing has to be carried along the ray for this.
    let node = &casting.volume.nodes[casting.leaf_at(point, ray) as usize];
    let value = value(casting.scene.finest_depth, view, node, point);
    let (least, most) = view.scale();
    let share = ((value - F::of(least)) / F::of(most - least)).most(F::ZERO).least(F::ONE);
    let (low, high) = view.colours();
    Light { rgb: heat(F::of(low) + F::of(high - low) * share) * light.alpha, alpha: light.alpha }
}

#[cfg(test)]
mod tests {
    use super::*;
    use layout::{NO_NODE, pack_weights};

    #[test]
    fn weights_are_trilinear_between_corners() {
        let node = NodeRecord {
            cell: [1, 0, 2],
            depth: 2,
            parent: 0,
            first_child: NO_NODE,
            slot: 0,
            deficit: 0.0,
            offset: 0.0,
            scale: 1.0,
            neighbours: [NO_NODE; 6],
            most_extinction: 1.0,
            weights: pack_weights([0.0, 1.0, 0.0, 1.0, 0.2, 1.0, 0.2, 1.0]),
            deviation_scale: 0.0,
        };
        let at = |x: f64, y: f64, z: f64| weight(3, &node, Vec3([56.0 + x, y, 112.0 + z]));
        assert_eq!((at(0.0, 9.0, 0.0), at(56.0, 50.0, 30.0)), (0.0, 1.0));
        assert!((at(14.0, 3.0, 0.0) - 0.25).abs() < 1e-12);
        assert!((at(0.0, 3.0, 28.0) - 0.1).abs() < 1e-12);
        assert_eq!(at(-3.0, 0.0, -1.0), 0.0, "beyond a corner is the corner");
    }
}
