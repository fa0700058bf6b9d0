//! The signals that ask the program to end, for work that leaves nothing half done.

use crate::FrontendError;
use signal_hook::consts::TERM_SIGNALS;
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Exit code of a run that a signal ended: what shells give for an interrupt.
pub const EXIT_CODE: i32 = 130;

/// A flag that becomes true when somebody asks the program to end, by Ctrl-C for instance. Whoever asks a second time
/// does not want to wait: that ends the program at once.
pub fn stop_flag() -> Result<Arc<AtomicBool>, FrontendError> {
    let stop = Arc::new(AtomicBool::new(false));
    for &signal in TERM_SIGNALS {
        // In this order: the first signal must not find the flag that it sets.
        flag::register_conditional_default(signal, Arc::clone(&stop)).map_err(FrontendError::Signals)?;
        flag::register(signal, Arc::clone(&stop)).map_err(FrontendError::Signals)?;
    }
    Ok(stop)
}
