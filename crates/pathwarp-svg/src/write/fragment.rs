//! Writes resolved geometry: groups, parts, and the definitions that they refer to.
//!
//! Group transforms are kept, and the geometry inside is written in the groups' user space, so that strokes, filters and paint
//! servers keep their frames. Groups refer to definitions, which hold groups in turn; the whole recursion is in this file. Parts, clip
//! paths, masks and bitmaps are given by their indices in the scene, `i`.

use super::defs::{Definitions, filter_key, has_usable_stops, server_key};
use super::input::WriteInput;
use super::layers::Layer;
use super::markup::{
    self, CssPaint, CssPaints, Markup, Properties, bent_attributes, bent_url, color, data_url, fill_rule, part_data,
    stroke_scale, svg,
};
use super::surroundings::Surroundings;
use super::{boxes, filter, mesh};
use crate::bend::fits::{EmbeddedImage, FilterOutcome};
use crate::bend::gradients::NewGradient;
use crate::bend::outcome::{Notes, Skipped, StrokeOutcome, WarpedPart};
use crate::bend::pictures::BentImage;
use crate::bend::shading::{Shading, Stop};
use crate::scene::geometry::{affine, rect};
use crate::scene::model::{Group, Node, Part, Tiles};
use crate::source::markup::Tag;
use crate::source::mesh::MeshGradient;
use crate::source::number::{MAX_DECIMALS, outline_data, rectangle, short, shorts, single, singles};
use pathwarp::engine::decimal::matrix;
use pathwarp::kurbo::{Affine, Rect};
use pathwarp_reader::PaintProperty::{self, Fill, FillOpacity, Stroke, StrokeOpacity};
use pathwarp_reader::xml::escape;
use std::fmt::Write as _;
use std::sync::Arc;
use usvg::filter::Filter;
use usvg::{BaseGradient, BlendMode, FillRule, ImageKind, ImageRendering, Paint, PaintOrder, SpreadMethod};

pub(super) const FILTERS: &str = "filters follow the warp as a whole: their regions and lengths are not bent";
const PATTERNS: &str = "patterns follow the warp as a whole: their tiles are not bent";
const CLIPPED_TWICE: &str = "a shape in a clip path has two clip paths of its own; one is left out";

/// Content that takes the place of a paint, and is clipped to the shape; with its opacity.
struct PaintContent {
    content: String,
    opacity: f32,
}

/// Writes elements, and the definitions to which they refer.
pub(super) struct Writer<'a> {
    pub(super) input: WriteInput<'a>,
    pub(super) markup: Markup<'a>,
    pub(super) defs: Definitions,
    /// The surroundings of new elements, if these keep the declarations of paint in the source.
    pub(super) surroundings: Option<Surroundings<'a>>,
    pub(super) skipped: &'a mut Vec<Skipped>,
    pub(super) notes: &'a mut Notes,
}

impl<'a> Writer<'a> {
    /// A writer to the source if `in_source`, else to a new file.
    pub(super) fn new(
        input: WriteInput<'a>,
        in_source: bool,
        skipped: &'a mut Vec<Skipped>,
        notes: &'a mut Notes,
    ) -> Self {
        let markup = Markup::new(input.source, in_source);
        let defs = Definitions::new(input.source, input.scene, in_source);
        Self { input, markup, defs, surroundings: None, skipped, notes }
    }

    pub(super) fn node(&mut self, n: &Node) -> String {
        match n {
            Node::Group(g) => self.group(g, ""),
            Node::Part(i) => self.part(*i),
            Node::Image(i) => self.image(*i),
            Node::Text { element, content, .. } => {
                let of_text = self.surroundings.map(|s| s.for_text(self.input.source, *element));
                let surroundings = std::mem::replace(&mut self.surroundings, of_text);
                let id = element.map_or(String::new(), |e| self.defs.id_attribute(self.input.source, e));
                let inner = self.group(content, "");
                self.surroundings = surroundings;
                self.markup.named_group(&id, inner)
            }
        }
    }

    /// Writes a group. With `extra` attributes it is written even if it has no effect.
    pub(super) fn group(&mut self, g: &Group, extra: &str) -> String {
        self.group_with(g, extra, "")
    }

    /// Writes a group that other elements refer to, so that it keeps no declarations of its surroundings.
    fn group_for_reference(&mut self, g: &Group, extra: &str) -> String {
        let surroundings = self.surroundings.take();
        let text = self.group(g, extra);
        self.surroundings = surroundings;
        text
    }

