//! `lightloom outputs`.

use super::say::say;
use crate::FrontendError;
use crate::cli::OutputsArgs;
use screens::{Mode, OutputInfo, Rectangle};

/// Lists the video outputs of this host, and writes the lines of a display file that name them.
pub(super) fn outputs(args: &OutputsArgs) -> Result<(), FrontendError> {
    let outputs = screens::outputs()?;
    if args.json {
        return say(&serde_json::to_string_pretty(&outputs)?);
    }
    let width = outputs.iter().map(|output| output.connector.len()).max().unwrap_or(0);
    for output in &outputs {
        say(&format!("{:<width$}  {}", output.connector, state(output)))?;
        let modes: Vec<String> = output.modes.iter().map(mode).collect();
        if !modes.is_empty() {
            say(&format!("{:<width$}  offers {}", "", modes.join(", ")))?;
        }
    }
    let usable: Vec<String> = outputs.iter().filter_map(line).collect();
    match usable.is_empty() {
        true => say("no output shows anything: switch one on, for instance with xrandr"),
        false => say(&format!("\nfor the [[projector]] entries of a display file:\n{}", usable.join("\n"))),
    }
}

fn state(output: &OutputInfo) -> String {
    let product = output.product.as_ref().map(|product| format!(", {product}")).unwrap_or_default();
    match (&output.shows, output.is_connected) {
        (Some((Rectangle { x, y, .. }, shown)), _) => format!("shows {} from {x}, {y}{product}", mode(shown)),
        (None, true) => format!("connected and off{product}"),
        (None, false) => "not connected".to_owned(),
    }
}

fn mode(mode: &Mode) -> String {
    let rate = if mode.rate_hz > 0.0 { format!(" at {:.2} Hz", mode.rate_hz) } else { String::new() };
    format!("{} × {}{rate}", mode.width, mode.height)
}

/// The line of a display file for a whole output.
fn line(output: &OutputInfo) -> Option<String> {
    let (Rectangle { width, height, .. }, _) = output.shows?;
    let name = output.connector.replace('\\', "\\\\").replace('"', "\\\"");
    Some(format!("output = {{ name = \"{name}\", x_px = 0, y_px = 0 }}    # {width} × {height}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_output_that_shows_something_gets_a_line() {
        let shown = Mode { width: 800, height: 600, rate_hz: 59.94 };
        let place = Rectangle { x: 1600, y: 0, width: 800, height: 600 };
        let output = OutputInfo {
            connector: "DP-1".to_owned(),
            is_connected: true,
            product: Some("LF 3D".to_owned()),
            shows: Some((place, shown)),
            modes: vec![shown],
        };
        assert_eq!(state(&output), "shows 800 × 600 at 59.94 Hz from 1600, 0, LF 3D");
        assert_eq!(line(&output).unwrap(), "output = { name = \"DP-1\", x_px = 0, y_px = 0 }    # 800 × 600");
        let off = OutputInfo { shows: None, ..output };
        assert_eq!((state(&off).as_str(), line(&off)), ("connected and off, LF 3D", None));
    }
}
