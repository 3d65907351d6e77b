//! Writes resolved geometry as SVG of our own: fragments that take an element's place, definitions, and whole files.
//!
//! Transforms of groups are kept and the geometry inside is written in its own user space, so that strokes, filters and paint
//! servers see the frame they were made for.

use crate::document::Document;
use crate::number::{escape, matrix, path_data, short};
use crate::options::WarpOptions;
use crate::scene::{Group, Node, Part};
use crate::source::ElementId;
use crate::warp::{self, Done, Notes, Outcome, Placed, Skipped, StrokeDone};
use pathwarp::kurbo::{Affine, BezPath, Rect, Shape as _};
use pathwarp::map::Map;
use pathwarp::refit;
use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;
use usvg::{BlendMode, FillRule, LineCap, LineJoin, Paint, PaintOrder, ShapeRendering, SpreadMethod};

/// Everything a writer needs to know.
#[derive(Clone, Copy)]
pub(crate) struct Job<'a> {
    pub(crate) document: &'a Document,
    pub(crate) outcomes: &'a [Outcome],
    pub(crate) slots: &'a [Placed],
    pub(crate) map: &'a dyn Map,
    pub(crate) options: &'a WarpOptions,
}

/// What is said of filters.
pub(crate) const FILTERS: &str = "filters follow the warp as a whole: their regions and lengths are not bent";

/// Presentation properties in order.
pub(crate) type Properties = Vec<(&'static str, String)>;

pub(crate) struct Writer<'a> {
    pub(crate) job: Job<'a>,
    /// Elements' prefix, mostly "".
    prefix: String,
    /// Whether the result stands in the source, whose definitions can be referred to.
    in_source: bool,
    /// Properties go into style attributes, where style sheets cannot reach them.
    styled: bool,
    /// Definitions written so far.
    pub(crate) defs: String,
    taken: HashSet<String>,
    /// Ids of clip paths and masks by number, once they have one.
    pub(crate) clip_ids: Vec<Option<String>>,
    pub(crate) mask_ids: Vec<Option<String>>,
    servers: HashMap<(usize, [u64; 6]), String>,
    filters: HashMap<usize, String>,
    /// Which properties the source speaks of at all.
    mentioned: RefCell<HashMap<&'static str, bool>>,
    pub(crate) skipped: &'a mut Vec<Skipped>,
    pub(crate) notes: &'a mut Notes,
}

impl<'a> Writer<'a> {
    pub(crate) fn new(job: Job<'a>, in_source: bool, skipped: &'a mut Vec<Skipped>, notes: &'a mut Notes) -> Self {
        let source = &job.document.source;
        let scene = &job.document.scene;
        let taken = if in_source { source.by_id.keys().cloned().collect() } else { HashSet::new() };
        Self {
            job,
            prefix: if in_source { source.prefix().to_owned() } else { String::new() },
            in_source,
            styled: in_source && source.has_css(),
            defs: String::new(),
            taken,
            clip_ids: vec![None; scene.clips.len()],
            mask_ids: vec![None; scene.masks.len()],
            servers: HashMap::new(),
            filters: HashMap::new(),
            mentioned: RefCell::default(),
            skipped,
            notes,
        }
    }

    /// `id` if it is free, else with a number.
    pub(crate) fn new_id(&mut self, id: &str) -> String {
        let mut out = id.to_owned();
        let mut n = 1;
        while !self.taken.insert(out.clone()) {
            n += 1;
            out = format!("{id}-{n}");
        }
        out
    }

    /// Whether an ancestor in the source may have set a property, so that its default must be written out.
    fn may_inherit(&self, name: &'static str) -> bool {
        let look = || self.job.document.source.text.contains(name);
        self.in_source && *self.mentioned.borrow_mut().entry(name).or_insert_with(look)
    }

    pub(crate) fn tag(&self, name: &str) -> String {
        format!("{}{name}", self.prefix)
    }

