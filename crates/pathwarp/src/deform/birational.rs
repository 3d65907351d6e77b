//! Free-form deformation of degree 1×n with a closed-form inverse.
//!
//! Two rows of n + 1 freely chosen points face each other; P(s,t) = (1−s)·P₀(t) + s·P₁(t), with weights that make the map one
//! to one and its inverse rational: see [`map::Birational`]. The weights are those of T. W. Sederberg, R. N. Goldman, X. Wang,
//! *Birational 2D free-form deformation of degree 1×n*, CAGD 44 (2016), equations 11-13 and 26, to which numbers of equations refer;
//! for degree 1×1 also of T. W. Sederberg, J. Zheng, *Birational quadrilateral maps*, CAGD 2015.

use super::entry::{Built, ByHand, Case, Entry, Example, Info, Law, Pairs, Role};
use super::ffd::{MAX_CELLS, MAX_DEGREE};
use crate::error::{Error, GeometryError, show};
use crate::map::{self, AffineMap, Class, Map, Rows};
use crate::outline::{Outline, Seg};
use crate::param::{Kind, Settings, parameters};
use crate::solve::{misses, smallest_change};
use kurbo::{BezPath, Point, Rect};
use std::sync::Arc;

/// The smallest angle between two pieces that is worth a warning, in degrees.
const VISIBLE_KINK: f64 = 0.1;

parameters! {
    /// Free-form deformation of degree 1×n between two rows of points, with a closed-form inverse.
    ///
    /// P(s,t) = (1−s)·P₀(t) + s·P₁(t), the weights of the rows P₀, P₁ being those that make the inverse rational. Lines across the
    /// rows stay straight.
    ///
    /// ```
    /// use pathwarp::{deform::Birational, kurbo::{Point, Rect}, map::Map};
    ///
    /// let (top, bottom) = ([(0.0, 0.0), (50.0, -40.0), (100.0, 0.0)], [(0.0, 100.0), (50.0, 100.0), (100.0, 100.0)]);
    /// let arch = Birational::top_bottom(Rect::new(0.0, 0.0, 100.0, 100.0), top, bottom).build()?;
    /// assert!(arch.map.point(Point::new(50.0, 0.0)).distance(Point::new(50.0, -20.0)) < 1e-12);
    /// # Ok::<(), pathwarp::Error>(())
    /// ```
    #[derive(Debug, Clone, PartialEq)]
    pub struct Birational(s, rows: Rows, first: Vec<Point>, second: Vec<Point>) {
        /// The top row, left to right: points x,y x,y …, or a path (its anchors; of a single curve its control points).
        param = path("top");
        /// The bottom row, left to right, with as many points.
        param = path("bottom");
        /// Instead of top and bottom, the left row, top to bottom.
        param = path("left");
        /// The right row, top to bottom, with as many points.
        param = path("right");
        /// Take the rows for B-splines of this degree; they need at least one point more than that.
        spline: Option<usize> = new("spline", Kind::Count).within(1.0, MAX_DEGREE as f64);
        /// Instead of one of the rows, the point in which all lines across them meet: the row is then the other one, halved towards it.
        param = new("meet", Kind::Point);
        /// Spacing along the rows: above 1 the artwork moves towards their last points, below 1 towards their first.
        spacing: f64 = number("spacing").default("1").within(0.01, 100.0).slider(0.2, 5.0);
        /// Instead of the spacing, a point on the line through the rows' first points, with --q1: the lines across divide the segment from
        /// the one to the other evenly.
        q0: Option<Point> = new("q0", Kind::Point);
        /// A point on the line through the rows' last points, with --q0.
        q1: Option<Point> = new("q1", Kind::Point);
        /// The weight of point J of row I, both from 0; may be given three times, the other weights follow.
        param = new("weight", Kind::Text("I,J:W")).repeated();
        /// The box that is laid between the rows; the map continues outside it.
        param = new("region", Kind::Text("artwork|X,Y,W,H")).default("artwork");
        /// Accept points outside the lines that join the rows' ends: the map is infinite somewhere then.
        allow_poles: bool = flag("allow-poles");
        let region: Rect = s.rect_if("region")?.unwrap_or(s.frame().rect);
        let weights: Vec<([usize; 2], f64)> = weights(s)?;
    }
}

