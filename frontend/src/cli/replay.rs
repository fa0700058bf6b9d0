//! The arguments of `lightloom replay`.

use super::live::{FADE_S, UPLOAD_MIB, fade, upload};
use super::parse::whole;
use clap::{Args, ValueEnum};
use renderer::working_set::{DiskModel, FetchOrder};
use std::path::PathBuf;

/// `lightloom replay`: every combination of its lists is tried.
#[derive(Clone, Debug, Args)]
pub struct ReplayArgs {
    /// Traces of `lightloom simulate --live --trace`, one for each back-end.
    #[arg(value_name = "TRACE", required = true)]
    pub traces: Vec<PathBuf>,
    /// Brick caches of a back-end.
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "1024", value_parser = whole(1..=1_u64 << 30), allow_hyphen_values = true)]
    pub cache_mib: Vec<u64>,
    /// Bricks that one frame of a back-end may upload.
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_values_t = [UPLOAD_MIB], value_parser = upload, allow_hyphen_values = true)]
    pub upload_mib: Vec<u64>,
    /// Disks: MB (10⁶ bytes) per second, or inf, and milliseconds from the beginning of a read to its first byte.
    #[arg(long, value_name = "MB_PER_S:LATENCY_MS,…", value_delimiter = ',', default_value = "2000:0.1", value_parser = disk, allow_hyphen_values = true)]
    pub disk: Vec<DiskArg>,
    /// Reads that a back-end has under way at the same time.
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = whole(1..=u16::MAX), allow_hyphen_values = true)]
    pub threads: u16,
    /// Seconds in which detail appears or disappears; 0 means at once.
    #[arg(long, value_name = "SECONDS,…", value_delimiter = ',', default_values_t = [FADE_S], value_parser = fade, allow_hyphen_values = true)]
    pub fade: Vec<f64>,
    /// What is fetched first.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', default_value = "deficit", value_enum)]
    pub order: Vec<FetchOrderArg>,
    /// The store that was recorded, if it has moved since.
    #[arg(long, value_name = "STORE.lloom")]
    pub volume: Option<PathBuf>,
    /// Print the figures as JSON on standard output, and nothing else.
    #[arg(long)]
    pub json: bool,
}

/// A disk as it is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiskArg {
    /// 10⁶ bytes per second; may be ∞.
    pub mb_per_s: f64,
    /// From the beginning of a read to its first byte, milliseconds.
    pub latency_ms: f64,
}

impl DiskArg {
    /// The disk with so many reads at a time.
    pub fn model(&self, threads: u16) -> DiskModel {
        DiskModel {
            bytes_per_s: self.mb_per_s * 1e6,
            latency_s: self.latency_ms * 1e-3,
            threads: usize::from(threads),
        }
    }
}

/// See [`FetchOrder`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FetchOrderArg {
    /// The largest deficit, then the most rays: what the renderer does.
    Deficit,
    /// The most rays alone.
    Rays,
    /// First come, first served.
    Arrival,
}

impl From<FetchOrderArg> for FetchOrder {
    fn from(order: FetchOrderArg) -> Self {
        match order {
            FetchOrderArg::Deficit => FetchOrder::Deficit,
            FetchOrderArg::Rays => FetchOrder::Rays,
            FetchOrderArg::Arrival => FetchOrder::Arrival,
        }
    }
}

fn disk(text: &str) -> Result<DiskArg, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let parts = text.split_once(':').and_then(|(rate, wait)| Some((number(rate)?, number(wait)?)));
    let disk = parts.map(|(mb_per_s, latency_ms)| DiskArg { mb_per_s, latency_ms });
    disk.filter(|disk| disk.mb_per_s > 0.0 && disk.latency_ms >= 0.0 && disk.latency_ms.is_finite())
        .ok_or_else(|| {
            "give MB per second above 0 and milliseconds from 0 up, such as 500:1 or inf:0".to_owned()
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Cli, Command};
    use clap::Parser;

    fn parse(rest: &[&str]) -> Result<ReplayArgs, clap::Error> {
        let all = ["lightloom", "replay"].iter().chain(rest);
        Cli::try_parse_from(all).map(|cli| match cli.command {
            Command::Replay(args) => args,
            other => panic!("{other:?}"),
        })
    }

    #[test]
    fn lists_are_read() {
        let args = parse(&[
            "a.trace",
            "b.trace",
            "--cache-mib",
            "64,256",
            "--upload-mib",
            "1,8",
            "--disk",
            "500:0.5,inf:0",
            "--fade",
            "0,0.4",
            "--order",
            "deficit,rays,arrival",
            "--threads",
            "4",
        ]);
        let args = args.unwrap();
        assert_eq!((args.traces.len(), args.cache_mib, args.upload_mib), (2, vec![64, 256], vec![1, 8]));
        assert_eq!(args.disk[0], DiskArg { mb_per_s: 500.0, latency_ms: 0.5 });
        assert_eq!(args.disk[1].model(args.threads).bytes_per_s, f64::INFINITY);
        assert_eq!(args.disk[0].model(4), DiskModel { bytes_per_s: 5e8, latency_s: 5e-4, threads: 4 });
        assert_eq!((args.fade, args.order.len(), args.threads), (vec![0.0, 0.4], 3, 4));
    }

    #[test]
    fn without_lists_it_is_what_simulate_does() {
        let args = parse(&["a.trace"]).unwrap();
        assert_eq!((args.cache_mib, args.upload_mib, args.fade), (vec![1024], vec![64], vec![0.4]));
        assert_eq!(args.order, [FetchOrderArg::Deficit]);
    }

    #[test]
    fn nonsense_is_a_usage_error() {
        let wrong: [&[&str]; 9] = [
            &[],
            &["a", "--cache-mib", "0"],
            &["a", "--cache-mib", "64,"],
            &["a", "--upload-mib", "-1"],
            &["a", "--disk", "500"],
            &["a", "--disk", "0:1"],
            &["a", "--disk", "500:inf"],
            &["a", "--fade", "nan"],
            &["a", "--order", "random"],
        ];
        for rest in wrong {
            assert_eq!(parse(rest).unwrap_err().exit_code(), 2, "{rest:?}");
        }
        assert!(parse(&["a", "--disk", "7"]).unwrap_err().to_string().contains("such as 500:1 or inf:0"));
    }
}
