//! The type of the exported numbers: the smallest that keeps them, or one that is asked for.

use super::{ExportError, Part};
use bricks::volume::Element;
use bricks::{Brick, BrickSource};

/// Integers that are tried, the smallest first.
const INTEGERS: [Element; 4] = [Element::U8, Element::I16, Element::U16, Element::I32];

/// The smallest type that keeps every value of the parts as the store has it (f32 where that takes fractions).
pub(super) fn smallest_element(source: &dyn BrickSource, parts: &[Part]) -> Result<Element, ExportError> {
    let (mut smallest, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut is_integer = true;
    // The coarse levels are means: where there are fractions at all, these have them, and are few.
    for part in parts.iter().rev() {
        if !is_integer {
            break;
        }
        part.bricks(source, |node, brick| {
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

/// Values on their way into a type.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounding {
    pub element: Element,
    /// Smallest and largest number; None if all fit.
    range: Option<(f64, f64)>,
}

impl Rounding {
    pub fn new(element: Element) -> Self {
        Self { element, range: range(element) }
    }

    /// The number that stands for a value: the nearest integer where the type has no others.
    pub fn round(&self, value: f64) -> Result<f64, ExportError> {
        let Some((low, high)) = self.range else { return Ok(value) };
        let rounded = value.round();
        match (low..=high).contains(&rounded) {
            true => Ok(rounded),
            false => Err(ExportError::Fit { value, element: self.element }),
        }
    }
}

/// Smallest and largest number of an integer type. The largest of 64 bits is not an f64: the next lower ones stand for
/// them, since what is compared is f64.
fn range(element: Element) -> Option<(f64, f64)> {
    Some(match element {
        Element::U8 => (0.0, 255.0),
        Element::I8 => (-128.0, 127.0),
        Element::U16 => (0.0, 65_535.0),
        Element::I16 => (-32_768.0, 32_767.0),
        Element::U32 => (0.0, f64::from(u32::MAX)),
        Element::I32 => (f64::from(i32::MIN), f64::from(i32::MAX)),
        Element::U64 => (0.0, (u64::MAX as f64).next_down()),
        Element::I64 => (i64::MIN as f64, (i64::MAX as f64).next_down()),
        Element::F32 | Element::F64 => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_rounded_and_must_fit() {
        let bytes = Rounding::new(Element::U8);
        assert_eq!(bytes.round(254.6).unwrap(), 255.0);
        assert_eq!(bytes.round(-0.4).unwrap(), 0.0);
        let said = bytes.round(255.5).unwrap_err().to_string();
        assert!(said.contains("255.5") && said.contains("uint8"), "{said}");
        assert!(bytes.round(-1.0).is_err());
        assert_eq!(Rounding::new(Element::F64).round(0.1).unwrap(), 0.1);
        assert!(Rounding::new(Element::U64).round(u64::MAX as f64).is_err());
    }
}
