//! Letters set along the skeleton one by one: each by an affine map of its own, so that only control points move.
//!
//! With C the place on the skeleton, T its unit tangent and N its unit normal where a letter's anchor (the middle of its advance
//! on the baseline) comes to lie, a letter goes by (x, y) ↦ C + X·(x − anchor) + Y·(y − baseline):
//!
//! | setting | X | Y | what holds |
//! |---|---|---|---|
//! | rotate | T | −N | letters turn and keep their shape |
//! | skew | T | down | uprights stay upright, the foot follows the path |
//! | ribbon | right | −N | levels stay level, uprights stand on the path |
//! | stair | right | down | letters only move; the anchor is where the advance begins |
//!
//! These are the type-on-a-path effects Rainbow, Skew, 3D Ribbon and Stair Step of Adobe Illustrator's manual.

use super::map::{BendMap, Place};
use super::piece::normal;
use crate::error::show;
use crate::outline::{Outline, Seg};
use crate::param::Letter;
use kurbo::{Affine, Line, PathEl, Point, Rect, Shape as _, Vec2};

/// How a letter stands on the skeleton.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Setting {
    Rotate,
    Skew,
    Ribbon,
    Stair,
}

impl Setting {
    /// The one of this name; `None` if letters bend.
    pub(super) fn named(name: &str) -> Option<Self> {
        match name {
            "rotate" => Some(Self::Rotate),
            "skew" => Some(Self::Skew),
            "ribbon" => Some(Self::Ribbon),
            "stair" => Some(Self::Stair),
            _ => None,
        }
    }

