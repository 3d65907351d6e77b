//! A closed path divided into four sides: its corners and its bottom, given or found.

use super::distortion::{distortion, turned};
use super::fit::{Corners, Ring, SAMPLES, SIDES, area, bounds, mirrored, part, reversed};
use crate::anchors;
use crate::error::{Error, show};
use crate::map::Jet;
use crate::outline::{Seg, Subpath};
use crate::param::NamedPath;
use kurbo::{Affine, CubicBez, Line, Point, Rect, Vec2};

/// Least angle, in degrees, at which a joint counts as a corner.
const CORNER: f64 = 20.0;
/// The cost of a corner on a smooth curve, in units of [`distortion`].
const SMOOTH: f64 = 0.1;
/// The additional cost if a sharp node is near.
const NEAR_SHARP: f64 = 0.2;
/// Distance within which a sharp node is near, as a share of the box.
const AROUND: f64 = 0.15;
/// Limit on sharp nodes considered as corners.
const MAX_SHARP: usize = 14;
/// Choices of corners whose cost exceeds the least by no more than this are rivals.
const RIVAL_MARGIN: f64 = 0.03;
/// Distance beyond which two corners are different, as a share of the box.
const DIFFERENT: f64 = 0.1;
/// Limit on a path's pieces: every joint is a crease of the map.
const MAX_PIECES: usize = 2000;
/// A location on a path: the index of a piece, and a parameter.
type Location = (usize, f64);

/// Returns the closed subpath of a path, if it encloses an area.
pub(super) fn closed(path: &NamedPath) -> Result<Subpath, Error> {
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
    places: &[Point],
) -> Result<Ring, Error> {
    let bounds = bounds(sub);
    let FoundCorners { corners: locations, how, rival } = match corners {
        Some(corners) => FoundCorners { corners: given(sub, corners, bounds)?, how: "as given", rival: None },
        None => found(name, sub, bounds, places)?,
    };
    let drawn = cut(&sub.segs, locations);
    let area: f64 = drawn.iter().flatten().map(area).sum();
    // With y down, bottom → right → top → left is counter-clockwise on the screen.
    let backwards = area > 0.0;
    let order = if backwards { [3, 2, 1, 0] } else { [0, 1, 2, 3] };
    let run = |i: usize| -> Vec<Seg> { if backwards { reversed(&drawn[i]) } else { drawn[i].clone() } };
    let sides = order.map(run);
    let bottom = match bottom_side {
        Some(n) => order.iter().position(|i| *i + 1 == n).unwrap_or(0),
        None => lowest(&sides),
    };
    let mut sides: [Vec<Seg>; 4] = std::array::from_fn(|i| sides[(bottom + i) % 4].clone());
    let corners: Vec<String> = sides.iter().filter_map(|s| s.first()).map(|s| show(s.start())).collect();
    let mut notes = vec![
        format!("corners of {name} ({how}): {} (bottom left, bottom right, top right, top left)", corners.join(" ")),
        format!(
            "bottom side: side {} as drawn, run {}, so that nothing is mirrored; `bottom-side` and `reverse` override that",
            order[bottom] + 1,
            if backwards { "backwards" } else { "forwards" }
        ),
    ];
    if reverse {
        sides = mirrored(sides);
        notes.push("reverse: the bottom side runs the other way, so that the result is mirrored".into());
    }
    let doubt = |rival: String| {
        format!(
            "envelope: the corners of {name} are in doubt: `--corners '{rival}'` would do as well, or `--keep verticals`"
        )
    };
    Ok(Ring { sides, notes, warnings: rival.map(doubt).into_iter().collect() })
}

/// Returns the lowest side on the screen among those that run to the right.
fn lowest(sides: &[Vec<Seg>; 4]) -> usize {
    let height = |side: &[Seg]| {
        // The mean height, weighted by length.
        let parts = side
            .iter()
            .flat_map(|s| (0..SAMPLES).map(move |i| (f64::from(i) + 0.5) / f64::from(SAMPLES)).map(move |t| (s, t)));
        let (sum, length) = parts.fold((0.0, 0.0), |(sum, all), (s, t)| {
            let speed = s.deriv(t).hypot();
            (sum + speed * s.eval(t).y, all + speed)
        });
        sum / length
    };
    let to_the_right = |side: &[Seg]| side.first().zip(side.last()).is_some_and(|(a, b)| b.end().x > a.start().x);
    // The first of equal sides is taken; tiny differences are rounding.
    let mut best: Option<(usize, f64)> = None;
    for (i, side) in sides.iter().enumerate().filter(|(_, s)| to_the_right(s)) {
        let here = height(side);
        if best.is_none_or(|(_, b)| here > b + 1e-9 * (here.abs() + b.abs())) {
            best = Some((i, here));
        }
    }
    best.map_or(0, |b| b.0)
}

