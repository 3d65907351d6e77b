//! Definitions: gradients, patterns, clip paths, masks and filters, each written once when first asked for.

use crate::bend::part::{self as warp, StrokeDone};
use crate::scene::model::{Group, Node};
use crate::source::number::{MOST_DECIMALS, escape, matrix, path_data, short};
use crate::write::fragment::{FILTERS, Properties, Writer, part_box, part_data, stroke_scale};
use pathwarp::kurbo::{Affine, Rect, Shape as _};
use pathwarp::refit;
use std::fmt::Write as _;
use usvg::{FillRule, SpreadMethod};

impl Writer<'_> {
    /// Whether a gradient of the source can lend its stops: there is one of this name, and its own links end somewhere.
    fn can_lean_on(&self, id: &str) -> bool {
        /// Longer chains of gradients than any program writes.
        const LONGEST: usize = 16;
        let source = &self.job.document.source;
        let mut next = Some(id.to_owned());
        for _ in 0..LONGEST {
            let Some(id) = next else { return true };
            match source.by_id().get(&id).map(Vec::as_slice) {
                Some(&[e]) if source.elements[e].tag.ends_with("Gradient") => next = source.href(e),
                _ => return false,
            }
        }
        // Renderers may follow a circle for ever.
        false
    }

    pub(crate) fn gradient(
        &mut self,
        tag: &str,
        g: &usvg::BaseGradient,
        key: usize,
        place: &str,
        fit: Affine,
    ) -> String {
        let address = key;
        let key = (key, fit.as_coeffs().map(f64::to_bits));
        if let Some(id) = self.servers.get(&key) {
            return format!("url(#{id})");
        }
        let id = self.new_id(g.id());
        let mut out = format!("<{} id=\"{}\" gradientUnits=\"userSpaceOnUse\" {place}", self.tag(tag), escape(&id));
        let t = fit * crate::scene::geometry::affine(g.transform());
        if t != Affine::IDENTITY {
            let _ = write!(out, " gradientTransform=\"{}\"", matrix(t));
        }
        match g.spread_method() {
            SpreadMethod::Pad => {}
            SpreadMethod::Reflect => out.push_str(" spreadMethod=\"reflect\""),
            SpreadMethod::Repeat => out.push_str(" spreadMethod=\"repeat\""),
        }
        if self.in_source && self.can_lean_on(g.id()) && !self.job.document.scene().foreign.contains(&address) {
            // The stops stay with the original.
            let _ = write!(out, " {}=\"#{}\"/>", self.link(), escape(g.id()));
        } else {
            out.push('>');
            for s in g.stops() {
                let c = s.color();
                let mut properties = vec![("stop-color", format!("#{:02x}{:02x}{:02x}", c.red, c.green, c.blue))];
                if s.opacity().get() < 1.0 || self.styled {
                    properties.push(("stop-opacity", short(s.opacity().get().into())));
                }
                let offset = short(s.offset().get().into());
                let _ = write!(out, "<{} offset=\"{offset}\"{}/>", self.tag("stop"), self.attributes(&properties));
            }
            let _ = write!(out, "</{}>", self.tag(tag));
        }
        self.define(&out);
        self.servers.insert(key, id.clone());
        format!("url(#{id})")
    }

    pub(crate) fn pattern(&mut self, pattern: &std::sync::Arc<usvg::Pattern>, fit: Affine) -> String {
        let key = (std::sync::Arc::as_ptr(pattern) as usize, fit.as_coeffs().map(f64::to_bits));
        if let Some(id) = self.servers.get(&key) {
            return format!("url(#{id})");
        }
        let scene = &self.job.document.scene();
        let Some(tile) = scene.tiles.iter().find(|t| std::sync::Arc::ptr_eq(&t.pattern, pattern)) else {
            return "none".into();
        };
        self.notes.add("patterns follow the warp as a whole, their tiles are not bent", pattern.id());
        let id = self.new_id(pattern.id());
        self.servers.insert(key, id.clone());
        let r = pattern.rect();
        let mut out = format!(
            "<{} id=\"{}\" patternUnits=\"userSpaceOnUse\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"",
            self.tag("pattern"),
            escape(&id),
            short(r.x().into()),
            short(r.y().into()),
            short(r.width().into()),
            short(r.height().into())
        );
        let t = fit * crate::scene::geometry::affine(pattern.transform());
        if t != Affine::IDENTITY {
            let _ = write!(out, " patternTransform=\"{}\"", matrix(t));
        }
        let inner = self.group(&tile.root, "");
        let _ = write!(out, ">{inner}</{}>", self.tag("pattern"));
        self.define(&out);
        format!("url(#{id})")
    }

    pub(crate) fn define(&mut self, text: &str) {
        self.defs.push_str(text);
        self.defs.push('\n');
    }

    /// A clip path's id; it is written when first asked for.
    pub(crate) fn clip_id(&mut self, i: usize) -> String {
        if let Some(id) = &self.clip_ids[i] {
            return id.clone();
        }
        let id = self.new_id(&self.job.document.scene().clips[i].id.clone());
        self.clip_ids[i] = Some(id.clone());
        let text = self.clip(i, &format!(" id=\"{}\"", escape(&id)));
        self.define(&text);
        id
    }

    /// A clip path, all transforms on its paths, as it must not hold groups.
    pub(crate) fn clip(&mut self, i: usize, head: &str) -> String {
        let scene = &self.job.document.scene();
        let c = &scene.clips[i];
        let mut out = format!("<{}{head}", self.tag("clipPath"));
        if c.transform != Affine::IDENTITY {
            let _ = write!(out, " transform=\"{}\"", matrix(c.transform));
        }
        if let Some(next) = c.clip {
            let id = self.clip_id(next);
            out.push_str(&self.attributes(&vec![("clip-path", format!("url(#{id})"))]));
        }
        out.push('>');
        self.clip_children(&c.root, c.root.transform, None, &mut out);
        let _ = write!(out, "</{}>", self.tag("clipPath"));
        out
    }

    fn clip_children(&mut self, g: &Group, t: Affine, clip: Option<usize>, out: &mut String) {
        let job = self.job;
        if clip.is_some() && g.clip.is_some() {
            self.notes.add("a shape in a clip path is clipped twice over; one of the two is left out", "");
        }
        let clip = g.clip.or(clip);
        for n in &g.children {
            match n {
                Node::Group(g) => self.clip_children(g, t * g.transform, clip, out),
                Node::Text { content, .. } => self.clip_children(content, t * content.transform, clip, out),
                Node::Image(_) => {}
                Node::Part(i) => {
                    let p = &job.document.scene().parts[*i];
                    if !p.visible {
                        continue;
                    }
                    let mut properties = Properties::new();
                    let rule = p.fill.as_ref().map_or(FillRule::NonZero, usvg::Fill::rule);
                    if rule == FillRule::EvenOdd {
                        properties.push(("clip-rule", "evenodd".into()));
                    } else if self.may_inherit("clip-rule") {
                        properties.push(("clip-rule", "nonzero".into()));
                    }
                    if let Some(i) = clip {
                        let id = self.clip_id(i);
                        properties.push(("clip-path", format!("url(#{id})")));
                    }
                    let mut head = p.source.map_or(String::new(), |e| self.id_attribute(e));
                    if t != Affine::IDENTITY {
                        let _ = write!(head, " transform=\"{}\"", matrix(t));
                    }
                    let d = part_data(p, job.outcomes[*i].done(), &job.document.source);
                    out.push_str(&self.path(&d, &head, &properties));
                }
            }
        }
    }

    /// A mask's id; it is written when first asked for.
    pub(crate) fn mask_id(&mut self, i: usize) -> String {
        if let Some(id) = &self.mask_ids[i] {
            return id.clone();
        }
        let id = self.new_id(&self.job.document.scene().masks[i].id.clone());
        self.mask_ids[i] = Some(id.clone());
        let text = self.mask(i, &format!(" id=\"{}\"", escape(&id)));
        self.define(&text);
        id
    }

    pub(crate) fn mask(&mut self, i: usize, head: &str) -> String {
        let scene = &self.job.document.scene();
        let m = &scene.masks[i];
        let region = self.mask_region(i);
        let mut properties = Properties::new();
        if m.kind == usvg::MaskType::Alpha {
            properties.push(("mask-type", "alpha".into()));
        }
        if let Some(next) = m.mask {
            let id = self.mask_id(next);
            properties.push(("mask", format!("url(#{id})")));
        }
        let mut inner = self.group(&m.root, "");
        if let Some(edge) = self.mask_edge(i) {
            let id = self.new_id(&format!("{}-edge", m.id));
            let path = self.path(&edge, "", &Properties::new());
            self.define(&format!("<{0} id=\"{1}\">{path}</{0}>", self.tag("clipPath"), escape(&id)));
            let clip = self.attributes(&vec![("clip-path", format!("url(#{id})"))]);
            inner = format!("<{0}{clip}>{inner}</{0}>", self.tag("g"));
        }
        let attrs: String = region.into_iter().map(|(n, v)| format!(" {n}=\"{v}\"")).collect();
        format!("<{0}{head}{attrs}{1}>{inner}</{0}>", self.tag("mask"), self.attributes(&properties))
    }

    /// The attributes that say where a mask counts: about all that its content covers after the warp.
    pub(crate) fn mask_region(&self, i: usize) -> Vec<(&'static str, String)> {
        let scene = &self.job.document.scene();
        let m = &scene.masks[i];
        let mut area = m.rect;
        if self.changes(m.parts.clone()) {
            for i in m.parts.clone() {
                let p = &scene.parts[i];
                let written = |slot, frame| warp::written(scene, self.job.slots, slot, frame);
                let to_frame = written(m.slot, m.frame).inverse() * written(p.slot, p.frame);
                let done = self.job.outcomes[i].done();
                let wide = match (&p.stroke, done.map(|d| &d.stroke)) {
                    (_, Some(StrokeDone::Outlined(o))) => Rect::bounding_box(&o.bounding_box()),
                    (Some(s), _) => {
                        let reach = f64::from(s.width().get()) * stroke_scale(done) * f64::from(s.miterlimit().get());
                        part_box(p, done).inflate(reach, reach)
                    }
                    (None, _) => part_box(p, done),
                };
                area = area.union(to_frame.transform_rect_bbox(wide));
            }
            // The source's own region stays inside; a renderer only pays for it.
            let margin = 0.01 * area.width().max(area.height());
            area = area.inflate(margin, margin);
        }
        vec![
            ("maskUnits", "userSpaceOnUse".into()),
            ("x", short(area.x0)),
            ("y", short(area.y0)),
            ("width", short(area.width())),
            ("height", short(area.height())),
        ]
    }

    /// Whether anything among these parts is warped.
    pub(crate) fn changes(&self, parts: std::ops::Range<usize>) -> bool {
        self.job.outcomes[parts].iter().any(|o| o.done().is_some())
    }

    /// The warped border of a mask's region, where it cuts the content.
    pub(crate) fn mask_edge(&self, i: usize) -> Option<String> {
        let m = &self.job.document.scene().masks[i];
        let inside = m.rect.union(m.content) == m.rect;
        if inside || !self.changes(m.parts.clone()) {
            return None;
        }
        let mut border = pathwarp::outline::Builder::default();
        let r = m.rect;
        border.move_to((r.x0, r.y0).into());
        for p in [(r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)] {
            border.line_to(p.into());
        }
        border.close();
        let border = border.finish().transformed(m.frame).repeated(&self.job.options.copies);
        let warped = refit::warp_path(&border, self.job.map, &self.job.options.refit).ok()?;
        let mut path = warped.path;
        path.apply_affine(warp::written(self.job.document.scene(), self.job.slots, m.slot, m.frame).inverse());
        Some(path_data(&path, MOST_DECIMALS.min(9)))
    }

    /// A reference to a filter: the source's own, or one written here.
    pub(crate) fn filter(&mut self, f: &std::sync::Arc<usvg::filter::Filter>) -> String {
        let source = &self.job.document.source;
        self.notes.add(FILTERS, f.id());
        let own = source.by_id().get(f.id()).is_some_and(|v| v.iter().any(|&e| source.elements[e].tag == "filter"));
        let foreign = self.job.document.scene().foreign.contains(&(std::sync::Arc::as_ptr(f) as usize));
        if self.in_source && own && !foreign && !self.shows_warped(f) {
            return format!("url(#{})", f.id());
        }
        format!("url(#{})", self.filter_id(f))
    }

    /// Whether a filter of the source shows, by `feImage`, what is warped where it stands. The filter moves along with the
    /// group it is applied to, and would move that a second time.
    pub(crate) fn shows_warped(&self, f: &usvg::filter::Filter) -> bool {
        if !f.primitives().iter().any(|p| matches!(p.kind(), usvg::filter::Kind::Image(_))) {
            return false;
        }
        let (scene, source) = (&self.job.document.scene(), &self.job.document.source);
        let inside = |range: &std::ops::Range<usize>, e: usize| range.contains(&source.elements[e].range.start);
        let own = source.by_id().get(f.id()).into_iter().flatten();
        let images = own.flat_map(|&e| {
            let range = &source.elements[e].range;
            (e + 1..source.elements.len()).take_while(move |&c| inside(range, c))
        });
        let shown = images.filter_map(|e| source.by_id().get(&source.href(e)?)).flatten();
        shown.map(|&e| &source.elements[e].range).any(|range| {
            let of = |p: &crate::scene::model::Part| p.owner.or(p.source).is_some_and(|e| inside(range, e));
            scene.parts.iter().zip(self.job.outcomes).any(|(p, o)| o.done().is_some() && of(p))
        })
    }

    /// The id of a filter written here, in user space.
    pub(crate) fn filter_id(&mut self, f: &std::sync::Arc<usvg::filter::Filter>) -> String {
        let key = std::sync::Arc::as_ptr(f) as usize;
        if let Some(id) = self.filters.get(&key) {
            return id.clone();
        }
        let id = self.new_id(f.id());
        self.filters.insert(key, id.clone());
        let text = self.filter_element(f, &format!(" id=\"{}\"", escape(&id)));
        self.define(&text);
        id
    }

    /// How links are written where this stands.
    pub(crate) fn link(&self) -> &'static str {
        if self.in_source && !self.job.document.source.text.contains("xmlns:xlink=") { "href" } else { "xlink:href" }
    }
}
