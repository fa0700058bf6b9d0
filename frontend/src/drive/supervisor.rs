//! What a service manager is told, where one has started this program and asks: systemd, by its notify socket.

use super::{BeatSummary, Recorder};
use crate::FrontendError;
use crate::staging::Theatre;
use protocol::FrameState;
use sd_notify::{NotifyState, notify};
use std::time::{Duration, Instant};
use world::Moment;

/// How often it hears that frames go on.
const INTERVAL: Duration = Duration::from_secs(1);

/// Tells it that the show has begun, then that it goes on, and that it ends. Without a service manager it does nothing.
#[derive(Debug, Default)]
pub struct Supervisor {
    told_at: Option<Instant>,
}

/// A service manager that does not listen does not hold up a show.
fn tell(state: &[NotifyState]) {
    let _ = notify(state);
}

impl Recorder for Supervisor {
    fn frame(
        &mut self,
        _: &FrameState,
        _: Moment,
        theatre: &Theatre,
        beat: &dyn Fn() -> BeatSummary,
    ) -> Result<(), FrontendError> {
        let is_first = self.told_at.is_none();
        if self.told_at.is_none_or(|before| before.elapsed() >= INTERVAL) {
            self.told_at = Some(Instant::now());
            let status = format!("{} frames, now {}", beat().frames, theatre.title());
            let states = [NotifyState::Watchdog, NotifyState::Status(&status), NotifyState::Ready];
            tell(if is_first { &states } else { &states[..2] });
        }
        Ok(())
    }

    fn said(&mut self, _: Duration, _: &str) {}
}

impl Drop for Supervisor {
    fn drop(&mut self) {
        tell(&[NotifyState::Stopping]);
    }
}
