//! The field of an NRRD header that says where the voxels are.

/// Names of the field that says where the voxels are.
pub(super) const DATA_FILE: [&str; 2] = ["data file", "datafile"];

/// The value of that field, before the names of several files on the lines that follow.
pub(super) const LIST: &str = "LIST";

/// Whether the value of that field has the names of several files follow.
pub(super) fn is_list(value: &str) -> bool {
    value.split_whitespace().next() == Some(LIST)
}
