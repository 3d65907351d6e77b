//! Numbers and path data as text: rounded once, in the shortest form.

use pathwarp::decimal::push_trimmed;
use pathwarp::kurbo::{Affine, BezPath, PathEl, Point, Vec2};
use pathwarp::outline::EllipticArc;
use pathwarp::{Outline, Seg};
use std::fmt::Write as _;

/// Beyond this many decimals, digits of an f64 carry no information.
pub(crate) const MOST_DECIMALS: u8 = 14;

/// Appends `v` rounded to `decimals`, without trailing zeros and never as `-0`.
pub(crate) fn push(out: &mut String, v: f64, decimals: u8) {
    let mut digits = Digits::new();
    let decimals = usize::from(decimals.min(MOST_DECIMALS));
    match digits.write(v, decimals).and_then(|text| std::str::from_utf8(text).ok()) {
        Some(text) => out.push_str(text),
        None => push_trimmed(out, v, decimals),
    }
}

/// Does the same for a text that is checked as a whole.
fn push_bytes(out: &mut Vec<u8>, v: f64, decimals: u8) {
    let decimals = usize::from(decimals.min(MOST_DECIMALS));
    match Digits::new().write(v, decimals) {
        Some(text) => out.extend_from_slice(text),
        None => {
            let mut text = String::new();
            push_trimmed(&mut text, v, decimals);
            out.extend_from_slice(text.as_bytes());
        }
    }
}

/// Room for the digits of a number: a sign, at most 16 digits before and 14 after the point.
struct Digits([u8; 32]);

impl Digits {
    fn new() -> Self {
        Self([b'0'; 32])
    }

    /// Writes `v` rounded to `decimals`. `None` if it does not fit an integer that is exact in f64; integers are much faster to
    /// write than decimals.
    fn write(&mut self, v: f64, decimals: usize) -> Option<&[u8]> {
        const WHOLE: f64 = 9e15;
        let scaled = (v * POWERS[decimals]).abs();
        if scaled.is_nan() || scaled >= WHOLE - 1.0 {
            return None;
        }
        // Round half away from zero; the difference is exact.
        let whole = scaled as u64;
        let n = whole + u64::from(scaled - whole as f64 >= 0.5);
        if n == 0 {
            return Some(b"0");
        }
        let unit = UNITS[decimals];
        let (mut before, mut after) = (n / unit, n % unit);
        let mut at = self.0.len();
        if after > 0 {
            // Drop the trailing zeros.
            let mut kept = decimals;
            while after % 10 == 0 {
                after /= 10;
                kept -= 1;
            }
            while kept > 1 {
                at -= 2;
                self.pair(at, after % 100);
                after /= 100;
                kept -= 2;
            }
            if kept == 1 {
                at -= 1;
                self.0[at] = b'0' + after as u8;
            }
            at -= 1;
            self.0[at] = b'.';
        }
        while before >= 100 {
            at -= 2;
            self.pair(at, before % 100);
            before /= 100;
        }
        if before >= 10 {
            at -= 2;
            self.pair(at, before);
        } else {
            at -= 1;
            self.0[at] = b'0' + before as u8;
        }
        if v < 0.0 {
            at -= 1;
            self.0[at] = b'-';
        }
        Some(&self.0[at..])
    }

    /// Writes the two digits of a number below 100.
    fn pair(&mut self, at: usize, n: u64) {
        let n = n as usize * 2;
        self.0[at..at + 2].copy_from_slice(&PAIRS[n..n + 2]);
    }
}

/// The numbers from 00 to 99.
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

const UNITS: [u64; MOST_DECIMALS as usize + 1] = {
    let mut out = [1; MOST_DECIMALS as usize + 1];
    let mut i = 1;
    while i < out.len() {
        out[i] = out[i - 1] * 10;
        i += 1;
    }
    out
};

const POWERS: [f64; MOST_DECIMALS as usize + 1] =
    [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14];

/// Formats `v` with nine significant digits: for lengths, offsets and matrices.
pub(crate) fn short(v: f64) -> String {
    significant(v, 9)
}

/// Formats `v` with `digits` significant digits.
pub(crate) fn significant(v: f64, digits: i32) -> String {
    let mut out = String::new();
    push_significant(&mut out, v, digits);
    out
}

fn push_significant(out: &mut String, v: f64, digits: i32) {
    if v == 0.0 || !v.is_finite() {
        return out.push('0');
    }
    // Fast path for small integers, the common case: no logarithm.
    if v.fract() == 0.0 && v.abs() < 1e6 {
        return push(out, v, 0);
    }
    let size = v.abs().log10().floor() as i32 + 1;
    match u8::try_from((digits - size).max(0)) {
        Ok(d) if d <= MOST_DECIMALS => push(out, v, d),
        // Thirty decimals resolve everything that can occur in a drawing.
        _ => push_trimmed(out, v, (digits - size).clamp(0, 30) as usize),
    }
}