    pub(crate) fn attributes(&self, properties: &Properties) -> String {
        let mut out = String::new();
        if self.styled {
            if !properties.is_empty() {
                let all: Vec<String> = properties.iter().map(|(n, v)| format!("{n}:{v}")).collect();
                let _ = write!(out, " style=\"{}\"", escape(&all.join(";")));
            }
        } else {
            for (n, v) in properties {
                // These are only understood in a style.
                if matches!(*n, "mix-blend-mode" | "isolation") {
                    let _ = write!(out, " style=\"{n}:{v}\"");
                } else {
                    let _ = write!(out, " {n}=\"{}\"", escape(v));
                }
            }
        }
        out
    }

    pub(crate) fn nodes(&mut self, nodes: &[Node]) -> String {
        nodes.iter().map(|n| self.node(n)).collect()
    }

    pub(crate) fn node(&mut self, n: &Node) -> String {
        match n {
            Node::Group(g) => self.group(g, ""),
            Node::Part(i) => self.part(*i),
            Node::Image(image) => self.image(image),
            Node::Text { element, content } => {
                let id = element.filter(|_| !self.in_source).map_or(String::new(), |e| self.id_attribute(e));
                let inner = self.group(content, "");
                if id.is_empty() { inner } else { format!("<{0}{id}>{inner}</{0}>", self.tag("g")) }
            }
        }
    }

    /// The source's id, for a file that is written anew.
    fn id_attribute(&mut self, e: ElementId) -> String {
        let Some(id) = self.job.document.source.attr(e, "id").filter(|i| !i.is_empty()) else { return String::new() };
        if self.taken.insert(id.to_string()) { format!(" id=\"{}\"", escape(&id)) } else { String::new() }
    }

    /// A group; `extra` attributes make it stay even where it does nothing.
    pub(crate) fn group(&mut self, g: &Group, extra: &str) -> String {
        self.group_with(g, extra, "")
    }

    /// A group with `lead` as the first of its content.
    pub(crate) fn group_with(&mut self, g: &Group, extra: &str, lead: &str) -> String {
        let mut properties = Properties::new();
        if g.opacity < 1.0 {
            properties.push(("opacity", short(f64::from(g.opacity))));
        }
        if let Some(i) = g.clip {
            let id = self.clip_id(i);
            properties.push(("clip-path", format!("url(#{id})")));
        }
        if let Some(i) = g.mask {
            let id = self.mask_id(i);
            properties.push(("mask", format!("url(#{id})")));
        }
        if !g.filters.is_empty() {
            let list: Vec<String> = g.filters.iter().map(|f| self.filter(f)).collect();
            properties.push(("filter", list.join(" ")));
        }
        if g.blend != BlendMode::Normal {
            properties.push(("mix-blend-mode", g.blend.to_string()));
        }
        if g.isolate {
            properties.push(("isolation", "isolate".into()));
        }
        let own = if self.in_source { String::new() } else { g.source.map_or(String::new(), |e| self.id_attribute(e)) };
        let mut head = format!("{own}{extra}");
        let transform = match g.slot.map(|s| (self.job.slots[s].fit, self.job.document.scene.slots[s].before)) {
            Some((fit, true)) => fit * g.transform,
            Some((fit, false)) => g.transform * fit,
            None => g.transform,
        };
        if transform != Affine::IDENTITY {
            let _ = write!(head, " transform=\"{}\"", matrix(transform));
        }
        head.push_str(&self.attributes(&properties));
        let inner = self.nodes(&g.children);
        if head.is_empty() {
            return format!("{lead}{inner}");
        }
        format!("<{0}{head}>{lead}{inner}</{0}>", self.tag("g"))
    }

    fn path(&mut self, d: &str, id: &str, properties: &Properties) -> String {
        format!("<{}{id} d=\"{d}\"{}/>", self.tag("path"), self.attributes(properties))
    }

