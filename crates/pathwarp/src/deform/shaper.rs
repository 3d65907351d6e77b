//! The 16-point shaper: artwork bent into a four-sided curved path.
//!
//! F = h₂ ∘ F₀ ∘ h₁ (Markku Koppinen, *A plane transformation from 16 control points*, equation 8). F₀ is the bicubic map of a
//! 4×4 net (equation 3); the user draws its outer twelve points as a closed path of four cubic sides, and the inner four follow
//! by equation 7 ([`net::complete`]). h₁ brings the Base to the standard position, h₂ the shaper's corners to the Target: direct
//! similitudes for two anchors, projective maps for four.
//!
//! The net is numbered p\[r\]\[s\]: row 0 is the bottom side run left to right, column 0 the left side run upwards.

use super::built::{Built, Explanation, Overlay, Role};
use super::entry::{Case, Deformation, Example, Info, Law};
use crate::anchors::{self, Anchors, Arrangement};
use crate::error::{Error, GeometryError};
use crate::map::net::{self, Net};
use crate::map::{AffineMap, BicubicNet, Chain, Class, Map};
use crate::outline::Seg;
use crate::param::{Kind, NamedPath, Param, Settings};
use kurbo::{BezPath, CubicBez, Point};
use std::sync::Arc;

pub(super) struct Shaper;

