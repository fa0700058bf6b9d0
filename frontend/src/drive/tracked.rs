//! Trackers and controllers: the tool in a visitor's hand, and its buttons.

use super::{Change, Input, Moment};
use crate::FrontendError;
use crate::scene::HeldTool;
use inputs::{Event, Hub, SourceId, What};
use std::path::Path;
use tracking::{ToolTrack, Tracked as Found};

/// Takes hold of the volume while it is down.
const GRIP: u8 = 0;
/// The next look.
const NEXT_LOOK: u8 = 1;
/// All as the scene has it.
const RESET: u8 = 2;

/// The sources of an input file. The tool is at the first sensor of which a pose comes; the buttons of its source are the
/// tool's.
pub struct Tracked {
    hub: Hub,
    names: Vec<String>,
    tool: Tool,
    news: Vec<String>,
}

/// The tool.
#[derive(Default)]
struct Tool {
    /// Where it is tracked, once that is known.
    sensor: Option<(SourceId, u8)>,
    track: ToolTrack,
    /// As it was shown last.
    shown: Option<HeldTool>,
}

impl Tracked {
    /// Begins to look for the sources of a file.
    ///
    /// # Errors
    /// The file is none, or the system has no more threads.
    pub fn start(file: &Path) -> Result<Self, FrontendError> {
        let inputs = inputs::Input::load(file)?;
        let names = inputs.iter().map(|input| input.name.clone()).collect();
        Ok(Self { hub: Hub::start(&inputs)?, names, tool: Tool::default(), news: Vec::new() })
    }
}

impl Input for Tracked {
    fn poll(&mut self, moment: Moment, changes: &mut Vec<Change>) {
        let mut events = Vec::new();
        self.hub.poll(moment.now, &mut events);
        for event in events {
            if let What::Found(sentence) | What::Lost(sentence) = &event.what {
                let name = self.names.get(usize::from(event.source.0)).map_or("", String::as_str);
                self.news.push(format!("input {name}: {sentence}"));
            }
            changes.extend(self.tool.take(&event));
        }
        changes.extend(self.tool.at(moment));
    }

    fn news(&mut self) -> Vec<String> {
        std::mem::take(&mut self.news)
    }
}

impl Tool {
    /// What an event changes, the place of the tool apart.
    fn take(&mut self, event: &Event) -> Option<Change> {
        match event.what {
            What::Pose { sensor, pose } => {
                let here = (event.source, sensor);
                if self.sensor.is_none() && pose.is_some() {
                    self.sensor = Some(here);
                }
                if self.sensor == Some(here) {
                    self.track.push(event.measured(), pose);
                }
                None
            }
            What::Button { index, is_down }
                if self.sensor.is_some_and(|(source, _)| source == event.source) =>
            {
                match (index, is_down) {
                    (GRIP, is_down) => Some(Change::Grip(is_down)),
                    (NEXT_LOOK, true) => Some(Change::NextLook),
                    (RESET, true) => Some(Change::Reset),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// Where the tool is in a frame, if that has changed.
    fn at(&mut self, Moment { now, seen_at }: Moment) -> Option<Change> {
        let held = match self.track.at(now, seen_at) {
            Some(Found { pose, presence }) => {
                HeldTool { tip_m: pose.position_m(), rotation: pose.rotation(), presence }
            }
            None => HeldTool { presence: 0.0, ..self.shown? },
        };
        (self.shown.replace(held) != Some(held)).then_some(Change::Tool(held))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};
    use inputs::Pose;
    use std::time::Duration;

    fn event(source: u16, ms: u64, what: What) -> Event {
        Event { source: SourceId(source), device_time: None, received: Duration::from_millis(ms), what }
    }

    fn pose(x_m: f64) -> Option<Pose> {
        Pose::new(DVec3::X * x_m, DQuat::IDENTITY)
    }

    fn at(tool: &mut Tool, ms: u64) -> Option<HeldTool> {
        let now = Duration::from_millis(ms);
        match tool.at(Moment { now, seen_at: now }) {
            Some(Change::Tool(held)) => Some(held),
            None => None,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_first_sensor_that_has_a_pose_is_the_tool() {
        let mut tool = Tool::default();
        tool.take(&event(0, 0, What::Pose { sensor: 4, pose: None }));
        assert_eq!(at(&mut tool, 0), None);
        tool.take(&event(1, 10, What::Pose { sensor: 2, pose: pose(0.5) }));
        tool.take(&event(0, 10, What::Pose { sensor: 4, pose: pose(9.0) }));
        assert_eq!(at(&mut tool, 20).unwrap().tip_m, DVec3::X * 0.5);
        assert_eq!(at(&mut tool, 20), None, "nothing has changed");
    }

    #[test]
    fn a_lost_tool_is_held_fades_and_is_gone() {
        let mut tool = Tool::default();
        tool.take(&event(0, 0, What::Pose { sensor: 0, pose: pose(0.5) }));
        // It fades in.
        tool.take(&event(0, 400, What::Pose { sensor: 0, pose: pose(0.5) }));
        assert_eq!(at(&mut tool, 400).unwrap().presence, 1.0);
        tool.take(&event(0, 450, What::Pose { sensor: 0, pose: None }));
        assert_eq!(at(&mut tool, 800), None, "it is held");
        let fading = at(&mut tool, 1050).unwrap();
        assert!(fading.presence > 0.0 && fading.presence < 1.0, "{fading:?}");
        assert_eq!(at(&mut tool, 3000).unwrap(), HeldTool { presence: 0.0, ..fading });
        assert_eq!(at(&mut tool, 3010), None);
    }

    #[test]
    fn the_buttons_of_its_source_are_the_tool_s() {
        let mut tool = Tool::default();
        let button = |source, index, is_down| event(source, 0, What::Button { index, is_down });
        assert_eq!(tool.take(&button(1, GRIP, true)), None, "there is no tool yet");
        tool.take(&event(1, 0, What::Pose { sensor: 0, pose: pose(0.0) }));
        assert_eq!(tool.take(&button(1, GRIP, true)), Some(Change::Grip(true)));
        assert_eq!(tool.take(&button(1, GRIP, false)), Some(Change::Grip(false)));
        assert_eq!(tool.take(&button(1, NEXT_LOOK, true)), Some(Change::NextLook));
        assert_eq!(tool.take(&button(1, NEXT_LOOK, false)), None);
        assert_eq!(tool.take(&button(0, GRIP, true)), None, "another's");
    }
}
