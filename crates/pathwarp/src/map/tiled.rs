//! Tiled maps: rows of smooth maps, each on a rectangle of the source plane. A ruled map between two guide curves is one such row.
//!
//! The outermost tiles continue beyond the region. The lines between tiles are creases: horizontal lines between rows, and
//! vertical stretches within a row. Adjacent maps need not agree there; a path across a gap is connected by a straight line.

use super::curves::{Guide, GuidePiece};
use super::newton::{kinks, push_images};
use super::{
    BicubicNet, Cost, Crease, Creases, INVERSE_WORK, Jet, Level, Map, Net, NewtonInverse, RationalBezier, Searches,
};
use crate::budget::{Budget, Search, is_over};
use kurbo::{Affine, CubicBez, Point, Rect};
use std::sync::Arc;

/// Tiles beside one another.
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
    /// The largest work of a tile's map.
    work: f64,
}

/// The extent of the creases beyond the region, as a multiple of its size. Artwork extends past its frame by less.
const CREASE_REACH: f64 = 1e3;
/// The margin around a tile within which preimages count, as a share of the sides of the region or of the tile's rectangle: for paths that
/// end on the border, and rounding.
const MARGIN: f64 = 1e-9;
/// The number of tiles usually searched for a point.
const USUAL_TILES: usize = 2;
/// The distance beyond the region over which the inverse searches, as a multiple of its size.
const INVERSE_REACH: f64 = 0.5;

impl Tiled {
    /// The map of these rows over `region`, divided at the ordinates `cuts`. A single tile gives its map. `None` if there are no rows, or
    /// if the cuts of the map or of a row are too few, too many or not in order.
    #[must_use]
    pub(crate) fn over(region: Rect, cuts: Vec<f64>, rows: Vec<TileRow>) -> Option<Arc<dyn Map>> {
        let fits = |cuts: &[f64], n: usize| cuts.len() + 1 == n && cuts.windows(2).all(|w| w[0] <= w[1]);
        if !fits(&cuts, rows.len()) || !rows.iter().all(|r| fits(&r.cuts, r.maps.len())) {
            return None;
        }
        if let [TileRow { maps, .. }] = &rows[..]
            && let [only] = &maps[..]
        {
            return Some(Arc::clone(only));
        }
        let work = rows.iter().flat_map(|r| &r.maps).map(|m| m.work()).fold(1.0, f64::max);
        Some(Arc::new(Self { region, cuts, rows, work }))
    }

    /// The row and column of the tile at `p`.
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
        let far = r.inflate(CREASE_REACH * r.width(), CREASE_REACH * r.height());
        b.x0 = if b.x0 == r.x0 { far.x0 } else { b.x0 };
        b.x1 = if b.x1 == r.x1 { far.x1 } else { b.x1 };
        b.y0 = if b.y0 == r.y0 { far.y0 } else { b.y0 };
        b.y1 = if b.y1 == r.y1 { far.y1 } else { b.y1 };
        b
    }

    /// The rows and columns of all tiles.
    fn tiles(&self) -> impl Iterator<Item = (usize, usize)> {
        self.rows.iter().enumerate().flat_map(|(j, r)| (0..r.maps.len()).map(move |i| (j, i)))
    }
}

impl Map for Tiled {
    fn cost(&self) -> Cost<'_> {
        Cost::new(self.work)
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
            let within = Rect { x1: self.extended_rect(j, row.maps.len() - 1).x1, ..self.extended_rect(j, 0) };
            for x in &row.cuts {
                let (a, b, c) = (1.0, 0.0, -x);
                // A single row has no lower or upper end: a whole line is its crease.
                let is_line = self.cuts.is_empty();
                out.push(Crease::kink(if is_line {
                    Level::Line { a, b, c }
                } else {
                    Level::Stretch { a, b, c, within }
                }));
            }
        }
        for (j, i) in self.tiles() {
            // Creases are zeros, so 1 makes none beyond the tile. The jump is at the tile's border, a crease already.
            for c in Creases::of_map(&self.rows[j].maps[i]).items() {
                let (level, tiled) = (c.level.clone(), self.clone());
                let level =
                    Level::Field(Arc::new(move |p: Point| if tiled.index(p) == (j, i) { level.at(p) } else { 1.0 }));
                out.push(Crease { level, kind: c.kind });
            }
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let tile = self.tile(inside);
        Some(tile.branch(inside).unwrap_or_else(|| tile.clone()))
    }

    /// The image of a curve whose control points, and therefore the whole curve, lie in one tile.
    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        let points = curve.hull()?;
        let (j, i) = self.index(*points.first()?);
        points.iter().all(|p| self.index(*p) == (j, i)).then(|| self.rows[j].maps[i].image(curve))?
    }

    fn preimages(&self, q: Point) -> Option<Vec<Point>> {
        let near = MARGIN * (self.region.width() + self.region.height());
        let tile = |(j, i): (usize, usize)| {
            let b = self.extended_rect(j, i).inflate(near, near);
            Some(self.rows[j].maps[i].preimages(q)?.into_iter().filter(move |p| b.contains(*p)))
        };
        let all: Option<Vec<_>> = self.tiles().map(tile).collect();
        Some(all?.into_iter().flatten().collect())
    }

    /// The inverse by Newton's method in every tile, up to half the size of the region beyond it.
    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(TiledInverse::new(self)))
    }
}

