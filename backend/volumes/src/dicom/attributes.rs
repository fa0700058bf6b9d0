//! Values of a DICOM data set, as the reader needs them.

use dicom_core::Tag;
use dicom_object::InMemDicomObject;
use dicom_object::mem::InMemElement;
use glam::DVec3;

/// Where the values of one frame may stand: its own functional groups, those that all frames share, and the data
/// set itself (PS3.3 C.7.6.16).
pub(super) struct FrameAttributes<'a> {
    pub own: Option<&'a InMemDicomObject>,
    pub shared: Option<&'a InMemDicomObject>,
    pub file: &'a InMemDicomObject,
}

impl<'a> FrameAttributes<'a> {
    /// The element `tag`: in the functional group `group` of the frame, then of all frames, then of the file.
    pub fn find(&self, group: Tag, tag: Tag) -> Option<&'a InMemElement> {
        let in_group = |groups: Option<&'a InMemDicomObject>| item(groups?, group)?.get(tag);
        in_group(self.own).or_else(|| in_group(self.shared)).or_else(|| self.file.get(tag))
    }
}

/// First item of a sequence.
pub(super) fn item(object: &InMemDicomObject, sequence: Tag) -> Option<&InMemDicomObject> {
    object.get(sequence)?.items()?.first()
}

/// The text without the blanks around it, and with blanks for line ends and other signs that are no letters; None if
/// there is none.
pub(super) fn text(element: Option<&InMemElement>) -> Option<String> {
    let text = element?.to_str().ok()?;
    let text = text.replace(char::is_control, " ");
    Some(text.trim().to_owned()).filter(|text| !text.is_empty())
}

/// All numbers of an element.
pub(super) fn numbers(element: Option<&InMemElement>) -> Option<Vec<f64>> {
    element?.to_multi_float64().ok().filter(|numbers| !numbers.is_empty())
}

/// The first number of an element.
pub(super) fn number(element: Option<&InMemElement>) -> Option<f64> {
    numbers(element)?.first().copied()
}

/// An integer.
pub(super) fn integer(element: Option<&InMemElement>) -> Option<i64> {
    element?.to_int().ok()
}

/// Three numbers from place `start` of an element.
pub(super) fn vector(element: Option<&InMemElement>, start: usize) -> Option<DVec3> {
    let numbers = numbers(element)?;
    Some(DVec3::from_slice(numbers.get(start..start + 3)?))
}

/// A time, or date and time, as a number that grows with it: its digits, which have the largest unit first.
pub(super) fn time(element: Option<&InMemElement>) -> Option<f64> {
    let text = text(element)?;
    let end = text.find(['+', '-', '\\']).unwrap_or(text.len());
    text[..end].replace(':', "").trim().parse().ok()
}
