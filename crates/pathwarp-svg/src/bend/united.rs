//! Shapes that become one: the last of them in painting order that is an element of its own gets the outline of all.

use super::bends::Bends;
use super::options::Edit;
use super::outcome::{Warning, WarpedDocument};
use crate::scene::areas::is_seen;
use crate::scene::drawing::Drawing;
use crate::scene::model::{Group, Node, PartRole, Scene};
use crate::source::elements::ElementId;
use pathwarp::edit::Area;
use pathwarp::refit::suited;
use pathwarp::{Error, GeometryError, Outline};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;
use usvg::{Fill, Paint};

/// Share of the tolerance within which areas are found; the rest is for gaps.
pub(super) const FINE: f64 = 0.1;

/// What becomes of the parts of a drawing.
#[derive(Default)]
pub(crate) struct United {
    /// By the index of the part: the outline of all, or an empty one for what is now part of another.
    pub(super) outlines: HashMap<usize, Arc<Outline>>,
    /// For each element that has become the outline of all, those that went in, itself among them.
    pub(crate) of: BTreeMap<ElementId, BTreeSet<ElementId>>,
    /// Elements without an area.
    left: BTreeSet<ElementId>,
    /// Whether shapes are to unite at all.
    unites: bool,
}

/// Unites the shapes of each bend that does. `of` has the index of the bend of every part.
pub(super) fn all(drawing: &Drawing, bends: &Bends<'_>, of: &[Option<usize>]) -> Result<United, Error> {
    let mut out = United::default();
    for (k, bend) in bends.each.iter().enumerate() {
        let Some(Edit::Unite { by_fill }) = bend.options.edit else { continue };
        let tolerance = bend.options.refit.tolerance;
        out.unites = true;
        if !unite_all(drawing, (of, k), (by_fill, tolerance), &mut out).map_err(Error::Geometry)? {
            return Err(Error::input(
                &drawing.name,
                "there is nothing to unite: no shape has a fill (outline turns strokes into areas)",
            ));
        }
    }
    Ok(out)
}

/// Unites the shapes of bend `k`. Returns `false` if there are none.
fn unite_all(
    drawing: &Drawing,
    (of, k): (&[Option<usize>], usize),
    (by_fill, finest): (bool, f64),
    out: &mut United,
) -> Result<bool, GeometryError> {
    let scene = drawing.scene();
    let is_own = |i: usize| of[i] == Some(k) && scene.parts[i].role == PartRole::Paint && is_seen(&scene.parts[i]);
    // An element is one shape, and stays as a whole.
    let mut areas: BTreeMap<usize, Area> = BTreeMap::new();
    for i in (0..of.len()).filter(|i| is_own(*i) && !scene.parts[*i].in_tile) {
        let (p, outline) = (&scene.parts[i], &drawing.shapes()[i].outline);
        let Some(e) = p.element() else { continue };
        let even_odd = p.fill.as_ref().is_some_and(|f| f.rule() == usvg::FillRule::EvenOdd);
        let size = outline.bounding_box().map_or(0.0, |b| b.size().to_vec2().hypot());
        let area = match p.fill {
            Some(_) => Area::of(outline, even_odd, FINE * suited(finest, size).max(1e-9 * outline.extent()))?,
            None => Area::default(),
        };
        if area.is_empty() {
            out.left.insert(e);
        }
        areas.insert(i, area);
    }
    let mut sets: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    let around = surroundings(scene);
    for &i in areas.keys().filter(|i| scene.parts[**i].element().is_some_and(|e| !out.left.contains(&e))) {
        let paint = if by_fill { scene.parts[i].fill.as_ref().map(key).unwrap_or_default() } else { String::new() };
        sets.entry(format!("{:?} {paint}", around.get(&i))).or_default().push(i);
    }
    for set in sets.values() {
        unite(drawing, set, &areas, finest, out)?;
    }
    Ok(!sets.is_empty())
}

