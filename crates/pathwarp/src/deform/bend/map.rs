//! The map: pieces of the skeleton side by side, and where the artwork stands on them.

use super::letters::listed;
use super::piece::{Piece, Shape};
use crate::error::show;
use crate::map::{AffineMap, Class, Crease, Creases, Jet, Level, Map, RationalBezier};
use crate::param::Letter;
use kurbo::{Affine, Point, Rect, Vec2};
use std::sync::Arc;

/// From the artwork to the strip: distance s = k·x + origin, height d = up·(base − y).
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) k: f64,
    pub(super) origin: f64,
    pub(super) up: f64,
    pub(super) base: f64,
}

impl Place {
    pub(super) fn s(&self, x: f64) -> f64 {
        self.k * x + self.origin
    }

    fn d(&self, y: f64) -> f64 {
        (self.base - y) * self.up
    }

    /// The jet on `piece`, which begins at distance `begin`.
    fn jet(&self, piece: &Piece, begin: f64, p: Point) -> Jet {
        let (at, ds, dd) = piece.jet(self.s(p.x) - begin, self.d(p.y));
        Jet { p: at, dx: ds * self.k, dy: dd * -self.up }
    }
}

/// The map: pieces side by side.
#[derive(Clone)]
pub(super) struct BendMap {
    pub(super) pieces: Vec<Arc<Piece>>,
    pub(super) length: f64,
    pub(super) closed: bool,
    pub(super) place: Place,
    /// The x for which creases are told.
    pub(super) reach: (f64, f64),
}

impl BendMap {
    /// The piece at distance `s`, and the distance at which its own begins there.
    fn piece(&self, s: f64) -> (&Arc<Piece>, f64) {
        let turn = if self.closed { (s / self.length).floor() * self.length } else { 0.0 };
        let i = self.pieces.partition_point(|p| p.from <= s - turn).max(1) - 1;
        (&self.pieces[i], self.pieces[i].anchor + turn)
    }

    /// The place at distance `s` on the skeleton, and the unit tangent there.
    pub(super) fn stand(&self, s: f64) -> (Point, Vec2) {
        let (piece, begin) = self.piece(s);
        let (at, along, _) = piece.jet(s - begin, 0.0);
        (at, along / along.hypot())
    }

    /// A skeleton that is one straight line bends nothing.
    pub(super) fn simplest(&self) -> Arc<dyn Map> {
        match &self.pieces[..] {
            [only] if !self.closed => match OnPiece::new(only, only.anchor, self.place).affine() {
                Some(m) => Arc::new(AffineMap(m)),
                None => Arc::new(self.clone()),
            },
            _ => Arc::new(self.clone()),
        }
    }

    /// A warning if the artwork is turned over somewhere: of letters at the points of their outlines, each with its letter; of
    /// other artwork at those of its box ([`edges`]). The determinant is linear in the height, so that the highest and lowest
    /// places are where it is worst.
    pub(super) fn fold<'a>(&self, points: impl Iterator<Item = (Point, Option<&'a Letter>)>) -> Option<String> {
        let det = |x: f64, y: f64| self.jet(Point::new(x, y)).det() / (self.place.k * self.place.up);
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
        let on = det(p.x, self.place.base);
        // Where the line between them crosses zero: the centre of curvature.
        let centre = self.place.d(p.y).abs() * on / (on - there);
        let names: Vec<&str> = over.iter().map(|l| l.name.as_str()).collect();
        let (who, reaches) = match names.len() {
            0 => ("the artwork folds over itself".to_owned(), "it reaches"),
            1 => (format!("the letter {} folds over itself", listed(&names)), "it reaches"),
            _ => (format!("the letters {} fold over themselves", listed(&names)), "they reach"),
        };
        Some(format!(
            "bend: {who}, worst near {} of the skeleton, where {reaches} more than {centre:.6} away from it, beyond the centre of \
curvature; a smaller `width`, another `baseline` or a gentler bend avoids that",
            show(self.point(Point::new(p.x, self.place.base)))
        ))
    }
}

/// Points along the top and the bottom of a box.
pub(super) fn edges(rect: Rect) -> impl Iterator<Item = Point> {
    const SAMPLES: u32 = 1024;
    (0..=SAMPLES).flat_map(move |i| {
        let x = rect.x0 + rect.width() * (f64::from(i) + 0.5) / f64::from(SAMPLES + 1);
        [rect.y0, rect.y1].map(|y| Point::new(x, y))
    })
}

impl Map for BendMap {
    fn jet(&self, p: Point) -> Jet {
        let (piece, begin) = self.piece(self.place.s(p.x));
        self.place.jet(piece, begin, p)
    }

    /// Uprights at the skeleton's joints.
    fn creases(&self, out: &mut Creases) {
        /// Turns round a closed skeleton whose joints are told.
        const MOST_TURNS: f64 = 64.0;
        let (a, b) = (self.place.s(self.reach.0), self.place.s(self.reach.1));
        let turns = |s: f64| if self.closed { (s / self.length).floor() } else { 0.0 };
        let (mut turn, last) = (turns(a), turns(b));
        let last = last.min(turn + MOST_TURNS);
        while turn <= last {
            for s in self.pieces.iter().map(|p| p.from).filter(|s| s.is_finite()) {
                let c = self.place.origin - s - turn * self.length;
                out.push(Crease::kink(Level::Line { a: self.place.k, b: 0.0, c }));
            }
            turn += 1.0;
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let (piece, begin) = self.piece(self.place.s(inside.x));
        Some(Arc::new(OnPiece::new(piece, begin, self.place)))
    }
}

/// The smooth map on one piece.
struct OnPiece {
    piece: Arc<Piece>,
    begin: f64,
    place: Place,
}

impl OnPiece {
    fn new(piece: &Arc<Piece>, begin: f64, place: Place) -> Self {
        Self { piece: Arc::clone(piece), begin, place }
    }

    fn affine(&self) -> Option<Affine> {
        let Shape::Straight { p, t, n } = &self.piece.shape else { return None };
        let Place { k, up, .. } = self.place;
        let at = *p + *t * (self.place.s(0.0) - self.begin) + *n * self.place.d(0.0);
        Some(Affine::new([t.x * k, t.y * k, -n.x * up, -n.y * up, at.x, at.y]))
    }
}

impl Map for OnPiece {
    fn jet(&self, p: Point) -> Jet {
        self.place.jet(&self.piece, self.begin, p)
    }

    fn class(&self) -> Class {
        self.affine().map_or(Class::Smooth, Class::Affine)
    }

    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        if let Some(m) = self.affine() {
            return AffineMap(m).image(curve);
        }
        let Shape::Ribbon { ribbon, unit, table: None } = &self.piece.shape else { return None };
        let Place { k, origin, up, base } = self.place;
        let (length, v) = (self.piece.length, up / unit);
        let to_uv = Affine::new([k / length, 0.0, 0.0, -v, (origin - self.begin) / length, base * v]);
        Some(ribbon.image(&AffineMap(to_uv).image(curve)?))
    }
}
