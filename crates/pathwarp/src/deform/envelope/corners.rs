//! A closed path divided into four sides, by corners and a bottom that are given or found; or sides drawn one by one: two facing curves,
//! three, four, or one with a height.
//!
//! Four corners are chosen by the distortion of the patch between them, to which corners at points that are not sharp add a cost.

use super::distortion::{distortion, turning_cost};
use super::fit::{Corners, Ring, SAMPLES, SIDES, bounds, double_area, mirrored, part, reversed};
use crate::anchors;
use crate::error::{Error, show};
use crate::map::Jet;
use crate::outline::{Seg, Subpath};
use crate::param::NamedPath;
use kurbo::{Affine, CubicBez, Line, Point, Rect, Vec2};
use std::collections::BTreeSet;

/// Least angle, in degrees, at which a node is sharp.
const MIN_TURN: f64 = 20.0;
/// The cost of a corner on a smooth curve, in units of [`distortion`].
const SMOOTH_COST: f64 = 0.1;
/// The additional cost if a sharp node is near.
const NEAR_SHARP_COST: f64 = 0.2;
/// Distance within which a sharp node is near, as a share of the box.
const NEAR: f64 = 0.15;
/// Limit on sharp nodes considered as corners.
const MAX_SHARP: usize = 14;
/// Choices of corners whose cost exceeds the least by no more than this are rivals.
const RIVAL_MARGIN: f64 = 0.03;
/// Distance beyond which two corners are different, as a share of the box.
const DIFFERENT: f64 = 0.1;
/// Limit on a path's pieces: every joint is a crease of the map.
const MAX_PIECES: usize = 2000;
/// Distance at which the ends of curves still meet, as a share of the size of all curves.
const MEET: f64 = 1e-4;

/// A location on a path: the index of a piece, and a parameter.
type Location = (usize, f64);

/// Returns the closed subpath of a path, if it encloses an area.
pub(super) fn closed_path(path: &NamedPath) -> Result<Subpath, Error> {
    let sub = anchors::closed_subpath(path, "a single closed run of them", |lines| lines >= 2)?;
    if sub.segs.len() > MAX_PIECES {
        let problem = format!("has {} pieces; the limit is {MAX_PIECES}: simplify it", sub.segs.len());
        return Err(Error::usage("envelope", path.name.clone(), problem));
    }
    let bounds = bounds(&sub);
    if !(bounds.width() > 0.0 && bounds.height() > 0.0) {
        return Err(Error::usage("envelope", path.name.clone(), "is flat: it encloses nothing"));
    }
    Ok(sub)
}

/// Divides a closed path into four sides. Corners and bottom are found unless given. Only `reverse` mirrors the artwork.
pub(super) fn ring(
    name: &str,
    sub: &Subpath,
    corners: Option<&Corners>,
    bottom_side: Option<usize>,
    reverse: bool,
    samples: &[Point],
) -> Result<Ring, Error> {
    let bounds = bounds(sub);
    let FoundCorners { corners: locations, how, rival } = match corners {
        Some(corners) => FoundCorners { corners: given_corners(sub, corners, bounds)?, how: "as given", rival: None },
        None => find_corners(name, sub, bounds, samples)?,
    };
    let drawn = divide(&sub.segs, locations);
    let area: f64 = drawn.iter().flatten().map(double_area).sum();
    // With y down, bottom → right → top → left is counter-clockwise on the screen.
    let backwards = area > 0.0;
    let order = if backwards { [3, 2, 1, 0] } else { [0, 1, 2, 3] };
    let sides = order.map(|i| if backwards { reversed(&drawn[i]) } else { drawn[i].clone() });
    let bottom = match bottom_side {
        Some(n) => order.iter().position(|i| *i + 1 == n).unwrap_or(0),
        None => lowest(&sides),
    };
    let mut sides: [Vec<Seg>; 4] = std::array::from_fn(|i| sides[(bottom + i) % 4].clone());
    let corners = sides.iter().filter_map(|s| s.first()).map(|s| show(s.start())).collect::<Vec<_>>().join(" ");
    let (number, way) = (order[bottom] + 1, if backwards { "backwards" } else { "forwards" });
    let mut notes = vec![
        format!("corners of {name} ({how}): {corners} (bottom left, bottom right, top right, top left)"),
        format!(
            "bottom side: side {number} as drawn, run {way}, so that nothing is mirrored; `bottom-side` and `reverse` override that"
        ),
    ];
    if reverse {
        sides = mirrored(sides);
        notes.push("reverse: the bottom side runs the other way, so that the result is mirrored".into());
    }
    let doubt = |rival| {
        format!(
            "envelope: the corners of {name} are in doubt: `--corners '{rival}'` would do as well, or `--keep verticals`"
        )
    };
    Ok(Ring { sides, notes, warnings: rival.map(doubt).into_iter().collect() })
}

