//! Letters set along the skeleton one by one, each by an affine map, so that only control points move.
//!
//! A letter's anchor (the middle of its advance on the baseline) comes to the point C of the skeleton, with unit tangent T and unit
//! normal N. The letter is mapped by (x, y) ↦ C + X·(x − anchor) + Y·(y − baseline):
//!
//! | setting | X | Y | property |
//! |---|---|---|---|
//! | rotate | T | −N | letters turn and keep their shape |
//! | skew | T | down | verticals stay vertical, the foot follows the path |
//! | ribbon | right | −N | horizontals stay horizontal, verticals stand on the path |
//! | stair | right | down | letters only move; the anchor is where the advance begins |
//!
//! These are the type-on-a-path effects Rainbow, Skew, 3D Ribbon and Stair Step of Adobe Illustrator's manual.

use super::map::{BendMap, ToStrip, listed, normal};
use crate::error::show;
use crate::outline::{Outline, Seg, boundary};
use crate::param::{Letter, choice};
use kurbo::{Affine, Line, Point, Rect, Shape as _, Vec2};

choice! {
    /// The way a letter is set on a skeleton, instead of being bent.
    #[non_exhaustive]
    pub enum LetterSetting {
        /// Turned; it keeps its shape.
        Rotate = "rotate",
        /// Sheared: verticals stay vertical, the foot follows the path.
        Skew = "skew",
        /// Sheared: horizontals stay horizontal, verticals stand on the path.
        Ribbon = "ribbon",
        /// Only moved.
        Stair = "stair",
    }
}

impl LetterSetting {
    fn axes(self, t: Vec2) -> (Vec2, Vec2) {
        let (right, down) = (Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0));
        match self {
            Self::Rotate => (t, -normal(t)),
            Self::Skew => (t, down),
            Self::Ribbon => (right, -normal(t)),
            Self::Stair => (right, down),
        }
    }

    /// Returns the map that takes `x0` on the baseline to distance `s`.
    fn place(self, map: &BendMap, x0: f64, s: f64) -> Affine {
        let (c, t) = map.stand(s);
        let (x, y) = self.axes(t);
        let (x, y) = (x * map.to_strip.up, y * map.to_strip.up);
        let at = c.to_vec2() - x * x0 - y * map.to_strip.base;
        Affine::new([x.x, x.y, y.x, y.y, at.x, at.y])
    }

    fn anchor(self, letter: &Letter) -> f64 {
        if self == Self::Stair { letter.origin.x } else { letter.middle().x }
    }

    /// Returns the distances along the skeleton of letters spread over it. The gaps of every line grow by the same amount, gaps between
    /// words by twice as much, until the line reaches from end to end. A closed skeleton has one more gap between words.
    fn spread(self, to_strip: &ToStrip, closed: bool, letters: &[Letter]) -> Vec<f64> {
        /// A gap wider than this share of its line's mean advance separates words.
        const BETWEEN_WORDS: f64 = 0.2;
        let up = to_strip.up;
        let mut out = vec![0.0; letters.len()];
        for line in lines(letters) {
            let end = |i: usize| letters[i].origin.x + letters[i].advance;
            let (Some(&first), Some(&last)) = (line.first(), line.last()) else { continue };
            let gaps: Vec<f64> = line.windows(2).map(|p| letters[p[1]].origin.x - end(p[0])).collect();
            let advances: f64 = line.iter().map(|i| letters[*i].advance).sum();
            let wide = BETWEEN_WORDS * advances / line.len() as f64;
            let weight = |gap: f64| if gap > wide { 2.0 } else { 1.0 };
            let round = if closed { weight(f64::INFINITY) } else { 0.0 };
            let weights = gaps.iter().map(|g| weight(*g)).sum::<f64>() + round;
            let (from, to) = (to_strip.s(letters[first].origin.x), to_strip.s(end(last)));
            let spare = to - from - up * (end(last) - letters[first].origin.x);
            // A single letter is centred.
            let (more, mut at) = if weights > 0.0 { (spare / weights, from) } else { (0.0, from + 0.5 * spare) };
            at += 0.5 * round * more;
            for (k, i) in line.into_iter().enumerate() {
                out[i] = at + up * (self.anchor(&letters[i]) - letters[i].origin.x);
                let gap = gaps.get(k).copied().unwrap_or_default();
                at += up * (letters[i].advance + gap) + more * weight(gap);
            }
        }
        out
    }
}

