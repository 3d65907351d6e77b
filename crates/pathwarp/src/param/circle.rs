//! Circles, arcs and spirals as path references: `circle:r=60mm`, `arc:r=60mm,from=180,to=360`, `spiral:turns=3,inner=20mm,outer=80mm`.
//!
//! The lengths `cx` and `cy` give the centre, which is the frame's by default. Their percentages count from the left and top of the
//! frame; percentages of radii refer to its width; `%page` refers to the page instead. Angles are clockwise on the screen from the
//! right (three o'clock). An arc runs from `from` to `to`, clockwise if `to` is larger. Circles and arcs are true arcs.
//!
//! A spiral is Archimedean, r = inner + (outer − inner)·φ/(360°·turns). It begins at the inner radius, at the angle `from`, by
//! default 180°, and runs outwards, clockwise (`cw`) or counter-clockwise (`ccw`). Its cubics are within [`SPIRAL_WITHIN`]·outer
//! of the exact curve.

use super::value::{self, ValueError};
use super::{Axis, Frame};
use crate::outline::{EllipticArc, Outline, Seg, Subpath};
use kurbo::{BezPath, CurveFitSample, ParamCurveFit, Point, Rect, Vec2};
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// Distance of a spiral's cubics from the true curve, relative to its outer radius.
const SPIRAL_WITHIN: f64 = 1e-7;
/// Limit on the turns of a spiral. The work grows with them, and letters on more turns would be illegible.
const MAX_TURNS: f64 = 100.0;
/// The default angle at which a spiral begins, so that lettering runs from the left over the top.
const LEFT: f64 = 180.0;

/// Returns `true` if a path reference is a circle, an arc or a spiral.
pub(super) fn is_circle(text: &str) -> bool {
    split(text).is_some()
}

/// Returns `true` if a path reference is a spiral, whose direction is part of the reference.
pub(crate) fn is_spiral(text: &str) -> bool {
    split(text).is_some_and(|(word, _)| word == "spiral")
}

/// Returns the word before the colon, and the values after it.
fn split(text: &str) -> Option<(&str, &str)> {
    // Without a colon, `circle` is the shape of that name.
    let split = text.trim().split_once(':').or_else(|| Some((text.trim(), "")).filter(|(word, _)| *word != "circle"));
    split.filter(|(word, _)| matches!(*word, "circle" | "arc" | "spiral"))
}

/// Returns an example of a reference that begins with this word.
fn example(word: &str) -> &'static str {
    match word {
        "arc" => "arc:r=60mm,from=180,to=360",
        "spiral" => "spiral:turns=3,inner=20mm,outer=80mm",
        _ => "circle:r=60mm",
    }
}

/// Reads a circle, an arc or a spiral; `None` for other texts. The error continues a sentence about the text.
pub(super) fn circle(text: &str, frame: &Frame) -> Option<Result<Outline, String>> {
    let (word, values) = split(text)?;
    Some(Values::new(word, values, frame).and_then(|t| if word == "spiral" { t.spiral() } else { t.arc() }))
}

/// The values of a reference, as typed.
struct Values<'a> {
    word: &'a str,
    given: Vec<(&'a str, &'a str)>,
    frame: &'a Frame,
}

impl<'a> Values<'a> {
    fn new(word: &'a str, values: &'a str, frame: &'a Frame) -> Result<Self, String> {
        /// The name under which the direction of a spiral is stored.
        const DIRECTION: &str = "direction";
        let names: &[&str] = match word {
            "arc" => &["r", "from", "to", "cx", "cy"],
            "spiral" => &["turns", "inner", "outer", "from", "cx", "cy"],
            _ => &["r", "cx", "cy"],
        };
        let mut given: Vec<(&str, &str)> = Vec::new();
        for part in values.split(',').map(str::trim).filter(|p| !p.is_empty()) {
            let (name, value) = match part.split_once('=').map(|(n, v)| (n.trim(), v.trim())) {
                Some(pair) => pair,
                None if word == "spiral" && matches!(part, "cw" | "ccw") => (DIRECTION, part),
                None => {
                    let or = if word == "spiral" { ", cw or ccw" } else { "" };
                    return Err(format!("contains `{part}`, which is not NAME=VALUE{or}: write {}", example(word)));
                }
            };
            if !names.contains(&name) && (name != DIRECTION || part.contains('=')) {
                return Err(format!("has a value for `{name}`; {word} takes {}", names.join(", ")));
            }
            if given.iter().any(|(n, _)| *n == name) {
                return Err(format!("has two values for {name}"));
            }
            given.push((name, value));
        }
        Ok(Self { word, given, frame })
    }

