//! The signals that ask the program to end, for work that leaves nothing half done.

use crate::FrontendError;
use signal_hook::consts::{SIGHUP, SIGINT, TERM_SIGNALS};
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
    let hangup = (!ignores_hangups()).then_some(SIGHUP);
    for signal in TERM_SIGNALS.iter().copied().chain(hangup) {
        // In this order: the first signal must not find the flag that it sets.
        flag::register_conditional_default(signal, Arc::clone(&stop)).map_err(FrontendError::Signals)?;
        flag::register_usize(signal, Arc::clone(latest), signal as usize).map_err(FrontendError::Signals)?;
        flag::register(signal, Arc::clone(&stop)).map_err(FrontendError::Signals)?;
    }
    Ok(stop)
}

/// Whether the program was started to go on when its terminal is closed, by `nohup` for instance. Only Linux tells; elsewhere
/// it is taken to be so.
fn ignores_hangups() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    is_ignored(&status, SIGHUP).unwrap_or(true)
}

/// Whether a process of this status ignores a signal, where that tells.
fn is_ignored(status: &str, signal: i32) -> Option<bool> {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"))?;
    let mask = u64::from_str_radix(mask.trim(), 16).ok()?;
    Some(mask >> (signal - 1) & 1 == 1)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_process_tells_which_signals_it_ignores() {
        let status = "Name:\tlightloom\nSigBlk:\t0000000000000001\nSigIgn:\t0000000000001001\n";
        assert_eq!(
            [SIGHUP, SIGINT, 13].map(|signal| is_ignored(status, signal)),
            [1, 0, 1].map(|b| Some(b == 1))
        );
        assert_eq!(is_ignored("SigBlk: 1", SIGHUP), None);
    }
}
