//! The vertices of a cut: every point at which a corner of a leaf lies, with the eight cells around it.

use super::{Cut, CutNode};

/// What is around a point: the place of the leaf in each octant (bit 0 = +x, bit 1 = +y, bit 2 = +z); None beyond the
/// root.
pub type Around = [Option<u32>; 8];

/// A part of space that may hold vertices: a point, or an edge, face or cell without its border.
struct Dual<'a, F> {
    cut: &'a Cut,
    visit: &'a mut F,
}

/// Where along an axis a part of a part lies.
#[derive(Clone, Copy, PartialEq)]
enum Half {
    Low,
    Middle,
    High,
}

/// Shows every vertex of the leaves that rays meet, once: the dual traversal of an octree. Takes time in proportion to
/// the nodes.
pub fn visit_vertices(cut: &Cut, visit: &mut impl FnMut(&Around)) {
    let mut dual = Dual { cut, visit };
    for part in 0..27 {
        let halves = halves(part);
        // The root's own border is between it and nothing.
        let around = std::array::from_fn(|octant| {
            let is_beyond = |axis: usize| match halves[axis] {
                Half::Low => octant >> axis & 1 == 0,
                Half::Middle => false,
                Half::High => octant >> axis & 1 == 1,
            };
            (!(0..3).any(is_beyond)).then_some(0)
        });
        dual.descend(around, halves.map(|half| half == Half::Middle));
    }
}

fn halves(part: usize) -> [Half; 3] {
    let of = |digit: usize| [Half::Low, Half::Middle, Half::High][digit % 3];
    [of(part), of(part / 3), of(part / 9)]
}

impl<F: FnMut(&Around)> Dual<'_, F> {
    /// Looks for vertices in a part: `around` are the cells in its octants, the same on both sides along the axes in
    /// which the part `extends`.
    fn descend(&mut self, around: Around, extends: [bool; 3]) {
        let children = around.map(|place| place.and_then(|place| self.children(place)));
        if children.iter().all(Option::is_none) {
            if extends == [false; 3] {
                (self.visit)(&around);
            }
            return;
        }
        for part in 0..27 {
            let halves = halves(part);
            if (0..3).any(|axis| !extends[axis] && halves[axis] != Half::Middle) {
                continue;
            }
            let inner = std::array::from_fn(|octant| match children[octant] {
                Some(first) => Some(first + child_at(octant, halves, extends)),
                None => around[octant],
            });
            self.descend(inner, std::array::from_fn(|axis| halves[axis] != Half::Middle));
        }
    }

    fn children(&self, place: u32) -> Option<u32> {
        CutNode::shown_child(self.cut.node(place))
    }
}

/// The child of the cell in an octant that borders on a part of the part.
fn child_at(octant: usize, halves: [Half; 3], extends: [bool; 3]) -> u32 {
    (0..3).fold(0, |child, axis| {
        let side = octant as u32 >> axis & 1;
        let bit = match halves[axis] {
            Half::Low => 0,
            Half::High => 1,
            // In the middle of a cell its halves lie on their own sides; beside a border, on the border's.
            Half::Middle if extends[axis] => side,
            Half::Middle => 1 - side,
        };
        child | bit << axis
    })
}
