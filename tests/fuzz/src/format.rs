//! Formats of volume inputs: the first byte of an input is one's place in the list.

/// What the rest of an input is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A file as it is.
    File,
    /// A file that is to be packed by gzip first: random changes do not get through the checksum of a packed one.
    Packed,
    /// Raw voxels, after their layout.
    Raw,
    /// A folder with this file in it.
    Folder,
    /// A Zarr array: its description and a chunk, parted by a zero byte.
    Zarr,
}

/// The name that an input gets, and what it is.
pub const FORMATS: [(&str, Form); 16] = [
    ("input.nrrd", Form::File),
    ("input.nhdr", Form::File),
    ("input.nii", Form::File),
    ("input.nii.gz", Form::Packed),
    ("input.nii.gz", Form::File),
    ("input.hdr", Form::File),
    ("input.hdr.gz", Form::Packed),
    ("input.mha", Form::File),
    ("input.mhd", Form::File),
    ("input.tif", Form::File),
    ("input.dcm", Form::File),
    ("slice.dcm", Form::Folder),
    ("slice.tif", Form::Folder),
    ("zarr.json", Form::Zarr),
    (".zarray", Form::Zarr),
    ("input.raw", Form::Raw),
];

/// The first byte of an input of a form under a name.
pub fn number(name: &str, form: Form) -> u8 {
    let place = FORMATS.iter().position(|format| *format == (name, form));
    u8::try_from(place.expect("a format of the list")).expect("a short list")
}
