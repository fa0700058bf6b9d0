//! `lightloom verify`.

use super::say::say;
use crate::FrontendError;
use crate::adapter::{self, VerifySummary};
use crate::cli::VerifyArgs;
use crate::progress::Progress;
use crate::report::units;

/// Checks a store; a damaged one is an error, after its damages have been listed.
pub(super) fn verify(args: &VerifyArgs) -> Result<(), FrontendError> {
    let found = adapter::verify(&args.store, Progress::new(!args.quiet && !args.json))?;
    if args.json {
        say(&serde_json::to_string_pretty(&found)?)?;
    } else if !args.quiet {
        say(&text(&found))?;
    }
    match found.is_whole {
        true => Ok(()),
        false => Err(FrontendError::DamagedStore { path: args.store.clone(), damages: found.damage_count }),
    }
}

fn text(found: &VerifySummary) -> String {
    if found.is_whole {
        return format!("whole: {} bricks, {}", units::count(found.bricks), units::bytes(found.bytes));
    }
    let unlisted = found.damage_count.saturating_sub(found.damages.len() as u64);
    let more = (unlisted > 0).then(|| format!("and {unlisted} more"));
    found.damages.iter().cloned().chain(more).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(damages: &[&str], damage_count: u64) -> VerifySummary {
        let damages: Vec<_> = damages.iter().map(|&damage| damage.to_owned()).collect();
        VerifySummary { is_whole: damages.is_empty(), bricks: 9, bytes: 2048, damage_count, damages }
    }

    #[test]
    fn damages_are_told_one_per_line() {
        assert!(text(&found(&[], 0)).starts_with("whole: 9 bricks, "));
        assert_eq!(text(&found(&["brick 3", "brick 5"], 2)), "brick 3\nbrick 5");
        assert_eq!(text(&found(&["brick 3"], 7)), "brick 3\nand 6 more");
    }
}