    /// Writes a group with `lead` before its content.
    pub(super) fn group_with(&mut self, g: &Group, extra: &str, lead: &str) -> String {
        let head = self.head(g, extra);
        let inner = g.children.iter().map(|n| self.node(n)).collect();
        let inner = self.with_pictures(g, inner);
        self.wrapped(g, &head, lead.to_owned() + &inner)
    }

    /// The content of a group between the pictures of its filters, or the picture that replaces it.
    pub(super) fn with_pictures(&self, g: &Group, content: String) -> String {
        let Some(outcome) = self.input.filter_outcome(g) else { return content };
        let [beneath, above] = outcome.pictures().map(|p| p.map(|p| bent_image(&self.markup, p, Affine::IDENTITY)));
        let content = if matches!(outcome, FilterOutcome::Whole(_)) { String::new() } else { content };
        beneath.unwrap_or_default() + &content + &above.unwrap_or_default()
    }

    /// Writes a group around written content.
    pub(super) fn group_around(&mut self, g: &Group, content: &str) -> String {
        let head = self.head(g, "");
        let content = self.with_pictures(g, content.to_owned());
        self.wrapped(g, &head, content)
    }

    /// Wraps content in the group's element, unless that has no attributes.
    fn wrapped(&self, g: &Group, head: &str, content: String) -> String {
        if head.is_empty() {
            return content;
        }
        let tag = if self.link_of(g).is_empty() { "g" } else { "a" };
        self.markup.element(tag).raw(head).around(&content)
    }

    /// The attributes of a group.
    fn head(&mut self, g: &Group, extra: &str) -> String {
        let mut properties = Properties::new();
        if g.opacity < 1.0 {
            properties.push(("opacity", single(f64::from(g.opacity))));
        }
        if let Some(i) = g.clip {
            let id = self.clip_id(i);
            properties.push(("clip-path", format!("url(#{id})")));
        }
        if let Some(i) = g.mask {
            let id = self.mask_id(i);
            properties.push(("mask", format!("url(#{id})")));
        }
        if self.input.keeps_filters(g) {
            properties.push(("filter", self.filters(g)));
        }
        if g.blend != BlendMode::Normal {
            properties.push(("mix-blend-mode", g.blend.to_string()));
        }
        if g.isolate {
            properties.push(("isolation", "isolate".into()));
        }
        let mut head = g.source.map_or(String::new(), |e| self.defs.id_attribute(self.input.source, e));
        head.push_str(extra);
        let transform = match g.slot.map(|s| (self.input.slots[s].fit, self.input.scene.slots[s].fits_outside)) {
            Some((fit, true)) => fit * g.transform,
            Some((fit, false)) => g.transform * fit,
            None => g.transform,
        };
        if transform != Affine::IDENTITY {
            let _ = write!(head, " transform=\"{}\"", matrix(transform));
        }
        head.push_str(&self.markup.attributes(&properties));
        head.push_str(&self.link_of(g));
        head
    }

    /// The link attribute of a group that was an `<a>`, for a new file.
    fn link_of(&self, g: &Group) -> String {
        let source = self.input.source;
        let in_source = self.markup.in_source;
        let link = g.source.filter(|&e| !in_source && source.elements[e].tag == "a").and_then(|e| source.link(e));
        link.map_or(String::new(), |to| format!(" {}=\"{}\"", self.markup.link(), escape(&to)))
    }

    /// Writes a part: as one path, or as two if fill and stroke have different outlines.
    pub(super) fn part(&mut self, i: usize) -> String {
        if self.input.united.absorbs(i) {
            return String::new();
        }
        let p = self.input.part(i);
        let warped = self.input.warped(i);
        let d = part_data(p, warped, self.input.source);
        let id = p.source.map_or(String::new(), |e| self.defs.id_attribute(self.input.source, e));
        if let Some(warped) = warped.filter(|_| self.input.in_pieces(i)) {
            let pieces = self.pieces(i, warped, &d);
            return self.markup.named_group(&id, pieces);
        }
        let mut properties = self.properties(i);
        let outline = warped.and_then(|w| w.stroke.outline()).filter(|_| p.stroke.is_some());
        let fill_area = warped.and_then(|w| w.fill.as_ref());
        let Some(warped) = warped.filter(|_| outline.is_some() || fill_area.is_some()) else {
            return self.markup.path(&d, &id, &properties);
        };
        let (stroke_data, stroke_properties) = match outline {
            Some(outline) => (warped.text(outline), self.outlined(i)),
            None => {
                let mut of_stroke = properties.clone();
                of_stroke.retain(|p| !p.0.starts_with("fill"));
                of_stroke.push(("fill", "none".into()));
                (d.clone(), of_stroke)
            }
        };
        if p.fill.is_none() || fill_area.is_some_and(|a| a.elements().is_empty()) {
            return self.markup.path(&stroke_data, &id, &stroke_properties);
        }
        let stroke = self.markup.path(&stroke_data, "", &stroke_properties);
        properties.retain(|p| !p.0.starts_with("stroke") && p.0 != "paint-order");
        properties.push(("stroke", "none".into()));
        let fill = self.markup.path(&fill_area.map_or(d, |a| warped.text(a)), "", &properties);
        self.markup.named_group(&id, painted(p, fill, stroke))
    }

