//! Text shapes as data: adjust values with their limits, formulas, and guide curves.
//!
//! Formulas use `w` and `h` (the box), `hc` = w/2, `vc` = h/2, `ss` = min(w, h), and the adjust values by their names: lengths
//! in 1/100000 of the box, angles in 1/60000 of a degree, clockwise from the right. A guide is written like path data with
//! formulas, without spaces, for numbers: `M x,y`, `L x,y …`, `Q x,y x,y`, `C x,y x,y x,y`, and `A cx,cy rx,ry from,sweep`, an
//! elliptical arc by the direction from its centre in which it begins, and the angle it sweeps.

use crate::formula::{Calculator, FormulaError};
use crate::outline::{EllipticArc, Seg};
use kurbo::{CubicBez, Line, Point, QuadBez, Vec2};
use serde::Deserialize;
use std::ops::RangeInclusive;
use thiserror::Error;

/// A text shape: guides over a box, with adjust values.
///
/// ```
/// use pathwarp::deform::TextShape;
///
/// assert_eq!(TextShape::named("Chevron Up").unwrap().name(), "chevron");
/// assert_eq!(TextShape::named("textWave1").unwrap().name(), "wave1");
/// ```
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TextShape {
    pub(super) name: String,
    /// Other names.
    #[serde(default)]
    also: Vec<String>,
    /// The adjust values.
    #[serde(default)]
    pub(super) adj: Vec<Adjust>,
    #[serde(default, rename = "let")]
    names: Vec<String>,
    /// Top and bottom guides, one pair below the other.
    #[serde(default)]
    bands: Vec<[String; 2]>,
    /// `true` if the shape surrounds a middle, so that its box should suit the artwork's proportion.
    #[serde(default)]
    pub(super) round: bool,
    /// Single guides that text stands on, one below the other.
    #[serde(default)]
    paths: Vec<String>,
}

/// An adjust value.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Adjust {
    pub(super) name: String,
    pub(super) default: f64,
    pub(super) least: f64,
    pub(super) most: f64,
}

impl Adjust {
    /// Refuses a value out of range; `shape` is the shape's name.
    pub(super) fn check(&self, value: f64, shape: &str) -> Result<(), crate::Error> {
        if (self.least..=self.most).contains(&value) {
            return Ok(());
        }
        let problem = format!("is out of range: {} of {shape} goes from {} to {}", self.name, self.least, self.most);
        Err(crate::Error::usage("adj", value.to_string(), problem))
    }
}

/// An error in a text shape's formulas. Its message continues a sentence about the shape.
#[derive(Debug, Clone, PartialEq, Error)]
pub(super) enum GuideError {
    #[error(transparent)]
    Formula(#[from] FormulaError),
    #[error("has a guide with `{0}`, which is not a point x,y")]
    BadPoint(String),
}

/// The guides of a text shape over a box.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Guides {
    /// Guides with the artwork between them: top and bottom of each band.
    Between(Vec<[Vec<Seg>; 2]>),
    /// Guides with the artwork standing on them.
    Along(Vec<Vec<Seg>>),
}

/// Reduces a name to letters and digits, so that `textWave1`, `Wave 1` and `wave-1` are equal.
fn bare(name: &str) -> String {
    let name: String = name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect();
    name.strip_prefix("text").map(str::to_owned).unwrap_or(name)
}

impl TextShape {
    /// Returns the built-in text shapes.
    #[must_use]
    pub fn builtin() -> Vec<Self> {
        // The text is part of this crate; a test reads every shape.
        serde_json::from_str(include_str!("presets.json")).unwrap_or_default()
    }

