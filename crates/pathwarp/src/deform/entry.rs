//! The trait [`Deformation`], which the registry's entries implement, and the data that describe a deformation.

use crate::error::Error;
use crate::map::Map;
use crate::map::called::Called;
use crate::outline::Outline;
use crate::param::{Args, Frame, Param, Settings};
use kurbo::{Affine, BezPath, Point, Rect};
use std::fmt;
use std::sync::Arc;

/// An entry of the registry: turns [`Args`] in a [`Frame`] into a map.
///
/// The command line and recipes build deformations this way, from text. Rust code that needs one particular deformation
/// uses its typed constructor instead, such as [`Shaper`](crate::deform::Shaper).
pub trait Deformation: Send + Sync {
    /// Returns the deformation's description, for people and programs.
    fn info(&self) -> &Info;

    /// Builds the map for these settings.
    ///
    /// # Errors
    /// [`Error::Usage`] for values that contradict each other, [`Error::Geometry`] when the anchors allow no such map.
    fn build(&self, settings: &Settings<'_>) -> Result<Built, Error>;

    /// Checks `args` against the parameter table and builds the map.
    ///
    /// # Errors
    /// [`Error::Usage`] for an unknown or repeated parameter, [`Error::Missing`] without a required one, and the errors of [`Self::build`].
    fn build_from(&self, args: &Args, frame: &Frame) -> Result<Built, Error> {
        self.build(&Settings::new(self.info().params, args, frame)?)
    }
}

/// A deformation of this crate: its description, and the function that builds it for settings.
pub(crate) struct Entry {
    info: &'static Info,
    build: fn(&Settings<'_>) -> Result<Built, Error>,
}

impl Entry {
    pub(super) const fn new(info: &'static Info, build: fn(&Settings<'_>) -> Result<Built, Error>) -> Self {
        Self { info, build }
    }
}

impl Deformation for Entry {
    fn info(&self) -> &Info {
        self.info
    }

    fn build(&self, settings: &Settings<'_>) -> Result<Built, Error> {
        (self.build)(settings)
    }
}

/// The description of a deformation.
///
/// It is written as a constant, from which help, recipes, schema and docs are made:
///
/// ```
/// use pathwarp::deform::Info;
/// use pathwarp::param::{Axis, Param};
///
/// static INFO: Info = Info::new("ripple", "rings on water")
///     .group("Plug-ins")
///     .about("Pushes every point along its ray from the centre.")
///     .params(&[Param::length("height", Axis::Diagonal, "Largest displacement.").default("1%")]);
/// assert_eq!(INFO.params[0].name, "height");
/// ```
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Info {
    /// The name in kebab case, which is also the subcommand.
    pub name: &'static str,
    /// One line for the menu.
    pub title: &'static str,
    /// The menu heading.
    pub group: &'static str,
    /// Sentences on the effect and the uses of the deformation, for help and docs.
    pub about: &'static str,
    /// The paper or program that the mathematics comes from.
    pub source: &'static str,
    /// The parameters.
    pub params: &'static [Param],
    /// Values for the required parameters that show the effect on artwork in the frame 0,0,100,100.
    pub demo: Pairs,
    /// Command lines for help; the tests run every one.
    pub examples: &'static [Example],
    /// Properties of every instance; [`check::entry`](crate::check::entry) tests them.
    pub laws: &'static [Law],
    /// Values known from elsewhere; [`check::entry`](crate::check::entry) tests them.
    pub cases: &'static [Case],
    /// The parameter that puts a baseline on the deformation's curve, if there is one. Without a value, the baseline is that of the
    /// lettering in the frame. The command line looks for [letters](crate::param::Frame::letters) only for deformations that have
    /// such a parameter, or [ask for them](Self::letters).
    pub baseline: Option<&'static str>,
    /// `true` if the deformation needs to know the artwork's letters.
    pub letters: bool,
    /// The presets that a gallery draws one by one, if the deformation has any.
    pub gallery: Option<Gallery>,
    /// The path parameters whose values are selected together with the artwork in a drawing program.
    pub guides: Guides,
    /// Further data for the editor page, on which handles are dragged.
    pub by_hand: ByHand,
}

impl Info {
    /// Starts a description; the rest is empty until set.
    #[must_use]
    pub const fn new(name: &'static str, title: &'static str) -> Self {
        Self {
            name,
            title,
            group: "",
            about: "",
            source: "",
            params: &[],
            demo: &[],
            examples: &[],
            laws: &[],
            cases: &[],
            baseline: None,
            letters: false,
            gallery: None,
            guides: Guides { params: &[], usual: 0 },
            by_hand: ByHand::NONE,
        }
    }

