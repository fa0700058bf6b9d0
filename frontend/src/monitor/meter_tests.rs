//! Tests of what is counted of inputs.

use super::*;
use crate::monitor::table;
use glam::{DQuat, DVec3};
use inputs::{DeviceTime, Kind, Pose, Refusal, SourceId};
use std::path::PathBuf;

fn inputs() -> [Input; 2] {
    ["wand", "pad"].map(|name| Input {
        name: name.to_owned(),
        kind: Kind::Gamepad(PathBuf::new()),
        display_from_tracker: None,
    })
}

fn event(source: u16, received_ms: u64, age_ms: Option<u64>, what: What) -> Event {
    let device_time = age_ms.map(|age_ms| DeviceTime::InStep(Duration::from_millis(received_ms - age_ms)));
    Event { source: SourceId(source), device_time, received: Duration::from_millis(received_ms), what }
}

fn pose(is_tracked: bool) -> What {
    let pose = is_tracked.then(|| Pose::new(DVec3::new(1.0, -2.0, 0.5), DQuat::IDENTITY).unwrap());
    What::Pose { sensor: 3, pose }
}

/// A hundred poses a second for a second, of which the second half has no target; and a button.
fn filled() -> Meter {
    let mut meter = Meter::new(&inputs());
    for i in 0..=100 {
        assert_eq!(meter.add(&event(0, 1000 + 10 * i, Some(4), pose(i < 50))), None);
    }
    meter.add(&event(1, 1500, None, What::Button { index: 2, is_down: true }));
    meter
}

#[test]
fn rates_ages_and_losses_are_those_of_the_events() {
    let counts = vec![Counts::default(); 2];
    let report = filled().report(Duration::from_secs(3), counts);
    let [wand, pad] = &report.sources[..] else { panic!() };
    let sensor = &wand.channels[0];
    assert_eq!((sensor.channel, sensor.events, sensor.losses), (Channel::Sensor(3), 101, 1));
    assert!((sensor.rate_hz - 100.0).abs() < 1e-9 && (sensor.silent_s - 1.0).abs() < 1e-9);
    // Histograms are right to two percent.
    assert_eq!(sensor.tool, None, "it has faded");
    let soon = filled().report(Duration::from_millis(1800), vec![Counts::default(); 2]);
    let tool = soon.sources[0].channels[0].tool.unwrap();
    assert!(tool.presence == 1.0 && tool.pose.position_m() == DVec3::new(1.0, -2.0, 0.5), "{tool:?}");
    assert!((sensor.gap_ms.p50 - 10.0).abs() < 0.2 && sensor.jitter_ms < 0.2, "{sensor:?}");
    assert!(
        (sensor.age_ms.unwrap().p99 - 4.0).abs() < 0.1 && (sensor.latest_age_ms.unwrap() - 4.0).abs() < 1e-6
    );
    let button = &pad.channels[0];
    assert_eq!((button.channel, button.rate_hz, button.age_ms), (Channel::Button(2), 0.0, None));
}

#[test]
fn a_lap_has_rates_of_its_own() {
    let mut meter = filled();
    let rate = |meter: &mut Meter, now_s| {
        meter.lap(Duration::from_secs(now_s), vec![Counts::default(); 2]).sources[0].channels[0].rate_hz
    };
    assert_eq!([rate(&mut meter, 2), rate(&mut meter, 4)], [101.0 / 2.0, 0.0]);
}

#[test]
fn sources_come_and_go_in_sentences() {
    let mut meter = Meter::new(&inputs());
    let told = meter.add(&event(1, 0, None, What::Found("is there".into())));
    assert_eq!(told.as_deref(), Some("pad: is there"));
    let is_there =
        |meter: &Meter| meter.report(Duration::ZERO, vec![Counts::default(); 2]).sources[1].is_there;
    assert!(is_there(&meter));
    for _ in 0..200 {
        meter.add(&event(1, 0, None, What::Lost("is gone".into())));
    }
    assert!(!is_there(&meter));
    assert_eq!(meter.report(Duration::ZERO, vec![]).sentences.len(), MOST_SENTENCES);
    assert_eq!(
        meter.add(&event(7, 0, None, What::Found(String::new()))),
        None,
        "a source that is not in the file"
    );
}

#[test]
fn the_table_has_a_line_for_each_channel() {
    let refused = [(Refusal::Checksum, 3)].into();
    let counts = vec![Counts { messages: 104, refused, dropped: 7 }, Counts::default()];
    let text = table(&filled().report(Duration::from_secs(2), counts));
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 6, "{text}");
    assert_eq!(lines[1], "wand (gamepad) is looked for, 104 messages, 7 events dropped");
    assert_eq!(lines[2], "  3 refused: its checksum is wrong");
    assert_eq!(
        lines[3].split_whitespace().collect::<Vec<_>>().join(" "),
        "sensor 3 100.0 0.00 4.0 1 no target, 95 % of its tool left"
    );
    assert_eq!(lines[5].split_whitespace().collect::<Vec<_>>().join(" "), "button 2 0.0 0.00 (500) 0 down");
}
