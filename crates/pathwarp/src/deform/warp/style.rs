//! Warp styles as data: rules that turn a box and a bend into a net of sixteen points.
//!
//! A style starts from the identity net: point (j, c), row j from the top and column c from the left, lies at u = c/3, v = j/3
//! of the box, which here runs from 0,0 to w,h. Its rules are formulas over
//!
//! - `w`, `h`: the box; `b`: the bend, 1 for 100 %; `a` = |b|
//! - `k` = 4/3·tan(bπ/4), `S` = sin(bπ/2), `C` = cos(bπ/2): the ingredients of a circular arc of angle bπ
//! - `u`, `v`: the point's position in the box, in `moves`
//!
//! evaluated in this order: `let` (named values), `arcs` (rows that are one arc; in the family `boundary` the sides run
//! straight between their ends), `points` (absolute positions), `moves` (displacements).
//! An arc with ends `half` to the left and right of the middle at height `y` has its handles `lift`·half above the ends, and
//! 2/3·half·C/cos²(bπ/4) from them towards the middle: the usual cubic for a circular arc, written so that b = 0 gives the line.

use crate::formula::{Calculator, FormulaError};
use crate::map::{Net, complete_net};
use kurbo::{Point, Vec2};
use serde::Deserialize;
use std::sync::OnceLock;
use thiserror::Error;

/// A warp style: rules for a net of sixteen points over a box.
///
/// ```
/// use pathwarp::deform::Style;
///
/// let arch = Style::named("arch").unwrap();
/// let own = Style::from_json(r#"{ "name": "roof", "family": "boundary", "moves": [{ "at": "0,1", "y": "-b*h/2" }] }"#);
/// assert_eq!((arch.name(), own.unwrap().name()), ("arch", "roof"));
/// ```
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Style {
    pub(super) name: String,
    /// Other spellings.
    #[serde(default)]
    pub(super) also: Vec<String>,
    /// A description in a few words.
    #[serde(default)]
    pub(super) title: String,
    pub(super) family: Family,
    /// Largest bend, 1 for 100 %; without it, any bend that keeps the numbers finite is accepted.
    limit: Option<f64>,
    #[serde(default, rename = "let")]
    names: Vec<String>,
    #[serde(default)]
    arcs: Vec<ArcRow>,
    #[serde(default)]
    points: Vec<Rule>,
    #[serde(default)]
    moves: Vec<Rule>,
    /// Added to every point when the axis is vertical.
    upright: Option<Shift>,
}

