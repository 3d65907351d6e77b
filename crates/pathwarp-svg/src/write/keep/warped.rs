//! The elements of the source that the warp changes.

use crate::bend::bitmap::EmbeddedImage;
use crate::write::input::WriteInput;

/// Flags for every element of the source.
pub(super) struct Warped {
    /// `true` if the element is warped.
    pub(super) own: Vec<bool>,
    /// `true` if it is warped or contains anything warped.
    pub(super) within: Vec<bool>,
}

impl Warped {
    pub(super) fn new(input: &WriteInput<'_>) -> Self {
        let (scene, source) = (input.scene, input.source);
        let count = source.elements.len();
        let mut out = Self { own: vec![false; count], within: vec![false; count] };
        let parts = scene.parts.iter().zip(input.outcomes);
        let parts = parts.filter(|(_, o)| o.warped().is_some()).filter_map(|(p, _)| p.element());
        let bitmaps = scene.bitmaps.iter().zip(input.images);
        let bitmaps = bitmaps.filter(|b| matches!(b.1, EmbeddedImage::Bent(_))).filter_map(|b| b.0.owner);
        for e in parts.chain(bitmaps) {
            out.own[e] = true;
            for a in source.ancestors(e) {
                if std::mem::replace(&mut out.within[a], true) {
                    break;
                }
            }
        }
        out
    }
}