/// Cuts the path at its corners.
fn cut(segs: &[Seg], locations: [Location; 4]) -> [Vec<Seg>; 4] {
    std::array::from_fn(|i| {
        let ((from, a), (to, b)) = (locations[i], locations[(i + 1) % 4]);
        let mut out = Vec::new();
        let (mut at, mut start) = (from, a);
        // The loop goes around the path at most once.
        for _ in 0..=segs.len() {
            if at == to && b > start {
                out.push(part(&segs[at], start, b));
                break;
            }
            out.push(part(&segs[at], start, 1.0));
            (at, start) = ((at + 1) % segs.len(), 0.0);
            if at == to && b == 0.0 {
                break;
            }
        }
        // Rounding must leave no gap to the next part.
        let next = segs[to].eval(b);
        if let Some(last) = out.last_mut() {
            *last = anchors::ending_at(last, next);
        }
        out
    })
}

/// Returns the locations of given corners.
fn given(sub: &Subpath, corners: &Corners, bounds: Rect) -> Result<[Location; 4], Error> {
    let (mut locations, text) = match corners {
        Corners::Nodes(nodes) => {
            let text = nodes.map(|n| n.to_string()).join(",");
            let count = sub.segs.len();
            if let Some(bad) = nodes.iter().find(|n| !(1..=count).contains(n)) {
                let problem = format!("has node {bad}, which is not there: the path has nodes 1 to {count}");
                return Err(Error::usage("corners", text, problem));
            }
            (nodes.map(|n| (n - 1, 0.0)), text)
        }
        Corners::Points(points) => {
            let text = points.map(show).join(" ");
            (points.map(|p| nearest(sub, p, Vec2::new(1.0, 1.0), bounds)), text)
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
/// `places` are points of the artwork, in the unit square.
fn found(name: &str, sub: &Subpath, bounds: Rect, places: &[Point]) -> Result<FoundCorners, Error> {
    let n = sub.segs.len();
    let mut sharp: Vec<usize> = (0..n).filter(|&i| turn(sub, i).abs() >= CORNER).collect();
    let mut seen: Vec<_> = (0..n).filter_map(|i| quarter(sub.segs[i].start(), bounds)).collect();
    seen.sort_unstable();
    seen.dedup();
    // Four nodes are meant as corners, unless they are the extremes of a circle.
    if n == 4 && seen.len() == 4 {
        return Ok(FoundCorners { corners: [0, 1, 2, 3].map(|i| (i, 0.0)), how: "its four nodes", rival: None });
    }
    sharp.sort_by(|a, b| turn(sub, *b).abs().total_cmp(&turn(sub, *a).abs()).then(a.cmp(b)));
    sharp.truncate(MAX_SHARP);
    // A tip between two quarters without sharp nodes, as of a heart, is the middle of a side. Four such tips, as of a diamond, are corners.
    let held: Vec<_> = sharp.iter().filter_map(|i| quarter(sub.segs[*i].start(), bounds)).collect();
    let beside = |p: Point| {
        let (to, d) = (bounds.center(), 0.25 * bounds.size().to_vec2());
        let lies = (p.x - to.x).abs() / bounds.width() > (p.y - to.y).abs() / bounds.height();
        let side =
            if lies { Vec2::new(d.x.copysign(p.x - to.x), 0.0) } else { Vec2::new(0.0, d.y.copysign(p.y - to.y)) };
        let across = if lies { Vec2::new(0.0, d.y) } else { Vec2::new(d.x, 0.0) };
        [1.0, -1.0].map(|s| quarter(to + side + across * s, bounds))
    };
    let lone = |i: &usize| {
        let p = sub.segs[*i].start();
        quarter(p, bounds).is_none() && beside(p).into_iter().flatten().all(|q| !held.contains(&q))
    };
    if sharp.iter().filter(|i| lone(i)).count() < 4 {
        sharp.retain(|i| !lone(i));
    }
    let share = |v: Vec2| Vec2::new(v.x / bounds.width(), v.y / bounds.height());
    let mut candidates: Vec<(Location, f64)> = sharp.iter().map(|i| ((*i, 0.0), 0.0)).collect();
    let nodes: Vec<Point> = sharp.iter().map(|i| sub.segs[*i].start()).collect();
    for c in [(bounds.x0, bounds.y1), (bounds.x1, bounds.y1), (bounds.x1, bounds.y0), (bounds.x0, bounds.y0)] {
        let c = Point::from(c);
        if nodes.iter().any(|p| quarter(*p, bounds) == quarter(c, bounds)) {
            continue;
        }
        let location = nearest(sub, c, Vec2::new(1.0 / bounds.width(), 1.0 / bounds.height()), bounds);
        let here = sub.segs[location.0].eval(location.1);
        let off = nodes.iter().map(|p| share(*p - here).hypot()).fold(1.0, f64::min);
        candidates.push((location, SMOOTH + NEAR_SHARP * (1.0 - off / AROUND).max(0.0)));
    }
    candidates.sort_by(|a, b| a.0.0.cmp(&b.0.0).then(a.0.1.total_cmp(&b.0.1)));
    candidates.dedup_by(|a, b| a.0 == b.0);
    let flat = FlatPath::new(sub);
    let at: Vec<f64> = candidates.iter().map(|c| flat.length_at(c.0)).collect();
    let mut scored: Vec<(f64, [usize; 4])> = Vec::new();
    let m = candidates.len();
    for (a, b) in (0..m).flat_map(|a| (a + 1..m).map(move |b| (a, b))) {
        for (c, d) in (b + 1..m).flat_map(|c| (c + 1..m).map(move |d| (c, d))) {
            let four = [a, b, c, d];
            let cost: f64 = four.iter().map(|i| candidates[*i].1).sum();
            scored.extend(flat.distortion(four.map(|i| at[i]), places).map(|s| (s + cost, four)));
        }
    }
    scored.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some((score, best)) = scored.first() else {
        let problem = format!(
            "has {} corners by angle, and its box does not determine them: give `corners` (four node numbers, or four points)",
            sharp.len()
        );
        return Err(Error::usage("envelope", name, problem));
    };
    let smooth = best.iter().filter(|i| candidates[**i].1 > 0.0).count();
    let place = |i: usize| sub.segs[candidates[i].0.0].eval(candidates[i].0.1);
    let differs =
        |four: &[usize; 4]| four.iter().any(|i| best.iter().all(|j| share(place(*i) - place(*j)).hypot() > DIFFERENT));
    let rival = scored.iter().skip(1).find(|s| differs(&s.1)).filter(|s| s.0 <= score + RIVAL_MARGIN);
    Ok(FoundCorners {
        corners: best.map(|i| candidates[i].0),
        how: match smooth {
            0 => "found by angle, the least distortion",
            4 => "the points nearest to the corners of its box",
            _ => "found by angle, the others nearest to the corners of its box",
        },
        rival: rival.map(|s| s.1.map(|i| show(place(i))).join(" ")),
    })
}

/// The result of a search for corners.
struct FoundCorners {
    corners: [Location; 4],
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
const LINES: u32 = 16;

impl FlatPath {
    fn new(sub: &Subpath) -> Self {
        let at = |s: &Seg| (0..LINES).map(|i| s.eval(f64::from(i) / f64::from(LINES))).collect::<Vec<_>>();
        let mut points: Vec<Point> = sub.segs.iter().flat_map(at).collect();
        points.push(points[0]);
        let mut lengths = vec![0.0];
        for w in points.windows(2) {
            lengths.push(lengths[lengths.len() - 1] + w[0].distance(w[1]));
        }
        Self { points, lengths }
    }

    fn length_at(&self, (i, t): Location) -> f64 {
        let at = f64::from(LINES) * (i as f64 + t);
        let k = (at as usize).min(self.points.len() - 2);
        self.lengths[k] + (at - k as f64) * (self.lengths[k + 1] - self.lengths[k])
    }

    fn whole(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// Returns the point at a length from the start, which may lead around the path more than once.
    fn at(&self, length: f64) -> Point {
        let length = length.rem_euclid(self.whole());
        let k = self.lengths.partition_point(|l| *l <= length).clamp(1, self.points.len() - 1);
        let (a, b) = (self.lengths[k - 1], self.lengths[k]);
        self.points[k - 1].lerp(self.points[k], if b > a { (length - a) / (b - a) } else { 0.0 })
    }

    /// Returns the distortion of the patch between corners at these lengths; `None` if a side is too short.
    fn distortion(&self, corners: [f64; 4], places: &[Point]) -> Option<f64> {
        /// The least length of a side, as a share of the path's.
        const SHORTEST: f64 = 0.01;
        const STEP: f64 = 0.05;
        let area: f64 = self.points.windows(2).map(|w| w[0].to_vec2().cross(w[1].to_vec2())).sum();
        let ends: [[f64; 2]; 4] =
            std::array::from_fn(|i| [corners[i], if i < 3 { corners[i + 1] } else { corners[0] + self.whole() }]);
        if ends.iter().any(|e| e[1] - e[0] < SHORTEST * self.whole()) {
            return None;
        }
        let order = if area > 0.0 { [3, 2, 1, 0] } else { [0, 1, 2, 3] };
        let sides = order.map(|i| if area > 0.0 { [ends[i][1], ends[i][0]] } else { ends[i] });
        let on = |side: [f64; 2], t: f64| self.at(side[0] + t * (side[1] - side[0]));
        let height = |s: [f64; 2]| (0..8).map(|i| on(s, (f64::from(i) + 0.5) / 8.0).y).sum::<f64>();
        let bottom = (0..4)
            .filter(|i| on(sides[*i], 1.0).x > on(sides[*i], 0.0).x)
            .reduce(|a, b| if height(sides[b]) > height(sides[a]) + 1e-9 * self.whole() { b } else { a })?;
        let [b, r, t, l]: [[f64; 2]; 4] = std::array::from_fn(|i| sides[(bottom + i) % 4]);
        let p = [on(b, 0.0), on(b, 1.0), on(t, 1.0), on(t, 0.0)];
        let patch = |u: f64, v: f64| {
            let (b, t) = (on(b, u).to_vec2(), on(t, 1.0 - u).to_vec2());
            let (l, r) = (on(l, 1.0 - v).to_vec2(), on(r, v).to_vec2());
            let corner = p[0].lerp(p[1], u).to_vec2() * (1.0 - v) + p[2].lerp(p[3], u).to_vec2() * v;
            b * (1.0 - v) + t * v + l * (1.0 - u) + r * u - corner
        };
        let jet = |q: &Point| {
            let (u, v) = (q.x.clamp(STEP, 1.0 - STEP), q.y.clamp(STEP, 1.0 - STEP));
            let dx = (patch(u + STEP, v) - patch(u - STEP, v)) / (2.0 * STEP);
            let dy = (patch(u, v - STEP) - patch(u, v + STEP)) / (2.0 * STEP);
            Jet { p: *q, dx, dy }
        };
        let jets: Vec<Jet> = places.iter().map(jet).collect();
        Some(distortion(&jets) + turned([p[0], p[1], p[3], p[2]]))
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
pub(super) fn trimmed(sub: &Subpath) -> (Subpath, Vec<Point>) {
    /// The largest area, as a share of the path's.
    const SMALL: f64 = 0.08;
    /// The least area, as a share of the square over the notches' distance.
    const DEEP: f64 = 0.15;
    let whole: f64 = sub.segs.iter().map(area).sum();
    let n = sub.segs.len();
    let notches: Vec<usize> = sharp(sub, -whole.signum()).collect();
    let tips: Vec<usize> = sharp(sub, whole.signum()).collect();
    let (mut gone, mut found) = (vec![false; n], Vec::new());
    let mut lines: Vec<(usize, Seg)> = Vec::new();
    for (k, a) in notches.iter().enumerate().filter(|_| notches.len() > 1) {
        let c = notches[(k + 1) % notches.len()];
        let between: Vec<usize> = (0..(c + n - a) % n).map(|i| (a + i) % n).collect();
        let (from, to) = (sub.segs[*a].start(), sub.segs[c].start());
        let chord = Seg::Line(Line::new(to, from));
        let part = between.iter().map(|i| area(&sub.segs[*i])).sum::<f64>() + area(&chord);
        let tip = between.iter().skip(1).find(|i| tips.contains(i));
        if let Some(tip) = tip
            && part * whole > 0.0
            && part / whole <= SMALL
            && part.abs() >= DEEP * to.distance(from).powi(2)
        {
            found.push(sub.segs[*tip].start());
            between.iter().for_each(|i| gone[*i] = true);
            lines.push((*a, chord.reversed()));
        }
    }
    let line = |i: usize| lines.iter().find(|l| l.0 == i).map(|l| l.1);
    let segs: Vec<Seg> = (0..n).filter_map(|i| line(i).or_else(|| (!gone[i]).then_some(sub.segs[i]))).collect();
    (Subpath { start: segs.first().map_or(sub.start, Seg::start), segs, closed: true }, found)
}

/// Returns the nodes at which a path turns sharply outwards. `around` is the sign of the area that it runs around.
pub(super) fn sharp(sub: &Subpath, around: f64) -> impl Iterator<Item = usize> {
    (0..sub.segs.len()).filter(move |i| turn(sub, *i) * around >= CORNER)
}

/// Returns the angle by which the path turns at a node, degrees.
fn turn(sub: &Subpath, node: usize) -> f64 {
    let n = sub.segs.len();
    let (a, b) = (&sub.segs[(node + n - 1) % n], &sub.segs[node]);
    /// Distance in parameter of the point whose direction counts if the piece has no speed at its end.
    const ASIDE: f64 = 1e-4;
    let direction = |s: &Seg, t: f64, aside: f64| {
        let v = s.deriv(t);
        let size = s.bounding_box();
        if v.hypot() <= 1e-9 * (size.width() + size.height()) { s.deriv(aside) } else { v }
    };
    let (v, w) = (direction(a, 1.0, 1.0 - ASIDE), direction(b, 0.0, ASIDE));
    v.cross(w).atan2(v.dot(w)).to_degrees()
}

/// Returns the location nearest to `c` after scaling both axes: the best sample, refined to a zero of the distance's derivative.
/// The ends of pieces become nodes.
fn nearest(sub: &Subpath, c: Point, scale: Vec2, bounds: Rect) -> Location {
    let scaled = |v: Vec2| Vec2::new(v.x * scale.x, v.y * scale.y);
    let off = |s: &Seg, t: f64| scaled(s.eval(t) - c);
    let mut best = (f64::INFINITY, (0, 0.0));
    for (i, s) in sub.segs.iter().enumerate() {
        for k in 0..=SAMPLES {
            let t = f64::from(k) / f64::from(SAMPLES);
            let here = off(s, t).hypot2();
            if here < best.0 {
                best = (here, (i, t));
            }
        }
    }
    let (i, t) = best.1;
    let s = &sub.segs[i];
    let step = 1.0 / f64::from(SAMPLES);
    let (mut lo, mut hi) = ((t - step).max(0.0), (t + step).min(1.0));
    let slope = |t: f64| off(s, t).dot(scaled(s.deriv(t)));
    // Sixty bisections reduce a unit interval to rounding.
    for _ in 0..60 {
        let middle = 0.5 * (lo + hi);
        if slope(middle) > 0.0 {
            hi = middle;
        } else {
            lo = middle;
        }
    }
    let t = 0.5 * (lo + hi);
    let near = |p: Point| s.eval(t).distance(p) <= 1e-6 * (bounds.width() + bounds.height());
    match (near(s.start()), near(s.end())) {
        (true, _) => (i, 0.0),
        (_, true) => ((i + 1) % sub.segs.len(), 0.0),
        _ => (i, t),
    }
}

// Sides drawn one by one: two facing curves, three, four, or one with a height.

/// Distance at which ends still meet, as a share of the size of all curves.
const MEET: f64 = 1e-4;

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
    /// `true` for bottom and top, `false` for left and right.
    lying: bool,
    first: Vec<Seg>,
    second: Vec<Seg>,
    /// The curves from the first to the second, at their starts and at their ends.
    between: [Option<Vec<Seg>>; 2],
}

impl Curves<'_> {
    /// Returns the four sides.
    pub(super) fn ring(&self) -> Result<Ring, Error> {
        let mut notes = Vec::new();
        let facing = self.facing(&mut notes)?;
        let FacingCurves { lying, first, second, between } = &facing;
        let [a, b, c, d] = [start(first), end(first), start(second), end(second)];
        let size = [b, c, d].iter().map(|p| p.distance(a)).fold(0.0, f64::max);
        let names = if *lying { ["left", "right"] } else { ["bottom", "top"] };
        let join = |k: usize, from: Point, to: Point| match &between[k] {
            Some(c) => joined(names[k], c.clone(), from, to, size),
            None if self.square => {
                let along =
                    if k == 0 { [leaving(first), leaving(second)] } else { [arriving(first), arriving(second)] };
                Ok(vec![at_right_angles(from, to, along)])
            }
            None => Ok(vec![Seg::Line(Line::new(from, to))]),
        };
        let (at_start, at_end) = (join(0, a, c)?, join(1, b, d)?);
        let FacingCurves { lying, first, second, .. } = facing;
        let warnings = self.exchanged(lying, &first, &second).into_iter().collect();
        let mut sides = if lying {
            [first, at_end, reversed(&second), reversed(&at_start)]
        } else {
            [at_start, second, reversed(&at_end), reversed(&first)]
        };
        let area: f64 = sides.iter().flatten().map(area).sum();
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
    fn exchanged(&self, lying: bool, first: &[Seg], second: &[Seg]) -> Option<String> {
        let middle = |c: &[Seg]| {
            let sum = c.iter().map(|s| s.start().to_vec2() + s.end().to_vec2()).fold(Vec2::ZERO, |a, b| a + b);
            sum / (2.0 * c.len().max(1) as f64)
        };
        let (a, b) = (middle(first), middle(second));
        let (wrong, what) = if lying {
            (
                b.y > a.y,
                "the top curve lies below the bottom curve, so that the artwork is upside down; exchange `bottom` and `top`",
            )
        } else {
            (
                b.x < a.x,
                "the right curve lies left of the left curve, so that the artwork is turned over; exchange `left` and `right`",
            )
        };
        (wrong && !self.reverse).then(|| format!("envelope: {what}"))
    }

    /// Returns the facing curves. A curve drawn alone faces a copy of itself.
    fn facing(&self, notes: &mut Vec<String>) -> Result<FacingCurves, Error> {
        let [bottom, right, top, left] = [0, 1, 2, 3].map(|k| self.curve(k));
        let (mut bottom, right, mut top, left) = (bottom?, right?, top?, left?);
        let given = [&bottom, &right, &top, &left].iter().filter(|c| c.is_some()).count();
        if given == 1 {
            let height = self.height.unwrap_or(self.frame_height);
            let moved =
                |c: &[Seg], y: f64| c.iter().map(|s| s.transformed(Affine::translate((0.0, y)))).collect::<Vec<_>>();
            match (&bottom, &top) {
                (Some(b), None) => top = Some(moved(b, -height)),
                (None, Some(t)) => bottom = Some(moved(t, height)),
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
                run(&mut a, &mut b, |v| v.x);
                Ok(FacingCurves { lying: true, first: a, second: b, between: [left, right] })
            }
            (bottom, top, Some(mut a), Some(mut b)) => {
                run(&mut a, &mut b, |v| -v.y);
                Ok(FacingCurves { lying: false, first: a, second: b, between: [bottom, top] })
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

fn leaving(c: &[Seg]) -> Vec2 {
    c.first().map_or(Vec2::ZERO, |s| s.deriv(0.0))
}

fn arriving(c: &[Seg]) -> Vec2 {
    c.last().map_or(Vec2::ZERO, |s| s.deriv(1.0))
}

/// Orients both curves so that `along` of the way from start to end is positive.
fn run(a: &mut Vec<Seg>, b: &mut Vec<Seg>, along: impl Fn(Vec2) -> f64) {
    for c in [a, b] {
        if along(end(c) - start(c)) < 0.0 {
            *c = reversed(c);
        }
    }
}

/// Orients a drawn side from one corner to another, and snaps its ends onto them.
fn joined(name: &str, c: Vec<Seg>, from: Point, to: Point, size: f64) -> Result<Vec<Seg>, Error> {
    let back = reversed(&c);
    let off = |c: &[Seg]| start(c).distance(from).max(end(c).distance(to));
    let mut c = if off(&back) < off(&c) { back } else { c };
    let gap = off(&c);
    if gap > MEET * size {
        let problem = format!(
            "does not meet its neighbours: it runs from {} to {}, their corners are {} and {}, {gap:.6} away",
            show(start(&c)),
            show(end(&c)),
            show(from),
            show(to)
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

/// Returns the cubic that leaves one curve and reaches the other at right angles.
fn at_right_angles(from: Point, to: Point, [a, b]: [Vec2; 2]) -> Seg {
    let chord = to - from;
    let handle = |along: Vec2| {
        let n = along.turn_90();
        let n = if n.dot(chord) < 0.0 { -n } else { n };
        if n.hypot() > 0.0 { n * (chord.hypot() / (3.0 * n.hypot())) } else { chord / 3.0 }
    };
    Seg::Cubic(CubicBez::new(from, from + handle(a), to - handle(b), to))
}