    /// Returns the built-in text shape of this name, also as office menus (`Chevron Up`) and files (`textChevron`) spell it.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::builtin().into_iter().find(|shape| shape.is_called(name))
    }

    /// Reads a text shape from JSON.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) if the text is not JSON of a text shape. Formulas are checked when the shape is
    /// used.
    pub fn from_json(text: &str) -> Result<Self, crate::Error> {
        Self::from_file("the text shape", text)
    }

    /// Reads a text shape from the text of a file.
    pub(super) fn from_file(name: &str, text: &str) -> Result<Self, crate::Error> {
        serde_json::from_str(text).map_err(|e| crate::Error::input(name, format!("is not a text shape: {e}")))
    }

    /// Returns the shape's name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the adjust values: the name, the range, and the value unless another is given. Ranges beyond a million are angles in
    /// 1/60000 degree, others in 1/100000 of the box.
    pub fn adjust_values(&self) -> impl Iterator<Item = (&str, RangeInclusive<f64>, f64)> {
        self.adj.iter().map(|a| (a.name.as_str(), a.least..=a.most, a.default))
    }

    /// Returns `true` if the shape has this name, or another by which people know it.
    #[must_use]
    pub fn is_called(&self, name: &str) -> bool {
        let name = bare(name);
        bare(&self.name) == name || self.also.iter().any(|a| bare(a) == name)
    }

    /// Returns the guides over a box `w` wide and `h` high with its top left corner at the origin. `adjusted` holds one value
    /// for each of [`TextShape::adj`].
    pub(super) fn guides(&self, w: f64, h: f64, adjusted: &[f64]) -> Result<Guides, GuideError> {
        let mut names = Calculator::new(&[("w", w), ("h", h), ("hc", 0.5 * w), ("vc", 0.5 * h), ("ss", w.min(h))]);
        for (a, value) in self.adj.iter().zip(adjusted) {
            names.set(&a.name, *value);
        }
        for text in &self.names {
            names.define(text)?;
        }
        if !self.paths.is_empty() {
            return Ok(Guides::Along(self.paths.iter().map(|p| guide(p, &names)).collect::<Result<_, _>>()?));
        }
        let pair = |[top, bottom]: &[String; 2]| Ok::<_, GuideError>([guide(top, &names)?, guide(bottom, &names)?]);
        Ok(Guides::Between(self.bands.iter().map(pair).collect::<Result<_, _>>()?))
    }
}

/// Evaluates one guide.
fn guide(text: &str, names: &Calculator) -> Result<Vec<Seg>, GuideError> {
    let mut out: Vec<Seg> = Vec::new();
    let mut command = ' ';
    let mut at = Point::ORIGIN;
    let mut pending: Vec<Point> = Vec::new();
    for word in text.split_whitespace() {
        if let ("M" | "L" | "Q" | "C" | "A", Some(c)) = (word, word.chars().next()) {
            command = c;
            continue;
        }
        let (x, y) = word.split_once(',').ok_or_else(|| GuideError::BadPoint(word.to_owned()))?;
        pending.push(Point::new(names.value(x)?, names.value(y)?));
        let seg = match (command, &pending[..]) {
            ('M', [p]) => {
                at = *p;
                None
            }
            ('L', [p]) => Some(Seg::Line(Line::new(at, *p))),
            ('Q', [p, q]) => Some(Seg::Quad(QuadBez::new(at, *p, *q))),
            ('C', [p, q, r]) => Some(Seg::Cubic(CubicBez::new(at, *p, *q, *r))),
            ('A', [c, radii, angles]) => Some(Seg::Arc(arc(*c, *radii, angles.x, angles.y))),
            _ => continue,
        };
        pending.clear();
        if let Some(seg) = seg {
            at = seg.end();
            out.push(seg);
        }
    }
    Ok(out)
}

/// Returns the arc from one direction through an angle, both in 1/60000 of a degree.
///
/// The point of an ellipse in the direction α from its centre has the parameter atan2(rx·sin α, ry·cos α).
fn arc(center: Point, radii: Point, from: f64, sweep: f64) -> EllipticArc {
    use std::f64::consts::{PI, TAU};
    const UNIT: f64 = PI / 10_800_000.0;
    let parameter = |direction: f64| {
        let off = (radii.x * direction.sin()).atan2(radii.y * direction.cos()) - direction;
        // Parameter and direction differ by less than a quarter turn.
        direction + off - TAU * (off / TAU).round()
    };
    let (first, last) = (parameter(from * UNIT), parameter((from + sweep) * UNIT));
    EllipticArc::new(center, Vec2::new(radii.x, 0.0), Vec2::new(0.0, radii.y), first, last - first)
}
