//! Which leaves rays do not meet, while they meet what touches them.
//!
//! No border shows beside such a leaf, as finer neighbours blend down to it. But these are then seen coarser than the
//! display resolves: so the leaf is refined, too, as far as they are, where there is room.

use super::vertices::{BEYOND, visit_vertices_beside};
use super::{Beside, Cut, Memory};

/// How urgent it is to refine a leaf beside what rays meet, levels. Whatever rays find too coarse is more urgent.
pub(super) const URGENCY: f64 = 0.0;

/// Brings [`CutNode::beside`](super::CutNode::beside) of all places up to date with what rays met; `order` has parents
/// before children. Without a memory of rays, nothing is beside what they met.
pub(super) fn mark_beside(cut: &mut Cut, memory: Option<Memory>, order: &[u32]) {
    order.iter().for_each(|&place| cut.node_mut(place).beside = Beside::Nothing);
    let Some(memory) = memory else { return };
    let holds = in_question(cut, memory, order);
    if !holds[0] {
        return;
    }
    let mut found = Vec::new();
    visit_vertices_beside(cut, &holds, &mut |around| {
        let inside = || {
            let inside = around.iter().filter(|&&place| place != BEYOND);
            inside.map(|&place| (place, cut.node(place)))
        };
        let met = inside().filter(|(_, node)| node.is_visible && memory.may_see(node));
        let Some(finest) = met.map(|(_, node)| node.key.depth).max() else { return };
        for (place, node) in inside().filter(|&(place, _)| holds[place as usize]) {
            match node.key.depth.cmp(&finest) {
                std::cmp::Ordering::Less if node.is_visible => found.push((place, Beside::Finer)),
                std::cmp::Ordering::Less | std::cmp::Ordering::Equal => found.push((place, Beside::AsFine)),
                std::cmp::Ordering::Greater => {}
            }
        }
    });
    for (place, beside) in found {
        let node = cut.node_mut(place);
        node.beside = node.beside.max(beside);
    }
}

/// The leaves that may be beside what rays met: short ones that no ray meets, and families of which no ray meets any. So
/// are all places above them.
fn in_question(cut: &Cut, memory: Memory, order: &[u32]) -> Vec<bool> {
    let mut holds = vec![false; cut.nodes().len()];
    for &place in order.iter().rev() {
        let above = cut.node(place);
        let Some(first) = above.shown_child() else { continue };
        let is_met = (first..first + 8).any(|child| memory.may_see(cut.node(child)));
        let is_dark = above.is_visible && !is_met;
        for child in first..first + 8 {
            let node = cut.node(child);
            let is_short = node.is_visible && node.deficit > 0.0 && !memory.may_see(node);
            holds[child as usize] |= node.shown_child().is_none() && (is_dark || is_short);
            holds[place as usize] |= holds[child as usize];
        }
    }
    holds
}
