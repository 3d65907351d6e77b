//! Options for warping a document.

use super::pictures::{Images, Painter};
use super::united::AREA_SHARE;
use crate::scene::model::{Part, PartRole};
use crate::source::elements::ElementId;
use crate::source::select::Selection;
use crate::source::text::SourceText;
use pathwarp::deform::SightMark;
use pathwarp::edit::{Area, Contour, Offset, OpenPaths, around, moved};
use pathwarp::kurbo::{Affine, Rect};
use pathwarp::map::Chain;
use pathwarp::refit::{self, RefittedPath};
use pathwarp::{GeometryError, Outline};
use std::fmt;
use std::sync::Arc;

/// Treatment of strokes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Strokes {
    /// Scale the width if the edges are then within the tolerance, if the width is right within 2 % along the whole shape, or if the stroke
    /// is a hairline: no wider than the tolerance or, on a page measured in physical units, than 0.1 mm. Otherwise, expand the stroke.
    #[default]
    Auto,
    /// Warp the centre line and keep the width.
    Keep,
    /// Scale the width (and dashes) by the map's mean local scale.
    Scale,
    /// Expand the stroke to a filled outline and warp that.
    Outline,
}

/// Treatment of text.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum TextMode {
    /// Warp its outlines.
    #[default]
    Outline,
    /// Leave it unchanged.
    Skip,
}

/// Method of writing the file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Structure {
    /// Patch the file in place. If that is impossible, flatten it with a warning.
    #[default]
    Auto,
    /// Patch the file in place, or fail.
    Keep,
    /// Write a new file of groups and paths with resolved properties.
    Flatten,
}

/// Reaction to a shape that cannot be warped.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum OnError {
    /// Fail.
    #[default]
    Stop,
    /// Leave the shape unchanged and report it.
    Skip,
}

/// Treatment of gradients. Without a [painter](WarpOptions::painter), all but the kept ones follow the fit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Gradients {
    /// Transform them by the map's best affine fit over the painted shape.
    #[default]
    Fit,
    /// Replace a gradient by a picture, bent pixel by pixel, if the affine fit would look wrong: if the colour would be off by more
    /// than 3 % over more than 1 % of the shape.
    Auto,
    /// Replace a gradient by a picture, bent pixel by pixel, if the affine fit would be off by more than 0.6 % of the colour's range
    /// anywhere.
    Exact,
    /// Leave them unchanged.
    Keep,
}

/// Treatment of filters. Without a [painter](WarpOptions::painter), all follow the fit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Filters {
    /// Transform them with what they are applied to by the map's best affine fit.
    #[default]
    Affine,
    /// Replace the drawing of a filter by a picture, bent pixel by pixel, if the affine fit would look wrong: if it would be off by
    /// more than 3 % over more than 1 % of the painted area. A shape beneath or above a shadow stays a shape.
    Auto,
    /// Replace the drawing of a filter by a picture, bent pixel by pixel, in any case.
    Picture,
}

/// Treatment of the page.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub enum PageFit {
    /// Leave it unchanged.
    #[default]
    None,
    /// If artwork on the page leaves it, extend the page to hold that artwork with the margin of the original, outwards to whole user
    /// units. If nothing is left on the page, set it to the bounding box of the warped artwork with that margin.
    Auto,
    /// Extend the page to hold all of the warped artwork.
    Grow,
    /// Set the page to the bounding box of the warped artwork.
    Page,
    /// Set the page to the bounding box of the warped artwork with the margin of the original: the smallest distance between the
    /// original artwork and the edge of its page.
    PageWithMargin,
    /// Leave it unchanged, and report the transform that takes artwork back onto it
    /// ([`WarpedDocument::back`](crate::WarpedDocument::back)).
    Shrink,
    /// Move the page to the origin, with its size unchanged.
    Origin,
    /// Set the page to a sheet of paper with these sides in mm, in its true size, upright or on its side as the warped artwork needs. The
    /// artwork lies in its middle.
    Sheet([f64; 2]),
}