/// The part of a style that a distortion scales.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Family {
    /// The twelve points of the sides; the bilinear Coons patch completes the inner four, with or without distortion.
    Boundary,
    /// All sixteen points.
    Points,
    /// The box; the style's displacements are added, scaled by the local factors.
    Frame,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct ArcRow {
    row: usize,
    y: String,
    half: String,
    lift: String,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Rule {
    /// `j,c`; `*` means all four.
    at: String,
    x: Option<String>,
    y: Option<String>,
}

impl Rule {
    /// Returns `false` if the formulas are certain to have one value everywhere.
    fn asks_for_the_place(&self) -> bool {
        self.x.iter().chain(&self.y).any(|f| f.contains(['u', 'v']))
    }
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Shift {
    x: Option<String>,
    y: Option<String>,
}

/// The parameters of a style.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::deform) struct StyleParams {
    /// 1 for 100 %.
    pub(in crate::deform) bend: f64,
    /// Horizontal and vertical distortion, 1 for 100 %.
    pub(in crate::deform) distortion: [f64; 2],
    /// Turns the style sideways.
    pub(in crate::deform) vertical: bool,
}

/// An error in a style's rules. Its message continues a sentence about the style.
#[derive(Debug, Clone, PartialEq, Error)]
pub(in crate::deform) enum StyleError {
    #[error(transparent)]
    Formula(#[from] FormulaError),
    #[error("has no row {0}: rows go from 0 to 3")]
    NoRow(usize),
    #[error("names the point `{0}`: write row,column, each from 0 to 3, or * for all")]
    BadPoint(String),
}

fn third(i: usize) -> f64 {
    i as f64 / 3.0
}

fn mapped(net: &Net, mut f: impl FnMut(usize, usize, Point) -> Point) -> Net {
    std::array::from_fn(|j| std::array::from_fn(|c| f(j, c, net[j][c])))
}

/// Swaps rows with columns and x with y.
fn transposed(net: &Net) -> Net {
    std::array::from_fn(|j| std::array::from_fn(|c| Point::new(net[c][j].y, net[c][j].x)))
}

/// Scales every column about the middle of its ends by 1 + amount·(2u − 1).
fn widened(net: &Net, amount: f64) -> Net {
    mapped(net, |_, c, p| {
        let middle = net[0][c].midpoint(net[3][c]);
        middle + (p - middle) * (1.0 + amount * (2.0 * third(c) - 1.0))
    })
}

/// Scales every row about the middle of its ends by 1 + amount·(2v − 1).
fn heightened(net: &Net, amount: f64) -> Net {
    mapped(net, |j, _, p| {
        let middle = net[j][0].midpoint(net[j][3]);
        middle + (p - middle) * (1.0 + amount * (2.0 * third(j) - 1.0))
    })
}

impl Style {
    /// Returns the built-in styles.
    #[must_use]
    pub fn builtin() -> Vec<Self> {
        presets().to_vec()
    }

    /// Returns the built-in style of this name, also as Photoshop spells it (`warpArc`).
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        presets().iter().find(|style| style.is_called(name)).cloned()
    }

    /// Reads a style from JSON.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) if the text is not JSON of a style. Formulas are checked when the style is used.
    pub fn from_json(text: &str) -> Result<Self, crate::Error> {
        Self::from_file("the style", text)
    }

    /// Reads a style from the text of a file.
    pub(super) fn from_file(name: &str, text: &str) -> Result<Self, crate::Error> {
        serde_json::from_str(text).map_err(|e| crate::Error::input(name, format!("is not a warp style: {e}")))
    }

    /// Returns the style's name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns `true` if the style has this name, or an alternative spelling of it.
    #[must_use]
    pub fn is_called(&self, name: &str) -> bool {
        self.name == name || self.also.iter().any(|a| a == name)
    }

    /// Returns the largest bend, 1 for 100 %; `None` if there is no limit.
    #[must_use]
    pub fn limit(&self) -> Option<f64> {
        self.limit
    }

    /// Returns the net over a box `w` wide and `h` high with its top left corner at the origin.
    pub(in crate::deform) fn net(&self, w: f64, h: f64, with: &StyleParams) -> Result<Net, StyleError> {
        let [horizontal, vertical] = with.distortion;
        if !with.vertical {
            return self
                .distorted(w, h, with.bend, [horizontal, vertical], |n| heightened(&widened(n, horizontal), vertical));
        }
        // Horizontal comes first in both cases; sideways it scales the rows.
        let net =
            self.distorted(h, w, with.bend, [vertical, horizontal], |n| widened(&heightened(n, horizontal), vertical))?;
        let shift = self.shift(h, w, with.bend)?;
        Ok(transposed(&mapped(&net, |_, _, p| p + shift)))
    }

    /// Returns the net under `distortion`, which scales columns and rows by these amounts.
    fn distorted(
        &self,
        w: f64,
        h: f64,
        b: f64,
        [columns, rows]: [f64; 2],
        distortion: impl Fn(&Net) -> Net,
    ) -> Result<Net, StyleError> {
        let rest: Net = std::array::from_fn(|j| std::array::from_fn(|c| Point::new(w * third(c), h * third(j))));
        let net = self.plain(&rest, w, h, b)?;
        let factor = |amount: f64, i: usize| 1.0 + amount * (2.0 * third(i) - 1.0);
        Ok(match self.family {
            Family::Boundary => complete_net(distortion(&net)),
            Family::Points => distortion(&net),
            Family::Frame => mapped(&distortion(&rest), |j, c, p| {
                p + (net[j][c] - rest[j][c]) * (factor(columns, c) * factor(rows, j))
            }),
        })
    }

    /// Applies the rules, without distortion.
    fn plain(&self, rest: &Net, w: f64, h: f64, b: f64) -> Result<Net, StyleError> {
        let mut names = self.names(w, h, b)?;
        let mut net = *rest;
        for arc in &self.arcs {
            let [y, half, lift] = [&arc.y, &arc.half, &arc.lift].map(|f| names.value(f));
            let (y, half, lift) = (y?, half?, lift?);
            let quarter = b * std::f64::consts::FRAC_PI_4;
            let along = 2.0 / 3.0 * half * (2.0 * quarter).cos() / quarter.cos().powi(2);
            let row = net.get_mut(arc.row).ok_or(StyleError::NoRow(arc.row))?;
            let (left, right, up) = (0.5 * w - half, 0.5 * w + half, y - lift * half);
            *row = [
                Point::new(left, y),
                Point::new(left + along, up),
                Point::new(right - along, up),
                Point::new(right, y),
            ];
        }
        if self.family == Family::Boundary {
            // The left and right sides are straight between the ends of the arcs.
            for c in [0, 3] {
                (net[1][c], net[2][c]) = (net[0][c].lerp(net[3][c], third(1)), net[0][c].lerp(net[3][c], third(2)));
            }
        }
        for (rules, absolute) in [(&self.points, true), (&self.moves, false)] {
            for rule in rules {
                let mut known = None;
                for (j, c) in selected(&rule.at)? {
                    names.set("u", third(c));
                    names.set("v", third(j));
                    let of = |f: &Option<String>| f.as_ref().map(|f| names.value(f)).transpose();
                    let value = || Ok::<_, FormulaError>((of(&rule.x)?, of(&rule.y)?));
                    let (x, y) = known.map_or_else(value, Ok)?;
                    known = (!rule.asks_for_the_place()).then_some((x, y));
                    let p = &mut net[j][c];
                    *p = if absolute {
                        Point::new(x.unwrap_or(p.x), y.unwrap_or(p.y))
                    } else {
                        *p + Vec2::new(x.unwrap_or(0.0), y.unwrap_or(0.0))
                    };
                }
            }
        }
        Ok(net)
    }

    fn names(&self, w: f64, h: f64, b: f64) -> Result<Calculator, FormulaError> {
        let half = b * std::f64::consts::FRAC_PI_2;
        let k = 4.0 / 3.0 * (0.5 * half).tan();
        let mut names = Calculator::new(&[
            ("w", w),
            ("h", h),
            ("b", b),
            ("a", b.abs()),
            ("k", k),
            ("S", half.sin()),
            ("C", half.cos()),
        ]);
        for text in &self.names {
            names.define(text)?;
        }
        Ok(names)
    }

    fn shift(&self, w: f64, h: f64, b: f64) -> Result<Vec2, FormulaError> {
        let Some(shift) = &self.upright else { return Ok(Vec2::ZERO) };
        let names = self.names(w, h, b)?;
        let of = |f: &Option<String>| f.as_ref().map_or(Ok(0.0), |f| names.value(f));
        Ok(Vec2::new(of(&shift.x)?, of(&shift.y)?))
    }
}

/// The built-in styles, read once: a batch of small drawings would spend a fifth of its time on them.
fn presets() -> &'static [Style] {
    static PRESETS: OnceLock<Vec<Style>> = OnceLock::new();
    // The text is part of this crate; a test reads every style.
    PRESETS.get_or_init(|| serde_json::from_str(include_str!("styles.json")).unwrap_or_default())
}

/// Returns the points that `j,c` selects.
fn selected(at: &str) -> Result<Vec<(usize, usize)>, StyleError> {
    let wrong = || StyleError::BadPoint(at.to_owned());
    let one = |t: &str| match t.trim() {
        "*" => Ok(0..4),
        n => n.parse::<usize>().ok().filter(|n| *n < 4).map(|n| n..n + 1).ok_or_else(wrong),
    };
    let (j, c) = at.split_once(',').ok_or_else(wrong)?;
    let (rows, columns) = (one(j)?, one(c)?);
    Ok(rows.flat_map(|j| columns.clone().map(move |c| (j, c))).collect())
}
