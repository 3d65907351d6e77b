//! Composition of maps.

use super::{
    AffineMap, Batches, Class, Cost, Crease, Creases, Enclosure, Field, Images, Jet, Level, Map, RationalBezier,
    RationalDegree, Searches, detail_in, inverse_of, middle_and_corners, most_stretched,
};
use crate::budget::Budget;
use kurbo::{Affine, Point, Rect, Vec2};
use std::sync::Arc;

/// A composition of maps, the first applied first. Adjacent affine and projective steps fold into one.
///
/// ```
/// use std::sync::Arc;
/// use pathwarp::kurbo::Affine;
/// use pathwarp::map::{AffineMap, Chain, Class, Map};
///
/// let step = |m| Arc::new(AffineMap(m)) as Arc<dyn Map>;
/// let chain = Chain::new([step(Affine::scale(2.0)), step(Affine::translate((1.0, 0.0)))]);
/// assert_eq!(chain.class(), Class::Affine(Affine::new([2.0, 0.0, 0.0, 2.0, 1.0, 0.0])));
/// ```
#[derive(Debug, Clone, Default)]
pub struct Chain {
    steps: Vec<Arc<dyn Map>>,
}

impl Chain {
    /// Composes `steps`, folding adjacent ones where possible.
    #[must_use]
    pub fn new(steps: impl IntoIterator<Item = Arc<dyn Map>>) -> Self {
        let mut chain = Self::default();
        for s in steps {
            chain.push(s);
        }
        chain
    }

    /// Appends a step.
    pub fn push(&mut self, step: Arc<dyn Map>) {
        let class = step.class();
        if class == Class::Affine(Affine::IDENTITY) {
            return;
        }
        let folded: Option<Arc<dyn Map>> = match (self.steps.last().map(Map::class), class) {
            (Some(Class::Affine(a)), Class::Affine(b)) => Some(Arc::new(AffineMap(b * a))),
            (Some(Class::Affine(a)), Class::Projective(b)) => Some(Arc::new(b.after_affine(a))),
            (Some(Class::Projective(a)), Class::Affine(b)) => Some(Arc::new(a.then_affine(b))),
            (Some(Class::Projective(a)), Class::Projective(b)) => Some(Arc::new(b.after(&a))),
            _ => None,
        };
        if let Some(f) = folded {
            self.steps.pop();
            if f.class() != Class::Affine(Affine::IDENTITY) {
                self.steps.push(f);
            }
        } else {
            self.steps.push(step);
        }
    }

    /// Returns the chain with one more step.
    ///
    /// ```
    /// use pathwarp::kurbo::{Affine, Point};
    /// use pathwarp::map::{AffineMap, Chain, Map, from_fn};
    ///
    /// let chain = Chain::default().then(AffineMap(Affine::scale(2.0))).then(from_fn(|p| Point::new(p.x, p.y + p.x * p.x)));
    /// assert_eq!(chain.point(Point::new(1.0, 1.0)), Point::new(2.0, 6.0));
    /// ```
    #[must_use]
    pub fn then(mut self, step: impl Map + 'static) -> Self {
        self.push(Arc::new(step));
        self
    }

    /// The inverse over `area`, a box in the plane of the source: the closed form of each step that has one ([`Map::inverse`]), Newton's
    /// method over the box of the area's image for the others.
    ///
    /// ```
    /// use pathwarp::kurbo::{Affine, Point, Rect};
    /// use pathwarp::map::{AffineMap, Chain, Map, from_fn};
    ///
    /// let wave = from_fn(|p| Point::new(p.x, p.y + (p.x / 20.0).sin() * 5.0));
    /// let chain = Chain::default().then(wave).then(AffineMap(Affine::rotate(0.3)));
    /// let back = chain.inverse_over(Rect::new(0.0, 0.0, 100.0, 100.0));
    /// let p = Point::new(30.0, 40.0);
    /// assert!(back.point(chain.point(p)).distance(p) < 1e-9);
    /// ```
    #[must_use]
    pub fn inverse_over(&self, area: Rect) -> Self {
        let (mut area, mut back) = (area, Vec::with_capacity(self.steps.len()));
        for step in &self.steps {
            back.push(inverse_of(step, area));
            area = image_box(&**step, area).unwrap_or(area);
        }
        Self::new(back.into_iter().rev())
    }

