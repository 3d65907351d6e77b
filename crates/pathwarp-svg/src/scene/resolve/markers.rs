//! Finds shapes with markers in usvg's tree, and places the markers as browsers do.

use super::builder::SceneBuilder;
use crate::scene::geometry::{affine, is_near};
use crate::source::elements::{ElementId, is_shape};
use pathwarp::kurbo::{Affine, Point, Vec2};
use pathwarp::{Outline, Seg};
use std::f64::consts::PI;
use usvg::tiny_skia_path::{Path, PathSegment};

/// Finds the children of a group that belong to shapes with markers: the shape and the group of marker instances next to it.
/// Returns their indices with the shape's element. `copy` is the `use` element that the group belongs to.
pub(super) fn marked_children(
    b: &SceneBuilder<'_>,
    g: &usvg::Group,
    copy: Option<ElementId>,
) -> Vec<(usize, ElementId)> {
    let mut out = Vec::new();
    let original = copy.and_then(|e| b.element(b.reader.source.link(e)?.strip_prefix('#')?));
    let shape = |i: usize| match g.children().get(i) {
        Some(usvg::Node::Path(p)) => {
            if copy.is_some() { original } else { b.element(p.id()) }.filter(|&e| is_shape(b.tag(e)))
        }
        _ => None,
    };
    for (i, c) in g.children().iter().enumerate() {
        let usvg::Node::Group(c) = c else { continue };
        let anonymous = c.id().is_empty() && c.transform().is_identity() && c.opacity().get() == 1.0;
        if !anonymous || c.clip_path().is_some() || c.children().is_empty() {
            continue;
        }
        // Each marker instance is a group without an id.
        let instances = c.children().iter().all(|m| matches!(m, usvg::Node::Group(m) if m.id().is_empty()));
        if !instances || b.has_ids(c) {
            continue;
        }
        // Paint order decides on which side of the markers the shape is.
        if let Some((j, e)) = [i.wrapping_sub(1), i + 1].into_iter().find_map(|j| Some((j, shape(j)?))) {
            out.extend([(i, e), (j, e)]);
        }
    }
    out
}

/// Places the markers of shapes as browsers do. usvg orients markers at the ends of a closed subpath as if it were open, and adds markers
/// within arcs. `copy` is the `use` element that the group belongs to, and `marked` what [`marked_children`] found.
pub(super) fn place_markers(
    b: &mut SceneBuilder<'_>,
    g: &usvg::Group,
    copy: Option<ElementId>,
    marked: &[(usize, ElementId)],
) {
    for &(i, e) in marked {
        let Some(usvg::Node::Group(instances)) = g.children().get(i) else { continue };
        let shape = [i.wrapping_sub(1), i + 1].into_iter().find_map(|j| match g.children().get(j) {
            Some(usvg::Node::Path(p)) if marked.contains(&(j, e)) => Some(p),
            _ => None,
        });
        let instances = instances.children().iter();
        let instances = instances.filter_map(|n| if let usvg::Node::Group(g) = n { Some(g.as_ref()) } else { None });
        let instances: Vec<&usvg::Group> = instances.collect();
        if let Some(placed) = shape.and_then(|p| marker_transforms(b, e, p.data(), &instances)) {
            let same = |(m, t): (&&usvg::Group, &Option<Affine>)| t.is_some_and(|t| is_near(t, affine(m.transform())));
            if !instances.iter().zip(&placed).all(same) {
                b.marked.insert(copy.unwrap_or(e));
            }
            b.markers.extend(instances.iter().map(|m| std::ptr::from_ref(*m) as usize).zip(placed));
        }
    }
}

/// The transform of each marker, `None` for markers that browsers do not show. Returns `None` if the markers are not the expected ones.
fn marker_transforms(
    b: &SceneBuilder<'_>,
    e: ElementId,
    data: &Path,
    instances: &[&usvg::Group],
) -> Option<Vec<Option<Affine>>> {
    let outline = b.reader.outline(e)?;
    let steps = steps(&outline, data);
    let (angles, vertices) = (directions(&steps), vertices(&steps, data)?);
    let source = b.reader.source;
    let marker = |name: &str| {
        let value = source.ancestors(e).filter_map(|a| source.property(a, name)).find(|v| v.trim() != "inherit")?;
        let id = value.trim().strip_prefix("url(#")?.split(')').next()?.to_owned();
        b.definition(&id, "marker")
    };
    let last = vertices.len() - 1;
    let middle = (1..last).filter(|k| vertices[*k].0 != Command::Close);
    let kinds = [("marker-start", vec![0]), ("marker-mid", middle.collect()), ("marker-end", vec![last])];
    let expected = kinds.into_iter().filter_map(|(name, at)| Some((marker(name)?, at)));
    let expected: Vec<(ElementId, usize)> = expected.flat_map(|(m, at)| at.into_iter().map(move |k| (m, k))).collect();
    if expected.len() != instances.len() {
        return None;
    }
    let transform = |(&(marker, k), instance): (&(ElementId, usize), &&usvg::Group)| {
        let (_, at, step) = vertices[k];
        let placed = affine(instance.transform());
        let orient = source.attr(marker, "orient");
        let turn = match orient.as_deref().map(str::trim) {
            Some("auto-start-reverse") if k == 0 => PI,
            Some("auto" | "auto-start-reverse") => 0.0,
            _ => return step.map(|_| placed),
        };
        let [x, y, ..] = placed.as_coeffs();
        Some(Affine::rotate_about(angles[step?] + turn - y.atan2(x), at) * placed)
    };
    Some(expected.iter().zip(instances).map(transform).collect())
}

