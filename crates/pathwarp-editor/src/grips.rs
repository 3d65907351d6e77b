//! The geometry from which the page makes the handles of a step's parameters (grips), in user units: paths, points, pairs of points, nets.
//!
//! The kind of a parameter and, for text, its notation determine its handles; therefore plug-ins have handles, too.

use crate::nets::{self, Net, Space};
use pathwarp::deform::{Info, Registry, TextShape};
use pathwarp::kurbo::{Point, Rect};
use pathwarp::map::Lattice;
use pathwarp::param::{Args, Axis, Frame, Kind, Param, Settings};
use pathwarp::recipe::{BuiltRecipe, Recipe};
use pathwarp::{Outline, Seg};
use pathwarp_engine::edits::CAPTION;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;
use std::ops::RangeInclusive;

/// Distance within which cubics follow the arcs of a handle path, as a share of the frame's diagonal.
const ARC_TOLERANCE: f64 = 1e-6;
/// Most control points of a net with handles; more could not be told apart.
const MOST_NODES: usize = 400;

/// The notations of parameters that move control points of nets.
const GRID: &str = "I,J:X,Y";
const TRIANGLE: &str = "I,J,K:X,Y";
/// The notation for adjust values of text shapes.
const ADJUST: &str = "[NAME=]VALUE";

/// Returns the grips of every step, by parameter, with the step's frame.
pub(crate) fn grips(registry: &Registry, resolved: &Recipe, built: &BuiltRecipe) -> Vec<Value> {
    let steps = resolved.steps.iter().zip(&built.frames);
    let steps = steps.map(|(step, frame)| {
        let info = registry.get(&step.deformation).map(|e| e.info());
        let params = info.map_or_else(Map::new, |info| params_grips(info, &step.args, frame));
        json!({ "frame": rect(frame.rect), "params": params })
    });
    steps.collect()
}

/// Returns the grips of a caption in this frame.
pub(crate) fn caption_grips(args: &Args, frame: &Frame) -> Value {
    json!({ "frame": rect(frame.rect), "params": params_grips(&CAPTION, args, frame) })
}

/// Returns a box as x, y, width and height.
pub(crate) fn rect(r: Rect) -> Value {
    json!([r.x0, r.y0, r.width(), r.height()])
}

fn params_grips(info: &Info, args: &Args, frame: &Frame) -> Map<String, Value> {
    let mut out = Map::new();
    // Wrong values have been reported when the step was built.
    let Ok(settings) = Settings::new(info.params, args, frame) else { return out };
    out.extend(info.params.iter().filter_map(|p| Some((p.name.to_owned(), param_grip(info, p, &settings)?))));
    out
}

fn param_grip(info: &Info, p: &Param, s: &Settings<'_>) -> Option<Value> {
    match p.kind {
        Kind::Point if s.given(p.name) || p.default.is_some() => Some(json!({ "point": xy(s.point(p.name).ok()?) })),
        Kind::Path => {
            let paths = s.paths(p.name).ok()?;
            if let ([text], [named]) = (s.texts(p.name).as_slice(), paths.as_slice())
                && ["circle:", "arc:"].iter().any(|word| text.trim_start().starts_with(word))
                && let Some(circle) = circle(&named.outline)
            {
                return Some(json!({ "circle": circle }));
            }
            let diagonal = s.frame().extent(Axis::Diagonal);
            let all: Vec<Value> = paths.iter().map(|named| path(&named.outline, ARC_TOLERANCE * diagonal)).collect();
            (!all.is_empty()).then(|| json!({ "paths": all }))
        }
        Kind::Length(_) | Kind::Number | Kind::Angle | Kind::Count => {
            Some(json!({ "value": s.number_if(p.name).ok()?.filter(|v| v.is_finite())? }))
        }
        Kind::Text("X,Y") => {
            let points = words(s, p).map(|w| s.point_in(p.name, w).map(xy));
            Some(json!({ "points": points.collect::<Result<Vec<_>, _>>().ok()? }))
        }
        Kind::Text("X,Y:X,Y") => {
            let pair = |w: &str| {
                let (from, to) = w.split_once(':')?;
                Some(json!([xy(s.point_in(p.name, from).ok()?), xy(s.point_in(p.name, to).ok()?)]))
            };
            Some(json!({ "pairs": words(s, p).map(pair).collect::<Option<Vec<_>>>()? }))
        }
        Kind::Text("SURFACE" | "SHAPE") => {
            let text = s.texts(p.name).pop()?;
            let size = |w: &str| {
                let (name, value) = w.split_once('=')?;
                Some(json!([name.trim(), s.length_in(p.name, value.trim(), Axis::X).ok()?]))
            };
            let sizes: Vec<Value> = text.split_once(':')?.1.split(',').filter_map(size).collect();
            Some(json!({ "surface": { "text": text, "sizes": sizes } }))
        }
        Kind::Text(ADJUST) => {
            let shape = TextShape::named(s.texts(info.gallery?.presets).last()?)?;
            let described = |(name, range, default): (&str, RangeInclusive<f64>, f64)| json!({ "name": name, "least": range.start(), "most": range.end(), "default": default });
            Some(json!({ "adjust": shape.adjust_values().map(described).collect::<Vec<_>>() }))
        }
        Kind::Text(GRID | TRIANGLE) => {
            let Net { names, points, lines, .. } = net(info, p, s)?;
            let points: Vec<Value> = points.into_iter().map(xy).collect();
            Some(json!({ "net": { "names": names, "points": points, "lines": lines } }))
        }
        _ => None,
    }
}