    fn axes(self, t: Vec2) -> (Vec2, Vec2) {
        let (right, down) = (Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0));
        match self {
            Self::Rotate => (t, -normal(t)),
            Self::Skew => (t, down),
            Self::Ribbon => (right, -normal(t)),
            Self::Stair => (right, down),
        }
    }

    /// Where a letter goes whose anchor comes to distance `s`.
    fn place(self, map: &BendMap, letter: &Letter, s: f64) -> Affine {
        let (c, t) = map.stand(s);
        let (x, y) = self.axes(t);
        let (x, y) = (x * map.place.up, y * map.place.up);
        let at = c.to_vec2() - x * self.anchor(letter) - y * map.place.base;
        Affine::new([x.x, x.y, y.x, y.y, at.x, at.y])
    }

    fn anchor(self, letter: &Letter) -> f64 {
        if self == Self::Stair { letter.origin.x } else { letter.middle().x }
    }

    /// The distances on the skeleton of letters that are spread over it: of every line, the gaps grow alike, those between words
    /// twice, until it reaches from end to end of its share. All round a closed skeleton there is one more gap between words.
    fn spread(self, map: &BendMap, letters: &[Letter]) -> Vec<f64> {
        /// A gap wider than this share of its line's mean advance is one between words.
        const BETWEEN_WORDS: f64 = 0.2;
        let Place { up, .. } = map.place;
        let mut out = vec![0.0; letters.len()];
        for line in lines(letters) {
            let end = |i: usize| letters[i].origin.x + letters[i].advance;
            let (Some(&first), Some(&last)) = (line.first(), line.last()) else { continue };
            let gaps: Vec<f64> = line.windows(2).map(|p| letters[p[1]].origin.x - end(p[0])).collect();
            let advances: f64 = line.iter().map(|i| letters[*i].advance).sum();
            let wide = BETWEEN_WORDS * advances / line.len() as f64;
            let weight = |gap: f64| if gap > wide { 2.0 } else { 1.0 };
            let round = if map.closed { weight(f64::INFINITY) } else { 0.0 };
            let weights = gaps.iter().map(|g| weight(*g)).sum::<f64>() + round;
            let (from, to) = (map.place.s(letters[first].origin.x), map.place.s(end(last)));
            let spare = to - from - up * (end(last) - letters[first].origin.x);
            // A letter alone stands in the middle.
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

/// Artwork without copies is where it is.
fn or_here(copies: &[Affine]) -> &[Affine] {
    if copies.is_empty() { &[Affine::IDENTITY] } else { copies }
}

/// The letters of every line from left to right, by their numbers.
fn lines(letters: &[Letter]) -> Vec<Vec<usize>> {
    /// Baselines nearer than this share of an advance are one.
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

/// For every letter its place in each of the copies. `spread`: over all the skeleton, with gaps that grow alike.
pub(super) fn places(
    map: &BendMap,
    setting: Setting,
    letters: &[Letter],
    copies: &[Affine],
    spread: bool,
) -> Vec<Vec<Affine>> {
    let at = if spread {
        setting.spread(map, letters)
    } else {
        letters.iter().map(|l| map.place.s(setting.anchor(l))).collect()
    };
    let all = |(l, s): (&Letter, f64)| {
        let further = or_here(copies).iter().map(|c| map.place.k * c.translation().x);
        further.map(|by| setting.place(map, l, s + by)).collect()
    };
    letters.iter().zip(at).map(all).collect()
}

/// What is to be said about letters that were placed.
pub(super) fn warnings(letters: &[Letter], places: &[Vec<Affine>]) -> Vec<String> {
    let mut out = Vec::new();
    /// A letter that is left with less of its width than this cannot be read.
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
and stair keep every letter readable",
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
        // The end of every copy and the beginning of the next, or of the same one all round.
        if let (Some(&first), Some(&last)) = (line.first(), line.last())
            && (line.len() > 1 || places[first].len() > 1)
        {
            look(last, first, 1);
        }
    }
    if let Some((_, at)) = crowded.first() {
        let names: Vec<&str> = crowded.iter().map(|(n, _)| n.as_str()).collect();
        out.push(format!(
            "bend: the letters {} run into each other, first near {}: the skeleton is too short for them or bends too tightly; a \
smaller `width`, `spacing even` or a gentler bend avoids that",
            listed(&names),
            show(*at)
        ));
    }
    out
}

/// As many names as a line holds.
pub(super) fn listed(names: &[&str]) -> String {
    const SHOWN: usize = 8;
    let shown = names.iter().take(SHOWN).map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ");
    if names.len() > SHOWN { format!("{shown} and {} more", names.len() - SHOWN) } else { shown }
}

/// Points on the outlines of letters in all their copies, letter by letter.
pub(super) fn points<'a>(
    letters: &'a [Letter],
    copies: &'a [Affine],
) -> impl Iterator<Item = (Point, Option<&'a Letter>)> {
    /// Points a segment.
    const SAMPLES: u32 = 8;
    let copies = or_here(copies);
    let each = letters.iter().flat_map(move |l| copies.iter().map(move |c| (l, *c)));
    each.flat_map(|(l, c)| {
        let on = |s: &'a Seg| (0..SAMPLES).map(move |i| s.eval(f64::from(i) / f64::from(SAMPLES)));
        l.outline.segs().flat_map(on).map(move |p| (c * p, Some(l)))
    })
}

/// Where two letters that are apart in the source cross each other in one of their `places`.
fn collision<'a>(a: &Letter, b: &Letter, places: impl Iterator<Item = (&'a Affine, &'a Affine)>) -> Option<Point> {
    let (left, right) = (Chords::of(&a.outline)?, Chords::of(&b.outline)?);
    let mut places = places.peekable();
    places.peek()?;
    let at = places.find_map(|(p, q)| left.crossing(*p, &right, *q))?;
    left.crossing(Affine::IDENTITY, &right, Affine::IDENTITY).is_none().then_some(at)
}

/// An outline as straight lines.
struct Chords {
    lines: Vec<Line>,
    rect: Rect,
}

impl Chords {
    fn of(outline: &Outline) -> Option<Self> {
        /// Fineness as a share of the letter's size: letters nearer than this touch.
        const FINE: f64 = 1e-3;
        let rect = outline.bounding_box()?;
        let fine = (FINE * rect.width().max(rect.height())).max(f64::MIN_POSITIVE);
        let mut lines = Vec::new();
        let mut at = Point::ORIGIN;
        let mut start = at;
        kurbo::flatten(outline.to_bez_path(fine), fine, |e| match e {
            PathEl::MoveTo(p) => (start, at) = (p, p),
            PathEl::LineTo(p) => {
                lines.push(Line::new(at, p));
                at = p;
            }
            _ => {
                lines.push(Line::new(at, start));
                at = start;
            }
        });
        Some(Self { lines, rect })
    }

    /// The lines that `m` takes into `rect`.
    fn within(&self, m: Affine, rect: Rect) -> Vec<Line> {
        let there = self.lines.iter().map(|l| m * *l);
        there.filter(|l| l.bounding_box().overlaps(rect)).collect()
    }

    /// Where the two cross.
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
