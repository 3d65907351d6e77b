//! Unites shapes: the last of them in painting order that is a separate element gets the outline of all.

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

/// Fraction of the tolerance within which areas are found; the rest is for gaps.
pub(super) const AREA_SHARE: f64 = 0.1;

/// The united shapes of a drawing.
#[derive(Default)]
pub(crate) struct United {
    /// By the index of the part: the united outline, or an empty one for a part that another one has absorbed.
    pub(super) outlines: HashMap<usize, Arc<Outline>>,
    /// For each element with a united outline, the elements that were united, including itself.
    pub(crate) merged: BTreeMap<ElementId, BTreeSet<ElementId>>,
    /// Elements without an area.
    left: BTreeSet<ElementId>,
    /// `true` if uniting was requested.
    requested: bool,
}

/// Unites the shapes of each bend that requests it. `part_bends` has the index of every part's bend.
pub(super) fn unite_drawing(
    drawing: &Drawing,
    bends: &Bends<'_>,
    part_bends: &[Option<usize>],
) -> Result<United, Error> {
    let mut out = United::default();
    for (k, bend) in bends.each.iter().enumerate() {
        let Some(Edit::Unite { by_fill }) = bend.options.edit else { continue };
        let tolerance = bend.options.refit.tolerance;
        out.requested = true;
        if !unite_bend(drawing, (part_bends, k), (by_fill, tolerance), &mut out).map_err(Error::Geometry)? {
            return Err(Error::input(
                &drawing.name,
                "there is nothing to unite: no shape has a fill (outline turns strokes into areas)",
            ));
        }
    }
    Ok(out)
}

/// Unites the shapes of bend `k`. Returns `false` if there are none.
fn unite_bend(
    drawing: &Drawing,
    (part_bends, k): (&[Option<usize>], usize),
    (by_fill, finest): (bool, f64),
    out: &mut United,
) -> Result<bool, GeometryError> {
    let scene = drawing.scene();
    let mut areas: BTreeMap<usize, Area> = BTreeMap::new();
    for i in (0..part_bends.len()).filter(|i| part_bends[*i] == Some(k)) {
        let (p, outline) = (&scene.parts[i], &drawing.shapes()[i].outline);
        let Some(e) = p.element().filter(|_| p.role == PartRole::Paint && is_seen(p) && !p.in_tile) else { continue };
        let even_odd = p.fill.as_ref().is_some_and(|f| f.rule() == usvg::FillRule::EvenOdd);
        let size = outline.bounding_box().map_or(0.0, |b| b.size().to_vec2().hypot());
        let area = match p.fill {
            Some(_) => Area::of(outline, even_odd, AREA_SHARE * suited(finest, size).max(1e-9 * outline.extent()))?,
            None => Area::default(),
        };
        if area.is_empty() {
            out.left.insert(e);
        }
        areas.insert(i, area);
    }
    let mut sets: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    let groups = effect_groups(scene);
    for &i in areas.keys().filter(|i| scene.parts[**i].element().is_some_and(|e| !out.left.contains(&e))) {
        let paint = scene.parts[i].fill.as_ref().filter(|_| by_fill).map(paint_key).unwrap_or_default();
        sets.entry(format!("{:?} {paint}", groups.get(&i))).or_default().push(i);
    }
    for set in sets.values() {
        unite_set(drawing, set, &areas, finest, out)?;
    }
    Ok(!sets.is_empty())
}

/// Unites a set of parts, unless it is a single one that does not overlap itself.
fn unite_set(
    drawing: &Drawing,
    set: &[usize],
    areas: &BTreeMap<usize, Area>,
    tolerance: f64,
    out: &mut United,
) -> Result<(), GeometryError> {
    let parts = &drawing.scene().parts;
    let is_separate = |i: &&usize| parts[**i].owner.is_none();
    let Some(&remaining) = set.iter().rfind(is_separate).or(set.last()) else { return Ok(()) };
    let sources =
        Outline { subpaths: set.iter().flat_map(|i| drawing.shapes()[*i].outline.subpaths.clone()).collect() };
    let all = Area::union(set.iter().map(|i| &areas[i]), AREA_SHARE * tolerance)?.with_gaps_closed(tolerance, &sources);
    if set.len() == 1 && all.outline().subpaths.len() == sources.subpaths.len() {
        return Ok(());
    }
    out.outlines.extend(set.iter().map(|i| (*i, Arc::default())));
    out.outlines.insert(remaining, Arc::new(all.with_arcs_of(&sources, AREA_SHARE * tolerance)));
    if let Some(e) = parts[remaining].element() {
        out.merged.entry(e).or_default().extend(set.iter().filter_map(|i| parts[*i].element()));
    }
    Ok(())
}

/// The groups with clip paths, masks, filters or opacity around each part, identified by their addresses, where there are any.
fn effect_groups(scene: &Scene) -> HashMap<usize, Vec<usize>> {
    fn walk(g: &Group, around: &[usize], out: &mut HashMap<usize, Vec<usize>>) {
        let has_effect = g.clip.is_some() || g.mask.is_some() || !g.filters.is_empty() || g.opacity < 1.0;
        let address = has_effect.then_some(std::ptr::from_ref(g).addr());
        let around: Vec<usize> = around.iter().copied().chain(address).collect();
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

/// A string that is equal for fills with equal paints and opacities.
fn paint_key(fill: &Fill) -> String {
    let paint = match fill.paint() {
        Paint::Color(c) => format!("{} {} {}", c.red, c.green, c.blue),
        Paint::LinearGradient(g) => format!("gradient {}", g.id()),
        Paint::RadialGradient(g) => format!("gradient {}", g.id()),
        Paint::Pattern(p) => format!("pattern {}", p.id()),
    };
    format!("{paint} {}", fill.opacity().get())
}

impl United {
    /// Returns `true` if a part has become part of another.
    pub(crate) fn absorbs(&self, i: usize) -> bool {
        self.outlines.get(&i).is_some_and(|o| o.is_empty())
    }

    /// Adds the names of the united elements to the reports of their shapes, whose indices `reports` has, and warns about shapes that stay.
    pub(super) fn report(&self, drawing: &Drawing, reports: &HashMap<ElementId, usize>, out: &mut WarpedDocument) {
        let names = |all: &BTreeSet<ElementId>| all.iter().map(|e| drawing.source.display_name(*e)).collect();
        for (e, all) in &self.merged {
            if let Some(shape) = reports.get(e).and_then(|i| out.shapes.get_mut(*i)) {
                shape.united = names(all);
            }
        }
        if self.merged.is_empty() && self.requested {
            let text = "there is nothing to unite: each shape stands alone, and overlaps neither itself nor others";
            out.warnings.push(Warning::Note { text, names: Vec::new() });
        }
        if !self.left.is_empty() {
            let text = "shapes without a fill stay, as they have no area to unite";
            out.warnings.push(Warning::Note { text, names: names(&self.left) });
        }
    }
}
