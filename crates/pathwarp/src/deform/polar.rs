//! Polar coordinates: a rectangle is bent into a sector of a ring, or into the whole ring.
//!
//! In the formulas of [`Polar`], x is measured from the artwork's middle, and g = 1 unless both radii are given. The conformal radius is
//! that of the complex exponential: heights grow with it. With ρ = 1/κ the inner edge keeps its length. A negative sweep (a smile) makes r
//! and κ negative; the top edge is then the inner one. The image is F = C + r·(sin φ, −cos φ). It is computed from the image O of the
//! artwork's middle, at height yₘ, as F = O + (r·sin φ, r(yₘ) − r + 2r·sin²(φ/2)), which loses no digits where the sweep is small and the
//! centre C far away. The inverse takes r from the distance to C and φ from the direction. At the ray opposite the middle, a whole turn
//! meets itself: artwork that crosses the ray is cut there and joined by a straight line, and the recipe warns of it.

use super::entry::{Built, ByHand, Case, Entry, Example, Info, Law, Pairs, Seam};
use crate::error::{Error, show};
use crate::map::{AffineMap, Crease, Creases, Formula, Level, Map, Real};
use crate::param::{Axis, Kind, parameters, word_space};
use kurbo::{Point, Rect, Vec2};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

parameters! {
    /// Polar coordinates: a box bent into a sector of a ring, or into the whole ring.
    ///
    /// Verticals become rays and horizontals become arcs about one centre: the angle from the vertical is φ = κ·x with κ =
    /// sweep/width, and the radius r = ρ + g·y, or ρ·exp(κ·y) if conformal, with y counted upwards from the inner edge and g the gain of
    /// radius per height.
    ///
    /// ```
    /// use pathwarp::{deform::Polar, kurbo::{Point, Rect}, map::Map};
    ///
    /// let ring = Polar::new(Rect::new(0.0, 0.0, 100.0, 100.0)).sweep(360.0).inner(10.0).outer(60.0).center((0.0, 0.0)).build()?;
    /// assert!(ring.map.point(Point::new(75.0, 0.0)).distance(Point::new(60.0, 0.0)) < 1e-12);
    /// # Ok::<(), pathwarp::Error>(())
    /// ```
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Polar(s) {
        /// The angle that the artwork's width is bent into; negative bends downwards.
        sweep: f64 = angle("sweep").default("60").within(-360.0, 360.0);
        /// Radius of the inner edge. Default: so that it keeps its length.
        inner: Option<f64> = length("inner", Axis::X).within(0.0, 1e9).slider(0.0, 500.0);
        /// Radius of the outer edge. Default: so that heights are kept.
        outer: Option<f64> = length("outer", Axis::X).within(0.0, 1e9).slider(0.0, 500.0);
        /// Turn the result, clockwise on the screen.
        turn: f64 = angle("turn").default("0");
        /// Centre of the ring. Default: so that the middle of the artwork stays.
        center: Option<Point> = new("center", Kind::Point);
        /// Space between the ends of a whole turn, user units or % of the width. Default: a word space for lettering, none for other artwork.
        gap: Option<f64> = length("gap", Axis::X).within(0.0, 1e9).slider(0.0, 100.0);
        /// Spacing of the radii: even, or conformal (angles are kept).
        conformal: bool = either("spacing", &["even", "conformal"]);
        let frame: Rect = s.frame().rect;
        let word_space: Option<f64> = word_space(&s.frame().letters);
    }
}

