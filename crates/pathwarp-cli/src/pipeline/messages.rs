//! Warnings about one input on the terminal.

use crate::report::FileReport;
use crate::terminal;

/// Most messages of a kind; the report holds the rest.
const SHOWN: usize = 8;

/// Prints the first `count` warnings, skipped shapes and missed tolerances.
pub(super) fn warn(r: &FileReport, count: usize) {
    let of_file = |message: &str| format!("{}: {message}", r.file);
    for w in r.warnings.iter().take(count.min(SHOWN)) {
        terminal::warning(&of_file(w));
    }
    for s in r.skipped.iter().take(SHOWN) {
        terminal::warning(&of_file(&format!("{} is not warped: {}", s.id, s.why)));
    }
    for s in r.shapes.iter().filter(|s| !s.over_budget.is_empty()).take(SHOWN) {
        let [x, y] = s.over_budget[0];
        let why = match s.unresolved {
            Some(resolution) => format!("it is below the resolution of these coordinates, {resolution:.0e}"),
            None => format!("the error there is up to {:.3e}", s.max_error),
        };
        terminal::warning(&of_file(&format!("{} misses the tolerance near {x:.4},{y:.4}: {why}", s.id)));
    }
    let more = count.saturating_sub(SHOWN) + r.skipped.len().saturating_sub(SHOWN);
    if more > 0 {
        terminal::warning(&of_file(&format!("and {more} more; --report FILE lists them all")));
    }
}
