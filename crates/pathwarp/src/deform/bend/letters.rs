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

use super::BendMap;
use super::piece::normal;
use crate::error::show;
use crate::param::Letter;
use kurbo::{Affine, Point, Rect, Vec2};

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

/// For every letter its place in each of the copies.
pub(super) fn places(map: &BendMap, setting: Setting, letters: &[Letter], copies: &[Affine]) -> Vec<Vec<Affine>> {
    let here = [Affine::IDENTITY];
    let copies = if copies.is_empty() { &here } else { copies };
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
    for (pair, there) in letters.windows(2).zip(places.windows(2)) {
        if let ([a, b], [p, q]) = (pair, there)
            && let Some(at) = p.iter().zip(q).find_map(|(p, q)| collide(a, b, *p, *q))
        {
            crowded.push((format!("{}{}", a.name, b.name), at));
        }
    }
    if let Some((_, at)) = crowded.first() {
        let names: Vec<&str> = crowded.iter().map(|(n, _)| n.as_str()).collect();
        out.push(format!(
            "bend: the letters {} run into each other, first near {}: the bend is too tight for their size; a smaller --width, \
--spacing even or a gentler bend avoids that",
            listed(&names),
            show(*at)
        ));
    }
    out
}

/// As many names as a line holds.
fn listed(names: &[&str]) -> String {
    const SHOWN: usize = 8;
    let shown = names.iter().take(SHOWN).map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ");
    if names.len() > SHOWN { format!("{shown} and {} more", names.len() - SHOWN) } else { shown }
}

/// Where two neighbours of a line, apart in the source, overlap: at the heights that both of them have, their boxes' sides change
/// places.
fn collide(a: &Letter, b: &Letter, p: Affine, q: Affine) -> Option<Point> {
    let (left, right) = (a.outline.bounding_box()?, b.outline.bounding_box()?);
    if a.origin.y != b.origin.y || right.x0 <= left.x1 {
        return None;
    }
    let both = Rect::new(left.x1, left.y0.max(right.y0), right.x0, left.y1.min(right.y1));
    let heights = if both.y0 < both.y1 { vec![both.y0, both.y1] } else { Vec::new() };
    heights.into_iter().find_map(|y| {
        let (l, r) = (p * Point::new(left.x1, y), q * Point::new(right.x0, y));
        let along = (q * b.middle()) - (p * a.middle());
        ((r - l).dot(along) < 0.0).then_some(l)
    })
}