static INFO: Info = Info::new("shaper", "bend artwork into a closed path of four curved sides")
    .group("Envelopes")
    .about("Draw a closed path with four anchors: that is the shape. The artwork's box (or the Base) is laid onto it, sides on \
sides, and everything inside follows smoothly. With a Target, the shaper's corners are then brought there, so that its own \
size and place do not matter.\n\nWhich side is the bottom? The one that lies lowest on the screen, run left to right; --bottom \
and --reverse-shaper overrule that, and --explain tells what was chosen. Two-anchor Bases and Targets are turned left to right, \
four-anchor ones start with their lowest side; --base-as-drawn and --target-as-drawn take them as they were drawn.\n\nA Base of \
two anchors fixes only the bottom side: artwork twice as tall as the Base is wide reaches past the shaper's top.")
    .source("Markku Koppinen, A plane transformation from 16 control points, equations (1)-(10)")
    .params(&[
        Param::path("shaper", "The closed path of four sides (lines, curves or arcs) to bend the artwork into."),
        Param::path(
            "net",
            "Instead of --shaper, all 16 control points: four paths of one cubic each, or 16 points, row by row, the bottom row \
first, each left to right.",
        )
        .repeated(),
        Param::path(
            "base",
            "Two or four anchors in the source that are laid onto the shaper's bottom side or its four corners. Default: the \
corners of the artwork's box.",
        ),
        Param::path(
            "target",
            "Two or four anchors where the shaper's bottom corners, or all four, are to land. Default: where the shaper lies.",
        ),
        Param::new("bottom", Kind::Count, "The side that is the bottom: 1 to 4, in the order they were drawn. Default: the lowest on the screen.")
            .within(1.0, 4.0),
        Param::flag("reverse-shaper", "Run the bottom side the other way (right to left): the result is mirrored."),
        Param::flag("base-as-drawn", "Take the Base's anchors in the order they were drawn."),
        Param::flag("target-as-drawn", "Take the Target's anchors in the order they were drawn."),
    ])
    .demo(&[("shaper", "M 10,90 C 40,110 60,70 95,85 C 85,60 105,40 90,15 C 60,-5 40,35 5,10 C 15,40 0,60 10,90 Z")])
    .examples(&[
        Example {
            what: "Bend a logo into a path of another file",
            command: "shaper samples/logo.svg --shaper samples/banner.svg -o out.svg",
        },
        Example {
            what: "The paper's example: Base, Target and Shaper are paths of the document itself",
            command: "shaper samples/paper-two-anchors.svg --base #Base --target #Target --shaper #Shaper -o out.svg --preview out.png",
        },
        Example {
            what: "A cage typed in place, and what was made of it",
            command: "shaper samples/monogram.svg --shaper 'M0,120 Q60,90 120,120 L110,0 Q60,30 10,0 Z' --explain -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("shaper", "0,0 100,0 100,100 0,100")]),
        Law::Identity(&[("shaper", "M0,100 L0,0 L100,0 L100,100 Z")]),
        Law::Identity(&[("shaper", "0,0 10,0 10,10 0,10"), ("target", "0,100 100,100")]),
        Law::Area(&[("shaper", "0,0 50,0 50,50 0,50")], 0.25),
        Law::Same(
            // The shaper's own size and place do not matter when there is a Target.
            &[("shaper", "M 10,90 Q 40,110 95,85 L 90,15 5,10 Z"), ("base", "0,100 100,100"), ("target", "5,90 70,80")],
            &[("shaper", "M 30,190 Q 90,230 200,180 L 190,40 20,30 Z"), ("base", "0,100 100,100"), ("target", "5,90 70,80")],
        ),
        Law::Same(
            // Neither does where a closed path starts, nor which way it runs.
            &[("shaper", "M 10,90 Q 40,110 95,85 L 90,15 5,10 Z")],
            &[("shaper", "M 90,15 L 95,85 Q 40,110 10,90 L 5,10 Z")],
        ),
        Law::KeepsLines(&[("shaper", "0,0 100,0 100,100 0,100"), ("target", "0,100 100,90 80,20 10,0")]),
    ])
    .cases(&[
        // Corners on corners; the bottom side's middle on the bottom arc's middle (a quadratic: (10+2·40+95)/4, ...).
        Case { args: CASE, at: (0.0, 100.0), to: (10.0, 90.0), tolerance: 1e-12 },
        Case { args: CASE, at: (100.0, 100.0), to: (95.0, 85.0), tolerance: 1e-12 },
        Case { args: CASE, at: (100.0, 0.0), to: (90.0, 15.0), tolerance: 1e-12 },
        Case { args: CASE, at: (50.0, 100.0), to: (46.25, 98.75), tolerance: 1e-12 },
        // The middle of a Coons patch: half the sum of the sides' middles less the corners' mean.
        Case { args: CASE, at: (50.0, 50.0), to: (46.875, 55.625), tolerance: 1e-12 },
    ]);

const CASE: super::entry::Pairs = &[("shaper", "M 10,90 Q 40,110 95,85 L 90,15 5,10 Z")];

impl Deformation for Shaper {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let mut notes = Vec::new();
        let (net, cage, name) = match (s.path_if("shaper")?, s.paths("net")?) {
            (Some(_), net) if !net.is_empty() => {
                return Err(Error::usage(
                    "net",
                    net[0].name.clone(),
                    "cannot go with `shaper`: one of them gives the net",
                ));
            }
            (Some(path), _) => {
                let net = from_cage(&path, s, &mut notes)?;
                (net, sides_path(&net), path.name)
            }
            (None, rows) if !rows.is_empty() => {
                if s.given("bottom") || s.given("reverse-shaper") {
                    return Err(Error::usage(
                        "net",
                        rows[0].name.clone(),
                        "is taken as given; `bottom` and `reverse-shaper` go with `shaper`",
                    ));
                }
                let net = from_rows(&rows)?;
                let path = rows_path(&net);
                (net, path, rows[0].name.clone())
            }
            _ => {
                return Err(Error::Missing {
                    param: "shaper".into(),
                    hint: "the closed path of four sides to bend the artwork into (or `net` with 16 points)".into(),
                });
            }
        };
        let corners = [net[0][0], net[0][3], net[3][3], net[3][0]];
        notes.push(format!("corners of {name}: {} (bottom left, bottom right, top right, top left)", list(&corners)));

        let base = match anchors::from_settings(s, "base", "base-as-drawn")? {
            Some(b) => b,
            None => anchors::frame_corners(s.frame())?,
        };
        let target = anchors::from_settings(s, "target", "target-as-drawn")?;
        notes.push(format!("base: {} ({})", list(base.points()), wrapper(&base)));
        let after = match &target {
            None => {
                notes.push("target: none, the result lies where the shaper lies".into());
                None
            }
            Some(t) => {
                notes.push(format!("target: {} ({})", list(t.points()), wrapper(t)));
                Some(to_target(&name, &corners, t)?)
            }
        };
        let map = compose(&anchors::to_standard("base", &base)?, net, after);
        let map = match map.class() {
            Class::Affine(m) => Arc::new(AffineMap(anchors::settled(m, s.frame()))),
            _ => map,
        };

        let mut overlays = vec![Overlay { role: Role::Cage, path: cage }, overlay(Role::Base, &base)];
        overlays.extend(target.iter().map(|t| overlay(Role::Target, t)));
        Ok(Built::new(map).explained(Explanation { notes, overlays, ..Explanation::default() }))
    }
}

