//! Errors for people: what is wrong, where, and what to do about it.
//!
//! There are three kinds, told apart by who can mend them: [`Error::Usage`] (the command or recipe), [`Error::Input`]
//! (a file) and [`Error::Geometry`] (the drawing does not allow what was asked).

use kurbo::Point;
use thiserror::Error;

/// Anything that can go wrong between a typed command and a warped path.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// A parameter has a value it cannot have.
    #[error("{param}: `{value}` {problem}")]
    Usage {
        /// The parameter as the user writes it, e.g. `--bottom`.
        param: String,
        /// The value as the user wrote it.
        value: String,
        /// What is wrong with it and what would be legal.
        problem: String,
    },
    /// A parameter that is needed was not given.
    #[error("{param} is needed: {hint}")]
    Missing {
        /// The parameter as the user writes it.
        param: String,
        /// What to write.
        hint: String,
    },
    /// A file cannot be read or understood.
    #[error("{place}: {problem}")]
    Input {
        /// File and place in it (line:column or byte), or the path reference.
        place: String,
        /// What is wrong and what to do.
        problem: String,
    },
    /// The geometry forbids it.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
}

/// The drawing, or the cage it is to be bent into, does not allow the deformation.
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
        /// Where it starts.
        start: Point,
        /// Where it ends.
        end: Point,
    },
    /// A path has the wrong number of anchors.
    #[error("{path} has {found} anchors ({}); it needs {expected}", show_all(anchors))]
    AnchorCount {
        /// The path as the user named it.
        path: String,
        /// How many anchors it has.
        found: usize,
        /// The first anchors (at most eight).
        anchors: Vec<Point>,
        /// How many it needs, in words.
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
        /// Where.
        at: Point,
    },
    /// A control point of a row lies on, or beyond, the line through the row's end and the facing row's.
    #[error(
        "{path}: point {which} ({}) lies {} the line through the {end} points of both rows ({}), so that the map would have a pole: move it off, to the side of the other points{}",
        show(*at), if *on { "on" } else { "beyond" }, show_all(line), if *on { "" } else { ", or allow poles" }
    )]
    WrongSide {
        /// The row as the user named it.
        path: String,
        /// The point's number, counted from 1.
        which: usize,
        /// Where it is.
        at: Point,
        /// Which end: first or last.
        end: &'static str,
        /// The line.
        line: [Point; 2],
        /// Whether it lies on the line itself, where no weight helps.
        on: bool,
    },
    /// The artwork is as flat as a line, and its box was to be the Base.
    #[error(
        "the artwork's box is {width} wide and {height} high: too flat to be the Base; give --base, or --frame X,Y,W,H"
    )]
    FlatFrame {
        /// The box's width.
        width: f64,
        /// The box's height.
        height: f64,
    },
    /// A projective map between these corners has its horizon among them.
    #[error(
        "{path}: the projective map from {} to {} hits infinity between these corners, because one of the quadrilaterals is convex and the other is not; move a corner, or mind their order",
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
    /// The map is infinite, or undefined, somewhere on a shape.
    #[error(
        "{shape} hits infinity at {}: the map has no finite value there; move the anchors so that the artwork stays on one side of the horizon, or leave this shape out",
        show(*at)
    )]
    Infinity {
        /// The shape's id.
        shape: String,
        /// The place in the source drawing.
        at: Point,
    },
    /// A coordinate is not a finite number, or too large to compute with.
    #[error("{shape} has a coordinate that is not finite, or larger than 1e100, near {}", show(*at))]
    NotFinite {
        /// The shape's id or the path as the user named it.
        shape: String,
        /// The place in the source drawing.
        at: Point,
    },
    /// A map cannot be turned round.
    #[error("{what} has no inverse: {why}")]
    NoInverse {
        /// The deformation.
        what: String,
        /// Why not.
        why: String,
    },
}

impl GeometryError {
    /// The same error, naming `shape` as the one it happened on.
    #[must_use]
    pub fn on_shape(mut self, name: &str) -> Self {
        if let Self::Infinity { shape, .. } | Self::NotFinite { shape, .. } = &mut self {
            name.clone_into(shape);
        }
        self
    }
}

impl Error {
    /// A wrong value for a parameter.
    pub fn usage(param: &str, value: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Usage { param: format!("--{param}"), value: value.into(), problem: problem.into() }
    }

    /// A file or path reference that cannot be used.
    pub fn input(place: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Input { place: place.into(), problem: problem.into() }
    }
}

/// A point as people write it.
pub(crate) fn show(p: Point) -> String {
    format!("{},{}", round6(p.x), round6(p.y))
}

fn show_all(points: &[Point]) -> String {
    points.iter().map(|p| show(*p)).collect::<Vec<_>>().join(" ")
}

/// Six decimals are enough to find a place, and keep messages short.
fn round6(v: f64) -> f64 {
    let r = (v * 1e6).round() / 1e6;
    if r.is_finite() { r + 0.0 } else { v }
}
