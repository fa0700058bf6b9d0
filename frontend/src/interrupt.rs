//! The signals that ask the program to end, for work that leaves nothing half done.

use crate::FrontendError;
use signal_hook::consts::{SIGINT, TERM_SIGNALS};
use signal_hook::flag;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

/// The latest of these signals.
static SIGNAL: OnceLock<Arc<AtomicUsize>> = OnceLock::new();

/// A flag that becomes true when somebody asks the program to end, by Ctrl-C for instance. Whoever asks a second time
/// does not want to wait: that ends the program at once.
pub fn stop_flag() -> Result<Arc<AtomicBool>, FrontendError> {
    let stop = Arc::new(AtomicBool::new(false));
    let latest = SIGNAL.get_or_init(|| Arc::new(AtomicUsize::new(SIGINT as usize)));
    for &signal in TERM_SIGNALS {
        // In this order: the first signal must not find the flag that it sets.
        flag::register_conditional_default(signal, Arc::clone(&stop)).map_err(FrontendError::Signals)?;
        flag::register_usize(signal, Arc::clone(latest), signal as usize).map_err(FrontendError::Signals)?;
        flag::register(signal, Arc::clone(&stop)).map_err(FrontendError::Signals)?;
    }
    Ok(stop)
}

/// Why work ended: for whoever asked it to, that is all that matters.
pub(crate) fn or_stopped(error: FrontendError, stop: &AtomicBool) -> FrontendError {
    match stop.load(Ordering::SeqCst) {
        true => FrontendError::Stopped(error.to_string()),
        false => error,
    }
}

/// Exit code of a run that a signal ended: what shells give for it.
pub fn exit_code() -> i32 {
    let signal = SIGNAL.get().map_or(SIGINT as usize, |latest| latest.load(Ordering::SeqCst));
    128 + signal as i32
}
