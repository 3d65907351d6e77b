//! The map: pieces of the skeleton side by side, and the artwork's position on them.

use super::listed::listed;
use super::piece::{SkeletonPiece, Strip};
use crate::error::show;
use crate::map::Cost;
use crate::map::{AffineMap, Class, Crease, Creases, Jet, Level, Map, RationalBezier};
use crate::param::Letter;
use kurbo::{Affine, Point, Rect, Vec2};
use std::sync::Arc;

/// The map from the artwork to the strip: distance s = k·x + origin, height d = up·(base − y).
#[derive(Debug, Clone, Copy)]
pub(super) struct ToStrip {
    pub(super) k: f64,
    pub(super) origin: f64,
    pub(super) up: f64,
    pub(super) base: f64,
}

impl ToStrip {
    pub(super) fn s(&self, x: f64) -> f64 {
        self.k * x + self.origin
    }

    fn d(&self, y: f64) -> f64 {
        (self.base - y) * self.up
    }

    /// Returns the point on `piece`, which begins at distance `begin`.
    fn point(&self, piece: &SkeletonPiece, begin: f64, p: Point) -> Point {
        piece.point(self.s(p.x) - begin, self.d(p.y))
    }

    /// Returns the jet on `piece`, which begins at distance `begin`.
    fn jet(&self, piece: &SkeletonPiece, begin: f64, p: Point) -> Jet {
        let (at, ds, dd) = piece.jet(self.s(p.x) - begin, self.d(p.y));
        Jet { p: at, dx: ds * self.k, dy: dd * -self.up }
    }
}

/// The map: pieces side by side.
#[derive(Clone)]
pub(super) struct BendMap {
    pub(super) pieces: Vec<Arc<SkeletonPiece>>,
    pub(super) length: f64,
    pub(super) closed: bool,
    pub(super) to_strip: ToStrip,
    /// The range of x in which creases are reported.
    pub(super) reach: (f64, f64),
}

impl BendMap {
    /// Returns the piece at distance `s`, and the distance of its start.
    fn piece(&self, s: f64) -> (&Arc<SkeletonPiece>, f64) {
        let turn = if self.closed { (s / self.length).floor() * self.length } else { 0.0 };
        let i = self.pieces.partition_point(|p| p.from <= s - turn).max(1) - 1;
        (&self.pieces[i], self.pieces[i].anchor + turn)
    }

    /// Returns the point at distance `s` on the skeleton, and the unit tangent there.
    pub(super) fn stand(&self, s: f64) -> (Point, Vec2) {
        let (piece, begin) = self.piece(s);
        let (at, along, _) = piece.jet(s - begin, 0.0);
        (at, along / along.hypot())
    }

    /// Returns an affine map if the skeleton is one straight line.
    pub(super) fn simplest(&self) -> Arc<dyn Map> {
        match &self.pieces[..] {
            [only] if !self.closed => match OnPiece::new(only, only.anchor, self.to_strip).affine() {
                Some(m) => Arc::new(AffineMap(m)),
                None => Arc::new(self.clone()),
            },
            _ => Arc::new(self.clone()),
        }
    }

    /// Warns if the artwork folds over itself. `points` samples the outlines of letters, each with its letter, or the box of
    /// other artwork ([`edges`]). The determinant is linear in the height, so that it is worst at the highest and lowest points.
    pub(super) fn fold<'a>(&self, points: impl Iterator<Item = (Point, Option<&'a Letter>)>) -> Option<String> {
        let det = |x: f64, y: f64| self.jet(Point::new(x, y)).det() / (self.to_strip.k * self.to_strip.up);
        let mut worst: Option<(f64, Point)> = None;
        let mut over: Vec<&Letter> = Vec::new();
        for (p, letter) in points {
            let there = det(p.x, p.y);
            if there >= 0.0 {
                continue;
            }
            if worst.is_none_or(|(w, _)| there < w) {
                worst = Some((there, p));
            }
            over.extend(letter.filter(|l| over.last().is_none_or(|o| !std::ptr::eq(*o, *l))));
        }
        let (there, p) = worst?;
        let on = det(p.x, self.to_strip.base);
        // The linear determinant vanishes at the centre of curvature.
        let centre = self.to_strip.d(p.y).abs() * on / (on - there);
        let names: Vec<&str> = over.iter().map(|l| l.name.as_str()).collect();
        let (who, reaches) = match names.len() {
            0 => ("the artwork folds over itself".to_owned(), "it reaches"),
            1 => (format!("the letter {} folds over itself", listed(&names)), "it reaches"),
            _ => (format!("the letters {} fold over themselves", listed(&names)), "they reach"),
        };
        Some(format!(
            "bend: {who}, worst near {} of the skeleton, where {reaches} more than {centre:.6} away from it, beyond the centre of \
curvature; a smaller `width`, another `baseline` or a gentler bend avoids that",
            show(self.point(Point::new(p.x, self.to_strip.base)))
        ))
    }
}

