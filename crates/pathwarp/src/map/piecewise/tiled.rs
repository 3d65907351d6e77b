//! Tiled maps: rows of smooth maps, each responsible for a rectangle of the source plane.
//!
//! The outermost tiles continue beyond the region. The lines between tiles are creases: horizontal lines between rows, and
//! vertical stretches within a row. Neighbours need not agree there; a path across a gap is connected by a straight line.

use crate::budget::{Budget, Search, is_over};
use crate::map::{Cost, Searches};
use crate::map::{Crease, CreaseKind, Creases, INVERSE_WORK, Jet, Level, Map, NewtonInverse, RationalBezier};
use kurbo::{Point, Rect};
use std::sync::Arc;

/// A row of tiles.
#[derive(Clone)]
pub(crate) struct TileRow {
    /// The increasing abscissae between tiles, one fewer than there are tiles.
    pub(crate) cuts: Vec<f64>,
    /// The maps of the tiles from left to right, at least one.
    pub(crate) maps: Vec<Arc<dyn Map>>,
}

/// A map made of rows of tiles.
#[derive(Clone)]
pub(crate) struct Tiled {
    region: Rect,
    /// The increasing ordinates between rows.
    cuts: Vec<f64>,
    rows: Vec<TileRow>,
}

/// Extent of the creases beyond the region, as a multiple of its size. Artwork extends past its frame by less.
const REACH: f64 = 1e3;
/// Margin, as a share of a tile's rectangle, within which answers of its inverse count: for the ends of parts on the border, and
/// their rounding.
const MARGIN: f64 = 1e-9;
/// Tiles that are searched for a point, most often.
const FORESEEN: usize = 2;
/// Distance beyond the region over which the inverse searches, as a multiple of its size.
const INVERSE_REACH: f64 = 0.5;

impl Tiled {
    /// Rows over `region`, divided at the ordinates `cuts`. A single tile gives its map itself. `None` if there are no rows, or
    /// if the number of cuts does not fit.
    #[must_use]
    pub(crate) fn over(region: Rect, cuts: Vec<f64>, rows: Vec<TileRow>) -> Option<Arc<dyn Map>> {
        let fits = |cuts: &[f64], n: usize| cuts.len() + 1 == n && cuts.windows(2).all(|w| w[0] <= w[1]);
        if !fits(&cuts, rows.len()) || !rows.iter().all(|r| fits(&r.cuts, r.maps.len())) {
            return None;
        }
        match &rows[..] {
            [TileRow { maps, .. }] if maps.len() == 1 => maps.first().cloned(),
            _ => Some(Arc::new(Self { region, cuts, rows })),
        }
    }

    /// Row and column of the tile at `p`.
    fn index(&self, p: Point) -> (usize, usize) {
        let j = self.cuts.partition_point(|c| *c < p.y);
        (j, self.rows[j].cuts.partition_point(|c| *c < p.x))
    }

    fn tile(&self, p: Point) -> &Arc<dyn Map> {
        let (j, i) = self.index(p);
        &self.rows[j].maps[i]
    }

    /// The rectangle of a tile within the region.
    fn rect(&self, j: usize, i: usize) -> Rect {
        let span = |cuts: &[f64], k: usize, from: f64, to: f64| {
            (if k == 0 { from } else { cuts[k - 1] }, cuts.get(k).copied().unwrap_or(to))
        };
        let r = self.region;
        let (y0, y1) = span(&self.cuts, j, r.y0, r.y1);
        let (x0, x1) = span(&self.rows[j].cuts, i, r.x0, r.x1);
        Rect::new(x0, y0, x1, y1)
    }

    /// The rectangle of a tile, extended far beyond the region for the outermost tiles.
    fn extended_rect(&self, j: usize, i: usize) -> Rect {
        let (mut b, r) = (self.rect(j, i), self.region);
        let far = r.inflate(REACH * r.width(), REACH * r.height());
        b.x0 = if b.x0 == r.x0 { far.x0 } else { b.x0 };
        b.x1 = if b.x1 == r.x1 { far.x1 } else { b.x1 };
        b.y0 = if b.y0 == r.y0 { far.y0 } else { b.y0 };
        b.y1 = if b.y1 == r.y1 { far.y1 } else { b.y1 };
        b
    }

    /// Rows and columns of all tiles.
    fn tiles(&self) -> impl Iterator<Item = (usize, usize)> {
        self.rows.iter().enumerate().flat_map(|(j, r)| (0..r.maps.len()).map(move |i| (j, i)))
    }
}