    setters! {
        const:
        /// Sets the menu heading.
        group(group: &'static str);
        /// Sets the text for help and docs.
        about(about: &'static str);
        /// Sets the paper or program the mathematics comes from.
        source(source: &'static str);
        /// Sets the parameters.
        params(params: &'static [Param]);
        /// Sets the values for the required parameters that show the effect.
        demo(demo: Pairs);
        /// Sets the command lines for help.
        examples(examples: &'static [Example]);
        /// Sets the properties of every instance.
        laws(laws: &'static [Law]);
        /// Sets the values known from elsewhere.
        cases(cases: &'static [Case]);
        /// Names the parameter that puts a baseline on the deformation's curve.
        baseline(param: &'static str) => baseline: Some(param);
        /// Names the path parameters that selected paths stand for, the topmost first, and the usual number of them.
        guides(params: &'static [&'static str], usual: usize) => guides: Guides { params, usual };
        /// Sets what a page for bending by hand needs.
        by_hand(by_hand: ByHand);
        /// Names the presets that a gallery draws one by one.
        gallery(gallery: Gallery) => gallery: Some(gallery);
    }

    /// Asks for the artwork's letters.
    #[must_use]
    pub const fn with_letters(self) -> Self {
        Self { letters: true, ..self }
    }
}

/// The path parameters whose values are selected together with the artwork in a drawing program.
#[derive(Debug, Clone, Copy)]
pub struct Guides {
    /// The parameters: the topmost selected path is the value of the first, the next one that of the second.
    pub params: &'static [&'static str],
    /// The default number of paths taken as guides; the rest is artwork.
    pub usual: usize,
}

/// Data for the editor page, on which handles are dragged, beyond the parameters.
///
/// In values, coordinates of points are percentages of the frame; path data is laid from the box 0,0,100,100 onto it.
#[derive(Debug, Clone, Copy)]
pub struct ByHand {
    /// A label, or `None` for the deformation's name.
    pub label: Option<&'static str>,
    /// Labels of parameters whose names could be misunderstood.
    pub labels: Pairs,
    /// Path parameters with a fixed number of points; others may have any number.
    pub fixed: &'static [&'static str],
    /// `true` if every path parameter is a row of control points of one curve, all rows equally long.
    pub rows: bool,
    /// Initial values, which move nothing and give every handle a position. If empty, the defaults or [`Info::demo`] are used.
    pub neutral: Pairs,
    /// Values that show the effect on any drawing, if [`Info::demo`] does not.
    pub showing: Pairs,
    /// Alternative initial values.
    pub variants: &'static [Variant],
    /// Parameters that replace others.
    pub instead: &'static [Instead],
}

impl ByHand {
    /// Nothing beyond the parameters.
    pub const NONE: Self = Self {
        label: None,
        labels: &[],
        fixed: &[],
        rows: false,
        neutral: &[],
        showing: &[],
        variants: &[],
        instead: &[],
    };
}

/// Alternative initial values, by another parameter than the usual ones.
#[derive(Debug, Clone, Copy)]
pub struct Variant {
    /// Its label.
    pub label: &'static str,
    /// The parameter that replaces the usual ones.
    pub param: &'static str,
    /// Path data that moves nothing.
    pub neutral: &'static str,
    /// Path data that shows the effect.
    pub showing: &'static str,
}

/// A parameter that replaces others.
#[derive(Debug, Clone, Copy)]
pub struct Instead {
    /// Its name.
    pub param: &'static str,
    /// The parameters that cannot go with it.
    pub others: &'static [&'static str],
    /// Another parameter that goes with it, and its value unless the user gives one.
    pub with: Option<(&'static str, &'static str)>,
}

/// The presets of a deformation, for a gallery that draws the artwork once under each.
#[derive(Debug, Clone, Copy)]
pub struct Gallery {
    /// The name of the set, kebab-case; users ask for the set by this name.
    pub set: &'static str,
    /// The presets in a few words, for the title of the sheet.
    pub title: &'static str,
    /// The parameter of kind [`NameOrFile`](crate::param::Kind::NameOrFile) whose names are the presets.
    pub presets: &'static str,
    /// The parameter for the amount by which a preset bends the artwork, if there is one.
    pub bend: Option<&'static str>,
    /// The parameter for the direction in which artwork runs through a preset (`horizontal` or `vertical`), if there is one.
    pub axis: Option<&'static str>,
}

/// A command line for help.
#[derive(Debug, Clone, Copy)]
pub struct Example {
    /// A caption: the effect of the command line.
    pub what: &'static str,
    /// The words after `pathwarp`, run from the project's root, `-o out.svg` included.
    pub command: &'static str,
}

/// Parameters' names and values, as a user would type them.
pub type Pairs = &'static [(&'static str, &'static str)];

/// A property of a deformation that [`check::entry`](crate::check::entry) tests, for artwork in the frame 0,0,100,100.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum Law {
    /// With these values nothing moves.
    Identity(Pairs),
    /// Both sets of values give the same map.
    Same(Pairs, Pairs),
    /// With these values straight lines stay straight.
    KeepsLines(Pairs),
    /// With these values straight lines in this direction stay straight.
    KeepsLinesAlong(Pairs, (f64, f64)),
    /// With these values nothing moves outside the box x0, y0, x1, y1.
    FixedOutside(Pairs, [f64; 4]),
    /// With these values every area is multiplied by this factor.
    Area(Pairs, f64),
    /// With these values angles between curves are kept, and nothing is mirrored.
    KeepsAngles(Pairs),
    /// The map of the second set of values is the inverse of that of the first.
    Undoes(Pairs, Pairs),
}

/// A point whose image is known.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// The parameters, in the frame 0,0,100,100.
    pub args: Pairs,
    /// A point of the source.
    pub at: (f64, f64),
    /// Its image.
    pub to: (f64, f64),
    /// The largest distance between the computed image and [`to`](Self::to), user units.
    pub tolerance: f64,
}

/// The result of building a deformation: its map, and what to report to the user.
#[derive(Clone)]
#[non_exhaustive]
pub struct Built {
    /// The map.
    pub map: Arc<dyn Map>,
    /// Notes, warnings and guides for the user.
    pub explanation: Explanation,
    /// Affine maps of the artwork's copies and letters, applied before the map or instead of it.
    pub placement: Placement,
    /// A ray in the image plane where the map brings two edges of the artwork together.
    pub seam: Option<Seam>,
    /// Files requested by parameters of kind [`Save`](crate::param::Kind::Save).
    pub saves: Vec<SavedFile>,
    /// The surface in space that the artwork lies on, for deformations onto surfaces.
    pub space: Option<InSpace>,
    /// Marks beside the result that show where to look from.
    pub sight: Option<Box<SightMark>>,
    /// Finds what lies behind another part of the artwork's box in the image, for views of surfaces in space that hide parts of themselves.
    pub hidden: Option<Hidden>,
    /// Explains why the map is undefined at a point, where it can.
    pub undefined: Option<Undefined>,
    /// Explains how the map failed after it was built, for maps that can fail.
    pub failure: Option<Failure>,
}

/// The reason why a map is undefined at a point of its source plane; `None` if it is defined there.
pub type Undefined = Arc<dyn Fn(Point) -> Option<String> + Send + Sync>;

/// The failure of a map that asks another program; `None` while there is none. A map that has failed gives NaN.
pub type Failure = Arc<dyn Fn() -> Option<Error> + Send + Sync>;

impl Built {
    /// Wraps a map that needs no explanation.
    #[must_use]
    pub fn new(map: Arc<dyn Map>) -> Self {
        Self {
            map,
            explanation: Explanation::default(),
            placement: Placement::default(),
            seam: None,
            saves: Vec::new(),
            space: None,
            sight: None,
            hidden: None,
            undefined: None,
            failure: None,
        }
    }

    /// Wraps the map of a program or function; `nothing` explains a point for which it gives no numbers.
    #[must_use]
    pub fn called(map: Called, nothing: &'static str) -> Self {
        let (values, state) = (map.clone(), map.clone());
        let mut built = Self::new(Arc::new(map));
        if values.is_partial() {
            built.undefined = Some(Arc::new(move |p| (!values.point(p).is_finite()).then(|| nothing.to_owned())));
        }
        built.failure = Some(Arc::new(move || state.failure()));
        built
    }

    /// Adds a note.
    pub fn note(&mut self, text: impl Into<String>) {
        self.explanation.notes.push(text.into());
    }

    /// Adds a warning.
    pub fn warn(&mut self, text: impl Into<String>) {
        self.explanation.warnings.push(text.into());
    }

    /// Adds a guide for the preview.
    pub fn overlay(&mut self, role: Role, path: BezPath) {
        self.explanation.overlays.push(Overlay { role, path });
    }

    setters! {
        /// Sets the explanation.
        explained(explanation: Explanation) => explanation: explanation;
    }
}

impl fmt::Debug for Built {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Built")
            .field("class", &self.map.class())
            .field("explanation", &self.explanation)
            .field("placement", &self.placement)
            .field("seam", &self.seam)
            .field("saves", &self.saves)
            .finish_non_exhaustive()
    }
}

/// Notes, warnings and guides for the user.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Explanation {
    /// Decisions made on the user's behalf.
    pub notes: Vec<String>,
    /// Problems the user should know of.
    pub warnings: Vec<String>,
    /// Guides that a preview draws over the artwork.
    pub overlays: Vec<Overlay>,
}

/// A guide for the preview.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    /// The part it plays.
    pub role: Role,
    /// The curve, in the order in which the deformation uses its anchors.
    pub path: BezPath,
}