/// h₂ ∘ F₀ ∘ h₁, with affine wrappers folded into the net.
fn compose(h1: &Arc<dyn Map>, net: Net, h2: Option<Arc<dyn Map>>) -> Arc<dyn Map> {
    let (net, h2) = match h2.as_ref().map(Map::class) {
        Some(Class::Affine(m)) => (net.map(|row| row.map(|p| m * p)), None),
        _ => (net, h2),
    };
    let (before, pre) = match h1.class() {
        Class::Affine(m) => (None, m),
        _ => (Some(h1.clone()), kurbo::Affine::IDENTITY),
    };
    let f0 = Arc::new(BicubicNet::new(&net, pre)) as Arc<dyn Map>;
    if before.is_none() && h2.is_none() {
        return f0;
    }
    Arc::new(Chain::new(before.into_iter().chain([f0]).chain(h2)))
}

/// The map of the shaper's corners to the Target.
fn to_target(name: &str, corners: &[Point; 4], target: &Anchors) -> Result<Arc<dyn Map>, Error> {
    match *target {
        Anchors::Two([p, q]) => {
            let m = AffineMap::similitude(corners[0], corners[1], p, q).ok_or_else(|| GeometryError::Coincident {
                path: name.to_owned(),
                which: [1, 2],
                at: corners[0],
            })?;
            Ok(Arc::new(m))
        }
        Anchors::Four(q) => Ok(Arc::new(anchors::projective("target", *corners, q)?)),
    }
}

/// The net of a closed path with four sides, its bottom chosen by the paper's rule or by the user.
fn from_cage(path: &NamedPath, s: &Settings<'_>, notes: &mut Vec<String>) -> Result<Net, Error> {
    let sub = anchors::closed_subpath(path, "exactly four, in one closed path", |lines| lines == 3)?;
    let drawn = sub.anchors();
    let [Some(a), Some(b), Some(c), Some(d)] = [0, 1, 2, 3].map(|i| (drawn.len() == 4).then(|| drawn[i])) else {
        return Err(GeometryError::AnchorCount {
            path: path.name.clone(),
            found: drawn.len(),
            anchors: drawn.into_iter().take(8).collect(),
            expected: "exactly four, in one closed path",
        }
        .into());
    };
    let corners = [a, b, c, d];
    anchors::general(&path.name, &corners)?;
    let sides: [CubicBez; 4] = std::array::from_fn(|i| sub.segs[i].to_cubic());

    let mut arrangement = if s.given("bottom") {
        Arrangement::from_bottom(&corners, s.number("bottom")? as usize - 1)
    } else {
        // The mean height of a cubic over its parameter is the mean of its control points' heights.
        let heights = sides.map(|c| (c.p0.y + c.p1.y + c.p2.y + c.p3.y) / 4.0);
        Arrangement::by_rule(&corners, &heights)
    };
    if s.flag("reverse-shaper")? {
        arrangement.reversed = !arrangement.reversed;
    }
    notes.push(format!(
        "bottom side of {}: side {} as drawn, {}",
        path.name,
        arrangement.bottom + 1,
        if arrangement.reversed { "run backwards" } else { "run forwards" }
    ));
    Ok(net::complete(outer_net(&sides, &arrangement)))
}

/// The outer twelve points, the inner four yet to come.
fn outer_net(sides: &[CubicBez; 4], a: &Arrangement) -> Net {
    let backwards = |c: CubicBez| CubicBez::new(c.p3, c.p2, c.p1, c.p0);
    // Four sides head to tail: bottom, right, top (right to left), left (downwards).
    let ring: [CubicBez; 4] = std::array::from_fn(|i| {
        if a.reversed { backwards(sides[(a.bottom + 4 - i) % 4]) } else { sides[(a.bottom + i) % 4] }
    });
    let [bottom, right, top, left] = [ring[0], ring[1], backwards(ring[2]), backwards(ring[3])];
    let inner = Point::ORIGIN;
    [
        [bottom.p0, bottom.p1, bottom.p2, bottom.p3],
        [left.p1, inner, inner, right.p1],
        [left.p2, inner, inner, right.p2],
        [top.p0, top.p1, top.p2, top.p3],
    ]
}

