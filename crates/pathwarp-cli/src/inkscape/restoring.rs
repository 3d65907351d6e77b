//! Restores the sources of warped objects, together with the changes that were made to the objects by hand.

use super::line::{check_recipe, referred, without_missing};
use super::names::split;
use super::stage::{GuidePaths, Scope, Stage};
use pathwarp::kurbo::{Affine, Point, Rect, Vec2};
use pathwarp_engine::failure::Failure;
use pathwarp_svg::objects::{self, Guides, Memory, RestoredObject};
use pathwarp_svg::{Document, Selection};
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

/// Relative change of areas from which an object counts as scaled; coordinates of eight digits cause a smaller one.
const SCALED: f64 = 1e-3;

/// Distance below which two nodes are equal, as a share of the object's size.
const SAME_NODE: f64 = 1e-6;

/// A drawing whose warped objects are replaced by their sources.
pub(super) struct Restoration {
    pub(super) svg: String,
    pub(super) objects: Vec<Restored>,
}

/// An object that was replaced by its source.
pub(super) struct Restored {
    pub(super) object: RestoredObject,
    /// The transform, in root user space, that the object has been given by hand since its warp.
    by_hand: Affine,
    /// The drawing that the warp produced.
    warped: Rc<str>,
}

/// Restores the sources of objects, and finds how each has been moved by hand since its warp.
///
/// # Errors
/// [`Failure::Usage`] if an object was changed by hand in another way, unless such changes are discarded.
pub(super) fn restore(stage: &Stage<'_>, drawing: &str, ids: &[String], discard: bool) -> Result<Restoration, Failure> {
    let sources = objects::restore(drawing, ids, &stage.limits())?;
    let mut objects = Vec::new();
    let mut runs: BTreeMap<&str, Vec<&RestoredObject>> = BTreeMap::new();
    for o in &sources.objects {
        runs.entry(&o.recipe).or_default().push(o);
    }
    let now = if runs.is_empty() { None } else { Some(stage.read(drawing)?) };
    let all = objects::objects(&sources.svg, &stage.limits())?;
    for (recipe, members) in runs {
        // Repeat the warp with the guides that it had.
        let guides = members.first().map(|m| GuidePaths { guides: &m.guides, has: &|_| true });
        let line = split(recipe);
        check_recipe(stage, &line)?;
        // If a guide still exists, the artwork follows that instead of changes by hand.
        let is_guided = referred(&line).iter().any(|id| all.iter().any(|o| o.id == *id));
        let line = without_missing(line, &all);
        let ids: Vec<String> = members.iter().map(|m| m.id.clone()).collect();
        let warped: Rc<str> = stage.warp(&sources.svg, &line, &Scope { ids: &ids }, guides.as_ref())?.svg.into();
        for m in members {
            let nodes_then = Nodes::read(&m.nodes).unwrap_or_default();
            let nodes_now = now.as_ref().map(|now| nodes(now, &m.id)).unwrap_or_default();
            let by_hand = match nodes_then.change_to(&nodes_now) {
                Change::Affine(_) if is_guided => Affine::IDENTITY,
                Change::Affine(map) => map,
                Change::Other if discard => Affine::IDENTITY,
                Change::Other => return Err(changed_by_hand(&m.id)),
            };
            objects.push(Restored { object: m.clone(), by_hand, warped: Rc::clone(&warped) });
        }
    }
    Ok(Restoration { svg: sources.svg, objects })
}

/// Returns the failure that an object has been changed by hand in a way that cannot be repeated.
fn changed_by_hand(id: &str) -> Failure {
    Failure::usage(format!(
        "the shape of {id} was changed by hand after it was warped, and the change would be lost; allow that, or warp the result \
         instead"
    ))
}

/// Repeats the changes made to objects by hand since their warp: colours, labels, positions. `now` is the drawing with the changes.
pub(super) fn with_changes_by_hand(
    stage: &Stage<'_>,
    now: &str,
    mut svg: String,
    objects: &[Restored],
) -> Result<String, Failure> {
    for r in objects {
        // Editors that scale an object scale its stroke width, too, and the transform below includes that.
        let is_scaled = (r.by_hand.determinant().abs() - 1.0).abs() > SCALED;
        let except: &[&str] = if is_scaled { &["stroke-width", "stroke-dasharray", "stroke-dashoffset"] } else { &[] };
        svg = objects::restyled([&r.warped, now, &svg], &r.object.id, except, &stage.limits())?;
    }
    for r in objects.iter().filter(|r| r.by_hand != Affine::IDENTITY) {
        svg = objects::moved(&svg, &r.object.id, r.by_hand, &stage.limits())?;
    }
    Ok(svg)
}