    /// The steps that remain after folding.
    #[must_use]
    pub fn steps(&self) -> &[Arc<dyn Map>] {
        &self.steps
    }

    /// Returns the chain with its searches charged to `budget`.
    pub(crate) fn spending(&self, budget: &Arc<Budget>) -> Self {
        Self { steps: self.steps.iter().map(|s| s.within(budget).unwrap_or_else(|| Arc::clone(s))).collect() }
    }
}

/// The bounding box of the image of a grid over `area`, without undefined points.
fn image_box(map: &dyn Map, area: Rect) -> Option<Rect> {
    const SIDE: u32 = 33;
    let share = |i: u32| f64::from(i) / f64::from(SIDE - 1);
    let at = |i, j| area.origin() + Vec2::new(share(i) * area.width(), share(j) * area.height());
    let grid: Vec<Point> = (0..SIDE * SIDE).map(|k| at(k % SIDE, k / SIDE)).collect();
    let mut images = vec![Point::ORIGIN; grid.len()];
    map.points(&grid, &mut images);
    let images = images.into_iter().filter(|p| p.is_finite());
    images.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b))
}

/// Points passed from step to step at a time, few enough for the stack.
const BATCH: usize = 16;

/// The level set of a later step, pulled back through the steps `before` it.
fn pull_back(level: &Level, before: &[Arc<dyn Map>]) -> Level {
    match (level, before, before.first().map(Map::class)) {
        (_, [], _) => level.clone(),
        (Level::Line { a, b, c }, [_], Some(Class::Affine(m))) => {
            let [ma, mb, mc, md, me, mf] = m.as_coeffs();
            Level::Line { a: a * ma + b * mb, b: a * mc + b * md, c: a * me + b * mf + c }
        }
        _ => Level::Field(Arc::new((level.clone(), Chain { steps: before.to_vec() }))),
    }
}

/// The level set of a step behind the chain.
impl Field for (Level, Chain) {
    fn at(&self, p: Point) -> f64 {
        self.0.at(self.1.point(p))
    }

    /// `None` behind steps that only estimate their enclosures: a crossing must not be missed.
    fn enclose(&self, along: [Enclosure; 2]) -> Option<Enclosure> {
        let step = |at: [Enclosure; 2], m: &Arc<dyn Map>| match m.detail(Enclosure::area(&at)) {
            Some(_) => None,
            None => m.enclose(at),
        };
        self.0.enclose(self.1.steps.iter().try_fold(along, step)?)
    }
}

impl Map for Chain {
    fn jet(&self, p: Point) -> Jet {
        let Some((first, rest)) = self.steps.split_first() else { return AffineMap::IDENTITY.jet(p) };
        rest.iter().fold(first.jet(p), |j, m| j.then(&m.jet(j.p)))
    }

