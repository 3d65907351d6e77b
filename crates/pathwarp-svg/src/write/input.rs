//! The drawing to write, with its image.

use crate::bend::bends::{Bend, Bends};
use crate::bend::drawing::BentDrawing;
use crate::bend::fits::{EmbeddedImage, FilterOutcome, PaintFit, PlacedSlot, frame_in_result};
use crate::bend::gradients::NewGradient;
use crate::bend::line::Line;
use crate::bend::options::WarpOptions;
use crate::bend::outcome::{PartOutcome, WarpedPart};
use crate::bend::united::United;
use crate::scene::drawing::Drawing;
use crate::scene::model::{Group, Node, Part, Scene, Tiles};
use crate::source::text::SourceText;
use pathwarp::kurbo::Affine;
use std::collections::BTreeMap;
use std::ops::Range;
use usvg::Paint;
use usvg::filter::{Filter, Kind};

/// A drawing with its image under a map.
#[derive(Clone, Copy)]
pub(crate) struct WriteInput<'a> {
    pub(super) drawing: &'a Drawing,
    pub(super) source: &'a SourceText,
    pub(super) scene: &'a Scene,
    /// The results for the parts, bitmaps and slots of the scene, by their indices there.
    pub(super) outcomes: &'a [PartOutcome],
    pub(super) images: &'a [EmbeddedImage],
    pub(super) slots: &'a [PlacedSlot],
    pub(super) bends: &'a Bends<'a>,
    /// For every part, the index of its bend; `None` if it is not bent.
    pub(super) part_bends: &'a [Option<usize>],
    /// The results for filters, by the index of their slot.
    pub(super) filters: &'a BTreeMap<usize, FilterOutcome>,
    pub(super) united: &'a United,
    /// The line around the artwork.
    pub(super) line: Option<&'a Line>,
    pub(super) options: &'a WarpOptions,
}

impl<'a> WriteInput<'a> {
    pub(crate) fn new(drawing: &'a Drawing, bent: &'a BentDrawing, bends: &'a Bends<'a>) -> Self {
        Self {
            drawing,
            source: &drawing.source,
            scene: drawing.scene(),
            outcomes: &bent.outcomes,
            images: &bent.images,
            slots: &bent.slots,
            bends,
            part_bends: &bent.part_bends,
            filters: &bent.filters,
            united: &bent.united,
            line: bent.line.as_ref(),
            options: &bends.options,
        }
    }