impl Birational {
    /// Lays the box `region` between a top and a bottom row, both left to right, of equally many points (2 to 11; for splines up to
    /// 64 more than their degree, at most 10). Verticals stay straight.
    pub fn top_bottom(
        region: Rect,
        top: impl IntoIterator<Item = impl Into<Point>>,
        bottom: impl IntoIterator<Item = impl Into<Point>>,
    ) -> Self {
        let (first, second) = (top.into_iter().map(Into::into).collect(), bottom.into_iter().map(Into::into).collect());
        Self::defaults(region, Rows::TopBottom, first, second)
    }

    /// Lays the box `region` between a left and a right row, both top to bottom, of equally many points (2 to 11).
    /// Horizontals stay straight.
    pub fn left_right(
        region: Rect,
        left: impl IntoIterator<Item = impl Into<Point>>,
        right: impl IntoIterator<Item = impl Into<Point>>,
    ) -> Self {
        Self { rows: Rows::LeftRight, ..Self::top_bottom(region, left, right) }
    }

    /// Gives point `j` of row `i`, both counted from 0, a positive weight. The weights that are not given follow, with the smallest
    /// change (equation 7). At most three weights can be chosen freely.
    #[must_use]
    pub fn weight(mut self, i: usize, j: usize, weight: f64) -> Self {
        self.weights.push(([i, j], weight));
        self
    }