    /// Returns a value as typed.
    fn text(&self, name: &str) -> Option<&'a str> {
        self.given.iter().find(|(n, _)| *n == name).map(|(_, v)| *v)
    }

    /// Reads a value that must be given.
    fn needed(&self, name: &str, read: impl Fn(&str) -> Result<f64, ValueError>) -> Result<f64, String> {
        let text = self.text(name).ok_or_else(|| format!("has no {name}: write {}", example(self.word)))?;
        read(text).map_err(|e| format!("has a wrong {name}: `{text}` {e}"))
    }

    fn radius(&self, name: &str) -> Result<f64, String> {
        self.length(name, Axis::X).map(|(length, _)| length)
    }

    /// Reads a length; for a percentage, also returns the box to which it refers.
    fn length(&self, name: &str, axis: Axis) -> Result<(f64, Option<Rect>), String> {
        let of_page = self.text(name).and_then(|t| t.strip_suffix("page")).filter(|t| t.ends_with('%'));
        let of_frame = self.text(name).is_some_and(|t| t.ends_with('%')).then_some(self.frame.rect);
        let Some(share) = of_page else {
            return Ok((self.needed(name, |t| value::length(t, axis, self.frame))?, of_frame));
        };
        let page = self
            .frame
            .page
            .ok_or_else(|| format!("refers to the page ({name}), and there is none; give a length instead"))?;
        Ok((self.needed(name, |_| value::length(share, axis, &Frame::new(page)))?, Some(page)))
    }

    fn centre(&self) -> Result<Point, String> {
        // Percentages count from the box to which they refer, lengths from the drawing's origin.
        let coordinate = |name: &str, axis, start: fn(Rect) -> f64, middle: f64| match self.text(name) {
            None => Ok(middle),
            Some(_) => self.length(name, axis).map(|(d, reference)| reference.map_or(0.0, start) + d),
        };
        let middle = self.frame.rect.center();
        Ok(Point::new(coordinate("cx", Axis::X, |r| r.x0, middle.x)?, coordinate("cy", Axis::Y, |r| r.y0, middle.y)?))
    }

    fn arc(&self) -> Result<Outline, String> {
        let (is_circle, radius) = (self.word == "circle", self.radius("r")?);
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(format!("has the radius {radius}; it must be larger than 0"));
        }
        let centre = self.centre()?;
        let angle = |name| self.needed(name, value::angle);
        let (from, to) = if is_circle { (0.0, 360.0) } else { (angle("from")?, angle("to")?) };
        let sweep = to - from;
        if !(sweep.abs() > 0.0 && sweep.abs() <= 360.0) {
            return Err(format!("runs through {sweep}°; from and to must differ by at most 360°"));
        }
        let (u, v) = (Vec2::new(radius, 0.0), Vec2::new(0.0, radius));
        let seg = Seg::Arc(EllipticArc::new(centre, u, v, from * PI / 180.0, sweep * PI / 180.0));
        let start = centre + Vec2::from_angle(from.to_radians()) * radius;
        Ok(Outline { subpaths: vec![Subpath { start, segs: vec![seg], closed: is_circle }] })
    }

    fn spiral(&self) -> Result<Outline, String> {
        let turns = self.needed("turns", value::number)?;
        if !(turns > 0.0 && turns <= MAX_TURNS) {
            return Err(format!("has {turns} turns; it takes more than 0 and at most {MAX_TURNS}"));
        }
        let (inner, outer) = (self.radius("inner")?, self.radius("outer")?);
        if !(inner >= 0.0 && outer > inner && outer.is_finite()) {
            return Err(format!("runs from the radius {inner} to {outer}; inner must be at least 0, and outer larger"));
        }
        let from = self.text("from").map_or(Ok(LEFT), |_| self.needed("from", value::angle))?;
        let sweep = if self.text("direction") == Some("ccw") { -turns * TAU } else { turns * TAU };
        let spiral = Spiral { centre: self.centre()?, inner, growth: outer - inner, from: from.to_radians(), sweep };
        let mut path = BezPath::new();
        // A fit of a whole turn or more would fail.
        let parts = (PARTS_PER_TURN * turns).ceil() as u32;
        for i in 0..parts {
            let [from, to] = [i, i + 1].map(|i| f64::from(i) / f64::from(parts));
            let part = kurbo::fit_to_bezpath(&spiral.part(from..to), SPIRAL_WITHIN * outer);
            path.extend(part.elements().iter().skip(usize::from(i > 0)).copied());
        }
        Ok(Outline::from(&path))
    }
}