/// The inverse of a [`Tiled`] map, by Newton's method in every tile.
#[derive(Clone)]
struct TiledInverse {
    map: Tiled,
    /// The inverse of every tile, and the rectangle in which its answers must lie.
    tiles: Vec<(Rect, Arc<NewtonInverse>)>,
    jet_work: f64,
    budget: Option<Arc<Budget>>,
}

impl TiledInverse {
    fn new(map: &Tiled) -> Self {
        let r = map.region;
        let searched = r.inflate(INVERSE_REACH * r.width(), INVERSE_REACH * r.height());
        let tiles = map.tiles().map(|(j, i)| {
            let domain = map.extended_rect(j, i).intersect(searched);
            let margin = MARGIN * (domain.width() + domain.height());
            let (tile, core) = (map.rows[j].maps[i].clone(), map.rect(j, i));
            // The map is one smooth piece. Preimages in the core come first; those beyond the domain do not count.
            (domain.inflate(margin, margin), Arc::new(NewtonInverse::with_core(tile, core, domain, 0.0, [1, 1])))
        });
        let tiles: Vec<(Rect, Arc<NewtonInverse>)> = tiles.collect();
        let jet_work = tiles.iter().map(|t| t.1.jet_work).fold(1.0, f64::max);
        Self { map: map.clone(), tiles, jet_work, budget: None }
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
                Some(jet) if self.map.region.contains(jet.p) => {
                    best = Some((k, jet));
                    break;
                }
                Some(jet) => best = best.or(Some((k, jet))),
                None => {}
            }
        }
        search.spend(self.budget.as_ref(), USUAL_TILES, self.jet_work);
        best
    }
}

impl Map for TiledInverse {
    fn cost(&self) -> Cost<'_> {
        Cost::new(USUAL_TILES as f64 * INVERSE_WORK * self.map.cost().work).searching(self)
    }

    fn jet(&self, q: Point) -> Jet {
        self.solve(q).map_or(Jet::UNDEFINED, |s| s.1)
    }

    /// The images of the kinks of the tiled map.
    fn creases(&self, out: &mut Creases) {
        push_images(kinks(&self.map), self, out);
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let (k, _) = self.solve(inside)?;
        let (rect, _) = self.tiles[k];
        let (j, i) = self.map.tiles().nth(k)?;
        // A margin for paths that end on the border of the tile, whose map is one smooth piece.
        let margin = 1e-3 * (rect.width() + rect.height());
        let branch = NewtonInverse::new(self.map.rows[j].maps[i].clone(), rect, margin, [1, 1]);
        Some(Arc::new(self.budget.as_ref().map_or_else(|| branch.clone(), |b| branch.spending(b))))
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.map.clone()))
    }
}

impl Searches for TiledInverse {
    fn within(&self, budget: &Arc<Budget>) -> Arc<dyn Map> {
        Arc::new(Self { budget: Some(Arc::clone(budget)), ..self.clone() })
    }
}

/// The ruled map that takes the upper side of `frame` to `top` and its lower side to `bottom` along straight lines, as a row of tiles:
///
/// > F(u, v) = (1 − v)·T(u) + v·B(u)
///
/// with u and v from 0 to 1 over the frame. Each guide defines u: as the share of its arc length, or by the parameters of its segments, of
/// which each takes an equal share of u. The vertical lines through the joints of either guide are creases.
///
/// On a strip between creases on which both guides are polynomials in u, the map is a bicubic net. It is linear in v, so its rows
/// divide the lines between the guides evenly. `None` if the frame has no area.
#[must_use]
pub(crate) fn ruled_row(frame: Rect, top: &Guide, bottom: &Guide) -> Option<TileRow> {
    /// Joints closer than this coincide up to rounding, as in guides of equal proportions.
    const MIN_DISTANCE: f64 = 1e-12;
    if !(frame.width() > 0.0 && frame.height() > 0.0) {
        return None;
    }
    let mut cuts: Vec<f64> = top.joints().chain(bottom.joints()).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|b, a| *b - *a < MIN_DISTANCE);
    let ends: Vec<f64> = [0.0].into_iter().chain(cuts.iter().copied()).chain([1.0]).collect();
    let maps = ends.windows(2).map(|w| ruled_map(frame, top, bottom, w[0], w[1])).collect();
    let cuts = cuts.iter().map(|u| frame.x0 + u * frame.width()).collect();
    Some(TileRow { cuts, maps })
}

