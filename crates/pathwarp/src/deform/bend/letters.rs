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

use super::map::{BendMap, ToStrip, list_names, normal};
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
    /// Returns X and Y of the table for the unit tangent `t`.
    fn axes(self, t: Vec2) -> (Vec2, Vec2) {
        let (right, down) = (Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0));
        match self {
            Self::Rotate => (t, -normal(t)),
            Self::Skew => (t, down),
            Self::Ribbon => (right, -normal(t)),
            Self::Stair => (right, down),
        }
    }

    /// Returns the map of a letter that takes the anchor at `x0` on the baseline to distance `s`.
    fn letter_map(self, map: &BendMap, x0: f64, s: f64) -> Affine {
        let (c, t) = map.frame_at(s);
        let (x, y) = self.axes(t);
        let (x, y) = (x * map.to_strip.y_scale, y * map.to_strip.y_scale);
        let shift = c.to_vec2() - x * x0 - y * map.to_strip.baseline;
        Affine::new([x.x, x.y, y.x, y.y, shift.x, shift.y])
    }

    /// Returns the x of the point of a letter that comes to the skeleton.
    fn anchor(self, letter: &Letter) -> f64 {
        if self == Self::Stair { letter.origin.x } else { letter.middle().x }
    }

    /// Returns the distances along the skeleton at which letters spread over it have their anchors. The gaps of every line grow by the same
    /// amount, gaps between words by twice as much, until the line reaches from end to end. A closed skeleton has one more gap between
    /// words, half of it before the first letter.
    fn spread_distances(self, to_strip: &ToStrip, closed: bool, letters: &[Letter]) -> Vec<f64> {
        /// A gap wider than this share of its line's mean advance separates words.
        const BETWEEN_WORDS: f64 = 0.2;
        let scale = to_strip.y_scale;
        let mut out = vec![0.0; letters.len()];
        for line in lines(letters) {
            let end = |i: usize| letters[i].origin.x + letters[i].advance;
            let (Some(&first), Some(&last)) = (line.first(), line.last()) else { continue };
            let gaps: Vec<f64> = line.windows(2).map(|p| letters[p[1]].origin.x - end(p[0])).collect();
            let advances: f64 = line.iter().map(|i| letters[*i].advance).sum();
            let word_gap = BETWEEN_WORDS * advances / line.len() as f64;
            let weight = |gap: f64| if gap > word_gap { 2.0 } else { 1.0 };
            let closing_weight = if closed { weight(f64::INFINITY) } else { 0.0 };
            let weights = gaps.iter().map(|g| weight(*g)).sum::<f64>() + closing_weight;
            let (from, to) = (to_strip.s(letters[first].origin.x), to_strip.s(end(last)));
            let spare = to - from - scale * (end(last) - letters[first].origin.x);
            // A single letter is centred.
            let (growth, mut s) = if weights > 0.0 { (spare / weights, from) } else { (0.0, from + 0.5 * spare) };
            s += 0.5 * closing_weight * growth;
            for (k, i) in line.into_iter().enumerate() {
                out[i] = s + scale * (self.anchor(&letters[i]) - letters[i].origin.x);
                let gap = gaps.get(k).copied().unwrap_or_default();
                s += scale * (letters[i].advance + gap) + growth * weight(gap);
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

/// Returns the maps of every letter, one for each of the copies. `spread` distributes the letters over the whole skeleton.
pub(super) fn letter_maps(
    map: &BendMap,
    setting: LetterSetting,
    letters: &[Letter],
    copies: &[Affine],
    spread: bool,
) -> Vec<Vec<Affine>> {
    let distances = if spread {
        setting.spread_distances(&map.to_strip, map.closed, letters)
    } else {
        letters.iter().map(|l| map.to_strip.s(setting.anchor(l))).collect()
    };
    let maps = |(l, s): (&Letter, f64)| {
        let shifts = or_identity(copies).iter().map(|c| map.to_strip.x_scale * c.translation().x);
        shifts.map(|shift| setting.letter_map(map, setting.anchor(l), s + shift)).collect()
    };
    letters.iter().zip(distances).map(maps).collect()
}

/// Returns the translations of letters in the source plane that spread them around a closed skeleton by larger spaces, one for each
/// letter. `ring_strip` is the map to the strip that would stretch the artwork around it.
pub(super) fn ring_translations(map: &BendMap, letters: &[Letter], ring_strip: ToStrip) -> Vec<Vec<Affine>> {
    let distances = LetterSetting::Rotate.spread_distances(&ring_strip, true, letters);
    let dx = |l: &Letter, s: f64| (s - map.to_strip.s(l.middle().x)) / map.to_strip.x_scale;
    letters.iter().zip(distances).map(|(l, s)| vec![Affine::translate((dx(l, s), 0.0))]).collect()
}

/// Returns the maps of every object, one for each of `count` copies of the row, with equal gaps between all objects. The first begins at
/// the distance `first_at`; on a closed skeleton its middle is there. Without `count`, there is one copy, at the distances drawn.
pub(super) fn object_maps(
    map: &BendMap,
    setting: LetterSetting,
    objects: &[Letter],
    count: Option<usize>,
    first_at: f64,
) -> Vec<Vec<Affine>> {
    let scale = map.to_strip.y_scale;
    let object_map = |o: &Letter, s: f64| setting.letter_map(map, o.middle().x, s);
    let Some(count) = count else {
        return objects.iter().map(|o| vec![object_map(o, map.to_strip.s(o.middle().x))]).collect();
    };
    let width: f64 = objects.iter().map(|o| scale * o.advance).sum();
    let total = (count * objects.len()) as f64;
    let spare = map.length - count as f64 * width;
    let (gap, mut s) = match objects.first() {
        Some(o) if map.closed => (spare / total, first_at - 0.5 * scale * o.advance),
        _ if total > 1.0 => (spare / (total - 1.0), first_at),
        _ => (0.0, first_at + 0.5 * spare),
    };
    let mut out = vec![Vec::with_capacity(count); objects.len()];
    for _ in 0..count {
        for (o, maps) in objects.iter().zip(&mut out) {
            maps.push(object_map(o, s + 0.5 * scale * o.advance));
            s += scale * o.advance + gap;
        }
    }
    out
}

/// Warns of letters that are squeezed or mirrored, and of letters that collide.
pub(super) fn warnings(letters: &[Letter], maps: &[Vec<Affine>]) -> Vec<String> {
    let mut out = Vec::new();
    /// Share of its width below which a sheared letter is illegible.
    const THIN: f64 = 0.1;
    // The sine of the angle between the images of horizontals and verticals.
    let width_share = |m: &Affine| {
        let [a, b, c, d, ..] = m.as_coeffs();
        m.determinant() / (a.hypot(b) * c.hypot(d))
    };
    let illegible = letters.iter().zip(maps).filter(|(_, m)| m.iter().any(|m| width_share(m) < THIN));
    let illegible: Vec<&str> = illegible.map(|(l, _)| l.name.as_str()).collect();
    if !illegible.is_empty() {
        out.push(format!(
            "bend: the skeleton is too steep or runs backwards at the letters {}: they are squeezed flat or mirrored; `glyphs rotate` \
and `glyphs stair` keep every letter legible",
            list_names(&illegible)
        ));
    }
    let mut collisions: Vec<(String, Point)> = Vec::new();
    // Compares letter a with letter b of the copy that is so many further.
    let mut compare = |a: usize, b: usize, further: usize| {
        let pairs = maps[a].iter().zip(maps[b].iter().cycle().skip(further));
        if let Some(at) = collision(&letters[a], &letters[b], pairs) {
            collisions.push((format!("{}{}", letters[a].name, letters[b].name), at));
        }
    };
    for line in lines(letters) {
        line.windows(2).for_each(|p| compare(p[0], p[1], 0));
        // The end of every copy meets the start of the next, or its start on a closed skeleton.
        if let (Some(&first), Some(&last)) = (line.first(), line.last())
            && (line.len() > 1 || maps[first].len() > 1)
        {
            compare(last, first, 1);
        }
    }
    if let Some((_, at)) = collisions.first() {
        let names: Vec<&str> = collisions.iter().map(|(n, _)| n.as_str()).collect();
        out.push(format!(
            "bend: the letters {} collide, first near {}: the skeleton is too short for them or bends too tightly; a \
smaller `width`, `spacing even` or a gentler bend avoids that",
            list_names(&names),
            show(*at)
        ));
    }
    out
}

/// Samples the outlines of letters in all their copies, letter by letter.
pub(super) fn samples<'a>(
    letters: &'a [Letter],
    copies: &'a [Affine],
) -> impl Iterator<Item = (Point, Option<&'a Letter>)> {
    /// Number of points per segment.
    const SAMPLES: u32 = 8;
    let copies = or_identity(copies);
    let each = letters.iter().flat_map(move |l| copies.iter().map(move |c| (l, *c)));
    each.flat_map(|(l, c)| {
        let on_segment = |s: &'a Seg| (0..SAMPLES).map(move |i| s.eval(f64::from(i) / f64::from(SAMPLES)));
        l.outline.segs().flat_map(on_segment).map(move |p| (c * p, Some(l)))
    })
}

/// Returns a point where two letters, which do not cross in the source, cross under one of the pairs of maps.
fn collision<'a>(a: &Letter, b: &Letter, mut maps: impl Iterator<Item = (&'a Affine, &'a Affine)>) -> Option<Point> {
    let (left, right) = (Chords::from_outline(&a.outline)?, Chords::from_outline(&b.outline)?);
    let at = maps.find_map(|(p, q)| left.crossing(*p, &right, *q))?;
    left.crossing(Affine::IDENTITY, &right, Affine::IDENTITY).is_none().then_some(at)
}

/// An outline as chords.
struct Chords {
    lines: Vec<Line>,
    rect: Rect,
}

impl Chords {
    fn from_outline(outline: &Outline) -> Option<Self> {
        /// Tolerance as a share of the letter's size. Letters closer than this touch.
        const TOLERANCE: f64 = 1e-3;
        let rect = outline.bounding_box()?;
        let tolerance = (TOLERANCE * rect.width().max(rect.height())).max(f64::MIN_POSITIVE);
        let mut lines = Vec::new();
        boundary(outline.to_bez_path(tolerance), tolerance, |a, b| lines.push(Line::new(a, b)));
        Some(Self { lines, rect })
    }

    /// Returns the images of the chords under `m` that overlap `rect`.
    fn images_overlapping(&self, m: Affine, rect: Rect) -> Vec<Line> {
        let images = self.lines.iter().map(|l| m * *l);
        images.filter(|l| l.bounding_box().overlaps(rect)).collect()
    }

    /// Returns a point where the image under `m` crosses that of `other` under `n`.
    fn crossing(&self, m: Affine, other: &Self, n: Affine) -> Option<Point> {
        let (a, b) = (m.transform_rect_bbox(self.rect), n.transform_rect_bbox(other.rect));
        if !a.overlaps(b) {
            return None;
        }
        let both = a.intersect(b);
        let others = other.images_overlapping(n, both);
        self.images_overlapping(m, both).into_iter().find_map(|l| others.iter().find_map(|o| intersection(l, *o)))
    }
}

fn intersection(a: Line, b: Line) -> Option<Point> {
    let (u, v) = (a.p1 - a.p0, b.p1 - b.p0);
    let det = u.cross(v);
    let (s, t) = ((b.p0 - a.p0).cross(v) / det, (b.p0 - a.p0).cross(u) / det);
    ((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t)).then(|| a.p0 + u * s)
}