/// The net given in full: four rows of one cubic each, or 16 points.
fn from_rows(given: &[NamedPath]) -> Result<Net, Error> {
    let name = &given[0].name;
    let subpaths: Vec<_> = given.iter().flat_map(|p| &p.outline.subpaths).collect();
    let rows: Option<Vec<[Point; 4]>> = if subpaths.len() == 4 && subpaths.iter().all(|s| s.segs.len() == 1) {
        let row = |s: &Seg| {
            let c = s.to_cubic();
            [c.p0, c.p1, c.p2, c.p3]
        };
        Some(subpaths.iter().map(|s| row(&s.segs[0])).collect())
    } else {
        let points: Vec<Point> = subpaths.iter().flat_map(|s| s.anchors()).collect();
        (points.len() == 16).then(|| points.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect())
    };
    let Some([a, b, c, d]) = rows.as_deref() else {
        let anchors: Vec<Point> = subpaths.iter().flat_map(|s| s.anchors()).collect();
        return Err(GeometryError::AnchorCount {
            path: name.clone(),
            found: anchors.len(),
            anchors: anchors.into_iter().take(8).collect(),
            expected: "16 points, or four paths of one cubic each",
        }
        .into());
    };
    let net = [*a, *b, *c, *d];
    anchors::general(name, &[a[0], a[3], d[3], d[0]])?;
    Ok(net)
}

/// The closed path of a net's four sides.
fn sides_path(n: &Net) -> BezPath {
    let mut p = BezPath::new();
    p.move_to(n[0][0]);
    p.curve_to(n[0][1], n[0][2], n[0][3]);
    p.curve_to(n[1][3], n[2][3], n[3][3]);
    p.curve_to(n[3][2], n[3][1], n[3][0]);
    p.curve_to(n[2][0], n[1][0], n[0][0]);
    p.close_path();
    p
}

/// The eight curves of a net.
pub(super) fn rows_path(n: &Net) -> BezPath {
    let mut p = BezPath::new();
    for (i, row) in n.iter().enumerate() {
        p.move_to(row[0]);
        p.curve_to(row[1], row[2], row[3]);
        p.move_to(n[0][i]);
        p.curve_to(n[1][i], n[2][i], n[3][i]);
    }
    p
}

fn overlay(role: Role, a: &Anchors) -> Overlay {
    Overlay { role, path: a.outline().to_bez_path(0.0) }
}

fn wrapper(a: &Anchors) -> &'static str {
    match a {
        Anchors::Two(_) => "two anchors: a similitude",
        Anchors::Four(_) => "four anchors: a projective map",
    }
}