impl Map for Tiled {
    fn cost(&self) -> Cost<'_> {
        Cost::new(self.rows.iter().flat_map(|r| &r.maps).map(|m| m.work()).fold(1.0, f64::max))
    }

    fn jet(&self, p: Point) -> Jet {
        self.tile(p).jet(p)
    }

    fn point(&self, p: Point) -> Point {
        self.tile(p).point(p)
    }

    fn creases(&self, out: &mut Creases) {
        for y in &self.cuts {
            out.push(Crease::kink(Level::Line { a: 0.0, b: 1.0, c: -y }));
        }
        for (j, row) in self.rows.iter().enumerate() {
            let last = row.maps.len() - 1;
            let within = Rect {
                x0: self.extended_rect(j, 0).x0,
                x1: self.extended_rect(j, last).x1,
                ..self.extended_rect(j, 0)
            };
            for x in &row.cuts {
                let (a, b, c) = (1.0, 0.0, -x);
                out.push(Crease::kink(if self.cuts.is_empty() {
                    Level::Line { a, b, c }
                } else {
                    Level::Stretch { a, b, c, within }
                }));
            }
        }
        for (j, i) in self.tiles() {
            let mut own = Creases::default();
            self.rows[j].maps[i].creases(&mut own);
            for c in own.items() {
                let (level, tiled) = (c.level.clone(), self.clone());
                let level = Level::Field(Arc::new(move |p| if tiled.index(p) == (j, i) { level.at(p) } else { 1.0 }));
                out.push(Crease { level, kind: c.kind });
            }
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let tile = self.tile(inside);
        Some(tile.branch(inside).unwrap_or_else(|| tile.clone()))
    }

    /// For a curve whose control points, and therefore the whole curve, lie in one tile.
    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        let mut tile = None;
        for p in &curve.points {
            if p[2] <= 0.0 {
                return None;
            }
            let here = self.index(Point::new(p[0] / p[2], p[1] / p[2]));
            if tile.replace(here).is_some_and(|previous| previous != here) {
                return None;
            }
        }
        let (j, i) = tile?;
        self.rows[j].maps[i].image(curve)
    }

    /// By Newton's method in every tile, up to half the size of the region beyond it.
    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(TiledInverse::new(self)))
    }
}

/// The inverse of a [`Tiled`] map.
#[derive(Clone)]
struct TiledInverse {
    of: Tiled,
    /// The inverse of every tile, and the rectangle in which its answers must lie.
    tiles: Vec<(Rect, Arc<NewtonInverse>)>,
    jet_work: f64,
    budget: Option<Arc<Budget>>,
}

impl TiledInverse {
    fn new(of: &Tiled) -> Self {
        let r = of.region;
        let wide = r.inflate(INVERSE_REACH * r.width(), INVERSE_REACH * r.height());
        let tiles = of.tiles().map(|(j, i)| {
            let domain = of.extended_rect(j, i).intersect(wide);
            let margin = MARGIN * (domain.width() + domain.height());
            let (map, core) = (of.rows[j].maps[i].clone(), of.rect(j, i));
            (domain.inflate(margin, margin), Arc::new(NewtonInverse::with_core(map, core, domain, 0.0, [1, 1])))
        });
        let tiles: Vec<(Rect, Arc<NewtonInverse>)> = tiles.collect();
        let jet_work = tiles.iter().map(|t| t.1.jet_work).fold(1.0, f64::max);
        Self { of: of.clone(), tiles, jet_work, budget: None }
    }

    /// The tile and jet of the first preimage in the region, or else of the first one beyond it.
    fn solve(&self, q: Point) -> Option<(usize, Jet)> {
        let (mut best, mut search) = (None, Search::default());
        if is_over(self.budget.as_ref()) {
            return None;
        }
        for (k, (rect, inverse)) in self.tiles.iter().enumerate() {
            let (found, more) = inverse.search(q, |p| rect.contains(p));
            search.add(more);
            match found {
                Some(jet) if self.of.region.contains(jet.p) => {
                    best = Some((k, jet));
                    break;
                }
                Some(jet) => best = best.or(Some((k, jet))),
                None => {}
            }
        }
        search.spend(self.budget.as_ref(), FORESEEN, self.jet_work);
        best
    }
}

impl Map for TiledInverse {
    fn cost(&self) -> Cost<'_> {
        Cost::new(FORESEEN as f64 * INVERSE_WORK * self.of.cost().work).searching(self)
    }

    fn jet(&self, q: Point) -> Jet {
        self.solve(q).map_or(Jet::UNDEFINED, |s| s.1)
    }

    fn creases(&self, out: &mut Creases) {
        // The creases of the forward map, pulled back through the inverse.
        let mut own = Creases::default();
        self.of.creases(&mut own);
        for c in own.items().iter().filter(|c| c.kind == CreaseKind::Kink) {
            let (level, back) = (c.level.clone(), self.clone());
            out.push(Crease::kink(Level::Field(Arc::new(move |q| level.at(back.point(q))))));
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let (k, _) = self.solve(inside)?;
        let (rect, _) = self.tiles[k];
        let (j, i) = self.of.tiles().nth(k)?;
        // A margin for parts that end on the border of the tile.
        let reach = 1e-3 * (rect.width() + rect.height());
        let branch = NewtonInverse::new(self.of.rows[j].maps[i].clone(), rect, reach, [1, 1]);
        Some(Arc::new(self.budget.as_ref().map_or_else(|| branch.clone(), |b| branch.spending(b))))
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.of.clone()))
    }
}

impl Searches for TiledInverse {
    fn within(&self, budget: &Arc<Budget>) -> Arc<dyn Map> {
        Arc::new(Self { budget: Some(Arc::clone(budget)), ..self.clone() })
    }
}