/// The map from the source to (u, v), with u from 0 to 1 over [`u0`, `u1`] of the frame.
fn to_unit_square(frame: Rect, u0: f64, u1: f64) -> Affine {
    let (w, h) = (frame.width() * (u1 - u0), frame.height());
    Affine::new([1.0 / w, 0.0, 0.0, 1.0 / h, -(frame.x0 + u0 * frame.width()) / w, -frame.y0 / h])
}

/// The ruled map over [`u0`, `u1`], which contains no joint of either guide.
fn ruled_map(frame: Rect, top: &Guide, bottom: &Guide, u0: f64, u1: f64) -> Arc<dyn Map> {
    let middle = 0.5 * (u0 + u1);
    let (top, bottom) = (top.piece(middle), bottom.piece(middle));
    if let (Some(t), Some(b)) = (top.cubic(u0, u1), bottom.cubic(u0, u1)) {
        return Arc::new(BicubicNet::new(&ruled_net(t, b), to_unit_square(frame, u0, u1)));
    }
    Arc::new(RuledMap { pre: to_unit_square(frame, 0.0, 1.0), top: top.clone(), bottom: bottom.clone() })
}

/// The net of the ruled map between two cubics.
fn ruled_net(top: CubicBez, bottom: CubicBez) -> Net {
    let (t, b) = ([top.p0, top.p1, top.p2, top.p3], [bottom.p0, bottom.p1, bottom.p2, bottom.p3]);
    std::array::from_fn(|j| std::array::from_fn(|i| if j == 3 { b[i] } else { t[i].lerp(b[i], j as f64 / 3.0) }))
}

/// The ruled map between pieces of guides that are not both polynomials in u.
#[derive(Debug, Clone)]
struct RuledMap {
    /// The affine function from the source point to (u, v).
    pre: Affine,
    top: GuidePiece,
    bottom: GuidePiece,
}

impl Map for RuledMap {
    fn jet(&self, p: Point) -> Jet {
        let Point { x: u, y: v } = self.pre * p;
        let ((t, dt), (b, db)) = (self.top.point_and_derivative(u), self.bottom.point_and_derivative(u));
        let [a, _, _, d, ..] = self.pre.as_coeffs();
        Jet { p: t.lerp(b, v), dx: (dt * (1.0 - v) + db * v) * a, dy: (b - t) * d }
    }

    fn point(&self, p: Point) -> Point {
        let Point { x: u, y: v } = self.pre * p;
        self.top.point(u).lerp(self.bottom.point(u), v)
    }

