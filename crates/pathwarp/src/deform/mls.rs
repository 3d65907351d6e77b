//! Moving least squares: the user moves points of the artwork, and everything else follows, more or less stiffly.
//!
//! S. Schaefer, T. `McPhail`, J. Warren, *Image deformation using moving least squares*, SIGGRAPH 2006. At a point v the handles
//! pᵢ → qᵢ have the weights wᵢ = 1/|pᵢ − v|^(2α). With the weighted means p*, q*, and p̂ᵢ = pᵢ − p*, q̂ᵢ = qᵢ − q*, the image is
//! F(v) = M·(v − p*) + q*, where M is the best approximation, by weighted least squares, among
//!
//! - affine maps: M = (Σ wᵢ q̂ᵢp̂ᵢᵀ)(Σ wᵢ p̂ᵢp̂ᵢᵀ)⁻¹ (equation 5),
//! - similarities: in complex numbers M = Σ wᵢ q̂ᵢ·conj(p̂ᵢ) / Σ wᵢ|p̂ᵢ|² (equation 6),
//! - rigid motions: M = Σ wᵢ q̂ᵢ·conj(p̂ᵢ) / |Σ wᵢ q̂ᵢ·conj(p̂ᵢ)| (Theorem 2.1 and equation 8).
//!
//! Weights only matter up to a common factor. They are computed as (d²/|pᵢ − v|²)^α, where d, the distance to the nearest handle k,
//! counts as constant. Means are relative to pₖ, so that nothing cancels near it. At pₖ itself, M comes from the other handles
//! alone, since p̂ₖ is of second order there: F(pₖ) = qₖ, and the derivative is that M (for α ≥ 1).

use super::entry::{Built, ByHand, Case, Entry, Example, Info, Law, Pairs, Role};
use crate::anchors;
use crate::error::{Error, GeometryError};
use crate::map::{AffineMap, Cost, Formula, Real};
use crate::param::{Axis, Choice as _, Kind, Settings, choice, parameters};
use kurbo::{Affine, BezPath, Point, Rect, Vec2};
use std::sync::Arc;

parameters! {
    /// Moving least squares: points of the artwork are moved, everything else follows as stiffly as asked.
    ///
    /// ```
    /// use pathwarp::{deform::Mls, kurbo::Point, map::Map};
    ///
    /// let bend = Mls::new([((10.0, 20.0), (10.0, 20.0)), ((50.0, 50.0), (60.0, 45.0)), ((80.0, 10.0), (80.0, 15.0))]).build()?;
    /// assert_eq!(bend.map.point(Point::new(50.0, 50.0)), Point::new(60.0, 45.0));
    /// # Ok::<(), pathwarp::Error>(())
    /// ```
    #[derive(Debug, Clone, PartialEq)]
    pub struct Mls(s, handles: Vec<(Point, Point)>) {
        /// A point of the artwork and its image; may be given many times.
        param = new("pair", Kind::Text("X,Y:X,Y")).repeated();
        /// A point that stays; may be given many times.
        param = new("pin", Kind::Text("X,Y")).repeated();
        /// A path whose anchors are moved, in order, to those of --to.
        param = path("from");
        /// A path with as many anchors as --from.
        param = path("to");
        /// Stiffness of the artwork.
        stiffness: Stiffness = new("kind", Kind::Choice(Stiffness::WORDS)).default("rigid");
        /// Locality: the influence of a pair falls off with this power of the squared distance.
        alpha: f64 = number("alpha").default("1").within(1.0, 4.0);
        // Size of the preview's crosses.
        let mark: f64 = s.frame().extent(Axis::Diagonal) / 100.0;
    }
}

