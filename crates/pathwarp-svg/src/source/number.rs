//! Writes numbers and path data, rounded once and in the shortest form.

use pathwarp::engine::decimal::{decimals, push_trimmed, together, trimmed};
use pathwarp::kurbo::{BezPath, CubicBez, PathEl, Point, Rect, Vec2};
use pathwarp::outline::{EllipticArc, Subpath};
use pathwarp::{Outline, Seg};
use std::fmt::Write as _;

/// Number of decimals beyond which digits of an f64 carry no information.
pub(crate) const MAX_DECIMALS: u8 = 14;

/// Appends `v` rounded to `decimals`, without trailing zeros and never as `-0`.
pub(crate) fn push(out: &mut String, v: f64, decimals: u8) {
    let mut digits = Digits::new();
    let decimals = usize::from(decimals.min(MAX_DECIMALS));
    match digits.write(v, decimals).and_then(|text| std::str::from_utf8(text).ok()) {
        Some(text) => out.push_str(text),
        None => push_trimmed(out, v, decimals),
    }
}

/// Appends `v` rounded to `decimals` as ASCII bytes, without trailing zeros and never as `-0`.
fn push_bytes(out: &mut Vec<u8>, v: f64, decimals: u8) {
    let decimals = usize::from(decimals.min(MAX_DECIMALS));
    match Digits::new().write(v, decimals) {
        Some(text) => out.extend_from_slice(text),
        None => out.extend_from_slice(trimmed(v, decimals).as_bytes()),
    }
}

/// Room for the digits of a number: a sign, at most 16 digits before and 14 after the point.
struct Digits([u8; 32]);

impl Digits {
    fn new() -> Self {
        Self([b'0'; 32])
    }

    /// Writes `v` rounded to `decimals`, by way of an integer, for speed, and from the last digit to the first. Returns `None` if the
    /// integer would not be exact in f64.
    fn write(&mut self, v: f64, decimals: usize) -> Option<&[u8]> {
        /// Just below 2⁵³, up to which all integers are exact.
        const MAX_EXACT: f64 = 9e15;
        let scaled = (v * POWERS[decimals]).abs();
        if scaled.is_nan() || scaled >= MAX_EXACT - 1.0 {
            return None;
        }
        // Rounds half away from zero; the difference is exact.
        let floor = scaled as u64;
        let n = floor + u64::from(scaled - floor as f64 >= 0.5);
        if n == 0 {
            return Some(b"0");
        }
        let unit = POWERS[decimals] as u64;
        let (mut whole, mut fraction) = (n / unit, n % unit);
        let mut start = self.0.len();
        if fraction > 0 {
            // Drop the trailing zeros.
            let mut kept = decimals;
            while fraction % 10 == 0 {
                fraction /= 10;
                kept -= 1;
            }
            while kept > 1 {
                start -= 2;
                self.write_pair(start, fraction % 100);
                fraction /= 100;
                kept -= 2;
            }
            if kept == 1 {
                start -= 1;
                self.0[start] = b'0' + fraction as u8;
            }
            start -= 1;
            self.0[start] = b'.';
        }
        while whole >= 100 {
            start -= 2;
            self.write_pair(start, whole % 100);
            whole /= 100;
        }
        if whole >= 10 {
            start -= 2;
            self.write_pair(start, whole);
        } else {
            start -= 1;
            self.0[start] = b'0' + whole as u8;
        }
        if v < 0.0 {
            start -= 1;
            self.0[start] = b'-';
        }
        Some(&self.0[start..])
    }

    /// Writes the two digits of a number below 100.
    fn write_pair(&mut self, start: usize, n: u64) {
        let n = n as usize * 2;
        self.0[start..start + 2].copy_from_slice(&PAIRS[n..n + 2]);
    }
}

/// The digits of the numbers from 00 to 99.
const PAIRS: [u8; 200] = {
    let mut out = [b'0'; 200];
    let mut n = 0;
    while n < 100 {
        out[2 * n] = b'0' + (n / 10) as u8;
        out[2 * n + 1] = b'0' + (n % 10) as u8;
        n += 1;
    }
    out
};

/// Powers of ten by their exponent.
const POWERS: [f64; MAX_DECIMALS as usize + 1] =
    [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14];