    fn point(&self, p: Point) -> Point {
        self.steps.iter().fold(p, |q, m| m.point(q))
    }

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        let Some((first, rest)) = self.steps.split_first() else {
            return AffineMap::IDENTITY.jets(ps, out);
        };
        first.jets(ps, out);
        for m in rest {
            if m.prefers_batches() {
                let points: Vec<Point> = out.iter().map(|j| j.p).collect();
                let mut outer = vec![Jet::default(); points.len()];
                m.jets(&points, &mut outer);
                for (j, o) in out.iter_mut().zip(&outer) {
                    *j = j.then(o);
                }
                continue;
            }
            for chunk in out.chunks_mut(BATCH) {
                let (mut points, mut outer) = ([Point::ORIGIN; BATCH], [Jet::default(); BATCH]);
                let n = chunk.len();
                for (p, j) in points.iter_mut().zip(chunk.iter()) {
                    *p = j.p;
                }
                m.jets(&points[..n], &mut outer[..n]);
                for (j, o) in chunk.iter_mut().zip(&outer) {
                    *j = j.then(o);
                }
            }
        }
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        let Some((first, rest)) = self.steps.split_first() else {
            out.copy_from_slice(ps);
            return;
        };
        first.points(ps, out);
        for m in rest {
            if m.prefers_batches() {
                let points = out.to_vec();
                m.points(&points, out);
                continue;
            }
            for chunk in out.chunks_mut(BATCH) {
                let mut points = [Point::ORIGIN; BATCH];
                points[..chunk.len()].copy_from_slice(chunk);
                m.points(&points[..chunk.len()], chunk);
            }
        }
    }

    /// With F₁ = (X₁, Y₁)/W₁ and a second map of degree d₂, the denominator of the chain is W₁^d₂ · (W₂ ∘ F₁).
    fn denominator(&self, p: Point) -> f64 {
        let step = |(p, w): (Point, f64), m: &Arc<dyn Map>| {
            // 1 needs no power, and finding the degree takes time.
            let power = if w == 1.0 { 1 } else { m.rational_degree().map_or(1, |d| d.degree) as i32 };
            (m.point(p), w.powi(power) * m.denominator(p))
        };
        self.steps.iter().fold((p, 1.0), step).1
    }

    fn class(&self) -> Class {
        match self.steps.as_slice() {
            [] => Class::Affine(Affine::IDENTITY),
            [one] => one.class(),
            several => {
                let step = |all: RationalDegree, m: &Arc<dyn Map>| {
                    let d = m.rational_degree()?;
                    let degree = all.degree.checked_mul(d.degree)?;
                    Some(RationalDegree { degree, rational: all.rational || d.rational })
                };
                several.iter().try_fold(RationalDegree::polynomial(1), step).map_or(Class::Smooth, Class::Rational)
            }
        }
    }

    fn creases(&self, out: &mut Creases) {
        for (i, m) in self.steps.iter().enumerate() {
            for c in Creases::of_map(m).items() {
                out.push(Crease { level: pull_back(&c.level, &self.steps[..i]), kind: c.kind });
            }
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let (mut p, mut has_branches) = (inside, false);
        let mut steps = Vec::with_capacity(self.steps.len());
        for (i, m) in self.steps.iter().enumerate() {
            let branch = m.branch(p);
            has_branches |= branch.is_some();
            if i + 1 < self.steps.len() {
                p = m.point(p);
            }
            steps.push(branch.unwrap_or_else(|| m.clone()));
        }
        has_branches.then(|| Arc::new(Self { steps }) as Arc<dyn Map>)
    }

    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        self.steps.iter().try_fold(curve.clone(), |c, m| m.image(&c))
    }

    fn enclose(&self, along: [Enclosure; 2]) -> Option<[Enclosure; 2]> {
        self.steps.iter().try_fold(along, |along, m| m.enclose(along))
    }

    /// If a step states its detail, the least detail of all steps, divided by the stretch of the steps before: enclosures through several
    /// estimates would show features that no step has.
    fn detail(&self, area: Rect) -> Option<f64> {
        if let [only] = self.steps.as_slice() {
            return only.detail(area);
        }
        let mut jets = middle_and_corners(area).map(|p| AffineMap::IDENTITY.jet(p));
        let diagonal = area.size().to_vec2().hypot();
        let (mut least, mut is_stated) = (f64::INFINITY, false);
        for (i, step) in self.steps.iter().enumerate() {
            let stretch = most_stretched(&jets);
            let area = Rect::from_center_size(jets[0].p, (stretch * diagonal, stretch * diagonal));
            is_stated |= step.detail(area).is_some();
            least = least.min(detail_in(&**step, area)? / stretch);
            if i + 1 < self.steps.len() {
                let mut outer = [Jet::default(); 3];
                step.jets(&jets.map(|j| j.p), &mut outer);
                jets = std::array::from_fn(|k| jets[k].then(&outer[k]));
            }
        }
        is_stated.then_some(least)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        let back: Option<Vec<_>> = self.steps.iter().rev().map(Map::inverse).collect();
        back.map(|steps| Arc::new(Self::new(steps)) as Arc<dyn Map>)
    }

    fn preimages(&self, q: Point) -> Option<Vec<Point>> {
        let step = |qs: Vec<Point>, m: &Arc<dyn Map>| {
            let found: Option<Vec<_>> = qs.into_iter().map(|q| m.preimages(q)).collect();
            found.map(|f| f.concat())
        };
        self.steps.iter().rev().try_fold(vec![q], step)
    }

    fn cost(&self) -> Cost<'_> {
        let costs = || self.steps.iter().map(|s| s.cost());
        let cost = Cost::new(costs().map(|c| c.work).sum::<f64>().max(1.0));
        let cost = if costs().any(|c| c.batches.is_some()) { cost.batched(self) } else { cost };
        if costs().any(|c| c.searches.is_some()) { cost.searching(self) } else { cost }
    }
}