impl Mls {
    /// Creates the map that takes the first point of each pair to the second. At most 1000 pairs, whose first points are distinct.
    pub fn new(pairs: impl IntoIterator<Item = (impl Into<Point>, impl Into<Point>)>) -> Self {
        let handles: Vec<(Point, Point)> = pairs.into_iter().map(|(p, q)| (p.into(), q.into())).collect();
        let points = handles.iter().flat_map(|h| [h.0, h.1]).map(|p| Rect::from_points(p, p));
        let bounds = points.reduce(|a, b| a.union(b)).unwrap_or_default();
        Self::defaults(bounds, handles)
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Missing`] without pairs, [`Error::Usage`] for too many pairs or an exponent out of range, [`GeometryError::Coincident`] for
    /// equal first points, and [`GeometryError::Collinear`] when they lie on one line with [`Stiffness::Affine`].
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        let Self { ref handles, stiffness, alpha, .. } = *self;
        let from: Vec<Point> = handles.iter().map(|h| h.0).collect();
        if handles.len() > MAX_HANDLES {
            let problem = format!("pairs are too many; at most {MAX_HANDLES} are possible");
            return Err(Error::usage("pair", handles.len().to_string(), problem));
        }
        anchors::distinct("the points to be moved", &from)?;
        let mut built = Built::new(match handles[..] {
            [] => return Err(Error::missing("pair", "a point and its image, such as 10,20:15,20")),
            [(p, q)] => Arc::new(AffineMap(Affine::translate(q - p))),
            [(p, q), (p1, q1)] if stiffness == Stiffness::Similar => {
                // Distinct points always have a similitude.
                Arc::new(AffineMap::similitude(p, p1, q, q1).unwrap_or(AffineMap::IDENTITY))
            }
            _ => {
                if stiffness == Stiffness::Affine && on_a_line(&from) {
                    return Err(GeometryError::Collinear {
                        path: "the points to be moved (`kind affine`)".into(),
                        which: [1, 2, handles.len()],
                        points: from.into_iter().take(8).collect(),
                    }
                    .into());
                }
                Arc::new(MlsMap::new(handles, stiffness, alpha))
            }
        });
        built.overlay(Role::Base, crosses(handles.iter().map(|h| h.0), self.mark));
        built.overlay(Role::Target, crosses(handles.iter().map(|h| h.1), self.mark));
        Ok(built)
    }
}

choice! {
    /// The kind of map that moving least squares fits at every point.
    #[non_exhaustive]
    pub enum Stiffness {
        /// Rigid motions: shapes are kept as well as possible.
        Rigid = "rigid",
        /// Similitudes: shapes may also grow and shrink.
        Similar = "similar",
        /// Affine maps: shapes may also shear. Needs three pairs whose first points are not on one line.
        Affine = "affine",
    }
}

static INFO: Info = Info::new("mls", "move points of the artwork, and let the rest follow")
    .group("Points")
    .by_hand(ByHand {
        label: Some("Pins"),
        neutral: &[
            ("pair", "0%,0%:0%,0%"),
            ("pair", "100%,0%:100%,0%"),
            ("pair", "100%,100%:100%,100%"),
            ("pair", "0%,100%:0%,100%"),
            ("pair", "50%,50%:50%,50%"),
        ],
        showing: &[("pair", "0%,50%:0%,75%"), ("pair", "50%,50%:50%,25%"), ("pair", "100%,50%:100%,75%")],
        ..ByHand::NONE
    })
    .guides(&["to", "from"], 2)
    .about("Moves points of the artwork; everything else follows smoothly, most where it is near, also across gaps. --pair moves a \
point, --pin holds one where it is, --from and --to take the anchors of two paths, in order.\n\n--kind rigid keeps shapes as stiff as \
it can, similar also lets them grow and shrink, affine lets them shear as well (it needs three pairs that are not on one line).")
    .source("S. Schaefer, T. McPhail, J. Warren, Image deformation using moving least squares, SIGGRAPH 2006")
    .params(Mls::PARAMS)
    .demo(&[("pin", "10,90"), ("pin", "90,90"), ("pair", "50,15:60,5"), ("pair", "52,55:45,48")])
    .examples(&[
        Example {
            what: "Hold the bottom corners, pull the top to the right",
            command: "mls samples/logo.svg --pin 0%,100% --pin 100%,100% --pair '50%,0%:65%,-10%' -o out.svg",
        },
        Example {
            what: "Bend a word",
            command: "mls samples/lettering.svg --kind similar --pair '0%,50%:0%,80%' --pair '50%,50%:50%,20%' --pair '100%,50%:100%,80%' -o out.svg",
        },
        Example {
            what: "The anchors of one path to those of another",
            command: "mls samples/grid.svg --from samples/anchors.svg#base4 --to samples/anchors.svg#target4 --kind affine -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("pin", "10,10"), ("pin", "90,20"), ("pin", "40,80")]),
        Law::Identity(&[("pin", "10,10"), ("pin", "90,20"), ("pin", "40,80"), ("kind", "affine")]),
        // A motion, a similitude, an affine map are reproduced by the kind that holds them.
        Law::Area(&[("pair", "0,0:5,5"), ("pair", "10,0:5,15"), ("pair", "0,10:-5,5")], 1.0),
        Law::Area(&[("kind", "similar"), ("pair", "0,0:5,5"), ("pair", "10,0:5,35"), ("pair", "0,10:-25,5")], 9.0),
        Law::KeepsLines(&[("kind", "affine"), ("pair", "0,0:5,5"), ("pair", "90,0:70,33"), ("pair", "0,80:20,99")]),
        Law::Same(&[("pair", "1,2:3,4")], &[("pair", "50,60:52,62")]),
        Law::KeepsAngles(&[("pair", "0,0:0,0"), ("pair", "10,0:20,20"), ("kind", "similar")]),
    ])
    .cases(&[
        // Handles land to the last bit.
        Case { args: THREE, at: (50.0, 50.0), to: (60.0, 45.0), tolerance: 0.0 },
        Case { args: THREE, at: (10.0, 20.0), to: (10.0, 20.0), tolerance: 0.0 },
        // One handle is a shift.
        Case { args: &[("pair", "1,2:3,5")], at: (10.0, 10.0), to: (12.0, 13.0), tolerance: 1e-12 },
        // Two handles, similar: the similitude, here z ↦ 2iz.
        Case {
            args: &[("kind", "similar"), ("pair", "0,0:0,0"), ("pair", "10,0:0,20")],
            at: (3.0, 4.0),
            to: (-8.0, 6.0),
            tolerance: 1e-12,
        },
    ]);

const THREE: Pairs = &[("pin", "10,20"), ("pair", "50,50:60,45"), ("pair", "80,10:80,15")];

/// Limit on handles: the image of a point depends on all of them.
const MAX_HANDLES: usize = 1000;

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| Mls::read(s, handles(s)?)?.build());

fn handles(s: &Settings<'_>) -> Result<Vec<(Point, Point)>, Error> {
    let mut out = Vec::new();
    for text in s.texts("pair") {
        let (p, q) = text
            .split_once(':')
            .ok_or_else(|| Error::usage("pair", text, "is not two places x,y:X,Y with a colon between them"))?;
        out.push((s.point_in("pair", p)?, s.point_in("pair", q)?));
    }
    for text in s.texts("pin") {
        let p = s.point_in("pin", text)?;
        out.push((p, p));
    }
    match (s.path_if("from")?, s.path_if("to")?) {
        (Some(from), Some(to)) => {
            let (a, b) = (from.outline.anchors(), to.outline.anchors());
            if a.len() != b.len() {
                let problem = format!("has {} anchors, {} has {}", b.len(), from.name, a.len());
                return Err(Error::usage("to", to.name, problem));
            }
            out.extend(a.into_iter().zip(b));
        }
        (None, None) => {}
        (from, _) => {
            let (given, missing) = if from.is_some() { ("from", "to") } else { ("to", "from") };
            return Err(Error::missing(missing, format!("`{given}` goes with it")));
        }
    }
    Ok(out)
}

/// Returns `true` if all points lie on one line, up to the rounding that the affine fit tolerates.
fn on_a_line(p: &[Point]) -> bool {
    let n = p.len() as f64;
    let mean = p.iter().fold(Vec2::ZERO, |s, q| s + q.to_vec2()) / n;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for q in p {
        let d = q.to_vec2() - mean;
        (xx, xy, yy) = (xx + d.x * d.x, xy + d.x * d.y, yy + d.y * d.y);
    }
    xx * yy - xy * xy <= 1e-12 * (xx + yy) * (xx + yy)
}

fn crosses(points: impl Iterator<Item = Point>, size: f64) -> BezPath {
    let mut out = BezPath::new();
    for p in points {
        for d in [Vec2::new(size, size), Vec2::new(size, -size)] {
            out.move_to(p - d);
            out.line_to(p + d);
        }
    }
    out
}

/// The map of two or more handles.
#[derive(Debug, Clone)]
struct MlsMap {
    /// The points pᵢ and their images qᵢ.
    handles: Vec<(Point, Point)>,
    /// For every handle, the squared distance to its nearest neighbour.
    gaps: Vec<f64>,
    stiffness: Stiffness,
    alpha: f64,
}

/// A 2×2 matrix, row by row.
type Matrix<S> = [[S; 2]; 2];

/// Weighted sums over the handles (p, q), relative to the nearest handle.
struct Moments<S> {
    /// Σw.
    w: S,
    /// Σwp, Σwq.
    p: [S; 2],
    q: [S; 2],
    /// Σwpₓpₓ, Σwpₓp_y, Σwp_yp_y.
    pp: [S; 3],
    /// Σwqpᵀ.
    qp: Matrix<S>,
}

impl<S: Real> Moments<S> {
    /// Sums over `handles`, each with its weight, relative to `origin`.
    fn new(handles: impl Iterator<Item = ((Point, Point), S)>, origin: (Point, Point)) -> Self {
        let zero = S::from(0.0);
        let mut m = Self { w: zero, p: [zero; 2], q: [zero; 2], pp: [zero; 3], qp: [[zero; 2]; 2] };
        for (handle, w) in handles {
            let (p, q) = (handle.0 - origin.0, handle.1 - origin.1);
            m.w = m.w + w;
            m.p = [m.p[0] + w * p.x, m.p[1] + w * p.y];
            m.q = [m.q[0] + w * q.x, m.q[1] + w * q.y];
            m.pp = [m.pp[0] + w * (p.x * p.x), m.pp[1] + w * (p.x * p.y), m.pp[2] + w * (p.y * p.y)];
            let [a, b] = m.qp;
            m.qp = [[a[0] + w * (q.x * p.x), a[1] + w * (q.x * p.y)], [b[0] + w * (q.y * p.x), b[1] + w * (q.y * p.y)]];
        }
        m
    }

    /// Returns the means p* and q*, and the sums relative to them: Σwp̂p̂ᵀ = Σwppᵀ − p*(Σwp)ᵀ. Little cancels, because the origin is the
    /// nearest handle, which has the largest weight.
    fn centred(self) -> ([S; 2], [S; 2], [S; 3], Matrix<S>) {
        let Self { w, p: [px, py], q, pp, qp } = self;
        let (mx, my) = (px / w, py / w);
        let pp = [pp[0] - mx * px, pp[1] - mx * py, pp[2] - my * py];
        let qp = [[qp[0][0] - q[0] * mx, qp[0][1] - q[0] * my], [qp[1][0] - q[1] * mx, qp[1][1] - q[1] * my]];
        ([mx, my], [q[0] / w, q[1] / w], pp, qp)
    }
}

impl MlsMap {
    fn new(handles: &[(Point, Point)], stiffness: Stiffness, alpha: f64) -> Self {
        let gap = |p: Point| {
            let others = handles.iter().map(|(o, _)| (*o - p).hypot2()).filter(|d| *d > 0.0);
            others.fold(f64::INFINITY, f64::min)
        };
        let gaps = handles.iter().map(|(p, _)| gap(*p)).collect();
        Self { handles: handles.to_vec(), gaps, stiffness, alpha }
    }

    /// Returns the nearest handle and its squared distance.
    fn nearest(&self, v: Point) -> (usize, f64) {
        let distances = self.handles.iter().map(|(p, _)| (*p - v).hypot2()).enumerate();
        distances.fold((0, f64::INFINITY), |best, next| if next.1 < best.1 { next } else { best })
    }

    /// Returns M from the weighted sums of p̂p̂ᵀ and q̂p̂ᵀ.
    fn matrix<S: Real>(&self, pp: [S; 3], qp: Matrix<S>) -> Matrix<S> {
        let [xx, xy, yy] = pp;
        let [[a, b], [c, d]] = qp;
        if self.stiffness == Stiffness::Affine {
            let det = xx * yy - xy * xy;
            return [
                [(a * yy - b * xy) / det, (b * xx - a * xy) / det],
                [(c * yy - d * xy) / det, (d * xx - c * xy) / det],
            ];
        }
        // Σ q̂·conj(p̂).
        let (re, im) = (a + d, c - b);
        let n = if self.stiffness == Stiffness::Rigid { re.hypot(im) } else { xx + yy };
        let (re, im) = (re / n, im / n);
        [[re, -im], [im, re]]
    }
}

/// Number of handles that take as long as a bicubic net.
const HANDLES: f64 = 4.0;

impl Formula for MlsMap {
    fn cost(&self) -> Cost<'_> {
        Cost::new(1.0 + self.handles.len() as f64 / HANDLES)
    }

    /// The weights vary on the scale of the distance between handles, or, far away, of the distance from them.
    fn detail(&self, area: Rect) -> Option<f64> {
        let distance = |p: Point| Point::new(p.x.clamp(area.x0, area.x1), p.y.clamp(area.y0, area.y1)).distance(p);
        let sizes = self.handles.iter().zip(&self.gaps).map(|((p, _), gap)| gap.sqrt().max(distance(*p)));
        Some(0.5 * sizes.fold(f64::INFINITY, f64::min))
    }

    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        /// Squared distance below which a point lies on the handle, relative to the squared distance between the handle and its neighbour.
        const ON_HANDLE: f64 = 1e-28;
        let (k, d2) = self.nearest(Point::new(x.value(), y.value()));
        let (nearest, gap) = (self.handles[k], self.gaps[k]);
        let (pk, qk) = nearest;
        let (vx, vy) = (x - pk.x, y - pk.y);
        if d2 <= ON_HANDLE * gap {
            let others = self.handles.iter().enumerate().filter(|(i, _)| *i != k);
            let weighted = others.map(|(_, h)| (*h, S::from(((h.0 - pk).hypot2() / gap).powf(-self.alpha))));
            let Moments { pp, qp, .. } = Moments::new(weighted, nearest);
            let m = self.matrix(pp, qp);
            return (m[0][0] * vx + m[0][1] * vy + qk.x, m[1][0] * vx + m[1][1] * vy + qk.y);
        }
        let weighted = self.handles.iter().map(|h| {
            let (dx, dy) = (x - h.0.x, y - h.0.y);
            let ratio = S::from(d2) / (dx * dx + dy * dy);
            (*h, if self.alpha == 1.0 { ratio } else { ratio.powf(self.alpha) })
        });
        let (p, q, pp, qp) = Moments::new(weighted, nearest).centred();
        let m = self.matrix(pp, qp);
        let (vx, vy) = (vx - p[0], vy - p[1]);
        (m[0][0] * vx + m[0][1] * vy + q[0] + qk.x, m[1][0] * vx + m[1][1] * vy + q[1] + qk.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check;
    use crate::deform::Deformation as _;
    use crate::map::Map;
    use crate::param::Args;

    #[test]
    fn is_sound() {
        let faults = check::entry(&ENTRY);
        assert!(faults.is_empty(), "{faults:#?}");
    }

    fn build(pairs: &[(&str, &str)]) -> Result<Built, Error> {
        ENTRY.build_from(&Args::from_pairs(pairs), &check::frame())
    }

    /// The map and its derivative are finite and continuous on every handle and next to it.
    #[test]
    fn handles_are_no_holes() {
        for kind in ["rigid", "similar", "affine"] {
            for alpha in ["1", "1.5", "2"] {
                let mut pairs = THREE.to_vec();
                pairs.extend([("kind", kind), ("alpha", alpha), ("pair", "20,90:30,80")]);
                let m = build(&pairs).unwrap().map;
                for p in [(10.0, 20.0), (50.0, 50.0), (80.0, 10.0), (20.0, 90.0)] {
                    let at = m.jet(p.into());
                    for h in [1e-13, 1e-9, 1e-6] {
                        let beside = m.jet(Point::new(p.0 + 0.6 * h, p.1 - 0.8 * h));
                        assert!(beside.is_finite());
                        assert!(at.p.distance(beside.p) < 10.0 * h + 1e-12, "{kind} {alpha} {p:?} {h}");
                        let jump = (at.dx - beside.dx).hypot() + (at.dy - beside.dy).hypot();
                        assert!(jump < 1e-4, "{kind} {alpha} {p:?} {h}: {at:?} {beside:?}");
                    }
                }
            }
        }
    }

    /// Compares the map with the paper's definition, without scaled weights or shifted origins.
    #[test]
    fn agrees_with_the_definition() {
        let handles: [[(f64, f64); 2]; 3] =
            [[(10.0, 20.0), (10.0, 20.0)], [(50.0, 50.0), (60.0, 45.0)], [(80.0, 10.0), (80.0, 15.0)]];
        let m = build(&[("pin", "10,20"), ("pair", "50,50:60,45"), ("pair", "80,10:80,15")]).unwrap().map;
        // Points between handles, beside a handle, and far away, where cancellation is greatest.
        for (v, exact) in [((33.0, 71.0), 1e-12), ((50.0 + 1e-5, 50.0 - 3e-5), 1e-12), ((-4e4, 9e5), 1e-8)] {
            let v = Point::from(v);
            let w = handles.map(|[p, _]| 1.0 / (Point::from(p) - v).hypot2());
            let mean = |side: usize| {
                let sum = handles.iter().zip(w).fold(Vec2::ZERO, |s, (h, w)| s + Vec2::from(h[side]) * w);
                sum / w.iter().sum::<f64>()
            };
            let (p, q) = (mean(0), mean(1));
            // Equation (8): f = |v − p*|·g/|g| + q*, g = Σ q̂ᵢ·(wᵢ·(p̂ᵢ; −p̂ᵢ⊥)(v − p*; −(v − p*)⊥)ᵀ).
            let d = v.to_vec2() - p;
            let mut g = Vec2::ZERO;
            for ([pi, qi], w) in handles.iter().zip(w) {
                let (a, b) = (Vec2::from(*pi) - p, Vec2::from(*qi) - q);
                g += Vec2::new(b.x * a.dot(d) - b.y * a.cross(d), b.x * a.cross(d) + b.y * a.dot(d)) * w;
            }
            let want = q + g * (d.hypot() / g.hypot());
            assert!(m.point(v).distance(want.to_point()) < exact, "{:?} {want:?}", m.point(v));
        }
    }

    #[test]
    fn faults_are_named() {
        let fault = |pairs: &[(&str, &str)]| build(pairs).err().unwrap().to_string();
        assert!(fault(&[]).contains("pair is needed"));
        assert!(fault(&[("pair", "1,2")]).contains("colon"));
        assert!(fault(&[("pin", "1,2"), ("pair", "1,2:3,4")]).contains("coincide"));
        assert!(fault(&[("pin", "1,1"), ("pin", "2,2"), ("pin", "3,3"), ("kind", "affine")]).contains("one line"));
        assert!(fault(&[("pin", "1,1"), ("pin", "9,1"), ("kind", "affine")]).contains("one line"));
        assert!(fault(&[("from", "0,0 1,1"), ("to", "0,0 1,1 2,2")]).contains("3 anchors"));
        assert!(fault(&[("from", "0,0 1,1")]).contains("to is needed"));
    }
}
