//! Outlines as polygons, and random paths, for tests.
use kurbo::{BezPath, Line, ParamCurve, ParamCurveNearest, Point};

/// An outline as a polygon; kurbo's winding numbers of cubics are not always right.
pub struct Polygon(pub Vec<Line>);

impl Polygon {
    pub fn of(path: &BezPath) -> Self {
        let mut flat = BezPath::new();
        kurbo::flatten(path, 1e-4, |e| flat.push(e));
        Self(flat.segments().map(|s| Line::new(s.start(), s.end())).collect())
    }

    pub fn winding(&self, p: Point) -> i32 {
        let turn = |l: &Line| {
            let is_left = (p.y - l.p0.y) * (l.p1.x - l.p0.x) < (p.x - l.p0.x) * (l.p1.y - l.p0.y);
            match (l.p0.y <= p.y, l.p1.y <= p.y) {
                (true, false) if !is_left => 1,
                (false, true) if is_left => -1,
                _ => 0,
            }
        };
        self.0.iter().map(turn).sum::<i32>()
    }

    pub fn covers(&self, p: Point) -> bool {
        self.winding(p) != 0
    }

    /// The distance from a point to the outline.
    pub fn distance(&self, p: Point) -> f64 {
        self.0.iter().map(|l| l.nearest(p, 0.0).distance_sq).fold(f64::INFINITY, f64::min).sqrt()
    }
}

/// Numbers that look random and are the same in every run.
pub struct Random(pub u64);

impl Random {
    /// From 0 to 1.
    pub fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1_u64 << 31) as f64
    }

    pub fn point(&mut self) -> Point {
        Point::new(100.0 * self.share(), 100.0 * self.share())
    }
}

/// Lines, quadratics and cubics through random points, some of which coincide or nearly do; every second path is closed.
pub fn random_path(random: &mut Random, i: usize) -> BezPath {
    let mut path = BezPath::new();
    let mut at = random.point();
    path.move_to(at);
    for _ in 0..1 + (4.0 * random.share()) as usize {
        let before = at;
        let mut next = || match (12.0 * random.share()) as usize {
            0 => before,
            1 => before + (random.point() - before) * 1e-4,
            _ => random.point(),
        };
        let (a, b, c) = (next(), next(), next());
        at = c;
        match i % 5 {
            0 => path.line_to(c),
            1 => path.quad_to(a, c),
            _ => path.curve_to(a, b, c),
        }
    }
    if i.is_multiple_of(2) {
        path.close_path();
    }
    path
}