/// Returns the values of a parameter, which each may hold several words.
fn words<'a>(s: &Settings<'a>, p: &Param) -> impl Iterator<Item = &'a str> {
    s.texts(p.name).into_iter().flat_map(str::split_whitespace)
}

fn xy(p: Point) -> Value {
    json!([p.x, p.y])
}

/// Describes a circle or arc: its centre, radius, and start and end angles in degrees, clockwise on the screen from the right.
fn circle(outline: &Outline) -> Option<[f64; 5]> {
    let [subpath] = outline.subpaths.as_slice() else { return None };
    let arc = |s: &Seg| if let Seg::Arc(arc) = s { Some(*arc) } else { None };
    let arcs = subpath.segs.iter().map(arc).collect::<Option<Vec<_>>>()?;
    let first = arcs.first()?;
    let start = (subpath.start - first.center).atan2().to_degrees();
    // The semi-axes a and b determine the direction of an arc's sweep.
    let sweep: f64 = arcs.iter().map(|a| a.sweep * a.a.cross(a.b).signum()).sum();
    Some([first.center.x, first.center.y, first.a.hypot(), start, start + sweep.to_degrees()])
}

/// Converts a path to subpaths: the start, and then six numbers for a cubic or two for a line.
fn path(outline: &Outline, arc_tolerance: f64) -> Value {
    let subpath = |s: &pathwarp::Subpath| {
        let mut segments: Vec<Value> = Vec::new();
        for seg in &s.segs {
            match seg {
                Seg::Line(l) => segments.push(xy(l.p1)),
                Seg::Arc(arc) => arc.to_cubics(arc_tolerance).for_each(|c| segments.push(cubic(c.p1, c.p2, c.p3))),
                other => {
                    let c = other.to_cubic();
                    segments.push(cubic(c.p1, c.p2, c.p3));
                }
            }
        }
        json!({ "start": xy(s.start), "segments": segments, "closed": s.closed })
    };
    outline.subpaths.iter().map(subpath).collect()
}

fn cubic(a: Point, b: Point, c: Point) -> Value {
    json!([a.x, a.y, b.x, b.y, c.x, c.y])
}

/// Returns path data of an outline, with all digits.
pub(crate) fn path_data(outline: &Outline) -> String {
    let mut out = String::new();
    for s in &outline.subpaths {
        let _ = write!(out, "M{},{} ", s.start.x, s.start.y);
        // `Z` draws the closing line.
        let segs = match s.segs.split_last() {
            Some((Seg::Line(_), rest)) if s.closed => rest,
            _ => &s.segs,
        };
        for seg in segs {
            let _ = match seg {
                Seg::Line(l) => write!(out, "L{},{} ", l.p1.x, l.p1.y),
                other => {
                    let c = other.to_cubic();
                    write!(out, "C{},{} {},{} {},{} ", c.p1.x, c.p1.y, c.p2.x, c.p2.y, c.p3.x, c.p3.y)
                }
            };
        }
        if s.closed {
            out.push_str("Z ");
        }
    }
    out.truncate(out.trim_end().len());
    out
}