    /// Writes a part's fill and stroke one after the other: patterns as geometry and gradients as pictures, clipped to the shape.
    fn pieces(&mut self, i: usize, warped: &WarpedPart, d: &str) -> String {
        let fill = self.fill_piece(i, warped, d);
        let stroke = self.stroke_piece(i, warped, d);
        painted(self.input.part(i), fill, stroke)
    }

    /// The tiles that replace a paint, or else its picture.
    fn piece(&mut self, tiles: Option<&Tiles>, picture: Option<&BentImage>, opacity: f32) -> Option<PaintContent> {
        match tiles {
            Some(t) => Some(PaintContent { content: self.group(&t.content, ""), opacity: t.opacity }),
            None => picture.map(|b| PaintContent { content: bent_image(&self.markup, b, Affine::IDENTITY), opacity }),
        }
    }

    fn fill_piece(&mut self, i: usize, warped: &WarpedPart, d: &str) -> String {
        let p = self.input.part(i);
        let opacity = p.fill.as_ref().map_or(1.0, |f| f.opacity().get());
        let content = self.piece(self.input.fill_tiles(i), warped.fill_image.as_ref(), opacity);
        // The fill may have another outline than the stroke, or be empty.
        let area = warped.fill.as_ref().map_or_else(|| d.to_owned(), |a| warped.text(a));
        match (p.fill.as_ref().filter(|_| !area.is_empty()), content) {
            (None, _) => String::new(),
            (Some(f), Some(content)) => self.clipped_to(&area, fill_rule(f.rule()), &content, i),
            (Some(_), None) => {
                let fill = self.fill(i);
                let paints = CssPaints { fill, stroke: None };
                let properties = markup::part_style(&self.markup, p, paints, stroke_scale(Some(warped)));
                self.markup.path(&area, "", &properties)
            }
        }
    }

    fn stroke_piece(&mut self, i: usize, warped: &WarpedPart, d: &str) -> String {
        let p = self.input.part(i);
        let opacity = p.stroke.as_ref().map_or(1.0, |s| s.opacity().get());
        let content = self.piece(self.input.stroke_tiles(i), warped.stroke_image.as_ref(), opacity);
        if p.stroke.is_none() {
            return String::new();
        }
        match (&warped.stroke, content) {
            (StrokeOutcome::Outlined(o), Some(content)) => self.clipped_to(&warped.text(o), "nonzero", &content, i),
            (StrokeOutcome::Outlined(o), None) => {
                let properties = self.outlined(i);
                self.markup.path(&warped.text(o), "", &properties)
            }
            (StrokeOutcome::Scaled(scale), _) => {
                let stroke = self.stroke(i, false);
                let properties = markup::part_style(&self.markup, p, CssPaints { fill: None, stroke }, *scale);
                self.markup.path(d, "", &properties)
            }
        }
    }

    /// Writes the content that takes the place of a paint of part `i`, clipped to an outline.
    fn clipped_to(&mut self, d: &str, rule: &'static str, inner: &PaintContent, i: usize) -> String {
        let p = self.input.part(i);
        let name = p.source.or(p.owner).and_then(|e| self.input.source.attr(e, "id")).filter(|n| !n.is_empty());
        let id = self.defs.new_id(&name.map_or_else(|| "shape-edge".to_owned(), |n| format!("{n}-edge")));
        let mut properties = Properties::new();
        self.markup.push_unless_default("clip-rule", rule, "nonzero", &mut properties);
        let path = self.markup.path(d, "", &properties);
        self.defs.push(&self.markup.element("clipPath").with("id", &id).around(&path));
        let mut properties = vec![("clip-path", format!("url(#{id})"))];
        if inner.opacity < 1.0 {
            properties.push(("opacity", single(f64::from(inner.opacity))));
        }
        self.markup.element("g").raw(&self.markup.attributes(&properties)).around(&inner.content)
    }

