//! `lightloom replay`.

use super::say::say;
use crate::FrontendError;
use crate::adapter::{ReplayRow, Traces};
use crate::cli::{DiskArg, FetchOrderArg, ReplayArgs};
use clap::ValueEnum;
use display_config::text::brief_number;
use renderer::working_set::Policy;

/// A policy as the command line names it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Named {
    cache_mib: u64,
    upload_mib: u64,
    disk: DiskArg,
    threads: u16,
    fade_s: f64,
    order: FetchOrderArg,
}

/// Replays every combination of the lists, and prints a row for each as soon as it is there.
pub(super) fn replay(args: &ReplayArgs) -> Result<(), FrontendError> {
    let traces = Traces::open(&args.traces, args.volume.as_deref())?;
    let mut rows = Vec::new();
    if !args.json {
        say(&heading())?;
    }
    for policy in combinations(args) {
        let row = policy.row(&traces);
        if !args.json {
            say(&line(&row))?;
        }
        rows.push(row);
    }
    if args.json {
        say(&serde_json::to_string_pretty(&rows)?)?;
    }
    Ok(())
}

/// The last list changes fastest.
fn combinations(args: &ReplayArgs) -> Vec<Named> {
    let mut all = Vec::new();
    for &cache_mib in &args.cache_mib {
        for &upload_mib in &args.upload_mib {
            for &disk in &args.disk {
                for &fade_s in &args.fade {
                    let named =
                        |&order| Named { cache_mib, upload_mib, disk, threads: args.threads, fade_s, order };
                    all.extend(args.order.iter().map(named));
                }
            }
        }
    }
    all
}

impl Named {
    fn policy(&self) -> Policy {
        Policy {
            cache_bytes: self.cache_mib << 20,
            upload_bytes: self.upload_mib << 20,
            disk: self.disk.model(self.threads),
            fade_s: self.fade_s,
            order: self.order.into(),
        }
    }

    fn row(&self, traces: &Traces) -> ReplayRow {
        let account = traces.replay(&self.policy());
        let order = self.order.to_possible_value().map_or(String::new(), |value| value.get_name().to_owned());
        ReplayRow {
            cache_mib: self.cache_mib,
            upload_mib: self.upload_mib,
            disk_mb_per_s: self.disk.mb_per_s,
            disk_latency_ms: self.disk.latency_ms,
            threads: self.threads,
            fade_s: self.fade_s,
            order,
            frames: account.frames,
            bricks_loaded: account.bricks_loaded,
            loaded_again: account.loaded_again,
            mb_read: account.bytes_read as f64 * 1e-6,
            mean_deficit: account.mean_deficit,
            high_deficit: account.high_deficit,
            deficit_at_end: account.deficit_at_end,
            seconds_to_rest: account.seconds_to_rest,
            splits: account.splits,
            collapses: account.collapses,
            update_ms: account.update_ms,
        }
    }
}

/// Names of the columns and their widths.
const COLUMNS: [(&str, usize); 15] = [
    ("cache MiB", 9),
    ("upload MiB", 11),
    ("disk MB/s:ms", 13),
    ("fade s", 7),
    ("order", 8),
    ("bricks", 9),
    ("again", 7),
    ("MB read", 9),
    ("mean", 7),
    ("99 %", 7),
    ("at end", 7),
    ("rest s", 7),
    ("splits", 8),
    ("collapses", 10),
    ("update ms", 10),
];

fn heading() -> String {
    aligned(COLUMNS.map(|(name, _)| name.to_owned()))
}

fn line(row: &ReplayRow) -> String {
    aligned([
        row.cache_mib.to_string(),
        row.upload_mib.to_string(),
        format!("{}:{}", brief_number(row.disk_mb_per_s), brief_number(row.disk_latency_ms)),
        row.fade_s.to_string(),
        row.order.clone(),
        row.bricks_loaded.to_string(),
        row.loaded_again.to_string(),
        format!("{:.1}", row.mb_read),
        format!("{:.3}", row.mean_deficit),
        format!("{:.3}", row.high_deficit),
        format!("{:.3}", row.deficit_at_end),
        row.seconds_to_rest.map_or("never".to_owned(), |seconds| format!("{seconds:.2}")),
        row.splits.to_string(),
        row.collapses.to_string(),
        format!("{:.2}", row.update_ms),
    ])
}

fn aligned(cells: [String; COLUMNS.len()]) -> String {
    let padded = cells.iter().zip(COLUMNS).map(|(cell, (_, width))| format!("{cell:>width$}"));
    padded.collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Cli, Command};
    use clap::Parser;

    fn args(rest: &[&str]) -> ReplayArgs {
        match Cli::try_parse_from(["lightloom", "replay", "a.trace"].iter().chain(rest)).unwrap().command {
            Command::Replay(args) => args,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn every_combination_is_tried_once() {
        let args = args(&["--cache-mib", "1,2", "--disk", "1:1,2:2,3:3", "--order", "rays,arrival"]);
        let all = combinations(&args);
        assert_eq!(all.len(), 12);
        assert!((0..12).all(|i| !all[..i].contains(&all[i])));
        assert_eq!((all[0].order, all[1].order), (FetchOrderArg::Rays, FetchOrderArg::Arrival));
        assert_eq!(all[11].policy().cache_bytes, 2 << 20);
    }

    #[test]
    fn columns_line_up() {
        let row = ReplayRow {
            cache_mib: 1024,
            upload_mib: 64,
            disk_mb_per_s: f64::INFINITY,
            disk_latency_ms: 0.25,
            threads: 8,
            fade_s: 0.4,
            order: "arrival".into(),
            frames: 180,
            bricks_loaded: 123_456,
            loaded_again: 789,
            mb_read: 8090.8,
            mean_deficit: 0.125,
            high_deficit: 7.0,
            deficit_at_end: 0.0,
            seconds_to_rest: None,
            splits: 20_000,
            collapses: 19_000,
            update_ms: 3.25,
        };
        let (heading, line) = (heading(), line(&row));
        assert_eq!(heading.chars().count(), line.chars().count(), "\n{heading}\n{line}");
        assert!(line.contains("inf:0.25") && line.contains("never"));
        let json = serde_json::to_value(&row).unwrap();
        assert!(json["disk_mb_per_s"].is_null() && json["seconds_to_rest"].is_null());
    }
}
