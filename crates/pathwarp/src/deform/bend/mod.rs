//! Bends artwork along a skeleton.
//!
//! The artwork's levels run along the skeleton curve C, its heights stand on it: F(x, y) = C(u) + v·S(u), u growing with x and v
//! with the height above the baseline. Two kinds of sides S:
//!
//! - **unit normals** ([`piece`]): with u by arc length s, ∂F/∂s = (1 + κd)·T and ∂F/∂d = N, exactly; the strip is as high as
//!   the artwork everywhere and folds beyond the centre of curvature, 1 + κd = 0. At corners S is brought to the mitre, evenly
//!   along both neighbours, so that offsets of a polygon are its offsets;
//! - **handles** ([`casteljau`]): the generalised algorithm of de Casteljau, one handle per leg of the control polygon, deeper
//!   levels on request. F is polynomial in u and v, and the image of a Bézier curve is one again, exactly. By default a handle is
//!   the leg's unit normal, as long as the artwork is high.
//!
//! Source: *A generalized de Casteljau approach to 3D free-form deformation* (Chang & Rockwood, SIGGRAPH 1994), here in the plane;
//! its joint conditions (4) and (5) are checked and told. A skeleton may be given as a B-spline ([`spline`]). Joints of the skeleton are creases: uprights in the artwork.

mod casteljau;
mod piece;
mod skeleton;
mod spline;

use super::{Built, Case, Deformation, Example, Info, Law, Overlay, Role};
use crate::error::{Error, show};
use crate::map::{AffineMap, Class, Crease, Creases, Jet, Level, Map, RationalBezier};
use crate::param::{Axis, Kind, Param, Settings};
use kurbo::{Affine, Point, Vec2};
use piece::{Piece, Shape};
use skeleton::Skeleton;
use std::sync::Arc;

pub(super) struct Bend;

