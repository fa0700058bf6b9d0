//! The arguments that decide how frames get their detail.

use clap::Args;
use protocol::Pace;
use std::path::PathBuf;

/// Seconds in which detail appears or goes, by default.
pub(super) const FADE_S: f64 = 0.4;
/// MiB that one frame may upload, by default.
pub(super) const UPLOAD_MIB: u64 = 64;
/// The longest fade, seconds: longer than an hour makes no sense.
const LONGEST_FADE_S: f64 = 3600.0;
/// The largest upload of a frame, MiB.
const MOST_UPLOAD_MIB: u64 = 1 << 20;

/// Live frames, or complete ones.
#[derive(Clone, Debug, Args)]
pub struct LiveArgs {
    /// Draw frames as on a live display: each shows what is there, and detail arrives with later ones. Otherwise each
    /// waits until nothing is missing.
    #[arg(long)]
    pub live: bool,
    /// With --live: time in which detail appears or disappears; 0 means at once. [default: 0.4]
    #[arg(long, value_name = "SECONDS", requires = "live", value_parser = fade, allow_hyphen_values = true)]
    pub fade: Option<f64>,
    /// With --live: how much one frame of a back-end may upload. [default: 64]
    #[arg(long, value_name = "N", requires = "live", value_parser = upload, allow_hyphen_values = true)]
    pub upload_mib: Option<u64>,
    /// With --live: folder for the files backend-N.trace, which record what the rays of each back-end asked for in every
    /// frame, for `lightloom replay`. Created if missing; they take the place of an earlier run's once this one ends or is stopped.
    #[arg(long, value_name = "DIR")]
    pub trace: Option<PathBuf>,
}

impl LiveArgs {
    /// How frames get their detail.
    pub fn pace(&self) -> Pace {
        if !self.live {
            return Pace::Complete;
        }
        live_pace(self.upload_mib, self.fade)
    }
}

/// The pace of live frames, where the command line leaves some of it open.
pub(super) fn live_pace(upload_mib: Option<u64>, fade_s: Option<f64>) -> Pace {
    Pace::Live { upload_bytes: upload_mib.unwrap_or(UPLOAD_MIB) << 20, fade_s: fade_s.unwrap_or(FADE_S) }
}

pub(super) fn fade(text: &str) -> Result<f64, String> {
    let seconds = text.trim().parse().ok().filter(|seconds| (0.0..=LONGEST_FADE_S).contains(seconds));
    seconds.ok_or_else(|| format!("give a number of seconds from 0 to {LONGEST_FADE_S}"))
}

pub(super) fn upload(text: &str) -> Result<u64, String> {
    let mib = text.trim().parse().ok().filter(|mib| (1..=MOST_UPLOAD_MIB).contains(mib));
    mib.ok_or_else(|| format!("give a whole number of MiB from 1 to {MOST_UPLOAD_MIB}"))
}