/// Samples the top and the bottom of a box.
pub(super) fn edges(rect: Rect) -> impl Iterator<Item = Point> {
    const SAMPLES: u32 = 1024;
    (0..=SAMPLES).flat_map(move |i| {
        let x = rect.x0 + rect.width() * (f64::from(i) + 0.5) / f64::from(SAMPLES + 1);
        [rect.y0, rect.y1].map(|y| Point::new(x, y))
    })
}

impl Map for BendMap {
    /// A jet on a curve takes less than half as long as one of a net: 7 ns on the hairpin of `tests/cli/report.rs`.
    fn cost(&self) -> Cost<'_> {
        /// The first pieces stand for all.
        const FIRST: usize = 16;
        const CURVE: f64 = 0.4;
        const SINGLY: f64 = 3.0;
        let work = self.pieces.iter().take(FIRST).map(|p| p.work()).fold(1.0, f64::max);
        Cost { jet: if work > 1.0 { SINGLY * work } else { CURVE }, ..Cost::new(work) }
    }

    fn jet(&self, p: Point) -> Jet {
        let (piece, begin) = self.piece(self.to_strip.s(p.x));
        self.to_strip.jet(piece, begin, p)
    }

    fn point(&self, p: Point) -> Point {
        let (piece, begin) = self.piece(self.to_strip.s(p.x));
        self.to_strip.point(piece, begin, p)
    }

    /// Verticals at the skeleton's joints.
    fn creases(&self, out: &mut Creases) {
        /// Limit on the turns around a closed skeleton whose joints are reported.
        const MAX_TURNS: f64 = 64.0;
        let (a, b) = (self.to_strip.s(self.reach.0), self.to_strip.s(self.reach.1));
        let turns = |s: f64| if self.closed { (s / self.length).floor() } else { 0.0 };
        let (first, last) = (turns(a), turns(b));
        if first > last || (first - last).is_nan() {
            return;
        }
        // Far out, a turn more is the same number.
        for turn in (0..=(last - first).min(MAX_TURNS) as usize).map(|n| first + n as f64) {
            for s in self.pieces.iter().map(|p| p.from).filter(|s| s.is_finite()) {
                let c = self.to_strip.origin - s - turn * self.length;
                out.push(Crease::kink(Level::Line { a: self.to_strip.k, b: 0.0, c }));
            }
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let (piece, begin) = self.piece(self.to_strip.s(inside.x));
        Some(Arc::new(OnPiece::new(piece, begin, self.to_strip)))
    }
}

/// The smooth map on one piece.
struct OnPiece {
    piece: Arc<SkeletonPiece>,
    begin: f64,
    to_strip: ToStrip,
}

impl OnPiece {
    fn new(piece: &Arc<SkeletonPiece>, begin: f64, to_strip: ToStrip) -> Self {
        Self { piece: Arc::clone(piece), begin, to_strip }
    }

    fn affine(&self) -> Option<Affine> {
        let Strip::Straight { p, t, n } = &self.piece.strip else { return None };
        let ToStrip { k, up, .. } = self.to_strip;
        let at = *p + *t * (self.to_strip.s(0.0) - self.begin) + *n * self.to_strip.d(0.0);
        Some(Affine::new([t.x * k, t.y * k, -n.x * up, -n.y * up, at.x, at.y]))
    }
}

impl Map for OnPiece {
    fn cost(&self) -> Cost<'_> {
        Cost::new(self.piece.work())
    }

    fn jet(&self, p: Point) -> Jet {
        self.to_strip.jet(&self.piece, self.begin, p)
    }

    fn point(&self, p: Point) -> Point {
        self.to_strip.point(&self.piece, self.begin, p)
    }

    fn class(&self) -> Class {
        self.affine().map_or(Class::Smooth, Class::Affine)
    }

    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        if let Some(m) = self.affine() {
            return AffineMap(m).image(curve);
        }
        let Strip::Ribbon { ribbon, unit, table: None } = &self.piece.strip else { return None };
        let ToStrip { k, origin, up, base } = self.to_strip;
        let (length, v) = (self.piece.length, up / unit);
        let to_uv = Affine::new([k / length, 0.0, 0.0, -v, (origin - self.begin) / length, base * v]);
        Some(ribbon.image(&AffineMap(to_uv).image(curve)?))
    }
}