    /// The resolved presentation of a part.
    pub(super) fn properties(&mut self, i: usize) -> Properties {
        let p = self.input.part(i);
        let warped = self.input.warped(i);
        let (fill, stroke) = (self.fill(i), self.stroke(i, false));
        markup::part_style(&self.markup, p, CssPaints { fill, stroke }, stroke_scale(warped))
    }

    /// The presentation of an expanded stroke.
    fn outlined(&mut self, i: usize) -> Properties {
        let p = self.input.part(i);
        self.stroke(i, true).map_or_else(Properties::new, |css| markup::outlined(&self.markup, p, css))
    }

    fn fill(&mut self, i: usize) -> Option<CssPaint> {
        let fill = self.input.part(i).fill.as_ref()?;
        Some(self.css_paint(i, [Fill, FillOpacity], (fill.paint(), fill.opacity()), false))
    }

    /// The paint of a stroke; `as_fill` for the interior of an expanded one.
    fn stroke(&mut self, i: usize, as_fill: bool) -> Option<CssPaint> {
        let stroke = self.input.part(i).stroke.as_ref()?;
        Some(self.css_paint(i, [Stroke, StrokeOpacity], (stroke.paint(), stroke.opacity()), as_fill))
    }

    /// A paint as declared in the source, if that means the same for the new element, or else as resolved. With `to_other`, it is written
    /// to another property.
    fn css_paint(
        &mut self,
        i: usize,
        [paint_property, opacity_property]: [PaintProperty; 2],
        (paint, opacity): (&Paint, usvg::Opacity),
        to_other: bool,
    ) -> CssPaint {
        let p = self.input.part(i);
        let around = self.surroundings.filter(|_| matches!(paint, Paint::Color(_)));
        if let Some((around, words)) = around.and_then(|a| Some((a, a.words_of(self.input.source, p)?))) {
            let inherits = |p| around.is_parent && !to_other && words.inherits(p, around.words);
            // `Some(None)` is a value that need not be written, and `None` one that cannot be kept.
            let value =
                |p| if inherits(p) { Some(None) } else { Some(Some(words.taken_over(p, around.words)?.to_owned())) };
            let has_opacity = words.says(opacity_property) || inherits(opacity_property);
            let opacity = if has_opacity { value(opacity_property) } else { Some(Some("1".to_owned())) };
            if let Some((paint, opacity)) = value(paint_property).zip(opacity) {
                return CssPaint { paint, opacity };
            }
        }
        let paint = self.paint(paint, p, self.input.warped(i));
        CssPaint { paint: Some(paint), opacity: Some(single(f64::from(opacity.get()))) }
    }

    /// A paint as a CSS value.
    pub(super) fn paint(&mut self, paint: &Paint, p: &Part, warped: Option<&WarpedPart>) -> String {
        if let Some((w, bent)) = warped.and_then(|w| Some((w, self.input.bent_gradient(paint, p, w)?))) {
            return match bent {
                NewGradient::Plain(shading) => self.bent_gradient(paint, shading),
                NewGradient::Mesh(mesh) => self.mesh(paint, mesh, w.decimals),
            };
        }
        let fit = self.input.paint_fit(paint, p, warped).map_or(Affine::IDENTITY, |f| f.affine);
        if let Some(mesh) = self.input.drawing.mesh(paint) {
            if self.markup.in_source && fit == Affine::IDENTITY {
                return format!("url(#{})", server_id(paint));
            }
            let placed = mesh.on(p.local.bounding_box().unwrap_or_default()).transformed(fit);
            return self.mesh(paint, &placed, MAX_DECIMALS);
        }
        match paint {
            Paint::Color(c) => color(*c),
            Paint::LinearGradient(g) => {
                let geometry = [("x1", g.x1()), ("y1", g.y1()), ("x2", g.x2()), ("y2", g.y2())];
                self.gradient("linearGradient", g, Arc::as_ptr(g) as usize, &geometry, fit)
            }
            Paint::RadialGradient(g) => {
                let (r, fr) = (g.r().get(), g.fr().get());
                let geometry = [("cx", g.cx()), ("cy", g.cy()), ("r", r), ("fx", g.fx()), ("fy", g.fy()), ("fr", fr)];
                let geometry = &geometry[..if fr > 0.0 { 6 } else { 5 }];
                self.gradient("radialGradient", g, Arc::as_ptr(g) as usize, geometry, fit)
            }
            Paint::Pattern(pattern) => self.pattern(pattern, fit),
        }
    }

