//! Bézier triangles: the artwork in a triangle follows a net of control points.
//!
//! F(u) = Σ wᵢⱼₖ Pᵢⱼₖ Bᵢⱼₖ(u) / Σ wᵢⱼₖ Bᵢⱼₖ(u), with Bᵢⱼₖ(u) = n!/(i!j!k!)·u₀ⁱu₁ʲu₂ᵏ and u the barycentric coordinates in
//! the reference triangle ABC (see [`net`]). Pᵢⱼₖ starts at (iA + jB + kC)/n. At degree 1 the
//! map is affine, with weights projective; at degree 2 six points are free and lines become conics' projections: parabolas, or
//! conics with weights. Outside the triangle nothing moves; the restriction of the map to a side depends on that side's points
//! alone, so a side whose points stay put is joined without a gap.
//!
//! G. Farin, *Triangular Bernstein–Bézier patches*, CAGD 3 (1986); J. Sánchez-Reyes, J. M. Chacón, *Anamorphic free-form
//! deformation*, CAGD 46 (2016), where the net is moved along rays (see `anamorph`).

pub(super) mod net;

use crate::deform::built::{Built, Role};
use crate::deform::entry::{Case, Deformation, Example, Info, Law};
use crate::error::{Error, GeometryError};
use crate::param::{Axis, Kind, Param, Settings};
use kurbo::{BezPath, Point, Rect, Vec2};

use net::{TriangleNet, indices};

pub(super) struct Triangle;

