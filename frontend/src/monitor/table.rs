//! What arrives from inputs, as lines of text.

use super::channel::{Channel, ChannelReport, Last};
use super::meter::{InputsReport, SourceReport};
use glam::{DQuat, DVec3};
use inputs::Pose;

/// Channels of a source that get a line of their own.
const MOST_LINES: usize = 40;

/// A heading, and for each source a line and one for each of its channels.
pub fn table(report: &InputsReport) -> String {
    let mut lines = vec![format!("{:<16}{:>9}{:>9}{:>8}{:>6}  last", "", "per s", "jitter", "age", "lost")];
    for source in &report.sources {
        lines.push(heading(source));
        lines.extend(source.channels.iter().take(MOST_LINES).map(line));
        if let Some(more) = source.channels.len().checked_sub(MOST_LINES).filter(|&more| more > 0) {
            lines.push(format!("  and {more} more"));
        }
    }
    lines.join("\n")
}

fn heading(source: &SourceReport) -> String {
    let state = if source.is_there { "is there" } else { "is looked for" };
    let counts = &source.counts;
    let mut text = format!("{} ({}) {state}, {} messages", source.name, source.kind, counts.messages);
    if counts.dropped > 0 {
        text += &format!(", {} events dropped", counts.dropped);
    }
    for (refusal, count) in &counts.refused {
        text += &format!("\n  {count} refused: {refusal}");
    }
    text
}

fn line(channel: &ChannelReport) -> String {
    let name = match channel.channel {
        Channel::Sensor(number) => format!("  sensor {number}"),
        Channel::Button(number) => format!("  button {number}"),
        Channel::Axis(number) => format!("  axis {number}"),
    };
    // Where the device does not say when it measured, the time since it last said anything stands in brackets.
    let age = match channel.latest_age_ms {
        Some(age_ms) => format!("{age_ms:.1}"),
        None => format!("({:.0})", channel.silent_s * 1e3),
    };
    let (rate, jitter) = (channel.rate_hz, channel.jitter_ms);
    let held = channel.tool.map(|tool| format!(", {:.0} % of its tool left", 1e2 * tool.presence));
    let last = match channel.last {
        Some(Last::Pose(None)) => "no target".to_owned() + &held.unwrap_or_default(),
        Some(Last::Pose(Some(pose))) => pose_text(&pose),
        Some(Last::IsDown(is_down)) => if is_down { "down" } else { "up" }.to_owned(),
        Some(Last::Value(value)) => format!("{value:.3}"),
        None => String::new(),
    };
    format!("{name:<16}{rate:>9.1}{jitter:>9.2}{age:>8}{:>6}  {last}", channel.losses)
}

/// Metres, and the quaternion x, y, z, w.
fn pose_text(pose: &Pose) -> String {
    let (DVec3 { x, y, z }, DQuat { x: qx, y: qy, z: qz, w }) = (pose.position_m(), pose.rotation());
    format!("{x:.3} {y:.3} {z:.3} m  {qx:.3} {qy:.3} {qz:.3} {w:.3}")
}
