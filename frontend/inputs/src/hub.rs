//! All sources of a file, asked at once.

use crate::datagrams::{Datagrams, Decoder};
use crate::dtrack::Dtrack;
use crate::error::InputError;
use crate::event::{DeviceTime, Event, SourceId, What};
use crate::input::{Input, Kind};
use crate::opentrackio::Segments;
use crate::outbox::{Counts, Shared};
use crate::queue::{Measured, Waiting};
use crate::records::Records;
use crate::script::Running;
use crate::vrpn::Client;
use crate::worker::{Source, start};
use std::sync::Arc;
use std::thread::Thread;
use std::time::{Duration, Instant};
use tracking::RigidTransform;

/// Sources that are listened to until this is dropped. Asking never waits for one of them, and a source that floods takes
/// nothing from the others.
pub struct Hub {
    feeds: Vec<Feed>,
    /// Of each, where it was calibrated.
    displays_from_trackers: Vec<Option<RigidTransform>>,
}

enum Feed {
    /// Listens on its own.
    Thread { shared: Arc<Shared>, thread: Thread },
    /// Has all its answers.
    Script { running: Box<Running>, counts: Counts },
}

impl Hub {
    /// Begins to look for sources, each in a thread of its own.
    ///
    /// # Errors
    /// The system has no more threads.
    pub fn start(inputs: &[Input]) -> Result<Self, InputError> {
        let feeds = inputs.iter().map(Feed::start).collect::<Result<_, _>>()?;
        let displays_from_trackers = inputs.iter().map(|input| input.display_from_tracker).collect();
        Ok(Self { feeds, displays_from_trackers })
    }

    /// What has happened since it was last asked, in the order of arrival. `now` is the asker's clock, which events are given
    /// on; it must not go back.
    pub fn poll(&mut self, now: Duration, events: &mut Vec<Event>) {
        let first = events.len();
        for ((number, feed), calibration) in (0..).zip(&mut self.feeds).zip(&self.displays_from_trackers) {
            let own = events.len();
            feed.poll(SourceId(number), now, events);
            if let Some(display_from_tracker) = calibration {
                events[own..].iter_mut().for_each(|event| bring(display_from_tracker, &mut event.what));
            }
        }
        // Events of one source that arrived at the same time stay in order.
        events[first..].sort_by_key(|event| event.received);
    }

    /// How much each source has said since the beginning, in the order of the file.
    pub fn counts(&self) -> Vec<Counts> {
        self.feeds.iter().map(Feed::counts).collect()
    }
}

impl Drop for Hub {
    fn drop(&mut self) {
        for feed in &self.feeds {
            if let Feed::Thread { shared, thread } = feed {
                shared.stop();
                thread.unpark();
            }
        }
    }
}

impl Feed {
    fn start(input: &Input) -> Result<Self, InputError> {
        let datagrams = |&port: &_, decoder| Source::Datagrams(Datagrams { port, decoder });
        let source = match &input.kind {
            Kind::Vrpn { address, device, takes_datagrams } => Source::Vrpn(Client {
                address: address.clone(),
                device: device.clone(),
                takes_datagrams: *takes_datagrams,
            }),
            Kind::Dtrack(port) => datagrams(port, Decoder::Dtrack(Dtrack::default())),
            Kind::Osc(port) => datagrams(port, Decoder::Osc),
            Kind::OpenTrackIo(port) => datagrams(port, Decoder::OpenTrackIo(Segments::default())),
            Kind::Freed(port) => datagrams(port, Decoder::Freed),
            Kind::Gamepad(path) => Source::Records(Records::Gamepad(path.clone())),
            Kind::Spacemouse(path) => Source::Records(Records::Spacemouse(path.clone())),
            Kind::Script(script) => {
                let running = Box::new(Running::new(script.clone()));
                return Ok(Self::Script { running, counts: Counts::default() });
            }
        };
        let shared = Arc::new(Shared::default());
        let thread = start(&input.name, source, Arc::clone(&shared))
            .map_err(|cause| InputError::Thread { input: input.name.clone(), cause })?;
        Ok(Self::Thread { shared, thread })
    }