    /// A part as one path, or as two where the stroke has become an outline.
    pub(crate) fn part(&mut self, i: usize) -> String {
        let job = self.job;
        let p = &job.document.scene.parts[i];
        let done = job.outcomes[i].done();
        let d = part_data(p, done);
        let id = if self.in_source { String::new() } else { p.source.map_or(String::new(), |e| self.id_attribute(e)) };
        let mut properties = self.properties(i);
        let Some(StrokeDone::Outlined(outline)) = done.map(|d| &d.stroke) else {
            return self.path(&d, &id, &properties);
        };
        let (Some(stroke), Some(done)) = (&p.stroke, done) else { return String::new() };
        let o = path_data(outline, done.decimals);
        let mut over = self.shared(p);
        let paint = self.paint(stroke.paint(), p, Some(done));
        over.push(("fill", paint));
        over.push(("fill-opacity", short(f64::from(stroke.opacity().get()))));
        over.push(("fill-rule", "nonzero".into()));
        over.push(("stroke", "none".into()));
        over.retain(|(n, v)| !(*n == "fill-opacity" && v == "1" || *n == "fill-rule") || self.may_inherit(n));
        properties.retain(|p| p.0 == "fill" || !p.0.starts_with("stroke") && p.0 != "paint-order");
        properties.push(("stroke", "none".into()));
        let top = self.path(&o, "", &over);
        if p.fill.is_none() {
            return if id.is_empty() { top } else { self.path(&o, &id, &over) };
        }
        let base = self.path(&d, "", &properties);
        let both =
            if p.paint_order == PaintOrder::StrokeAndFill { format!("{top}{base}") } else { format!("{base}{top}") };
        if id.is_empty() { both } else { format!("<{0}{id}>{both}</{0}>", self.tag("g")) }
    }

    /// What fill and stroke outline have in common.
    fn shared(&self, p: &Part) -> Properties {
        let mut out = Properties::new();
        if !p.visible {
            out.push(("visibility", "hidden".into()));
        } else if self.may_inherit("visibility") {
            out.push(("visibility", "visible".into()));
        }
        match p.rendering {
            ShapeRendering::GeometricPrecision => {
                if self.may_inherit("shape-rendering") {
                    out.push(("shape-rendering", "auto".into()));
                }
            }
            ShapeRendering::OptimizeSpeed => out.push(("shape-rendering", "optimizeSpeed".into())),
            ShapeRendering::CrispEdges => out.push(("shape-rendering", "crispEdges".into())),
        }
        if self.may_inherit("marker") {
            out.extend(["marker-start", "marker-mid", "marker-end"].map(|n| (n, "none".to_owned())));
        }
        out
    }

    /// The presentation of a part, resolved.
    pub(crate) fn properties(&mut self, i: usize) -> Properties {
        let job = self.job;
        let p = &job.document.scene.parts[i];
        let done = job.outcomes[i].done();
        let mut all = self.shared(p);
        match &p.fill {
            None => all.push(("fill", "none".into())),
            Some(f) => {
                let paint = self.paint(f.paint(), p, done);
                all.push(("fill", paint));
                all.push(("fill-opacity", short(f64::from(f.opacity().get()))));
                all.push(("fill-rule", if f.rule() == FillRule::EvenOdd { "evenodd" } else { "nonzero" }.into()));
            }
        }
        match &p.stroke {
            None => all.push(("stroke", "none".into())),
            Some(s) => {
                let paint = self.paint(s.paint(), p, done);
                let scale = stroke_scale(done);
                all.push(("stroke", paint));
                all.push(("stroke-opacity", short(f64::from(s.opacity().get()))));
                all.push(("stroke-width", short(f64::from(s.width().get()) * scale)));
                let cap = match s.linecap() {
                    LineCap::Butt => "butt",
                    LineCap::Round => "round",
                    LineCap::Square => "square",
                };
                all.push(("stroke-linecap", cap.into()));
                let join = match s.linejoin() {
                    LineJoin::Miter => "miter",
                    LineJoin::MiterClip => "miter-clip",
                    LineJoin::Round => "round",
                    LineJoin::Bevel => "bevel",
                };
                all.push(("stroke-linejoin", join.into()));
                all.push(("stroke-miterlimit", short(f64::from(s.miterlimit().get()))));
                all.push(("stroke-dasharray", dashes(s, scale)));
                all.push(("stroke-dashoffset", short(f64::from(s.dashoffset()) * scale)));
            }
        }
        let order = match p.paint_order {
            PaintOrder::FillAndStroke => "normal",
            PaintOrder::StrokeAndFill => "stroke",
        };
        all.push(("paint-order", order.into()));
        all.retain(|(name, value)| {
            let default = match *name {
                "fill-opacity" | "stroke-opacity" | "stroke-width" => "1",
                "fill-rule" => "nonzero",
                "stroke" | "stroke-dasharray" => "none",
                "stroke-linecap" => "butt",
                "stroke-linejoin" => "miter",
                "stroke-miterlimit" => "4",
                "stroke-dashoffset" => "0",
                "paint-order" => "normal",
                _ => return true,
            };
            value != default || self.may_inherit(name)
        });
        all
    }