impl Batches for Chain {
    fn points_and_jets(&self, (ps, images): Images<'_, Point>, (qs, jets): Images<'_, Jet>) {
        if let [only] = self.steps.as_slice()
            && let Some(batches) = only.cost().batches
        {
            return batches.points_and_jets((ps, images), (qs, jets));
        }
        self.points(ps, images);
        self.jets(qs, jets);
    }

    fn differentiates(&self) -> bool {
        self.steps.iter().filter_map(|s| s.cost().batches).any(Batches::differentiates)
    }
}

impl Searches for Chain {
    fn within(&self, budget: &Arc<Budget>) -> Arc<dyn Map> {
        Arc::new(self.spending(budget))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{BicubicNet, Formula, Homography, Real};
    use crate::outline::Seg;
    use kurbo::Line;
    use std::f64::consts::FRAC_PI_2;

    struct Shear;
    impl Formula for Shear {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x + y * y * 0.1, y)
        }
    }

    /// Waves of length 2π.
    struct Waves;
    impl Formula for Waves {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x, y + x.sin())
        }

        fn detail(&self, _area: Rect) -> Option<f64> {
            Some(FRAC_PI_2)
        }
    }

    fn affine(c: [f64; 6]) -> Arc<dyn Map> {
        Arc::new(AffineMap(Affine::new(c)))
    }

    fn tilt() -> Homography {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(Point::from);
        Homography::from_points(square, [(0.0, 0.0), (1.0, 0.0), (0.8, 0.9), (0.1, 1.0)].map(Point::from)).unwrap()
    }

    #[test]
    fn affine_and_projective_neighbours_fold() {
        let c = Chain::new([
            affine([2.0, 0.0, 0.0, 1.0, 0.0, 0.0]),
            Arc::new(tilt()),
            affine([1.0, 0.3, 0.0, 1.0, 5.0, 0.0]),
        ]);
        assert_eq!(c.steps().len(), 1);
        let p = Point::new(0.2, 0.3);
        let by_hand = Affine::new([1.0, 0.3, 0.0, 1.0, 5.0, 0.0]) * tilt().point(Point::new(0.4, 0.3));
        assert!(c.point(p).distance(by_hand) < 1e-14);
        let back = Chain::new([affine([2.0, 0.0, 0.0, 2.0, 0.0, 0.0]), affine([0.5, 0.0, 0.0, 0.5, 0.0, 0.0])]);
        assert_eq!(back.class(), Class::Affine(Affine::IDENTITY));
    }

    #[test]
    fn details_of_chains_are_those_of_the_source_plane() {
        let area = Rect::new(0.0, 0.0, 0.1, 0.1);
        let threefold = || affine([3.0, 0.0, 0.0, 3.0, 0.0, 0.0]);
        assert_eq!(Chain::new([Arc::new(Shear) as Arc<dyn Map>, threefold()]).detail(area), None);
        // Waves of length 2π are a third as long where the source is stretched threefold first, and as long where it is afterwards.
        let after = Chain::new([threefold(), Arc::new(Waves)]).detail(area).unwrap();
        assert!(after <= FRAC_PI_2 / 3.0 && after > 0.7 * FRAC_PI_2 / 3.0, "{after}");
        let before = Chain::new([Arc::new(Waves) as Arc<dyn Map>, threefold()]).detail(area).unwrap();
        assert!(before <= FRAC_PI_2 && before > 0.7 * FRAC_PI_2, "{before}");
    }

    #[test]
    fn jets_batches_and_single_values_agree() {
        let c = Chain::new([Arc::new(Shear) as Arc<dyn Map>, Arc::new(tilt()), Arc::new(Shear)]);
        let ps: Vec<Point> = (0..40).map(|i| Point::new(f64::from(i) * 0.01, 0.3)).collect();
        let (mut jets, mut points) = (vec![Jet::default(); 40], vec![Point::ORIGIN; 40]);
        c.jets(&ps, &mut jets);
        c.points(&ps, &mut points);
        for i in 0..40 {
            assert_eq!(jets[i], c.jet(ps[i]));
            assert!(jets[i].p.distance(points[i]) < 1e-15 && c.point(ps[i]) == points[i]);
            let h = 1e-6;
            let dx = (c.point(ps[i] + Vec2::new(h, 0.0)) - c.point(ps[i] - Vec2::new(h, 0.0))) / (2.0 * h);
            assert!((dx - jets[i].dx).hypot() < 1e-8);
        }
    }

    #[test]
    fn denominators_are_the_product_of_the_steps() {
        let net = BicubicNet::new(
            &std::array::from_fn(|r| {
                std::array::from_fn(|s| {
                    Point::new(0.1 * s as f64 + 0.02 * (r * r) as f64, 0.1 * r as f64 - 0.01 * (s * r) as f64)
                })
            }),
            Affine::IDENTITY,
        );
        let degree = net.class().degree().unwrap().degree as i32;
        let chain = Chain::new([Arc::new(tilt()) as Arc<dyn Map>, Arc::new(net.clone()), Arc::new(tilt())]);
        assert_eq!(chain.class().degree(), Some(RationalDegree::rational(degree as usize)));
        for p in (0..8).map(|i| Point::new(0.1 * f64::from(i), 0.7 - 0.09 * f64::from(i))) {
            let w = chain.denominator(p);
            let expected = tilt().w(p).powi(degree) * tilt().w(net.point(tilt().point(p)));
            assert!(
                (w - expected).abs() < 1e-14 * expected.abs() && (w - 1.0).abs() > 1e-6 * f64::from(p != Point::ORIGIN)
            );
        }
    }

    #[test]
    fn a_later_horizon_is_found_in_the_source_plane() {
        // The horizon of the second step lies at x = 4 there, at x = 2 in the source, and at x = 2 − y²/20 with a shear first.
        let far = Homography::new([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-0.25, 0.0, 1.0]]);
        let scaled = Chain { steps: vec![affine([2.0, 0.0, 0.0, 1.0, 0.0, 0.0]), Arc::new(far)] };
        let seg = Seg::Line(Line::new((0.0, 1.0), (3.0, 1.0)));
        let creases = Creases::of_map(&scaled);
        assert!(creases.first_undefined(&seg).unwrap().distance((2.0, 1.0).into()) < 1e-12);
        let sheared = Chain { steps: vec![Arc::new(Shear), affine([2.0, 0.0, 0.0, 1.0, 0.0, 0.0]), Arc::new(far)] };
        let creases = Creases::of_map(&sheared);
        assert!(creases.first_undefined(&seg).unwrap().distance((1.9, 1.0).into()) < 1e-12);
        assert!(!creases.defined_at((1.95, 1.0).into()) && creases.defined_at((1.85, 1.0).into()));
    }
}