/// Unites a set of parts, unless it is a single one that does not overlap itself.
fn unite(
    drawing: &Drawing,
    set: &[usize],
    areas: &BTreeMap<usize, Area>,
    tolerance: f64,
    out: &mut United,
) -> Result<(), GeometryError> {
    let parts = &drawing.scene().parts;
    let is_plain = |i: &&usize| parts[**i].owner.is_none();
    let Some(&one) = set.iter().rfind(is_plain).or(set.last()) else { return Ok(()) };
    let sources =
        Outline { subpaths: set.iter().flat_map(|i| drawing.shapes()[*i].outline.subpaths.clone()).collect() };
    let all = Area::union(set.iter().map(|i| &areas[i]), FINE * tolerance)?.with_gaps_closed(tolerance, &sources);
    if set.len() == 1 && all.outline().subpaths.len() == sources.subpaths.len() {
        return Ok(());
    }
    out.outlines.extend(set.iter().map(|i| (*i, Arc::default())));
    out.outlines.insert(one, Arc::new(all.with_arcs_of(&sources, FINE * tolerance)));
    if let Some(e) = parts[one].element() {
        out.of.entry(e).or_default().extend(set.iter().filter_map(|i| parts[*i].element()));
    }
    Ok(())
}

/// The clip paths, masks, filters and transparent groups around each part, where there are any.
fn surroundings(scene: &Scene) -> HashMap<usize, Vec<usize>> {
    fn walk(g: &Group, around: &[usize], out: &mut HashMap<usize, Vec<usize>>) {
        let has_effect = g.clip.is_some() || g.mask.is_some() || !g.filters.is_empty() || g.opacity < 1.0;
        // The address is that of the group, which is unique.
        let own = has_effect.then_some(std::ptr::from_ref(g).addr());
        let around: Vec<usize> = around.iter().copied().chain(own).collect();
        for n in &g.children {
            match n {
                Node::Group(g) => walk(g, &around, out),
                Node::Text { content, .. } => walk(content, &around, out),
                Node::Part(i) if !around.is_empty() => drop(out.insert(*i, around.clone())),
                Node::Part(_) | Node::Image(_) => {}
            }
        }
    }
    let mut out = HashMap::new();
    walk(&scene.root, &[], &mut out);
    out
}

/// A name for the paint of a fill.
fn key(fill: &Fill) -> String {
    let paint = match fill.paint() {
        Paint::Color(c) => format!("{} {} {}", c.red, c.green, c.blue),
        Paint::LinearGradient(g) => format!("gradient {}", g.id()),
        Paint::RadialGradient(g) => format!("gradient {}", g.id()),
        Paint::Pattern(p) => format!("pattern {}", p.id()),
    };
    format!("{paint} {}", fill.opacity().get())
}

impl United {
    /// Whether a part is now part of another.
    pub(crate) fn absorbs(&self, i: usize) -> bool {
        self.outlines.get(&i).is_some_and(|o| o.is_empty())
    }

    /// Reports what went in to the shapes that it has become, whose indices `reports` has, and names what stays.
    pub(super) fn report(&self, drawing: &Drawing, reports: &HashMap<ElementId, usize>, out: &mut WarpedDocument) {
        let names = |all: &BTreeSet<ElementId>| all.iter().map(|e| drawing.source.display_name(*e)).collect();
        for (e, all) in &self.of {
            if let Some(shape) = reports.get(e).and_then(|i| out.shapes.get_mut(*i)) {
                shape.united = names(all);
            }
        }
        if self.of.is_empty() && self.unites {
            let text = "there is nothing to unite: each shape stands alone, and overlaps neither itself nor others";
            out.warnings.push(Warning::Note { text, names: Vec::new() });
        }
        if !self.left.is_empty() {
            let text = "shapes without a fill stay, as they have no area to unite";
            out.warnings.push(Warning::Note { text, names: names(&self.left) });
        }
    }
}