/// Returns the lowest side on the screen among those that run to the right.
fn lowest(sides: &[Vec<Seg>; 4]) -> usize {
    let mean_y = |side: &[Seg]| {
        let parameters = (0..SAMPLES).map(|i| (f64::from(i) + 0.5) / f64::from(SAMPLES));
        let samples = side.iter().flat_map(|s| parameters.clone().map(move |t| (s, t)));
        let (sum, length) = samples.fold((0.0, 0.0), |(sum, length), (s, t)| {
            let speed = s.deriv(t).hypot();
            (sum + speed * s.eval(t).y, length + speed)
        });
        sum / length
    };
    let to_the_right = |side: &[Seg]| side.first().zip(side.last()).is_some_and(|(a, b)| b.end().x > a.start().x);
    // The first of equal sides is taken; tiny differences are rounding.
    let mut lowest: Option<(usize, f64)> = None;
    for (i, side) in sides.iter().enumerate().filter(|(_, s)| to_the_right(s)) {
        let y = mean_y(side);
        if lowest.is_none_or(|(_, most)| y > most + 1e-9 * (y.abs() + most.abs())) {
            lowest = Some((i, y));
        }
    }
    lowest.map_or(0, |(i, _)| i)
}

/// Cuts the path at its corners.
fn divide(segs: &[Seg], locations: [Location; 4]) -> [Vec<Seg>; 4] {
    std::array::from_fn(|i| {
        let ((mut piece, mut start), (last, end)) = (locations[i], locations[(i + 1) % 4]);
        let mut out = Vec::new();
        // The loop goes around the path at most once.
        for _ in 0..=segs.len() {
            if piece == last && end > start {
                out.push(part(&segs[piece], start, end));
                break;
            }
            out.push(part(&segs[piece], start, 1.0));
            (piece, start) = ((piece + 1) % segs.len(), 0.0);
            if piece == last && end == 0.0 {
                break;
            }
        }
        // Rounding must leave no gap to the next part.
        let next = segs[last].eval(end);
        if let Some(last) = out.last_mut() {
            *last = anchors::ending_at(last, next);
        }
        out
    })
}

/// Returns the locations of given corners.
fn given_corners(sub: &Subpath, corners: &Corners, bounds: Rect) -> Result<[Location; 4], Error> {
    let (mut locations, text) = match corners {
        Corners::Nodes(nodes) => {
            let text = nodes.map(|n| n.to_string()).join(",");
            let count = sub.segs.len();
            if let Some(bad) = nodes.iter().find(|n| !(1..=count).contains(n)) {
                let problem = format!("names node {bad}, which the path lacks: it has nodes 1 to {count}");
                return Err(Error::usage("corners", text, problem));
            }
            (nodes.map(|n| (n - 1, 0.0)), text)
        }
        Corners::Points(points) => {
            let text = points.map(show).join(" ");
            (points.map(|p| nearest_location(sub, p, Vec2::new(1.0, 1.0), bounds)), text)
        }
    };
    locations.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    if locations.windows(2).any(|w| w[0] == w[1]) {
        return Err(Error::usage("corners", text, "names one point of the path twice; four different ones are needed"));
    }
    Ok(locations)
}