    /// Builds the map. A kink between B-spline pieces gives a warning.
    ///
    /// # Errors
    /// [`Error::Geometry`] for rows of different or illegal length, facing ends that coincide, and points on the wrong side of
    /// the lines that join the rows' ends; [`Error::Usage`] for a region without area, a number out of range, weights that are not positive
    /// or contradict each other, and a Q₀ or Q₁ off its line.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        let Self { region, rows, first, second, spline, allow_poles, .. } = self;
        let names = match rows {
            Rows::TopBottom => ["top", "bottom"],
            Rows::LeftRight => ["left", "right"],
        };
        self.check_counts(names[1])?;
        if !(region.width() > 0.0 && region.height() > 0.0) {
            return Err(Error::usage("region", "artwork", "has no area: the artwork is flat; name a box x,y,w,h"));
        }
        let map = map::Birational::new(*region, *rows, [first, second], *spline, *allow_poles, names)?;
        let map = self.with_weights(map)?;
        let mut notes = match map.axis() {
            _ if spline.is_some() => Vec::new(),
            [x, y, w] if w != 0.0 => {
                vec![format!("the lines across the rows meet in {}", show(Point::new(x / w, y / w)))]
            }
            _ => vec!["the lines across the rows are parallel".to_owned()],
        };
        for (k, [a, b]) in map.weights().enumerate() {
            notes.push(format!("weights of piece {}: {a:.6?} and {b:.6?}", k + 1));
        }
        let kink = map.kink().filter(|(angle, _)| *angle > VISIBLE_KINK);
        let mut built = Built::new(match map.class() {
            Class::Affine(m) => Arc::new(AffineMap(m)),
            _ => Arc::new(map),
        });
        built.explanation.notes = notes;
        if let Some((angle, at)) = kink {
            built.warn(format!(
                "curves along the rows turn by up to {angle:.1} degrees where two pieces of the spline meet, near {}: place the points of \
both rows opposite each other, on parallel lines or on lines through one point",
                show(at)
            ));
        }
        built.overlay(Role::Base, kurbo::Shape::to_path(region, 0.0));
        built.overlay(Role::Cage, net(first, second));
        Ok(built)
    }

    /// Returns `map` with the given spacing, points or weights.
    fn with_weights(&self, map: map::Birational) -> Result<map::Birational, Error> {
        let Self { spacing, weights, .. } = self;
        let has_weights = *spacing != 1.0 || !weights.is_empty();
        match (self.q0, self.q1) {
            (None, None) if !has_weights => return Ok(map),
            _ if self.spline.is_some() => {
                let problem = "leaves no weight free; omit `spacing`, `q0`, `q1` and `weight`";
                return Err(Error::usage("spline", "", problem));
            }
            (None, None) => {}
            (Some(q0), Some(q1)) if !has_weights => return self.between(&map, [q0, q1]),
            _ => return Err(Error::usage("q0", "", "goes with `q1`, and without `spacing` and `weight`")),
        }
        // New weights have ln w = ln wᵢⱼ + ln kᵢ + j·ln g; the unknowns are ln k₀, ln k₁ and ln g.
        let piece = map.weights().next();
        let (mut rows, mut want) = (Vec::new(), Vec::new());
        if *spacing != 1.0 {
            (rows, want) = (vec![vec![0.0, 0.0, 1.0]], vec![[spacing.ln()]]);
        }
        let wrong = |[i, j]: [usize; 2], w: f64, why: &str| Error::usage("weight", format!("{i},{j}:{w}"), why);
        for &([i, j], w) in weights {
            let old = piece.and_then(|rows| rows.get(i)?.get(j));
            let old = old.ok_or_else(|| wrong([i, j], w, "is not a point of a row"))?;
            if !(w > 0.0 && w.is_finite() && *old > 0.0) {
                return Err(wrong([i, j], w, "is not a positive weight of a lattice without poles"));
            }
            rows.push(vec![1.0 - i as f64, i as f64, j as f64]);
            want.push([(w / old).ln()]);
        }
        let change = smallest_change(&rows, &want);
        let misses = misses(&rows, &want, &change);
        if let Some(([i, j], w)) = weights.last().filter(|_| misses.iter().any(|miss| *miss > 1e-9)) {
            return Err(wrong([*i, *j], *w, "contradicts the others: three weights determine all; leave one out"));
        }
        let [k0, k1, g] = [0, 1, 2].map(|k| change[k][0].exp());
        map.respaced([k0, k1], g)
            .ok_or_else(|| Error::usage("spacing", "", "leads to weights out of range; choose values nearer to 1"))
    }

    /// Returns the map whose lines across divide the segment between two points evenly.
    fn between(&self, map: &map::Birational, q: [Point; 2]) -> Result<map::Birational, Error> {
        let wrong = |name: &str, at: Point, why: &str| Error::usage(&name.to_lowercase(), show(at), why);
        let map = map.along(q).map_err(|e| match e {
            GeometryError::WrongSide { path, at, .. } if path.starts_with('Q') => {
                wrong(&path, at, "does not lie on the line through the rows' points at that end")
            }
            GeometryError::Coincident { path, at, .. } => {
                wrong(&path, at, "is the point in which the lines across meet")
            }
            e => e.into(),
        })?;
        if !self.allow_poles && map.weights().flatten().flatten().any(|w| *w <= 0.0) {
            let why = "or `q1` lies beyond the point in which the lines across meet, seen from the rows";
            return Err(wrong("q0", q[0], why));
        }
        Ok(map)
    }

    /// Refuses rows of different or illegal length; `name` is the second row's.
    fn check_counts(&self, name: &str) -> Result<(), Error> {
        let Self { first, second, spline, .. } = self;
        let (min, max) = spline.map_or((2, MAX_DEGREE + 1), |d| (d + 1, d + MAX_CELLS));
        let expected = if first.len() != second.len() {
            "as many as the facing row"
        } else if second.len() < min {
            if spline.is_some() { "at least one more than the degree" } else { "at least 2" }
        } else if second.len() > max {
            if spline.is_some() { "at most 64 more than the degree" } else { "at most 11; take `spline 3` for more" }
        } else {
            return Ok(());
        };
        Err(GeometryError::anchor_count(name, second, expected).into())
    }
}

