//! An interaction that was recorded: what visitors did, to whatever scene is asked for.

use super::Scenario;
use crate::FrontendError;
use crate::drive::{Remade, Taped, cast};
use crate::staging::{Ensemble, Piece, Theatre};
use display_config::Display;
use protocol::{FrameState, Pace};
use std::path::Path;
use tape::Tape;

/// The tapes that come with the program, by their names.
pub const SHIPPED: [(&str, &[u8]); 2] = [
    ("handling", include_bytes!("../../tapes/handling.mcap")),
    ("cutting", include_bytes!("../../tapes/cutting.mcap")),
];

/// Opens one of the tapes that come with the program.
///
/// # Errors
/// It is no tape, or one of a later version.
pub fn open_shipped(name: &str, bytes: &'static [u8]) -> Result<Taped, FrontendError> {
    Ok(Taped::of(&Tape::of_bytes(Path::new(name), bytes)?, true))
}

/// What those who are on a tape make of a piece before a display, and what is to be said of the tape. They have the tools that the
/// exhibit on the tape gave them; where it was a scene's, one hand.
///
/// # Errors
/// The exhibit on the tape is no good one, or the piece cannot be shown so.
pub fn recorded(
    tape: Taped,
    name: &str,
    piece: Piece,
    display: &Display,
) -> Result<(Scenario, Vec<String>), FrontendError> {
    let tape = tape.for_any_scene();
    let name = format!("{}, {name}", piece.name());
    let theatre = match tape.exhibit_cast()? {
        Some((cast, rules)) => {
            let piece = piece.for_tools();
            let item = piece.item(Vec::new(), None);
            let ensemble = Ensemble { cast, rules, pieces: vec![(piece, item)] };
            Theatre::new(ensemble, display.clone(), Pace::Complete)
        }
        None => Theatre::of_one(piece, cast(tape.has_inputs()), display.clone(), Pace::Complete),
    };
    let whole = (0, tape.len());
    let Remade { frames, news } = tape.remake(Some(whole), &mut theatre.with_sub_frames(false))?;
    // The volume is that of whoever draws it.
    let states = frames.into_values().map(|frame| FrameState { volume: None, ..frame });
    Ok((Scenario::sampled(name, states), news))
}

#[cfg(test)]
#[path = "taped_tests.rs"]
mod tests;
