//! Writes resolved geometry as SVG of our own: fragments that take an element's place, definitions, and whole files.
//!
//! Transforms of groups are kept and the geometry inside is written in its own user space, so that strokes, filters and paint
//! servers see the frame they were made for.

use crate::bend::image::{BentImage, Picture};
use crate::bend::options::WarpOptions;
use crate::bend::paint::Fit;
use crate::bend::part::{Done, Notes, Outcome, Placed, Skipped, StrokeDone};
use crate::document::Document;
use crate::scene::model::{Group, Node, Part};
use crate::source::number::{escape, matrix, outline_data, path_data, short};
use crate::source::text::{ElementId, Source};
use pathwarp::kurbo::{Affine, Rect, Shape as _};
use pathwarp::map::Map;
use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::fmt::Write as _;
use std::ops::Range;
use usvg::{BlendMode, FillRule, LineCap, LineJoin, Paint, PaintOrder, ShapeRendering};

/// Everything a writer needs to know.
#[derive(Clone, Copy)]
pub(crate) struct Job<'a> {
    pub(crate) document: &'a Document,
    pub(crate) outcomes: &'a [Outcome],
    pub(crate) pictures: &'a [Picture],
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
    pub(crate) in_source: bool,
    /// Properties go into style attributes, where style sheets cannot reach them.
    pub(crate) styled: bool,
    /// Definitions written so far.
    pub(crate) defs: String,
    pub(crate) taken: HashSet<String>,
    /// Ids of clip paths and masks by number, once they have one.
    pub(crate) clip_ids: Vec<Option<String>>,
    pub(crate) mask_ids: Vec<Option<String>>,
    pub(crate) servers: HashMap<(usize, [u64; 6]), String>,
    pub(crate) filters: HashMap<usize, String>,
    /// The place of the source's element that is being replaced, and the elements in it whose ids have been written.
    pub(crate) replaced: Option<(Range<usize>, BTreeSet<ElementId>)>,
    /// Which properties the source speaks of at all.
    mentioned: RefCell<HashMap<&'static str, bool>>,
    pub(crate) skipped: &'a mut Vec<Skipped>,
    pub(crate) notes: &'a mut Notes,
}

