//! Warp styles as data: rules that make a net of sixteen points from a box and a bend.
//!
//! A style starts from the net that changes nothing: point (j, c), row j from the top and column c from the left, lies at
//! u = c/3, v = j/3 of the box, which here runs from 0,0 to w,h. Its rules are formulas over
//!
//! - `w`, `h`: the box; `b`: the bend, 1 for 100 %; `a` = |b|
//! - `k` = 4/3·tan(bπ/4), `S` = sin(bπ/2), `C` = cos(bπ/2): what a circle's arc of bπ is made of
//! - `u`, `v`: the point's own place, in `moves`
//!
//! worked out in this order: `let` (names for values), `arcs` (rows that are one arc; in the family `boundary` the sides run
//! straight between their ends), `points` (put somewhere), `moves` (added).
//! An arc with ends `half` to the left and right of the middle at height `y` has its handles `lift`·half above the ends, and
//! 2/3·half·C/cos²(bπ/4) from them towards the middle: the usual cubic of a circle's arc, written so that b = 0 gives the line.

use crate::deform::expr::calc::Calculator;
use crate::map::net::{self, Net};
use kurbo::{Point, Vec2};
use serde::Deserialize;

/// A style.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Style {
    /// Its name.
    pub(crate) name: String,
    /// Other spellings.
    #[serde(default)]
    pub(crate) also: Vec<String>,
    /// What it does, in a few words.
    #[serde(default)]
    pub(crate) title: String,
    /// How distortions act.
    pub(crate) family: Family,
    /// Bends must stay within this, 1 for 100 %; without it all that keep numbers finite are taken.
    limit: Option<f64>,
    #[serde(default, rename = "let")]
    names: Vec<String>,
    #[serde(default)]
    arcs: Vec<Arc>,
    #[serde(default)]
    points: Vec<Rule>,
    #[serde(default)]
    moves: Vec<Rule>,
    /// Added to every point when the axis is vertical.
    upright: Option<Shift>,
}

