//! `lightloom calibrate`.

use super::say::{print, say, warn};
use crate::FrontendError;
use crate::adapter;
use crate::calibrate::{TrackerSummary, read_pairs};
use crate::cli::{CalibrateArgs, CalibrateSubject, TrackerArgs};
use crate::report::write_text;
use crate::same_file::is_same_file;

/// Calibrates what the arguments name.
pub(super) fn calibrate(args: &CalibrateArgs) -> Result<(), FrontendError> {
    match &args.subject {
        CalibrateSubject::Tracker(args) => tracker(args),
    }
}

/// Registers the pairs, and writes or prints the transform. All is read and checked before anything is written.
fn tracker(args: &TrackerArgs) -> Result<(), FrontendError> {
    let display = args.display.as_deref().map(adapter::load_display).transpose()?;
    let pairs = read_pairs(&args.pairs)?;
    let refused = |source| FrontendError::Registration { path: args.pairs.clone(), source };
    let found = tracking::register(&pairs).map_err(refused)?;
    let summary = TrackerSummary::new(&pairs, &found, display.as_ref());
    let transform = inputs::transform_text(&found.display_from_tracker, found.rms_m);
    if let Some(out) = &args.out {
        if is_same_file(out, &args.pairs) {
            return Err(FrontendError::PairsOverwritten { path: out.clone() });
        }
        write_text(out, &transform)?;
    }
    if args.json {
        return say(&serde_json::to_string_pretty(&summary)?);
    }
    summary.warnings.iter().for_each(|warning| warn(warning));
    print(&summary.text())?;
    match &args.out {
        Some(out) => say(&format!("\nwritten to {}", out.display())),
        None => print(&format!("\n{transform}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    const PAIRS: &str = "[[pair]]\ntracker_m = [0, 0, 0]\ndisplay_m = [0, 0, 0]\n\
                         [[pair]]\ntracker_m = [0, 1, 0]\ndisplay_m = [1, 0, 0]\n\
                         [[pair]]\ntracker_m = [0, 0, 1]\ndisplay_m = [0, 1, 0]\n";

    fn arguments(folder: &tempfile::TempDir, text: &str) -> (TrackerArgs, PathBuf) {
        let (pairs, out) = (folder.path().join("pairs.toml"), folder.path().join("tracker.toml"));
        std::fs::write(&pairs, text).unwrap();
        (TrackerArgs { pairs, display: None, out: Some(out.clone()), json: false }, out)
    }

    #[test]
    fn a_tracker_s_transform_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let (args, out) = arguments(&folder, PAIRS);
        tracker(&args).unwrap();
        let first = std::fs::read_to_string(&out).unwrap();
        assert!(first.contains("\nrotation = [") && first.contains("\ntranslation_m = ["), "{first}");
        tracker(&args).unwrap();
        assert_eq!(std::fs::read_to_string(&out).unwrap(), first);
    }

    #[test]
    fn nothing_is_written_for_pairs_that_are_refused_or_over_them() {
        let folder = tempfile::tempdir().unwrap();
        let (args, out) = arguments(&folder, &PAIRS.replace("[0, 0, 1]", "[0, 3, 0]"));
        let sentence = tracker(&args).unwrap_err().to_string();
        assert!(sentence.contains("pairs.toml: in the tracker frame all points lie within"), "{sentence}");
        let (args, _) = arguments(&folder, &PAIRS.replace("tracker_m", "tracker_mm"));
        let sentence = tracker(&args).unwrap_err().to_string();
        assert!(sentence.contains("pairs.toml, line 2: ") && sentence.contains("`tracker_m`"), "{sentence}");
        assert!(!out.exists());
        let (args, _) = arguments(&folder, PAIRS);
        let over = TrackerArgs { out: Some(args.pairs.clone()), ..args.clone() };
        let sentence = tracker(&over).unwrap_err().to_string();
        assert!(sentence.contains("give --out another name"), "{sentence}");
        assert_eq!(std::fs::read_to_string(&args.pairs).unwrap(), PAIRS);
    }
}