/// Finds four corners. If a path has just four nodes, one in each quarter of its box, it is those. Otherwise the candidates are sharp
/// nodes and, for each quarter of the box without one, the point of the path nearest to its corner; the four that distort least win.
/// `samples` are points of the artwork, in the unit square.
fn find_corners(name: &str, sub: &Subpath, bounds: Rect, samples: &[Point]) -> Result<FoundCorners, Error> {
    let n = sub.segs.len();
    let node = |i: usize| sub.segs[i].start();
    let quarters: BTreeSet<_> = (0..n).filter_map(|i| quarter(node(i), bounds)).collect();
    // Four nodes are meant as corners, unless they are the extremes of a circle.
    if n == 4 && quarters.len() == 4 {
        return Ok(FoundCorners { corners: [0, 1, 2, 3].map(|i| (i, 0.0)), how: "its four nodes", rival: None });
    }
    let mut sharp: Vec<usize> = (0..n).filter(|&i| turn_at(sub, i).abs() >= MIN_TURN).collect();
    sharp.sort_by(|a, b| turn_at(sub, *b).abs().total_cmp(&turn_at(sub, *a).abs()).then(a.cmp(b)));
    sharp.truncate(MAX_SHARP);
    // A tip between two quarters without sharp nodes, as of a heart, is the middle of a side. Four such tips, as of a diamond, are corners.
    let sharp_quarters: Vec<_> = sharp.iter().filter_map(|i| quarter(node(*i), bounds)).collect();
    let neighbours = |p: Point| {
        let (centre, d) = (bounds.center(), 0.25 * bounds.size().to_vec2());
        let v = p - centre;
        let is_beside = v.x.abs() / bounds.width() > v.y.abs() / bounds.height();
        let side = if is_beside { Vec2::new(d.x.copysign(v.x), 0.0) } else { Vec2::new(0.0, d.y.copysign(v.y)) };
        let across = if is_beside { Vec2::new(0.0, d.y) } else { Vec2::new(d.x, 0.0) };
        [1.0, -1.0].map(|s| quarter(centre + side + across * s, bounds))
    };
    let is_tip = |i: &usize| {
        let p = node(*i);
        quarter(p, bounds).is_none() && neighbours(p).into_iter().flatten().all(|q| !sharp_quarters.contains(&q))
    };
    if sharp.iter().filter(|i| is_tip(i)).count() < 4 {
        sharp.retain(|i| !is_tip(i));
    }
    let share = |v: Vec2| Vec2::new(v.x / bounds.width(), v.y / bounds.height());
    // Locations and their costs.
    let mut candidates: Vec<(Location, f64)> = sharp.iter().map(|i| ((*i, 0.0), 0.0)).collect();
    let nodes: Vec<Point> = sharp.iter().map(|i| node(*i)).collect();
    let corners = [(bounds.x0, bounds.y1), (bounds.x1, bounds.y1), (bounds.x1, bounds.y0), (bounds.x0, bounds.y0)];
    for c in corners.map(Point::from) {
        if nodes.iter().any(|p| quarter(*p, bounds) == quarter(c, bounds)) {
            continue;
        }
        let location = nearest_location(sub, c, Vec2::new(1.0 / bounds.width(), 1.0 / bounds.height()), bounds);
        let here = sub.segs[location.0].eval(location.1);
        let distance = nodes.iter().map(|p| share(*p - here).hypot()).fold(1.0, f64::min);
        candidates.push((location, SMOOTH_COST + NEAR_SHARP_COST * (1.0 - distance / NEAR).max(0.0)));
    }
    candidates.sort_by(|a, b| a.0.0.cmp(&b.0.0).then(a.0.1.total_cmp(&b.0.1)));
    candidates.dedup_by(|a, b| a.0 == b.0);
    let flat = FlatPath::new(sub);
    let lengths: Vec<f64> = candidates.iter().map(|c| flat.length_at(c.0)).collect();
    let mut scored: Vec<(f64, [usize; 4])> = Vec::new();
    let m = candidates.len();
    for (a, b) in (0..m).flat_map(|a| (a + 1..m).map(move |b| (a, b))) {
        for (c, d) in (b + 1..m).flat_map(|c| (c + 1..m).map(move |d| (c, d))) {
            let four = [a, b, c, d];
            let cost: f64 = four.iter().map(|i| candidates[*i].1).sum();
            scored.extend(flat.distortion(four.map(|i| lengths[i]), samples).map(|s| (s + cost, four)));
        }
    }
    scored.sort_by(|a, b| a.0.total_cmp(&b.0));
    let count = sharp.len();
    let undetermined = || {
        format!(
            "has {count} corners by angle, and its box does not determine them: give `corners` (four node numbers, or four points)"
        )
    };
    let (score, best) = scored.first().ok_or_else(|| Error::usage("envelope", name, undetermined()))?;
    let smooth = best.iter().filter(|i| candidates[**i].1 > 0.0).count();
    let point = |i: usize| sub.segs[candidates[i].0.0].eval(candidates[i].0.1);
    let differs =
        |four: &[usize; 4]| four.iter().any(|i| best.iter().all(|j| share(point(*i) - point(*j)).hypot() > DIFFERENT));
    let rival = scored.iter().skip(1).find(|s| differs(&s.1)).filter(|s| s.0 <= score + RIVAL_MARGIN);
    Ok(FoundCorners {
        corners: best.map(|i| candidates[i].0),
        how: match smooth {
            0 => "found by angle, the least distortion",
            4 => "the points nearest to the corners of its box",
            _ => "found by angle, the others nearest to the corners of its box",
        },
        rival: rival.map(|s| s.1.map(|i| show(point(i))).join(" ")),
    })
}