/// The part that an overlay plays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The cage the artwork is bent into.
    Cage,
    /// The part of the source that the deformation takes hold of.
    Base,
    /// The image of the base.
    Target,
}

/// Affine maps of the artwork's copies and letters. Only the first step of a recipe can have them, and its inverse has none.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Placement {
    /// The positions of the artwork's copies in the source plane, the original included. A map gives every point one image, so
    /// copies are made before it. Empty: the artwork alone.
    pub copies: Vec<Affine>,
    /// For every letter of the frame, one affine map per copy of the artwork, which replaces the map for that letter. Empty:
    /// the map takes the letters as well.
    pub letters: Vec<Vec<Affine>>,
    /// `true` if `letters` are the maps of the frame's [objects](crate::param::Frame::objects) instead of its letters.
    pub of_objects: bool,
    /// `true` if `letters` move letters within the source plane, before the map.
    pub before: bool,
}

/// A ray in the image plane where the map brings two edges of the artwork together. The inverse map tears apart artwork that
/// crosses it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seam {
    /// The ray's end.
    pub end: Point,
    /// Another point of the ray.
    pub through: Point,
}

/// A file to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SavedFile {
    /// Its name as the user gave it.
    pub name: String,
    /// Its contents.
    pub text: String,
}

/// Marks beside the result that show where to look from, in the plane of the result.
#[derive(Debug, Clone, PartialEq)]
pub struct SightMark {
    /// Lines: the position of the eye or an arrow towards it, and the foot of a mirror.
    pub path: BezPath,
    /// The middle of the baseline of a line of text, and the text.
    pub label: (Point, String),
    /// The height of the text.
    pub size: f64,
}

