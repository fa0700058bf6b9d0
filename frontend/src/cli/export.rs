//! The arguments of `lightloom export`.

use super::parse::{dims, place, whole};
use bricks::volume::Element;
use clap::Args;
use glam::UVec3;
use std::path::PathBuf;
use volumes::export::ExportOptions;

/// `lightloom export`.
#[derive(Clone, Debug, Args)]
pub struct ExportArgs {
    /// A .lloom store.
    pub store: PathBuf,
    /// What to write: a .nrrd file, or a .zarr folder (OME-Zarr 0.5). Existing files are not replaced.
    #[arg(value_name = "OUT.nrrd|OUT.zarr")]
    pub output: PathBuf,
    /// Level of the store, 0 = finest; by default the finest, or all levels of an OME-Zarr image.
    #[arg(long, value_name = "L", value_parser = whole(0..=u8::MAX), allow_hyphen_values = true)]
    pub level: Option<u8>,
    /// First voxel of the part to write, in voxels of the level.
    #[arg(long, value_name = "X,Y,Z", value_parser = place, allow_hyphen_values = true)]
    pub low: Option<UVec3>,
    /// Voxels of the part to write; by default all that follow the first one.
    #[arg(long, value_name = "X,Y,Z", value_parser = dims, allow_hyphen_values = true)]
    pub size: Option<UVec3>,
    /// Type of the numbers, to which they are rounded: uint8, int16, float, …; by default the smallest that loses nothing.
    #[arg(long = "type", value_name = "TYPE", value_parser = element)]
    pub element: Option<Element>,
    /// Pack an NRRD file with gzip; OME-Zarr is always packed.
    #[arg(long)]
    pub compress: bool,
    /// No progress, no summary.
    #[arg(long)]
    pub quiet: bool,
    /// Print what was done as JSON on standard output, and nothing else.
    #[arg(long)]
    pub json: bool,
}

impl ExportArgs {
    /// What to export, and how.
    pub fn options(&self) -> ExportOptions {
        ExportOptions {
            level: self.level,
            low: self.low,
            size: self.size,
            element: self.element,
            is_packed: self.compress,
            stop: None,
        }
    }
}

fn element(text: &str) -> Result<Element, String> {
    Element::from_name(text).ok_or_else(|| "give uint8, int16, float or the like".to_owned())
}

#[cfg(test)]
mod tests {
    use crate::cli::{Cli, Command};
    use bricks::volume::Element;
    use clap::Parser;
    use glam::UVec3;

    #[test]
    fn a_part_and_a_type_are_read() {
        let parse = |rest: &[&str]| {
            let all = ["lightloom", "export", "a.lloom", "a.nrrd"].iter().chain(rest);
            Cli::try_parse_from(all).map(|cli| match cli.command {
                Command::Export(args) => args,
                other => panic!("{other:?}"),
            })
        };
        let args = parse(&["--level", "2", "--low", "0,1,2", "--size", "3,4,5", "--type", "uint8"]).unwrap();
        assert_eq!((args.level, args.low), (Some(2), Some(UVec3::new(0, 1, 2))));
        assert_eq!((args.size, args.element), (Some(UVec3::new(3, 4, 5)), Some(Element::U8)));
        for wrong in [["--size", "0,1,1"], ["--low", "1,2"], ["--type", "block"], ["--level", "-1"]] {
            assert_eq!(parse(&wrong).unwrap_err().exit_code(), 2, "{wrong:?}");
        }
    }
}