/// A command of path data.
#[derive(Clone, Copy, PartialEq)]
enum Command {
    Move,
    Draw,
    Close,
}

/// The commands of usvg's path with their end points and the index of the step that ends there, which is `None` within an arc. Returns
/// `None` if the path has other steps.
fn vertices(steps: &[Vec<Step<'_>>], data: &Path) -> Option<Vec<(Command, Point, Option<usize>)>> {
    let mut expected = steps.iter().flatten().enumerate().peekable();
    let (mut out, mut start) = (Vec::new(), Point::ZERO);
    for segment in data.segments() {
        let (command, end) = match segment {
            PathSegment::MoveTo(p) => (Command::Move, point(p)),
            PathSegment::LineTo(p) | PathSegment::QuadTo(_, p) | PathSegment::CubicTo(.., p) => {
                (Command::Draw, point(p))
            }
            PathSegment::Close => (Command::Close, start),
        };
        if command == Command::Move {
            start = end;
        }
        let (index, step) = *expected.peek()?;
        let is_reached = step.1.is_none_or(|seg| seg.eval(1.0).distance(end) <= NEAR * (1.0 + end.to_vec2().hypot()));
        if step.0 != command || (!is_reached && !matches!(step.1, Some(Seg::Arc(_)))) {
            return None;
        }
        out.push((command, end, expected.next_if(|_| is_reached).map(|_| index)));
    }
    (expected.next().is_none() && !out.is_empty()).then_some(out)
}

/// Largest relative difference of numbers that are equal up to single precision.
const NEAR: f64 = 1e-5;

fn point(p: usvg::tiny_skia_path::Point) -> Point {
    Point::new(f64::from(p.x), f64::from(p.y))
}

/// A command of path data, and the segment that it draws.
type Step<'a> = (Command, Option<&'a Seg>);

/// The commands of path data by subpath. An outline lacks closing lines without length, which are taken from `data`.
fn steps<'a>(outline: &'a Outline, data: &Path) -> Vec<Vec<Step<'a>>> {
    // For each subpath, `true` if it has come back to its start when it closes, so that closing draws a line without length.
    let mut returned = Vec::new();
    let (mut start, mut last) = (None, None);
    for segment in data.segments() {
        match segment {
            PathSegment::MoveTo(p) => {
                start = Some(p);
                last = start;
                returned.push(false);
            }
            PathSegment::LineTo(p) | PathSegment::QuadTo(_, p) | PathSegment::CubicTo(.., p) => last = Some(p),
            PathSegment::Close => returned.last_mut().into_iter().for_each(|r| *r = last == start),
        }
    }
    let subpaths = outline.subpaths.iter().enumerate();
    let all = subpaths.map(|(k, s)| {
        let mut out = vec![(Command::Move, None)];
        out.extend(s.segs.iter().map(|seg| (Command::Draw, Some(seg))));
        match out.last_mut() {
            Some(closing) if s.closed && !returned.get(k).unwrap_or(&true) => closing.0 = Command::Close,
            _ => out.extend(s.closed.then_some((Command::Close, None))),
        }
        out
    });
    all.collect()
}

/// The direction of a marker at the end of every step (SVG 2, section 13.7.4): the path's direction at open ends, and the bisector of its
/// two directions elsewhere, also where a subpath closes.
fn directions(steps: &[Vec<Step<'_>>]) -> Vec<f64> {
    /// Parameter distance over which to measure the direction at an end, since handles may coincide with their nodes.
    const STEP: f64 = 1e-4;
    let angle = |v: Vec2| v.y.atan2(v.x);
    let bisector = |a: Vec2, b: Vec2| {
        let (a, b) = (angle(a), angle(b));
        // A half turn goes to the left.
        a.midpoint(a + (b - a + PI).rem_euclid(2.0 * PI) - PI)
    };
    let mut out = Vec::new();
    for subpath in steps {
        let ends = subpath[1..].iter().map(|(_, seg)| match seg {
            Some(seg) => [seg.eval(STEP) - seg.eval(0.0), seg.eval(1.0) - seg.eval(1.0 - STEP)],
            None => [Vec2::ZERO; 2],
        });
        let ends: Vec<[Vec2; 2]> = ends.collect();
        let (Some(first), Some(last)) = (ends.first(), ends.last()) else {
            out.push(0.0);
            continue;
        };
        let closed = subpath.last().is_some_and(|s| s.0 == Command::Close);
        // A closing line without length takes the direction in which the subpath begins.
        let or_first = |v: Vec2| if v == Vec2::ZERO { first[0] } else { v };
        let at_start = if closed { bisector(or_first(last[1]), first[0]) } else { angle(first[0]) };
        out.push(at_start);
        out.extend(ends.windows(2).map(|w| bisector(w[0][1], or_first(w[1][0]))));
        out.push(if closed { at_start } else { angle(last[1]) });
    }
    out
}
