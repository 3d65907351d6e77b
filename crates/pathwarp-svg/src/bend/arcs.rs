//! Arcs that stay arcs: under affine maps, and under any other map that takes them to circles, as similitudes and Möbius maps do.

use pathwarp::kurbo::{Point, Vec2};
use pathwarp::map::{Class, Map};
use pathwarp::outline::{EllipticArc, Subpath};
use pathwarp::refit::{self, Assurance, PathReport, Span};
use pathwarp::{GeometryError, Outline, Seg};
use std::f64::consts::PI;
use std::ops::Range;

/// Largest sweep of a written arc. The centre of a longer one depends on its rounded ends too much: without bound at half a turn.
const LONGEST: f64 = 2.0 / 3.0 * PI;

/// Largest distance of an image from its circle, as a fraction of the radius; rounding is below a thousandth of that.
const ROUND: f64 = 1e-10;

/// Largest radius of an image, in lengths of its chord. Flatter ones are better written as curves.
const FLATTEST: f64 = 1e4;

/// The image of an outline in which arcs stay arcs, in root user space. Returns `None` if there are none.
pub(super) fn with_arcs(
    map: &dyn Map,
    outline: &Outline,
    options: &refit::Options,
) -> Result<Option<(Outline, PathReport)>, GeometryError> {
    if !outline.segs().any(|s| matches!(s, Seg::Arc(_))) || !outline.segs().all(Seg::is_finite) {
        return Ok(None);
    }
    let mut report = PathReport::default();
    let image = if let Class::Affine(m) = map.class() {
        outline.transformed(m)
    } else if options.certify {
        // The test for circles is no proof.
        return Ok(None);
    } else {
        if map.prefers_batches() {
            let starts = outline.subpaths.iter().map(|s| s.start);
            map.prepare(&outline.segs().flat_map(on_circle).chain(starts).collect::<Vec<_>>(), &[]);
        }
        let images = |s: &Subpath| s.segs.iter().map(|g| circle_of(g, map)).collect();
        let all: Vec<Vec<Option<EllipticArc>>> = outline.subpaths.iter().map(images).collect();
        if all.iter().flatten().all(Option::is_none) {
            return Ok(None);
        }
        let mut first = 0;
        let subpaths = outline.subpaths.iter().zip(&all).map(|(s, arcs)| {
            let image = subpath((s, first), arcs, map, options, &mut report);
            first += s.segs.len();
            image
        });
        Outline { subpaths: subpaths.collect::<Result<_, _>>()? }
    };
    let image = Outline { subpaths: image.subpaths.into_iter().map(short_arcs).collect() };
    report.segments_in = outline.segs().count();
    report.segments_out = image.segs().count();
    report.account_for_rounding(outline, image.extent(), options.tolerance);
    Ok(Some((image, report)))
}

/// Places compared with the circle.
const SAMPLES: u32 = 24;

/// The places of an arc that are compared with a circle; none of other segments.
fn on_circle(g: &Seg) -> Vec<Point> {
    let Seg::Arc(arc) = g else { return Vec::new() };
    (0..=SAMPLES).map(|i| arc.eval(f64::from(i) / f64::from(SAMPLES))).collect()
}

/// The image of an arc of a circle, if that is one, too.
fn circle_of(g: &Seg, map: &dyn Map) -> Option<EllipticArc> {
    let Seg::Arc(arc) = g else { return None };
    let r = arc.a.hypot();
    if (arc.b.hypot() - r).abs() > ROUND * r || arc.a.dot(arc.b).abs() > ROUND * r * r {
        return None;
    }
    let image = |i: u32| map.point(arc.eval(f64::from(i) / f64::from(SAMPLES)));
    let (first, last) = (image(0), image(SAMPLES));
    let center = center(first, image(SAMPLES / 3), image(2 * SAMPLES / 3))?;
    let radius = first.distance(center);
    if radius > FLATTEST * first.distance(image(SAMPLES / 2)) {
        return None;
    }
    let (mut sweep, mut before) = (0.0, first - center);
    for i in 1..=SAMPLES {
        let v = image(i) - center;
        if (v.hypot() - radius).abs() > ROUND * radius || !v.is_finite() {
            return None;
        }
        let step = before.cross(v).atan2(before.dot(v));
        if step * sweep < 0.0 {
            return None;
        }
        sweep += step;
        before = v;
    }
    let start = (first - center).atan2();
    let (a, b) = (Vec2::new(radius, 0.0), Vec2::new(0.0, radius));
    Some(EllipticArc { p0: first, p1: last, center, a, b, start, sweep })
}

/// Centre of the circle through three points.
fn center(p: Point, q: Point, r: Point) -> Option<Point> {
    let (u, v) = (q - p, r - p);
    let d = 2.0 * u.cross(v);
    let to = Vec2::new(v.y * u.hypot2() - u.y * v.hypot2(), u.x * v.hypot2() - v.x * u.hypot2()) / d;
    (p + to).is_finite().then_some(p + to)
}

/// The image of a subpath with the images of its arcs. What lies between them is refitted. `first` is the index of its first segment in
/// the outline.
fn subpath(
    (s, first): (&Subpath, usize),
    arcs: &[Option<EllipticArc>],
    map: &dyn Map,
    options: &refit::Options,
    report: &mut PathReport,
) -> Result<Subpath, GeometryError> {
    let mut out = Subpath { start: map.point(s.start), segs: Vec::with_capacity(s.segs.len()), closed: s.closed };
    let mut rest = s.segs.iter().zip(arcs).zip(first..).peekable();
    while let Some(((g, arc), from)) = rest.next() {
        if let Some(arc) = arc {
            let p0 = out.end();
            out.segs.push(Seg::Arc(EllipticArc { p0, ..*arc }));
            report.assurance = report.assurance.min(Assurance::Checked);
            report.max_error = report.max_error.max(ROUND * arc.a.hypot());
            continue;
        }
        let mut run = Subpath { start: g.start(), segs: vec![*g], closed: false };
        while let Some(((g, _), _)) = rest.next_if(|((_, arc), _)| arc.is_none()) {
            run.segs.push(*g);
        }
        let options = options.clone().with_spans(within(&options.spans, from..from + run.segs.len()));
        let refitted = refit::warp_path(&Outline { subpaths: vec![run] }, map, &options)?;
        report.add(refitted.report);
        out.segs.extend(Outline::from(&refitted.path).subpaths.into_iter().flat_map(|s| s.segs));
    }
    Ok(out)
}

/// The spans of some of the segments.
fn within(spans: &[Span], segments: Range<usize>) -> Vec<Span> {
    let mut end = 0;
    let each = spans.iter().map(|s| {
        let start = end;
        end += s.segments;
        Span { segments: end.min(segments.end).saturating_sub(start.max(segments.start)), ..*s }
    });
    each.filter(|s| s.segments > 0).collect()
}

/// Divides long arcs.
fn short_arcs(s: Subpath) -> Subpath {
    let divided = |g: Seg| -> Vec<Seg> {
        match g {
            Seg::Arc(a) => {
                let n = (a.sweep.abs() / LONGEST).ceil().max(1.0);
                (0..n as u32).map(|i| Seg::Arc(a.subsegment(f64::from(i) / n, f64::from(i + 1) / n))).collect()
            }
            other => vec![other],
        }
    };
    Subpath { segs: s.segs.into_iter().flat_map(divided).collect(), ..s }
}
