//! Pictures: decoded, and the samples drawn.

mod pictures;
mod samples;