    fn poll(&mut self, source: SourceId, now: Duration, events: &mut Vec<Event>) {
        match self {
            Self::Thread { shared, .. } => {
                let waiting = shared.lock().queue.take();
                let asked = Instant::now();
                events.extend(waiting.into_iter().map(|waiting| event(source, waiting, asked, now)));
            }
            Self::Script { running, counts } => running.poll(now, |received, own, what| {
                if counts.messages == 0 {
                    let what = What::Found("its script runs".to_owned());
                    events.push(Event { source, device_time: None, received, what });
                }
                counts.messages += 1;
                events.push(Event { source, device_time: Some(DeviceTime::Own(own)), received, what });
            }),
        }
    }

    fn counts(&self) -> Counts {
        match self {
            Self::Thread { shared, .. } => {
                let inner = shared.lock();
                Counts { dropped: inner.queue.dropped(), ..inner.counts.clone() }
            }
            Self::Script { counts, .. } => counts.clone(),
        }
    }
}

/// Brings a pose to the display's frame; one that would be too far away is lost.
fn bring(display_from_tracker: &RigidTransform, what: &mut What) {
    if let What::Pose { pose, .. } = what {
        *pose = pose.and_then(|pose| display_from_tracker.pose(&pose));
    }
}

/// An event that waited, on the clock that shows `now` at the instant `asked`.
fn event(source: SourceId, waiting: Waiting, asked: Instant, now: Duration) -> Event {
    let received = now.saturating_sub(asked.saturating_duration_since(waiting.at));
    let device_time = waiting.measured.map(|measured| match measured {
        Measured::Own(time) => DeviceTime::Own(time),
        Measured::Ago(ago_s) => {
            DeviceTime::InStep(Duration::from_secs_f64((received.as_secs_f64() - ago_s).max(0.0)))
        }
    });
    Event { source, device_time, received, what: waiting.what }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn poses_are_brought_to_the_display_s_frame() {
        let display_from_tracker =
            RigidTransform { rotation: DQuat::from_rotation_z(FRAC_PI_2), translation_m: DVec3::Z };
        let brought = |x_m: f64| {
            let pose = tracking::Pose::new(DVec3::X * x_m, DQuat::from_rotation_x(0.5));
            let mut what = What::Pose { sensor: 3, pose };
            bring(&display_from_tracker, &mut what);
            let What::Pose { sensor: 3, pose } = what else { panic!("{what:?}") };
            pose
        };
        let pose = brought(2.0).unwrap();
        assert!(pose.position_m().distance(DVec3::new(0.0, 2.0, 1.0)) < 1e-12, "{pose:?}");
        let turned = DQuat::from_rotation_z(FRAC_PI_2) * DQuat::from_rotation_x(0.5);
        assert!(pose.rotation().angle_between(turned) < 1e-6, "{pose:?}");
        let mut down = What::Button { index: 1, is_down: true };
        bring(&display_from_tracker, &mut down);
        assert_eq!(down, What::Button { index: 1, is_down: true });
    }

    #[test]
    fn times_are_put_on_the_asker_s_clock() {
        let asked = Instant::now();
        let at = |before_ms| asked - Duration::from_millis(before_ms);
        let times = |before_ms, measured| {
            let waiting =
                Waiting { at: at(before_ms), measured: Some(measured), what: What::Found(String::new()) };
            let event = event(SourceId(3), waiting, asked, Duration::from_secs(5));
            (event.received.as_millis(), event.device_time.unwrap())
        };
        let in_step = |ms| DeviceTime::InStep(Duration::from_millis(ms));
        assert_eq!(times(200, Measured::Ago(0.3)), (4800, in_step(4500)));
        assert_eq!(times(200, Measured::Ago(-0.1)), (4800, in_step(4900)));
        assert_eq!(times(9000, Measured::Ago(1.0)), (0, in_step(0)));
        let own = Duration::from_secs(77);
        assert_eq!(times(0, Measured::Own(own)), (5000, DeviceTime::Own(own)));
    }
}