    /// A paint as CSS says it.
    pub(crate) fn paint(&mut self, paint: &Paint, p: &Part, done: Option<&Done>) -> String {
        let fit = done.and_then(|d| d.fit).filter(|f| p.local.bounding_box().is_none_or(|b| !f.is_identity(b)));
        let fit = fit.map_or(Affine::IDENTITY, |f| f.affine);
        match paint {
            Paint::Color(c) => format!("#{:02x}{:02x}{:02x}", c.red, c.green, c.blue),
            Paint::LinearGradient(g) => {
                let place = format!(
                    "x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"",
                    short(g.x1().into()),
                    short(g.y1().into()),
                    short(g.x2().into()),
                    short(g.y2().into())
                );
                self.gradient("linearGradient", g, std::sync::Arc::as_ptr(g) as usize, &place, fit)
            }
            Paint::RadialGradient(g) => {
                let mut place = format!(
                    "cx=\"{}\" cy=\"{}\" r=\"{}\" fx=\"{}\" fy=\"{}\"",
                    short(g.cx().into()),
                    short(g.cy().into()),
                    short(g.r().get().into()),
                    short(g.fx().into()),
                    short(g.fy().into())
                );
                if g.fr().get() > 0.0 {
                    let _ = write!(place, " fr=\"{}\"", short(g.fr().get().into()));
                }
                self.gradient("radialGradient", g, std::sync::Arc::as_ptr(g) as usize, &place, fit)
            }
            Paint::Pattern(pattern) => self.pattern(pattern, fit),
        }
    }