/// What a distortion scales.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Family {
    /// The twelve points of the sides; the inner four are completed by the bilinear Coons patch, also without distortion.
    Boundary,
    /// All sixteen points.
    Points,
    /// The box; the style's own displacements are added, scaled by the local factors.
    Frame,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Arc {
    row: usize,
    y: String,
    half: String,
    lift: String,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Rule {
    /// `j,c`; a star stands for all four.
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

/// A style set up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bent {
    /// 1 for 100 %.
    pub(crate) bend: f64,
    /// Horizontal and vertical distortion, 1 for 100 %.
    pub(crate) distortion: [f64; 2],
    /// Whether the style acts sideways.
    pub(crate) vertical: bool,
}

/// The styles that come with the program.
pub(crate) fn builtin() -> Vec<Style> {
    // The text is this crate's own; a test reads every style.
    serde_json::from_str(include_str!("styles.json")).unwrap_or_default()
}

fn third(i: usize) -> f64 {
    i as f64 / 3.0
}

fn map(net: &Net, mut f: impl FnMut(usize, usize, Point) -> Point) -> Net {
    std::array::from_fn(|j| std::array::from_fn(|c| f(j, c, net[j][c])))
}

/// Rows and columns swapped, and x and y.
fn transposed(net: &Net) -> Net {
    std::array::from_fn(|j| std::array::from_fn(|c| Point::new(net[c][j].y, net[c][j].x)))
}

/// Every column scaled about the middle of its ends by 1 + amount·(2u − 1).
fn widened(net: &Net, amount: f64) -> Net {
    map(net, |_, c, p| {
        let middle = net[0][c].midpoint(net[3][c]);
        middle + (p - middle) * (1.0 + amount * (2.0 * third(c) - 1.0))
    })
}

/// The same for rows: 1 + amount·(2v − 1).
fn heightened(net: &Net, amount: f64) -> Net {
    map(net, |j, _, p| {
        let middle = net[j][0].midpoint(net[j][3]);
        middle + (p - middle) * (1.0 + amount * (2.0 * third(j) - 1.0))
    })
}

impl Style {
    /// Whether this is its name, or another spelling of it.
    pub(crate) fn is_called(&self, name: &str) -> bool {
        self.name == name || self.also.iter().any(|a| a == name)
    }

    /// How far it can be bent, 1 for 100 %.
    pub(crate) fn limit(&self) -> Option<f64> {
        self.limit
    }

    /// The net over a box `w` wide and `h` high with its top left corner at the origin. Errors end a sentence about the style.
    pub(crate) fn net(&self, w: f64, h: f64, with: &Bent) -> Result<Net, String> {
        let [horizontal, vertical] = with.distortion;
        if !with.vertical {
            return self
                .distorted(w, h, with.bend, [horizontal, vertical], |n| heightened(&widened(n, horizontal), vertical));
        }
        // Horizontal comes first either way: sideways it is the rows that it scales.
        let net =
            self.distorted(h, w, with.bend, [vertical, horizontal], |n| widened(&heightened(n, horizontal), vertical))?;
        let shift = self.shift(h, w, with.bend)?;
        Ok(transposed(&map(&net, |_, _, p| p + shift)))
    }

    /// The net under `distortion`, which scales columns and rows by these amounts.
    fn distorted(
        &self,
        w: f64,
        h: f64,
        b: f64,
        [columns, rows]: [f64; 2],
        distortion: impl Fn(&Net) -> Net,
    ) -> Result<Net, String> {
        let rest: Net = std::array::from_fn(|j| std::array::from_fn(|c| Point::new(w * third(c), h * third(j))));
        let net = self.plain(&rest, w, h, b)?;
        let factor = |amount: f64, i: usize| 1.0 + amount * (2.0 * third(i) - 1.0);
        Ok(match self.family {
            Family::Boundary => net::complete(distortion(&net)),
            Family::Points => distortion(&net),
            Family::Frame => {
                map(&distortion(&rest), |j, c, p| p + (net[j][c] - rest[j][c]) * (factor(columns, c) * factor(rows, j)))
            }
        })
    }

    /// The style's own rules.
    fn plain(&self, rest: &Net, w: f64, h: f64, b: f64) -> Result<Net, String> {
        let mut names = self.names(w, h, b)?;
        let mut net = *rest;
        for arc in &self.arcs {
            let [y, half, lift] = [&arc.y, &arc.half, &arc.lift].map(|f| names.value(f));
            let (y, half, lift) = (y?, half?, lift?);
            let quarter = b * std::f64::consts::FRAC_PI_4;
            let along = 2.0 / 3.0 * half * (2.0 * quarter).cos() / quarter.cos().powi(2);
            let row = net.get_mut(arc.row).ok_or_else(|| format!("has no row {}: rows go from 0 to 3", arc.row))?;
            let (left, right, up) = (0.5 * w - half, 0.5 * w + half, y - lift * half);
            *row = [
                Point::new(left, y),
                Point::new(left + along, up),
                Point::new(right - along, up),
                Point::new(right, y),
            ];
        }
        if self.family == Family::Boundary {
            // The upright sides run straight between the ends of the arcs.
            for c in [0, 3] {
                (net[1][c], net[2][c]) = (net[0][c].lerp(net[3][c], third(1)), net[0][c].lerp(net[3][c], third(2)));
            }
        }
        for (rules, put) in [(&self.points, true), (&self.moves, false)] {
            for rule in rules {
                for (j, c) in places(&rule.at)? {
                    names.set("u", third(c));
                    names.set("v", third(j));
                    let of = |f: &Option<String>| f.as_ref().map(|f| names.value(f)).transpose();
                    let (x, y) = (of(&rule.x)?, of(&rule.y)?);
                    let p = &mut net[j][c];
                    *p = if put {
                        Point::new(x.unwrap_or(p.x), y.unwrap_or(p.y))
                    } else {
                        *p + Vec2::new(x.unwrap_or(0.0), y.unwrap_or(0.0))
                    };
                }
            }
        }
        Ok(net)
    }

    fn names(&self, w: f64, h: f64, b: f64) -> Result<Calculator, String> {
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

    fn shift(&self, w: f64, h: f64, b: f64) -> Result<Vec2, String> {
        let Some(shift) = &self.upright else { return Ok(Vec2::ZERO) };
        let names = self.names(w, h, b)?;
        let of = |f: &Option<String>| f.as_ref().map_or(Ok(0.0), |f| names.value(f));
        Ok(Vec2::new(of(&shift.x)?, of(&shift.y)?))
    }
}

/// The points that `j,c` means.
fn places(at: &str) -> Result<Vec<(usize, usize)>, String> {
    let wrong = || format!("names the point `{at}`: row,column from 0 to 3 each, or * for all");
    let one = |t: &str| match t.trim() {
        "*" => Ok(0..4),
        n => n.parse::<usize>().ok().filter(|n| *n < 4).map(|n| n..n + 1).ok_or_else(wrong),
    };
    let (j, c) = at.split_once(',').ok_or_else(wrong)?;
    let (rows, columns) = (one(j)?, one(c)?);
    Ok(rows.flat_map(|j| columns.clone().map(move |c| (j, c))).collect())
}
