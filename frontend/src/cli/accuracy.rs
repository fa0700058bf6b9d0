//! The arguments of `lightloom accuracy`.

use super::DeviceArg;
use super::parse::whole;
use clap::Args;
use std::path::PathBuf;

/// `lightloom accuracy`.
#[derive(Clone, Debug, Args)]
pub struct AccuracyArgs {
    /// A .toml scene, a .lloom store, procedural:NAME or procedural:NAME@VOXELS with shells, marschner-lobb or sparse-vessels.
    pub scene: String,
    /// Folder for accuracy.json and accuracy.html; created if missing.
    #[arg(short = 'o', long = "out", value_name = "DIR")]
    pub out: PathBuf,
    /// A display: a preset's name (see `lightloom displays`) or a .toml file.
    #[arg(long, value_name = "DISPLAY", default_value = "holo72")]
    pub display: String,
    /// Which device casts the rays.
    #[arg(long, value_enum, default_value = "auto")]
    pub device: DeviceArg,
    /// Which frame of the scene.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = whole(0..=u32::MAX), allow_hyphen_values = true)]
    pub frame: u32,
    /// Projectors whose pictures are compared and timed; by default one at the side and one near the middle.
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', value_parser = whole(0..=u32::MAX), allow_hyphen_values = true)]
    pub projectors: Vec<u32>,
    /// Compare every N-th pixel along x and y; by default as many as the reference traces in about half a minute.
    #[arg(long, value_name = "N", value_parser = whole(1..=u32::MAX), allow_hyphen_values = true)]
    pub stride: Option<u32>,
    /// How often each setting is timed: an odd number.
    #[arg(long, value_name = "N", default_value = "3", value_parser = odd, allow_hyphen_values = true)]
    pub repetitions: u32,
    /// Try every combination of the settings, hundreds of them, not one at a time around the default.
    #[arg(long)]
    pub full: bool,
    /// Measure everything at the finest level, so that errors of coarser levels hide no others.
    #[arg(long)]
    pub finest: bool,
    /// Brick cache.
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = whole(1..=1_u64 << 30), allow_hyphen_values = true)]
    pub cache_mib: u64,
    /// No progress, no table.
    #[arg(long)]
    pub quiet: bool,
    /// Print the report as JSON on standard output, and nothing else.
    #[arg(long)]
    pub json: bool,
}

fn odd(text: &str) -> Result<u32, String> {
    let number = text.trim().parse().ok().filter(|n: &u32| n % 2 == 1 && *n < 100);
    number.ok_or_else(|| "give an odd number from 1 to 99".to_owned())
}

#[cfg(test)]
mod tests {
    use crate::cli::{AccuracyArgs, Cli, Command};
    use clap::Parser;

    fn parse(rest: &[&str]) -> Result<AccuracyArgs, i32> {
        let all = ["lightloom", "accuracy", "procedural:shells", "-o", "d"].iter().chain(rest);
        Cli::try_parse_from(all).map_err(|error| error.exit_code()).map(|cli| match cli.command {
            Command::Accuracy(args) => args,
            other => panic!("{other:?}"),
        })
    }

    #[test]
    fn projectors_and_repetitions_are_read() {
        let args = parse(&["--projectors", "3,1", "--repetitions", "5", "--stride", "4"]).unwrap();
        assert_eq!((args.projectors, args.repetitions, args.stride), (vec![3, 1], 5, Some(4)));
        assert_eq!(parse(&[]).unwrap().projectors, Vec::<u32>::new());
    }

    #[test]
    fn nonsense_is_a_usage_error() {
        for wrong in [["--projectors", "a"], ["--stride", "0"], ["--repetitions", "4"], ["--frame", "-1"]] {
            assert_eq!(parse(&wrong).map(|_| ()), Err(2), "{wrong:?}");
        }
    }
}