    /// Refers to a gradient, writing it if necessary. `ptr` is its address, which identifies it.
    fn gradient(&mut self, tag: &str, g: &BaseGradient, ptr: usize, geometry: &[(&str, f32)], fit: Affine) -> String {
        let key = server_key(ptr, fit);
        if let Some(id) = self.defs.servers.get(&key) {
            return format!("url(#{id})");
        }
        let id = self.defs.new_id(g.id());
        let mut tag = self.markup.element(tag).with("id", &id).with("gradientUnits", "userSpaceOnUse");
        let numbers = singles(&geometry.iter().map(|g| g.1).collect::<Vec<_>>());
        tag = geometry.iter().zip(numbers).fold(tag, |tag, ((name, _), v)| tag.with(name, &v));
        let t = fit * affine(g.transform());
        if t != Affine::IDENTITY {
            tag = tag.with("gradientTransform", &matrix(t));
        }
        tag = match g.spread_method() {
            SpreadMethod::Pad => tag,
            SpreadMethod::Reflect => tag.with("spreadMethod", "reflect"),
            SpreadMethod::Repeat => tag.with("spreadMethod", "repeat"),
        };
        let is_foreign = self.input.scene.foreign.contains(&ptr);
        let shares_stops = || has_usable_stops(self.input.source, g.id(), g.stops().len());
        let text = if self.markup.in_source && !is_foreign && shares_stops() {
            tag.with(self.markup.link(), &format!("#{}", g.id())).empty()
        } else {
            let stop = |s: &usvg::Stop| self.stop(s.offset().get().into(), s.color(), s.opacity().get().into());
            tag.around(&g.stops().iter().map(stop).collect::<String>())
        };
        self.defs.push(&text);
        self.defs.servers.insert(key, id.clone());
        format!("url(#{id})")
    }

    fn stop(&self, offset: f64, stop_color: usvg::Color, opacity: f64) -> String {
        let mut properties = vec![("stop-color", color(stop_color))];
        if opacity < 1.0 || self.markup.styled {
            properties.push(("stop-opacity", short(opacity)));
        }
        let tag = self.markup.element("stop").with("offset", &short(offset));
        tag.raw(&self.markup.attributes(&properties)).empty()
    }

    /// Writes a gradient that replaces another, and refers to it.
    fn bent_gradient(&mut self, paint: &Paint, bent: &Shading) -> String {
        let id = self.defs.new_id(server_id(paint));
        let (tag, geometry) = bent.geometry();
        let mut tag = self.markup.element(tag).with("id", &id).with("gradientUnits", "userSpaceOnUse");
        let values: Vec<f64> = geometry.iter().map(|g| g.1).collect();
        tag = geometry.iter().zip(shorts(&values)).fold(tag, |tag, ((name, _), v)| tag.with(name, &v));
        if bent.to_gradient != Affine::IDENTITY {
            tag = tag.with("gradientTransform", &matrix(bent.to_gradient.inverse()));
        }
        let stop = |s: &Stop| {
            let [r, g, b] = [0, 1, 2].map(|channel| (s.color[channel] * 255.0).round() as u8);
            let rounded = |v: f64| (v * 1e6).round() / 1e6;
            self.stop(rounded(s.offset), usvg::Color::new_rgb(r, g, b), rounded(s.color[3]))
        };
        let stops: String = bent.stops.iter().map(stop).collect();
        self.defs.push(&tag.around(&stops));
        format!("url(#{id})")
    }

    /// Writes a mesh gradient that replaces another, and refers to it.
    fn mesh(&mut self, paint: &Paint, mesh: &MeshGradient, decimals: u8) -> String {
        let content = mesh::content(&self.markup, mesh, decimals);
        // A stroke that becomes an outline has its paint written twice.
        if let Some(id) = self.defs.meshes.get(&content) {
            return format!("url(#{id})");
        }
        let id = self.defs.new_id(server_id(paint));
        self.defs.push(&mesh::element(&self.markup, mesh, &id, decimals).around(&content));
        self.defs.meshes.insert(content, id.clone());
        format!("url(#{id})")
    }

    /// Refers to a pattern, writing it if necessary.
    fn pattern(&mut self, pattern: &Arc<usvg::Pattern>, fit: Affine) -> String {
        let key = server_key(Arc::as_ptr(pattern) as usize, fit);
        if let Some(id) = self.defs.servers.get(&key) {
            return format!("url(#{id})");
        }
        let scene = self.input.scene;
        let Some(tile) = scene.tiles.iter().find(|t| Arc::ptr_eq(&t.pattern, pattern)) else {
            return "none".into();
        };
        self.notes.add(PATTERNS, pattern.id());
        let id = self.defs.new_id(pattern.id());
        self.defs.servers.insert(key, id.clone());
        let r = pattern.rect();
        let mut head = self.markup.element("pattern").with("id", &id).with("patternUnits", "userSpaceOnUse");
        head = head.with_all(rectangle(rect(r.to_rect())));
        let t = fit * affine(pattern.transform());
        if t != Affine::IDENTITY {
            head = head.with("patternTransform", &matrix(t));
        }
        let inner = self.group_for_reference(&tile.root, "");
        self.defs.push(&head.around(&inner));
        format!("url(#{id})")
    }

