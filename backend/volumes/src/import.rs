//! From what a user names, a file or a procedural volume, to a store.

use crate::{Selection, open};
use bricks::procedural::ProceduralVolume;
use bricks::store::{BuildOptions, BuildReport, StoreError, build};
use bricks::volume::VolumeReader;
use glam::UVec3;
use std::path::Path;

/// What an input starts with that names a procedural volume.
pub const PROCEDURAL_PREFIX: &str = "procedural:";

/// How to import.
#[derive(Clone, Debug)]
pub struct ImportOptions {
    /// How to build the store.
    pub build: BuildOptions,
    /// Voxels of a procedural volume along each axis; a file has its own.
    pub procedural_dims: UVec3,
    /// Edge of a procedural volume's voxels in metres.
    pub procedural_voxel_m: f64,
}

impl Default for ImportOptions {
    fn default() -> Self {
        Self { build: BuildOptions::default(), procedural_dims: UVec3::splat(256), procedural_voxel_m: 1e-3 }
    }
}

/// Builds the store `out` from `input`: a volume file (of which `selection` says more), or `procedural:NAME`.
///
/// # Errors
/// Those of [`open`] and [`build`].
pub fn import(
    input: &Path,
    selection: &Selection,
    out: &Path,
    options: &ImportOptions,
    progress: &dyn Fn(u64, u64),
) -> Result<BuildReport, StoreError> {
    // A name that is no text is a file's.
    let procedural = input.to_str().and_then(|input| input.strip_prefix(PROCEDURAL_PREFIX));
    let mut reader: Box<dyn VolumeReader> = match procedural {
        Some(name) => {
            check_no_choice(input, selection)?;
            Box::new(ProceduralVolume::new(name, options.procedural_dims, options.procedural_voxel_m)?)
        }
        None => open(input, selection)?,
    };
    build(reader.as_mut(), out, &options.build, progress)
}

/// A procedural volume is one volume, and its voxels have the size that the options say.
fn check_no_choice(input: &Path, selection: &Selection) -> Result<(), StoreError> {
    let chosen = Selection { memory_bytes: selection.memory_bytes, ..Selection::default() };
    match *selection == chosen {
        true => Ok(()),
        false => Err(StoreError::Input {
            input: input.display().to_string(),
            what: "a procedural volume has no series, levels, channels, times, raw voxels or spacing to choose: leave \
                   such choices out"
                .into(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bricks::BrickSource;
    use bricks::store::Store;

    #[test]
    fn a_procedural_volume_is_imported() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("shells.lloom");
        let options = ImportOptions { procedural_dims: UVec3::new(40, 30, 20), ..Default::default() };
        let told = std::cell::Cell::new((0, 0));
        let report =
            import(Path::new("procedural:shells"), &Selection::default(), &out, &options, &|done, total| {
                told.set((done, total))
            })
            .unwrap();
        assert_eq!(told.get(), (20, 20));
        assert_eq!(Store::open(&out).unwrap().shape().dims(), report.dims);
        let error = import(Path::new("procedural:shell"), &Selection::default(), &out, &options, &|_, _| {})
            .unwrap_err();
        assert!(error.to_string().contains("sparse-vessels"));
        let input = folder.path().join("a.nrrd");
        std::fs::copy(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/short.nrrd"), &input).unwrap();
        let error = import(&input, &Selection::default(), &input, &options, &|_, _| {}).unwrap_err();
        assert!(error.to_string().contains("not a lightloom store"), "{error}");
    }

    #[test]
    fn nothing_of_a_procedural_volume_is_chosen_in_silence() {
        let folder = tempfile::tempdir().unwrap();
        let options = ImportOptions { procedural_dims: UVec3::splat(4), ..Default::default() };
        for selection in [
            Selection { level: Some(0), ..Default::default() },
            Selection { series: Some("1".into()), ..Default::default() },
            Selection { spacing_mm: Some(glam::DVec3::ONE), ..Default::default() },
        ] {
            let out = folder.path().join("a.lloom");
            let error = import(Path::new("procedural:shells"), &selection, &out, &options, &|_, _| {});
            assert!(error.unwrap_err().to_string().contains("leave such choices out"), "{selection:?}");
            assert!(!out.exists());
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_name_need_not_be_text() {
        use std::os::unix::ffi::OsStrExt;
        let folder = tempfile::tempdir().unwrap();
        let name = |bytes: &[u8]| folder.path().join(std::ffi::OsStr::from_bytes(bytes));
        let (input, out) = (name(b"\xff.nrrd"), name(b"\xfe.lloom"));
        std::fs::copy(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/short.nrrd"), &input).unwrap();
        import(&input, &Selection::default(), &out, &ImportOptions::default(), &|_, _| {}).unwrap();
        Store::open(&out).unwrap();
    }

    #[test]
    fn a_real_file_with_nan_is_imported() {
        let folder = tempfile::tempdir().unwrap();
        let input = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/non_finite.nrrd");
        let report = import(
            Path::new(input),
            &Selection::default(),
            &folder.path().join("a.lloom"),
            &ImportOptions::default(),
            &|_, _| {},
        )
        .unwrap();
        assert_eq!((report.non_finite, report.value_range), (3, (1.0, 353.0)));
    }
}