/// Returns the nodes of an object in root user space.
fn nodes(doc: &Document, id: &str) -> Nodes {
    let selection = Selection { select: vec![format!("[id={id}]")], ..Selection::default() };
    let outlines: Vec<_> = doc.selected(&selection).map(|s| Arc::clone(&s.outline)).collect();
    let boxes = outlines.iter().filter_map(|o| o.bounding_box());
    let size = boxes.reduce(|a, b| a.union(b)).map_or(0.0, |b| b.width().hypot(b.height()));
    let subpaths = outlines.iter().flat_map(|o| &o.subpaths);
    Nodes::new(&subpaths.flat_map(|p| without_doubles(p.anchors(), SAME_NODE * size)).collect::<Vec<Point>>())
}

/// Removes nodes of a contour that coincide with the preceding one: relative coordinates leave a gap before the end.
fn without_doubles(mut nodes: Vec<Point>, near: f64) -> Vec<Point> {
    nodes.dedup_by(|b, a| a.distance(*b) <= near);
    while nodes.len() > 1 && nodes.first().zip(nodes.last()).is_some_and(|(a, b)| a.distance(*b) <= near) {
        nodes.pop();
    }
    nodes
}

/// Stores the sources of a result's objects, which are in `before`.
pub(super) fn with_sources(
    stage: &Stage<'_>,
    before: &str,
    result: &str,
    ids: &[String],
    recipe: &str,
    guides: &Guides,
) -> Result<String, Failure> {
    let doc = stage.read(result)?;
    let memory = |id: &String| {
        let nodes = nodes(&doc, id).text();
        Memory { id: id.clone(), recipe: recipe.to_owned(), guides: guides.clone(), nodes }
    };
    let memories: Vec<Memory> = ids.iter().map(memory).collect();
    Ok(objects::remember(before, result, &memories, &stage.limits())?)
}

/// Largest error of a node, as a share of the object's size: Inkscape rounds coordinates to eight digits.
const NODE_ERROR: f64 = 1e-5;

/// Most means in a summary.
const MEANS: usize = 12;

/// A summary of nodes: their number, and means of consecutive groups, which affine maps take to means.
#[derive(Debug, Clone, PartialEq, Default)]
struct Nodes {
    count: usize,
    means: Vec<Point>,
}

impl Nodes {
    /// Summarises nodes.
    fn new(nodes: &[Point]) -> Self {
        let size = nodes.len().div_ceil(MEANS).max(1);
        let mean = |part: &[Point]| {
            let sum = part.iter().fold(Vec2::ZERO, |sum, p| sum + p.to_vec2());
            (sum / part.len() as f64).to_point()
        };
        Self { count: nodes.len(), means: nodes.chunks(size).map(mean).collect() }
    }

    /// Formats the summary.
    fn text(&self) -> String {
        let means = self.means.iter().map(|p| format!(" {},{}", p.x, p.y));
        std::iter::once(self.count.to_string()).chain(means).collect()
    }

    /// Parses a summary. Returns `None` for other text.
    fn read(text: &str) -> Option<Self> {
        let mut words = text.split_whitespace();
        let count = words.next()?.parse().ok()?;
        let point = |w: &str| {
            let (x, y) = w.split_once(',')?;
            Some(Point::new(x.parse().ok()?, y.parse().ok()?))
        };
        Some(Self { count, means: words.map(point).collect::<Option<_>>()? })
    }

    /// Finds the change from these nodes to others.
    fn change_to(&self, now: &Self) -> Change {
        if self.count == now.count { change(&self.means, &now.means) } else { Change::Other }
    }
}

/// A change between two lists of nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Change {
    /// An affine map; the identity if nothing moved.
    Affine(Affine),
    /// No affine map transforms one list into the other.
    Other,
}

