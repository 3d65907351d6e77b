//! Limits on a program: seconds and bytes.

use std::sync::OnceLock;
use std::time::Duration;

/// Environment variable for the seconds that a program may take for one answer.
const SECONDS_VARIABLE: &str = "PATHWARP_PLUGIN_SECONDS";

/// Seconds for one answer: of the slowest interpreters on a busy machine, many times what they need.
const SECONDS: f64 = 10.0;

/// Points in one request. More are asked in several, so that a program needs little memory and answers in time.
pub(crate) const MOST_POINTS: usize = 1 << 13;

/// Bytes of an entry.
pub(crate) const ENTRY_BYTES: usize = 1 << 18;

/// Bytes of an answer that is a message or a list of creases.
pub(crate) const MESSAGE_BYTES: usize = 1 << 16;

/// Bytes of a line with the answer for one point: six numbers of up to 25 characters, and some more for their authors.
pub(crate) const LINE_BYTES: usize = 256;

/// Bytes on standard error while a program is running.
pub(crate) const ERROR_BYTES: usize = 1 << 20;

/// Bytes of standard error that are quoted in messages.
pub(crate) const QUOTED_BYTES: usize = 300;

/// The time for one answer.
pub(crate) fn time() -> Duration {
    static TIME: OnceLock<Duration> = OnceLock::new();
    *TIME.get_or_init(|| {
        let given = std::env::var(SECONDS_VARIABLE).ok().and_then(|t| t.parse().ok());
        let seconds: f64 = given.filter(|s: &f64| *s > 0.0 && *s < 1e6).unwrap_or(SECONDS);
        Duration::from_secs_f64(seconds)
    })
}
