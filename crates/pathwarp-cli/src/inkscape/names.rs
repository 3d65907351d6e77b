//! Names of parameters in the dialogs, beside those of deformations and common options. Those are in kebab case, so an underscore
//! is free to mark what belongs to one of them.

/// The word between two steps.
pub(super) const CHAIN: &str = "+";

/// The deformation to apply.
pub(super) const DEFORMATION: &str = "inkscape-deformation";
/// Another thing to do.
pub(super) const ACTION: &str = "inkscape-action";
/// The number of selected paths that are guides, or [`AUTOMATIC`].
pub(super) const GUIDES: &str = "inkscape-guides";
/// The treatment of objects that are warped already.
pub(super) const AGAIN: &str = "inkscape-again";
/// Show warnings in a window.
pub(super) const WARNINGS: &str = "inkscape-warnings";
/// New values for a warp.
pub(super) const CHANGES: &str = "inkscape-changes";
/// Show the settings of a warp, and change nothing.
pub(super) const SHOW: &str = "inkscape-show";
/// Give up changes made by hand.
pub(super) const DISCARD: &str = "inkscape-discard";

/// The word for the usual choice.
pub(super) const AUTOMATIC: &str = "auto";
/// Change the warp instead of warping its result.
pub(super) const REPLACE: &str = "replace";
/// Warp the result.
pub(super) const ADD: &str = "add";

/// The value of an option without a choice, as Inkscape has no empty ones.
pub(super) const NONE: &str = "-";

/// A number in percent.
pub(super) const PERCENT: &str = "_percent";
/// The unit of a length.
pub(super) const UNIT: &str = "_unit";
/// A file of the user's instead of a name.
pub(super) const FILE: &str = "_file";

/// Units of lengths as Inkscape passes them, and as the command line takes them.
pub(super) const UNITS: [(&str, &str, &str); 6] = [
    ("percent", "%", "% of the artwork"),
    ("user", "", "user units"),
    ("mm", "mm", "mm"),
    ("cm", "cm", "cm"),
    ("in", "in", "in"),
    ("pt", "pt", "pt"),
];

/// Returns `true` for the argument that says what to do.
pub(super) fn is_job(arg: &str) -> bool {
    let name = arg.strip_prefix("--").and_then(|a| a.split_once('=')).map(|(name, _)| name);
    name.is_some_and(|n| n == DEFORMATION || n == ACTION)
}