static INFO: Info = Info::new("birational", "bend artwork between two rows of points; verticals or horizontals stay straight")
    .group("Envelopes")
    .by_hand(ByHand {
        label: Some("Two rows"),
        rows: true,
        neutral: &[
            ("top", "0%,0% 33.3333%,0% 66.6667%,0% 100%,0%"),
            ("bottom", "0%,100% 33.3333%,100% 66.6667%,100% 100%,100%"),
        ],
        ..ByHand::NONE
    })
    .guides(&["top", "bottom"], 2)
    .about("Draw the new top and bottom of the artwork as two rows of equally many points from left to right: \
verticals stay straight lines between them, which is what lettering wants. Or give --left and --right from top to bottom: \
then horizontals stay straight. The rows are curves that begin and end in their first and last points and are pulled towards the \
others, as with any Bézier curve.\n\nAs long as the rows do not cross, the result does not fold over, and undoing it is exact and fast: no search is needed.\n\n\
Each row's inner points must lie between the lines that join the rows' ends; --allow-poles lifts that restriction, for artwork that \
keeps clear of the points where the map is infinite. With --spline, rows of many points become B-splines and bend locally; place their points \
opposite each other, or the artwork kinks where pieces meet.\n\n\
Verticals may stand closer at one end (--spacing), evenly along a line of yours (--q0, --q1), or as the weights of three points say (--weight). \
Give --meet and one row instead of two for verticals that meet in a point: docs/birational.md has the mathematics.")
    .source("T. W. Sederberg, R. N. Goldman, X. Wang, Birational 2D free-form deformation of degree 1xn, Computer Aided Geometric Design 44, \
2016; of degree 1x1: T. W. Sederberg, J. Zheng, Birational quadrilateral maps, Computer Aided Geometric Design 32, 2015")
    .params(Birational::PARAMS)
    .demo(&[("top", "0,10 30,-25 70,30 100,5"), ("bottom", "5,90 35,110 60,70 95,100")])
    .examples(&[
        Example {
            what: "A word on a wave, its verticals kept straight",
            command: "birational samples/lettering.svg --top '0%,20% 30%,-60% 60%,90% 100%,0%' --bottom '0%,100% 35%,60% 60%,170% 100%,100%' -o out.svg",
        },
        Example {
            what: "A logo like a flag blown from the side: horizontals stay straight",
            command: "birational samples/logo.svg --left '0%,0% -6%,40% 6%,70% 0%,100%' --right '100%,5% 94%,45% 106%,75% 100%,110%' -o out.svg --preview out.png",
        },
        Example {
            what: "A fan: one row, and the point in which all uprights meet",
            command: "birational samples/lettering.svg --top '0%,20% 30%,-60% 70%,-60% 100%,20%' --meet 50%,500% --spacing 1.5 -o out.svg",
        },
        Example {
            what: "Many points: B-spline rows",
            command: "birational samples/grid.svg --spline 3 --top '0%,0% 20%,-20% 40%,10% 60%,-10% 80%,20% 100%,0%' --bottom '0%,100% 20%,90% 40%,115% 60%,90% 80%,110% 100%,100%' -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("top", "0,0 100,0"), ("bottom", "0,100 100,100")]),
        Law::Identity(&[("left", "0,0 0,25 0,50 0,75 0,100"), ("right", "100,0 100,25 100,50 100,75 100,100")]),
        Law::Identity(&[
            ("spline", "2"),
            ("top", "10,10 20,10 40,10 50,10"),
            ("bottom", "10,90 20,90 40,90 50,90"),
            ("region", "10,10,40,80"),
        ]),
        // A path that is one curve means its control points.
        Law::Same(
            &[("top", "M0,0 C30,20 60,-20 100,0"), ("bottom", "0,90 30,90 60,80 100,100")],
            &[("top", "0,0 30,20 60,-20 100,0"), ("bottom", "0,90 30,90 60,80 100,100")],
        ),
        Law::KeepsLinesAlong(BENT, (0.0, 1.0)),
        Law::KeepsLinesAlong(&[("left", "0,0 -20,25 15,55 5,90"), ("right", "80,-10 100,30 70,60 95,110")], (1.0, 0.0)),
        Law::KeepsLinesAlong(
            &[("spline", "2"), ("top", "0,0 30,20 60,-20 100,0"), ("bottom", "0,90 30,90 60,80 100,100")],
            (0.0, 1.0),
        ),
        Law::KeepsLinesAlong(&[("top", "0,0 25,-20 60,15 80,-10"), ("meet", "30,400"), ("spacing", "3")], (0.0, 1.0)),
        Law::KeepsLinesAlong(
            &[("top", "0,0 30,20 60,-20 100,0"), ("bottom", "0,90 30,90 60,80 100,100"), ("weight", "0,0:1 1,0:2 1,2:5")],
            (0.0, 1.0),
        ),
        // Equal weights, and points at the ends of a rectangle's rows, do not change the map.
        Law::Identity(&[("top", "0,0 100,0"), ("bottom", "0,100 100,100"), ("weight", "0,0:2 1,0:2 1,1:2")]),
        Law::Identity(&[("top", "0,0 100,0"), ("bottom", "0,100 100,100"), ("q0", "0,30"), ("q1", "100,30")]),
    ])
    .cases(&[
        // Figure 3c, w01 = 5/3 and the others 1: P(2/5, 2/3) = (8, 4).
        Case {
            args: &[("left", "0,0 8,6"), ("right", "12,0 12,4"), ("weight", "0,0:1 1,0:1 1,1:1")],
            at: (40.0, 200.0 / 3.0),
            to: (8.0, 4.0),
            tolerance: 1e-12,
        },
        // Corners on corners.
        Case { args: BENT, at: (0.0, 0.0), to: (0.0, 0.0), tolerance: 1e-12 },
        Case { args: BENT, at: (100.0, 100.0), to: (95.0, 110.0), tolerance: 1e-12 },
        // Between two points that face each other on parallel end lines all weights are 1: the middle of a quadratic.
        Case {
            args: &[("top", "0,0 50,-40 100,0"), ("bottom", "0,100 50,100 100,100")],
            at: (50.0, 0.0),
            to: (50.0, -20.0),
            tolerance: 1e-12,
        },
    ]);

const BENT: Pairs = &[("top", "0,0 25,-20 60,15 80,-10"), ("bottom", "5,90 30,100 60,70 95,110")];

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| {
    let meet = s.given("meet").then(|| s.point("meet")).transpose()?;
    let mut given = [row(s, "top")?, row(s, "bottom")?, row(s, "left")?, row(s, "right")?];
    if let Some(meet) = meet {
        let rows: Vec<usize> = (0..4).filter(|i| given[*i].is_some()).collect();
        let [i] = rows[..] else {
            let problem = "takes the place of a row: give one row with it";
            return Err(Error::usage("meet", s.texts("meet").join(" "), problem));
        };
        // The facing row is this one, halved towards the point.
        given[i ^ 1] = given[i].as_ref().map(|row| row.iter().map(|p| p.midpoint(meet)).collect());
    }
    let (rows, first, second) = match given.into() {
        (Some(a), Some(b), None, None) => (Rows::TopBottom, a, b),
        (None, None, Some(a), Some(b)) => (Rows::LeftRight, a, b),
        (None, None, None, None) => {
            let hint =
                "with `bottom`, a row of equally many points, left to right (or `left` and `right`, top to bottom)";
            return Err(Error::missing("top", hint));
        }
        (None, Some(_), None, None) => return Err(facing("top", "bottom")),
        (Some(_), None, None, None) => return Err(facing("bottom", "top")),
        (None, None, None, Some(_)) => return Err(facing("left", "right")),
        (None, None, Some(_), None) => return Err(facing("right", "left")),
        _ => {
            let name = if s.given("left") { "left" } else { "right" };
            return Err(Error::usage(name, s.texts(name).join(" "), "cannot go with `top` and `bottom`"));
        }
    };
    Birational::read(s, rows, first, second)?.build()
});