/// Takes a point of the source to a point in space (x right, y down, z away, user units), if it has one.
pub type Place = Arc<dyn Fn(Point) -> Option<[f64; 3]> + Send + Sync>;

/// Returns the outlines of the hidden part of the source plane, by the even-odd rule, so that their image is within a tolerance.
pub type Hidden = Arc<dyn Fn(f64) -> Outline + Send + Sync>;

/// The surface in space that the artwork lies on.
#[derive(Clone)]
pub struct InSpace {
    /// Takes a point of the source to the surface: x right, y down, z away, user units. `None` if the ray misses the surface.
    pub place: Place,
    /// Further parts of the scene that a mesh shows, by name: a rectangle, or the artwork itself, laid elsewhere.
    pub besides: Vec<(&'static str, Option<Rect>, Place)>,
    /// Files requested by the parameters.
    pub files: Vec<SpaceFile>,
}

impl fmt::Debug for InSpace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("InSpace").field("files", &self.files).finish_non_exhaustive()
    }
}

/// A file of the artwork on its surface.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SpaceFile {
    /// The parameter that asked for it.
    pub param: &'static str,
    /// Its name as the user gave it.
    pub name: String,
    /// `true` for filled shapes as a mesh, `false` for outlines as polylines.
    pub filled: bool,
}