    /// The id of a clip path, which is written if necessary.
    pub(super) fn clip_id(&mut self, i: usize) -> String {
        if let Some(id) = &self.defs.clip_ids[i] {
            return id.clone();
        }
        let id = self.defs.new_id(&self.input.scene.clips[i].id);
        self.defs.clip_ids[i] = Some(id.clone());
        let text = self.clip(i, &format!(" id=\"{}\"", escape(&id)));
        self.defs.push(&text);
        id
    }

    /// Writes a clip path with the attributes `head`. As it must not contain groups, all transforms are on its paths.
    pub(super) fn clip(&mut self, i: usize, head: &str) -> String {
        let c = &self.input.scene.clips[i];
        let mut tag = self.markup.element("clipPath").raw(head);
        if c.transform != Affine::IDENTITY {
            tag = tag.with("transform", &matrix(c.transform));
        }
        if let Some(next) = c.clip {
            let id = self.clip_id(next);
            tag = tag.raw(&self.markup.attributes(&vec![("clip-path", format!("url(#{id})"))]));
        }
        let mut paths = String::new();
        self.clip_children(&c.root, c.root.transform, None, &mut paths);
        tag.around(&paths)
    }

    /// Writes the parts of a group in a clip path. `to_clip` leads from the group to the clip path. `clip` is the clip path of an enclosing
    /// group, with the transform that leads from that group.
    fn clip_children(&mut self, g: &Group, to_clip: Affine, clip: Option<(usize, Affine)>, out: &mut String) {
        if clip.is_some() && g.clip.is_some() {
            self.notes.add(CLIPPED_TWICE, "");
        }
        let clip = g.clip.map(|c| (c, to_clip)).or(clip);
        for n in &g.children {
            match n {
                Node::Group(g) => self.clip_children(g, to_clip * g.transform, clip, out),
                Node::Text { content, .. } => self.clip_children(content, to_clip * content.transform, clip, out),
                Node::Part(i) if self.input.part(*i).visible => out.push_str(&self.clip_part(*i, to_clip, clip)),
                Node::Part(_) | Node::Image(_) => {}
            }
        }
    }

    /// Writes a part of a clip path. A clip path on it refers to the coordinates in which its path is written.
    fn clip_part(&mut self, i: usize, to_clip: Affine, clip: Option<(usize, Affine)>) -> String {
        let p = self.input.part(i);
        let mut properties = Properties::new();
        let rule = fill_rule(p.fill.as_ref().map_or(FillRule::NonZero, usvg::Fill::rule));
        self.markup.push_unless_default("clip-rule", rule, "nonzero", &mut properties);
        let mut transform = to_clip;
        if let Some((i, from_group)) = clip {
            let id = self.clip_id(i);
            properties.push(("clip-path", format!("url(#{id})")));
            transform = from_group;
        }
        let mut head = p.source.map_or(String::new(), |e| self.defs.id_attribute(self.input.source, e));
        if transform != Affine::IDENTITY {
            let _ = write!(head, " transform=\"{}\"", matrix(transform));
        }
        let warped = self.input.warped(i);
        let d = match warped {
            _ if transform == to_clip => part_data(p, warped, self.input.source),
            Some(w) => w.text(&(transform.inverse() * to_clip * w.path.clone())),
            None => outline_data(&p.local.transformed(transform.inverse() * to_clip)),
        };
        self.markup.path(&d, &head, &properties)
    }

    /// The id of a mask, which is written if necessary.
    pub(super) fn mask_id(&mut self, i: usize) -> String {
        if let Some(id) = &self.defs.mask_ids[i] {
            return id.clone();
        }
        let id = self.defs.new_id(&self.input.scene.masks[i].id);
        self.defs.mask_ids[i] = Some(id.clone());
        let text = self.mask(i, &format!(" id=\"{}\"", escape(&id)));
        self.defs.push(&text);
        id
    }