static INFO: Info = Info {
    name: "bend",
    title: "bend artwork along a path",
    group: "Bends",
    about: "The artwork follows a path, the skeleton: what is level runs along it, what is upright stands on it. The skeleton may \
have any number of lines, curves and arcs, open or closed. Nothing is stretched unless you ask: --stretch scale sizes the artwork \
to the skeleton, fit stretches it lengthwise only. --stretch repeat sets copies of it side by side, as many as the skeleton has \
room for, and spreads them evenly.\n\nAn open skeleton is run left to right and a closed one clockwise, so that up \
is up, or outside; --as-drawn and --reverse overrule that. On a closed skeleton the artwork's middle stands on its highest point. \
Beyond the ends of an open one everything goes straight on. --spline 3 makes a smooth skeleton of a \
few points: it is drawn towards them and has no corners; an open one begins at the first and ends at the last.\n\n--by parameter, or --handles, gives the polynomial map of the paper: \
its sides are handles on the control polygon instead of normals of the curve. FILE.json holds {\"pieces\": [{\"levels\": [[[dx,dy], …], \
…]}, …]}: for every piece of degree n the n handles of the first level, then n-1 of the second, and so on (deeper levels may be \
left away). A handle says where the artwork's height goes.",
    source: "Y.-K. Chang and A. Rockwood, A generalized de Casteljau approach to 3D free-form deformation, SIGGRAPH 1994",
    params: &[
        Param::path("along", "The skeleton: one connected path.").needed(),
        Param::new(
            "stretch",
            Kind::Choice(&["keep", "scale", "fit", "repeat"]),
            "Lengths: keep them, scale the artwork evenly to the skeleton's length, fit its width only, or repeat it all along.",
        )
        .default("keep"),
        Param::new(
            "align",
            Kind::Choice(&["start", "middle", "end"]),
            "What of the artwork comes to what of the skeleton.",
        )
        .default("middle"),
        Param::length("offset", Axis::X, "Shift along the skeleton, user units or % of the artwork's width.")
            .default("0"),
        Param::length("gap", Axis::X, "The least space between repeated artwork, user units or % of its width.").default("0"),
        Param::length("baseline", Axis::Y, "The height of the artwork, from its bottom, that lies on the skeleton.")
            .default("50%"),
        Param::number("width", "Heights are multiplied by this.").default("100%").within(1e-6, 1e6).slider(0.1, 3.0),
        Param::new(
            "by",
            Kind::Choice(&["arclength", "parameter"]),
            "Run evenly along the skeleton, or by its pieces' parameters with handles for sides.",
        )
        .default("arclength"),
        Param::new("handles", Kind::File, "A JSON file of handles; the skeleton is then taken as drawn."),
        Param::new(
            "spline",
            Kind::Count,
            "Take the skeleton's anchors as control points of a uniform B-spline of this degree; its own curves count for nothing.",
        )
        .within(1.0, 3.0),
        Param::flag("as-drawn", "Take the skeleton in the direction it was drawn, a closed one from its start."),
        Param::flag("reverse", "Run the skeleton the other way."),
    ],
    demo: &[("along", "M-10,60 Q25,35 50,45 T110,50")],
    examples: &[
        Example {
            what: "Along a curve, true to size",
            command: "bend samples/lettering.svg --along 'M20,170 C180,60 356,60 516,170' -o out.svg --preview out.png",
        },
        Example {
            what: "On an arc of a circle, scaled to its length",
            command: "bend samples/logo.svg --along 'M60,190 A400,400 0 0 1 604,190' --stretch scale --baseline 0 -o out.svg",
        },
        Example {
            what: "A border of logos round a circle",
            command: "bend samples/logo.svg --along 'M100,400 A300,300 0 1 1 700,400 A300,300 0 1 1 100,400 Z' --stretch repeat --gap 10% --baseline 0 -o out.svg",
        },
        Example {
            what: "A grid along a winding path, by the paper's polynomial map",
            command: "bend samples/grid.svg --along 'M10,120 C60,20 90,20 120,120 S180,220 230,120' --by parameter --stretch fit --width 40% -o out.svg",
        },
    ],
    laws: &[
        Law::Identity(&[("along", "0,50 100,50")]),
        Law::Identity(&[("along", "0,50 100,50"), ("by", "parameter")]),
        Law::Identity(&[("along", "100,100 70,100 20,100 0,100"), ("baseline", "0"), ("stretch", "fit")]),
        Law::Area(&[("along", "0,0 30,40"), ("stretch", "scale")], 0.25),
        Law::Area(&[("along", "0,0 30,40"), ("stretch", "fit"), ("width", "3")], 1.5),
        Law::KeepsLines(&[("along", "M10,10 L60,80")]),
        Law::Same(&[("along", "M0,60 Q50,20 100,60")], &[("along", "M100,60 Q50,20 0,60")]),
        Law::Same(
            &[("along", "M0,60 Q50,20 100,60"), ("reverse", "true")],
            &[("along", "M100,60 Q50,20 0,60"), ("as-drawn", "true")],
        ),
        // A B-spline with as many points as its degree asks for is a Bézier curve; points in a row make a line.
        Law::Same(&[("along", "0,60 30,20 70,90 100,50"), ("spline", "3")], &[("along", "M0,60 C30,20 70,90 100,50")]),
        Law::Same(&[("along", "0,60 40,20 90,90"), ("spline", "1")], &[("along", "0,60 40,20 90,90")]),
        // The upper half of a circle, wherever the circle begins and whichever way it was drawn.
        Law::Same(&[("along", ARC), ("baseline", "0")], &[("along", CIRCLE), ("baseline", "0")]),
    ],
    cases: &[
        // Half a circle of radius 50 about 50,50: 45 degrees from the top, on it and 20 above.
        Case { args: ON_ARC, at: (50.0, 100.0), to: (50.0, 0.0), tolerance: 1e-11 },
        Case { args: ON_ARC, at: (EIGHTH, 100.0), to: (50.0 + 50.0 * R2, 50.0 - 50.0 * R2), tolerance: 1e-11 },
        Case { args: ON_ARC, at: (EIGHTH, 80.0), to: (50.0 + 70.0 * R2, 50.0 - 70.0 * R2), tolerance: 1e-11 },
        // A right angle: the mitre, and beyond it the offset.
        Case { args: CORNER, at: (50.0, 40.0), to: (60.0, -10.0), tolerance: 1e-12 },
        Case { args: CORNER, at: (100.0, 40.0), to: (60.0, 50.0), tolerance: 1e-12 },
        // The polynomial map: C(1/2) + S(1/2)/2 of a quadratic with legs (30,-40) and (30,40), their normals (-.8,-.6), (.8,-.6).
        Case { args: PARAMETER, at: (50.0, 50.0), to: (30.0, -20.0), tolerance: 1e-12 },
        Case { args: PARAMETER, at: (50.0, 0.0), to: (30.0, -50.0), tolerance: 1e-12 },
    ],
};