/// The result of a search for corners.
struct FoundCorners {
    corners: [Location; 4],
    /// The reason for the choice, for a note.
    how: &'static str,
    /// Other corners that are hardly worse, for a message.
    rival: Option<String>,
}

/// A closed path as lines, with the length from its start to every point.
struct FlatPath {
    points: Vec<Point>,
    lengths: Vec<f64>,
}

/// Number of lines per piece.
const LINES_PER_PIECE: u32 = 16;

impl FlatPath {
    fn new(sub: &Subpath) -> Self {
        let parameters = (0..LINES_PER_PIECE).map(|i| f64::from(i) / f64::from(LINES_PER_PIECE));
        let mut points: Vec<Point> = sub.segs.iter().flat_map(|s| parameters.clone().map(|t| s.eval(t))).collect();
        points.push(points[0]);
        let mut lengths = vec![0.0];
        for w in points.windows(2) {
            lengths.push(lengths[lengths.len() - 1] + w[0].distance(w[1]));
        }
        Self { points, lengths }
    }

    fn length_at(&self, (i, t): Location) -> f64 {
        let lines = f64::from(LINES_PER_PIECE) * (i as f64 + t);
        let k = (lines as usize).min(self.points.len() - 2);
        self.lengths[k] + (lines - k as f64) * (self.lengths[k + 1] - self.lengths[k])
    }