    /// Writes a mask with the attributes `head`.
    pub(super) fn mask(&mut self, i: usize, head: &str) -> String {
        let m = &self.input.scene.masks[i];
        let region = boxes::region(&self.input, i);
        let mut properties = Properties::new();
        if m.kind == usvg::MaskType::Alpha {
            properties.push(("mask-type", "alpha".into()));
        }
        if let Some(next) = m.mask {
            let id = self.mask_id(next);
            properties.push(("mask", format!("url(#{id})")));
        }
        let mut inner = self.group_for_reference(&m.root, "");
        if let Some(edge) = boxes::edge(&self.input, i) {
            let id = self.defs.new_id(&format!("{}-edge", m.id));
            let path = self.markup.path(&edge, "", &Properties::new());
            self.defs.push(&self.markup.element("clipPath").with("id", &id).around(&path));
            let clip = self.markup.attributes(&vec![("clip-path", format!("url(#{id})"))]);
            inner = self.markup.element("g").raw(&clip).around(&inner);
        }
        let tag = self.markup.element("mask").raw(head).with_all(region);
        tag.raw(&self.markup.attributes(&properties)).around(&inner)
    }

    /// Refers to the filters of a group: the source's, or new ones, which are written if necessary.
    pub(super) fn filters(&mut self, g: &Group) -> String {
        self.note_filters(g);
        let growth = boxes::growth(&self.input, g);
        let url = |f: &Arc<Filter>| {
            let region = boxes::grown(f, growth);
            if self.keeps_filter(f) {
                self.defs.grow(f, region);
                return format!("url(#{})", f.id());
            }
            format!("url(#{})", self.filter_id(f, region))
        };
        g.filters.iter().map(url).collect::<Vec<_>>().join(" ")
    }

    /// Notes that the filters of a group do not look right.
    pub(super) fn note_filters(&mut self, g: &Group) {
        if self.input.filter_outcome(g).is_none() {
            g.filters.iter().for_each(|f| self.notes.add(FILTERS, f.id()));
        }
    }

    /// Returns `true` if a filter of the source remains in use.
    pub(super) fn keeps_filter(&self, f: &Arc<Filter>) -> bool {
        let source = self.input.source;
        let is_filter = |v: &Vec<usize>| v.iter().any(|&e| source.elements[e].tag == "filter");
        let is_foreign = self.input.scene.foreign.contains(&(Arc::as_ptr(f) as usize));
        let is_in_source = self.markup.in_source && source.by_id().get(f.id()).is_some_and(is_filter);
        is_in_source && !is_foreign && !self.input.shows_warped(f)
    }

    /// The id of a filter in user space with the given region, which is written if necessary.
    pub(super) fn filter_id(&mut self, f: &Arc<Filter>, region: Rect) -> String {
        let key = filter_key(f, region);
        if let Some(id) = self.defs.filters.get(&key) {
            return id.clone();
        }
        let id = self.new_filter(f, region, None);
        self.defs.filters.insert(key, id.clone());
        id
    }

    /// Writes a filter, or the primitives of it that a layer needs. Returns its id.
    fn new_filter(&mut self, f: &Arc<Filter>, region: Rect, layer: Option<&Layer>) -> String {
        let id = self.defs.new_id(f.id());
        let pictures = f.primitives().iter().filter_map(|p| match p.kind() {
            usvg::filter::Kind::Image(i) => Some(self.picture(i.root())),
            _ => None,
        });
        let pictures: Vec<String> = pictures.collect();
        let text = filter::element(&self.markup, f, region, &id, pictures, layer);
        self.defs.push(&text);
        id
    }

    /// An SVG drawing of the area `view` of a group with its filters, or of a layer of its only filter.
    pub(super) fn layer_drawing(&mut self, g: &Group, layer: Option<&Layer>, view: Rect) -> String {
        let inner: String = g.children.iter().map(|n| self.node(n)).collect();
        let growth = boxes::growth(&self.input, g);
        let urls = g.filters.iter().map(|f| format!("url(#{})", self.new_filter(f, boxes::grown(f, growth), layer)));
        let urls: Vec<String> = urls.collect();
        let content = Tag::new("g").with("filter", &urls.join(" ")).around(&inner);
        let [_, _, width, height] = rectangle(view);
        svg(view).with_all([width, height]).around(&format!("<defs>{}</defs>{content}", self.defs.text))
    }