/// Returns the copies, or the identity for artwork without copies.
pub(super) fn or_identity(copies: &[Affine]) -> &[Affine] {
    if copies.is_empty() { &[Affine::IDENTITY] } else { copies }
}

/// Returns the indices of the letters of every line, from left to right.
fn lines(letters: &[Letter]) -> Vec<Vec<usize>> {
    /// Distance of baselines that belong to one line, as a share of an advance.
    const ONE_LINE: f64 = 1e-3;
    let mut out: Vec<Vec<usize>> = Vec::new();
    for (i, l) in letters.iter().enumerate() {
        let before = out.last_mut().zip(i.checked_sub(1).and_then(|b| letters.get(b)));
        match before.filter(|(_, b)| (l.origin.y - b.origin.y).abs() <= ONE_LINE * l.advance) {
            Some((line, _)) => line.push(i),
            None => out.push(vec![i]),
        }
    }
    for line in &mut out {
        line.sort_by(|a, b| letters[*a].origin.x.total_cmp(&letters[*b].origin.x));
    }
    out
}

/// Returns the map of every letter for each of the copies. `spread` distributes the letters over the whole skeleton.
pub(super) fn places(
    map: &BendMap,
    setting: LetterSetting,
    letters: &[Letter],
    copies: &[Affine],
    spread: bool,
) -> Vec<Vec<Affine>> {
    let at = if spread {
        setting.spread(&map.to_strip, map.closed, letters)
    } else {
        letters.iter().map(|l| map.to_strip.s(setting.anchor(l))).collect()
    };
    let all = |(l, s): (&Letter, f64)| {
        let further = or_identity(copies).iter().map(|c| map.to_strip.k * c.translation().x);
        further.map(|by| setting.place(map, setting.anchor(l), s + by)).collect()
    };
    letters.iter().zip(at).map(all).collect()
}

/// Returns the translations of letters in the source plane that spread them around a closed skeleton by larger spaces. `whole` is the
/// map to the strip that would stretch the artwork around it.
pub(super) fn apart(map: &BendMap, letters: &[Letter], whole: ToStrip) -> Vec<Vec<Affine>> {
    let at = LetterSetting::Rotate.spread(&whole, true, letters);
    let by =
        |(l, s): (&Letter, f64)| vec![Affine::translate(((s - map.to_strip.s(l.middle().x)) / map.to_strip.k, 0.0))];
    letters.iter().zip(at).map(by).collect()
}

/// Returns the map of every object for each of `count` copies of the row, with equal gaps between all objects. The first begins at
/// `first`; on a closed skeleton its middle is there. Without `count`, there is one copy, at the distances drawn.
pub(super) fn row(
    map: &BendMap,
    setting: LetterSetting,
    objects: &[Letter],
    count: Option<usize>,
    first: f64,
) -> Vec<Vec<Affine>> {
    let ToStrip { up, .. } = map.to_strip;
    let place = |o: &Letter, s: f64| setting.place(map, o.middle().x, s);
    let Some(count) = count else {
        return objects.iter().map(|o| vec![place(o, map.to_strip.s(o.middle().x))]).collect();
    };
    let width: f64 = objects.iter().map(|o| up * o.advance).sum();
    let all = (count * objects.len()) as f64;
    let spare = map.length - count as f64 * width;
    let (gap, mut at) = match objects.first() {
        Some(o) if map.closed => (spare / all, first - 0.5 * up * o.advance),
        _ if all > 1.0 => (spare / (all - 1.0), first),
        _ => (0.0, first + 0.5 * spare),
    };
    let mut out = vec![Vec::with_capacity(count); objects.len()];
    for _ in 0..count {
        for (o, places) in objects.iter().zip(&mut out) {
            places.push(place(o, at + 0.5 * up * o.advance));
            at += up * o.advance + gap;
        }
    }
    out
}

