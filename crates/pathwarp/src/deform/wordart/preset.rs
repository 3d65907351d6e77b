//! Text warps as data: adjust values with their limits, formulas, and guide curves.
//!
//! Formulas run over `w` and `h` (the box), `hc` = w/2, `vc` = h/2, `ss` = min(w, h), and the adjust values by their names:
//! lengths in 1/100000 of the box, angles in 1/60000 of a degree, clockwise from the right. A guide is written like path data,
//! its numbers formulas without spaces: `M x,y`, `L x,y …`, `Q x,y x,y`, `C x,y x,y x,y`, and `A cx,cy rx,ry from,sweep`, an arc of
//! an ellipse by the directions from its centre in which it begins and ends.

use crate::deform::expr::calc::Calculator;
use crate::outline::{EllipticArc, Seg};
use kurbo::{CubicBez, Line, Point, QuadBez, Vec2};
use serde::Deserialize;

/// A text warp.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Preset {
    /// Its name.
    pub(super) name: String,
    #[serde(default)]
    also: Vec<String>,
    /// What can be adjusted.
    #[serde(default)]
    pub(super) adj: Vec<Adjust>,
    #[serde(default, rename = "let")]
    names: Vec<String>,
    /// Top and bottom guides, one pair below the other.
    #[serde(default)]
    bands: Vec<[String; 2]>,
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

/// What a preset comes to over a box.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Guides {
    /// Artwork between guides: top and bottom of each band.
    Between(Vec<[Vec<Seg>; 2]>),
    /// Artwork standing on guides.
    Along(Vec<Vec<Seg>>),
}

/// All of them.
pub(super) fn all() -> Vec<Preset> {
    // The text is this crate's own; a test reads every preset.
    serde_json::from_str(include_str!("presets.json")).unwrap_or_default()
}

/// Letters and digits only, so that `textWave1`, `Wave 1` and `wave-1` are one.
fn bare(name: &str) -> String {
    let name: String = name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect();
    name.strip_prefix("text").map(str::to_owned).unwrap_or(name)
}

impl Preset {
    /// Whether this is its name, or another by which people know it.
    pub(super) fn is_called(&self, name: &str) -> bool {
        let name = bare(name);
        bare(&self.name) == name || self.also.iter().any(|a| bare(a) == name)
    }

    /// The guides over a box `w` wide and `h` high with its top left corner at the origin. `adjusted` holds a value for each of
    /// [`Preset::adj`]. Errors end a sentence about the preset.
    pub(super) fn guides(&self, w: f64, h: f64, adjusted: &[f64]) -> Result<Guides, String> {
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
        let pair = |[top, bottom]: &[String; 2]| Ok::<_, String>([guide(top, &names)?, guide(bottom, &names)?]);
        Ok(Guides::Between(self.bands.iter().map(pair).collect::<Result<_, _>>()?))
    }
}

/// Reads one guide.
fn guide(text: &str, names: &Calculator) -> Result<Vec<Seg>, String> {
    let mut out: Vec<Seg> = Vec::new();
    let mut command = ' ';
    let mut at = Point::ORIGIN;
    let mut pending: Vec<Point> = Vec::new();
    for word in text.split_whitespace() {
        if let ("M" | "L" | "Q" | "C" | "A", Some(c)) = (word, word.chars().next()) {
            command = c;
            continue;
        }
        let (x, y) = word.split_once(',').ok_or_else(|| format!("has a guide with `{word}`, which is no place x,y"))?;
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

/// An arc from one direction through an angle, both in 1/60000 of a degree.
///
/// The point of an ellipse in the direction α from its centre has the parameter atan2(rx·sin α, ry·cos α).
fn arc(center: Point, radii: Point, from: f64, sweep: f64) -> EllipticArc {
    use std::f64::consts::{PI, TAU};
    const UNIT: f64 = PI / 10_800_000.0;
    let parameter = |direction: f64| {
        let off = (radii.x * direction.sin()).atan2(radii.y * direction.cos()) - direction;
        // The parameter is never a quarter turn away from the direction.
        direction + off - TAU * (off / TAU).round()
    };
    let (first, last) = (parameter(from * UNIT), parameter((from + sweep) * UNIT));
    EllipticArc::new(center, Vec2::new(radii.x, 0.0), Vec2::new(0.0, radii.y), first, last - first)
}