    /// Writes bitmap `i`, bent or not.
    fn image(&mut self, i: usize) -> String {
        let input = self.input;
        let bitmap = &input.scene.bitmaps[i];
        if !bitmap.image.is_visible() || bitmap.is_unread() {
            return String::new();
        }
        match &input.images[i] {
            EmbeddedImage::Placed => self.placed_image(&bitmap.image),
            EmbeddedImage::Approximate(why) => {
                let id = input.source.image_name(bitmap.owner);
                self.skipped.push(Skipped { id, why: why.clone() });
                self.placed_image(&bitmap.image)
            }
            // The inverse placing leads back to the group's coordinates, the bitmap's pixels. It has no rotation.
            EmbeddedImage::Bent { image, clip } => self.clipped_image(image, clip.as_deref(), bitmap.placing.inverse()),
        }
    }

    /// Writes a bitmap that is not bent.
    fn placed_image(&self, image: &usvg::Image) -> String {
        let drawing = self.input.drawing;
        let file = |media_type: &str, data: &[u8]| {
            let stored = drawing.turned.and_then(|turned| turned(data, &drawing.budget.limits()));
            data_url(media_type, stored.as_deref().unwrap_or(data))
        };
        // The file as it was before the reader turned it by its EXIF orientation.
        let url = match image.kind() {
            ImageKind::JPEG(d) => file("image/jpeg", d),
            ImageKind::PNG(d) => file("image/png", d),
            ImageKind::GIF(d) => file("image/gif", d),
            ImageKind::WEBP(d) => file("image/webp", d),
            ImageKind::SVG(t) => file("image/svg+xml", t.to_string(&usvg::WriteOptions::default()).as_bytes()),
        };
        let rendering = match image.rendering_mode() {
            ImageRendering::OptimizeQuality => None,
            ImageRendering::OptimizeSpeed => Some("optimizeSpeed"),
            ImageRendering::Smooth => Some("smooth"),
            ImageRendering::HighQuality => Some("high-quality"),
            ImageRendering::CrispEdges => Some("crisp-edges"),
            ImageRendering::Pixelated => Some("pixelated"),
        };
        let [width, height] = [image.size().width(), image.size().height()].map(|side| single(side.into()));
        let tag = self.markup.element("image").with("width", &width).with("height", &height);
        let style = rendering.map(|keyword| ("style", format!("image-rendering:{keyword}")));
        tag.with_all(style).raw(&format!(" {}=\"{url}\"", self.markup.link())).empty()
    }

    /// Writes a bent bitmap, and as a definition the outline that clips it. `to_user` leads from the coordinates of both to user space.
    pub(super) fn clipped_image(&mut self, image: &BentImage, clip: Option<&str>, to_user: Affine) -> String {
        let text = bent_image(&self.markup, image, to_user);
        let Some(data) = clip else { return text };
        let id = self.outline_id(data, to_user);
        let clip = self.markup.attributes(&vec![("clip-path", format!("url(#{id})"))]);
        self.markup.element("g").raw(&clip).around(&text)
    }

    /// Writes an outline as a clip path, which `to_user` takes to user space. Returns its id.
    pub(super) fn outline_id(&mut self, data: &str, to_user: Affine) -> String {
        let id = self.defs.new_id("outline");
        let mut path = self.markup.element("path").with("d", data);
        if to_user != Affine::IDENTITY {
            path = path.with("transform", &matrix(to_user));
        }
        let clip = self.markup.element("clipPath").with("id", &id).around(&path.empty());
        self.defs.push(&clip);
        id
    }

    /// Writes the content of an `feImage` as a definition. Returns the attribute that links to it.
    fn picture(&mut self, root: &usvg::Group) -> String {
        let Some(picture) = self.input.scene.pictures.get(&(std::ptr::from_ref(root) as usize)) else {
            return String::new();
        };
        let id = self.defs.new_id("picture");
        let text = self.group_for_reference(picture, &format!(" id=\"{id}\""));
        self.defs.push(&text);
        format!(" {}=\"#{id}\"", self.markup.link())
    }
}

/// Writes a bent bitmap as an element whose user space `to_user` leads to.
pub(super) fn bent_image(markup: &Markup<'_>, bent: &BentImage, to_user: Affine) -> String {
    let tag = markup.element("image").with_all(bent_attributes(bent, to_user));
    tag.raw(&format!(" {}=\"{}\"", markup.link(), bent_url(bent))).empty()
}

/// The elements of a part's fill and stroke in painting order.
fn painted(p: &Part, fill: String, stroke: String) -> String {
    if p.paint_order == PaintOrder::StrokeAndFill { stroke + &fill } else { fill + &stroke }
}

/// The id of a paint, as the source of new ids.
fn server_id(paint: &Paint) -> &str {
    match paint {
        Paint::LinearGradient(g) => g.id(),
        Paint::RadialGradient(g) => g.id(),
        Paint::Pattern(p) => p.id(),
        Paint::Color(_) => "gradient",
    }
}
