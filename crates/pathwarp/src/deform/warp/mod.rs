//! Warp styles: ready-made bends of a box, each by one bicubic net.
//!
//! The fifteen styles that drawing programs share are data in `styles.json`. Each makes a net of sixteen points from the artwork's
//! box. The numbers were measured on the most widely used drawing program and published with the OPuller editor (AnatomikPerq,
//! 2026). Circular arcs are the usual cubics for them. In the families with bent sides, the inner points make a bilinear Coons patch,
//! by equation 7 of M. Koppinen, *A plane transformation from 16 control points*.

#[cfg(test)]
mod tests;

use super::entry::{Built, ByHand, Case, Entry, Example, Gallery, Info, Law, Role};
use super::envelope::{self, Keep, Ring};
use super::shaper::rows_path;
use crate::anchors;
use crate::error::{Error, with_area};
use crate::formula::{Calculator, FormulaError};
use crate::map::{BicubicNet, Net, complete_net};
use crate::outline::Seg;
use crate::param::{Choice as _, Kind, Settings, parameters};
use kurbo::{CubicBez, Point, Rect, Vec2};
use serde::Deserialize;
use std::sync::{Arc, OnceLock};
use thiserror::Error;

parameters! {
    /// A warp style over the artwork's box: arc, flag, fisheye, …
    ///
    /// The map is the bicubic Bézier patch of the style's net, or the envelope of its sides if lines are [kept](Self::keep).
    ///
    /// ```
    /// use pathwarp::{deform::{Style, Warp}, kurbo::{Point, Rect}, map::Map};
    ///
    /// let arch = Warp::new(Rect::new(0.0, 0.0, 100.0, 100.0), Style::named("arch").unwrap()).bend(1.0).build()?;
    /// assert!(arch.map.point(Point::new(50.0, 0.0)).distance(Point::new(50.0, -50.0)) < 1e-12);
    /// # Ok::<(), pathwarp::Error>(())
    /// ```
    #[derive(Debug, Clone, PartialEq)]
    pub struct Warp(s, style: Style) {
        /// The style: a name, or a file of your own.
        param = new("style", Kind::NameOrFile(NAMES)).default("arc");
        /// Amount and direction of the bend.
        bend: f64 = number("bend").default("50%").within(-10.0, 10.0).slider(-1.0, 1.0);
        /// The direction of the style.
        sideways: bool = either("axis", &["horizontal", "vertical"]);
        /// Distortion: the right side grows by this, the left one shrinks.
        horizontal: f64 = number("horizontal").default("0%").within(-1.0, 1.0);
        /// Distortion: the lower side grows by this, the upper one shrinks.
        vertical: f64 = number("vertical").default("0%").within(-1.0, 1.0);
        /// Lines that stay straight: the artwork is put between the style's sides by a map that keeps them, as `envelope --keep` does.
        keep: Keep = new("keep", Kind::Choice(&["nothing", "verticals", "horizontals", "lines"])).default("nothing");
        let frame: Rect = s.frame().rect;
    }
}

