//! Warps SVG drawings in place.
//!
//! A [`Document`] is an SVG file. [`Document::warp`] bends every shape by a map of root user space (the coordinate system
//! inside the root `<svg>`) and returns the file with ids, classes, styles, titles, groups and formatting as they were: usvg
//! resolves the drawing, and the source text is patched in place.
//!
//! ```
//! use pathwarp::map::{Formula, Real};
//! use pathwarp::refit;
//! use pathwarp_svg::{Document, ReadOptions, WarpOptions};
//!
//! struct Wave;
//! impl Formula for Wave {
//!     fn f<S: Real>(&self, x: S, y: S) -> (S, S) { (x, y + (x / 20.0).sin() * 5.0) }
//! }
//!
//! let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 50'><rect id='a' width='90' height='40'/></svg>";
//! let document = Document::read(svg.as_bytes(), "example.svg", &ReadOptions::default())?;
//! let warped = document.warp(&Wave, &WarpOptions::new(refit::Options::new(0.01)))?;
//! assert!(warped.svg.contains("<path id='a' d=\"M"));
//! # Ok::<(), pathwarp::Error>(())
//! ```
//!
//! [`WarpOptions`] say what is warped ([`Selection`]) and what becomes of text, strokes, gradients, patterns, images and the page.
//! Nothing is lost silently: the [`WarpedDocument`] has a [`ShapeReport`] for every shape, with the error of its curves, and names
//! what was left as it was and what was changed:
//!
//! ```
//! # use pathwarp::{deform::Swirl, kurbo::Point, refit};
//! # use pathwarp_svg::{Document, ReadOptions, Warning, WarpOptions};
//! let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 50'><text id='a' y='30' font-family='Nowhere'>Hi</text></svg>";
//! let document = Document::read(svg.as_bytes(), "example.svg", &ReadOptions::default().with_system_fonts(false))?;
//! let swirl = Swirl::new(Point::new(10.0, 25.0), 60.0).build()?;
//!
//! let warped = document.warp(&swirl.map, &WarpOptions::new(refit::Options::new(0.01)))?;
//! assert!(warped.shapes.iter().all(|shape| shape.path.max_error <= 0.01));
//! assert!(warped.skipped.is_empty());
//! assert_eq!(warped.warnings, [Warning::MissingFonts(vec!["Nowhere".into()])]);
//! # Ok::<(), pathwarp::Error>(())
//! ```
//!
//! A [`Document`] also lists its shapes and named paths as [`Outline`](pathwarp::Outline)s, which can serve as cages and guides.
//! [`Plot`] flattens it for machines that cut, and [`Origin`] embeds the source of a result, to undo the warp later.
//!
//! # Features
//!
//! - `parallel` (default): bends shapes on all processors.
//! - `usvg`: adds the module `usvg_tree`, which exposes types of usvg and is exempt from semantic versioning.

/// Declares options, each once: its field, its default and perhaps its setter. `defaults` takes the type's argument, a field without a
/// default.
macro_rules! options {
    (
        $(#[$about:meta])*
        pub struct $type:ident($($required:ident: $required_type:ty)?) {
            $($(#[$doc:meta])* $visibility:vis $field:ident: $value:ty = $default:expr $(, $setter:ident)?;)*
        }
    ) => {
        $(#[$about])*
        pub struct $type {
            $($(#[$doc])* $visibility $field: $value,)*
        }

        impl $type {
            /// The defaults.
            fn defaults($($required: $required_type)?) -> Self {
                Self { $($field: $default,)* }
            }

            $($(
                #[doc = concat!("Sets [`", stringify!($field), "`](Self::", stringify!($field), ").")]
                #[must_use]
                pub fn $setter(self, $field: $value) -> Self {
                    Self { $field, ..self }
                }
            )?)*
        }
    };
}

mod bend;
mod document;
mod embed;
mod nodes;
#[doc(hidden)]
pub mod objects;
mod scene;
#[doc(hidden)]
pub mod sheet;
mod source;
#[cfg(feature = "usvg")]
pub mod usvg_tree;
mod write;

pub use bend::options::{
    Clones, Edit, Filters, Gradients, OnError, PageFit, Patterns, Strokes, Structure, TextMode, WarpOptions,
};
pub use bend::outcome::{ShapeReport, Skipped, Warning, WarpedDocument};
pub use bend::path::{WarpedPath, warp_path};
pub use bend::pictures::{Images, Painter};
pub use document::Document;
pub use embed::Origin;
pub use scene::drawing::{NamedPath, Shape};
pub use scene::plot::{Plot, PlotLoss, PlotShape};
pub use source::read::ReadOptions;
pub use source::select::{Elements, Selection};

/// Items for pathwarp-engine and other crates that stand on this one: painters of what SVG cannot bend, fonts, documents of set text. This
/// module may change in any release, as may `objects` and `sheet`.
#[doc(hidden)]
pub mod engine {
    pub use crate::bend::options::{CutLine, LetterPlaces};
    pub use crate::bend::outcome::Overhang;
    pub use crate::bend::path::edit_path;
    pub use crate::bend::pictures::{
        BentImage, EdgePainter, FilterDrawing, FilterPainter, FilterRequest, GradientColors, GradientPainter,
        GradientRequest, ImageRequest, ImageWarper, PictureError, SeenColor,
    };
    pub use crate::bend::traced::Opacity;
    pub use crate::document::DrawingPart;
    pub use crate::scene::drawing::UnreadImages;
    pub use crate::scene::selected_lettering::{Lettering, LetteringFrame, LetteringFrameError};
    pub use crate::source::faces::{GenericFamilies, bundled_font};
    pub use crate::source::fonts::{FontFile, check_fonts, families, family_styles, find_font};
    pub use crate::source::links::Relinking;
    pub use crate::source::read::{Turned, compressed};
    pub use crate::source::select::Division;
    pub use crate::source::shaping::fallback_fonts;
    pub use crate::write::lettering::{
        LetteringOptions, SetGroup, SetPath, lettering_group, write_lettering, write_set_groups,
    };
}
