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

use super::map::BendMap;
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

    /// Where a letter goes that is moved `by` along the source first.
    fn place(self, map: &BendMap, letter: &Letter, by: f64) -> Affine {
        let anchor = if self == Self::Stair { letter.origin.x } else { letter.middle().x };
        let (c, t) = map.stand(anchor + by);
        let (x, y) = self.axes(t);
        let (x, y) = (x * map.place.up, y * map.place.up);
        let at = c.to_vec2() - x * anchor - y * map.place.base;
        Affine::new([x.x, x.y, y.x, y.y, at.x, at.y])
    }
}

/// Artwork without copies is where it is.
fn or_here(copies: &[Affine]) -> &[Affine] {
    if copies.is_empty() { &[Affine::IDENTITY] } else { copies }
}

/// For every letter its place in each of the copies.
pub(super) fn places(map: &BendMap, setting: Setting, letters: &[Letter], copies: &[Affine]) -> Vec<Vec<Affine>> {
    let copies = or_here(copies);
    letters.iter().map(|l| copies.iter().map(|c| setting.place(map, l, c.translation().x)).collect()).collect()
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
            "bend: the skeleton is too steep or runs backwards at the letters {}: they are squeezed flat or mirrored; --glyphs rotate \
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
    let mut first = 0;
    /// Baselines nearer than this share of an advance are one.
    const ONE_LINE: f64 = 1e-3;
    for line in letters.chunk_by(|a, b| (a.origin.y - b.origin.y).abs() <= ONE_LINE * a.advance) {
        let last = first + line.len() - 1;
        (first..last).for_each(|i| look(i, i + 1, 0));
        // The end of every copy and the beginning of the next, or of the same one all round.
        if first < last || places[first].len() > 1 {
            look(last, first, 1);
        }
        first = last + 1;
    }
    if let Some((_, at)) = crowded.first() {
        let names: Vec<&str> = crowded.iter().map(|(n, _)| n.as_str()).collect();
        out.push(format!(
            "bend: the letters {} run into each other, first near {}: the skeleton is too short for them or bends too tightly; a \
smaller --width, --spacing even or a gentler bend avoids that",
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
