//! Text shapes as data: adjust values with their limits, formulas, and guide curves.
//!
//! Formulas use `w` and `h` (the size of the box), `hc` = w/2, `vc` = h/2, `ss` = min(w, h), and the adjust values by their names:
//! lengths in 1/100000 of the box, angles in 1/60000 of a degree, clockwise from the right. A guide is written like path data, with
//! formulas without spaces instead of numbers: `M x,y`, `L x,y …`, `Q x,y x,y`, `C x,y x,y x,y`, and `A cx,cy rx,ry from,sweep` for an
//! elliptical arc, which begins in the direction `from` as seen from its centre and sweeps the angle `sweep`.

use crate::formula::{Calculator, FormulaError};
use crate::map::Map;
use crate::map::curves::ArcLength;
use crate::outline::{EllipticArc, Seg};
use crate::param::Letter;
use kurbo::{CubicBez, Line, Point, QuadBez, Rect, Size, Vec2};
use serde::Deserialize;
use std::ops::RangeInclusive;
use std::sync::Arc;
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
    /// Alternative names.
    #[serde(default)]
    also: Vec<String>,
    #[serde(default)]
    pub(super) adj: Vec<Adjust>,
    /// Formulas `name = …`, which later ones and the guides may use.
    #[serde(default, rename = "let")]
    definitions: Vec<String>,
    /// Top and bottom guides, one pair below the other.
    #[serde(default)]
    bands: Vec<[String; 2]>,
    /// `true` if the shape surrounds a middle, so that its box is fitted to the artwork's proportions.
    #[serde(default)]
    pub(super) round: bool,
    /// Single guides on which text stands, one below the other.
    #[serde(default)]
    paths: Vec<String>,
}

/// A declaration of an adjust value.
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
    /// Guides with the artwork between them: the top and the bottom of each band.
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

    /// Returns the built-in text shape of this name, which may be spelt as in office menus (`Chevron Up`) or files (`textChevron`).
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::builtin().into_iter().find(|shape| shape.is_called(name))
    }

    /// Reads a text shape from JSON.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) when the text is not JSON of a text shape. Formulas are checked when the shape is
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

    /// Returns the name, the range and the default of every adjust value. Ranges beyond a million are angles in 1/60000 degree,
    /// others in 1/100000 of the box.
    pub fn adjust_values(&self) -> impl Iterator<Item = (&str, RangeInclusive<f64>, f64)> {
        self.adj.iter().map(|a| (a.name.as_str(), a.least..=a.most, a.default))
    }

    /// Returns `true` for the shape's name and its alternative names.
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
        for text in &self.definitions {
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
    let mut current = Point::ORIGIN;
    // The points of a segment that is not complete yet.
    let mut pending: Vec<Point> = Vec::new();
    for word in text.split_whitespace() {
        if let ("M" | "L" | "Q" | "C" | "A", Some(c)) = (word, word.chars().next()) {
            command = c;
            continue;
        }
        let (x, y) = word.split_once(',').ok_or_else(|| GuideError::BadPoint(word.to_owned()))?;
        pending.push(Point::new(names.value(x)?, names.value(y)?));
        match (command, &pending[..]) {
            ('M', [p]) => current = *p,
            ('L', [p]) => out.push(Seg::Line(Line::new(current, *p))),
            ('Q', [p, q]) => out.push(Seg::Quad(QuadBez::new(current, *p, *q))),
            ('C', [p, q, r]) => out.push(Seg::Cubic(CubicBez::new(current, *p, *q, *r))),
            ('A', [c, radii, angles]) => out.push(Seg::Arc(arc(*c, *radii, angles.x, angles.y))),
            _ => continue,
        }
        pending.clear();
        if command != 'M' {
            current = out.last().map_or(current, Seg::end);
        }
    }
    Ok(out)
}

/// Returns the arc from one direction through an angle, both in 1/60000 of a degree.
///
/// The point of an ellipse in the direction α from its centre has the parameter atan2(rx·sin α, ry·cos α), where rx and ry are its radii.
fn arc(center: Point, radii: Point, from: f64, sweep: f64) -> EllipticArc {
    use std::f64::consts::{PI, TAU};
    /// 1/60000 of a degree.
    const UNIT: f64 = PI / 10_800_000.0;
    let parameter = |direction: f64| {
        let difference = (radii.x * direction.sin()).atan2(radii.y * direction.cos()) - direction;
        // The parameter and the direction differ by less than a quarter turn.
        direction + difference - TAU * (difference / TAU).round()
    };
    let (first, last) = (parameter(from * UNIT), parameter((from + sweep) * UNIT));
    EllipticArc::new(center, Vec2::new(radii.x, 0.0), Vec2::new(0.0, radii.y), first, last - first)
}