static INFO: Info = Info::new("triangle", "pull artwork about by a triangular net of control points")
    .group("Lattices and nets")
    .about("Lays a triangle over the artwork, with control points along its sides and inside it, and lets the artwork follow where \
they are moved. Degree 1 has the three corners; degree 2 the middles of the sides too; degree 3 one more in the middle. The higher \
the degree, the more local each point's pull. A triangle bends less stiffly than a rectangular net of the same degree, and treats \
all directions alike.\n\nA control point is named by three numbers I,J,K that add up to the degree: how near it lies to the first, \
second and third corner. 2,0,0 is the first corner of a triangle of degree 2, 0,1,1 the middle of the side opposite.\n\nOutside the \
triangle nothing moves, unless --extend is given. Where a side's control points stay in their places, inside and outside join \
without a gap; if not, a warning tells.")
    .source("G. Farin, Triangular Bernstein-Bézier patches, CAGD 3, 1986; J. Sánchez-Reyes, J. M. Chacón, Anamorphic Free-Form \
Deformation, CAGD 46, 2016")
    .params(&[
        Param::new(
            "reference",
            Kind::Text("X,Y X,Y X,Y"),
            "The triangle's corners. Default: a triangle about the artwork, its \
first corner at the top, its second at the bottom left.",
        ),
        Param::new("degree", Kind::Count, "How finely the net is divided: control points along a side, less one.")
            .default("2")
            .within(1.0, 10.0),
        Param::new("move", Kind::Text("I,J,K:DX,DY"), "Moves a control point by this much; may be given many times.")
            .repeated(),
        Param::new("at", Kind::Text("I,J,K:X,Y"), "Puts a control point here; may be given many times.").repeated(),
        Param::new(
            "weight",
            Kind::Text("I,J,K:W"),
            "How strongly a control point draws the artwork towards itself, 1 being usual; may be given many times.",
        )
        .repeated(),
        Param::flag(
            "extend",
            "Let the map run on outside the triangle instead of leaving everything there in its place.",
        ),
    ])
    .demo(&[("move", "0,1,1:10,15"), ("weight", "1,1,0:2")])
    .examples(&[
        Example {
            what: "Pull the bottom down in the middle",
            command: "triangle samples/lettering.svg --move 0,1,1:0,60% -o out.svg",
        },
        Example {
            what: "Push out one spot of a badge; its surroundings stay",
            command: "triangle samples/badge.svg --reference '50%,5% 5%,80% 95%,80%' --degree 3 --move 1,1,1:0,-20% -o out.svg",
        },
        Example {
            what: "Six points, two of them moved, with no edge",
            command: "triangle samples/grid.svg --move 1,1,0:-30%,30% --move 1,0,1:30%,30% --extend -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[]),
        Law::Identity(&[("degree", "7"), ("reference", "0,0 90,10 20,80"), ("extend", "true")]),
        Law::Identity(&[("weight", "1,0,1:1"), ("move", "1,0,1:0,0")]),
        Law::KeepsLines(&[("degree", "1"), ("move", "1,0,0:10,-20"), ("weight", "0,1,0:1.5"), ("extend", "true")]),
        Law::Area(&[("degree", "1"), ("reference", "0,0 100,0 0,100"), ("at", "0,1,0:200,0"), ("extend", "true")], 2.0),
    ])
    .cases(&[
        // The middle of a side: a quarter of its ends and half of its middle point.
        Case { args: SIX, at: (50.0, 0.0), to: (50.0, 15.0), tolerance: 1e-12 },
        // u = (½, ¼, ¼): B110 = 2·½·¼ = ¼ of the shift.
        Case { args: SIX, at: (25.0, 25.0), to: (25.0, 32.5), tolerance: 1e-12 },
        Case { args: SIX, at: (90.0, 90.0), to: (90.0, 90.0), tolerance: 0.0 },
        // Beyond the triangle, run on: u = (−½, ¾, ¾), B110 = −¾.
        Case {
            args: &[("reference", "0,0 100,0 0,100"), ("move", "1,1,0:0,30"), ("extend", "true")],
            at: (75.0, 75.0),
            to: (75.0, 52.5),
            tolerance: 1e-12,
        },
        // Weights draw along the sides: (¼·0 + ½·2·50 + ¼·100)/(¼ + 1 + ¼) = 50; at u = (¾, ¼, 0) it is
        // (2·⅜·50 + 100/16)/(9/16 + ¾ + 1/16) = 43.75/1.375.
        Case {
            args: &[("reference", "0,0 100,0 0,100"), ("weight", "1,1,0:2")],
            at: (25.0, 0.0),
            to: (43.75 / 1.375, 0.0),
            tolerance: 1e-12,
        },
    ]);

const SIX: crate::deform::entry::Pairs = &[("reference", "0,0 100,0 0,100"), ("move", "1,1,0:0,30")];

impl Deformation for Triangle {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let corners = corners(s)?;
        let degree = s.number("degree")? as usize;
        let mut net = TriangleNet::regular(corners, degree).ok_or_else(|| GeometryError::Collinear {
            path: "reference".into(),
            which: [1, 2, 3],
            points: corners.to_vec(),
        })?;
        let lengths = |name: &str, text: &str| -> Result<Vec2, Error> {
            let wrong = || Error::usage(name, text, "is not a shift DX,DY");
            let (dx, dy) = text.split_once(',').ok_or_else(wrong)?;
            Ok(Vec2::new(s.length_in(name, dx, Axis::X)?, s.length_in(name, dy, Axis::Y)?))
        };
        for text in s.texts("at") {
            let (ijk, rest) = node(s, "at", text, degree)?;
            net.place(ijk, s.point_in("at", rest)?);
        }
        for text in s.texts("move") {
            let (ijk, rest) = node(s, "move", text, degree)?;
            net.shift(ijk, lengths("move", rest)?);
        }
        for text in s.texts("weight") {
            let (ijk, rest) = node(s, "weight", text, degree)?;
            let w = s.number_in("weight", rest)?;
            if w <= 0.0 || w > 1e6 {
                return Err(Error::usage(
                    "weight",
                    text,
                    "has a weight out of range: it must be positive, a million at most",
                ));
            }
            net.set_weight(ijk, w);
        }
        let extended = s.flag("extend")?;
        let mut built = Built::new(net.map(extended));
        if !extended {
            let names = ["first and second", "second and third", "third and first"];
            let torn =
                (0..3).filter(|&k| !net.side_is_fixed(k) && meets(s.frame().rect, corners[k], corners[(k + 1) % 3]));
            for k in torn {
                built.warn(format!(
                    "the side between the {} corner runs through the artwork's box and has control points moved: what crosses it \
is torn apart; keep that side's points in place, choose a larger `reference`, or give `extend`",
                    names[k]
                ));
            }
        }
        let outline = |p: [Point; 3]| {
            let mut path = BezPath::new();
            path.move_to(p[0]);
            path.line_to(p[1]);
            path.line_to(p[2]);
            path.close_path();
            path
        };
        built.overlay(Role::Base, outline(corners));
        built.overlay(Role::Cage, cage(&net));
        Ok(built)
    }
}

/// The reference triangle as given, or one about the artwork's box: twice as wide and twice as high.
fn corners(s: &Settings<'_>) -> Result<[Point; 3], Error> {
    let Some(text) = s.texts("reference").pop() else {
        let r = s.frame().rect;
        let half = r.width() / 2.0;
        return Ok([
            Point::new(r.center().x, r.y0 - r.height()),
            Point::new(r.x0 - half, r.y1),
            Point::new(r.x1 + half, r.y1),
        ]);
    };
    let points = s.points_in("reference", text)?;
    points.try_into().map_err(|p: Vec<Point>| {
        Error::usage("reference", text, format!("has {} points; a triangle has three", p.len()))
    })
}

