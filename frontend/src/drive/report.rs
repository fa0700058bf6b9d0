//! What a show reports when it is over: JSON for programs, and a page for people.

use super::{BeatSummary, ControlSummary, Played};
use crate::FrontendError;
use crate::report::html::{escape, facts, table};
use crate::report::page::STYLE;
use crate::report::{BackendSummary, Quantiles, write_text};
use control::Rule;
use serde::Serialize;
use std::path::Path;

/// The report for programs.
const JSON: &str = "drive.json";
/// The page for people.
const HTML: &str = "drive.html";

/// A report.
#[derive(Clone, Debug, Serialize)]
pub struct DriveReport {
    /// The scene's name.
    pub scene: String,
    /// The display's name.
    pub display: String,
    /// Its projectors.
    pub projectors: usize,
    /// Frames a second that were asked for.
    pub rate_hz: f64,
    /// Whether each frame casts a quarter of its pixels.
    pub reconstructs: bool,
    /// What decides what is cast and what is shown; None where each frame is drawn and shown.
    pub control: Option<Rule>,
    /// What the processors of the front-end's host took meanwhile, joules, where the machine tells.
    pub joules: Option<f64>,
    /// Whether time stood still while a frame was drawn.
    pub stepped: bool,
    /// How long it lasted, seconds of the display's clock.
    pub seconds: f64,
    /// What drew it.
    pub backends: Vec<BackendSummary>,
    /// How it went.
    #[serde(flatten)]
    pub played: Played,
}

impl DriveReport {
    /// What is told on a terminal, in one line.
    pub fn line(&self) -> String {
        let BeatSummary { frames, interval_ms, skew_ms, input_to_shown_ms, backends, .. } = &self.played.beat;
        let late: u64 = backends.iter().map(|backend| backend.late).sum();
        let rate_hz = if interval_ms.p50 > 0.0 { 1e3 / interval_ms.p50 } else { 0.0 };
        let control = self.played.control.as_ref().map(|control| {
            let ControlSummary { begun, mean_share, mean_errors: [spatial, temporal], .. } = control;
            format!(
                "; {begun} pictures begun, shown with {:.0} % of their rays, ζ {:.2}, τ {:.2} of 255",
                100.0 * mean_share,
                255.0 * spatial,
                255.0 * temporal
            )
        });
        let control = control.unwrap_or_default();
        format!(
            "{frames} frames in {:.1} s, {rate_hz:.1} a second; from input to screen {:.1} ms (99 %: {:.1}); \
             skew {:.2} ms (99 %: {:.2}); {late} late{control}",
            self.seconds, input_to_shown_ms.p50, input_to_shown_ms.p99, skew_ms.p50, skew_ms.p99,
        )
    }

    /// Writes it into a folder.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), FrontendError> {
        write_text(&folder.join(JSON), &serde_json::to_string_pretty(self)?)?;
        Ok(write_text(&folder.join(HTML), &self.page())?)
    }

    fn page(&self) -> String {
        let plot = &self.played.plot;
        let title = escape(&self.scene);
        let sentences = |heading: &str, sentences: &[String]| match sentences {
            [] => String::new(),
            some => {
                let items: String = some.iter().map(|one| format!("<li>{}</li>", escape(one))).collect();
                format!("<h2>{heading}</h2><ul>{items}</ul>")
            }
        };
        format!(
            "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">\
             <meta name=\"viewport\" content=\"width=device-width\"><title>{title} · lightloom</title>\
             <style>{STYLE}</style></head><body><main><header><h1>{title}</h1><p>driven on {}</p></header>\
             {}<h2>The beat</h2>{}{plot}{}<h2>Back-ends</h2>{}{}{}</main></body></html>\n",
            escape(&self.display),
            self.setting(),
            self.times(),
            self.control(),
            self.table_of_backends(),
            sentences("Not complete", &self.played.shortfall),
            sentences("What happened", &self.played.troubles),
        )
    }

    fn setting(&self) -> String {
        let casts = if self.control.is_some() {
            "as much of its picture as fits, see below"
        } else if self.reconstructs {
            "a quarter of its pixels, and reconstructs the others"
        } else {
            "all pixels"
        };
        let clock = if self.stepped { "stands still while a frame is drawn" } else { "this machine's" };
        facts(&[
            ("frames", self.played.beat.frames.to_string()),
            ("length", format!("{:.1} s", self.seconds)),
            ("asked for", format!("{} a second", self.rate_hz)),
            ("a frame casts", casts.to_owned()),
            ("its rays", self.played.casters.join("; ")),
            ("the clock", clock.to_owned()),
            (
                "rays were cast for",
                self.played
                    .stages
                    .iter()
                    .map(|stages| format!("{:.1} s", stages.cast_ms / 1e3))
                    .collect::<Vec<_>>()
                    .join(", "),
            ),
            (
                "energy",
                self.joules
                    .map_or("this machine does not tell".to_owned(), |joules| format!("{joules:.0} J")),
            ),
            ("projectors", self.projectors.to_string()),
        ])
    }

    /// How frames were controlled.
    fn control(&self) -> String {
        let Some(summary) = &self.played.control else { return String::new() };
        let [spatial, temporal] = summary.mean_errors.map(|error| 255.0 * error);
        let rows = [
            (
                "pictures begun",
                format!("{}, {} of them for detail that came", summary.begun, summary.begun_for_detail),
            ),
            ("pictures shown", format!("{}, {} of them complete", summary.shown, summary.shown_complete)),
            ("rays of what was shown", format!("{:.0} % on average", 100.0 * summary.mean_share)),
            ("error in space, ζ", format!("{spatial:.2} of 255 on average")),
            ("error in time, τ", format!("{temporal:.2} of 255 on average")),
            ("nothing was cast in", format!("{:.0} % of the display's periods", 100.0 * summary.idle_share)),
        ];
        format!("<h2>Frame control</h2>{}{}", facts(&rows), self.played.strip)
    }

    fn times(&self) -> String {
        let row = |name: &str, times: &Quantiles| {
            let cell = |ms: f64| format!("{ms:.2}");
            vec![name.to_owned(), cell(times.p50), cell(times.p99), cell(times.max)]
        };
        let rows = [
            row("from a frame to the next", &self.played.beat.interval_ms),
            row("from input to screen", &self.played.beat.input_to_shown_ms),
            row("to hand a frame over to all back-ends", &self.played.beat.handing_over_ms),
            row("skew: first to last back-end", &self.played.beat.skew_ms),
        ];
        table(&["milliseconds", "median", "99 %", "largest"], &rows)
    }

    fn table_of_backends(&self) -> String {
        let row = |(number, (beat, backend)): (usize, (&super::BackendBeat, &BackendSummary))| {
            let Quantiles { p50, p99, max, .. } = beat.drawing_ms;
            let times = [p50, p99, max].map(|ms| format!("{ms:.1}"));
            let away = match beat.away_ms.count {
                0 => String::new(),
                _ => format!("{:.2} / {:.2}", beat.away_ms.p50 / 1e3, beat.away_ms.max / 1e3),
            };
            let counts = [beat.late.to_string(), beat.lost.to_string(), away];
            [vec![format!("{number}: {}", backend.device.adapter)], times.to_vec(), counts.to_vec()].concat()
        };
        let rows: Vec<_> =
            self.played.beat.backends.iter().zip(&self.backends).enumerate().map(row).collect();
        table(
            &[
                "back-end",
                "draws a frame in, ms",
                "99 %",
                "largest",
                "late",
                "lost",
                "away, s: median / largest",
            ],
            &rows,
        )
    }
}