    fn gradient(&mut self, tag: &str, g: &usvg::BaseGradient, key: usize, place: &str, fit: Affine) -> String {
        let key = (key, fit.as_coeffs().map(f64::to_bits));
        if let Some(id) = self.servers.get(&key) {
            return format!("url(#{id})");
        }
        let id = self.new_id(g.id());
        let mut out = format!("<{} id=\"{}\" gradientUnits=\"userSpaceOnUse\" {place}", self.tag(tag), escape(&id));
        let t = fit * crate::geometry::affine(g.transform());
        if t != Affine::IDENTITY {
            let _ = write!(out, " gradientTransform=\"{}\"", matrix(t));
        }
        match g.spread_method() {
            SpreadMethod::Pad => {}
            SpreadMethod::Reflect => out.push_str(" spreadMethod=\"reflect\""),
            SpreadMethod::Repeat => out.push_str(" spreadMethod=\"repeat\""),
        }
        let source = &self.job.document.source;
        let gradient = |e: ElementId| source.elements[e].tag.ends_with("Gradient");
        let own = source.by_id.get(g.id()).is_some_and(|v| v.len() == 1 && gradient(v[0]));
        if self.in_source && own {
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

    fn pattern(&mut self, pattern: &std::sync::Arc<usvg::Pattern>, fit: Affine) -> String {
        let key = (std::sync::Arc::as_ptr(pattern) as usize, fit.as_coeffs().map(f64::to_bits));
        if let Some(id) = self.servers.get(&key) {
            return format!("url(#{id})");
        }
        let scene = &self.job.document.scene;
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
        let t = fit * crate::geometry::affine(pattern.transform());
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
        let id = self.new_id(&self.job.document.scene.clips[i].id.clone());
        self.clip_ids[i] = Some(id.clone());
        let text = self.clip(i, &format!(" id=\"{}\"", escape(&id)));
        self.define(&text);
        id
    }

    /// A clip path, all transforms on its paths, as it must not hold groups.
    pub(crate) fn clip(&mut self, i: usize, head: &str) -> String {
        let scene = &self.job.document.scene;
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
                    let p = &job.document.scene.parts[*i];
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
                    let transform =
                        if t == Affine::IDENTITY { String::new() } else { format!(" transform=\"{}\"", matrix(t)) };
                    let d = part_data(p, job.outcomes[*i].done());
                    out.push_str(&self.path(&d, &transform, &properties));
                }
            }
        }
    }

    /// A mask's id; it is written when first asked for.
    pub(crate) fn mask_id(&mut self, i: usize) -> String {
        if let Some(id) = &self.mask_ids[i] {
            return id.clone();
        }
        let id = self.new_id(&self.job.document.scene.masks[i].id.clone());
        self.mask_ids[i] = Some(id.clone());
        let text = self.mask(i, &format!(" id=\"{}\"", escape(&id)));
        self.define(&text);
        id
    }

    pub(crate) fn mask(&mut self, i: usize, head: &str) -> String {
        let scene = &self.job.document.scene;
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
        let scene = &self.job.document.scene;
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
                        part_path(p, done).bounding_box().inflate(reach, reach)
                    }
                    (None, _) => part_path(p, done).bounding_box(),
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
        let m = &self.job.document.scene.masks[i];
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
        let border = border.finish().transformed(m.frame);
        let warped = refit::warp_path(&border, self.job.map, &self.job.options.refit).ok()?;
        let mut path = warped.path;
        path.apply_affine(warp::written(&self.job.document.scene, self.job.slots, m.slot, m.frame).inverse());
        Some(path_data(&path, crate::number::MOST_DECIMALS.min(9)))
    }

    /// A reference to a filter: the source's own, or one written here.
    fn filter(&mut self, f: &std::sync::Arc<usvg::filter::Filter>) -> String {
        let source = &self.job.document.source;
        self.notes.add(FILTERS, f.id());
        let own = source.by_id.get(f.id()).is_some_and(|v| v.iter().any(|&e| source.elements[e].tag == "filter"));
        if self.in_source && own {
            return format!("url(#{})", f.id());
        }
        format!("url(#{})", self.filter_id(f))
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

    fn image(&mut self, image: &usvg::Image) -> String {
        self.notes.add("images in copies follow the warp as a whole, they are not bent", "");
        if !image.is_visible() {
            return String::new();
        }
        let (kind, data) = match image.kind() {
            usvg::ImageKind::JPEG(d) => ("image/jpeg", d.clone()),
            usvg::ImageKind::PNG(d) => ("image/png", d.clone()),
            usvg::ImageKind::GIF(d) => ("image/gif", d.clone()),
            usvg::ImageKind::WEBP(d) => ("image/webp", d.clone()),
            usvg::ImageKind::SVG(t) => {
                let text = t.to_string(&usvg::WriteOptions::default());
                ("image/svg+xml", std::sync::Arc::new(text.into_bytes()))
            }
        };
        let mut properties = Properties::new();
        match image.rendering_mode() {
            usvg::ImageRendering::OptimizeQuality => {}
            usvg::ImageRendering::OptimizeSpeed => properties.push(("image-rendering", "optimizeSpeed".into())),
            usvg::ImageRendering::Smooth => properties.push(("image-rendering", "smooth".into())),
            usvg::ImageRendering::HighQuality => properties.push(("image-rendering", "high-quality".into())),
            usvg::ImageRendering::CrispEdges => properties.push(("image-rendering", "crisp-edges".into())),
            usvg::ImageRendering::Pixelated => properties.push(("image-rendering", "pixelated".into())),
        }
        let style = properties.iter().map(|(n, v)| format!(" style=\"{n}:{v}\"")).collect::<String>();
        let link = self.link();
        format!(
            "<{} width=\"{}\" height=\"{}\"{style} {link}=\"data:{kind};base64,{}\"/>",
            self.tag("image"),
            short(image.size().width().into()),
            short(image.size().height().into()),
            base64(&data)
        )
    }
}

