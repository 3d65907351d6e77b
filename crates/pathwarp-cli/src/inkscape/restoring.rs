//! Restores the sources of warped objects, together with the changes that were made to the objects by hand.

use super::line::{allowed, existing, referred};
use super::names::split;
use super::stage::{GuidePaths, Scope, Stage};
use pathwarp::kurbo::{Affine, Point, Rect, Vec2};
use pathwarp_engine::failure::Failure;
use pathwarp_svg::objects::{self, Guides, Memory, RestoredObject};
use pathwarp_svg::{Document, Selection};
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

/// Relative change of areas that counts as rounding: coordinates have eight digits.
const UNSCALED: f64 = 1e-3;

/// Distance below which two nodes are equal, as a share of the object's size.
const SAME_NODE: f64 = 1e-6;

/// A drawing whose warped objects are replaced by their sources.
pub(super) struct Restoration {
    pub(super) svg: String,
    pub(super) objects: Vec<Returned>,
}

/// An object that was replaced by its source.
pub(super) struct Returned {
    pub(super) object: RestoredObject,
    /// The transform, in root user space, that the object has been given by hand since its warp.
    by_hand: Affine,
    /// The drawing that the warp produced.
    then: Rc<str>,
}

/// Restores the sources of objects, and finds how each has been moved by hand since its warp.
///
/// # Errors
/// [`Failure::Usage`] if an object was changed by hand in another way, unless such changes are discarded.
pub(super) fn restored(
    stage: &Stage<'_>,
    drawing: &str,
    ids: &[String],
    discard: bool,
) -> Result<Restoration, Failure> {
    let back = objects::restore(drawing, ids, &stage.limits())?;
    let mut objects = Vec::new();
    let mut runs: BTreeMap<&str, Vec<&RestoredObject>> = BTreeMap::new();
    for o in &back.objects {
        runs.entry(&o.recipe).or_default().push(o);
    }
    let now = if runs.is_empty() { None } else { Some(stage.read(drawing)?) };
    let all = objects::objects(&back.svg, &stage.limits())?;
    for (recipe, members) in runs {
        // Repeat the warp with the guides that it had.
        let guides = members.first().map(|m| GuidePaths { guides: &m.guides, has: &|_| true });
        let line = split(recipe);
        allowed(stage, &line)?;
        let line = existing(line, &all);
        let ids: Vec<String> = members.iter().map(|m| m.id.clone()).collect();
        let text: Rc<str> = stage.warp(&back.svg, &line, &Scope { ids: &ids }, guides.as_ref())?.svg.into();
        for m in members {
            let was = Nodes::read(&m.nodes).unwrap_or_default();
            let is = now.as_ref().map(|now| nodes(now, &m.id)).unwrap_or_default();
            let by_hand = match was.moved_to(&is) {
                Move::By(a) => a,
                Move::Otherwise if discard => Affine::IDENTITY,
                Move::Otherwise => return Err(changed_by_hand(&m.id)),
            };
            // If the guide still exists, the artwork follows it instead.
            let guided = referred(&split(recipe)).iter().any(|id| all.iter().any(|o| o.id == *id));
            let by_hand = if guided { Affine::IDENTITY } else { by_hand };
            objects.push(Returned { object: m.clone(), by_hand, then: Rc::clone(&text) });
        }
    }
    Ok(Restoration { svg: back.svg, objects })
}

fn changed_by_hand(id: &str) -> Failure {
    Failure::usage(format!(
        "the shape of {id} was changed by hand after it was warped, and the change would be lost; allow that, or warp the result \
         instead"
    ))
}