/// Treatment of patterns.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Patterns {
    /// Warp their tiles one by one if an affine fit would be visibly wrong and there are not too many tiles; else transform
    /// the pattern by that fit.
    #[default]
    Auto,
    /// Warp their tiles one by one unless there are too many.
    Instantiate,
    /// Transform them by the map's best affine fit over the painted shape.
    Fit,
    /// Leave them unchanged.
    Keep,
}

/// Treatment of `use` elements that are not warped themselves but show something that is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Clones {
    /// Replace them by copies of the unwarped elements, so that they look as before.
    #[default]
    Copy,
    /// Leave them, so that they show the warped elements.
    Follow,
}

/// Style of the line around artwork.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CutLine {
    /// The name of its layer, and of its ink on a printing press. `None`: an ordinary colour.
    pub spot: Option<String>,
    /// `true` if the ink knocks out the inks below; otherwise it is printed over them.
    pub knockout: bool,
    /// `true` if only the line is written, without the artwork.
    pub only: bool,
    /// Distance by which the artwork's colours go on beyond the line, in user units.
    pub bleed: f64,
    /// `true` if crop and register marks are drawn around it.
    pub marks: bool,
}

options! {
    /// Options for warping a document.
    ///
    /// ```
    /// use pathwarp::refit;
    /// use pathwarp_svg::{Strokes, WarpOptions};
    ///
    /// let fine = WarpOptions::new(refit::Options::new(0.01)).with_strokes(Strokes::Outline).with_precision(Some(3));
    /// let coarse = fine.clone().with_refit(refit::Options::new(0.5));
    /// assert_eq!((coarse.refit.tolerance, coarse.precision), (0.5, Some(3)));
    /// ```
    #[derive(Debug, Clone, PartialEq)]
    #[non_exhaustive]
    pub struct WarpOptions(refit: refit::Options) {
        /// Options for refitting paths; the tolerance is in root user units.
        pub refit: refit::Options = refit, with_refit;
        /// Number of decimals in written coordinates. `None` takes enough to keep rounding below a hundredth of the tolerance, or a
        /// tenth of the tolerance of a small contour, and to keep smooth joints smooth.
        pub precision: Option<u8> = None, with_precision;
        /// Style of the line of [`Edit::Contour`].
        pub line: CutLine = CutLine::default(), with_line;
        /// An edit to apply to the shapes in place of the map, which is ignored.
        pub edit: Option<Edit> = None, with_edit;
        /// Treatment of strokes.
        pub strokes: Strokes = Strokes::default(), with_strokes;
        /// Simplify the outlines of strokes so that they cross neither themselves nor each other within one path.
        pub union: bool = false, with_union;
        /// Treatment of text.
        pub text: TextMode = TextMode::default(), with_text;
        /// Method of writing the file.
        pub structure: Structure = Structure::default(), with_structure;
        /// Marks beside the artwork, in root user space.
        pub sight: Option<SightMark> = None, with_sight;
        /// The part of the document to warp.
        pub selection: Selection = Selection::default(), with_selection;
        /// Reaction to a shape that cannot be warped.
        pub on_error: OnError = OnError::default(), with_on_error;
        /// Treatment of gradients.
        pub gradients: Gradients = Gradients::default(), with_gradients;
        /// Treatment of filters.
        pub filters: Filters = Filters::default(), with_filters;
        /// Paints the pictures that replace gradients and filters.
        pub painter: Option<Painter> = None, with_painter;
        /// Treatment of patterns.
        pub patterns: Patterns = Patterns::default(), with_patterns;
        /// Treatment of the page: viewBox, width and height. If it changes, lengths in percent of it become numbers, except in style
        /// sheets.
        pub page: PageFit = PageFit::default(), with_page;
        /// Transforms of every shape to its copies before the warp, in root user space, including the identity for the original. A shape
        /// and its copies become one path, also in clip paths and masks. If empty, there is only the shape.
        pub copies: Vec<Affine> = Vec::new(), with_copies;
        /// The part of the source that other parts hide in the image. It is cut out of fills, strokes and clip paths.
        pub hidden: Option<Arc<Area>> = None, with_hidden;
        /// Letters to place one by one.
        pub letters: LetterPlaces = LetterPlaces::default(), with_letters;
        /// Treatment of bitmaps.
        pub images: Images = Images::default(), with_images;
        /// Treatment of `use` elements that are not warped themselves but show something that is.
        pub clones: Clones = Clones::default(), with_clones;
        /// Leave viewBox, width and height unchanged, to show the result on the page of the source.
        /// [`WarpedDocument::page`](crate::WarpedDocument::page) still reports the new page.
        pub same_view: bool = false, with_same_view;
        /// The page after an earlier edit that made it grow. Artwork on it counts as shown, and the page may have to grow although nothing
        /// is bent.
        pub grown: Option<Rect> = None, with_grown;
        /// Measure how far the result extends past its page, and list artwork that has moved onto it. This examines every path.
        pub overhang: bool = true, with_overhang;
    }
}

