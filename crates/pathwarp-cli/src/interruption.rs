//! Ctrl-C and SIGTERM: a handler on another thread waits for commits under way, removes all temporary files and ends the program.

use crate::terminal;
use pathwarp_engine::temporaries;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// The exit code after an interruption, which shells use for SIGINT.
const INTERRUPTED: i32 = 130;

/// Number of inputs of a batch whose results are in place.
static FINISHED: AtomicUsize = AtomicUsize::new(0);
/// `true` if interruptions are the usual end of the command, and need no message.
static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// Counts an input of a batch as finished.
pub(crate) fn count_finished() {
    FINISHED.fetch_add(1, Ordering::Relaxed);
}

/// Lets interruptions end the program without a message from now on.
pub(crate) fn end_quietly() {
    IS_QUIET.store(true, Ordering::Relaxed);
    handle();
}

/// Installs the handler, once.
pub(crate) fn handle() {
    static INSTALL: Once = Once::new();
    INSTALL.call_once(|| {
        // If a host program has installed a handler, that one handles interruptions.
        let _ = ctrlc::set_handler(|| {
            end_after_cleaning(|| {
                if !IS_QUIET.load(Ordering::Relaxed) {
                    terminal::error(&match FINISHED.load(Ordering::Relaxed) {
                        0 => "interrupted; no output was written".to_owned(),
                        1 => "interrupted; the result of 1 input is written".to_owned(),
                        n => format!("interrupted; the results of {n} inputs are written"),
                    });
                }
                std::process::exit(INTERRUPTED);
            });
        });
    });
}

/// Ends the plug-ins' processes, removes all temporary files, and calls `end`, which ends this program.
pub(crate) fn end_after_cleaning(end: impl FnOnce()) {
    temporaries::remove_all_and(pathwarp_plugin::end_all, end);
}
