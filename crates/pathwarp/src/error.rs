//! Errors: each message names the problem, its place, and a remedy.
//!
//! The kinds differ in who can fix them: [`Error::Usage`] and [`Error::Missing`] (the caller), [`Error::Input`] (a file) and
//! [`Error::Geometry`] (the drawing does not allow the deformation). Messages call parameters by their bare names; the command
//! line adds its dashes.

use crate::budget::Exceeded;
use kurbo::{Point, Rect};
use thiserror::Error;

/// Any error from a parameter's value to the warped path.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// A parameter has a value it cannot have.
    #[error("{param}{} {problem}{advice}", quoted(.value))]
    Usage {
        /// The parameter's name, such as `bottom`.
        param: String,
        /// The value as the user wrote it; empty if the parameter should not be there at all.
        value: String,
        /// The problem, and legal values: the end of a sentence that begins with the value.
        problem: String,
        /// The remedy, with the punctuation that joins it to the problem; empty if the problem contains it.
        advice: String,
    },
    /// A required parameter was not given.
    #[error("{param} is needed: {hint}")]
    Missing {
        /// The parameter's name.
        param: String,
        /// A description of the value to give.
        hint: String,
    },
    /// A file cannot be read or understood.
    #[error("{place}: {problem}")]
    Input {
        /// The file and the position in it (line:column or byte), or the path reference.
        place: String,
        /// The problem and a remedy.
        problem: String,
        /// The limit, if the file takes more work than it allows.
        limit: Option<Exceeded>,
    },
    /// The geometry forbids the deformation.
    #[error(transparent)]
    Geometry(GeometryError),
    /// A tolerance that is not positive or not finite.
    #[error("{}", GeometryError::Tolerance(*.0))]
    Tolerance(f64),
}

impl From<GeometryError> for Error {
    fn from(e: GeometryError) -> Self {
        match e {
            GeometryError::Tolerance(tolerance) => Self::Tolerance(tolerance),
            e => Self::Geometry(e),
        }
    }
}

/// An error because the drawing, or a path that controls the deformation, does not allow it.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// A path that must be closed is open.
    #[error(
        "{path} is not closed: it ends at {}, {:.6} away from its start {}; close it (in SVG: end the path with Z)",
        show(*end), end.distance(*start), show(*start)
    )]
    NotClosed {
        /// The path as the user named it.
        path: String,
        /// Its first point.
        start: Point,
        /// Its last point.
        end: Point,
    },
    /// A path has the wrong number of anchors.
    #[error("{path} has {found} anchors ({}); it needs {expected}", show_all(anchors))]
    AnchorCount {
        /// The path as the user named it.
        path: String,
        /// The number of anchors it has.
        found: usize,
        /// The first anchors (at most eight).
        anchors: Vec<Point>,
        /// The number it needs, in words.
        expected: &'static str,
    },
    /// Three of four corners lie on one line.
    #[error(
        "{path}: anchors {}, {} and {} ({}) lie on one line; move one of them",
        which[0], which[1], which[2], show_all(points)
    )]
    Collinear {
        /// The path as the user named it.
        path: String,
        /// The anchors' numbers, counted from 1 in path order.
        which: [usize; 3],
        /// The anchors.
        points: Vec<Point>,
    },
    /// Two anchors that must differ coincide.
    #[error("{path}: anchors {} and {} coincide at {}; move them apart", which[0], which[1], show(*at))]
    Coincident {
        /// The path as the user named it.
        path: String,
        /// The anchors' numbers, counted from 1 in path order.
        which: [usize; 2],
        /// Their position.
        at: Point,
    },
    /// A control point of a row lies on, or beyond, the line through the row's end and the facing row's end.
    #[error(
        "{path}: point {which} ({}) lies {} the line through the {end} points of both rows ({}), so that the map would have a pole: move it off, to the side of the other points{}",
        show(*at), if *on { "on" } else { "beyond" }, show_all(line), if *on { "" } else { ", or allow poles" }
    )]
    WrongSide {
        /// The row as the user named it.
        path: String,
        /// The point's number, counted from 1.
        which: usize,
        /// Its position.
        at: Point,
        /// The rows' end: first or last.
        end: &'static str,
        /// The line.
        line: [Point; 2],
        /// `true` if it lies on the line itself, where no weight helps.
        on: bool,
    },
    /// The artwork is as flat as a line, so that its box cannot be the base.
    #[error(
        "the artwork's box is {width} wide and {height} high: too flat to be deformed as a box; name another base or frame"
    )]
    FlatFrame {
        /// The box's width.
        width: f64,
        /// The box's height.
        height: f64,
    },
    /// The horizon of the projective map between these corners lies among them.
    #[error(
        "{path}: the projective map from {} to {} hits infinity between these corners, because one of the quadrilaterals is convex and the other is not; move a corner, or change their order",
        show_all(from),
        show_all(to)
    )]
    NotConvex {
        /// The path as the user named it.
        path: String,
        /// The source corners.
        from: Vec<Point>,
        /// The target corners.
        to: Vec<Point>,
    },
    /// The map is infinite or undefined at a point of a shape.
    #[error(
        "{shape} hits infinity at {}: the map has no finite value there; change the values of the deformation, move the artwork away from there, or leave this shape out",
        show(*at)
    )]
    Infinity {
        /// The shape's id.
        shape: String,
        /// The point in the source drawing.
        at: Point,
    },
    /// A coordinate is not a finite number, or too large to compute with.
    #[error("{shape} has a coordinate that is not finite, or larger than 1e100, near {}", show(*at))]
    NotFinite {
        /// The shape's id or the path as the user named it.
        shape: String,
        /// The point in the source drawing.
        at: Point,
    },
    /// Warping takes more work than a limit allows.
    #[error("warping takes {0}")]
    Limit(Exceeded),
    /// A tolerance that is not positive or not finite; becomes [`Error::Tolerance`].
    #[error("the tolerance {0} is not a positive, finite number; give the largest distance that is allowed")]
    Tolerance(f64),
    /// The crossings of an area's edges could not be determined.
    #[error(
        "the crossings of the edges of {shape} could not be determined; try another tolerance, or leave this shape out"
    )]
    Crossings {
        /// The shape's id.
        shape: String,
    },
    /// A map has no inverse.
    #[error("{what} has no inverse: {why}")]
    NoInverse {
        /// The deformation.
        what: String,
        /// The reason.
        why: String,
    },
}