    pub(super) fn part(&self, i: usize) -> &'a Part {
        &self.scene.parts[i]
    }

    /// The result for the filters of a group; `None` if they follow the fit and look different.
    pub(super) fn filter_outcome(&self, g: &Group) -> Option<&'a FilterOutcome> {
        self.filters.get(&g.slot.filter(|_| !g.filters.is_empty())?)
    }

    /// Returns `true` if a group has filters in the result.
    pub(super) fn keeps_filters(&self, g: &Group) -> bool {
        !g.filters.is_empty() && matches!(self.filter_outcome(g), None | Some(FilterOutcome::Fits))
    }

    /// The bend of the first of these parts that is bent.
    pub(super) fn bend(&self, parts: Range<usize>) -> Option<&'a Bend<'a>> {
        self.part_bends[parts].iter().find_map(|i| i.map(|i| &self.bends.each[i]))
    }

    /// The image of a part; `None` if it is unchanged.
    pub(super) fn warped(&self, i: usize) -> Option<&'a WarpedPart> {
        self.outcomes[i].warped()
    }

    /// Returns `true` if all of a node has become part of another shape.
    pub(super) fn is_absorbed(&self, n: &Node) -> bool {
        match n {
            Node::Part(i) => self.united.absorbs(*i),
            Node::Group(g) | Node::Text { content: g, .. } => {
                !g.children.is_empty() && g.children.iter().all(|n| self.is_absorbed(n))
            }
            Node::Image(_) => false,
        }
    }

    /// Returns `true` if any of these parts is warped.
    pub(super) fn changes(&self, parts: Range<usize>) -> bool {
        self.outcomes[parts].iter().any(|o| o.warped().is_some())
    }

    /// The frame (from an object's coordinates to root user space) in the result, of an object that moves along with its slot.
    pub(super) fn written(&self, slot: Option<usize>, frame: Affine) -> Affine {
        frame_in_result(self.scene, self.slots, slot, frame)
    }

    /// The fit to apply to a paint server; `None` if it is unchanged.
    pub(super) fn paint_fit(&self, paint: &Paint, p: &Part, warped: Option<&WarpedPart>) -> Option<PaintFit> {
        let fit = warped.and_then(|w| w.fit).filter(|_| self.options.moves(paint));
        fit.filter(|f| p.local.bounding_box().is_none_or(|b| !f.is_identity(b)))
    }

    /// The gradient that replaces a paint of the part, if there is one. `paint` is that of its fill or its stroke.
    pub(super) fn bent_gradient<'w>(&self, paint: &Paint, p: &Part, warped: &'w WarpedPart) -> Option<&'w NewGradient> {
        match &p.fill {
            Some(f) if std::ptr::eq(f.paint(), paint) => warped.fill_gradient.as_ref(),
            _ => warped.stroke_gradient.as_ref(),
        }
    }

    /// Returns `true` if a part is written in several pieces: its fill or stroke consists of tiles or a picture.
    pub(super) fn in_pieces(&self, i: usize) -> bool {
        let has_picture = |d: &WarpedPart| d.fill_image.is_some() || d.stroke_image.is_some();
        self.warped(i).is_some_and(has_picture) || self.fill_tiles(i).is_some() || self.stroke_tiles(i).is_some()
    }

    /// The tiles of a part's fill, if all of them are warped.
    pub(super) fn fill_tiles(&self, i: usize) -> Option<&'a Tiles> {
        self.warped(i)?;
        self.part(i).fill_tiles.as_ref().filter(|t| self.all_warped(&t.content))
    }

    /// The tiles of a part's stroke, if all of them are warped and the stroke is expanded.
    pub(super) fn stroke_tiles(&self, i: usize) -> Option<&'a Tiles> {
        self.warped(i)?.stroke.outline()?;
        self.part(i).stroke_tiles.as_ref().filter(|t| self.all_warped(&t.content))
    }

    /// Returns `true` if everything in a group is warped, clip paths included.
    fn all_warped(&self, g: &Group) -> bool {
        let clips = &self.scene.clips;
        let mut clip = g.clip;
        while let Some(i) = clip {
            if !self.all_warped(&clips[i].root) {
                return false;
            }
            clip = clips[i].clip;
        }
        g.children.iter().all(|n| match n {
            Node::Group(g) => self.all_warped(g),
            Node::Part(i) => self.warped(*i).is_some(),
            Node::Image(_) | Node::Text { .. } => false,
        })
    }

    /// Returns `true` if a filter of the source shows, by `feImage`, an element that is warped. The filter moves with its group, and
    /// would move that element a second time.
    pub(super) fn shows_warped(&self, f: &Filter) -> bool {
        if !f.primitives().iter().any(|p| matches!(p.kind(), Kind::Image(_))) {
            return false;
        }
        let source = self.source;
        let filters = source.by_id().get(f.id()).into_iter().flatten();
        let images = filters.flat_map(|&e| source.descendants(e));
        let shown = images.filter_map(|e| source.by_id().get(&source.href(e)?)).flatten();
        shown.map(|&e| &source.elements[e].range).any(|range| {
            let is_inside = |p: &Part| p.element().is_some_and(|e| range.contains(&source.elements[e].range.start));
            self.scene.parts.iter().zip(self.outcomes).any(|(p, o)| o.warped().is_some() && is_inside(p))
        })
    }
}
