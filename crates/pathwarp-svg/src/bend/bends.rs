//! The maps that bend a drawing, each with the part that it bends.

use super::options::WarpOptions;
use crate::scene::drawing::Drawing;
use crate::scene::model::{PartRole, Referrer, Scene};
use crate::source::elements::ElementId;
use crate::source::select::Selection;
use crate::source::text::SourceText;
use pathwarp::Error;
use pathwarp::kurbo::Affine;
use pathwarp::map::{AffineMap, Class, Map};
use std::ops::Range;

/// A map with the options for its part of the drawing.
#[derive(Clone)]
pub(crate) struct Bend<'a> {
    pub(crate) map: &'a dyn Map,
    pub(crate) options: WarpOptions,
}

impl<'a> Bend<'a> {
    pub(crate) fn new(map: &'a dyn Map, options: WarpOptions) -> Self {
        let map = match options.edit {
            None => map,
            Some(_) => &AffineMap(Affine::IDENTITY),
        };
        Self { map, options }
    }

    /// Returns `true` if nothing moves.
    pub(crate) fn is_identity(&self) -> bool {
        let WarpOptions { edit, copies, letters, .. } = &self.options;
        edit.is_none()
            && self.map.class() == Class::Affine(Affine::IDENTITY)
            && copies.is_empty()
            && letters.places.is_empty()
    }
}

/// The maps of a drawing. If several select an element, the first one bends it.
#[derive(Clone)]
pub(crate) struct Bends<'a> {
    pub(crate) each: Vec<Bend<'a>>,
    /// The options for the document. Their selection is the union of the bends' selections.
    pub(crate) options: WarpOptions,
    /// For every element, the index of its bend.
    of_element: Vec<Option<usize>>,
    /// The index of a bend that selects everything, including parts without an element.
    everything: Option<usize>,
}

impl<'a> Bends<'a> {
    pub(crate) fn new(source: &SourceText, each: Vec<Bend<'a>>, document: &WarpOptions) -> Self {
        let mut options = document.clone();
        if each.len() > 1 {
            options.selection = Selection::union(source, each.iter().map(|b| &b.options.selection));
        }
        let mut of_element = vec![None; source.elements.len()];
        for (k, bend) in each.iter().enumerate() {
            for (first, selected) in of_element.iter_mut().zip(bend.options.selection.resolve(source)) {
                *first = first.or(selected.then_some(k));
            }
        }
        let everything = each.iter().position(|b| b.options.selection.is_everything());
        Self { each, options, of_element, everything }
    }

    /// Returns `true` if nothing moves.
    pub(crate) fn is_identity(&self) -> bool {
        self.each.iter().all(Bend::is_identity)
    }

    /// The index of an element's bend.
    pub(crate) fn bend_of(&self, e: Option<ElementId>) -> Option<usize> {
        e.map_or(self.everything, |e| self.of_element.get(e).copied().flatten())
    }

    /// The index of the bend of the first referrer that has one.
    fn bend_of_referrers(&self, all: &[Referrer]) -> Option<usize> {
        self.everything.or_else(|| all.iter().find_map(|r| r.owner.or(r.element).and_then(|e| self.bend_of(Some(e)))))
    }

    /// If maps share clip paths or masks, resolves the drawing again with one copy of them for each map.
    pub(crate) fn divided(&self, drawing: &Drawing) -> Result<Option<Drawing>, Error> {
        let Scene { clips, masks, .. } = drawing.scene();
        let mut referrers = clips.iter().map(|c| &c.referrers).chain(masks.iter().map(|m| &m.referrers));
        let bend_of = |r: &Referrer| self.bend_of(r.owner.or(r.element));
        let is_shared = |all: &Vec<Referrer>| all.windows(2).any(|pair| bend_of(&pair[0]) != bend_of(&pair[1]));
        let divides = self.everything.is_none() && referrers.any(is_shared);
        divides.then(|| drawing.divided(self.of_element.clone())).transpose()
    }

    /// For every part of the drawing, the index of its bend. Clip paths and masks follow the elements that refer to them.
    pub(crate) fn part_bends(&self, drawing: &Drawing) -> Vec<Option<usize>> {
        let (scene, far) = (drawing.scene(), drawing.out_of_range());
        let mut out: Vec<Option<usize>> = scene.parts.iter().map(|p| self.bend_of(p.element())).collect();
        let mut fill = |parts: &Range<usize>, bend: Option<usize>, referrers: &[Referrer]| {
            out[parts.clone()].fill(bend.or_else(|| self.bend_of_referrers(referrers)));
        };
        scene.clips.iter().for_each(|c| fill(&c.parts, c.bend, &c.referrers));
        scene.masks.iter().for_each(|m| fill(&m.parts, m.bend, &m.referrers));
        for (i, (bend, p)) in out.iter_mut().zip(&scene.parts).enumerate() {
            let is_text = p.owner.is_some_and(|e| drawing.source.elements[e].tag == "text");
            if far.holds(i) || p.role == PartRole::Pattern || (is_text && self.options.skips_text()) {
                *bend = None;
            }
        }
        out
    }
}