impl WarpOptions {
    /// Default options with the given options for refitting.
    #[must_use]
    pub fn new(refit: refit::Options) -> Self {
        Self::defaults(refit)
    }

    /// Options for an edit in place of a warp. Everything that the edit does not concern stays unchanged.
    #[must_use]
    pub fn editing(self, edit: Edit) -> Self {
        let options = self.with_edit(Some(edit)).with_images(Images::Keep).with_overhang(false);
        let options = options.with_filters(Filters::Affine);
        match edit {
            Edit::Simplify { .. } => {
                let options = options.with_strokes(Strokes::Keep).with_text(TextMode::Skip);
                let options = options.with_gradients(Gradients::Keep).with_patterns(Patterns::Keep);
                options.with_clones(Clones::Follow)
            }
            Edit::Outline => options.with_strokes(Strokes::Outline).with_gradients(Gradients::Fit),
            // Nothing of the artwork changes.
            Edit::Contour(_) => options.with_overhang(true),
            Edit::Offset(_) => options.with_strokes(Strokes::Keep).with_gradients(Gradients::Fit).with_overhang(true),
            Edit::Unite { .. } | Edit::Resolve => options.with_strokes(Strokes::Keep).with_gradients(Gradients::Fit),
        }
    }

    /// Returns `true` if paint servers of this kind follow the map.
    pub(crate) fn moves(&self, paint: &usvg::Paint) -> bool {
        match paint {
            usvg::Paint::Color(_) => false,
            usvg::Paint::Pattern(_) => self.patterns != Patterns::Keep,
            usvg::Paint::LinearGradient(_) | usvg::Paint::RadialGradient(_) => self.gradients != Gradients::Keep,
        }
    }

    pub(crate) fn skips_text(&self) -> bool {
        self.text == TextMode::Skip
    }

    pub(crate) fn paints_gradients(&self) -> bool {
        self.painter.is_some() && matches!(self.gradients, Gradients::Exact | Gradients::Auto)
    }
}

/// An edit of the selected shapes, in place of a warp.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Edit {
    /// Reduces paths to the fewest nodes within the tolerance. A path that would not get fewer stays as it is written.
    Simplify {
        /// Smallest turn of a joint, in radians, that stays a corner. `None` keeps joints for which no smooth curve can stand within the
        /// tolerance.
        corner: Option<f64>,
    },
    /// Converts strokes and text to filled outlines.
    Outline,
    /// Unites all shapes that have an area, by their fill rules: the last one in painting order that is a separate element gets the outline
    /// of all and names them in `data-united`. Gaps narrower than the tolerance close. Shapes in clip paths, masks, filters and transparent
    /// groups are united within them.
    Unite {
        /// `true` if each paint gets a shape.
        by_fill: bool,
    },
    /// Draws a line around all visible artwork, in a new layer ([`WarpOptions::line`]): strokes with their width, text, and pictures by
    /// their opacity, cut by clip paths and masks. Filters do not count. A distance below zero is inside.
    Contour(Contour),
    /// Grows or shrinks areas, by their fill rules. Open paths without a fill move sideways on request, or if there are no areas.
    Offset(Offset),
    /// Writes markers and strokes that usvg draws differently from browsers as plain shapes.
    Resolve,
}

impl Edit {
    /// The edit with the fill rule of a part.
    pub(super) fn for_part(self, part: &Part) -> Self {
        match self {
            Self::Offset(offset) => {
                let even_odd = part.fill.as_ref().is_some_and(|f| f.rule() == usvg::FillRule::EvenOdd);
                let open = if part.fill.is_some() { OpenPaths::Close } else { offset.open };
                Self::Offset(Offset { even_odd, open, ..offset })
            }
            other => other,
        }
    }

