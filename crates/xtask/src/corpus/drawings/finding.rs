//! The result of one check of one file.

/// A check, its outcome and a remark.
#[derive(Debug, Clone)]
pub(super) struct Finding {
    /// The name of the check.
    pub(super) check: &'static str,
    pub(super) passed: bool,
    /// Figures or a cause, for the report.
    pub(super) remark: String,
}

impl Finding {
    pub(super) fn new(check: &'static str, passed: bool, remark: impl Into<String>) -> Self {
        Self { check, passed, remark: remark.into() }
    }

    pub(super) fn failed(check: &'static str, remark: impl Into<String>) -> Self {
        Self::new(check, false, remark)
    }
}
