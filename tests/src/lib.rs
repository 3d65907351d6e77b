//! End-to-end tests of pathwarp live in `tests/`; this crate holds nothing else.