/// Significant digits of lengths and offsets, far more than renderers in single precision resolve.
const SHORT: i32 = 9;
/// Significant digits of single precision.
const SINGLE: i32 = 7;

/// Formats `v` with nine significant digits, for lengths and offsets.
pub(crate) fn short(v: f64) -> String {
    significant(v, SHORT)
}

/// Formats `v` with the significant digits of single precision.
pub(crate) fn single(v: f64) -> String {
    significant(v, SINGLE)
}

/// Formats `v` with `digits` significant digits; a number that is not finite as 0.
fn significant(v: f64, digits: i32) -> String {
    let mut out = String::new();
    let decimals = decimals([v], digits);
    match u8::try_from(decimals) {
        _ if !v.is_finite() => out.push('0'),
        Ok(few) if few <= MAX_DECIMALS => push(&mut out, v, few),
        _ => push_trimmed(&mut out, v, decimals),
    }
    out
}

/// Formats numbers with nine significant digits each, but no decimals beyond the twelfth digit of the largest.
pub(crate) fn shorts(values: &[f64]) -> impl Iterator<Item = String> {
    together(values, SHORT, 3)
}

/// Formats numbers of single precision with seven significant digits each, but no decimals beyond the eighth digit of the largest.
pub(crate) fn singles(values: &[f32]) -> Vec<String> {
    let values: Vec<f64> = values.iter().map(|v| f64::from(*v)).collect();
    together(&values, SINGLE, 1).collect()
}

