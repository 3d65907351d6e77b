//! Patches the source text in place: whatever can stay an element stays that element, with all its owner gave it.

mod animations;

pub(crate) use animations::is_animation;

use crate::bend::image::Picture;
use crate::bend::part::{Notes, Skipped, StrokeDone};
use crate::scene::model::{Group, Node, Referrer};
use crate::source::edit::Edits;
use crate::source::number::{escape, matrix, short};
use crate::source::text::{ElementId, Source, is_shape};
use crate::write::fragment::{Job, Writer, bent_attributes, dashes, data_uri, part_data, stroke_scale};
use pathwarp::kurbo::Affine;
use std::collections::{BTreeMap, BTreeSet};

/// The attributes that say where a shape is, and are gone when it has become a path.
const GEOMETRY: [&str; 14] = ["d", "x", "y", "width", "height", "rx", "ry", "cx", "cy", "r", "x1", "y1", "x2", "y2"];

/// The attributes that tell of lettering.
const LETTERING: [&str; 6] =
    ["data-glyph", "data-baseline", "data-ascent", "data-descent", "data-cap-height", "data-x-height"];

/// A style without what a class may have said and the groups inside say for themselves.
pub(crate) const NO_EFFECTS: &str = " style=\"opacity:1;clip-path:none;mask:none;filter:none;mix-blend-mode:normal\"";

pub(crate) struct Keeper<'a, 'w> {
    pub(crate) edits: Edits<'a>,
    pub(crate) source: &'a Source,
    job: Job<'a>,
    pub(crate) writer: &'w mut Writer<'a>,
    /// Elements that have become groups.
    pub(crate) fragments: BTreeSet<ElementId>,
}

/// The patched text, or why there is none.
pub(crate) fn write(job: &Job<'_>, skipped: &mut Vec<Skipped>, notes: &mut Notes) -> Result<String, String> {
    let source = &job.document.source;
    let mut writer = Writer::new(*job, true, skipped, notes);
    let mut k =
        Keeper { edits: Edits::new(source), source, job: *job, writer: &mut writer, fragments: BTreeSet::new() };
    k.clips()?;
    k.masks()?;
    k.group(&job.document.scene().root);
    k.slots();
    k.animations();
    for (name, value) in job.page().into_iter().flatten() {
        k.edits.set_attr(0, name, value);
    }
    let edits = k.edits;
    let defs = std::mem::take(&mut writer.defs);
    finish(source, edits, &defs, &writer.tag("defs"))
}

/// Adds the new definitions to the file's own, or at its end, where they push no title from first place.
fn finish(source: &Source, mut edits: Edits<'_>, defs: &str, tag: &str) -> Result<String, String> {
    if defs.is_empty() {
        return Ok(if edits.is_empty() { source.text.clone() } else { edits.apply() });
    }
    let home = source.elements.iter().position(|e| e.tag == "defs" && e.parent == Some(0) && e.close.is_some());
    match home {
        Some(home) => edits.wrap_content(home, String::new(), defs.to_owned()),
        None if source.elements[0].close.is_some() => {
            edits.wrap_content(0, String::new(), format!("<{tag}>\n{defs}</{tag}>\n"));
        }
        None => return Err("its root element is empty".into()),
    }
    Ok(edits.apply())
}