/// Returns the net whose control points the parameter `p` moves one by one: their indices as typed, and the rows that they form. The
/// parameters `degree`, `cells`, `spline`, `region`, `reference` and `move` define it, in the deformation's notation.
fn net(info: &Info, p: &Param, s: &Settings<'_>) -> Option<Net> {
    let has = |name: &str| info.params.iter().any(|p| p.name == name);
    // These parameters define control points in other ways.
    if ["lattice", "pin"].iter().any(|name| has(name) && s.given(name)) || !has("degree") {
        return None;
    }
    let mut net = if p.kind == Kind::Text(TRIANGLE) { triangle(s)? } else { grid(s, &has)? };
    let Net { names, points, weights, .. } = &mut net;
    let words_of =
        |name: &str| if has(name) { s.texts(name) } else { Vec::new() }.into_iter().flat_map(str::split_whitespace);
    // Splits `INDICES:VALUE`, and finds the control point.
    let index_and_value = |word: &'_ str| {
        let (name, value) = word.split_once(':')?;
        Some((names.iter().position(|n| n == name.trim())?, value.to_owned()))
    };
    for word in words(s, p) {
        let (i, value) = index_and_value(word)?;
        *points.get_mut(i)? = s.point_in(p.name, &value).ok()?;
    }
    for word in words_of("move") {
        let (i, value) = index_and_value(word)?;
        let (x, y) = value.split_once(',')?;
        let point = points.get_mut(i)?;
        point.x += s.length_in("move", x, Axis::X).ok()?;
        point.y += s.length_in("move", y, Axis::Y).ok()?;
    }
    for word in words_of("weight") {
        let (i, value) = index_and_value(word)?;
        *weights.get_mut(i)? = value.trim().parse().ok()?;
    }
    Some(net)
}

/// Returns the parameter that moves single control points and its net, if the deformation has one.
pub(crate) fn net_of<'a>(info: &'a Info, args: &Args, frame: &Frame) -> Option<(&'a Param, Net)> {
    let p = info.params.iter().find(|p| matches!(p.kind, Kind::Text(GRID | TRIANGLE)))?;
    Some((p, net(info, p, &Settings::new(info.params, args, frame).ok()?)?))
}

/// Returns values for the parameter that moves control points, and for `weight`, with which the net of `new` bends like that of `old`.
pub(crate) fn carried_net_values(
    info: &Info,
    old: &Args,
    new: &Args,
    frame: &Frame,
) -> Option<Vec<(String, Vec<String>)>> {
    let (_, old) = net_of(info, old, frame)?;
    let (p, mut net) = net_of(info, new, frame)?;
    let undistorted = net.points.clone();
    nets::carry_over(&old, &mut net);
    let r = frame.rect;
    let percent =
        |p: Point| format!("{:.6}%,{:.6}%", 100.0 * (p.x - r.x0) / r.width(), 100.0 * (p.y - r.y0) / r.height());
    let points = net.names.iter().zip(net.points.iter().zip(&undistorted)).filter(|(_, (p, rest))| p != rest);
    let points = points.map(|(name, (p, _))| format!("{name}:{}", percent(*p))).collect();
    let weights = net.names.iter().zip(&net.weights).filter(|(_, w)| **w != 1.0);
    let weights = weights.map(|(name, w)| format!("{name}:{w}")).collect();
    Some(vec![(p.name.to_owned(), points), ("weight".to_owned(), weights)])
}

/// Returns the undistorted grid over the region.
fn grid(s: &Settings<'_>, has: &dyn Fn(&str) -> bool) -> Option<Net> {
    let numbers = |name: &str| {
        let text = s.texts(name).last().copied()?;
        let (a, b) = text.split_once(['x', 'X', '×']).unwrap_or((text, text));
        Some([a.trim().parse::<usize>().ok()?, b.trim().parse::<usize>().ok()?])
    };
    let degree = numbers("degree")?;
    let cells = if has("cells") && s.given("cells") {
        numbers("cells")?
    } else if has("spline") && s.flag("spline").ok()? {
        [4, 4]
    } else {
        [1, 1]
    };
    let [columns, rows] = [degree[0].checked_add(cells[0])?, degree[1].checked_add(cells[1])?];
    if degree.contains(&0) || cells.contains(&0) || columns.checked_mul(rows)? > MOST_NODES {
        return None;
    }
    let region = if has("region") { s.rect_if("region").ok()?.unwrap_or(s.frame().rect) } else { s.frame().rect };
    let indices = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    let lattice = Lattice::regular(region, degree, cells);
    let across = (0..rows).map(|j| (0..columns).map(|i| j * columns + i).collect());
    let down = (0..columns).map(|i| (0..rows).map(|j| j * columns + i).collect());
    Some(Net {
        space: Space::Grid { degree, cells },
        names: indices.clone().map(|(i, j)| format!("{i},{j}")).collect(),
        points: indices.map(|(i, j)| lattice.regular_point(i, j)).collect(),
        weights: vec![1.0; columns * rows],
        lines: across.chain(down).collect(),
    })
}