/// Number of parts of a turn, which are fitted separately.
const PARTS_PER_TURN: f64 = 4.0;

/// An Archimedean spiral, at constant angular speed from t = 0 to 1.
struct Spiral {
    centre: Point,
    inner: f64,
    growth: f64,
    /// Radians, clockwise on the screen.
    from: f64,
    sweep: f64,
}

impl Spiral {
    fn part(&self, t: Range<f64>) -> Self {
        let (inner, width) = (self.inner + self.growth * t.start, t.end - t.start);
        let (growth, sweep) = (self.growth * width, self.sweep * width);
        Self { centre: self.centre, inner, growth, from: self.from + self.sweep * t.start, sweep }
    }
}

impl ParamCurveFit for Spiral {
    fn sample_pt_tangent(&self, t: f64, _: f64) -> CurveFitSample {
        let (p, tangent) = self.sample_pt_deriv(t);
        CurveFitSample { p, tangent }
    }

    fn sample_pt_deriv(&self, t: f64) -> (Point, Vec2) {
        let (r, out) = (self.inner + self.growth * t, Vec2::from_angle(self.from + self.sweep * t));
        (self.centre + out * r, out * self.growth + Vec2::new(-out.y, out.x) * (r * self.sweep))
    }

    fn break_cusp(&self, _: Range<f64>) -> Option<f64> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Outline, String> {
        let frame = Frame::new(Rect::new(100.0, 0.0, 300.0, 50.0)).with_units_per_px([2.0; 2]);
        circle(text, &frame).unwrap()
    }

    #[test]
    fn circles_and_arcs_have_their_measures() {
        let inch = read("circle:r=1in").unwrap();
        let b = inch.bounding_box().unwrap();
        // An inch is 96 px, and a px is two units.
        assert!((b.width() - 384.0).abs() < 1e-9 && b.center().distance(Point::new(200.0, 25.0)) < 1e-9, "{b:?}");
        assert!(inch.subpaths[0].closed && matches!(inch.subpaths[0].segs[..], [Seg::Arc(_)]));
        let arc = read("arc: r=10%, from=180, to=1.5PI, cx=25%, cy=7");
        assert!(arc.is_err());
        let arc = read("arc:r=10%,from=180,to=0.75turn,cx=25%,cy=7").unwrap();
        let (a, b) = (arc.subpaths[0].start, arc.subpaths[0].end());
        assert!(
            a.distance(Point::new(130.0, 7.0)) < 1e-9 && b.distance(Point::new(150.0, -13.0)) < 1e-9,
            "{a:?} {b:?}"
        );
        assert!(circle("circles.svg#a", &Frame::new(Rect::ZERO)).is_none() && !is_circle("M0,0"));
    }

