//! Definitions written so far, with their ids.

use super::input::WriteInput;
use super::markup::{Markup, color};
use crate::scene::areas;
use crate::scene::geometry::affine;
use crate::scene::model::Scene;
use crate::source::elements::ElementId;
use crate::source::number::{matrix, short};
use crate::source::text::SourceText;
use pathwarp::kurbo::{Affine, Rect};
use pathwarp_reader::xml::escape;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::fmt::Write as _;
use std::ops::Range;
use std::sync::Arc;
use usvg::filter::Filter;
use usvg::{LinearGradient, Pattern, RadialGradient, SpreadMethod};

/// Key of a gradient or pattern: its address and the fit applied to it.
type ServerKey = (usize, [u64; 6]);

/// Key of a filter: its address and its region.
type FilterKey = (usize, [u64; 4]);

/// Definitions written so far. Each is written once, when it is first referred to.
pub(super) struct Definitions {
    /// Text of the definitions.
    pub(super) text: String,
    /// Ids in use.
    pub(super) taken: HashSet<String>,
    /// The last numbers appended to ids, by id.
    numbers: HashMap<String, usize>,
    /// Ids of clip paths and masks by index, once they have one.
    pub(super) clip_ids: Vec<Option<String>>,
    pub(super) mask_ids: Vec<Option<String>>,
    /// Ids of gradients and patterns.
    pub(super) servers: HashMap<ServerKey, String>,
    /// Ids of filters.
    pub(super) filters: HashMap<FilterKey, String>,
    /// Regions of the source's filters, by their ids, that are to grow.
    pub(super) regions: BTreeMap<String, Rect>,
    /// Definitions are added to the source.
    in_source: bool,
    /// The element of the source that is being replaced.
    pub(super) replaced: Option<Replaced>,
}

/// An element of the source that is being replaced, so that its ids become free.
pub(super) struct Replaced {
    range: Range<usize>,
    /// Elements inside whose ids have been written.
    named: BTreeSet<ElementId>,
}

impl Replaced {
    pub(super) fn new(range: Range<usize>) -> Self {
        Self { range, named: BTreeSet::new() }
    }
}

impl Definitions {
    pub(super) fn new(source: &SourceText, scene: &Scene, in_source: bool) -> Self {
        Self {
            text: String::new(),
            taken: if in_source { source.by_id().keys().cloned().collect() } else { HashSet::new() },
            numbers: HashMap::new(),
            clip_ids: vec![None; scene.clips.len()],
            mask_ids: vec![None; scene.masks.len()],
            servers: HashMap::new(),
            filters: HashMap::new(),
            regions: BTreeMap::new(),
            in_source,
            replaced: None,
        }
    }

    /// Returns `id` if it is free, else with a number appended.
    pub(super) fn new_id(&mut self, id: &str) -> String {
        if self.taken.insert(id.to_owned()) {
            return id.to_owned();
        }
        // An id is never free again, so the search goes on where the last one ended.
        let n = self.numbers.entry(id.to_owned()).or_insert(1);
        loop {
            *n += 1;
            let numbered = format!("{id}-{n}");
            if self.taken.insert(numbered.clone()) {
                return numbered;
            }
        }
    }

    /// The id of a source element as an attribute, for the element that takes its place; empty if the id is not free.
    pub(super) fn id_attribute(&mut self, source: &SourceText, e: ElementId) -> String {
        let Some(id) = source.attr(e, "id").filter(|i| !i.is_empty()) else { return String::new() };
        let free = match &mut self.replaced {
            Some(r) => r.range.contains(&source.elements[e].range.start) && r.named.insert(e),
            None => !self.in_source && self.taken.insert(id.to_string()),
        };
        if free { format!(" id=\"{}\"", escape(&id)) } else { String::new() }
    }

    /// Lets the region of a filter of the source grow to hold `region`.
    pub(super) fn grow(&mut self, f: &Filter, region: Rect) {
        let own = areas::rect(f.rect());
        if region != own {
            let all = self.regions.entry(f.id().to_owned()).or_insert(own);
            *all = all.union(region);
        }
    }

    pub(super) fn push(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push('\n');
    }
}

pub(super) fn filter_key(f: &Arc<Filter>, region: Rect) -> FilterKey {
    (Arc::as_ptr(f) as usize, [region.x0, region.y0, region.x1, region.y1].map(f64::to_bits))
}

pub(super) fn server_key(address: usize, fit: Affine) -> ServerKey {
    (address, fit.as_coeffs().map(f64::to_bits))
}

/// A gradient of either kind.
struct GradientElement<'g> {
    tag: &'static str,
    base: &'g usvg::BaseGradient,
    address: usize,
    /// Attributes of the geometry.
    geometry: String,
}