/// The attributes of a rectangle, with their names.
pub(crate) fn rectangle(r: Rect) -> [(&'static str, String); 4] {
    let values = [r.x0, r.y0, r.width(), r.height()];
    let mut sides = shorts(&values);
    ["x", "y", "width", "height"].map(|name| (name, sides.next().unwrap_or_default()))
}

/// Formats a path as a `d` attribute with absolute commands.
pub(crate) fn path_data(path: &BezPath, decimals: u8) -> String {
    path_data_by(path, |_| None, |_| [decimals; 2])
}

/// Formats a path as a `d` attribute with absolute commands. `decimals` gives the numbers of decimals for the handles and the end of each
/// element, by its index.
///
/// `coarsest` is `None` if the decimals are fixed. Otherwise it gives the largest step for which an element's decimals were chosen: the
/// unit of the last one is the power of ten below. Handles so short that rounding would turn them then get more decimals, so that smooth
/// joints stay smooth. Whether a cubic is written as a quadratic depends on `coarsest` alone, which in root user space is the same for
/// neighbours under different transforms, so that they write a shared edge equally.
pub(crate) fn path_data_by(
    path: &BezPath,
    coarsest: impl Fn(usize) -> Option<f64>,
    decimals: impl Fn(usize) -> [u8; 2],
) -> String {
    /// Usual length of an element of path data in bytes: a letter and three points.
    const ELEMENT: usize = 48;
    let mut out: Vec<u8> = Vec::with_capacity(path.elements().len() * ELEMENT);
    let point = |out: &mut Vec<u8>, p: Point, decimals: u8| {
        push_bytes(out, p.x, decimals);
        out.push(b',');
        push_bytes(out, p.y, decimals);
    };
    // The last point, and the point that will be read from its text.
    let (mut last, mut last_read) = (Point::ORIGIN, Point::ORIGIN);
    for (i, el) in path.elements().iter().enumerate() {
        let [handle, node] = decimals(i);
        let end_read = el.end_point().map_or(last_read, |p| rounded(p, node));
        if !out.is_empty() {
            out.push(b' ');
        }
        match *el {
            PathEl::MoveTo(p) => {
                out.push(b'M');
                point(&mut out, p, node);
            }
            PathEl::LineTo(p) => {
                out.push(b'L');
                point(&mut out, p, node);
            }
            PathEl::QuadTo(a, p) => {
                out.push(b'Q');
                point(&mut out, a, handle);
                out.push(b' ');
                point(&mut out, p, node);
            }
            PathEl::CurveTo(a, b, p) => {
                // A quadratic is written if it differs by less than the rounding and its handles keep their directions.
                let coarsest = coarsest(i);
                let step = POWERS[usize::from(handle.min(MAX_DECIMALS))].recip();
                let quad = quadratic(last, a, b, p).filter(|(q, gap)| match coarsest {
                    // The step is between a tenth of the coarsest and the coarsest, unless the number of decimals is at its limits.
                    Some(coarsest) => {
                        let least = STEADY * coarsest.max(step);
                        let steady = |exact, v: Vec2| exact == Vec2::ZERO || (is_kept(exact, v) && v.hypot() >= least);
                        *gap < MAX_GAP * step.min(0.1 * coarsest)
                            && steady(a - last, *q - last)
                            && steady(b - p, *q - p)
                    }
                    None => {
                        let q = rounded(*q, handle);
                        *gap < MAX_GAP * step && is_kept(a - last, q - last_read) && is_kept(b - p, q - end_read)
                    }
                });
                let quad = quad.map(|(q, _)| q);
                out.push(if quad.is_some() { b'Q' } else { b'C' });
                let handles = match quad {
                    Some(q) => [Some((q, handle)), None],
                    None if coarsest.is_none() => [Some((a, handle)), Some((b, handle))],
                    None => [
                        Some(keep_direction(a, (last, last_read), handle)),
                        Some(keep_direction(b, (p, end_read), handle)),
                    ],
                };
                for (q, decimals) in handles.into_iter().flatten() {
                    point(&mut out, q, decimals);
                    out.push(b' ');
                }
                point(&mut out, p, node);
            }
            PathEl::ClosePath => out.push(b'Z'),
        }
        (last, last_read) = (el.end_point().unwrap_or(last), end_read);
    }
    // The bytes are ASCII, so this cannot fail.
    String::from_utf8(out).unwrap_or_default()
}

/// Largest distance between the two handles that a cubic's ends give for a quadratic, in units of the last decimal. The curves differ by
/// a tenth of it.
const MAX_GAP: f64 = 3.0;

/// Length of a handle, in units of the last decimal, from which on rounding turns it by less than [`is_kept`] allows.
const STEADY: f64 = 600.0;

/// The point that will be read from a point's text.
fn rounded(p: Point, decimals: u8) -> Point {
    let unit = POWERS[usize::from(decimals.min(MAX_DECIMALS))];
    Point::new((p.x * unit).round() / unit, (p.y * unit).round() / unit)
}

/// Returns `true` if `v` has the direction of `exact` within 0.2°, so that two handles at a joint turn by less than half a degree.
fn is_kept(exact: Vec2, v: Vec2) -> bool {
    const TURN: f64 = 0.0035;
    let along = exact.dot(v);
    exact == Vec2::ZERO || (along > 0.0 && exact.cross(v).abs() <= TURN * along)
}

/// A handle and enough decimals to keep its direction from `node`, which will be read as `read`.
fn keep_direction(handle: Point, (node, read): (Point, Point), decimals: u8) -> (Point, u8) {
    /// Most additional decimals. Handles that would need more are far too short to be visible.
    const MAX_MORE: u8 = 6;
    let v = handle - node;
    if is_kept(v, rounded(handle, decimals) - read) {
        return (handle, decimals);
    }
    let mut more = (1..=MAX_MORE).map(|n| decimals.saturating_add(n).min(MAX_DECIMALS));
    let enough = more.find(|d| is_kept(v, rounded(read + v, *d) - read));
    enough.map_or((handle, decimals), |d| (read + v, d))
}

/// Appends `v` in the shortest form that reads back unchanged; as an f32 if `v` is one.
fn push_exact(out: &mut String, v: f64) {
    let single = v as f32;
    // A number with few digits needs no search for the shortest form.
    const DECIMALS: u8 = 3;
    const MAX: f64 = 1e6;
    let scale = POWERS[usize::from(DECIMALS)];
    let n = (v * scale).round();
    let rounded = n / scale;
    if n != 0.0 && n.abs() < MAX && (rounded == v || (f64::from(single) == v && rounded as f32 == single)) {
        return push(out, rounded, DECIMALS);
    }
    // Writing to a String cannot fail.
    let _ = if f64::from(single) == v { write!(out, "{single}") } else { write!(out, "{v}") };
}

/// Formats an outline as a `d` attribute without rounding, with arcs as arcs.
pub(crate) fn outline_data(outline: &Outline) -> String {
    let mut out = String::new();
    let mut add = |command: char, numbers: &[f64]| {
        out.push(command);
        for (i, v) in numbers.iter().enumerate() {
            if i > 0 {
                out.push(' ');
            }
            push_exact(&mut out, *v);
        }
    };
    let arc = |a: &EllipticArc| {
        let [rx, ry, turn] = written_axes(a)?;
        let large = a.sweep.abs() > std::f64::consts::PI;
        Some([rx, ry, turn, flag(large), flag(a.sweep > 0.0), a.p1.x, a.p1.y])
    };
    for s in &outline.subpaths {
        commands(s, &mut add, arc, |a| a.major() * TOLERANCE);
    }
    out
}

/// A flag of an arc as a number.
fn flag(yes: bool) -> f64 {
    f64::from(u8::from(yes))
}

/// Lists the commands of a subpath with their numbers. `arc` gives the numbers of an arc; if it returns `None`, the arc becomes cubics
/// within `tolerance`.
fn commands(
    s: &Subpath,
    add: &mut impl FnMut(char, &[f64]),
    arc: impl Fn(&EllipticArc) -> Option<[f64; 7]>,
    tolerance: impl Fn(&EllipticArc) -> f64,
) {
    let cubic = |add: &mut dyn FnMut(char, &[f64]), c: &CubicBez| {
        add('C', &[c.p1.x, c.p1.y, c.p2.x, c.p2.y, c.p3.x, c.p3.y]);
    };
    add('M', &[s.start.x, s.start.y]);
    let closing = s.closed && matches!(s.segs.last(), Some(Seg::Line(_)));
    for g in s.segs.iter().take(s.segs.len() - usize::from(closing)) {
        match g {
            Seg::Line(l) => add('L', &[l.p1.x, l.p1.y]),
            Seg::Quad(q) => add('Q', &[q.p1.x, q.p1.y, q.p2.x, q.p2.y]),
            Seg::Cubic(c) => cubic(add, c),
            Seg::Arc(a) => match arc(a) {
                Some(numbers) => add('A', &numbers),
                None => a.to_cubics(tolerance(a)).for_each(|c| cubic(add, &c)),
            },
        }
    }
    if s.closed {
        add('Z', &[]);
    }
}

/// Formats an outline with arcs as a `d` attribute, with the accuracy of the decimals that `decimals` gives for each subpath. The centre
/// of an arc follows from its ends and radii, which takes more decimals: one more or, for flat ellipses, up to `more` beyond that. If
/// these do not suffice, an arc is written as cubics.
pub(crate) fn arcs_data(outline: &Outline, more: u8, decimals: impl Fn(usize) -> u8) -> String {
    let mut out = String::new();
    for (i, s) in outline.subpaths.iter().enumerate() {
        let nominal = POWERS[usize::from(decimals(i).min(MAX_DECIMALS))].recip();
        let holds = |a: &EllipticArc, from: Point, d: u8| ArcText::new(a, d).error(a, from) <= nominal;
        let first = decimals(i).saturating_add(1).min(MAX_DECIMALS);
        let all_hold =
            |d: u8| s.segs.iter().all(|g| if let Seg::Arc(a) = g { holds(a, rounded(a.p0, d), d) } else { true });
        let decimals = (first..=(first + more).min(MAX_DECIMALS)).find(|d| all_hold(*d)).unwrap_or(first);
        subpath_with_arcs(&mut out, s, decimals, nominal, holds);
    }
    out
}

/// Writes a subpath with `decimals`, and as cubics within a tenth of `nominal` the arcs for which that does not suffice (`holds`).
fn subpath_with_arcs(
    out: &mut String,
    s: &Subpath,
    decimals: u8,
    nominal: f64,
    holds: impl Fn(&EllipticArc, Point, u8) -> bool,
) {
    // The numbers of an arc are its radii and turn, two flags, and its end.
    let decimals_of = |command: char, i: usize| match (command, i) {
        ('A', 0..3) => axis_decimals(decimals),
        ('A', 3..5) => 0,
        _ => decimals,
    };
    let mut add = |command: char, numbers: &[f64]| {
        if !out.is_empty() {
            out.push(' ');
        }
        out.push(command);
        for (i, v) in numbers.iter().enumerate() {
            if i > 0 {
                out.push(if i % 2 == 1 && command != 'A' { ',' } else { ' ' });
            }
            push(out, *v, decimals_of(command, i));
        }
    };
    let arc = |a: &EllipticArc| {
        let ArcText { radii: [rx, ry], turn, large, sweep, .. } = ArcText::new(a, decimals);
        let numbers = [rx, ry, turn, flag(large), flag(sweep), a.p1.x, a.p1.y];
        holds(a, rounded(a.p0, decimals), decimals).then_some(numbers)
    };
    commands(s, &mut add, arc, |_| 0.1 * nominal);
}

/// Decimals of an arc's radii and turn.
fn axis_decimals(decimals: u8) -> u8 {
    decimals.saturating_add(2).min(MAX_DECIMALS)
}

/// The numbers to write for an arc.
struct ArcText {
    radii: [f64; 2],
    /// Rotation of the ellipse, in degrees.
    turn: f64,
    /// The flags of the `A` command.
    large: bool,
    sweep: bool,
    /// The end as it will be read.
    to: Point,
    /// Decimals of radii and turn.
    axis_decimals: u8,
}

impl ArcText {
    fn new(a: &EllipticArc, decimals: u8) -> Self {
        let axis_decimals = axis_decimals(decimals);
        let (radii, turn) = axes(a);
        let (large, sweep) = (a.sweep.abs() > std::f64::consts::PI, a.sweep * a.a.cross(a.b) > 0.0);
        Self { radii, turn, large, sweep, to: rounded(a.p1, decimals), axis_decimals }
    }

    /// Estimates the distance between the arc and the arc that will be read if it starts at `from`.
    fn error(&self, a: &EllipticArc, from: Point) -> f64 {
        const SAMPLES: u32 = 16;
        let round = |v: f64| rounded(Point::new(v, 0.0), self.axis_decimals).x;
        let radii = Vec2::new(round(self.radii[0]), round(self.radii[1]));
        let Some(read) = EllipticArc::from_svg(from, radii, round(self.turn), self.large, self.sweep, self.to) else {
            return a.p0.distance(from) + a.p1.distance(self.to);
        };
        let parameters = (0..=SAMPLES).map(|i| f64::from(i) / f64::from(SAMPLES));
        parameters.map(|t| read.eval(t).distance(a.eval(t))).fold(0.0, f64::max)
    }
}

/// The semi-axes of an arc's ellipse, which are the singular values of the matrix (a b), and the direction of the first in degrees.
fn axes(a: &EllipticArc) -> ([f64; 2], f64) {
    let (u, v) = (a.a, a.b);
    let sum = Vec2::new(0.5 * (u.x + v.y), 0.5 * (u.y - v.x));
    let difference = Vec2::new(0.5 * (u.x - v.y), 0.5 * (u.y + v.x));
    let (q, r) = (sum.hypot(), difference.hypot());
    // One of the two vanishes for a circle, up to rounding.
    let is_circle = q.min(r) <= 1e-12 * q.max(r);
    let turn = if is_circle { 0.0 } else { 0.5 * (sum.atan2() + difference.atan2()) };
    ([q + r, (q - r).abs()], turn.to_degrees())
}

/// Tolerance of the cubics that replace an arc whose vectors are no principal axes, relative to its major semi-axis; far below a pixel.
const TOLERANCE: f64 = 1e-5;

/// The radii of an arc and the rotation of its ellipse in degrees, for the `A` command. Returns `None` for a sheared or mirrored arc, and
/// for an arc that ends at its start.
fn written_axes(a: &EllipticArc) -> Option<[f64; 3]> {
    let (rx, ry) = (a.a.hypot(), a.b.hypot());
    let right = a.a.dot(a.b).abs() <= 1e-12 * rx * ry && a.a.cross(a.b) > 0.0;
    (right && a.p0 != a.p1).then(|| [rx, ry, a.a.y.atan2(a.a.x).to_degrees()])
}

/// The handle of the quadratic nearest to a cubic, with the distance between the two handles that the cubic's ends give. Returns `None` if
/// it is not finite.
fn quadratic(p0: Point, p1: Point, p2: Point, p3: Point) -> Option<(Point, f64)> {
    let from_start = p0 + (p1 - p0) * 1.5;
    let from_end = p3 + (p2 - p3) * 1.5;
    let q = from_start.midpoint(from_end);
    q.is_finite().then(|| (q, from_start.distance(from_end)))
}

#[cfg(test)]
mod tests;