    fn length(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// Returns the point at a length from the start, which may lead around the path more than once.
    fn point_at(&self, length: f64) -> Point {
        let length = length.rem_euclid(self.length());
        let k = self.lengths.partition_point(|l| *l <= length).clamp(1, self.points.len() - 1);
        let (a, b) = (self.lengths[k - 1], self.lengths[k]);
        self.points[k - 1].lerp(self.points[k], if b > a { (length - a) / (b - a) } else { 0.0 })
    }

    /// Returns the distortion of the patch between corners at these lengths, at `samples` of the unit square; `None` if a side is short.
    fn distortion(&self, corners: [f64; 4], samples: &[Point]) -> Option<f64> {
        /// The least length of a side, as a share of the path's.
        const SHORTEST: f64 = 0.01;
        /// The step of the central differences that stand for derivatives.
        const STEP: f64 = 0.05;
        let area: f64 = self.points.windows(2).map(|w| w[0].to_vec2().cross(w[1].to_vec2())).sum();
        let ends: [[f64; 2]; 4] =
            std::array::from_fn(|i| [corners[i], if i < 3 { corners[i + 1] } else { corners[0] + self.length() }]);
        if ends.iter().any(|e| e[1] - e[0] < SHORTEST * self.length()) {
            return None;
        }
        let order = if area > 0.0 { [3, 2, 1, 0] } else { [0, 1, 2, 3] };
        let sides = order.map(|i| if area > 0.0 { [ends[i][1], ends[i][0]] } else { ends[i] });
        let point = |side: [f64; 2], t: f64| self.point_at(side[0] + t * (side[1] - side[0]));
        let sum_of_y = |s: [f64; 2]| (0..8).map(|i| point(s, (f64::from(i) + 0.5) / 8.0).y).sum::<f64>();
        let bottom = (0..4)
            .filter(|i| point(sides[*i], 1.0).x > point(sides[*i], 0.0).x)
            .reduce(|a, b| if sum_of_y(sides[b]) > sum_of_y(sides[a]) + 1e-9 * self.length() { b } else { a })?;
        let [b, r, t, l]: [[f64; 2]; 4] = std::array::from_fn(|i| sides[(bottom + i) % 4]);
        // Bottom left, bottom right, top left, top right.
        let p = [point(b, 0.0), point(b, 1.0), point(t, 1.0), point(t, 0.0)];
        let patch = |u: f64, v: f64| {
            let (b, t) = (point(b, u).to_vec2(), point(t, 1.0 - u).to_vec2());
            let (l, r) = (point(l, 1.0 - v).to_vec2(), point(r, v).to_vec2());
            let corner = p[0].lerp(p[1], u).to_vec2() * (1.0 - v) + p[2].lerp(p[3], u).to_vec2() * v;
            b * (1.0 - v) + t * v + l * (1.0 - u) + r * u - corner
        };
        let jet = |q: &Point| {
            let (u, v) = (q.x.clamp(STEP, 1.0 - STEP), q.y.clamp(STEP, 1.0 - STEP));
            let dx = (patch(u + STEP, v) - patch(u - STEP, v)) / (2.0 * STEP);
            let dy = (patch(u, v - STEP) - patch(u, v + STEP)) / (2.0 * STEP);
            Jet { p: *q, dx, dy }
        };
        let jets: Vec<Jet> = samples.iter().map(jet).collect();
        Some(distortion(&jets) + turning_cost([p[0], p[1], p[3], p[2]]))
    }
}

/// Returns the quarter of the box that a point lies in; `None` if it is too close to the box's middle lines.
fn quarter(p: Point, bounds: Rect) -> Option<(bool, bool)> {
    /// Least distance from the middle lines, as a share of the box.
    const MIDDLE: f64 = 0.05;
    let (x, y) = ((p.x - bounds.x0) / bounds.width() - 0.5, (p.y - bounds.y0) / bounds.height() - 0.5);
    (x.abs() > MIDDLE && y.abs() > MIDDLE).then_some((x > 0.0, y > 0.0))
}

/// Replaces tails and teeth of a closed path, which lettering leaves free, by straight lines. They stick out with a sharp tip between
/// two notches that are near one another. Returns the tips, too.
pub(super) fn without_tails(sub: &Subpath) -> (Subpath, Vec<Point>) {
    /// The largest area of a tail, as a share of the path's.
    const MAX_AREA: f64 = 0.08;
    /// The least area of a tail, as a share of the square over the notches' distance.
    const MIN_DEPTH: f64 = 0.15;
    let whole: f64 = sub.segs.iter().map(double_area).sum();
    let n = sub.segs.len();
    let notches: Vec<usize> = sharp_nodes(sub, -whole.signum()).collect();
    let tips: Vec<usize> = sharp_nodes(sub, whole.signum()).collect();
    let mut found = Vec::new();
    // For every piece, what takes its place.
    let mut segs: Vec<Option<Seg>> = sub.segs.iter().copied().map(Some).collect();
    for (k, a) in notches.iter().enumerate().filter(|_| notches.len() > 1) {
        let c = notches[(k + 1) % notches.len()];
        let between: Vec<usize> = (0..(c + n - a) % n).map(|i| (a + i) % n).collect();
        let (from, to) = (sub.segs[*a].start(), sub.segs[c].start());
        let chord = Seg::Line(Line::new(to, from));
        let tail = between.iter().map(|i| double_area(&sub.segs[*i])).sum::<f64>() + double_area(&chord);
        let tip = between.iter().skip(1).find(|i| tips.contains(i));
        if let Some(tip) = tip
            && tail * whole > 0.0
            && tail / whole <= MAX_AREA
            && tail.abs() >= MIN_DEPTH * to.distance(from).powi(2)
        {
            found.push(sub.segs[*tip].start());
            between.iter().for_each(|i| segs[*i] = None);
            segs[*a] = Some(chord.reversed());
        }
    }
    let segs: Vec<Seg> = segs.into_iter().flatten().collect();
    (Subpath { start: segs.first().map_or(sub.start, Seg::start), segs, closed: true }, found)
}

/// Returns the nodes at which a path turns sharply outwards. `sign` is the sign of the area that it encloses; the opposite one gives the
/// nodes at which it turns inwards.
pub(super) fn sharp_nodes(sub: &Subpath, sign: f64) -> impl Iterator<Item = usize> {
    (0..sub.segs.len()).filter(move |i| turn_at(sub, *i) * sign >= MIN_TURN)
}

/// Returns the angle by which the path turns at a node, degrees, clockwise on the screen.
fn turn_at(sub: &Subpath, node: usize) -> f64 {
    let n = sub.segs.len();
    let (a, b) = (&sub.segs[(node + n - 1) % n], &sub.segs[node]);
    /// Distance in parameter of the point whose direction counts if the piece has no speed at its end.
    const INSIDE: f64 = 1e-4;
    let direction = |s: &Seg, t: f64, inside: f64| {
        let v = s.deriv(t);
        let size = s.bounding_box();
        if v.hypot() <= 1e-9 * (size.width() + size.height()) { s.deriv(inside) } else { v }
    };
    let (v, w) = (direction(a, 1.0, 1.0 - INSIDE), direction(b, 0.0, INSIDE));
    v.cross(w).atan2(v.dot(w)).to_degrees()
}

/// Returns the location nearest to `c` after scaling both axes: the best sample, refined to a zero of the distance's derivative.
/// The ends of pieces become nodes.
fn nearest_location(sub: &Subpath, c: Point, scale: Vec2, bounds: Rect) -> Location {
    let scaled = |v: Vec2| Vec2::new(v.x * scale.x, v.y * scale.y);
    let from_c = |s: &Seg, t: f64| scaled(s.eval(t) - c);
    let (mut least, mut best) = (f64::INFINITY, (0, 0.0));
    for (i, s) in sub.segs.iter().enumerate() {
        for t in (0..=SAMPLES).map(|k| f64::from(k) / f64::from(SAMPLES)) {
            let square = from_c(s, t).hypot2();
            if square < least {
                (least, best) = (square, (i, t));
            }
        }
    }
    let (i, t) = best;
    let s = &sub.segs[i];
    let step = 1.0 / f64::from(SAMPLES);
    let (mut lo, mut hi) = ((t - step).max(0.0), (t + step).min(1.0));
    let slope = |t: f64| from_c(s, t).dot(scaled(s.deriv(t)));
    // Sixty bisections reduce a unit interval to rounding.
    for _ in 0..60 {
        let middle = 0.5 * (lo + hi);
        *if slope(middle) > 0.0 { &mut hi } else { &mut lo } = middle;
    }
    let t = 0.5 * (lo + hi);
    let is_at = |p: Point| s.eval(t).distance(p) <= 1e-6 * (bounds.width() + bounds.height());
    match (is_at(s.start()), is_at(s.end())) {
        (true, _) => (i, 0.0),
        (_, true) => ((i + 1) % sub.segs.len(), 0.0),
        _ => (i, t),
    }
}

/// The curves of an envelope, and how to complete them.
pub(super) struct Curves<'a> {
    /// Bottom, right, top, left.
    pub(super) drawn: &'a [Option<NamedPath>; 4],
    /// Distance between the only curve drawn and its copy on the facing side.
    pub(super) height: Option<f64>,
    /// The default for `height`.
    pub(super) frame_height: f64,
    /// `true` if missing sides leave the curves at right angles.
    pub(super) square: bool,
    pub(super) reverse: bool,
}