fn list(points: &[Point]) -> String {
    points.iter().map(|p| crate::error::show(*p)).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::Outline;
    use crate::param::{Args, Frame};
    use kurbo::{ParamCurve, Rect};

    const CAGE: &str = "M 10,90 C 40,110 60,70 95,85 C 85,60 105,40 90,15 C 60,-5 40,35 5,10 C 15,40 0,60 10,90 Z";

    fn build(pairs: &[(&str, &str)]) -> Result<Built, Error> {
        Shaper.build_from(&Args::from_pairs(pairs), &Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0)))
    }

    /// Criterion: the box's sides land on the shaper's arcs to 1e-9.
    #[test]
    fn sides_land_on_sides() {
        let m = build(&[("shaper", CAGE)]).unwrap().map;
        let sides: Vec<CubicBez> = Outline::from_svg(CAGE).unwrap().segs().map(Seg::to_cubic).collect();
        for i in 0..=100 {
            let t = f64::from(i) / 100.0;
            let on = [(100.0 * t, 100.0), (100.0, 100.0 - 100.0 * t), (100.0 - 100.0 * t, 0.0), (0.0, 100.0 * t)];
            for (side, p) in sides.iter().zip(on) {
                assert!(m.point(p.into()).distance(side.eval(t)) < 1e-9);
            }
        }
    }

    /// Criterion: the Base's anchors land on the Target's to 1e-9, in every mix of counts.
    #[test]
    fn base_lands_on_target() {
        let bases: [(&str, &[usize]); 2] = [("12,80 77,88", &[0, 1]), ("0,100 90,95 100,5 10,10", &[0, 1, 2, 3])];
        let targets = ["200,150 320,110", "210,160 300,170 330,40 190,60"];
        for (base, which) in bases {
            for target in targets {
                let m = build(&[("shaper", CAGE), ("base", base), ("target", target)]).unwrap().map;
                let parse = |t: &str| -> Vec<Point> {
                    t.split(' ')
                        .map(|w| {
                            w.split_once(',').map(|(x, y)| Point::new(x.parse().unwrap(), y.parse().unwrap())).unwrap()
                        })
                        .collect()
                };
                let (b, t) = (parse(base), parse(target));
                for &i in which.iter().filter(|i| **i < t.len()) {
                    assert!(m.point(b[i]).distance(t[i]) < 1e-9, "{base} {target} {i}: {:?}", m.point(b[i]));
                }
            }
        }
    }

    #[test]
    fn the_net_given_in_full_equals_the_cage() {
        let by_cage = build(&[("shaper", CAGE)]).unwrap();
        let sides: Vec<CubicBez> = Outline::from_svg(CAGE).unwrap().segs().map(Seg::to_cubic).collect();
        let ring: [CubicBez; 4] = [sides[0], sides[1], sides[2], sides[3]];
        let net = net::complete(outer_net(&ring, &Arrangement { bottom: 0, reversed: false }));
        let points: Vec<String> = net.iter().flatten().map(|p| format!("{},{}", p.x, p.y)).collect();
        let rows: Vec<String> = net
            .iter()
            .map(|r| {
                format!("M{},{} C{},{} {},{} {},{}", r[0].x, r[0].y, r[1].x, r[1].y, r[2].x, r[2].y, r[3].x, r[3].y)
            })
            .collect();
        for by_net in [
            build(&[("net", &points.join(" "))]),
            build(&[("net", &rows.join(" "))]),
            build(&[("net", &rows[0]), ("net", &rows[1]), ("net", &rows[2]), ("net", &rows[3])]),
        ] {
            let by_net = by_net.unwrap();
            for p in [(0.0, 0.0), (30.0, 70.0), (110.0, -5.0)] {
                assert!(by_net.map.point(p.into()).distance(by_cage.map.point(p.into())) < 1e-10);
            }
        }
    }

    #[test]
    fn the_lowest_side_is_the_bottom_and_can_be_overruled() {
        let m = |extra: &[(&str, &str)]| {
            let mut pairs = vec![("shaper", "M 0,0 L 100,0 L 100,100 L 0,100 Z")];
            pairs.extend(extra);
            build(&pairs).unwrap().map.point((10.0, 80.0).into())
        };
        let near = |p: Point, q: (f64, f64)| p.distance(q.into()) < 1e-12;
        assert!(near(m(&[]), (10.0, 80.0)));
        assert!(near(m(&[("reverse-shaper", "true")]), (90.0, 80.0)));
        // Side 1 is the top edge: the picture stands on its head, not mirrored left to right.
        assert!(near(m(&[("bottom", "1")]), (10.0, 20.0)));
    }

    #[test]
    fn every_fault_is_named() {
        let fault = |pairs: &[(&str, &str)]| build(pairs).err().unwrap().to_string();
        let square = "0,0 100,0 100,100 0,100";
        assert!(fault(&[("shaper", "M0,0 L1,0 L1,1 L0,1 L0,0.5")]).contains("shaper is not closed"));
        assert!(fault(&[("shaper", "M0,0 L1,0 L1,1 Z")]).contains("has 3 anchors (0,0 1,0 1,1)"));
        assert!(fault(&[("shaper", "M0,0 L1,0 L2,0 L0,1 Z")]).contains("anchors 1, 2 and 3"));
        assert!(fault(&[("shaper", square), ("base", "5,5 5,5")]).contains("base: anchors 1 and 2 coincide at 5,5"));
        assert!(fault(&[("shaper", square), ("target", "0,0 1,0 2,0 0,1")]).contains("target: anchors 1, 2 and 3"));
        assert!(fault(&[("shaper", square), ("base", "1,1 2,2 3,5")]).contains("base has 3 anchors"));
        assert!(fault(&[("shaper", square), ("bottom", "5")]).contains("bottom: `5` is out of range"));
        assert!(fault(&[("shaper", square), ("base", "0,0 10,0 2,2 0,10")]).contains("hits infinity"));
        assert!(fault(&[]).contains("shaper is needed"));
        assert!(fault(&[("shaper", "M0,0 L1,0 L1,1 L0,1 Z M5,5 L6,6")]).contains("has 6 anchors"));
    }
}