impl<'a> Writer<'a> {
    pub(crate) fn new(job: Job<'a>, in_source: bool, skipped: &'a mut Vec<Skipped>, notes: &'a mut Notes) -> Self {
        let source = &job.document.source;
        let scene = &job.document.scene();
        let taken = if in_source { source.by_id().keys().cloned().collect() } else { HashSet::new() };
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
            replaced: None,
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
    pub(crate) fn may_inherit(&self, name: &'static str) -> bool {
        let look = || self.job.document.source.text.contains(name);
        self.in_source && *self.mentioned.borrow_mut().entry(name).or_insert_with(look)
    }

    pub(crate) fn tag(&self, name: &str) -> String {
        format!("{}{name}", self.prefix)
    }

    pub(crate) fn attributes(&self, properties: &Properties) -> String {
        let mut out = String::new();
        self.push_attributes(properties, &mut out);
        out
    }

    fn push_attributes(&self, properties: &Properties, out: &mut String) {
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
                    push_all(out, [" ", n, "=\"", &escape(v), "\""]);
                }
            }
        }
    }

    fn push_nodes(&mut self, nodes: &[Node], out: &mut String) {
        for n in nodes {
            let one = self.node(n);
            if out.is_empty() {
                *out = one;
            } else {
                out.push_str(&one);
            }
        }
    }

    pub(crate) fn node(&mut self, n: &Node) -> String {
        match n {
            Node::Group(g) => self.group(g, ""),
            Node::Part(i) => self.part(*i),
            Node::Image(i) => self.image(*i),
            Node::Text { element, content, .. } => {
                let id = element.map_or(String::new(), |e| self.id_attribute(e));
                let inner = self.group(content, "");
                if id.is_empty() { inner } else { format!("<{0}{id}>{inner}</{0}>", self.tag("g")) }
            }
        }
    }

    /// The source's id, for what takes the element's place.
    pub(crate) fn id_attribute(&mut self, e: ElementId) -> String {
        let source = &self.job.document.source;
        let Some(id) = source.attr(e, "id").filter(|i| !i.is_empty()) else { return String::new() };
        let free = match &mut self.replaced {
            Some((range, named)) => range.contains(&source.elements[e].range.start) && named.insert(e),
            None => !self.in_source && self.taken.insert(id.to_string()),
        };
        if free { format!(" id=\"{}\"", escape(&id)) } else { String::new() }
    }

    /// A group; `extra` attributes make it stay even where it does nothing.
    pub(crate) fn group(&mut self, g: &Group, extra: &str) -> String {
        self.group_with(g, extra, "")
    }

    /// A group with `lead` as the first of its content.
    pub(crate) fn group_with(&mut self, g: &Group, extra: &str, lead: &str) -> String {
        let head = self.head(g, extra);
        let mut inner = lead.to_owned();
        self.push_nodes(&g.children, &mut inner);
        self.wrapped(g, &head, inner)
    }

    /// What a group does, around content that is written already.
    pub(crate) fn group_around(&mut self, g: &Group, content: &str) -> String {
        let head = self.head(g, "");
        self.wrapped(g, &head, content.to_owned())
    }

    fn wrapped(&self, g: &Group, head: &str, content: String) -> String {
        if head.is_empty() {
            return content;
        }
        let tag = if self.link_of(g).is_empty() { "g" } else { "a" };
        let mut out = String::with_capacity(head.len() + content.len() + 2 * (self.prefix.len() + "<g></".len()));
        push_all(&mut out, ["<", &self.prefix, tag, head, ">", &content, "</", &self.prefix, tag, ">"]);
        out
    }

    /// A group's attributes.
    fn head(&mut self, g: &Group, extra: &str) -> String {
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
        let own = g.source.map_or(String::new(), |e| self.id_attribute(e));
        let mut head = format!("{own}{extra}");
        let transform = match g.slot.map(|s| (self.job.slots[s].fit, self.job.document.scene().slots[s].before)) {
            Some((fit, true)) => fit * g.transform,
            Some((fit, false)) => g.transform * fit,
            None => g.transform,
        };
        if transform != Affine::IDENTITY {
            let _ = write!(head, " transform=\"{}\"", matrix(transform));
        }
        head.push_str(&self.attributes(&properties));
        head.push_str(&self.link_of(g));
        head
    }

    /// Where a group leads to that was a link, for a file that is written anew.
    fn link_of(&self, g: &Group) -> String {
        let source = &self.job.document.source;
        let link = g.source.filter(|&e| !self.in_source && source.elements[e].tag == "a").and_then(|e| source.link(e));
        link.map_or(String::new(), |to| format!(" {}=\"{}\"", self.link(), escape(&to)))
    }

    pub(crate) fn path(&mut self, d: &str, id: &str, properties: &Properties) -> String {
        /// As long as the attributes mostly are.
        const USUAL: usize = 64;
        let mut out = String::with_capacity(d.len() + id.len() + USUAL);
        push_all(&mut out, ["<", &self.prefix, "path", id, " d=\"", d, "\""]);
        self.push_attributes(properties, &mut out);
        out.push_str("/>");
        out
    }

    /// A part as one path, or as two where the stroke has become an outline.
    pub(crate) fn part(&mut self, i: usize) -> String {
        let job = self.job;
        let p = &job.document.scene().parts[i];
        let done = job.outcomes[i].done();
        let d = part_data(p, done, &job.document.source);
        let id = p.source.map_or(String::new(), |e| self.id_attribute(e));
        if let Some(done) = done.filter(|_| self.pieced(i)) {
            let both = self.pieces(i, done, &d);
            return if id.is_empty() { both } else { format!("<{0}{id}>{both}</{0}>", self.tag("g")) };
        }
        let mut properties = self.properties(i);
        let outlined = match (done.map(|d| &d.stroke), &p.stroke) {
            (Some(StrokeDone::Outlined(o)), Some(s)) => Some((o, s)),
            _ => None,
        };
        let area = done.and_then(|d| d.fill.as_ref());
        let Some(done) = done.filter(|_| outlined.is_some() || area.is_some()) else {
            return self.path(&d, &id, &properties);
        };
        let (top, over) = match outlined {
            Some((outline, stroke)) => (path_data(outline, done.decimals), self.outlined(p, stroke, done)),
            None => {
                let mut over = properties.clone();
                over.retain(|p| !p.0.starts_with("fill"));
                over.push(("fill", "none".into()));
                (d.clone(), over)
            }
        };
        if p.fill.is_none() || area.is_some_and(|a| a.elements().is_empty()) {
            return self.path(&top, &id, &over);
        }
        let top = self.path(&top, "", &over);
        properties.retain(|p| p.0 == "fill" || !p.0.starts_with("stroke") && p.0 != "paint-order");
        properties.push(("stroke", "none".into()));
        let base = self.path(&area.map_or(d, |a| path_data(a, done.decimals)), "", &properties);
        let both =
            if p.paint_order == PaintOrder::StrokeAndFill { format!("{top}{base}") } else { format!("{base}{top}") };
        if id.is_empty() { both } else { format!("<{0}{id}>{both}</{0}>", self.tag("g")) }
    }

    /// The presentation of a stroke's outline.
    pub(crate) fn outlined(&mut self, p: &Part, stroke: &usvg::Stroke, done: &Done) -> Properties {
        let mut over = self.shared(p);
        let paint = self.paint(stroke.paint(), p, Some(done));
        over.push(("fill", paint));
        over.push(("fill-opacity", short(f64::from(stroke.opacity().get()))));
        over.push(("fill-rule", "nonzero".into()));
        over.push(("stroke", "none".into()));
        over.retain(|(n, v)| !(*n == "fill-opacity" && v == "1" || *n == "fill-rule") || self.may_inherit(n));
        over
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
        self.properties_of(i, true, true)
    }

    /// The presentation of a part's fill, its stroke, or both.
    pub(crate) fn properties_of(&mut self, i: usize, fill: bool, stroke: bool) -> Properties {
        let job = self.job;
        let p = &job.document.scene().parts[i];
        let done = job.outcomes[i].done();
        let mut all = self.shared(p);
        match p.fill.as_ref().filter(|_| fill) {
            None => all.push(("fill", "none".into())),
            Some(f) => {
                let paint = self.paint(f.paint(), p, done);
                all.push(("fill", paint));
                all.push(("fill-opacity", short(f64::from(f.opacity().get()))));
                all.push(("fill-rule", if f.rule() == FillRule::EvenOdd { "evenodd" } else { "nonzero" }.into()));
            }
        }
        match p.stroke.as_ref().filter(|_| stroke) {
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
        if p.fixed_width && stroke && p.stroke.is_some() {
            all.push(("vector-effect", "non-scaling-stroke".into()));
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

    /// How a paint server follows the map, unless it stays.
    pub(crate) fn fit(&self, paint: &Paint, p: &Part, done: Option<&Done>) -> Option<Fit> {
        let fit = done.and_then(|d| d.fit).filter(|_| self.job.options.moves(paint));
        fit.filter(|f| p.local.bounding_box().is_none_or(|b| !f.is_identity(b)))
    }

    /// A paint as CSS says it.
    pub(crate) fn paint(&mut self, paint: &Paint, p: &Part, done: Option<&Done>) -> String {
        let fit = self.fit(paint, p, done).map_or(Affine::IDENTITY, |f| f.affine);
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

    /// A bent bitmap as an element.
    pub(crate) fn bent(&self, bent: &BentImage, to: Affine) -> String {
        let mut all = bent_attributes(bent, to).to_vec();
        all.push((self.link(), data_uri(bent)));
        let all: String = all.iter().map(|(n, v)| format!(" {n}=\"{v}\"")).collect();
        format!("<{}{all}/>", self.tag("image"))
    }

    fn image(&mut self, i: usize) -> String {
        let bitmap = &self.job.document.scene().bitmaps[i];
        let image = &bitmap.image;
        if !image.is_visible() {
            return String::new();
        }
        match &self.job.pictures[i] {
            Picture::Placed => {}
            Picture::Nearly(why) => {
                let id = bitmap.owner.map_or_else(|| "an image".into(), |e| self.job.document.source.display_name(e));
                self.skipped.push(Skipped { id, why: why.clone() });
            }
            Picture::Bent(bent) => {
                // Back into the group's own coordinates, the bitmap's pixels: the placing has no turn in it.
                return self.bent(bent, bitmap.placing.inverse());
            }
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

/// Where a bent bitmap goes, as attributes of its element.
pub(crate) fn bent_attributes(bent: &BentImage, to: Affine) -> [(&'static str, String); 5] {
    let r = to.transform_rect_bbox(bent.area);
    [
        ("x", short(r.x0)),
        ("y", short(r.y0)),
        ("width", short(r.width())),
        ("height", short(r.height())),
        ("preserveAspectRatio", "none".into()),
    ]
}

/// A bent bitmap as a link.
pub(crate) fn data_uri(bent: &BentImage) -> String {
    format!("data:image/png;base64,{}", base64(&bent.png))
}

/// The box around a part's path in its own user space.
pub(crate) fn part_box(p: &Part, done: Option<&Done>) -> Rect {
    match done {
        Some(d) => d.fill.iter().fold(d.path.bounding_box(), |b, f| b.union(f.bounding_box())),
        None => p.local.bounding_box().unwrap_or_default(),
    }
}

/// A part's path data; what is not warped in the source's own words, as far as it has any.
pub(crate) fn part_data(p: &Part, done: Option<&Done>, source: &Source) -> String {
    let own = |e| source.attr(e, "d").filter(|_| source.elements[e].tag == "path");
    match (done, p.drawn.and_then(own)) {
        (Some(d), _) => path_data(&d.path, d.decimals),
        (None, Some(d)) => escape(&d),
        (None, None) => outline_data(&p.local),
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

fn push_all<const N: usize>(out: &mut String, parts: [&str; N]) {
    for p in parts {
        out.push_str(p);
    }
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
    if source.animated {
        w.notes.add("animations are dropped where the file is written anew", "");
    }
    let mut out =
        String::from("<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\"");
    let page = job.page().unwrap_or_default();
    for name in ["id", "class", "width", "height", "viewBox", "preserveAspectRatio"] {
        let new = page.iter().find(|p| p.0 == name).map(|p| Cow::Borrowed(p.1.as_str()));
        if let Some(v) = new.or_else(|| source.attr(0, name)) {
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
    let mut body = String::new();
    for n in &job.document.scene().root.children {
        body.push_str(&w.node(n));
        body.push('\n');
    }
    if !w.defs.is_empty() {
        let _ = write!(out, "<defs>\n{}</defs>\n", w.defs);
    }
    out.push_str(&body);
    out.push_str("</svg>\n");
    out
}
