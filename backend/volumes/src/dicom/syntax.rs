//! How DICOM files begin, and the transfer syntaxes that matter here.

use dicom_dictionary_std::uids;

/// What a Part 10 file starts with after its preamble of so many bytes; some files lack the preamble.
pub(super) const MAGIC: &[u8] = b"DICM";
pub(super) const PREAMBLE_BYTES: usize = 128;

/// Whether frames lie in files of this transfer syntax as they are, lowest byte first.
pub(super) fn is_plain(syntax: &str) -> bool {
    matches!(syntax, uids::IMPLICIT_VR_LITTLE_ENDIAN | uids::EXPLICIT_VR_LITTLE_ENDIAN)
}

/// Highest byte first, which the standard has since retired.
pub(super) const BIG_ENDIAN: &str = "1.2.840.10008.1.2.2";
