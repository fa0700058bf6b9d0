//! Where pictures are shown.

use super::raw::{RawLine, RawOutput, RawProjector};
use super::source::Source;
use crate::{ConfigError, Output, Projector, Turn};
use glam::UVec2;
use toml::Spanned;

/// No desktop reaches farther, pixels.
const FARTHEST_PX: u32 = 1 << 16;

/// The output that an entry of a projector names.
pub(super) fn of_entry(source: &Source<'_>, raw: &Spanned<RawOutput>) -> Result<Output, ConfigError> {
    let output = raw.get_ref();
    let connector = output.name.as_ref().map(|name| source.name("name", name)).transpose()?;
    let along = |key, pixels: &Spanned<u32>| match *pixels.get_ref() {
        count if count < FARTHEST_PX => Ok(count),
        count => {
            let expected = "a number of pixels from 0 to 65535";
            Err(source.out_of_range(key, pixels.span(), f64::from(count), expected))
        }
    };
    let first_px = UVec2::new(along("x_px", &output.x_px)?, along("y_px", &output.y_px)?);
    let turn = Turn { is_mirrored: output.mirrored, quarters: quarters(source, output)? };
    Ok(Output { connector, first_px, turn })
}

fn quarters(source: &Source<'_>, output: &RawOutput) -> Result<u8, ConfigError> {
    let Some(turn) = &output.turn_deg else { return Ok(0) };
    let known = [0, 90, 180, 270].iter().zip(0..).find(|(degrees, _)| *degrees == turn.get_ref());
    known.map(|(_, quarters)| quarters).ok_or_else(|| {
        source.out_of_range("turn_deg", turn.span(), *turn.get_ref() as f64, "0, 90, 180 or 270")
    })
}

/// Refuses a projector whose pixels another of its back-end has on the same output; other back-ends may be other hosts, with
/// connectors of the same names.
pub(super) fn check_against_earlier(
    source: &Source<'_>,
    earlier: &[Projector],
    projector: &Projector,
    raw: &RawProjector,
) -> Result<(), ConfigError> {
    let (Some(output), Some(entry)) = (&projector.raster.output, &raw.output) else { return Ok(()) };
    let is_on_its_pixels =
        |other: &&Projector| other.backend == projector.backend && other.shares_pixels(projector);
    match earlier.iter().find(is_on_its_pixels) {
        Some(other) => Err(ConfigError::OverlappingOutput {
            place: source.place("output", entry.span()),
            output: output.connector.clone().unwrap_or_else(|| "the desktop".to_owned()),
            other: other.name.clone(),
        }),
        None => Ok(()),
    }
}

/// The output of each projector of a line: those of a back-end take the connectors in turn, a whole one each.
pub(super) fn of_line(
    source: &Source<'_>,
    raw: &RawLine,
    backend_of: &[u32],
) -> Result<Vec<Option<Output>>, ConfigError> {
    let Some(list) = &raw.outputs else { return Ok(vec![None; backend_of.len()]) };
    let connectors: Result<Vec<_>, _> =
        list.get_ref().iter().map(|name| source.name("outputs", name)).collect();
    let connectors = connectors?;
    let mut places = Vec::with_capacity(backend_of.len());
    for (index, backend) in backend_of.iter().enumerate() {
        // A line shares its projectors contiguously.
        let turn = backend_of[..index].iter().rev().take_while(|before| *before == backend).count();
        let connector = connectors.get(turn).cloned().ok_or_else(|| ConfigError::TooFewLineOutputs {
            place: source.place("outputs", list.span()),
            outputs: connectors.len(),
            backend: *backend,
        })?;
        places.push(Some(Output {
            connector: Some(connector),
            first_px: UVec2::ZERO,
            turn: Turn::default(),
        }));
    }
    Ok(places)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{HEAD, LINE, listed, message, message_of};
    use super::*;
    use crate::Display;

    const KEY: &str = "output = { name = \"DP-1\", x_px = 0, y_px = 600 }";

    fn outputs(text: &str) -> Vec<Option<Output>> {
        let display = Display::from_toml(text, "outputs.toml").unwrap();
        display.projectors.into_iter().map(|projector| projector.raster.output).collect()
    }

    fn output(connector: Option<&str>, first_px: [u32; 2], turn: Turn) -> Option<Output> {
        Some(Output { connector: connector.map(str::to_owned), first_px: first_px.into(), turn })
    }

    #[test]
    fn an_output_is_a_place_on_a_connector_or_on_the_desktop() {
        let upright = Turn::default();
        assert_eq!(outputs(&listed()), [None, output(Some("DP-1"), [0, 600], upright)]);
        let turned = "output = { x_px = 5, y_px = 0, mirrored = true, turn_deg = 270 }";
        let turn = Turn { is_mirrored: true, quarters: 3 };
        assert_eq!(outputs(&listed().replace(KEY, turned))[1], output(None, [5, 0], turn));
    }

    #[test]
    fn wrong_outputs_are_refused_by_key() {
        let turned = message("y_px = 600", "y_px = 600, turn_deg = 45");
        assert!(turned.contains("line 24: `turn_deg` is 45; give 0, 90, 180 or 270"), "{turned}");
        let far = message("x_px = 0", "x_px = 70000");
        assert!(far.contains("`x_px` is 70000; give a number of pixels from 0 to 65535"), "{far}");
        let unnamed = message("\"DP-1\"", "\"\"");
        assert!(unnamed.contains("`name` is empty"), "{unnamed}");
        assert!(message("y_px = 600", "flip = 1").contains("`flip` is not a key"));
    }

    #[test]
    fn pixels_of_an_output_are_one_projector_s_of_a_back_end() {
        let same = |y: u32| format!("backend = 1\noutput = {{ name = \"DP-1\", x_px = 0, y_px = {y} }}\n");
        let overlap = message("backend = 0\n", &same(1));
        assert!(overlap.contains("line 25: `output` puts the picture on pixels of `DP-1`"), "{overlap}");
        let other_host = same(1).replace("backend = 1", "backend = 0");
        assert!(Display::from_toml(&listed().replace("backend = 0\n", &other_host), "two.toml").is_ok());
        // The left projector of back-end 1 as well, above the right one.
        let both = listed().replace("backend = 0\n", &same(0)).replace("backend = 1", "backend = 0");
        assert!(Display::from_toml(&both, "two.toml").is_ok());
    }

    #[test]
    fn projectors_of_a_line_take_the_connectors_in_turn() {
        let line = format!("{HEAD}{LINE}outputs = [\"HDMI-1\", \"DP-1\"]\n");
        let connectors = outputs(&line).into_iter().flatten().map(|output| output.connector.unwrap());
        assert_eq!(connectors.collect::<Vec<_>>(), ["HDMI-1", "HDMI-1", "DP-1"]);
        let few = message_of(&line, ", \"DP-1\"", "");
        assert!(few.contains("`outputs` has 1 connectors, and back-end 1 has more projectors"), "{few}");
    }
}
