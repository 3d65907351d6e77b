//! How a document is warped.

use crate::bend::gradient::GradientPainter;
use crate::bend::image::Images;
use crate::bend::letters::LetterPlaces;
use crate::source::select::Selection;
use pathwarp::kurbo::Affine;
use pathwarp::refit;
use std::fmt;
use std::sync::Arc;

/// What becomes of strokes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Strokes {
    /// Scaled where that is right within 2 % of the width all along the shape, outlined elsewhere.
    #[default]
    Auto,
    /// The centre line is warped, the width stays.
    Keep,
    /// The width (and dashes) grow with the map's mean local scale.
    Scale,
    /// The stroke becomes a filled outline, which is warped.
    Outline,
}

/// What becomes of text.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum TextMode {
    /// Its outlines are warped.
    #[default]
    Outline,
    /// It stays as it is.
    Skip,
}

/// How the file is written.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Structure {
    /// Patched in place; written anew only where that is impossible, with a warning.
    #[default]
    Auto,
    /// Patched in place, or an error.
    Keep,
    /// Always written anew: groups and paths with everything resolved.
    Flatten,
}

/// What happens when a shape cannot be warped.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum OnError {
    /// The whole document fails.
    #[default]
    Stop,
    /// The shape stays as it was and is reported.
    Skip,
}

/// What becomes of gradients.
#[derive(Clone, Default)]
pub enum Gradients {
    /// They follow the map's best affine fit over the shape they paint.
    #[default]
    Fit,
    /// Where that fit would be seen to be none, the shape shows a picture of the gradient, bent pixel by pixel.
    Exact(Arc<dyn GradientPainter>),
    /// They stay as they are.
    Keep,
}

impl fmt::Debug for Gradients {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Fit => "Fit",
            Self::Exact(_) => "Exact",
            Self::Keep => "Keep",
        })
    }
}

impl PartialEq for Gradients {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Fit, Self::Fit) | (Self::Keep, Self::Keep) => true,
            (Self::Exact(a), Self::Exact(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }
}

/// What becomes of the page.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum PageFit {
    /// It stays.
    #[default]
    None,
    /// It grows to hold all of the warped artwork.
    Grow,
    /// It becomes the warped artwork's box.
    Page,
}

/// What becomes of patterns.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Patterns {
    /// Their tiles are warped one by one where an affine fit would be seen to be none and the tiles are not too many; elsewhere
    /// they follow that fit.
    #[default]
    Auto,
    /// Their tiles are warped one by one unless they are too many.
    Instantiate,
    /// They follow the map's best affine fit over the shape they paint.
    Fit,
    /// They stay as they are.
    Keep,
}

/// How a document is warped.
#[derive(Debug, Clone, PartialEq)]
pub struct WarpOptions {
    /// How paths are refitted; the tolerance is in root user units.
    pub refit: refit::Options,
    /// Decimals of the coordinates written. `None`: as many as keep rounding below a hundredth of the tolerance.
    pub precision: Option<u8>,
    /// What becomes of strokes.
    pub strokes: Strokes,
    /// What becomes of text.
    pub text: TextMode,
    /// How the file is written.
    pub structure: Structure,
    /// What is warped.
    pub selection: Selection,
    /// What happens when a shape cannot be warped.
    pub on_error: OnError,
    /// What becomes of gradients.
    pub gradients: Gradients,
    /// What becomes of patterns.
    pub patterns: Patterns,
    /// What becomes of the page: viewBox, width and height. Lengths in per cent that stand in the file then mean the new one.
    pub page: PageFit,
    /// Where copies of every shape stand before the warp, in root user space, the original included; a shape and its copies
    /// become one path, clip paths and masks alike. Empty: the shape alone.
    pub copies: Vec<Affine>,
    /// Letters that are placed one by one.
    pub letters: LetterPlaces,
    /// What becomes of bitmaps.
    pub images: Images,
}

impl WarpOptions {
    /// Whether paint servers of this kind follow the map.
    pub(crate) fn moves(&self, paint: &usvg::Paint) -> bool {
        match paint {
            usvg::Paint::Color(_) => false,
            usvg::Paint::Pattern(_) => self.patterns != Patterns::Keep,
            usvg::Paint::LinearGradient(_) | usvg::Paint::RadialGradient(_) => self.gradients != Gradients::Keep,
        }
    }

    /// Everything as it is by default.
    #[must_use]
    pub fn new(refit: refit::Options) -> Self {
        Self {
            refit,
            precision: None,
            strokes: Strokes::default(),
            text: TextMode::default(),
            structure: Structure::default(),
            selection: Selection::default(),
            on_error: OnError::default(),
            gradients: Gradients::default(),
            patterns: Patterns::default(),
            page: PageFit::default(),
            copies: Vec::new(),
            letters: LetterPlaces::default(),
            images: Images::default(),
        }
    }
}
