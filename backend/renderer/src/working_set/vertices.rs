//! The vertices of a cut: every point at which a corner of a leaf lies, with the eight cells around it.

use super::{Cut, CutNode};

/// Stands for what is beyond the root.
pub const BEYOND: u32 = u32::MAX;

/// What is around a point: the place of the leaf in each octant (bit 0 = +x, bit 1 = +y, bit 2 = +z), or [`BEYOND`].
pub type Around = [u32; 8];

/// The axes along which a part of space has an extent, as bits: none is a point, one an edge, two a face, three a cell,
/// all without their borders. Cells around a part are the same on both sides along these axes.
type Extent = usize;

/// A part of a part.
#[derive(Clone, Copy)]
struct Inner {
    /// Which child of the cell in each octant borders on it.
    child: [u32; 8],
    extent: Extent,
}

/// Where along an axis a part of a part lies.
#[derive(Clone, Copy, PartialEq)]
enum Half {
    Low,
    Middle,
    High,
}

/// A traversal.
struct Dual<'a, F, S> {
    /// Of each place: the first of the children that rays meet, or [`BEYOND`].
    first_child: Vec<u32>,
    /// Whether anything that is looked for may lie around.
    is_sought: S,
    /// The parts that each kind of part is made of.
    parts: [Vec<Inner>; 8],
    visit: &'a mut F,
}

/// Shows every vertex of the leaves that rays meet, once: the dual traversal of an octree. Takes time in proportion to
/// the nodes.
pub fn visit_vertices(cut: &Cut, visit: &mut impl FnMut(&Around)) {
    visit_all(cut, |_| true, visit);
}

/// The same, but only vertices around which a place is that `holds` what is looked for, as all places above it do.
pub(super) fn visit_vertices_beside(cut: &Cut, holds: &[bool], visit: &mut impl FnMut(&Around)) {
    let holds = |&place: &u32| place != BEYOND && holds[place as usize];
    visit_all(cut, |around| around.iter().any(holds), visit);
}

fn visit_all(cut: &Cut, is_sought: impl Fn(&Around) -> bool, visit: &mut impl FnMut(&Around)) {
    let first_child = |node: &CutNode| node.shown_child().unwrap_or(BEYOND);
    let mut dual = Dual {
        first_child: cut.nodes().iter().map(first_child).collect(),
        is_sought,
        parts: std::array::from_fn(parts_of),
        visit,
    };
    for part in 0..27 {
        let halves = halves(part);
        // The root's own border is between it and nothing.
        let around = std::array::from_fn(|octant| {
            let is_beyond = |axis: usize| match halves[axis] {
                Half::Low => octant >> axis & 1 == 0,
                Half::Middle => false,
                Half::High => octant >> axis & 1 == 1,
            };
            if (0..3).any(is_beyond) { BEYOND } else { 0 }
        });
        let extent =
            (0..3).filter(|&axis| halves[axis] == Half::Middle).fold(0, |bits, axis| bits | 1 << axis);
        dual.descend(&around, extent);
    }
}

fn halves(part: usize) -> [Half; 3] {
    let of = |digit: usize| [Half::Low, Half::Middle, Half::High][digit % 3];
    [of(part), of(part / 3), of(part / 9)]
}

/// The parts of a part: a half or the middle along each axis in which it extends.
fn parts_of(extent: Extent) -> Vec<Inner> {
    let extends = |axis: usize| extent >> axis & 1 == 1;
    let is_part = |halves: &[Half; 3]| (0..3).all(|axis| extends(axis) || halves[axis] == Half::Middle);
    let inner = |halves: [Half; 3]| Inner {
        child: std::array::from_fn(|octant| {
            (0..3).fold(0, |child, axis| {
                let side = (octant >> axis & 1) as u32;
                let bit = match halves[axis] {
                    Half::Low => 0,
                    Half::High => 1,
                    // In the middle of a cell its halves lie on their own sides; beside a border, on the border's.
                    Half::Middle if extends(axis) => side,
                    Half::Middle => 1 - side,
                };
                child | bit << axis
            })
        }),
        extent: (0..3).filter(|&axis| halves[axis] != Half::Middle).fold(0, |bits, axis| bits | 1 << axis),
    };
    (0..27).map(halves).filter(is_part).map(inner).collect()
}

impl<F: FnMut(&Around), S: Fn(&Around) -> bool> Dual<'_, F, S> {
    /// Looks for vertices in a part with these cells in its octants.
    fn descend(&mut self, around: &Around, extent: Extent) {
        if !(self.is_sought)(around) {
            return;
        }
        // The first child of each cell, or the cell where it has none: then no number is added to it.
        let (mut first, mut has_children) = (*around, [0; 8]);
        for octant in (0..8).filter(|&octant| around[octant] != BEYOND) {
            let child = self.first_child[around[octant] as usize];
            if child != BEYOND {
                (first[octant], has_children[octant]) = (child, u32::MAX);
            }
        }
        if has_children == [0; 8] {
            if extent == 0 {
                (self.visit)(around);
            }
            return;
        }
        for part in 0..self.parts[extent].len() {
            let Inner { child, extent } = self.parts[extent][part];
            // No branches, so that eight octants go into one or two registers.
            let inner = std::array::from_fn(|octant| first[octant] + (child[octant] & has_children[octant]));
            self.descend(&inner, extent);
        }
    }
}