/// A part's path in its own user space.
fn part_path(p: &Part, done: Option<&Done>) -> BezPath {
    /// Fine against any stroke or pixel, for parts that are written but not warped.
    const FINE: f64 = 1e-4;
    match done {
        Some(d) => d.path.clone(),
        None => {
            let size = p.local.bounding_box().map_or(1.0, |b| b.width().max(b.height()));
            p.local.to_bez_path((size * FINE).max(1e-12))
        }
    }
}

pub(crate) fn part_data(p: &Part, done: Option<&Done>) -> String {
    /// f32's digits and some more.
    const DIGITS: i32 = 10;
    match done {
        Some(d) => path_data(&d.path, d.decimals),
        None => {
            let path = part_path(p, None);
            let b = path.bounding_box();
            let size = b.x0.abs().max(b.x1.abs()).max(b.y0.abs()).max(b.y1.abs());
            let decimals = if size > 0.0 { DIGITS - size.log10().ceil() as i32 } else { DIGITS };
            path_data(&path, decimals.clamp(0, 14) as u8)
        }
    }
}

pub(crate) fn stroke_scale(done: Option<&Done>) -> f64 {
    match done.map(|d| &d.stroke) {
        Some(StrokeDone::Scaled(s)) => *s,
        _ => 1.0,
    }
}

/// `stroke-dasharray`.
pub(crate) fn dashes(s: &usvg::Stroke, scale: f64) -> String {
    s.dasharray()
        .map_or("none".into(), |list| list.iter().map(|d| short(f64::from(*d) * scale)).collect::<Vec<_>>().join(","))
}

fn base64(data: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(data.len().div_ceil(3) * 4);
    for chunk in data.chunks(3) {
        let n = chunk.iter().fold(0_u32, |n, b| n << 8 | u32::from(*b)) << (8 * (3 - chunk.len()));
        for i in 0..4 {
            let letter = LETTERS[(n >> (18 - 6 * i) & 63) as usize];
            out.push(if i <= chunk.len() { char::from(letter) } else { '=' });
        }
    }
    out
}

/// The whole file written anew.
pub(crate) fn flat(job: &Job<'_>, skipped: &mut Vec<Skipped>, notes: &mut Notes) -> String {
    let source = &job.document.source;
    let mut w = Writer::new(*job, false, skipped, notes);
    let mut out =
        String::from("<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\"");
    for name in ["id", "class", "width", "height", "viewBox", "preserveAspectRatio"] {
        if let Some(v) = source.attr(0, name) {
            let _ = write!(out, " {name}=\"{}\"", escape(&v));
            if name == "id" {
                w.taken.insert(v.into_owned());
            }
        }
    }
    out.push_str(">\n");
    if let Some(t) = source.elements.first().and_then(|e| e.title.as_ref()) {
        let _ = writeln!(out, "<title>{}</title>", escape(t));
    }
    let body: String = job.document.scene.root.children.iter().map(|n| format!("{}\n", w.node(n))).collect();
    if !w.defs.is_empty() {
        let _ = write!(out, "<defs>\n{}</defs>\n", w.defs);
    }
    out.push_str(&body);
    out.push_str("</svg>\n");
    out
}