const ARC: &str = "M0,50 A50,50 0 0 1 100,50";
const CIRCLE: &str = "M100,50 A50,50 0 1 1 0,50 A50,50 0 1 1 100,50 Z";
const ON_ARC: super::Pairs = &[("along", ARC), ("baseline", "0")];
const CORNER: super::Pairs = &[("along", "0,0 50,0 50,50"), ("align", "start")];
const PARAMETER: super::Pairs = &[("along", "M0,0 Q30,-40 60,0"), ("by", "parameter"), ("stretch", "fit")];
const EIGHTH: f64 = 50.0 + 50.0 * std::f64::consts::FRAC_PI_4;
const R2: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// The handles file.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct HandlesFile {
    pieces: Vec<PieceHandles>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct PieceHandles {
    levels: Vec<Vec<[f64; 2]>>,
}

impl Deformation for Bend {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let missing = || Error::Missing { param: "--along".into(), hint: "the path to bend the artwork along".into() };
        let mut path = s.path_if("along")?.ok_or_else(missing)?;
        if let Some(degree) = s.number_if("spline")? {
            path = spline::through(&path, degree as usize)?;
        }
        let rect = s.frame().rect;
        let file = s.file_if("handles")?;
        let as_drawn = s.flag("as-drawn")? || file.is_some();
        let skeleton = Skeleton::new(&path, as_drawn, s.flag("reverse")?)?;
        let by_arc_length = s.choice("by")? == "arclength";
        let size = s.frame().extent(Axis::Diagonal).max(skeleton.length);

        let skeleton = match &file {
            Some(f) if skeleton.has_arcs() => {
                return Err(Error::input(
                    f.name.clone(),
                    "handles stand on lines and Bézier curves; the skeleton has arcs",
                ));
            }
            Some(_) => skeleton,
            None if by_arc_length => skeleton,
            // Arcs become cubics this near, as a share of the whole.
            None => skeleton.polynomial(1e-9 * size, true),
        };
        let (length, closed) = (skeleton.length, skeleton.closed);
        let middle = if closed && !as_drawn { skeleton.top() } else { 0.5 * length };
        // What v = 1 stands for; artwork without height has nothing to stand up.
        let unit = if rect.height() > 0.0 { rect.height() } else { 1.0 };
        let joined = match &file {
            Some(f) => {
                let file: HandlesFile = serde_json::from_str(&f.text)
                    .map_err(|e| Error::input(f.name.clone(), format!("is no file of handles: {e}")))?;
                let vectors = |l: Vec<[f64; 2]>| l.into_iter().map(|[x, y]| Vec2::new(x, y)).collect();
                let given: Vec<Vec<Vec<Vec2>>> =
                    file.pieces.into_iter().map(|p| p.levels.into_iter().map(vectors).collect()).collect();
                skeleton.with_handles(Some(&given), unit, by_arc_length)?
            }
            None if by_arc_length => skeleton.with_normals()?,
            None => skeleton.with_handles(None, unit, false)?,
        };

        let stretch = s.choice("stretch")?;
        if stretch != "keep" && rect.width() <= 0.0 {
            return Err(Error::usage("stretch", stretch, "cannot stretch artwork that has no width"));
        }
        let k = if matches!(stretch, "keep" | "repeat") { 1.0 } else { length / rect.width() };
        let row = match stretch {
            "repeat" => Row::new(rect.width(), s.number("gap")?, length, closed)?,
            _ => Row::ONE,
        };
        let (from, to) = match s.choice("align")? {
            // A row that reaches from end to end begins where the skeleton does.
            _ if row.count > 1 && !closed => (rect.x0, 0.0),
            "start" => (rect.x0, 0.0),
            "end" => (rect.x1, length),
            _ => (rect.center().x, middle),
        };
        let place = Place {
            k,
            origin: to + s.number("offset")? - k * from,
            up: s.number("width")? * if stretch == "scale" { k } else { 1.0 },
            base: rect.y1 - s.number("baseline")?,
        };
        let pieces = joined.pieces.into_iter().map(Arc::new).collect();
        let shift = row.spacing * (row.count - 1) as f64;
        let rect = kurbo::Rect { x1: rect.x1 + shift, ..rect };
        let reach = (rect.x0 - rect.width(), rect.x1 + rect.width());
        let map = BendMap { pieces, length, closed, place, reach };