/// Repeats the changes made to objects by hand since their warp: colours, labels, positions. `now` is the drawing with the changes.
pub(super) fn as_by_hand(
    stage: &Stage<'_>,
    now: &str,
    mut svg: String,
    objects: &[Returned],
) -> Result<String, Failure> {
    for r in objects {
        // Editors that scale an object scale its stroke width, too, and the transform below includes that.
        let is_scaled = (r.by_hand.determinant().abs() - 1.0).abs() > UNSCALED;
        let except: &[&str] = if is_scaled { &["stroke-width", "stroke-dasharray", "stroke-dashoffset"] } else { &[] };
        svg = objects::restyled([&r.then, now, &svg], &r.object.id, except, &stage.limits())?;
    }
    for r in objects.iter().filter(|r| r.by_hand != Affine::IDENTITY) {
        svg = objects::moved(&svg, &r.object.id, r.by_hand, &stage.limits())?;
    }
    Ok(svg)
}

/// The nodes of an object in root user space.
pub(super) fn nodes(doc: &Document, id: &str) -> Nodes {
    let selection = Selection { select: vec![format!("[id={id}]")], ..Selection::default() };
    let outlines: Vec<_> = doc.selected(&selection).map(|s| Arc::clone(&s.outline)).collect();
    let boxes = outlines.iter().filter_map(|o| o.bounding_box());
    let size = boxes.reduce(|a, b| a.union(b)).map_or(0.0, |b| b.width().hypot(b.height()));
    let subpaths = outlines.iter().flat_map(|o| &o.subpaths);
    Nodes::of(&subpaths.flat_map(|p| apart(p.anchors(), SAME_NODE * size)).collect::<Vec<Point>>())
}

/// Removes nodes of a contour that coincide with the preceding one: relative coordinates leave a gap before the end.
fn apart(mut nodes: Vec<Point>, near: f64) -> Vec<Point> {
    nodes.dedup_by(|b, a| a.distance(*b) <= near);
    while nodes.len() > 1 && nodes.first().zip(nodes.last()).is_some_and(|(a, b)| a.distance(*b) <= near) {
        nodes.pop();
    }
    nodes
}

/// Stores the sources of a result's objects, which are in `before`.
pub(super) fn remembering(
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

/// Largest error relative to the object's size: Inkscape rounds coordinates to eight digits.
const LARGEST: f64 = 1e-5;

/// Most means in a summary.
const MEANS: usize = 12;

/// A summary of nodes: their number, and means of consecutive groups, which affine maps take to means.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Nodes {
    count: usize,
    means: Vec<Point>,
}

impl Nodes {
    /// Summarises nodes.
    pub(super) fn of(nodes: &[Point]) -> Self {
        let size = nodes.len().div_ceil(MEANS).max(1);
        let mean = |part: &[Point]| {
            let sum = part.iter().fold(Vec2::ZERO, |sum, p| sum + p.to_vec2());
            (sum / part.len() as f64).to_point()
        };
        Self { count: nodes.len(), means: nodes.chunks(size).map(mean).collect() }
    }

    /// Formats the summary.
    pub(super) fn text(&self) -> String {
        let means = self.means.iter().map(|p| format!(" {},{}", p.x, p.y));
        std::iter::once(self.count.to_string()).chain(means).collect()
    }

    /// Parses a summary. Returns `None` for other text.
    pub(super) fn read(text: &str) -> Option<Self> {
        let mut words = text.split_whitespace();
        let count = words.next()?.parse().ok()?;
        let point = |w: &str| {
            let (x, y) = w.split_once(',')?;
            Some(Point::new(x.parse().ok()?, y.parse().ok()?))
        };
        Some(Self { count, means: words.map(point).collect::<Option<_>>()? })
    }

    /// Finds the affine map that takes these nodes to others.
    pub(super) fn moved_to(&self, now: &Self) -> Move {
        if self.count == now.count { found(&self.means, &now.means) } else { Move::Otherwise }
    }
}

/// A change between two lists of nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Move {
    /// An affine map; the identity if nothing moved.
    By(Affine),
    /// No affine map transforms one list into the other.
    Otherwise,
}