/// Two facing curves, run in the same direction, and the curves drawn between them.
struct FacingCurves {
    /// `true` for bottom and top, run to the right; `false` for left and right, run upwards.
    horizontal: bool,
    first: Vec<Seg>,
    second: Vec<Seg>,
    /// The curves drawn between their starts and between their ends.
    between: [Option<Vec<Seg>>; 2],
}

impl Curves<'_> {
    /// Returns the four sides.
    pub(super) fn ring(&self) -> Result<Ring, Error> {
        let mut notes = Vec::new();
        let FacingCurves { horizontal, first, second, between } = self.facing(&mut notes)?;
        let [a, b, c, d] = [start(&first), end(&first), start(&second), end(&second)];
        let size = [b, c, d].iter().map(|p| p.distance(a)).fold(0.0, f64::max);
        let names = if horizontal { ["left", "right"] } else { ["bottom", "top"] };
        let direction = |c: &[Seg], k: usize| {
            let seg = if k == 0 { c.first() } else { c.last() };
            seg.map_or(Vec2::ZERO, |s| s.deriv(k as f64))
        };
        let join = |k: usize, from: Point, to: Point| match &between[k] {
            Some(curve) => join_ends(names[k], curve.clone(), from, to, size),
            None if self.square => Ok(vec![at_right_angles(from, to, [&first, &second].map(|c| direction(c, k)))]),
            None => Ok(vec![Seg::Line(Line::new(from, to))]),
        };
        let (at_start, at_end) = (join(0, a, c)?, join(1, b, d)?);
        let warnings = self.exchange_warning(horizontal, &first, &second).into_iter().collect();
        let mut sides = if horizontal {
            [first, at_end, reversed(&second), reversed(&at_start)]
        } else {
            [at_start, second, reversed(&at_end), reversed(&first)]
        };
        let area: f64 = sides.iter().flatten().map(double_area).sum();
        if area > 0.0 {
            // The ring is run the other way; the bottom remains the bottom.
            sides = mirrored(sides);
            notes.push("the curves run right to left: the other way they would mirror".into());
        }
        if self.reverse {
            sides = mirrored(sides);
            notes.push("reverse: the curves run the other way, so that the result is mirrored".into());
        }
        let corners = sides.each_ref().map(|s| show(start(s))).join(" ");
        notes.insert(0, format!("corners: {corners} (bottom left, bottom right, top right, top left)"));
        Ok(Ring { sides, notes, warnings })
    }

    /// Returns a warning if two facing curves should be exchanged.
    fn exchange_warning(&self, horizontal: bool, first: &[Seg], second: &[Seg]) -> Option<String> {
        let middle = |c: &[Seg]| {
            let sum = c.iter().map(|s| s.start().to_vec2() + s.end().to_vec2()).fold(Vec2::ZERO, |a, b| a + b);
            sum / (2.0 * c.len().max(1) as f64)
        };
        let (a, b) = (middle(first), middle(second));
        let is_exchanged = if horizontal { b.y > a.y } else { b.x < a.x };
        let what = if horizontal {
            "the top curve lies below the bottom curve, so that the artwork is upside down; exchange `bottom` and `top`"
        } else {
            "the right curve lies left of the left curve, so that the artwork is turned over; exchange `left` and `right`"
        };
        (is_exchanged && !self.reverse).then(|| format!("envelope: {what}"))
    }

    /// Returns the facing curves. A curve drawn alone faces a copy of itself.
    fn facing(&self, notes: &mut Vec<String>) -> Result<FacingCurves, Error> {
        let [bottom, right, top, left] = [0, 1, 2, 3].map(|k| self.curve(k));
        let (mut bottom, right, mut top, left) = (bottom?, right?, top?, left?);
        let given = [&bottom, &right, &top, &left].iter().filter(|c| c.is_some()).count();
        if given == 1 {
            let height = self.height.unwrap_or(self.frame_height);
            let copy = |c: &[Seg], dy: f64| c.iter().map(|s| s.transformed(Affine::translate((0.0, dy)))).collect();
            match (&bottom, &top) {
                (Some(b), None) => top = Some(copy(b, -height)),
                (None, Some(t)) => bottom = Some(copy(t, height)),
                _ => return Err(needs_facing(if left.is_some() { "right" } else { "left" })),
            }
            notes.push(format!("the facing side: the same curve, {height:.6} away"));
        } else if let Some(height) = self.height {
            let problem = "goes with `bottom` or `top` alone: here the facing side is drawn";
            return Err(Error::usage("height", height.to_string(), problem));
        }
        // The corners are the ends of the facing curves.
        match (bottom, top, left, right) {
            (Some(mut a), Some(mut b), left, right) => {
                orient(&mut a, &mut b, |v| v.x);
                Ok(FacingCurves { horizontal: true, first: a, second: b, between: [left, right] })
            }
            (bottom, top, Some(mut a), Some(mut b)) => {
                orient(&mut a, &mut b, |v| -v.y);
                Ok(FacingCurves { horizontal: false, first: a, second: b, between: [bottom, top] })
            }
            (Some(_), ..) => Err(needs_facing("top")),
            _ => Err(needs_facing("bottom")),
        }
    }

    /// Returns curve `k`, one connected open run; `None` if it is not drawn.
    fn curve(&self, k: usize) -> Result<Option<Vec<Seg>>, Error> {
        let Some(path) = &self.drawn[k] else { return Ok(None) };
        let sub = anchors::only_subpath(path, "a single connected run of them")?;
        let problem = match (sub.closed, sub.segs.is_empty()) {
            (true, _) => "is closed: a side is an open curve; for a closed path use `envelope`",
            (_, true) => "is a single point",
            _ => return Ok(Some(sub.segs)),
        };
        Err(Error::usage(SIDES[k], path.name.clone(), problem))
    }
}

