//! What usvg 0.49 (<https://github.com/linebender/resvg/tree/v0.49.0/crates/usvg>) takes more time for than the drawing has, counted before
//! it is asked. Whatever a later version does in proportion to the drawing can be deleted here, with its call in `check.rs`.

use super::unfold;
use memchr::{memchr2, memmem};
use pathwarp::budget::{Budget, Exceeded, cost};
use pathwarp::{Outline, Seg};
use pathwarp_reader::LARGEST;
use std::collections::HashMap;
use usvg::roxmltree;

/// Counts the segments along which texts are laid out: each text measures its whole path.
pub(super) fn text_paths(xml: &roxmltree::Document<'_>, budget: &Budget) -> Result<(), Exceeded> {
    /// Fewest bytes of path data for a curve, whose length takes the time. A line takes less in fewer bytes.
    const CURVE: usize = 12;
    let links = || xml.descendants().filter(|n| n.tag_name().name() == "textPath").filter_map(href);
    if links().next().is_none() {
        return Ok(());
    }
    let data = |n: roxmltree::Node<'_, '_>| Some((n.attribute("id")?.to_owned(), n.attribute("d")?.len()));
    let lengths: HashMap<String, usize> = xml.descendants().filter_map(data).collect();
    links().try_for_each(|id| {
        let segments = lengths.get(id).map_or(0, |length| length / CURVE);
        budget.spend(cost::SEGMENT * segments as f64)
    })
}

/// The id that a link leads to.
fn href<'a>(n: roxmltree::Node<'a, '_>) -> Option<&'a str> {
    let link = n.attributes().find(|a| a.name() == "href")?.value();
    link.trim().strip_prefix('#')
}

/// Counts what arcs become whose ellipses are much wider than any page, such as those with one small radius that have to be enlarged to
/// reach their ends. usvg turns an arc into cubics whose number grows with the radius, and the time with its square.
pub(super) fn wide_arcs(xml: &roxmltree::Document<'_>, segments: u64, budget: &Budget) -> Result<(), Exceeded> {
    /// Radii of fewer cubics take no time.
    const WIDE: f64 = 1e8;
    /// A cubic's error times the sixth power of their number in a turn, for the radius 1, and the error that usvg allows.
    const ERROR: f64 = 1.1163;
    const ALLOWED: f64 = 0.1;
    /// Comparisons for an arc, by the square of its cubics.
    const MOVED: f64 = 0.0125;
    // Path data is parsed once more only where its numbers may amount to such an arc.
    let arcs = |d: &str| {
        let suspected = memchr2(b'a', b'A', d.as_bytes()).is_some() && is_uneven(d);
        suspected.then(|| Outline::from_svg_lossy(d))
    };
    let radius = |s: &Seg| if let Seg::Arc(a) = s { a.a.hypot().max(a.b.hypot()) } else { 0.0 };
    let widest = |o: Outline| o.segs().map(radius).fold(0.0, f64::max);
    let paths = xml.descendants().filter_map(|n| n.attribute("d")).filter_map(arcs);
    let radius = paths.map(widest).fold(0.0, f64::max);
    if radius < WIDE {
        return Ok(());
    }
    let cubics = (ERROR * radius / ALLOWED).powf(1.0 / 6.0);
    // Each of them may be as wide.
    budget.spend(cost::COMPARISON * segments as f64 * MOVED * cubics * cubics)
}

/// Returns `false` if all numbers of path data are certainly below 10⁴ and, unless they are zero, at least 10⁻³: no exponent, no five
/// digits before a point, no three zeros after it.
fn is_uneven(data: &str) -> bool {
    let (mut digits, mut zeros, mut fraction) = (0, 0, false);
    for byte in data.bytes() {
        match byte {
            b'e' | b'E' => return true,
            b'.' => (zeros, fraction) = (0, true),
            b'0' if fraction => zeros += 1,
            // The digits after the first one that is not zero do not count.
            b'0'..=b'9' if fraction => zeros = i32::MIN,
            b'0'..=b'9' => digits += 1,
            _ => (digits, fraction) = (0, false),
        }
        if digits > 4 || fraction && zeros > 2 {
            return true;
        }
    }
    false
}

/// Counts the shapes of a drawing with strokes so wide that single precision fails the renderer when it outlines them for their
/// boxes: the time grows with the width.
pub(super) fn wide_strokes(xml: &roxmltree::Document<'_>, budget: &Budget) -> Result<(), Exceeded> {
    /// Narrower strokes take no time.
    const WIDE: f64 = 2e6;
    /// Comparisons for a shape and a unit of its width.
    const UNIT: f64 = 350e-6;
    let text = xml.input_text();
    let widths = memmem::find_iter(text.as_bytes(), "stroke-width").filter_map(|at| {
        let value = text.get(at + "stroke-width".len()..)?.trim_start_matches([' ', ':', '=', '"', '\'']);
        let end = value.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E' | '+' | '-')));
        value[..end.unwrap_or(value.len())].trim_end_matches(['e', 'E']).parse::<f64>().ok()
    });
    let width = widths.fold(0.0, f64::max).min(LARGEST);
    if width < WIDE {
        return Ok(());
    }
    let shapes = xml.descendants().filter(roxmltree::Node::is_element).count();
    budget.spend(cost::COMPARISON * shapes as f64 * width * UNIT)
}

/// Counts the letters that are compared with every span of their text.
pub(super) fn spans(xml: &roxmltree::Document<'_>, budget: &Budget) -> Result<(), Exceeded> {
    const AT_A_TIME: f64 = 64.0;
    let texts = xml.descendants().filter(|n| n.tag_name().name() == "text");
    for text in texts {
        let (mut spans, mut letters) = (0.0, 0.0);
        for n in text.descendants() {
            if n.is_element() {
                spans += 1.0;
            }
            letters += unfold::letters(n) as f64;
        }
        // The text itself is no span. Its letters are also compared with each other, some at a time.
        budget.spend(cost::COMPARISON * ((spans - 1.0) * letters + letters * letters / AT_A_TIME))?;
    }
    Ok(())
}