// The box of a text shape, fitted to the artwork, and the lines of lettering.
//
// On a single guide, letters keep their size and the box is a square. The length of an offset is linear in its height: at half the
// height of artwork of width w and height h, a guide of length L that turns by θ (positive: outwards) has the length L + θh/2. The
// artwork fills it if L = w − θh/2. Between two guides, the box has the proportions whose map distorts the artwork least, and the
// size that keeps the artwork's area.

/// The box in which a text shape is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum ShapeBox {
    /// For round shapes, a box fitted to the artwork's proportions; for all others, the artwork's box.
    #[default]
    Fit,
    /// The artwork's box.
    Artwork,
    /// This box.
    Given(Rect),
}

/// A guide that returns to its start within this fraction of its length is closed.
const CLOSED: f64 = 1e-3;
/// On the outside of a guide, the tops of letters are at most 1 + this times as wide as their feet.
const WIDEST: f64 = 1.0;
/// Limit on the narrowing of letters that stand inside a guide: their tops are at least 1 − this times as wide as their feet.
const NARROWEST: f64 = 0.5;

/// Factor by which the box is enlarged, so that rounding makes no artwork longer than its guide.
const SLACK: f64 = 1.0 + 1e-6;

/// Returns `true` if a guide ends where it starts.
pub(super) fn is_closed(guide: &[Seg]) -> bool {
    let ends = guide.first().zip(guide.last());
    ends.is_some_and(|(a, b)| a.start().distance(b.end()) < CLOSED * length(guide))
}

/// Returns the side of the square box in which artwork of `width` × `height` stands on a guide true to size. `guide` is drawn in the
/// unit square.
pub(super) fn side(guide: &[Seg], width: f64, height: f64) -> f64 {
    let turn = turn(guide);
    let min = if turn > 0.0 { turn * height / WIDEST } else { -turn * height / NARROWEST };
    (width - 0.5 * turn * height).max(min) * SLACK / length(guide)
}

/// Returns the distance along a guide of its highest point on the screen, as a fraction of its length.
pub(super) fn share_at_top(guide: &[Seg]) -> f64 {
    let (mut top_y, mut distance, mut before) = (f64::INFINITY, 0.0, 0.0);
    for s in guide {
        if let Some((u, y)) = samples().map(|(u, _)| (u, s.eval(u).y)).min_by(|a, b| a.1.total_cmp(&b.1))
            && y < top_y
        {
            (top_y, distance) = (y, before + ArcLength::new(&|t| s.deriv(t * u).hypot() * u).length());
        }
        before += length(std::slice::from_ref(s));
    }
    distance / before
}

/// Returns `true` if artwork of a width and height leaves more than `space` of a guide free.
pub(super) fn is_loose(guide: &[Seg], width: f64, height: f64, space: f64) -> bool {
    mid_length(guide, height) > (width + space) * (1.0 + CLOSED)
}

/// Returns the length of a guide, measured at half the height of the artwork that stands on it.
pub(super) fn mid_length(guide: &[Seg], height: f64) -> f64 {
    length(guide) + 0.5 * turn(guide) * height
}

/// Number of intervals of a guide's piece, in each of which its tangent turns by less than half a circle.
const SAMPLES: u32 = 256;

/// The ends of these intervals.
fn samples() -> impl Iterator<Item = (f64, f64)> {
    (0..SAMPLES).map(|i| (f64::from(i) / f64::from(SAMPLES), f64::from(i + 1) / f64::from(SAMPLES)))
}

pub(super) fn length(guide: &[Seg]) -> f64 {
    guide.iter().map(|s| ArcLength::of_segment(s).length()).sum()
}

/// Returns the total turn of the tangent, radians, clockwise on the screen.
fn turn(guide: &[Seg]) -> f64 {
    let angle = |a: Vec2, b: Vec2| a.cross(b).atan2(a.dot(b));
    guide.iter().flat_map(|s| samples().map(move |(a, b)| angle(s.deriv(a), s.deriv(b)))).sum()
}