impl Polar {
    /// Creates an arch of 60° whose inner edge keeps its length and whose middle stays in place.
    #[must_use]
    pub fn new(frame: Rect) -> Self {
        Self::defaults(frame)
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Usage`] for radii that leave no ring, values that contradict each other, or artwork without width.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        let Self { frame: rect, inner, outer, conformal, .. } = *self;
        let is_whole = self.sweep.abs() > 360.0 * (1.0 - WHOLE);
        let gap = self.gap.or(self.word_space).unwrap_or(0.0);
        // The part of the sweep that the gap leaves to the artwork.
        let used = if is_whole && gap > 0.0 { rect.width() / (rect.width() + gap) } else { 1.0 };
        let sweep = self.sweep.to_radians() * used;
        let degrees = sweep.to_degrees().to_string();
        if sweep == 0.0 {
            if inner.or(outer).is_some() || self.center.is_some() {
                return Err(Error::usage("sweep", degrees, "bends nothing, so there is no radius and no centre"));
            }
            return Ok(Built::new(Arc::new(AffineMap::IDENTITY)));
        }
        let (width, height) = (rect.width(), rect.height());
        if width <= 0.0 {
            return Err(Error::usage("sweep", degrees, "cannot bend artwork that has no width"));
        }
        let (near, far) = self.radii(sweep)?;
        let up = sweep.signum();
        let mut map = PolarMap {
            conformal,
            up,
            sweep: sweep.abs(),
            k: sweep / width,
            radius: up * near,
            gain: if height > 0.0 && !conformal { (far - near) / height } else { 1.0 },
            edge: if up > 0.0 { rect.y1 } else { rect.y0 },
            middle: rect.center(),
            to: rect.center(),
            turn: Vec2::from_angle(self.turn.to_radians()),
        };
        if let Some(center) = self.center {
            // The centre lies r(yₘ) below the image of the middle, before the turn.
            map.to = center + map.turned(Vec2::new(0.0, -map.radius_at(map.middle.y)));
        }
        let mut built = Built::new(Arc::new(map));
        if map.is_whole() {
            let c = map.centre();
            built.seam = Some(Seam { end: c, through: c + map.turned(Vec2::new(0.0, up)) });
        }
        if used < 1.0 {
            built.note(format!("a gap of {gap:.6} between the ends leaves a sweep of {:.6}°", sweep.to_degrees()));
        }
        built.note(format!("centre {}, radii {near:.6} and {far:.6}", show(map.centre())));
        Ok(built)
    }

    /// Returns the radii of the inner and outer edge.
    fn radii(&self, sweep: f64) -> Result<(f64, f64), Error> {
        let Self { frame, inner, outer, conformal, .. } = *self;
        let (width, height) = (frame.width(), frame.height());
        if conformal && outer.is_some() {
            return Err(Error::usage(
                "outer",
                "",
                "follows from `inner` and `sweep` with `spacing conformal`; omit it",
            ));
        }
        let (near, far) = match (inner, outer) {
            (None, None) => (width / sweep.abs(), width / sweep.abs() + height),
            (Some(i), None) => (i, i + height),
            (None, Some(o)) => (o - height, o),
            (Some(i), Some(o)) => (i, o),
        };
        if near < 0.0 || (far <= near && height > 0.0) || (conformal && near == 0.0) {
            let name = if outer.is_some() { "outer" } else { "inner" };
            let problem = format!("leaves no ring: the inner radius would be {near:.6}, the outer one {far:.6}");
            return Err(Error::usage(name, "", problem));
        }
        Ok((near, far))
    }
}

static INFO: Info = Info::new("polar", "bend artwork into an arch or a whole ring")
    .group("Bends")
    .by_hand(ByHand {
        label: Some("Ring"),
        ..ByHand::NONE
    })
    .with_letters()
    .about("Verticals become rays, horizontals become arcs about one centre. The inner edge keeps its length, the outer one is stretched; \
--inner and --outer set the radii instead. A negative sweep bends downwards (a smile). The middle of the artwork stays where it is, \
unless --center gives the centre. With --spacing conformal, squares stay squares: heights grow with the width.")
    .source("elementary (polar coordinates; the complex exponential)")
    .params(Polar::PARAMS)
    .demo(&[("turn", "15")])
    .examples(&[
        Example { what: "An arch", command: "polar samples/lettering.svg -o out.svg" },
        Example {
            what: "A whole ring about the middle",
            command: "polar samples/grid.svg --sweep 360 --inner 15% --outer 50% --center 50%,50% -o out.svg",
        },
        Example { what: "A smile", command: "polar samples/logo.svg --sweep -90 -o out.svg" },
    ])
    .laws(&[
        Law::Identity(&[("sweep", "0")]),
        Law::KeepsAngles(&[("spacing", "conformal"), ("sweep", "200")]),
        Law::KeepsAngles(&[("spacing", "conformal"), ("sweep", "-77"), ("turn", "10")]),
        Law::Same(&[("sweep", "-360"), ("inner", "10"), ("outer", "60")], SMILE),
    ])
    .cases(&[
        // A ring about 0,0: bottom middle at the top of the inner circle, the top's right end at the bottom of the outer one.
        Case { args: RING, at: (50.0, 100.0), to: (0.0, -10.0), tolerance: 1e-12 },
        Case { args: RING, at: (75.0, 0.0), to: (60.0, 0.0), tolerance: 1e-12 },
        Case { args: RING, at: (100.0, 0.0), to: (0.0, 60.0), tolerance: 1e-12 },
        Case { args: RING, at: (25.0, 50.0), to: (-35.0, 0.0), tolerance: 1e-12 },
        // Half a turn: the bottom's length 100 is π·ρ.
        Case {
            args: &[("sweep", "180"), ("center", "0,0")],
            at: (100.0, 100.0),
            to: (100.0 / PI, 0.0),
            tolerance: 1e-12,
        },
        Case { args: &[("sweep", "180")], at: (50.0, 50.0), to: (50.0, 50.0), tolerance: 1e-12 },
        // A smile: the top is the inner edge and the middle of the bottom lies straight below the centre.
        Case { args: SMILE_AT_0, at: (50.0, 100.0), to: (0.0, 60.0), tolerance: 1e-12 },
        Case { args: SMILE_AT_0, at: (100.0, 0.0), to: (10.0, 0.0), tolerance: 1e-12 },
    ]);

const RING: Pairs = &[("sweep", "360"), ("inner", "10"), ("outer", "60"), ("center", "0,0")];
const SMILE: Pairs = &[("sweep", "-360"), ("outer", "60"), ("inner", "10"), ("center", "50,15")];
const SMILE_AT_0: Pairs = &[("sweep", "-180"), ("outer", "60"), ("inner", "10"), ("center", "0,0")];

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| Polar::read(s)?.build());

/// A sweep that falls short of a whole turn by less than this fraction counts as one.
const WHOLE: f64 = 1e-9;

/// The ring as a map.
#[derive(Debug, Clone, Copy)]
struct PolarMap {
    conformal: bool,
    /// +1 for an arch, −1 for a smile.
    up: f64,
    /// The absolute value of the sweep, in radians.
    sweep: f64,
    /// κ, in radians per unit of x.
    k: f64,
    /// ρ, negative for a smile.
    radius: f64,
    /// g, the gain of radius per unit of height.
    gain: f64,
    /// The y of the inner edge.
    edge: f64,
    /// The artwork's middle, and its image O.
    middle: Point,
    to: Point,
    /// The image of the x direction under the additional turn, a unit vector.
    turn: Vec2,
}

impl PolarMap {
    /// Applies the additional turn to a vector.
    fn turned(&self, v: Vec2) -> Vec2 {
        Vec2::new(v.x * self.turn.x - v.y * self.turn.y, v.x * self.turn.y + v.y * self.turn.x)
    }

    /// Returns r at the ordinate `y` of the artwork.
    fn radius_at<S: Real>(&self, y: S) -> S {
        let h = -(y - self.edge);
        if self.conformal { (h * self.k).exp() * self.radius } else { h * self.gain + self.radius }
    }

    /// Returns `true` for a whole turn, up to rounding.
    fn is_whole(&self) -> bool {
        self.sweep > TAU * (1.0 - WHOLE)
    }

    fn centre(&self) -> Point {
        self.to + self.turned(Vec2::new(0.0, self.radius_at(self.middle.y)))
    }
}

impl Formula for PolarMap {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let r = self.radius_at(y);
        let angle = (x - self.middle.x) * self.k;
        let down = if self.conformal { -r + self.radius_at(self.middle.y) } else { (y - self.middle.y) * self.gain };
        let (a, sin_half) = (r * angle.sin(), (angle * 0.5).sin());
        let b = down + r * sin_half * sin_half * 2.0;
        let t = self.turn;
        (a * t.x - b * t.y + self.to.x, a * t.y + b * t.x + self.to.y)
    }

    /// Adds the horizontal that becomes the centre.
    fn creases(&self, out: &mut Creases) {
        if !self.conformal {
            let c = self.up * (self.radius + self.gain * self.edge);
            out.push(Crease::edge(Level::Line { a: 0.0, b: -self.up * self.gain, c }));
        }
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(PolarInverse { ring: *self, half: None }))
    }
}

/// The inverse: the ring unrolled.
#[derive(Debug, Clone, Copy)]
struct PolarInverse {
    ring: PolarMap,
    /// The sign of the angles in this half, edges included, for a branch of a whole turn.
    half: Option<f64>,
}

impl PolarInverse {
    /// Returns the distance from the centre and the angle from the middle.
    fn polar<S: Real>(&self, x: S, y: S) -> (S, S) {
        let m = &self.ring;
        let (c, t) = (m.centre(), m.turn);
        let (u, v) = (x - c.x, y - c.y);
        let (a, b) = (u * t.x + v * t.y, v * t.x - u * t.y);
        let angle = (a * m.up).atan2(b * -m.up);
        // On the ray itself, rounding picks either end of the turn.
        let angle = match self.half {
            Some(sign) if angle.value() * sign < -FRAC_PI_2 => angle + sign * TAU,
            _ => angle,
        };
        (a.hypot(b), angle)
    }
}

impl Formula for PolarInverse {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let m = &self.ring;
        let (r, angle) = self.polar(x, y);
        let r = r * m.up;
        let h = if m.conformal { (r / m.radius).ln() / m.k } else { (r - m.radius) / m.gain };
        (angle / m.k + m.middle.x, -h + m.edge)
    }

    /// The inverse ends at the ray opposite the middle: each end of the ring extends over half of the angle that the sweep leaves
    /// free. A whole turn leaves none, so that the value jumps there; a line through the centre divides it into halves with definite ends.
    fn creases(&self, out: &mut Creases) {
        let inverse = *self;
        if self.ring.is_whole() {
            let (c, t) = (self.ring.centre().to_vec2(), self.ring.turn);
            out.push(Crease::kink(Level::Line { a: t.x, b: t.y, c: -c.dot(t) }));
            return;
        }
        let limit = 0.5 * (0.5 * self.ring.sweep + PI) * (1.0 - 1e-9);
        out.push(Crease::edge(Level::Field(Arc::new(move |p: Point| limit - inverse.polar(p.x, p.y).1.abs()))));
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let half = self.polar(inside.x, inside.y).1.signum();
        self.ring.is_whole().then(|| Arc::new(Self { half: Some(half), ..*self }) as Arc<dyn Map>)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.ring))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::Deformation as _;
    use crate::deform::Registry;
    use crate::param::{Args, Frame};
    use crate::recipe::{Recipe, Step};
    use crate::{Outline, check, refit};
    use kurbo::ParamCurveNearest as _;

    #[test]
    fn is_sound() {
        let faults = check::entry(&ENTRY);
        assert!(faults.is_empty(), "{faults:#?}");
    }

    fn build(pairs: &[(&str, &str)]) -> Result<Built, Error> {
        ENTRY.build_from(&Args::from_pairs(pairs), &check::frame())
    }

    #[test]
    fn a_small_sweep_tends_to_the_identity_without_losing_digits() {
        for (sweep, spacing) in [("1e-9", "even"), ("-1e-9", "even"), ("1e-5", "conformal")] {
            let m = build(&[("sweep", sweep), ("spacing", spacing)]).unwrap().map;
            for p in [(0.0, 0.0), (100.0, 30.0), (20.0, 100.0)] {
                let p = Point::from(p);
                assert!(m.point(p).distance(p) < 1e-5, "{sweep} {spacing} {p:?} {:?}", m.point(p));
            }
        }
    }

    #[test]
    fn inverses_return_in_every_kind() {
        for pairs in [
            &[("sweep", "-200"), ("turn", "77")][..],
            &[("spacing", "conformal"), ("sweep", "300")],
            &[("sweep", "359"), ("inner", "20"), ("outer", "25"), ("center", "7,8")],
        ] {
            let m = build(pairs).unwrap().map;
            let back = m.inverse().unwrap();
            let mut creases = Creases::default();
            back.creases(&mut creases);
            for p in [(0.5, 1.0), (99.5, 99.0), (30.0, 60.0)] {
                let q = m.point(p.into());
                assert!(creases.defined_at(q) && back.point(q).distance(p.into()) < 1e-9, "{pairs:?} {p:?}");
            }
        }
    }

    /// Unrolls two squares from a ring about 0,0: one lies across the ray opposite the middle, the other does not.
    #[test]
    fn a_whole_turn_is_cut_where_it_meets_itself_and_warns() {
        let pairs = [("sweep", "360"), ("inner", "20"), ("outer", "90"), ("center", "0,0"), ("turn", "-10")];
        let step = Step { inverse: true, ..Step::new("polar", Args::from_pairs(&pairs)) };
        let recipe = Recipe { steps: vec![step] };
        let unroll = |d: &str| {
            let art = Outline::from_svg(d).unwrap();
            let frame = Frame::new(Rect::new(0.0, 0.0, 300.0, 70.0));
            let built = recipe.build(&Registry::builtin(), frame, &std::iter::once(&art)).unwrap();
            let warped = refit::warp_path(&art, &built.map, &refit::Options::new(0.01)).unwrap();
            assert!(warped.report.unresolved.is_empty() && warped.report.max_error <= 0.01, "{:?}", warped.report);
            // The distance from 0,0 is the height, the angle from the vertical, turned back, the width.
            let mut largest: f64 = 0.0;
            for p in art.segs().flat_map(|s| (1..200).map(move |i| s.eval(f64::from(i) / 200.0))) {
                let angle = (p.x.atan2(-p.y) + 10_f64.to_radians() + 3.0 * PI).rem_euclid(TAU) - PI;
                let to = Point::new(150.0 + 300.0 * angle / TAU, 70.0 - (p.to_vec2().hypot() - 20.0));
                let near =
                    warped.path.segments().map(|s| s.nearest(to, 1e-6).distance_sq.sqrt()).fold(f64::MAX, f64::min);
                largest = largest.max(near);
            }
            assert!(largest < 0.0101, "{largest}");
            (built.steps[0].explanation.warnings.clone(), warped.report.segments_out)
        };
        let (warnings, segments) = unroll("M-31.37,40 H8.63 V80 H-31.37 Z");
        assert!(warnings.len() == 1 && warnings[0].contains("torn apart"), "{warnings:?}");
        assert!(segments < 16, "{segments}");
        let (warnings, _) = unroll("M-20,-80 H20 V-40 H-20 Z");
        assert!(warnings.is_empty(), "{warnings:?}");
        // A circle that starts and ends on the ray gives two halves, the way back, and short pieces by rounding at both ends.
        let (sin, cos) = 10_f64.to_radians().sin_cos();
        let (x, y) = (50.0 * -sin, 50.0 * cos);
        let (warnings, segments) = unroll(&format!("M{x},{y} A50,50 0 0 1 {},{} A50,50 0 0 1 {x},{y} Z", -x, -y));
        assert!(segments <= 6 && warnings.len() == 1, "{segments} {warnings:?}");
    }

    #[test]
    fn rings_that_are_none_are_refused() {
        for pairs in [
            &[("inner", "50"), ("outer", "40")][..],
            &[("outer", "30")],
            &[("sweep", "0"), ("inner", "4")],
            &[("spacing", "conformal"), ("outer", "40")],
            &[("spacing", "conformal"), ("inner", "0")],
        ] {
            assert!(matches!(build(pairs), Err(Error::Usage { .. })), "{pairs:?}");
        }
        // Artwork that reaches below the centre is refused where it does.
        let m = build(&[("inner", "0"), ("outer", "50")]).unwrap().map;
        let art = Outline::from_svg("M10,10 L20,150").unwrap();
        let e = refit::warp_path(&art, &*m, &refit::Options::new(0.1)).unwrap_err();
        assert!(e.to_string().contains("infinity"), "{e}");
    }
}
