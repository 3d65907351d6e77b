//! Gradients as definitions, transformed by the affine fit of the map.

use super::defs::{Definitions, server_key};
use super::input::WriteInput;
use super::markup::Markup;
use super::values::color;
use crate::scene::affine::affine;
use crate::source::number::{matrix, short};
use crate::source::text::SourceText;
use pathwarp::kurbo::Affine;
use pathwarp_reader::xml::escape;
use std::fmt::Write as _;
use std::sync::Arc;
use usvg::{LinearGradient, RadialGradient, SpreadMethod};

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