/// Reads `weight`.
fn weights(s: &Settings<'_>) -> Result<Vec<([usize; 2], f64)>, Error> {
    let words = s.texts("weight").into_iter().flat_map(str::split_whitespace);
    let weight = |text| {
        let (node, value) = s.node_in::<2>("weight", text)?;
        Ok((node, s.number_in("weight", value)?))
    };
    words.map(weight).collect()
}

fn facing(missing: &str, given: &str) -> Error {
    Error::missing(missing, format!("the row that faces `{given}`, with as many points"))
}

/// Reads a row: the anchors of a path, or the control points of a single curve.
fn row(s: &Settings<'_>, name: &str) -> Result<Option<Vec<Point>>, Error> {
    let Some(path) = s.path_if(name)? else { return Ok(None) };
    let points = match path.outline.subpaths.as_slice() {
        [one] if one.segs.len() == 1 => match one.segs[0] {
            Seg::Quad(q) => vec![q.p0, q.p1, q.p2],
            Seg::Cubic(c) => vec![c.p0, c.p1, c.p2, c.p3],
            _ => one.anchors(),
        },
        _ => path.outline.anchors(),
    };
    Ok(Some(points))
}

/// Draws both rows, and the lines between facing points.
fn net(a: &[Point], b: &[Point]) -> BezPath {
    let mut p = BezPath::new();
    let lines = a.iter().zip(b).map(|(a, b)| vec![*a, *b]);
    for line in [a.to_vec(), b.to_vec()].into_iter().chain(lines) {
        p.extend(Outline::from_points(&line, false).to_bez_path(0.0));
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check;
    use crate::deform::Deformation as _;
    use crate::param::Args;

    fn build(pairs: &[(&str, &str)]) -> Result<Built, Error> {
        ENTRY.build_from(&Args::from_pairs(pairs), &check::frame())
    }

    #[test]
    fn faults_are_named() {
        let rows = [("left", "0,0 8,6"), ("right", "12,0 12,4")];
        let fails = |more: &[(&str, &str)]| build(&[&rows[..], more].concat()).unwrap_err().to_string();
        assert!(fails(&[("spacing", "2"), ("q0", "0,0"), ("q1", "0,10")]).contains("without `spacing`"));
        assert!(fails(&[("weight", "0,0:0")]).contains("positive"));
        assert!(fails(&[("weight", "0,2:1")]).contains("not a point"));
        assert!(fails(&[("weight", "0,0:1 1,0:1 1,1:1 0,1:1")]).contains("contradicts"));
        assert!(fails(&[("q0", "0,0")]).contains("q1"));
        assert!(fails(&[("q0", "0,1"), ("q1", "0,10")]).contains("does not lie on the line"));
        assert!(fails(&[("q0", "20,0"), ("q1", "0,10")]).contains("is the point in which"));
        assert!(fails(&[("q0", "30,0"), ("q1", "0,10")]).contains("lies beyond"));
        assert!(fails(&[("meet", "20,0")]).contains("takes the place of a row"));
        let spline = [("spline", "2"), ("top", "0,0 30,20 60,-20 100,0"), ("bottom", "0,90 30,90 60,80 100,100")];
        assert!(build(&[&spline[..], &[("spacing", "2")]].concat()).unwrap_err().to_string().contains("spline"));
    }

    #[test]
    fn kinks_are_said() {
        let top = ("top", "0,0 20,-20 40,10 60,-10 80,20 100,0");
        let warnings = |bottom: &str| build(&[("spline", "3"), top, ("bottom", bottom)]).unwrap().explanation.warnings;
        assert!(warnings("0,100 20,90 40,115 60,90 80,110 100,100").is_empty());
        let kinked = warnings("0,100 30,90 50,115 60,90 90,110 100,100");
        assert!(kinked.len() == 1 && kinked[0].contains("degrees"), "{kinked:?}");
    }

    /// The lines meet at the given point A, and both rows have the same weights: P(s, t) = A + (1 − s/2)·(P₀(t) − A).
    #[test]
    fn a_row_and_a_point() {
        let built = build(&[("top", "0,0 25,-20 60,15 80,-10"), ("meet", "30,400")]).unwrap();
        assert!(built.explanation.notes[0].contains("30,400"), "{:?}", built.explanation.notes);
        let [top, middle, bottom] = [0.0, 50.0, 100.0].map(|y| built.map.point(Point::new(40.0, y)));
        assert!(middle.distance(top.midpoint(bottom)) < 1e-12);
        assert!(bottom.distance(top.midpoint(Point::new(30.0, 400.0))) < 1e-12);
    }
}