/// Formats a transform as `matrix(…)`, with fifteen significant digits to suit f64 readers.
pub(crate) fn matrix(m: Affine) -> String {
    let mut out = String::from("matrix(");
    for (i, v) in m.as_coeffs().into_iter().enumerate() {
        if i > 0 {
            out.push(' ');
        }
        push_significant(&mut out, v, 15);
    }
    out.push(')');
    out
}

/// Formats a path as a `d` attribute with absolute commands.
pub(crate) fn path_data(path: &BezPath, decimals: u8) -> String {
    path_data_by(path, |_| [decimals; 2])
}

/// The same with decimals for the handles and the end of each element, given by its index.
pub(crate) fn path_data_by(path: &BezPath, decimals: impl Fn(usize) -> [u8; 2]) -> String {
    let mut out: Vec<u8> = Vec::with_capacity(path.elements().len() * 48);
    let point = |out: &mut Vec<u8>, p: Point, decimals: u8| {
        push_bytes(out, p.x, decimals);
        out.push(b',');
        push_bytes(out, p.y, decimals);
    };
    let mut at = Point::ORIGIN;
    for (i, el) in path.elements().iter().enumerate() {
        let [handle, node] = decimals(i);
        // Write a cubic as a quadratic if the two differ by a tenth of the last decimal.
        let near = || 0.1_f64.powi(i32::from(handle));
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
            PathEl::CurveTo(a, b, p) if quadratic(at, a, b, p).is_some_and(|q| q.1 < near()) => {
                if let Some((q, _)) = quadratic(at, a, b, p) {
                    out.push(b'Q');
                    point(&mut out, q, handle);
                    out.push(b' ');
                    point(&mut out, p, node);
                }
            }
            PathEl::CurveTo(a, b, p) => {
                out.push(b'C');
                point(&mut out, a, handle);
                out.push(b' ');
                point(&mut out, b, handle);
                out.push(b' ');
                point(&mut out, p, node);
            }
            PathEl::ClosePath => out.push(b'Z'),
        }
        at = el.end_point().unwrap_or(at);
    }
    // ASCII only, so this cannot fail.
    String::from_utf8(out).unwrap_or_default()
}

/// Appends `v` in the shortest form that reads back unchanged; as an f32 if `v` is one.
fn push_exact(out: &mut String, v: f64) {
    let single = v as f32;
    // A number with few digits is the unique shortest form; find it without the general algorithm.
    const DECIMALS: u8 = 3;
    const LARGEST: f64 = 1e6;
    let scale = POWERS[usize::from(DECIMALS)];
    let n = (v * scale).round();
    let near = n / scale;
    if n != 0.0 && n.abs() < LARGEST && (near == v || f64::from(single) == v && near as f32 == single) {
        return push(out, near, DECIMALS);
    }
    // Writing to a String cannot fail.
    let _ = if f64::from(single) == v { write!(out, "{single}") } else { write!(out, "{v}") };
}

/// Formats an outline as a `d` attribute without rounding, with arcs as arcs.
pub(crate) fn outline_data(outline: &Outline) -> String {
    let mut out = String::new();
    let mut add = |command: &str, numbers: &[f64]| {
        out.push_str(command);
        for (i, v) in numbers.iter().enumerate() {
            if i > 0 {
                out.push(' ');
            }
            push_exact(&mut out, *v);
        }
    };
    for s in &outline.subpaths {
        add("M", &[s.start.x, s.start.y]);
        let closing = s.closed && matches!(s.segs.last(), Some(Seg::Line(_)));
        for g in s.segs.iter().take(s.segs.len() - usize::from(closing)) {
            match g {
                Seg::Line(l) => add("L", &[l.p1.x, l.p1.y]),
                Seg::Quad(q) => add("Q", &[q.p1.x, q.p1.y, q.p2.x, q.p2.y]),
                Seg::Cubic(c) => add("C", &[c.p1.x, c.p1.y, c.p2.x, c.p2.y, c.p3.x, c.p3.y]),
                Seg::Arc(a) => match radii(a) {
                    Some([rx, ry, turn]) => {
                        let flag = |yes| if yes { 1.0 } else { 0.0 };
                        let large = a.sweep.abs() > std::f64::consts::PI;
                        add("A", &[rx, ry, turn, flag(large), flag(a.sweep > 0.0), a.p1.x, a.p1.y]);
                    }
                    None => {
                        for c in a.to_cubics(a.major() * FINE) {
                            add("C", &[c.p1.x, c.p1.y, c.p2.x, c.p2.y, c.p3.x, c.p3.y]);
                        }
                    }
                },
            }
        }
        if s.closed {
            add("Z", &[]);
        }
    }
    out
}