/// Warns of letters that are squeezed or mirrored, and of letters that collide.
pub(super) fn warnings(letters: &[Letter], places: &[Vec<Affine>]) -> Vec<String> {
    let mut out = Vec::new();
    /// Share of its width below which a letter is illegible.
    const THIN: f64 = 0.1;
    let share = |m: &Affine| {
        let [a, b, c, d, ..] = m.as_coeffs();
        m.determinant() / (a.hypot(b) * c.hypot(d))
    };
    let lost = letters.iter().zip(places).filter(|(_, p)| p.iter().any(|m| share(m) < THIN));
    let lost: Vec<&str> = lost.map(|(l, _)| l.name.as_str()).collect();
    if !lost.is_empty() {
        out.push(format!(
            "bend: the skeleton is too steep or runs backwards at the letters {}: they are squeezed flat or mirrored; `glyphs rotate` \
and `glyphs stair` keep every letter legible",
            listed(&lost)
        ));
    }
    let mut crowded: Vec<(String, Point)> = Vec::new();
    let mut look = |a: usize, b: usize, next: usize| {
        let pairs = places[a].iter().zip(places[b].iter().cycle().skip(next));
        if let Some(at) = collision(&letters[a], &letters[b], pairs) {
            crowded.push((format!("{}{}", letters[a].name, letters[b].name), at));
        }
    };
    for line in lines(letters) {
        line.windows(2).for_each(|p| look(p[0], p[1], 0));
        // The end of every copy meets the start of the next, or its start on a closed skeleton.
        if let (Some(&first), Some(&last)) = (line.first(), line.last())
            && (line.len() > 1 || places[first].len() > 1)
        {
            look(last, first, 1);
        }
    }
    if let Some((_, at)) = crowded.first() {
        let names: Vec<&str> = crowded.iter().map(|(n, _)| n.as_str()).collect();
        out.push(format!(
            "bend: the letters {} collide, first near {}: the skeleton is too short for them or bends too tightly; a \
smaller `width`, `spacing even` or a gentler bend avoids that",
            listed(&names),
            show(*at)
        ));
    }
    out
}

/// Samples the outlines of letters in all their copies, letter by letter.
pub(super) fn points<'a>(
    letters: &'a [Letter],
    copies: &'a [Affine],
) -> impl Iterator<Item = (Point, Option<&'a Letter>)> {
    /// Number of points per segment.
    const SAMPLES: u32 = 8;
    let copies = or_identity(copies);
    let each = letters.iter().flat_map(move |l| copies.iter().map(move |c| (l, *c)));
    each.flat_map(|(l, c)| {
        let on = |s: &'a Seg| (0..SAMPLES).map(move |i| s.eval(f64::from(i) / f64::from(SAMPLES)));
        l.outline.segs().flat_map(on).map(move |p| (c * p, Some(l)))
    })
}

/// Returns a point where two letters, apart in the source, cross under one of the pairs of maps in `places`.
fn collision<'a>(a: &Letter, b: &Letter, places: impl Iterator<Item = (&'a Affine, &'a Affine)>) -> Option<Point> {
    let (left, right) = (Chords::of(&a.outline)?, Chords::of(&b.outline)?);
    let mut places = places.peekable();
    places.peek()?;
    let at = places.find_map(|(p, q)| left.crossing(*p, &right, *q))?;
    left.crossing(Affine::IDENTITY, &right, Affine::IDENTITY).is_none().then_some(at)
}

/// An outline as chords.
struct Chords {
    lines: Vec<Line>,
    rect: Rect,
}

impl Chords {
    fn of(outline: &Outline) -> Option<Self> {
        /// Tolerance as a share of the letter's size. Letters closer than this touch.
        const FINE: f64 = 1e-3;
        let rect = outline.bounding_box()?;
        let fine = (FINE * rect.width().max(rect.height())).max(f64::MIN_POSITIVE);
        let mut lines = Vec::new();
        boundary(outline.to_bez_path(fine), fine, |a, b| lines.push(Line::new(a, b)));
        Some(Self { lines, rect })
    }

    /// Returns the images of the chords that overlap `rect`.
    fn within(&self, m: Affine, rect: Rect) -> Vec<Line> {
        let there = self.lines.iter().map(|l| m * *l);
        there.filter(|l| l.bounding_box().overlaps(rect)).collect()
    }

    /// Returns a point where the two cross.
    fn crossing(&self, m: Affine, other: &Self, n: Affine) -> Option<Point> {
        let (a, b) = (m.transform_rect_bbox(self.rect), n.transform_rect_bbox(other.rect));
        if !a.overlaps(b) {
            return None;
        }
        let both = a.intersect(b);
        let others = other.within(n, both);
        self.within(m, both).into_iter().find_map(|l| others.iter().find_map(|o| cross(l, *o)))
    }
}

fn cross(a: Line, b: Line) -> Option<Point> {
    let (u, v) = (a.p1 - a.p0, b.p1 - b.p0);
    let det = u.cross(v);
    let (s, t) = ((b.p0 - a.p0).cross(v) / det, (b.p0 - a.p0).cross(u) / det);
    ((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t)).then(|| a.p0 + u * s)
}