/// Finds the affine map that takes each point of `from` to its counterpart in `to`: the identity, a translation or another one.
fn change(from: &[Point], to: &[Point]) -> Change {
    if from.len() != to.len() {
        return Change::Other;
    }
    let (Some(&p0), Some(&q0)) = (from.first(), to.first()) else { return Change::Affine(Affine::IDENTITY) };
    let size = |points: &[Point]| {
        let b = points.iter().fold(Rect::from_points(points[0], points[0]), |b, p| b.union_pt(*p));
        b.width().hypot(b.height())
    };
    let near = NODE_ERROR * size(to).max(size(from)).max(f64::MIN_POSITIVE);
    let fits = |a: &Affine| from.iter().zip(to).all(|(p, q)| (*a * *p).distance(*q) <= near);
    let candidates = [Some(Affine::IDENTITY), Some(Affine::translate(q0 - p0)), by_three_points(from, to)];
    let unit = size(to).log10().floor();
    let mut rounded = candidates.into_iter().flatten().map(|a| rounded(a, unit));
    rounded.find(fits).map_or(Change::Other, Change::Affine)
}

/// Rounds a map to the digits of coordinates, for points whose size is ten to the power of `unit`.
fn rounded(a: Affine, unit: f64) -> Affine {
    /// Inkscape writes fewer digits, so further ones are noise.
    const DIGITS: f64 = 9.0;
    let round = |v: f64, digits: f64| {
        let scale = 10_f64.powf(digits.clamp(0.0, 2.0 * DIGITS));
        (v * scale).round() / scale
    };
    let [a, b, c, d, e, f] = a.as_coeffs();
    let [a, b, c, d] = [a, b, c, d].map(|v| round(v, DIGITS));
    let [e, f] = [e, f].map(|v| round(v, DIGITS - unit));
    Affine::new([a, b, c, d, e, f])
}

/// Returns the affine map that takes three points far apart to their images.
fn by_three_points(from: &[Point], to: &[Point]) -> Option<Affine> {
    let pairs = || from.iter().copied().zip(to.iter().copied());
    let (p0, q0) = pairs().next()?;
    let (p1, q1) = pairs().max_by(|a, b| a.0.distance(p0).total_cmp(&b.0.distance(p0)))?;
    let height = |p: Point| (p1 - p0).cross(p - p0).abs();
    let (p2, q2) = pairs().max_by(|a, b| height(a.0).total_cmp(&height(b.0)))?;
    let (u, v) = (p1 - p0, p2 - p0);
    let are_apart = u.cross(v).abs() > 1e-9 * u.hypot2();
    // Takes (0, 0), (1, 0) and (0, 1) to three points.
    let frame = |o: Point, a: Point, b: Point| Affine::new([a.x - o.x, a.y - o.y, b.x - o.x, b.y - o.y, o.x, o.y]);
    are_apart.then(|| frame(q0, q1, q2) * frame(p0, p0 + u, p0 + v).inverse())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moves_are_found_and_other_changes_are_not() {
        let from: Vec<Point> = (0..9).map(|i| Point::new(f64::from(i * i), f64::from(i * 7 % 5))).collect();
        for a in [Affine::IDENTITY, Affine::translate((3.0, -1.0)), Affine::rotate(0.3).then_scale(2.0), Affine::FLIP_X]
        {
            let to: Vec<Point> = from.iter().map(|p| a * *p + Vec2::new(1e-7, 0.0)).collect();
            let Change::Affine(b) = change(&from, &to) else { panic!("{a:?}") };
            assert!(from.iter().all(|p| (b * *p).distance(a * *p) < 1e-3));
        }
        let mut bent = from.clone();
        bent[4].x += 1.0;
        assert_eq!(change(&from, &bent), Change::Other);
        assert_eq!(change(&from, &from[1..]), Change::Other);
        assert_eq!(change(&[], &[]), Change::Affine(Affine::IDENTITY));
        let many: Vec<Point> = (0..500).map(|i| Point::new(f64::from(i * i % 97), f64::from(i * 31 % 89))).collect();
        let nodes = Nodes::new(&many);
        assert_eq!(Nodes::read(&nodes.text()).as_ref(), Some(&nodes));
        let turned: Vec<Point> = many.iter().map(|p| Affine::rotate(1.0) * *p).collect();
        let change = nodes.change_to(&Nodes::new(&turned));
        assert!(matches!(change, Change::Affine(a) if (a.determinant() - 1.0).abs() < 1e-9));
        let mut bent = many.clone();
        bent[321].y += 1.0;
        assert_eq!(nodes.change_to(&Nodes::new(&bent)), Change::Other);
        assert_eq!(nodes.change_to(&Nodes::new(&many[1..])), Change::Other);
    }
}
