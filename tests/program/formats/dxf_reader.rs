//! An independent reader of DXF, after Autodesk's reference: group codes, entities, and points on them.

use pathwarp::kurbo::Point;
use std::f64::consts::TAU;

/// Points per arc.
const DENSE: usize = 1000;
/// Distance of points along a spline, in mm.
const STEP: f64 = 0.05;

/// A group code with its value.
pub type Pair = (i32, String);

/// An entity.
#[derive(Debug)]
pub struct Entity {
    pub kind: String,
    pub pairs: Vec<Pair>,
}

/// A file.
pub struct Dxf {
    pub pairs: Vec<Pair>,
    pub entities: Vec<Entity>,
}

impl Dxf {
    pub fn read(text: &str) -> Self {
        assert!(text.is_ascii());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len() % 2, 0, "codes and values come in pairs");
        let pairs: Vec<Pair> = lines.chunks(2).map(|c| (c[0].trim().parse().unwrap(), c[1].to_owned())).collect();
        assert_eq!(pairs.last().unwrap(), &(0, "EOF".to_owned()));
        let start = pairs.iter().position(|p| *p == (2, "ENTITIES".to_owned())).unwrap() + 1;
        let end = start + pairs[start..].iter().position(|p| *p == (0, "ENDSEC".to_owned())).unwrap();
        let mut entities: Vec<Entity> = Vec::new();
        for (code, value) in &pairs[start..end] {
            match code {
                0 => entities.push(Entity { kind: value.clone(), pairs: Vec::new() }),
                _ => entities.last_mut().unwrap().pairs.push((*code, value.clone())),
            }
        }
        Self { pairs, entities }
    }

    /// Returns the value of a variable of the header.
    pub fn variable(&self, name: &str) -> &str {
        let at = self.pairs.iter().position(|p| *p == (9, name.to_owned())).unwrap();
        &self.pairs[at + 1].1
    }

    /// The layers, with their colours.
    pub fn layers(&self) -> Vec<(String, i32)> {
        let records = self.pairs.split(|p| p.0 == 0).filter(|r| r.contains(&(100, "AcDbLayerTableRecord".to_owned())));
        let value = |r: &[Pair], code| r.iter().find(|p| p.0 == code).unwrap().1.clone();
        records.map(|r| (value(r, 2), value(r, 62).parse().unwrap())).collect()
    }

    /// All entities as polylines.
    pub fn polylines(&self) -> Vec<Vec<Point>> {
        self.entities.iter().map(Entity::points).collect()
    }
}

impl Entity {
    pub fn text(&self, code: i32) -> Option<&str> {
        self.pairs.iter().find(|p| p.0 == code).map(|p| p.1.as_str())
    }

    pub fn all(&self, code: i32) -> Vec<f64> {
        self.pairs.iter().filter(|p| p.0 == code).map(|p| p.1.parse().unwrap()).collect()
    }

    pub fn number(&self, code: i32) -> f64 {
        self.all(code)[0]
    }

    fn point(&self, code: i32) -> Point {
        Point::new(self.number(code), self.number(code + 10))
    }

    /// Points along the entity.
    pub fn points(&self) -> Vec<Point> {
        let along = |f: &dyn Fn(f64) -> Point| (0..=DENSE).map(|i| f(i as f64 / DENSE as f64)).collect();
        match self.kind.as_str() {
            "LINE" => vec![self.point(10), self.point(11)],
            "CIRCLE" => along(&|t| on_circle(self.point(10), self.number(40), t * TAU)),
            "ARC" => {
                let (from, to) = (self.number(50).to_radians(), self.number(51).to_radians());
                let sweep = (to - from).rem_euclid(TAU);
                along(&|t| on_circle(self.point(10), self.number(40), from + t * sweep))
            }
            "ELLIPSE" => {
                let (major, ratio) = (self.point(11).to_vec2(), self.number(40));
                assert!(ratio > 0.0 && ratio <= 1.0 && self.number(230) == 1.0);
                let minor = major.turn_90() * ratio;
                let (from, to) = (self.number(41), self.number(42));
                assert!(from < to && to <= from + TAU + 1e-9);
                along(&|t| {
                    let (sin, cos) = (from + t * (to - from)).sin_cos();
                    self.point(10) + major * cos + minor * sin
                })
            }
            "LWPOLYLINE" => self.polyline(),
            "SPLINE" => self.spline(),
            other => panic!("{other}"),
        }
    }