fn needs_facing(name: &str) -> Error {
    Error::missing(name, "the curve that faces the given one (or `bottom` or `top` alone, with `height`)")
}

fn start(c: &[Seg]) -> Point {
    c.first().map_or(Point::ORIGIN, Seg::start)
}

fn end(c: &[Seg]) -> Point {
    c.last().map_or(Point::ORIGIN, Seg::end)
}

/// Orients both curves so that the vector from start to end has a positive `component`.
fn orient(a: &mut Vec<Seg>, b: &mut Vec<Seg>, component: impl Fn(Vec2) -> f64) {
    for c in [a, b] {
        if component(end(c) - start(c)) < 0.0 {
            *c = reversed(c);
        }
    }
}

/// Orients a drawn side from one corner to another, and snaps its ends onto them. `size` is that of all curves.
fn join_ends(name: &str, c: Vec<Seg>, from: Point, to: Point, size: f64) -> Result<Vec<Seg>, Error> {
    let back = reversed(&c);
    let gap = |c: &[Seg]| start(c).distance(from).max(end(c).distance(to));
    let mut c = if gap(&back) < gap(&c) { back } else { c };
    let gap = gap(&c);
    if gap > MEET * size {
        let [a, b, from, to] = [start(&c), end(&c), from, to].map(show);
        let problem = format!(
            "does not meet its neighbours: it runs from {a} to {b}, their corners are {from} and {to}, {gap:.6} away"
        );
        return Err(Error::usage(name, "the curve", problem));
    }
    if let Some(last) = c.last_mut() {
        *last = anchors::ending_at(last, to);
    }
    if let Some(first) = c.first_mut() {
        *first = anchors::ending_at(&first.reversed(), from).reversed();
    }
    Ok(c)
}

/// Returns the cubic that leaves one curve and reaches the other, which have the directions `a` and `b` there, at right angles.
fn at_right_angles(from: Point, to: Point, [a, b]: [Vec2; 2]) -> Seg {
    let chord = to - from;
    let handle = |along: Vec2| {
        let n = along.turn_90();
        let n = if n.dot(chord) < 0.0 { -n } else { n };
        if n.hypot() > 0.0 { n * (chord.hypot() / (3.0 * n.hypot())) } else { chord / 3.0 }
    };
    Seg::Cubic(CubicBez::new(from, from + handle(a), to - handle(b), to))
}
