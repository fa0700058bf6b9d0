//! Work on a thread of its own, so that a signal ends the program however long a device takes.

use super::{AccuracyError, Watch};
use crate::progress::Progress;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// How often the signal is looked for.
const LOOK_INTERVAL: Duration = Duration::from_millis(50);
/// How long work that is to end may take to put its things down; it is left alone then, and the program ends.
const GRACE: Duration = Duration::from_millis(500);

/// Does `work` and shows its progress; once `stop` is set it ends, by itself or by being left behind. The work must write
/// no file.
pub fn supervised<T: Send + 'static>(
    stop: &Arc<AtomicBool>,
    mut progress: Progress,
    work: impl FnOnce(&Watch) -> Result<T, AccuracyError> + Send + 'static,
) -> Result<T, AccuracyError> {
    let ((news, told), (done, results)) = (channel(), channel());
    let watch = Watch::new(Arc::clone(stop), news);
    std::thread::Builder::new()
        .name("accuracy".to_owned())
        // If sending fails, nothing waits any more.
        .spawn(move || drop(done.send(work(&watch))))
        .map_err(|error| AccuracyError::Backend(format!("cannot start a thread: {error}")))?;
    let mut stopped_since = None;
    loop {
        if let Some(result) = wait(&results) {
            return result;
        }
        told.try_iter().for_each(|(part, what)| progress.set(part, &what));
        if stop.load(Ordering::Relaxed) {
            let since: Instant = *stopped_since.get_or_insert_with(Instant::now);
            if since.elapsed() >= GRACE {
                return Err(AccuracyError::Stopped);
            }
        }
    }
}

/// The result, where it comes within a moment.
fn wait<T>(results: &Receiver<Result<T, AccuracyError>>) -> Option<Result<T, AccuracyError>> {
    match results.recv_timeout(LOOK_INTERVAL) {
        Ok(result) => Some(result),
        Err(RecvTimeoutError::Timeout) => None,
        Err(RecvTimeoutError::Disconnected) => {
            Some(Err(AccuracyError::Backend("the measurement ended without a result".to_owned())))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread::sleep;

    fn run(stop: bool, work: fn(&Watch) -> Result<u8, AccuracyError>) -> Result<u8, AccuracyError> {
        supervised(&Arc::new(AtomicBool::new(stop)), Progress::new(false), work)
    }

    #[test]
    fn work_gives_its_result() {
        assert_eq!(run(false, |watch| watch.check().map(|()| 7)), Ok(7));
    }

    #[test]
    fn work_that_looks_and_work_that_does_not_both_end() {
        let started = Instant::now();
        assert_eq!(run(true, |watch| watch.check().map(|()| 7)), Err(AccuracyError::Stopped));
        let deaf = |_: &Watch| {
            sleep(Duration::from_secs(20));
            Ok(7)
        };
        assert_eq!(run(true, deaf), Err(AccuracyError::Stopped));
        assert!(started.elapsed() < Duration::from_secs(10), "{:?}", started.elapsed());
    }

    #[test]
    fn work_that_panics_does_not_hang() {
        assert!(matches!(run(false, |_| panic!("on purpose")), Err(AccuracyError::Backend(_))));
    }
}
