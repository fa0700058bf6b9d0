//! Trackers and controllers.

use super::{Input, Request};
use crate::FrontendError;
use exhibit::InputStatus;
use glam::{DQuat, DVec3};
use inputs::{Hub, What};
use world::{Action, Button, Cast, Deed, Moment, Sensor, Tool, ToolKind, Visitor, VisitorId};

/// The sources of inputs.
pub struct Tracked {
    hub: Hub,
    names: Vec<String>,
    news: Vec<String>,
}

impl Tracked {
    /// Begins to look for sources.
    ///
    /// # Errors
    /// The system has no more threads.
    pub fn start(inputs: &[inputs::Input]) -> Result<Self, FrontendError> {
        let names = inputs.iter().map(|input| input.name.clone()).collect();
        Ok(Self { hub: Hub::start(inputs)?, names, news: Vec::new() })
    }
}

impl Input for Tracked {
    fn poll(&mut self, moment: Moment, requests: &mut Vec<Request>) {
        let mut events = Vec::new();
        self.hub.poll(moment.now, &mut events);
        for event in events {
            if let What::Found(sentence) | What::Lost(sentence) = &event.what {
                let name = self.names.get(usize::from(event.source.0)).map_or("", String::as_str);
                self.news.push(format!("input {name}: {sentence}"));
            }
            requests.push(Request::Deed(Deed::Event(event)));
        }
    }

    fn counts(&self) -> Vec<InputStatus> {
        let counted = self.names.iter().zip(self.hub.counts());
        let status = counted.map(|(name, counts)| InputStatus {
            name: name.clone(),
            messages: counts.messages,
            refused: counts.refused.values().sum(),
        });
        status.collect()
    }

    fn news(&mut self) -> Vec<String> {
        std::mem::take(&mut self.news)
    }
}

/// Who takes part in a show of one scene: somebody with one tool, where anything is tracked.
pub fn cast(is_tracked: bool) -> Cast {
    if is_tracked { one_hand() } else { Cast::default() }
}

/// One visitor with one tool, at the first sensor that has a pose: its first button grabs the volume, the second goes on to
/// the next look, the third resets all.
pub fn one_hand() -> Cast {
    let actions = [Action::Grab, Action::NextLook, Action::Reset];
    let button = |(index, action)| Button { index, action };
    let tool = Tool {
        name: "tool".to_owned(),
        holder: VisitorId(0),
        sensor: Sensor::First,
        sensor_from_tip: tracking::RigidTransform { rotation: DQuat::IDENTITY, translation_m: DVec3::ZERO },
        kinds: vec![ToolKind::Pointer],
        buttons: (0..).zip(actions).map(button).collect(),
        dials: Vec::new(),
        track: tracking::TrackSettings::default(),
    };
    Cast { visitors: vec![Visitor { name: "visitor".to_owned(), colour: [1.0; 3] }], tools: vec![tool] }
}
