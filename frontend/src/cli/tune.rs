//! The arguments of `lightloom tune`.

use super::parse::picture_size;
use crate::scene::QualityPreset;
use clap::Args;
use glam::UVec2;
use std::convert::Infallible;
use std::path::PathBuf;
use std::time::Duration;

/// `lightloom tune`.
#[derive(Clone, Debug, Args)]
pub struct TuneArgs {
    /// Scenes: each a .toml scene, a .lloom store, procedural:NAME or procedural:NAME@VOXELS. Each is turned and has its
    /// extinction changed; the first is cut by a plane, too.
    #[arg(required = true, value_name = "SCENE")]
    pub scenes: Vec<String>,
    /// Folder for tune.json, tune.html and the worst instants; created if missing.
    #[arg(short = 'o', long = "out", value_name = "DIR")]
    pub out: PathBuf,
    /// Also what visitors did when this tape was recorded, to each scene; repeatable. `shipped` are the tapes that come with
    /// the program: `handling`, a hand that turns and moves the volume and changes its look, and `cutting`, a knife, a light
    /// and a hand.
    #[arg(long = "tape", value_name = "TAPE.mcap", value_parser = tape)]
    pub tapes: Vec<TapeChoice>,
    /// The tapes alone.
    #[arg(long, requires = "tapes")]
    pub only_tapes: bool,
    /// A display: a preset's name (see `lightloom displays`) or a .toml file.
    #[arg(long, value_name = "DISPLAY", default_value = "desk8")]
    pub display: String,
    /// Pixels of each projector's picture in place of the display's: all of them are kept for every instant.
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "160x120", value_parser = picture_size, allow_hyphen_values = true)]
    pub size: UVec2,
    /// Seconds that a complete picture takes the machines that are simulated.
    #[arg(long, value_name = "SECONDS,…", value_delimiter = ',', default_values = ["0.1", "0.4", "1.6"], value_parser = full, allow_hyphen_values = true)]
    pub machines: Vec<Duration>,
    /// Quality, overriding the scenes'.
    #[arg(long, value_enum)]
    pub quality: Option<QualityPreset>,
    /// No progress, no summary.
    #[arg(long)]
    pub quiet: bool,
    /// Print the report as JSON on standard output, and nothing else.
    #[arg(long)]
    pub json: bool,
}

/// Which tape is played.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TapeChoice {
    /// All that come with the program.
    Shipped,
    /// A file.
    File(PathBuf),
}

fn tape(text: &str) -> Result<TapeChoice, Infallible> {
    Ok(if text == "shipped" { TapeChoice::Shipped } else { TapeChoice::File(text.into()) })
}

/// A machine that is faster than this shows every instant complete; a slower one shows nothing worth judging.
const FULL_S: std::ops::RangeInclusive<f64> = 1e-3..=100.0;

fn full(text: &str) -> Result<Duration, String> {
    let seconds = text.trim().parse().ok().filter(|seconds| FULL_S.contains(seconds));
    seconds.map(Duration::from_secs_f64).ok_or_else(|| "give seconds from 0.001 to 100".to_owned())
}

#[cfg(test)]
mod tests {
    use crate::cli::{Cli, Command, TapeChoice};
    use clap::Parser;

    #[test]
    fn machines_are_read_and_nonsense_is_a_usage_error() {
        let parse = |rest: &[&str]| {
            let all = ["lightloom", "tune", "procedural:shells", "-o", "d"].iter().chain(rest);
            Cli::try_parse_from(all).map_err(|error| error.exit_code())
        };
        let Ok(Command::Tune(args)) = parse(&["--machines", "0.5,2"]).map(|cli| cli.command) else {
            panic!()
        };
        assert_eq!(args.machines.iter().map(|full| full.as_millis()).collect::<Vec<_>>(), [500, 2000]);
        let Ok(Command::Tune(args)) =
            parse(&["--tape", "shipped", "--tape", "a.mcap", "--only-tapes"]).map(|cli| cli.command)
        else {
            panic!()
        };
        assert!(args.only_tapes);
        assert_eq!(args.tapes, [TapeChoice::Shipped, TapeChoice::File("a.mcap".into())]);
        assert_eq!(parse(&["--only-tapes"]).map(|_| ()), Err(2));
        for wrong in [["--machines", "0"], ["--machines", "fast"], ["--size", "0x4"]] {
            assert_eq!(parse(&wrong).map(|_| ()), Err(2), "{wrong:?}");
        }
    }
}
