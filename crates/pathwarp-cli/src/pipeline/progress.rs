//! The progress bar.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;

/// A bar over `files` files, with rate and time left; hidden for a single one, on request, and if standard error is not a
/// terminal.
pub(super) fn bar(files: usize, quiet: bool) -> ProgressBar {
    if quiet || files < 2 || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(files as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:32} {human_pos}/{human_len} files  {per_sec}  {eta} left") {
        bar.set_style(style);
    }
    bar
}