/// Reads `I,J,K:…`, the three numbers adding up to the degree.
fn node<'t>(s: &Settings<'_>, name: &str, text: &'t str, degree: usize) -> Result<([usize; 3], &'t str), Error> {
    let (ijk, rest) = s.node_in::<3>(name, text)?;
    if ijk.iter().try_fold(0usize, |sum, v| sum.checked_add(*v)) != Some(degree) {
        return Err(Error::usage(
            name,
            text,
            format!("names no control point: I, J and K must add up to {degree}, the degree"),
        ));
    }
    Ok((ijk, rest))
}

/// Whether the line between two points runs through the inside of a box.
fn meets(r: Rect, a: Point, b: Point) -> bool {
    let room = 1e-9 * (r.width() + r.height());
    let inner = r.inflate(-room, -room);
    // Cut the line's parameter range by the box's two slabs.
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (p, d, lo, hi) in [(a.x, b.x - a.x, inner.x0, inner.x1), (a.y, b.y - a.y, inner.y0, inner.y1)] {
        if d == 0.0 {
            if p <= lo || p >= hi {
                return false;
            }
        } else {
            let (t0, t1) = ((lo - p) / d, (hi - p) / d);
            from = from.max(t0.min(t1));
            to = to.min(t0.max(t1));
        }
    }
    from < to
}

/// The net's lines in three directions.
fn cage(net: &TriangleNet) -> BezPath {
    let mut path = BezPath::new();
    for [i, j, k] in indices(net.degree()).into_iter().filter(|ijk| ijk[0] > 0) {
        let (left, right) = (net.point([i - 1, j + 1, k]), net.point([i - 1, j, k + 1]));
        path.move_to(net.point([i, j, k]));
        path.line_to(left);
        path.line_to(right);
        path.close_path();
    }
    path
}

#[cfg(test)]
mod tests {
    use super::net::{basis, regular_point};
    use super::*;
    use crate::check;
    use crate::map::{Class, Map, RationalBezier};
    use crate::outline::Seg;
    use crate::param::Args;

    fn build(pairs: &[(&str, &str)]) -> Result<Built, Error> {
        Triangle.build_from(&Args::from_pairs(pairs), &check::frame())
    }

    #[test]
    fn is_sound() {
        let faults = check::entry(&Triangle);
        assert!(faults.is_empty(), "{faults:#?}");
    }

    /// Straight from the definition, factorials and all.
    #[test]
    fn every_degree_agrees_with_the_definition() {
        let corners = [Point::new(-20.0, 10.0), Point::new(120.0, -5.0), Point::new(30.0, 140.0)];
        for n in 1..=10usize {
            for rational in [false, true] {
                let mut net = TriangleNet::regular(corners, n).unwrap();
                for [i, j, k] in indices(n) {
                    let wobble = (7 * i + 3 * j + 11 * k) as f64;
                    net.shift([i, j, k], Vec2::new(9.0 * wobble.sin(), 9.0 * wobble.cos()));
                    if rational {
                        net.set_weight([i, j, k], 1.5 + wobble.sin());
                    }
                }
                let m = net.map(true);
                for p in [(30.0, 40.0), (0.0, 20.0), (90.0, 10.0), (40.0, 100.0), (-15.0, 120.0)].map(Point::from) {
                    let area = |a: Point, b: Point, c: Point| (b - a).cross(c - a);
                    let [a, b, c] = corners;
                    let u = [area(p, b, c), area(a, p, c), area(a, b, p)].map(|v| v / area(a, b, c));
                    let factorial = |k: usize| (1..=k).map(|v| v as f64).product::<f64>();
                    let (mut x, mut w) = (Vec2::ZERO, 0.0);
                    for ([i, j, k], value) in indices(n).into_iter().zip(basis(corners, n, p)) {
                        let many = factorial(n) / (factorial(i) * factorial(j) * factorial(k));
                        let b = many * u[0].powi(i as i32) * u[1].powi(j as i32) * u[2].powi(k as i32);
                        assert!((value - b).abs() < 1e-11);
                        let wobble = (7 * i + 3 * j + 11 * k) as f64;
                        let weight = if rational { 1.5 + wobble.sin() } else { 1.0 };
                        x += net.point([i, j, k]).to_vec2() * (b * weight);
                        w += b * weight;
                    }
                    let off = m.point(p).distance((x / w).to_point());
                    // The change of basis multiplies rounding by up to 3ⁿ, by more far outside.
                    let inside = u.iter().all(|v| *v >= 0.0);
                    let near = if inside { 1e-13 * 3f64.powi(n as i32) } else { 1e-7 };
                    assert!(off < near, "degree {n}: {off:e}");
                    if p.x > 0.0 && p.y < 50.0 {
                        assert!(net.map(false).point(p).distance(m.point(p)) < 1e-12);
                    }
                }
            }
        }
        assert_eq!(regular_point(corners, [0, 2, 0]), corners[1]);
    }