    /// Edits an outline. `contours` are the tolerances of its subpaths, if not the options'. Returns `None` if the edit only refits it.
    pub(super) fn apply(
        self,
        outline: &Outline,
        options: &refit::Options,
        contours: &[f64],
    ) -> Result<Option<RefittedPath>, GeometryError> {
        match self {
            Self::Simplify { corner } => refit::simplified(outline, corner, options, contours).map(Some),
            Self::Offset(offset) => moved(outline, &offset, options, contours).map(|m| Some(m.path)),
            Self::Contour(contour) => {
                let tolerance = AREA_SHARE * options.tolerance;
                let around = around(&Area::of(outline, false, tolerance)?, &contour, options)?;
                let mut out = RefittedPath::default();
                (out.path, out.report) = (around.outline.to_bez_path(tolerance), around.report);
                Ok(Some(out))
            }
            Self::Outline | Self::Unite { .. } | Self::Resolve => Ok(None),
        }
    }

    /// The edit for these parts: if none of them is an area, an offset moves lines.
    pub(super) fn for_parts<'p>(self, mut parts: impl Iterator<Item = &'p Part>) -> Self {
        match self {
            Self::Offset(offset) if !parts.any(|p| p.role == PartRole::Paint && p.painted() && is_area(p)) => {
                Self::Offset(Offset { open: OpenPaths::Move, ..offset })
            }
            other => other,
        }
    }

    /// Returns `true` if the edit may change a part.
    pub(super) fn concerns(self, part: &Part, source: &SourceText) -> bool {
        let tag = |e: Option<ElementId>| e.map_or("", |e| &*source.elements[e].tag);
        match self {
            // No other element would have fewer nodes as a path.
            Self::Simplify { .. } => {
                part.owner.is_none() && matches!(tag(part.source), "path" | "polygon" | "polyline")
            }
            Self::Outline => part.stroke.is_some() || tag(part.owner) == "text",
            Self::Offset(offset) => {
                let is_painted = part.role == PartRole::Paint && part.painted();
                is_painted && (offset.open != OpenPaths::Stay || is_area(part))
            }
            Self::Unite { .. } => true,
            Self::Contour(_) => false,
            Self::Resolve => part.differs_from_usvg,
        }
    }
}

/// Returns `true` if a part has a fill or closed lines.
fn is_area(part: &Part) -> bool {
    part.fill.is_some() || part.local.subpaths.iter().any(|s| s.closed)
}

/// Returns `true` if a part has open lines that an edit leaves where they are.
pub(super) fn has_lines_that_stay(edit: Edit, part: &Part) -> bool {
    let stay = matches!(edit, Edit::Offset(offset) if offset.open == OpenPaths::Stay);
    let is_line = part.role == PartRole::Paint && part.painted() && part.fill.is_none();
    stay && is_line && part.local.subpaths.iter().any(|s| !s.closed)
}

/// Positions of letters that are placed one by one.
#[derive(Clone, Default)]
pub struct LetterPlaces {
    /// Affine maps to the copies of each letter of [`Lettering::letters`](crate::engine::Lettering::letters). If empty, letters are bent
    /// like everything else.
    pub places: Vec<Vec<Affine>>,
    /// `true` if [objects](crate::Document::objects) are placed in place of letters.
    pub of_objects: bool,
    /// The selection that contains these letters. `None` stands for the warp's selection.
    pub of: Option<Selection>,
    /// Map applied to the placed letters: the remaining steps.
    pub after: Chain,
}

impl fmt::Debug for LetterPlaces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "LetterPlaces({} letters)", self.places.len())
    }
}

impl PartialEq for LetterPlaces {
    fn eq(&self, other: &Self) -> bool {
        let (a, b) = (self.after.steps(), other.after.steps());
        self.places == other.places
            && self.of_objects == other.of_objects
            && self.of == other.of
            && a.len() == b.len()
            && a.iter().zip(b).all(|(a, b)| Arc::ptr_eq(a, b))
    }
}