        let mut built = Built::new(map.simplest());
        built.notes.push(format!("skeleton: length {length:.6}, {}", if closed { "closed" } else { "open" }));
        built.notes.extend(joined.notes);
        for c in joined.corners {
            built.warnings.push(format!(
                "bend: the skeleton has a corner at {} (it turns by {:.1}°): the artwork is mitred there; round it for a smooth bend",
                show(c.at),
                c.turn.to_degrees().abs()
            ));
        }
        if stretch == "repeat" {
            built.notes.push(format!("artwork repeated: {} times, one every {:.6}", row.count, row.spacing));
            built.copies = (0..row.count).map(|i| Affine::translate((row.spacing * i as f64, 0.0))).collect();
        }
        if k * rect.width() > length * (1.0 + 1e-9) {
            let what = if closed { "runs over itself" } else { "runs straight on beyond its ends" };
            built.warnings.push(format!(
                "bend: the artwork is {:.6} wide, the skeleton only {length:.6} long: it {what}; see --stretch",
                k * rect.width()
            ));
        }
        built.warnings.extend(map.fold(rect));
        built.overlays.push(Overlay { role: Role::Cage, path: path.outline.to_bez_path(1e-4 * size) });
        Ok(built)
    }
}

/// Copies of the artwork side by side.
#[derive(Debug, Clone, Copy)]
struct Row {
    count: usize,
    /// From one to the next.
    spacing: f64,
}

impl Row {
    const ONE: Self = Self { count: 1, spacing: 0.0 };

    /// As many copies of `width` as `length` has room for with at least `gap` between them, spread evenly: on an open skeleton
    /// from its start to its end, on a closed one all round.
    fn new(width: f64, gap: f64, length: f64, closed: bool) -> Result<Self, Error> {
        /// More than this on one skeleton is a slip of the unit.
        const MOST: f64 = 10_000.0;
        let period = width + gap;
        if period <= 0.0 {
            return Err(Error::usage(
                "gap",
                gap.to_string(),
                format!("is no more than minus the artwork's width, {width:.6}"),
            ));
        }
        // Rounding must not refuse what just fits.
        let room = ((if closed { length } else { length + gap }) / period * (1.0 + 1e-9)).floor().max(1.0);
        if room > MOST {
            let problem = format!("would take {room} copies of artwork {width:.6} wide; {MOST} are the most");
            return Err(Error::usage("stretch", "repeat", problem));
        }
        let spacing = match (closed, room > 1.0) {
            (true, _) => length / room,
            (false, true) => (length - width) / (room - 1.0),
            (false, false) => 0.0,
        };
        Ok(Self { count: room as usize, spacing })
    }
}

/// From the artwork to the strip: distance s = k·x + origin, height d = up·(base − y).
#[derive(Debug, Clone, Copy)]
struct Place {
    k: f64,
    origin: f64,
    up: f64,
    base: f64,
}

impl Place {
    fn s(&self, x: f64) -> f64 {
        self.k * x + self.origin
    }

    fn d(&self, y: f64) -> f64 {
        (self.base - y) * self.up
    }

    /// The jet on `piece`, which begins at distance `begin`.
    fn jet(&self, piece: &Piece, begin: f64, p: Point) -> Jet {
        let (at, ds, dd) = piece.jet(self.s(p.x) - begin, self.d(p.y));
        Jet { p: at, dx: ds * self.k, dy: dd * -self.up }
    }
}

/// The map: pieces side by side.
#[derive(Clone)]
struct BendMap {
    pieces: Vec<Arc<Piece>>,
    length: f64,
    closed: bool,
    place: Place,
    /// The x for which creases are told.
    reach: (f64, f64),
}

impl BendMap {
    /// The piece at `x`, and the distance at which its own begins there.
    fn piece(&self, x: f64) -> (&Arc<Piece>, f64) {
        let s = self.place.s(x);
        let turn = if self.closed { (s / self.length).floor() * self.length } else { 0.0 };
        let i = self.pieces.partition_point(|p| p.from <= s - turn).max(1) - 1;
        (&self.pieces[i], self.pieces[i].anchor + turn)
    }

