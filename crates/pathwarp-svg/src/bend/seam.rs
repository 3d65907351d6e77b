//! Removes seams: edges of a contour that a map brings together, as a ring joins the ends of a band.

use pathwarp::kurbo::Point;
use pathwarp::map::{Class, Map};
use pathwarp::outline::Subpath;
use pathwarp::{Outline, Seg};

/// Largest distance of coinciding images, as a fraction of their coordinates.
const COINCIDING: f64 = 1e-9;

/// The subpaths of an outline without seams, each with the index of its source subpath. A seam is a pair of segments of a contour that have
/// one image, with the area on either side of it; without them, a band becomes two contours. Open lines whose ends meet in the image are
/// closed. Returns `None` if the map brings nothing together.
pub(super) fn without_seams(outline: &Outline, map: &dyn Map) -> Option<Vec<(usize, Subpath)>> {
    if matches!(map.class(), Class::Affine(_) | Class::Projective(_)) || map.prefers_batches() {
        return None;
    }
    let (mut out, mut changed) = (Vec::new(), false);
    for (i, s) in outline.subpaths.iter().enumerate() {
        let (first, last) = (map.point(s.start), map.point(s.end()));
        if !s.closed {
            let closed = s.start != s.end() && meet(first, last);
            changed |= closed;
            out.push((i, Subpath { closed, ..s.clone() }));
            continue;
        }
        let before = out.len();
        divide(s.segs.clone(), map, &mut |segs: Vec<Seg>| {
            let start = segs.first().map_or(s.start, Seg::start);
            out.push((i, Subpath { start, segs, closed: true }));
        });
        changed |= out.len() != before + 1 || out[before].1.segs.len() != s.segs.len();
    }
    changed.then_some(out)
}

/// Returns `true` if two images coincide.
fn meet(a: Point, b: Point) -> bool {
    a.distance(b) <= COINCIDING * (a.to_vec2().hypot() + b.to_vec2().hypot())
}

/// Divides a contour at its first seam, and the parts at theirs.
fn divide(segs: Vec<Seg>, map: &dyn Map, out: &mut dyn FnMut(Vec<Seg>)) {
    let n = segs.len();
    let images: Vec<Point> = segs.iter().map(|s| map.point(s.start())).collect();
    let mut sorted: Vec<usize> = (0..n).collect();
    sorted.sort_by(|a, b| images[*a].x.total_cmp(&images[*b].x));
    // The segments whose images begin where the image of segment `a` ends.
    let (images, sorted) = (&images, &sorted);
    let after = |a: usize| {
        let q = images[(a + 1) % n];
        let tolerance = 2.0 * COINCIDING * q.to_vec2().hypot();
        let from = sorted.partition_point(|k| images[*k].x < q.x - tolerance);
        sorted[from..].iter().copied().take_while(move |k| images[*k].x <= q.x + tolerance)
    };
    let is_seam = |a: usize, b: usize| {
        let (s, t) = (&segs[a], &segs[b]);
        let (p, q) = (s.eval(0.5), t.eval(0.5));
        meet(images[(a + 1) % n], images[b])
            && meet(images[a], images[(b + 1) % n])
            && !(s.start() == t.end() && s.end() == t.start())
            && meet(map.point(p), map.point(q))
            && !meet(images[a], map.point(p))
            // Both segments of a fold have the area on one side.
            && (map.jet(p).det() * map.jet(q).det()) > 0.0
    };
    let seam = (0..n).find_map(|a| after(a).find(|b| *b > a && is_seam(a, *b)).map(|b| (a, b)));
    let Some((a, b)) = seam else { return out(segs) };
    for part in [[&segs[b + 1..], &segs[..a]].concat(), segs[a + 1..b].to_vec()] {
        // A part that the map takes to a point is dropped.
        if part.iter().any(|s| !meet(map.point(s.start()), map.point(s.eval(0.5)))) {
            divide(part, map, out);
        }
    }
}
