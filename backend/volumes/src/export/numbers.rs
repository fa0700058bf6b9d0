//! The smallest type that keeps the exported numbers.

use super::rounding::range;
use super::supply::Supply;
use super::{ExportError, Part};
use bricks::Brick;
use bricks::volume::Element;

/// Integers that are tried, the smallest first.
const INTEGERS: [Element; 4] = [Element::U8, Element::I16, Element::U16, Element::I32];

/// The smallest type that keeps every value of the parts as the store has it (f32 where that takes fractions).
pub(super) fn smallest_element(supply: Supply, parts: &[Part]) -> Result<Element, ExportError> {
    let (mut smallest, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut is_integer = true;
    // The coarse levels are means: where there are fractions at all, these have them, and are few.
    for part in parts.iter().rev() {
        if !is_integer {
            break;
        }
        part.bricks(supply, |node, brick| {
            is_integer = has_integers(brick);
            for (index, _, voxels) in part.rows(node) {
                let values = (index..index + voxels).map(|i| brick.value(i));
                values.for_each(|value| (smallest, largest) = (smallest.min(value), largest.max(value)));
            }
            Ok(is_integer)
        })?;
    }
    let fits =
        |element: &&Element| range(**element).is_some_and(|(low, high)| low <= smallest && largest <= high);
    let integer = INTEGERS.iter().find(fits).filter(|_| is_integer);
    Ok(integer.copied().unwrap_or(Element::F32))
}

/// Whether a brick can hold nothing but whole numbers.
fn has_integers(brick: &Brick) -> bool {
    brick.low.fract() == 0.0 && (brick.step == 1.0 || brick.step == 0.0)
}