/// Returns the undistorted triangular net: control point i,j,k lies at (iA + jB + kC)/n.
fn triangle(s: &Settings<'_>) -> Option<Net> {
    let n = s.number("degree").ok()? as usize;
    let frame = s.frame().rect;
    let half = frame.width() / 2.0;
    let given = s.texts("reference").pop().map(|text| s.points_in("reference", text));
    let corners = match given.transpose().ok()? {
        Some(corners) => corners,
        // The deformation's default: about the frame, twice as wide and high.
        None => vec![
            Point::new(frame.center().x, frame.y0 - frame.height()),
            Point::new(frame.x0 - half, frame.y1),
            Point::new(frame.x1 + half, frame.y1),
        ],
    };
    let [a, b, c] = corners.as_slice() else { return None };
    if n == 0 || n > MOST_NODES {
        return None;
    }
    let indices: Vec<[usize; 3]> = nets::indices(n).collect();
    let point = |[i, j, k]: &[usize; 3]| {
        let sum = a.to_vec2() * *i as f64 + b.to_vec2() * *j as f64 + c.to_vec2() * *k as f64;
        (sum / n as f64).to_point()
    };
    // Lines along each side: points with equal index of the opposite corner.
    let line = |axis: usize, m: usize| (0..indices.len()).filter(|p| indices[*p][axis] == m).collect::<Vec<_>>();
    let lines = (0..3).flat_map(|axis| (0..n).map(move |m| (axis, m))).map(|(axis, m)| line(axis, m));
    Some(Net {
        space: Space::Triangle(n),
        weights: vec![1.0; indices.len()],
        names: indices.iter().map(|[i, j, k]| format!("{i},{j},{k}")).collect(),
        points: indices.iter().map(point).collect(),
        lines: lines.collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::map::Map as _;
    use pathwarp::recipe::Step;

    fn of(name: &str, pairs: &[(&str, &str)]) -> Map<String, Value> {
        let frame = Frame::new(Rect::new(0.0, 0.0, 90.0, 60.0));
        params_grips(Registry::builtin().get(name).unwrap().info(), &Args::from_pairs(pairs), &frame)
    }

    #[test]
    fn kinds_and_notations_say_which_handles_there_are() {
        let target = &of("projective", &[("target", "0%,100% 100%,100% 80,0 0,0")])["target"]["paths"][0][0];
        assert_eq!(target["start"], json!([0.0, 60.0]));
        assert_eq!(target["segments"], json!([[90.0, 60.0], [80.0, 0.0], [0.0, 0.0]]));
        let shaper = &of("shaper", &[("shaper", "M0,60 Q45,60 90,60 L90,0 H0 Z")])["shaper"]["paths"][0][0];
        assert_eq!(
            (&shaper["segments"][0], &shaper["closed"]),
            (&json!([30.0, 60.0, 60.0, 60.0, 90.0, 60.0]), &json!(true))
        );
        let mls = of("mls", &[("pin", "10,20"), ("pair", "50%,50%:50,40")]);
        assert_eq!(mls["pin"]["points"], json!([[10.0, 20.0]]));
        assert_eq!(mls["pair"]["pairs"], json!([[[45.0, 30.0], [50.0, 40.0]]]));
        assert_eq!(of("swirl", &[])["center"]["point"], json!([45.0, 30.0]));
        let cone = &of("anamorph", &[("onto", "cone:top-radius=20%,bottom-diameter=9,height=3,inside")])["onto"];
        assert_eq!(cone["surface"]["sizes"], json!([["top-radius", 18.0], ["bottom-diameter", 9.0], ["height", 3.0]]));
    }

    #[test]
    fn nets_stand_where_they_are_moved_to() {
        let net = &of("ffd", &[("degree", "3x2"), ("move", "1,0:5,10%"), ("at", "0,2:-1,60")])["at"]["net"];
        assert_eq!((&net["names"][5], net["points"].as_array().unwrap().len()), (&json!("1,1"), 12));
        assert_eq!((&net["points"][1], &net["points"][8]), (&json!([35.0, 6.0]), &json!([-1.0, 60.0])));
        let triangle = &of("triangle", &[("reference", "0,0 90,0 0,60"), ("at", "1,1,0:40,-9")])["at"]["net"];
        let at = |name: &str| {
            let names = triangle["names"].as_array().unwrap();
            &triangle["points"][names.iter().position(|n| n == name).unwrap()]
        };
        assert_eq!(
            (at("2,0,0"), at("0,1,1"), at("1,1,0")),
            (&json!([0.0, 0.0]), &json!([45.0, 30.0]), &json!([40.0, -9.0]))
        );
        // A clamped quadratic B-spline of two cells: knots 0 0 0 ½ 1 1 1.
        let net = &of("ffd", &[("degree", "2x1"), ("spline", "true"), ("cells", "2x1")])["at"]["net"];
        let places: Vec<f64> = (0..4).map(|i| net["points"][i][0].as_f64().unwrap() / 90.0).collect();
        assert_eq!(places, [0.0, 0.25, 0.75, 1.0]);
    }

    const FRAME: Rect = Rect::new(20.0, 30.0, 684.0, 230.0);

    fn built(name: &str, args: &Args) -> BuiltRecipe {
        let art = Outline::from_svg("M20,30 H684 V230 H20 Z").unwrap();
        let recipe = Recipe { steps: vec![Step::new(name, args.clone())] };
        recipe.build(&Registry::builtin(), Frame::new(FRAME), &std::iter::once(&art)).unwrap()
    }

    /// The largest distance between a deformation and the one to which its net was carried over.
    fn apart(name: &str, before: &[(&str, &str)], after: &[(&str, &str)]) -> f64 {
        let registry = Registry::builtin();
        let info = registry.get(name).unwrap().info();
        let (old, mut new) = (Args::from_pairs(before), Args::from_pairs(after));
        let values = carried_net_values(info, &old, &new, &Frame::new(FRAME)).unwrap();
        for (name, values) in values {
            new.set(&name, values);
        }
        assert!(net_of(info, &new, &Frame::new(FRAME)).is_some());
        let (a, b) = (built(name, &old), built(name, &new));
        let at = |k: u32| Point::new(20.0 + 83.0 * f64::from(k % 9), 30.0 + 25.0 * f64::from(k / 9));
        (0..81).map(|k| a.map.point(at(k)).distance(b.map.point(at(k)))).fold(0.0, f64::max)
    }

    #[test]
    fn more_control_points_change_nothing() {
        let moved = ("at", "1,0:30%,-50% 0,1:-20%,40% 1,1:80%,10%");
        let grid = |before: &[(&str, &str)], after: &[(&str, &str)]| apart("ffd", &[before, &[moved]].concat(), after);
        assert!(grid(&[("degree", "2x1")], &[("degree", "5x3")]) < 1e-4);
        assert!(grid(&[("degree", "2x2"), ("weight", "1,1:4")], &[("degree", "3x4")]) < 1e-4);
        assert!(grid(&[("degree", "2x2"), ("cells", "2x3")], &[("degree", "2x2"), ("cells", "4x3")]) < 1e-4);
        assert!(grid(&[("degree", "3x3")], &[("degree", "3x3"), ("spline", "true")]) < 1e-4);
        let triangle = [("at", "1,1,0:20%,10%"), ("move", "0,1,1:0,60%"), ("weight", "1,0,1:3")];
        assert!(apart("triangle", &triangle, &[("degree", "4")]) < 1e-4);
    }

    /// The line that is nearest to a symmetric arch is level.
    #[test]
    fn fewer_control_points_stay_near() {
        let arch = [("degree", "2x1"), ("move", "1,0:0,-60 1,1:0,-60")];
        // The arch is 60·2t(1 − t) high, 20 in the mean: a level line is 20 off at its ends and 10 in the middle.
        let off = apart("ffd", &arch, &[("degree", "1x1")]);
        assert!((off - 20.0).abs() < 1.5, "{off}");
    }
}