/// Finds the affine map that takes each point of `from` to its counterpart in `to`.
fn found(from: &[Point], to: &[Point]) -> Move {
    let (Some(&p0), Some(&q0)) = (from.first(), to.first()) else {
        return if from.len() == to.len() { Move::By(Affine::IDENTITY) } else { Move::Otherwise };
    };
    if from.len() != to.len() {
        return Move::Otherwise;
    }
    let size = |points: &[Point]| {
        let b = points.iter().fold(Rect::from_points(points[0], points[0]), |b, p| b.union_pt(*p));
        b.width().hypot(b.height())
    };
    let allowed = LARGEST * size(to).max(size(from)).max(f64::MIN_POSITIVE);
    let fits = |a: Affine| from.iter().zip(to).all(|(p, q)| (a * *p).distance(*q) <= allowed);
    let candidates = [Some(Affine::IDENTITY), Some(Affine::translate(q0 - p0)), by_three(from, to)];
    let unit = size(to).log10().floor();
    let near = candidates.into_iter().flatten().map(|a| rounded(a, unit));
    near.into_iter().find(|a| fits(*a)).map_or(Move::Otherwise, Move::By)
}

/// Rounds a map to the digits of coordinates, for points whose size is ten to the power of `unit`.
fn rounded(a: Affine, unit: f64) -> Affine {
    /// Inkscape writes fewer digits, so further ones are noise.
    const DIGITS: f64 = 9.0;
    let round = |v: f64, digits: f64| {
        let k = 10_f64.powf(digits.clamp(0.0, 2.0 * DIGITS));
        (v * k).round() / k
    };
    let [a, b, c, d, e, f] = a.as_coeffs();
    let [a, b, c, d] = [a, b, c, d].map(|v| round(v, DIGITS));
    let [e, f] = [e, f].map(|v| round(v, DIGITS - unit));
    Affine::new([a, b, c, d, e, f])
}

/// Returns the affine map that takes three points far apart to their images.
fn by_three(from: &[Point], to: &[Point]) -> Option<Affine> {
    let p0 = *from.first()?;
    let most = |value: &dyn Fn(&Point) -> f64| {
        let all = from.iter().enumerate().map(|(i, p)| (i, value(p)));
        all.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
    };
    let i = most(&|p| p.distance(p0))?;
    let u = *from.get(i)? - p0;
    let j = most(&|p| u.cross(*p - p0).abs())?;
    let v = *from.get(j)? - p0;
    let frame = |o: Point, a: Point, b: Point| Affine::new([a.x - o.x, a.y - o.y, b.x - o.x, b.y - o.y, o.x, o.y]);
    let q = |i: usize| to.get(i).copied();
    (u.cross(v).abs() > 1e-9 * u.hypot2()).then_some(())?;
    Some(frame(*to.first()?, q(i)?, q(j)?) * frame(p0, p0 + u, p0 + v).inverse())
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
            let Move::By(b) = found(&from, &to) else { panic!("{a:?}") };
            assert!(from.iter().all(|p| (b * *p).distance(a * *p) < 1e-3));
        }
        let mut bent = from.clone();
        bent[4].x += 1.0;
        assert_eq!(found(&from, &bent), Move::Otherwise);
        assert_eq!(found(&from, &from[1..]), Move::Otherwise);
        assert_eq!(found(&[], &[]), Move::By(Affine::IDENTITY));
        let many: Vec<Point> = (0..500).map(|i| Point::new(f64::from(i * i % 97), f64::from(i * 31 % 89))).collect();
        let was = Nodes::of(&many);
        assert_eq!(Nodes::read(&was.text()).as_ref(), Some(&was));
        let turned: Vec<Point> = many.iter().map(|p| Affine::rotate(1.0) * *p).collect();
        assert!(matches!(was.moved_to(&Nodes::of(&turned)), Move::By(a) if (a.determinant() - 1.0).abs() < 1e-9));
        let mut bent = many.clone();
        bent[321].y += 1.0;
        assert_eq!(was.moved_to(&Nodes::of(&bent)), Move::Otherwise);
        assert_eq!(was.moved_to(&Nodes::of(&many[1..])), Move::Otherwise);
    }
}