/// Formats an outline with arcs as a `d` attribute, as accurately as [`path_data`] does with that number of decimals: the centre of
/// an arc follows from its ends and radii, and needs more.
/// `decimals` gives their number for each subpath.
pub(crate) fn arcs_data(outline: &Outline, decimals: impl Fn(usize) -> u8) -> String {
    let mut out = String::new();
    let add = |out: &mut String, command: char, numbers: &[(f64, u8)]| {
        if !out.is_empty() {
            out.push(' ');
        }
        out.push(command);
        for (i, (v, decimals)) in numbers.iter().enumerate() {
            if i > 0 {
                out.push(if i % 2 == 1 && command != 'A' { ',' } else { ' ' });
            }
            push(out, *v, *decimals);
        }
    };
    for (i, s) in outline.subpaths.iter().enumerate() {
        let decimals = decimals(i).saturating_add(1).min(MOST_DECIMALS);
        let finer = decimals.saturating_add(2).min(MOST_DECIMALS);
        let at = |p: Point| [(p.x, decimals), (p.y, decimals)];
        add(&mut out, 'M', &at(s.start));
        let closing = s.closed && matches!(s.segs.last(), Some(Seg::Line(_)));
        for g in s.segs.iter().take(s.segs.len() - usize::from(closing)) {
            match g {
                Seg::Line(l) => add(&mut out, 'L', &at(l.p1)),
                Seg::Quad(q) => add(&mut out, 'Q', &[at(q.p1), at(q.p2)].concat()),
                Seg::Cubic(c) => add(&mut out, 'C', &[at(c.p1), at(c.p2), at(c.p3)].concat()),
                Seg::Arc(a) => {
                    let ([rx, ry], turn) = axes(a);
                    let flag = |yes: bool| (f64::from(u8::from(yes)), 0);
                    let large = flag(a.sweep.abs() > std::f64::consts::PI);
                    let sweep = flag(a.sweep * a.a.cross(a.b) > 0.0);
                    let [x, y] = at(a.p1);
                    add(&mut out, 'A', &[(rx, finer), (ry, finer), (turn, finer), large, sweep, x, y]);
                }
            }
        }
        if s.closed {
            out.push_str(" Z");
        }
    }
    out
}

/// The semi-axes of an arc's ellipse and the direction of the first in degrees: the singular values of (a b).
fn axes(a: &EllipticArc) -> ([f64; 2], f64) {
    let (u, v) = (a.a, a.b);
    let sum = Vec2::new(0.5 * (u.x + v.y), 0.5 * (u.y - v.x));
    let difference = Vec2::new(0.5 * (u.x - v.y), 0.5 * (u.y + v.x));
    let (q, r) = (sum.hypot(), difference.hypot());
    let least = 1e-12 * q.max(r);
    let turn = match (q > least, r > least) {
        (true, true) => 0.5 * (sum.atan2() + difference.atan2()),
        // A circle.
        _ => 0.0,
    };
    ([q + r, (q - r).abs()], turn.to_degrees())
}

/// Relative tolerance of the cubics that replace an arc without principal axes; far below a pixel.
const FINE: f64 = 1e-5;

/// Returns the radii of an arc and the rotation of its ellipse in degrees, as the `A` command takes them. Returns `None` for
/// a sheared or mirrored arc, and for one that ends at its start.
fn radii(a: &EllipticArc) -> Option<[f64; 3]> {
    let (rx, ry) = (a.a.hypot(), a.b.hypot());
    let right = a.a.dot(a.b).abs() <= 1e-12 * rx * ry && a.a.cross(a.b) > 0.0;
    (right && a.p0 != a.p1).then(|| [rx, ry, a.a.y.atan2(a.a.x).to_degrees()])
}

/// Finds the quadratic nearest to a cubic, with the distance between its two candidate handles. Returns `None` if the
/// handle is not finite.
fn quadratic(p0: Point, p1: Point, p2: Point, p3: Point) -> Option<(Point, f64)> {
    let from_start = p0 + (p1 - p0) * 1.5;
    let from_end = p3 + (p2 - p3) * 1.5;
    let q = from_start.midpoint(from_end);
    q.is_finite().then(|| (q, from_start.distance(from_end)))
}

#[cfg(test)]
mod tests;