    #[test]
    fn percentages_may_be_those_of_the_page() {
        let frame = Frame::new(Rect::new(100.0, 0.0, 300.0, 50.0)).with_page(Rect::new(-20.0, 10.0, 380.0, 210.0));
        let b = circle("circle:r=5%page,cx=50%page,cy=25%page", &frame).unwrap().unwrap().bounding_box().unwrap();
        assert!(b.center().distance(Point::new(180.0, 60.0)) < 1e-9 && (b.width() - 40.0).abs() < 1e-9, "{b:?}");
        assert!(read("circle:r=5%page").unwrap_err().contains("page"));
        assert!(circle("circle:r=5page", &frame).unwrap().is_err());
    }

    #[test]
    fn spirals_follow_their_formula() {
        for (text, from, sign) in [
            ("spiral:turns=3,inner=20,outer=80,cx=7,cy=9", 180.0, 1.0),
            ("spiral:turns=2.3,inner=0,outer=80,from=-0.25turn,ccw,cx=7,cy=9", -90.0, -1.0),
            ("spiral:turns=0.2,inner=79,outer=80,from=30,cw,cx=7,cy=9", 30.0, 1.0),
        ] {
            let spiral = read(text).unwrap();
            let number = |name: &str| {
                let value = text.split([',', ':']).find_map(|p| p.strip_prefix(name));
                value.unwrap().parse::<f64>().unwrap()
            };
            let (turns, inner, outer) = (number("turns="), number("inner="), number("outer="));
            let at = |share: f64| {
                let angle = (from + sign * 360.0 * turns * share).to_radians();
                Point::new(7.0, 9.0) + Vec2::from_angle(angle) * (inner + (outer - inner) * share)
            };
            let sub = &spiral.subpaths[0];
            assert!(!sub.closed && sub.start.distance(at(0.0)) < 1e-9 && sub.end().distance(at(1.0)) < 1e-9);
            let mut last = 0.0;
            let mut worst: f64 = 0.0;
            for p in sub.segs.iter().flat_map(|s| (0..40).map(|i| s.eval(f64::from(i) / 40.0))) {
                // The nearest point of the exact spiral, sought from the last one on.
                let near = (0..200)
                    .map(|i| last + f64::from(i) * 1e-4)
                    .min_by(|a, b| at(*a).distance(p).total_cmp(&at(*b).distance(p)));
                let (mut a, mut b) = (near.unwrap() - 1e-4, near.unwrap() + 1e-4);
                for _ in 0..80 {
                    let (c, d) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
                    if at(c).distance(p) < at(d).distance(p) { b = d } else { a = c }
                }
                worst = worst.max(at(a).distance(p));
                last = a.max(0.0);
            }
            assert!(worst < 1.1 * SPIRAL_WITHIN * outer && last > 0.9, "{text}: {worst} {last}");
        }
    }

    #[test]
    fn errors_name_the_value() {
        for (text, part) in [
            ("circle:", "no r"),
            ("circle:r=-3", "larger than 0"),
            ("circle:r=3,from=4", "circle takes r, cx, cy"),
            ("circle:60mm", "`60mm`"),
            ("circle:r=wide", "wrong r: `wide`"),
            ("arc:r=3,from=0", "no to"),
            ("arc:r=3,from=0,to=400", "at most 360"),
            ("arc:r=3,r=4", "two values for r"),
            ("spiral:turns=3,inner=2", "no outer: write spiral:turns=3"),
            ("spiral:turns=3,inner=2,outer=1", "from the radius 2 to 1"),
            ("spiral:turns=1e9,inner=2,outer=3", "at most 100"),
            ("spiral:turns=0,inner=2,outer=3", "more than 0"),
            ("spiral:turns=3,inner=2,outer=3,left", "`left`, which is not NAME=VALUE, cw or ccw"),
            ("spiral:turns=3,inner=2,outer=3,cw,ccw", "two values for direction"),
            ("spiral:turns=3,inner=2,outer=3,direction=cw", "takes turns, inner"),
            ("spiral:turns=3,inner=2,outer=3,r=1", "takes turns, inner"),
        ] {
            let message = read(text).unwrap_err();
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