/// Refers to a linear gradient, writing it if necessary.
pub(super) fn linear(
    input: &WriteInput<'_>,
    markup: &Markup<'_>,
    defs: &mut Definitions,
    g: &Arc<LinearGradient>,
    fit: Affine,
) -> String {
    let geometry = format!(
        "x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"",
        short(g.x1().into()),
        short(g.y1().into()),
        short(g.x2().into()),
        short(g.y2().into())
    );
    let element = GradientElement { tag: "linearGradient", base: g, address: Arc::as_ptr(g) as usize, geometry };
    element.reference(input, markup, defs, fit)
}

/// Refers to a radial gradient, writing it if necessary.
pub(super) fn radial(
    input: &WriteInput<'_>,
    markup: &Markup<'_>,
    defs: &mut Definitions,
    g: &Arc<RadialGradient>,
    fit: Affine,
) -> String {
    let mut geometry = format!(
        "cx=\"{}\" cy=\"{}\" r=\"{}\" fx=\"{}\" fy=\"{}\"",
        short(g.cx().into()),
        short(g.cy().into()),
        short(g.r().get().into()),
        short(g.fx().into()),
        short(g.fy().into())
    );
    if g.fr().get() > 0.0 {
        let _ = write!(geometry, " fr=\"{}\"", short(g.fr().get().into()));
    }
    let element = GradientElement { tag: "radialGradient", base: g, address: Arc::as_ptr(g) as usize, geometry };
    element.reference(input, markup, defs, fit)
}

impl GradientElement<'_> {
    fn reference(&self, input: &WriteInput<'_>, markup: &Markup<'_>, defs: &mut Definitions, fit: Affine) -> String {
        let g = self.base;
        let key = server_key(self.address, fit);
        if let Some(id) = defs.servers.get(&key) {
            return format!("url(#{id})");
        }
        let id = defs.new_id(g.id());
        let tag = markup.tag(self.tag);
        let mut out = format!("<{tag} id=\"{}\" gradientUnits=\"userSpaceOnUse\" {}", escape(&id), self.geometry);
        let t = fit * affine(g.transform());
        if t != Affine::IDENTITY {
            let _ = write!(out, " gradientTransform=\"{}\"", matrix(t));
        }
        match g.spread_method() {
            SpreadMethod::Pad => {}
            SpreadMethod::Reflect => out.push_str(" spreadMethod=\"reflect\""),
            SpreadMethod::Repeat => out.push_str(" spreadMethod=\"repeat\""),
        }
        let foreign = input.scene.foreign.contains(&self.address);
        if markup.in_source && has_usable_stops(input.source, g.id()) && !foreign {
            // Share the stops of the original.
            let _ = write!(out, " {}=\"#{}\"/>", markup.link(), escape(g.id()));
        } else {
            out.push('>');
            push_stops(markup, g, &mut out);
            let _ = write!(out, "</{tag}>");
        }
        defs.push(&out);
        defs.servers.insert(key, id.clone());
        format!("url(#{id})")
    }
}

fn push_stops(markup: &Markup<'_>, g: &usvg::BaseGradient, out: &mut String) {
    for s in g.stops() {
        let mut properties = vec![("stop-color", color(s.color()))];
        if s.opacity().get() < 1.0 || markup.styled {
            properties.push(("stop-opacity", short(s.opacity().get().into())));
        }
        let offset = short(s.offset().get().into());
        let _ = write!(out, "<{} offset=\"{offset}\"{}/>", markup.tag("stop"), markup.attributes(&properties));
    }
}

/// Returns `true` if another gradient can take its stops from the source's gradient `id`: the id is unique, and the chain of
/// links ends.
fn has_usable_stops(source: &SourceText, id: &str) -> bool {
    /// Longest chain of links followed.
    const LONGEST: usize = 16;
    let mut next = Some(id.to_owned());
    for _ in 0..LONGEST {
        let Some(id) = next else { return true };
        match source.by_id().get(&id).map(Vec::as_slice) {
            Some(&[e]) if source.elements[e].tag.ends_with("Gradient") => next = source.href(e),
            _ => return false,
        }
    }
    // The links may form a cycle, which renderers may follow forever.
    false
}

/// Writes the attributes of a pattern.
pub(super) fn head(pattern: &Pattern, id: &str, fit: Affine) -> String {
    let r = pattern.rect();
    let mut out = format!(
        " id=\"{}\" patternUnits=\"userSpaceOnUse\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"",
        escape(id),
        short(r.x().into()),
        short(r.y().into()),
        short(r.width().into()),
        short(r.height().into())
    );
    let t = fit * affine(pattern.transform());
    if t != Affine::IDENTITY {
        let _ = write!(out, " patternTransform=\"{}\"", matrix(t));
    }
    out
}