impl From<bezierfit::Error> for GeometryError {
    fn from(e: bezierfit::Error) -> Self {
        let shape = "path".to_owned();
        match e {
            bezierfit::Error::NotFinite(e) => Self::NotFinite { shape, at: e.at },
            bezierfit::Error::Tolerance(t) => Self::Tolerance(t),
            _ => Self::Crossings { shape },
        }
    }
}

impl GeometryError {
    /// Creates a [`GeometryError::AnchorCount`].
    pub(crate) fn anchor_count(path: &str, anchors: &[Point], expected: &'static str) -> Self {
        let (found, shown) = (anchors.len(), anchors.iter().take(8).copied().collect());
        Self::AnchorCount { path: path.to_owned(), found, anchors: shown, expected }
    }

    /// The point that the error is about, if it is about one.
    #[must_use]
    pub fn place(&self) -> Option<Point> {
        match self {
            Self::Infinity { at, .. }
            | Self::NotFinite { at, .. }
            | Self::Coincident { at, .. }
            | Self::WrongSide { at, .. }
            | Self::NotClosed { end: at, .. } => Some(*at),
            _ => None,
        }
    }

    /// Returns this error with the name of the shape on which it happened.
    #[must_use]
    pub fn on_shape(mut self, name: &str) -> Self {
        if let Self::Infinity { shape, .. } | Self::NotFinite { shape, .. } | Self::Crossings { shape } = &mut self {
            name.clone_into(shape);
        }
        self
    }
}

impl Error {
    /// Creates an [`Error::Usage`].
    pub fn usage(param: &str, value: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::advised(param, value, problem, "")
    }

    /// Creates an [`Error::Usage`] whose advice a caller may replace.
    pub(crate) fn advised(
        param: &str,
        value: impl Into<String>,
        problem: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        let (value, problem, advice) = (value.into(), problem.into(), advice.into());
        Self::Usage { param: param.to_owned(), value, problem, advice }
    }

    /// Creates an [`Error::Missing`].
    pub fn missing(param: &str, hint: impl Into<String>) -> Self {
        Self::Missing { param: param.to_owned(), hint: hint.into() }
    }

    /// Creates an [`Error::Input`] for a file that takes too much work. `what` is the cause and a verb: `its text takes`.
    pub fn limit(place: impl Into<String>, what: impl Into<String>, exceeded: Exceeded) -> Self {
        let problem = format!("{} {exceeded}", what.into());
        Self::Input { place: place.into(), problem, limit: Some(exceeded) }
    }

    /// Creates an [`Error::Input`].
    pub fn input(place: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Input { place: place.into(), problem: problem.into(), limit: None }
    }
}

/// The error about a JSON file in a build that cannot read it.
#[cfg(not(feature = "serde"))]
pub(crate) fn no_json(place: &str) -> Error {
    Error::input(place, "is JSON, and this build lacks the feature `serde` that reads it")
}

/// Returns a box if it has an area.
pub(crate) fn with_area(r: Rect) -> Result<Rect, GeometryError> {
    let (width, height) = (r.width(), r.height());
    if width > 0.0 && height > 0.0 { Ok(r) } else { Err(GeometryError::FlatFrame { width, height }) }
}

/// Returns `value` if it is within the range, ends included.
pub(crate) fn check_range(param: &str, value: f64, min: f64, max: f64) -> Result<f64, Error> {
    if (min..=max).contains(&value) {
        return Ok(value);
    }
    Err(Error::usage(param, value.to_string(), format!("is out of range: {min} to {max}")))
}

/// Quotes the value of an [`Error::Usage`] in backticks, after the parameter.
fn quoted(value: &str) -> String {
    if value.is_empty() { String::new() } else { format!(": `{value}`") }
}

/// Formats a point for a message.
pub(crate) fn show(p: Point) -> String {
    format!("{},{}", round6(p.x), round6(p.y))
}

fn show_all(points: &[Point]) -> String {
    points.iter().map(|p| show(*p)).collect::<Vec<_>>().join(" ")
}

/// Rounds to six decimals: enough to find a point, and short.
fn round6(v: f64) -> f64 {
    let rounded = (v * 1e6).round() / 1e6;
    // Adding 0 removes the sign of -0.
    if rounded.is_finite() { rounded + 0.0 } else { v }
}
