//! The arguments that say how frames get their detail.

use clap::Args;
use protocol::Pace;
use std::path::PathBuf;

/// Seconds in which detail appears or goes, unless told otherwise.
pub(super) const FADE_S: f64 = 0.4;
/// MiB that one frame may upload, unless told otherwise.
pub(super) const UPLOAD_MIB: u64 = 64;
/// The longest fade, seconds: an hour is no fade.
const LONGEST_FADE_S: f64 = 3600.0;
/// The largest upload of a frame, MiB.
const MOST_UPLOAD_MIB: u64 = 1 << 20;

/// Live frames, or complete ones.
#[derive(Clone, Debug, Args)]
pub struct LiveArgs {
    /// Draw frames as on a live display: each shows what there is, and detail comes with later ones. Otherwise each
    /// waits until nothing is missing.
    #[arg(long)]
    pub live: bool,
    /// With --live: time in which detail appears or goes; 0 is at once. [default: 0.4]
    #[arg(long, value_name = "SECONDS", requires = "live", value_parser = fade, allow_hyphen_values = true)]
    pub fade: Option<f64>,
    /// With --live: bricks that one frame of a back-end may upload. [default: 64]
    #[arg(long, value_name = "N", requires = "live", value_parser = upload, allow_hyphen_values = true)]
    pub upload_mib: Option<u64>,
    /// With --live: folder for backend-N.trace, what rays of each back-end asked for in every frame, which `lightloom
    /// replay` reads; made if it is not there. Traces of an earlier run go first.
    #[arg(long, value_name = "DIR")]
    pub trace: Option<PathBuf>,
}

impl LiveArgs {
    /// How frames get their detail.
    pub fn pace(&self) -> Pace {
        if !self.live {
            return Pace::Complete;
        }
        Pace::Live {
            upload_bytes: self.upload_mib.unwrap_or(UPLOAD_MIB) << 20,
            fade_s: self.fade.unwrap_or(FADE_S),
        }
    }
}

pub(super) fn fade(text: &str) -> Result<f64, String> {
    let seconds = text.trim().parse().ok().filter(|seconds| (0.0..=LONGEST_FADE_S).contains(seconds));
    seconds.ok_or_else(|| format!("give a number of seconds from 0 to {LONGEST_FADE_S}"))
}

pub(super) fn upload(text: &str) -> Result<u64, String> {
    let mib = text.trim().parse().ok().filter(|mib| (1..=MOST_UPLOAD_MIB).contains(mib));
    mib.ok_or_else(|| format!("give a whole number of MiB from 1 to {MOST_UPLOAD_MIB}"))
}