    /// A skeleton that is one straight line bends nothing.
    fn simplest(&self) -> Arc<dyn Map> {
        match &self.pieces[..] {
            [only] if !self.closed => match OnPiece::new(only, only.anchor, self.place).affine() {
                Some(m) => Arc::new(AffineMap(m)),
                None => Arc::new(self.clone()),
            },
            _ => Arc::new(self.clone()),
        }
    }

    /// A warning if the artwork's box is turned over somewhere. The determinant is linear in the height: the box's top and
    /// bottom are where it is worst.
    fn fold(&self, rect: kurbo::Rect) -> Option<String> {
        const SAMPLES: u32 = 1024;
        let mut worst: Option<(f64, Point, f64)> = None;
        for i in 0..=SAMPLES {
            let x = rect.x0 + rect.width() * (f64::from(i) + 0.5) / f64::from(SAMPLES + 1);
            let det = |y: f64| self.jet(Point::new(x, y)).det() / (self.place.k * self.place.up);
            let on = det(self.place.base);
            for y in [rect.y0, rect.y1] {
                let there = det(y);
                if there < 0.0 && worst.is_none_or(|(w, ..)| there < w) {
                    // Where the line between them crosses zero: the centre of curvature.
                    let centre = self.place.d(y).abs() * on / (on - there);
                    worst = Some((there, self.point(Point::new(x, self.place.base)), centre));
                }
            }
        }
        worst.map(|(_, at, centre)| {
            format!(
                "bend: the artwork folds over itself near {} of the skeleton, where it reaches more than {centre:.6} away from it, \
beyond the centre of curvature; a smaller --width, another --baseline or a gentler bend avoids that",
                show(at)
            )
        })
    }
}

impl Map for BendMap {
    fn jet(&self, p: Point) -> Jet {
        let (piece, begin) = self.piece(p.x);
        self.place.jet(piece, begin, p)
    }

    /// Uprights at the skeleton's joints.
    fn creases(&self, out: &mut Creases) {
        /// Turns round a closed skeleton whose joints are told.
        const MOST_TURNS: f64 = 64.0;
        let (a, b) = (self.place.s(self.reach.0), self.place.s(self.reach.1));
        let turns = |s: f64| if self.closed { (s / self.length).floor() } else { 0.0 };
        let (mut turn, last) = (turns(a), turns(b));
        let last = last.min(turn + MOST_TURNS);
        while turn <= last {
            for s in self.pieces.iter().map(|p| p.from).filter(|s| s.is_finite()) {
                let c = self.place.origin - s - turn * self.length;
                out.push(Crease::kink(Level::Line { a: self.place.k, b: 0.0, c }));
            }
            turn += 1.0;
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let (piece, begin) = self.piece(inside.x);
        Some(Arc::new(OnPiece::new(piece, begin, self.place)))
    }
}

/// The smooth map on one piece.
struct OnPiece {
    piece: Arc<Piece>,
    begin: f64,
    place: Place,
}

impl OnPiece {
    fn new(piece: &Arc<Piece>, begin: f64, place: Place) -> Self {
        Self { piece: Arc::clone(piece), begin, place }
    }

    fn affine(&self) -> Option<Affine> {
        let Shape::Straight { p, t, n } = &self.piece.shape else { return None };
        let Place { k, up, .. } = self.place;
        let at = *p + *t * (self.place.s(0.0) - self.begin) + *n * self.place.d(0.0);
        Some(Affine::new([t.x * k, t.y * k, -n.x * up, -n.y * up, at.x, at.y]))
    }
}

impl Map for OnPiece {
    fn jet(&self, p: Point) -> Jet {
        self.place.jet(&self.piece, self.begin, p)
    }

    fn class(&self) -> Class {
        self.affine().map_or(Class::Smooth, Class::Affine)
    }

    fn image_of(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        if let Some(m) = self.affine() {
            return AffineMap(m).image_of(curve);
        }
        let Shape::Ribbon { ribbon, unit, table: None } = &self.piece.shape else { return None };
        let Place { k, origin, up, base } = self.place;
        let (length, v) = (self.piece.length, up / unit);
        let to_uv = Affine::new([k / length, 0.0, 0.0, -v, (origin - self.begin) / length, base * v]);
        Some(ribbon.image_of(&AffineMap(to_uv).image_of(curve)?))
    }
}

#[cfg(test)]
mod tests;