/// Returns the box about the middle of `rect` whose map distorts the artwork least and keeps its area. `map` builds the map for a box;
/// it returns `None` if a guide has no length there.
pub(super) fn least_distorting<E>(
    rect: Rect,
    map: impl Fn(Rect) -> Result<Option<Arc<dyn Map>>, E>,
) -> Result<Rect, E> {
    /// Largest logarithm of the proportions tried, which are between 1:20 and 20:1.
    const RANGE: f64 = 3.0;
    /// Number of steps of golden section, which find the proportions to a millionth, so that differences in rounding do not show.
    const STEPS: usize = 32;
    // The box of the artwork's area whose proportion has the logarithm `log`.
    let proportioned = |log: f64| {
        let side = (rect.width() * rect.height()).sqrt();
        Rect::from_center_size(rect.center(), Size::new(side * (0.5 * log).exp(), side * (-0.5 * log).exp()))
    };
    let measured = |log: f64| Ok(map(proportioned(log))?.map_or((f64::INFINITY, 1.0), |m| distortion(rect, &*m)));
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut a, mut b) = (-RANGE, RANGE);
    // Two logarithms between a and b, each with its cost.
    let with_cost = |log: f64| Ok((log, measured(log)?.0));
    let (mut x, mut y) = (with_cost(b - golden * (b - a))?, with_cost(a + golden * (b - a))?);
    for _ in 0..STEPS {
        if x.1 <= y.1 {
            (b, y) = (y.0, x);
            x = with_cost(b - golden * (b - a))?;
        } else {
            (a, x) = (x.0, y);
            y = with_cost(a + golden * (b - a))?;
        }
    }
    let best = 0.5 * (a + b);
    let scale = measured(best)?.1.sqrt().recip();
    let found = proportioned(best);
    Ok(Rect::from_center_size(found.center(), found.size() * scale))
}

/// Returns the mean squared logarithm of the ratio of the singular values over a box, and the mean factor of areas.
fn distortion(rect: Rect, map: &dyn Map) -> (f64, f64) {
    /// Columns and rows of sampled points.
    const GRID: [u32; 2] = [24, 3];
    /// The squared logarithm that counts for a collapsed or mirrored point, and its upper limit.
    const WORST: f64 = 50.0;
    let fraction = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n);
    let (mut cost, mut area) = (0.0, 0.0);
    for (i, j) in (0..GRID[0]).flat_map(|i| (0..GRID[1]).map(move |j| (i, j))) {
        let (u, v) = (fraction(i, GRID[0]), fraction(j, GRID[1]));
        let p = Point::new(rect.x0 + rect.width() * u, rect.y0 + rect.height() * v);
        let jet = map.jet(p);
        // σ₁/σ₂ + σ₂/σ₁ = (|Fx|² + |Fy|²)/det = 2 cosh ln(σ₁/σ₂).
        let cosh = 0.5 * (jet.dx.hypot2() + jet.dy.hypot2()) / jet.det();
        cost += if cosh >= 1.0 { cosh.acosh().powi(2).min(WORST) } else { WORST };
        area += jet.det().abs();
    }
    let count = f64::from(GRID[0] * GRID[1]);
    (cost / count, area / count)
}

/// A line of lettering: its baseline, and the y of the highest and the lowest point of its letters.
pub(super) struct TextLine {
    baseline: f64,
    top: f64,
    bottom: f64,
}

/// Returns the lines of the letters within `rect`, from top to bottom.
pub(super) fn lines(letters: &[Letter], rect: Rect) -> Vec<TextLine> {
    let mut lines: Vec<TextLine> = Vec::new();
    // Letters may stick out at the sides; on the upper edge, the middle of one must be within.
    let is_within = |l: &&Letter| rect.contains(l.middle()) || (rect.y0 < l.origin.y && l.origin.y <= rect.y1);
    for l in letters.iter().filter(is_within) {
        let (Some(b), baseline) = (l.outline.bounding_box(), l.origin.y) else { continue };
        match lines.iter_mut().find(|line| (line.baseline - baseline).abs() < 0.5 * b.height().max(l.advance)) {
            Some(line) => (line.top, line.bottom) = (line.top.min(b.y0), line.bottom.max(b.y1)),
            None => lines.push(TextLine { baseline, top: b.y0, bottom: b.y1 }),
        }
    }
    lines.sort_by(|a, b| a.baseline.total_cmp(&b.baseline));
    lines
}

/// Returns the heights in the middle of the gaps between lines; `None` unless they increase downwards and lie inside `rect`.
pub(super) fn gaps(lines: &[TextLine], rect: Rect) -> Option<Vec<f64>> {
    let cuts: Vec<f64> = lines.windows(2).map(|w| 0.5 * (w[0].bottom + w[1].top)).collect();
    let is_sorted = cuts.windows(2).all(|w| w[0] < w[1]);
    (is_sorted && cuts.iter().all(|y| *y > rect.y0 && *y < rect.y1)).then_some(cuts)
}