    /// Infinite: between creases, each guide is one simple curve.
    fn detail(&self, _: Rect) -> Option<f64> {
        Some(f64::INFINITY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::GuidePace::{self, ArcLength, Parameter};
    use crate::map::RationalDegree;
    use crate::outline::{EllipticArc, Outline, Seg};
    use kurbo::{ParamCurve, ParamCurveArclen, Vec2};

    fn guide(d: &str, pace: GuidePace) -> Guide {
        let segs: Vec<Seg> = Outline::from_svg(d).unwrap().segs().copied().collect();
        Guide::new(&segs, pace).unwrap()
    }

    const FRAME: Rect = Rect::new(10.0, 20.0, 110.0, 70.0);

    fn ruled(top: &Guide, bottom: &Guide) -> Arc<dyn Map> {
        Tiled::over(FRAME, Vec::new(), vec![ruled_row(FRAME, top, bottom).unwrap()]).unwrap()
    }

    fn source(u: f64, v: f64) -> Point {
        Point::new(FRAME.x0 + u * FRAME.width(), FRAME.y0 + v * FRAME.height())
    }

    /// The map reproduces both guides, and divides straight lines between them evenly.
    #[test]
    fn sides_are_the_guides_and_verticals_are_straight() {
        let top = "M0,0 C30,-40 70,40 100,0 L150,-20";
        let bottom = "M-10,60 L40,80 Q90,90 160,50";
        for pace in [ArcLength, Parameter] {
            let (t, b) = (guide(top, pace), guide(bottom, pace));
            let m = ruled(&t, &b);
            for i in -2..=22 {
                let u = f64::from(i) / 20.0;
                let (p, q) = (m.point(source(u, 0.0)), m.point(source(u, 1.0)));
                assert!(p.distance(t.eval(u)) < 1e-9 && q.distance(b.eval(u)) < 1e-9, "{pace:?} {u}");
                for v in [-0.3, 0.25, 0.5, 0.9] {
                    assert!(m.point(source(u, v)).distance(p.lerp(q, v)) < 1e-10);
                }
            }
            let h = 1e-5;
            for (u, v) in [(0.1, 0.2), (0.45, 0.7), (0.93, 1.2), (-0.1, 0.5), (1.07, 0.5)] {
                let (p, j) = (source(u, v), m.jet(source(u, v)));
                let dx = (m.point(p + (h, 0.0)) - m.point(p - (h, 0.0))) / (2.0 * h);
                let dy = (m.point(p + (0.0, h)) - m.point(p - (0.0, h))) / (2.0 * h);
                assert!((dx - j.dx).hypot() < 1e-6 && (dy - j.dy).hypot() < 1e-6, "{pace:?} {u} {v}: {j:?} {dx} {dy}");
            }
        }
    }

    /// The parameter u is the share of the arc length, measured by an independent integration.
    #[test]
    fn arc_length_is_the_share_of_the_length() {
        let c = CubicBez::new((0.0, 0.0), (10.0, 60.0), (20.0, -30.0), (120.0, 10.0));
        let g = Guide::new(&[Seg::Cubic(c)], ArcLength).unwrap();
        let total = c.arclen(1e-12);
        for i in 0..=20 {
            let t = f64::from(i) / 20.0;
            let u = c.subsegment(0.0..t).arclen(1e-12) / total;
            assert!(g.eval(u).distance(c.eval(t)) < 1e-8, "{t}");
        }
        // Segments share [0, 1] in proportion to their lengths, so one without length has no share.
        let g = guide("M0,0 L30,0 L30,0 L30,10", ArcLength);
        assert_eq!(g.joints().collect::<Vec<_>>(), [0.75]);
        assert!(g.eval(0.875).distance((30.0, 5.0).into()) < 1e-12);
        assert!(Guide::new(&[], ArcLength).is_none());
        let dot = Seg::Line(kurbo::Line::new((3.0, 3.0), (3.0, 3.0)));
        assert!(Guide::new(&[dot], ArcLength).is_none() && Guide::new(&[dot], Parameter).is_none());
    }

    /// Strips between polynomial guides are nets, so that images are exact and certified. Joints are vertical creases.
    #[test]
    fn polynomial_strips_are_nets() {
        let roof = guide("M0,20 L50,0 L100,20", ArcLength);
        let floor = guide("M0,50 Q50,70 100,50", Parameter);
        let m = ruled(&roof, &floor);
        let creases = Creases::of_map(&m);
        assert_eq!(creases.items().len(), 1);
        assert!(creases.items()[0].level.at(source(0.5, 0.3)).abs() < 1e-12);
        for u in [0.2, 0.8] {
            let piece = m.branch(source(u, 0.5)).unwrap();
            assert!(matches!(piece.rational_degree(), Some(RationalDegree { rational: false, .. })));
            assert!(piece.point(source(u, 0.4)).distance(m.point(source(u, 0.4))) < 1e-12);
        }
        // On a circle, angle and arc length give the same guide.
        let arc =
            [Seg::Arc(EllipticArc::new(Point::new(50.0, 0.0), Vec2::new(40.0, 0.0), Vec2::new(0.0, 40.0), 3.2, 2.9))];
        let [a, b] = [ArcLength, Parameter].map(|l| Guide::new(&arc, l).unwrap());
        assert!((0..=10).all(|i| a.eval(f64::from(i) / 10.0).distance(b.eval(f64::from(i) / 10.0)) < 1e-9));
    }

    #[test]
    fn the_inverse_returns_in_every_strip() {
        let (t, b) = (guide("M0,20 L50,0 L100,20", ArcLength), guide("M0,50 C30,80 60,30 100,60", ArcLength));
        let m = ruled(&t, &b);
        let back = m.inverse().unwrap();
        for (u, v) in [(0.1, 0.1), (0.49, 0.9), (0.5, 0.5), (0.51, 0.2), (0.97, 0.99), (1.2, 0.5)] {
            let p = source(u, v);
            assert!(back.point(m.point(p)).distance(p) < 1e-8, "{u} {v}");
        }
    }
}