impl<'a> Keeper<'a, '_> {
    fn tag(&self, e: ElementId) -> &'a str {
        &self.source.elements[e].tag
    }

    fn done(&self, part: usize) -> bool {
        self.job.outcomes[part].done().is_some()
    }

    /// Clip paths: the first frame's version stays in its place, others get definitions of their own.
    fn clips(&mut self) -> Result<(), String> {
        let scene = &self.job.document.scene();
        let mut placed = BTreeSet::new();
        for (i, c) in scene.clips.iter().enumerate().filter(|c| !c.1.foreign) {
            let def = self.def(&c.id, "clipPath");
            if !self.writer.changes(c.parts.clone()) {
                // A viewport's edge has no definition; everything else is where it was.
                self.writer.clip_ids[i] = def.map(|_| c.id.clone());
                continue;
            }
            let viewport =
                c.referrers.iter().any(|r| r.owner.is_none() && r.element.is_some_and(|e| self.tag(e) == "svg"));
            match def {
                None if viewport => self.viewport(i)?,
                Some(def) if placed.insert(def) => {
                    self.writer.clip_ids[i] = Some(c.id.clone());
                    let units = self.source.attr(def, "clipPathUnits");
                    if units.is_none_or(|u| u != "objectBoundingBox") && self.plain_clip(&c.root) {
                        self.group(&c.root);
                    } else {
                        let head = self.kept_attributes(def, &["clipPathUnits", "transform", "clip-path"]);
                        let text = self.replacing(def, |w| w.clip(i, &head));
                        self.edits.replace(def, text);
                    }
                }
                _ => {
                    let id = self.writer.clip_id(i);
                    self.point(&c.referrers, "clip-path", &id)?;
                }
            }
        }
        Ok(())
    }

    fn masks(&mut self) -> Result<(), String> {
        let scene = &self.job.document.scene();
        let mut placed = BTreeSet::new();
        for (i, m) in scene.masks.iter().enumerate().filter(|m| !m.1.foreign) {
            let def = self.def(&m.id, "mask");
            // Over a box without area a mask in box units hides everything; the box of what is written may have an area.
            let boxed = def.is_none_or(|d| self.source.attr(d, "maskUnits").is_none_or(|u| u != "userSpaceOnUse"));
            if boxed && m.root.children.is_empty() {
                let id = self.writer.mask_id(i);
                self.point(&m.referrers, "mask", &id)?;
                continue;
            }
            if !self.writer.changes(m.parts.clone()) {
                self.writer.mask_ids[i] = def.map(|_| m.id.clone());
                continue;
            }
            match def {
                Some(def) if placed.insert(def) => {
                    self.writer.mask_ids[i] = Some(m.id.clone());
                    let units = self.source.attr(def, "maskContentUnits");
                    let plain = units.is_none_or(|u| u != "objectBoundingBox") && self.writer.mask_edge(i).is_none();
                    if plain {
                        for (name, value) in self.writer.mask_region(i) {
                            self.edits.set_attr(def, name, value);
                        }
                        self.group(&m.root);
                    } else {
                        let gone = ["maskUnits", "maskContentUnits", "x", "y", "width", "height", "mask", "mask-type"];
                        let head = self.kept_attributes(def, &gone);
                        let text = self.replacing(def, |w| w.mask(i, &head));
                        self.edits.replace(def, text);
                    }
                }
                _ => {
                    let id = self.writer.mask_id(i);
                    self.point(&m.referrers, "mask", &id)?;
                }
            }
        }
        Ok(())
    }

    /// What is written in the place of an element, whose ids are free again, unless style sheets or animations lie in wait for
    /// them: what is written says all of its look and place itself.
    fn replacing(&mut self, e: ElementId, write: impl FnOnce(&mut Writer<'a>) -> String) -> String {
        let free = !self.source.has_css() && !self.source.animated;
        self.writer.replaced = free.then(|| (self.source.elements[e].range.clone(), BTreeSet::new()));
        let text = write(self.writer);
        self.writer.replaced = None;
        text
    }

    /// Filtered elements and images move along with their transforms.
    fn slots(&mut self) {
        for (s, placed) in self.job.document.scene().slots.iter().zip(self.job.slots) {
            if let (None, Some(e)) = (s.owner, s.element)
                && placed.fit != Affine::IDENTITY
            {
                let own = self.job.document.own_transform(e);
                self.edits.set_attr(e, "transform", matrix(own * placed.fit));
            }
        }
    }

    fn def(&self, id: &str, tag: &str) -> Option<ElementId> {
        self.source.by_id().get(id)?.iter().copied().rfind(|&e| self.tag(e) == tag)
    }

    /// Points all that referred to the old definition to the new one.
    fn point(&mut self, referrers: &[Referrer], property: &'static str, id: &str) -> Result<(), String> {
        for r in referrers {
            match (r.owner, r.element) {
                // It is written anew and asks for the right one itself.
                (Some(_), _) => {}
                (None, Some(e)) if self.tag(e) == "use" => {}
                (None, Some(e)) => self.edits.set_property(e, property, format!("url(#{id})")),
                (None, None) => return Err(format!("a {property} on an element that cannot be told from others")),
            }
        }
        Ok(())
    }

    /// Whether a clip path holds only shapes of its own that stay one path each.
    fn plain_clip(&self, g: &Group) -> bool {
        g.children.iter().all(|n| match n {
            Node::Group(g) => g.owner.is_none() && self.plain_clip(g),
            Node::Part(i) => {
                let p = &self.job.document.scene().parts[*i];
                p.source.is_some() && p.owner.is_none()
            }
            Node::Image(_) | Node::Text { .. } => false,
        })
    }

    /// A nested viewport cuts its content along straight edges in one place. Warped content must not be cut there: the
    /// viewport lets everything through, and if it did cut something, its warped edge becomes a clip path around it.
    fn viewport(&mut self, i: usize) -> Result<(), String> {
        let c = &self.job.document.scene().clips[i];
        let svgs: BTreeSet<ElementId> =
            c.referrers.iter().filter_map(|r| r.element).filter(|&e| self.tag(e) == "svg").collect();
        for e in svgs {
            self.edits.set_property(e, "overflow", "visible".into());
            if !self.fits(e, c.parts.clone()) {
                if self.source.attr(e, "transform").is_some() {
                    return Err("a nested viewport with a transform of its own cuts its content".into());
                }
                let id = self.writer.clip_id(i);
                let g = self.writer.tag("g");
                self.edits.insert_before(e, &format!("<{g} clip-path=\"url(#{})\">", escape(&id)));
                self.edits.insert_after(e, &format!("</{g}>"));
            }
        }
        Ok(())
    }

    /// Whether all that `e` holds lies inside the box of these parts.
    fn fits(&self, e: ElementId, edge: std::ops::Range<usize>) -> bool {
        let scene = &self.job.document.scene();
        let Some(edge) = scene.parts.get(edge.start).and_then(|p| p.outline().bounding_box()) else { return false };
        let inside = self.source.elements[e].range.clone();
        scene.parts.iter().filter(|p| !p.in_tile).all(|p| {
            let of = p.owner.or(p.source).is_some_and(|s| inside.contains(&self.source.elements[s].range.start));
            let reach = p.stroke.as_ref().map_or(0.0, |s| f64::from(s.width().get() * s.miterlimit().get()));
            let reach = reach * crate::bend::part::stretch(p.frame);
            !of || p.outline().bounding_box().is_none_or(|b| edge.union(b.inflate(reach, reach)) == edge)
        })
    }

    /// The element's attributes but for those that are written anew.
    fn kept_attributes(&self, e: ElementId, gone: &[&str]) -> String {
        let el = &self.source.elements[e];
        let kept = el.attrs.iter().filter(|a| !gone.contains(&a.name(&self.source.text)));
        kept.map(|a| format!(" {}", &self.source.text[a.range.clone()])).collect()
    }

    fn group(&mut self, g: &Group) {
        if let ([n @ Node::Text { element: Some(e), .. }], false) = (g.children.as_slice(), g.filters.is_empty())
            && self.changed(n)
        {
            // Box units meant the box of the letters' places, which outlines do not have.
            let list: Vec<String> = g.filters.iter().map(|f| format!("url(#{})", self.writer.filter_id(f))).collect();
            self.edits.set_property(*e, "filter", list.join(" "));
        } else if g.filters.iter().any(|f| self.writer.shows_warped(f))
            && let Some(slot) = g.slot.map(|s| &self.job.document.scene().slots[s])
            && let (None, Some(e)) = (slot.owner, slot.element)
        {
            let list: Vec<String> = g.filters.iter().map(|f| self.writer.filter(f)).collect();
            self.edits.set_property(e, "filter", list.join(" "));
        }
        let scene = &self.job.document.scene();
        for f in &g.filters {
            self.writer.notes.add(crate::write::fragment::FILTERS, f.id());
        }
        // Shapes with markers: the shape and its copies, in painting order.
        let mut marked: BTreeMap<ElementId, Vec<&Node>> = BTreeMap::new();
        for n in &g.children {
            match n {
                Node::Group(c) => match c.owner {
                    Some(e) if self.tag(e) == "use" => self.copy(e, c),
                    Some(e) if self.tag(e) == "image" => self.vector_image(e, n, c),
                    Some(e) if is_shape(self.tag(e)) => marked.entry(e).or_default().push(n),
                    _ => self.group(c),
                },
                Node::Text { element: Some(e), content, owners } => self.text(*e, content, owners),
                Node::Text { element: None, .. } => {}
                Node::Image(i) => self.image(g, *i),
                Node::Part(i) => match (scene.parts[*i].owner, scene.parts[*i].source) {
                    (Some(e), _) if is_shape(self.tag(e)) => marked.entry(e).or_default().push(n),
                    (None, Some(e)) if self.done(*i) => self.shape(e, *i),
                    _ => {}
                },
            }
        }
        for (e, nodes) in marked {
            if nodes.iter().any(|n| self.changed(n)) {
                let content = nodes.iter().map(|n| self.writer.node(n)).collect();
                self.fragment(e, content);
                for name in ["marker-start", "marker-mid", "marker-end"] {
                    self.edits.set_style(e, name, "none".into());
                }
            }
        }
    }

    pub(crate) fn changed(&self, n: &Node) -> bool {
        match n {
            Node::Part(i) => self.done(*i),
            Node::Group(g) => g.children.iter().any(|n| self.changed(n)),
            Node::Text { content, .. } => content.children.iter().any(|n| self.changed(n)),
            Node::Image(i) => {
                let slot = self.job.document.scene().bitmaps[*i].slot;
                let moved = slot.is_some_and(|s| self.job.slots[s].fit != Affine::IDENTITY);
                moved || matches!(self.job.pictures[*i], Picture::Bent(_))
            }
        }
    }

    fn image(&mut self, g: &Group, i: usize) {
        let bitmap = &self.job.document.scene().bitmaps[i];
        let e = g.source.or(bitmap.owner).filter(|&e| self.tag(e) == "image");
        match (&self.job.pictures[i], e) {
            (Picture::Placed, _) => {}
            (Picture::Bent(bent), Some(e)) => {
                for (name, value) in bent_attributes(bent, Affine::IDENTITY) {
                    self.edits.set_attr(e, name, value);
                }
                self.edits.set_attr(e, "href", data_uri(bent));
            }
            (picture, _) => {
                let id = e.map_or_else(|| "an image".to_owned(), |e| self.source.display_name(e));
                let why = match picture {
                    Picture::Nearly(why) => why.clone(),
                    _ => "its element was not found; it is placed by the best affine fit".to_owned(),
                };
                self.writer.skipped.push(Skipped { id, why });
            }
        }
    }

    /// A shape element stays; only where its stroke has become an outline it turns into a group of two paths.
    fn shape(&mut self, e: ElementId, i: usize) {
        let job = self.job;
        let p = &job.document.scene().parts[i];
        let Some(done) = job.outcomes[i].done() else { return };
        let outlined = p.stroke.is_some() && matches!(done.stroke, StrokeDone::Outlined(_));
        let filled = done.fill.as_ref().is_some_and(|f| !f.elements().is_empty());
        if self.writer.pieced(i) || outlined || filled {
            let content = self.writer.part(i);
            self.fragment(e, content);
            return;
        }
        let tag = self.tag(e);
        if tag != "path" {
            self.edits.rename(e, "path");
            for name in GEOMETRY.into_iter().chain(["points"]) {
                self.edits.remove_attr(e, name);
            }
            // A rule for the old name no longer holds, one for the new name does.
            if self.source.css_mentions(tag) || self.source.css_mentions("path") || self.source.css.contains('[') {
                for (name, value) in self.writer.properties(i) {
                    self.edits.set_style(e, name, value);
                }
            }
        }
        self.edits.set_attr(e, "d", part_data(p, Some(done), self.source));
        self.forget_lettering(e);
        for (name, paint) in
            [("fill", p.fill.as_ref().map(usvg::Fill::paint)), ("stroke", p.stroke.as_ref().map(usvg::Stroke::paint))]
        {
            if let Some(paint) = paint.filter(|paint| self.writer.fit(paint, p, Some(done)).is_some()) {
                let paint = self.writer.paint(paint, p, Some(done));
                self.edits.set_property(e, name, paint);
            }
        }
        // Without a box, a paint server in box units gave way to a colour; now that there may be one, it must not come back.
        let flat = p.local.bounding_box().is_some_and(|b| b.width() == 0.0 || b.height() == 0.0);
        if flat && self.source.text.contains("objectBoundingBox") | self.source.text.contains("Gradient") {
            for (name, value) in self.writer.properties(i) {
                if matches!(name, "fill" | "stroke") {
                    self.edits.set_property(e, name, value);
                }
            }
        }
        if done.fill.is_some() {
            self.edits.set_property(e, "fill", "none".into());
        }
        let scale = stroke_scale(Some(done));
        if let Some(s) = p.stroke.as_ref().filter(|_| (scale - 1.0).abs() > 1e-9) {
            self.edits.set_property(e, "stroke-width", short(f64::from(s.width().get()) * scale));
            if s.dasharray().is_some() {
                self.edits.set_property(e, "stroke-dasharray", dashes(s, scale));
                if s.dashoffset() != 0.0 {
                    self.edits.set_property(e, "stroke-dashoffset", short(f64::from(s.dashoffset()) * scale));
                }
            }
        }
    }

    /// What a letter said of where it stands holds no longer, nor what its line and text said.
    fn forget_lettering(&mut self, e: ElementId) {
        if self.source.attr(e, "data-glyph").is_none() {
            return;
        }
        for a in self.source.ancestors(e) {
            for name in LETTERING {
                if self.source.attr(a, name).is_some() {
                    self.edits.remove_attr(a, name);
                }
            }
        }
    }

    /// A shape element as a group: its attributes and children stay, its geometry becomes `content`.
    fn fragment(&mut self, e: ElementId, content: String) {
        self.forget_lettering(e);
        self.fragments.insert(e);
        self.edits.rename(e, "g");
        for name in GEOMETRY.into_iter().chain(["points"]) {
            self.edits.remove_attr(e, name);
        }
        self.edits.wrap_content(e, String::new(), content);
    }

    /// An image that is a drawing: a group of the same name, with what it showed.
    fn vector_image(&mut self, e: ElementId, n: &Node, g: &Group) {
        if self.changed(n) {
            let content = self.writer.group(g, "");
            for name in ["href", "preserveAspectRatio"] {
                self.edits.remove_attr(e, name);
            }
            self.fragment(e, content);
        }
    }

    /// A `use` whose copy no longer is one: a group with the same name, written from what it showed.
    fn copy(&mut self, e: ElementId, g: &Group) {
        // What it shows may have been warped in its own place.
        let untouched =
            || self.job.options.selection.is_everything() || self.job.outcomes.iter().all(|o| o.done().is_none());
        if !g.children.iter().any(|n| self.changed(n)) && untouched() {
            return;
        }
        let styled = self.source.has_css();
        let kept =
            |name: &str| name == "id" || name == "class" || name.starts_with("data-") || name.starts_with("aria-");
        let el = &self.source.elements[e];
        let mut head: String = el
            .attrs
            .iter()
            .filter(|a| {
                kept(a.name(&self.source.text)) || matches!(a.namespace, crate::source::text::Namespace::Inkscape)
            })
            .map(|a| format!(" {}", &self.source.text[a.range.clone()]))
            .collect();
        let title = self.writer.tag("title");
        let title = el.title.as_ref().map_or(String::new(), |t| format!("<{title}>{}</{title}>", escape(t)));
        self.fragments.insert(e);
        let title = title + &self.kept_animations(e);
        let text = if styled && self.source.attr(e, "class").or(self.source.attr(e, "id")).is_some() {
            // What its class says is in the resolved group already and must not count twice.
            head.push_str(NO_EFFECTS);
            let inner = self.writer.group(g, "");
            format!("<{0}{head}>{title}{inner}</{0}>", self.writer.tag("g"))
        } else {
            self.writer.group_with(g, &head, &title)
        };
        self.edits.replace(e, text);
    }
}
