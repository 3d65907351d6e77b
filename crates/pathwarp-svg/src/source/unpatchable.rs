//! Reasons why a source text cannot be patched in place.

/// The reason why a source text cannot be patched in place.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Unpatchable {
    #[error("parts of it come from DTD entities, which have no position in the text")]
    Entities,
    #[error("an image shares its id with another element")]
    AmbiguousImage,
    #[error("a text shares its id with another element")]
    AmbiguousText,
    #[error("a painted path cannot be traced to one element of the source")]
    UntracedPath,
    #[error("an element with a {0} cannot be identified")]
    AmbiguousReferrer(&'static str),
    #[error("a nested viewport with a transform clips its content")]
    ClippingViewport,
    #[error("its root element is empty")]
    EmptyRoot,
}