    #[test]
    fn degree_one_is_affine_and_with_weights_projective() {
        let one = build(&[("degree", "1"), ("move", "0,1,0:5,5"), ("extend", "true")]).unwrap().map;
        assert!(matches!(one.class(), Class::Affine(_)));
        let two = build(&[("degree", "1"), ("weight", "0,1,0:3"), ("extend", "true")]).unwrap().map;
        assert!(matches!(two.class(), Class::Projective(_)));
        // Moved together, six points make an affine map too.
        let corners = ["2,0,0:0,10", "0,2,0:0,20", "0,0,2:0,0", "1,1,0:0,15", "1,0,1:0,5", "0,1,1:0,10"];
        let mut args = Args::from_pairs(&[("extend", "true")]);
        corners.iter().for_each(|c| args.push("move", *c));
        let m = Triangle.build_from(&args, &check::frame()).unwrap().map;
        assert!(matches!(m.class(), Class::Affine(_)));
    }

    #[test]
    fn exact_images_have_n_times_the_degree() {
        let cubic = Seg::Cubic(kurbo::CubicBez::new((5.0, 5.0), (90.0, 5.0), (20.0, 80.0), (60.0, 60.0)));
        let source = RationalBezier::from_seg(&cubic).unwrap();
        for (degree, node) in [("2", "0,1,1"), ("3", "1,1,1"), ("5", "1,2,2")] {
            let (shift, weight) = (format!("{node}:9,9"), format!("{node}:2"));
            for args in [vec![("move", &*shift)], vec![("move", &shift), ("weight", &weight)]] {
                let m = build(&[args, vec![("degree", degree)]].concat()).unwrap().map;
                let image = m.image(&source).unwrap();
                assert_eq!(image.degree(), 3 * degree.parse::<usize>().unwrap());
                for i in 0..=20 {
                    let t = f64::from(i) / 20.0;
                    assert!(image.eval(t).distance(m.point(source.eval(t))) < 1e-10);
                }
            }
        }
    }

    #[test]
    fn a_fixed_side_joins_and_a_torn_one_is_told() {
        let reference = ("reference", "10,20 90,30 40,90");
        let inner = build(&[reference, ("degree", "3"), ("move", "1,1,1:8,-6")]).unwrap();
        assert!(inner.explanation.warnings.is_empty(), "{:?}", inner.explanation.warnings);
        let b = inner.map.branch(Point::new(45.0, 45.0)).unwrap();
        for t in [0.0, 0.2, 0.7, 1.0] {
            let p = Point::new(10.0, 20.0).lerp(Point::new(90.0, 30.0), t);
            assert!(b.point(p).distance(p) < 1e-13);
        }
        let torn = build(&[reference, ("move", "1,1,0:8,-6")]).unwrap();
        assert!(
            torn.explanation.warnings.len() == 1 && torn.explanation.warnings[0].contains("first and second"),
            "{:?}",
            torn.explanation.warnings
        );
        let large = build(&[("move", "0,1,1:0,10")]).unwrap();
        assert!(large.explanation.warnings.is_empty(), "{:?}", large.explanation.warnings);
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (pairs, part) in [
            (&[("reference", "0,0 1,1")][..], "three"),
            (&[("reference", "0,0 1,1 2,2")], "one line"),
            (&[("move", "1,1,1:3,3")], "add up to 2"),
            (&[("move", "1,1:3,3")], "I,J,K:"),
            (&[("move", "1,1,0:3")], "DX,DY"),
            (&[("weight", "1,1,0:0")], "positive"),
            (&[("move", "99999999999999999999,1,0:0,0")], "I,J,K:"),
            (&[("degree", "11")], "out of range"),
        ] {
            let e = build(pairs).err().unwrap().to_string();
            assert!(e.contains(part), "{e}");
        }
    }
}