impl Warp {
    /// Creates a warp of the box `frame` by 50 %. Bends beyond 100 % continue by the same formula, up to the style's
    /// [limit](Style::limit).
    #[must_use]
    pub fn new(frame: Rect, style: Style) -> Self {
        Self::defaults(frame, style)
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Geometry`] for a flat box; [`Error::Usage`] for a bend or distortion out of range, a style with a wrong
    /// formula, and lines that the style cannot keep.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        let Self { frame, style, bend, .. } = self;
        if let Some(limit) = style.limit().filter(|l| bend.abs() > *l) {
            let percent = limit * 100.0;
            let problem = format!("is out of range: {} bends from -{percent}% to {percent}%", style.name);
            return Err(Error::usage("bend", bend.to_string(), problem));
        }
        let params = StyleParams { bend: *bend, distortion: [self.horizontal, self.vertical], vertical: self.sideways };
        let net = style.net(frame.width(), frame.height(), &params);
        let net = net.map_err(|e| Error::usage("style", style.name.clone(), e.to_string()))?;
        let mut built = if self.keep == Keep::Nothing { over(*frame, &net)? } else { self.keeping(&net, &params)? };
        built.note(format!(
            "style {}: bend {}%, {}{}",
            style.name,
            bend * 100.0,
            if self.sideways { "vertical" } else { "horizontal" },
            if style.title.is_empty() { String::new() } else { format!("; {}", style.title) }
        ));
        Ok(built)
    }

    /// Fits the box between the sides of the style's net and keeps lines. If that fails, the error lists the styles that can keep them.
    fn keeping(&self, net: &Net, params: &StyleParams) -> Result<Built, Error> {
        let frame = self.frame;
        let fit = |style: &Style, net: &Net| -> Result<Built, Error> {
            // A style that moves only the inside has no effect between its sides.
            let flat = style.net(frame.width(), frame.height(), &StyleParams { bend: 0.0, ..*params });
            if params.bend != 0.0 && flat.is_ok_and(|flat| same_sides(&flat, net)) {
                return Err(Error::usage("keep", self.keep.name(), "its sides do not bend, only its inside"));
            }
            let ring = sides(&net.map(|row| row.map(|p| p + frame.origin().to_vec2())));
            envelope::fit(frame, &ring, self.keep, None)
        };
        fit(&self.style, net).map_err(|e| {
            let Error::Usage { problem, .. } = e else { return e };
            let is_possible = |style: &&Style| {
                let net = style.net(frame.width(), frame.height(), params).ok();
                net.is_some_and(|n| fit(style, &n).is_ok())
            };
            let names: Vec<&str> = presets().iter().filter(is_possible).map(Style::name).collect();
            let others = match names[..] {
                [] => "no style can at this bend".into(),
                _ => format!("it can with {}", names.join(", ")),
            };
            // The envelope's advice is for drawn curves only.
            Error::usage("keep", self.keep.name(), format!("is impossible with this style ({problem}); {others}"))
        })
    }
}

/// Returns `true` if two nets have the same outermost rows and columns.
fn same_sides(a: &Net, b: &Net) -> bool {
    let is_inner = |j: usize, c: usize| (1..3).contains(&j) && (1..3).contains(&c);
    (0..16).map(|k| (k / 4, k % 4)).all(|(j, c)| is_inner(j, c) || a[j][c] == b[j][c])
}

/// Returns a net's four sides: bottom to the right, right side upwards, top to the left, left side downwards.
fn sides(net: &Net) -> Ring {
    let row = |r: usize| net[r];
    let column = |c: usize| [net[0][c], net[1][c], net[2][c], net[3][c]];
    let seg = |[a, b, c, d]: [Point; 4]| vec![Seg::Cubic(CubicBez::new(a, b, c, d))];
    let reversed = |[a, b, c, d]: [Point; 4]| [d, c, b, a];
    Ring {
        sides: [seg(row(3)), seg(reversed(column(3))), seg(reversed(row(0))), seg(column(0))],
        notes: Vec::new(),
        warnings: Vec::new(),
    }
}

/// Builds the map of one net over a box; the net's origin is the box's top left corner.
pub(super) fn over(rect: Rect, net: &Net) -> Result<Built, Error> {
    with_area(rect)?;
    let net: Net = net.map(|row| row.map(|p| p + rect.origin().to_vec2()));
    let mut built = Built::new(anchors::simplified(Arc::new(BicubicNet::over(rect, &net)), rect));
    built.overlay(Role::Base, kurbo::Shape::to_path(&rect, 0.1));
    built.overlay(Role::Cage, rows_path(&net));
    Ok(built)
}

// Warp styles as data: rules that turn a box and a bend into a net of sixteen points.
//
// A style starts from the identity net: point (j, c), in row j from the top and column c from the left, lies at u = c/3, v = j/3
// of the box, which runs from 0,0 to w,h. The rules are formulas of
//
// - `w`, `h`: the size of the box; `b`: the bend, 1 for 100 %; `a` = |b|
// - `k` = 4/3·tan(bπ/4), `S` = sin(bπ/2), `C` = cos(bπ/2): terms of a circular arc of angle bπ
// - `u`, `v`: the point's position in the box, in `moves`
//
// They are evaluated in this order: `let` (named values), `arcs` (rows that are one arc; in the family `boundary`, the left and right
// sides are straight between the ends of arcs), `points` (absolute positions), `moves` (displacements).
// The ends of an arc lie at height `y`, `half` to the left and right of the middle. Its handles are `lift`·half above the ends, and
// 2/3·half·C/cos²(bπ/4) from them towards the middle: the usual cubic for a circular arc, in a form that gives the line for b = 0.

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
    name: String,
    /// Alternative spellings of the name.
    #[serde(default)]
    also: Vec<String>,
    /// A description in a few words.
    #[serde(default)]
    title: String,
    family: Family,
    /// Largest bend, 1 for 100 %. Without it, bends are limited only by finite numbers.
    limit: Option<f64>,
    #[serde(default, rename = "let")]
    names: Vec<String>,
    #[serde(default)]
    arcs: Vec<ArcRow>,
    #[serde(default)]
    points: Vec<Rule>,
    #[serde(default)]
    moves: Vec<Rule>,
    /// Shift of every point when the axis is vertical.
    upright: Option<Shift>,
}

/// The part of a net that a distortion scales.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Family {
    /// The twelve points of the sides; a bilinear Coons patch completes the inner four, with or without distortion.
    Boundary,
    /// All sixteen points.
    Points,
    /// The points of the box, to which the style's displacements are then added, scaled by the local factors.
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

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Shift {
    x: Option<String>,
    y: Option<String>,
}

/// The parameters of a style.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::deform) struct StyleParams {
    /// The bend, 1 for 100 %.
    pub(in crate::deform) bend: f64,
    /// Horizontal and vertical distortion, 1 for 100 %.
    pub(in crate::deform) distortion: [f64; 2],
    /// `true` for the style turned sideways.
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

/// Returns the factor by which a distortion scales column (or row) `i`.
fn factor(amount: f64, i: usize) -> f64 {
    1.0 + amount * (2.0 * third(i) - 1.0)
}

fn mapped(net: &Net, mut f: impl FnMut(usize, usize, Point) -> Point) -> Net {
    std::array::from_fn(|j| std::array::from_fn(|c| f(j, c, net[j][c])))
}

/// Swaps rows with columns and x with y.
fn transposed(net: &Net) -> Net {
    std::array::from_fn(|j| std::array::from_fn(|c| Point::new(net[c][j].y, net[c][j].x)))
}

/// Scales every column about the middle of its ends.
fn with_scaled_columns(net: &Net, amount: f64) -> Net {
    mapped(net, |_, c, p| {
        let middle = net[0][c].midpoint(net[3][c]);
        middle + (p - middle) * factor(amount, c)
    })
}

/// Scales every row about the middle of its ends.
fn with_scaled_rows(net: &Net, amount: f64) -> Net {
    transposed(&with_scaled_columns(&transposed(net), amount))
}

impl Style {
    /// Returns the built-in styles.
    #[must_use]
    pub fn builtin() -> Vec<Self> {
        presets().to_vec()
    }

    /// Returns the built-in style of this name, which may be in Photoshop's spelling (`warpArc`).
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        presets().iter().find(|style| style.is_called(name)).cloned()
    }

    /// Reads a style from JSON.
    ///
    /// # Errors
    /// [`Error::Input`] when the text is not JSON of a style. Formulas are checked when the style is used.
    pub fn from_json(text: &str) -> Result<Self, Error> {
        Self::from_file("the style", text)
    }

    /// Reads a style from the text of a file.
    fn from_file(name: &str, text: &str) -> Result<Self, Error> {
        serde_json::from_str(text).map_err(|e| Error::input(name, format!("is not a warp style: {e}")))
    }

    /// Returns the style's name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns `true` for the style's name and its alternative spellings.
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
            return self.distorted(w, h, with.bend, [horizontal, vertical], true);
        }
        // The horizontal distortion always comes first; here it scales rows of the transposed net.
        let net = self.distorted(h, w, with.bend, [vertical, horizontal], false)?;
        let shift = self.shift(h, w, with.bend)?;
        Ok(transposed(&mapped(&net, |_, _, p| p + shift)))
    }

    /// Returns the net under a distortion that scales columns and rows by these amounts, columns or rows first.
    fn distorted(
        &self,
        w: f64,
        h: f64,
        b: f64,
        [columns, rows]: [f64; 2],
        columns_first: bool,
    ) -> Result<Net, StyleError> {
        let scaled = |net: &Net| match columns_first {
            true => with_scaled_rows(&with_scaled_columns(net, columns), rows),
            false => with_scaled_columns(&with_scaled_rows(net, rows), columns),
        };
        let rest: Net = std::array::from_fn(|j| std::array::from_fn(|c| Point::new(w * third(c), h * third(j))));
        let net = self.undistorted(&rest, w, h, b)?;
        Ok(match self.family {
            Family::Boundary => complete_net(scaled(&net)),
            Family::Points => scaled(&net),
            Family::Frame => {
                mapped(&scaled(&rest), |j, c, p| p + (net[j][c] - rest[j][c]) * (factor(columns, c) * factor(rows, j)))
            }
        })
    }

    /// Returns the net that the rules make of the net at rest, without distortion.
    fn undistorted(&self, rest: &Net, w: f64, h: f64, b: f64) -> Result<Net, StyleError> {
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
                // Formulas that do not use the point's position are evaluated once.
                let is_constant = !rule.x.iter().chain(&rule.y).any(|f| f.contains(['u', 'v']));
                let mut known = None;
                for (j, c) in selected(&rule.at)? {
                    names.set("u", third(c));
                    names.set("v", third(j));
                    let value = |f: &Option<String>| f.as_ref().map(|f| names.value(f)).transpose();
                    let both = || Ok::<_, FormulaError>((value(&rule.x)?, value(&rule.y)?));
                    let (x, y) = known.map_or_else(both, Ok)?;
                    known = is_constant.then_some((x, y));
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

    /// Returns the names that formulas may use, with their values.
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

    /// Returns the shift of a style with a vertical axis, before x and y are swapped.
    fn shift(&self, w: f64, h: f64, b: f64) -> Result<Vec2, FormulaError> {
        let Some(shift) = &self.upright else { return Ok(Vec2::ZERO) };
        let names = self.names(w, h, b)?;
        let value = |f: &Option<String>| f.as_ref().map_or(Ok(0.0), |f| names.value(f));
        Ok(Vec2::new(value(&shift.x)?, value(&shift.y)?))
    }
}

/// Returns the built-in styles, which are parsed once.
fn presets() -> &'static [Style] {
    static PRESETS: OnceLock<Vec<Style>> = OnceLock::new();
    // A test reads every style of this text, which is part of the crate.
    PRESETS.get_or_init(|| serde_json::from_str(include_str!("styles.json")).unwrap_or_default())
}

/// Returns the points (j, c) that `at` selects.
fn selected(at: &str) -> Result<Vec<(usize, usize)>, StyleError> {
    let wrong = || StyleError::BadPoint(at.to_owned());
    let range = |t: &str| match t.trim() {
        "*" => Ok(0..4),
        n => n.parse::<usize>().ok().filter(|n| *n < 4).map(|n| n..n + 1).ok_or_else(wrong),
    };
    let (j, c) = at.split_once(',').ok_or_else(wrong)?;
    let (rows, columns) = (range(j)?, range(c)?);
    Ok(rows.flat_map(|j| columns.clone().map(move |c| (j, c))).collect())
}

/// The built-in styles, in the order of drawing programs' menus.
const NAMES: &[&str] = &[
    "arc",
    "arc-lower",
    "arc-upper",
    "arch",
    "bulge",
    "shell-lower",
    "shell-upper",
    "flag",
    "wave",
    "fish",
    "rise",
    "fisheye",
    "inflate",
    "squeeze",
    "twist",
];

static INFO: Info = Info::new("warp", "bend artwork in one of fifteen styles: arc, flag, fisheye, …")
    .gallery(Gallery { set: "styles", title: "styles", presets: "style", bend: Some("bend"), axis: Some("axis") })
    .group("Envelopes")
    .by_hand(ByHand {
        label: Some("Style"),
        labels: &[("horizontal", "Distort horizontally"), ("vertical", "Distort vertically")],
        ..ByHand::NONE
    })
    .about("The warp styles that drawing programs share, by the nets measured on the best known of them: arc, arc-lower, arc-upper, arch, bulge, \
shell-lower, shell-upper, flag, wave, fish, rise, fisheye, inflate, squeeze, twist. --bend sets the amount and the direction; \
`pathwarp gallery` draws them all. Photoshop's names (warpArc) work too.\n\nBends beyond 100% continue by the same \
formula; those made of circular arcs end at 190%. --horizontal and --vertical distort the result in addition, as if it leaned away \
to a side.\n\nA style of your own is a TOML or JSON file: rules that move the sixteen points of a net (row,column; 0,0 is the top left \
one), with formulas of w and h (the box), b (the bend), u and v (the point's position), and k, S, C for circular arcs:\n\n  \
name = \"roof\"\n  family = \"boundary\"   # or \"points\", \"frame\": the part that distortions act on\n  \
moves = [{ at = \"0,1\", y = \"-b*h/2\" }, { at = \"0,2\", y = \"-b*h/2\" }]")
    .source("Nets measured on Adobe Illustrator 2026, published with the OPuller editor, 2026; completion: Markku Koppinen, A plane \
transformation from 16 control points, equation (7)")
    .params(Warp::PARAMS)
    .demo(&[("style", "arc"), ("bend", "40%"), ("horizontal", "15%"), ("vertical", "-20%")])
    .examples(&[
        Example { what: "A word on an arc", command: "warp samples/lettering.svg --style arc --bend 50% -o out.svg" },
        Example { what: "A logo on a flag", command: "warp samples/logo.svg --style flag --bend -30% -o out.svg" },
        Example {
            what: "A badge seen through a fisheye, leaning away to the right",
            command: "warp samples/badge.svg --style fisheye --bend 60% --horizontal -25% -o out.svg",
        },
        Example {
            what: "Lettering in a bulge whose verticals stay vertical",
            command: "warp samples/lettering.svg --style bulge --bend 40% --keep verticals -o out.svg",
        },
        Example {
            what: "A style from a file",
            command: "warp samples/lettering.svg --style samples/roof.toml --bend 80% -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("style", "arc"), ("bend", "0")]),
        Law::Identity(&[("style", "shell-upper"), ("bend", "0"), ("axis", "vertical")]),
        Law::Identity(&[("style", "twist"), ("bend", "0%")]),
        Law::Same(&[("style", "warpArcUpper")], &[("style", "arc-upper"), ("bend", "0.5")]),
        // Arch and flag move verticals up and down.
        Law::KeepsLinesAlong(&[("style", "arch"), ("bend", "-70%")], (0.0, 1.0)),
        Law::KeepsLinesAlong(&[("style", "flag"), ("bend", "150%")], (0.0, 1.0)),
        Law::Area(&[("style", "flag"), ("bend", "30%")], 1.0),
        // On a square the box itself is its transpose.
        Law::KeepsLinesAlong(&[("style", "arch"), ("axis", "vertical")], (1.0, 0.0)),
    ])
    .cases(&[
        // A half circle: its middle lies the cubic's 3/4·(2/3·diameter) above the ends.
        Case { args: &[("style", "arch"), ("bend", "100%")], at: (50.0, 0.0), to: (50.0, -50.0), tolerance: 1e-12 },
        // The wings of a full fan are level.
        Case { args: &[("style", "arc"), ("bend", "100%")], at: (0.0, 0.0), to: (-100.0, 100.0), tolerance: 1e-12 },
        Case { args: &[("style", "arc"), ("bend", "100%")], at: (50.0, 100.0), to: (50.0, 50.0), tolerance: 1e-12 },
        // 3·(1/3)(2/3)²·100 up and down again.
        Case {
            args: &[("style", "flag"), ("bend", "50%")],
            at: (100.0 / 3.0, 50.0),
            to: (100.0 / 3.0, 50.0 + 200.0 / 9.0),
            tolerance: 1e-12,
        },
        Case {
            args: &[("style", "rise"), ("bend", "50%"), ("axis", "vertical")],
            at: (50.0, 0.0),
            to: (50.0, 0.0),
            tolerance: 1e-12,
        },
    ]);

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| Warp::read(s, style(s)?)?.build());

/// Reads the style, by name or from a file.
fn style(s: &Settings<'_>) -> Result<Style, Error> {
    if let Some(file) = s.file_if("style")? {
        return Style::from_file(&file.name, &file.text);
    }
    let name = s.texts("style").last().copied().unwrap_or_default();
    Style::named(name).ok_or_else(|| {
        let known = format!("; there are {}, and files (TOML or JSON)", NAMES.join(", "));
        Error::advised("style", name, "is not a style", known)
    })
}