    pub fn is_closed(&self) -> bool {
        self.text(70) == Some("1")
    }

    fn polyline(&self) -> Vec<Point> {
        let mut vertices: Vec<(Point, f64)> = Vec::new();
        for (code, value) in &self.pairs {
            let v: f64 = value.parse().unwrap_or_default();
            match code {
                10 => vertices.push((Point::new(v, 0.0), 0.0)),
                20 => vertices.last_mut().unwrap().0.y = v,
                42 => vertices.last_mut().unwrap().1 = v,
                _ => {}
            }
        }
        assert_eq!(vertices.len() as f64, self.number(90));
        if self.is_closed() {
            vertices.push(vertices[0]);
        }
        let mut out = vec![vertices[0].0];
        for w in vertices.windows(2) {
            let ((p, bulge), (q, _)) = (w[0], w[1]);
            if bulge == 0.0 {
                out.push(q);
                continue;
            }
            // The bulge is the sagitta over half the chord; positive arcs bend to the right of their direction.
            let angle = 4.0 * bulge.atan();
            let chord = q - p;
            let radius = chord.hypot() / (2.0 * (angle / 2.0).sin());
            let center = p.midpoint(q) + chord.turn_90() / chord.hypot() * radius * (angle / 2.0).cos();
            let start = (p - center).angle();
            out.extend((1..=DENSE).map(|i| on_circle(center, radius.abs(), start + angle * i as f64 / DENSE as f64)));
            assert!(out.last().unwrap().distance(q) < 1e-6);
        }
        out
    }

    /// Points along a spline.
    fn spline(&self) -> Vec<Point> {
        let degree = self.number(71) as usize;
        let knots = self.all(40);
        let points: Vec<Point> = self.all(10).into_iter().zip(self.all(20)).map(Point::from).collect();
        assert_eq!((knots.len(), points.len()), (self.number(72) as usize, self.number(73) as usize));
        assert_eq!(knots.len(), points.len() + degree + 1);
        assert!(knots.windows(2).all(|w| w[0] <= w[1]));
        let mut out = Vec::new();
        for k in (degree..points.len()).filter(|k| knots[*k] < knots[k + 1]) {
            let polygon: f64 = points[k - degree..=k].windows(2).map(|w| w[0].distance(w[1])).sum();
            let n = (polygon / STEP).clamp(20.0, 2000.0).ceil() as usize;
            for i in 0..=n {
                let [x, y, _] = self.in_span(k, knots[k] + (knots[k + 1] - knots[k]) * i as f64 / n as f64);
                out.push(Point::new(x, y));
            }
        }
        out
    }

    /// Returns a point of a spline in the span after knot `k`, by de Boor's algorithm on homogeneous coordinates.
    pub fn in_span(&self, k: usize, t: f64) -> [f64; 3] {
        let (degree, knots, weights) = (self.number(71) as usize, self.all(40), self.all(41));
        let axes = [10, 20, 30].map(|code| self.all(code));
        let weight = |i: usize| weights.get(i).copied().unwrap_or(1.0);
        let of = |i: usize| [axes[0][i] * weight(i), axes[1][i] * weight(i), axes[2][i] * weight(i), weight(i)];
        let mut d: Vec<[f64; 4]> = (k - degree..=k).map(of).collect();
        for r in 1..=degree {
            for j in (r..=degree).rev() {
                let i = j + k - degree;
                let a = (t - knots[i]) / (knots[i + 1 + degree - r] - knots[i]);
                d[j] = std::array::from_fn(|c| d[j - 1][c] * (1.0 - a) + d[j][c] * a);
            }
        }
        let [x, y, z, w] = d[degree];
        [x / w, y / w, z / w]
    }
}

fn on_circle(center: Point, radius: f64, angle: f64) -> Point {
    let (sin, cos) = angle.sin_cos();
    Point::new(center.x + radius * cos, center.y + radius * sin)
}
