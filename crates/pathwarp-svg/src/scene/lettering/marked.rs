//! Lettering of outlines, read from their data attributes.

use super::line::{Heights, PlacedLetter, TextLine};
use crate::scene::geometry::GeometryReader;
use crate::scene::model::{Part, PartRole};
use crate::source::tags::ElementId;
use pathwarp::kurbo::{Point, Vec2};
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, HashMap};

/// Reads the lines of `<g data-baseline>` elements. A letter belongs to the innermost one.
pub(crate) fn lines(
    reader: &GeometryReader<'_>,
    parts: &[Part],
    by_source: &HashMap<ElementId, Vec<usize>>,
) -> Vec<TextLine> {
    let source = reader.source;
    let mut out: BTreeMap<ElementId, TextLine> = BTreeMap::new();
    for e in 0..source.elements.len() {
        let Some(letter) = letter(reader, parts, by_source, e) else { continue };
        let mut above = source.ancestors(e);
        let Some((group, ends)) = above.find_map(|a| Some((a, numbers(reader, a, "data-baseline")?))) else { continue };
        match out.entry(group) {
            Entry::Occupied(mut line) => line.get_mut().letters.push(letter),
            Entry::Vacant(place) => {
                if let Some(line) = line(reader, group, ends) {
                    place.insert(line).letters.push(letter);
                }
            }
        }
    }
    out.into_values().collect()
}

fn line(reader: &GeometryReader<'_>, e: ElementId, [x0, y0, x1, y1]: [f64; 4]) -> Option<TextLine> {
    let source = reader.source;
    let frame = reader.transform_to_root(e)?;
    let label = source.ancestors(e).find_map(|a| source.attr(a, "aria-label"));
    let name = label.map_or_else(|| source.display_name(e), std::borrow::Cow::into_owned);
    Some(TextLine::new(name, Point::new(x0, y0), Point::new(x1, y1), heights(reader, e), frame, true))
}

fn letter(
    reader: &GeometryReader<'_>,
    parts: &[Part],
    by_source: &HashMap<ElementId, Vec<usize>>,
    e: ElementId,
) -> Option<PlacedLetter> {
    let [x, y, advance] = numbers(reader, e, "data-glyph")?;
    let own: Vec<usize> = by_source.get(&e)?.iter().copied().filter(|&i| is_ink(&parts[i])).collect();
    let frame = parts[*own.first()?].frame;
    let [a, b, ..] = frame.as_coeffs();
    let label = reader.source.attr(e, "aria-label");
    Some(PlacedLetter {
        name: label.map_or_else(|| reader.source.display_name(e), std::borrow::Cow::into_owned),
        origin: frame * Point::new(x, y),
        advance: (Vec2::new(a, b) * advance).hypot(),
        subpaths: own.into_iter().map(|i| (i, 0..parts[i].local.subpaths.len())).collect(),
    })
}

fn heights(reader: &GeometryReader<'_>, e: ElementId) -> Heights {
    let named = |name: &str| {
        let found = reader.source.ancestors(e).find_map(|a| numbers::<1>(reader, a, name));
        found.map_or(0.0, |[v]| v.abs())
    };
    Heights {
        ascent: named("data-ascent"),
        descent: named("data-descent"),
        cap_height: named("data-cap-height"),
        x_height: named("data-x-height"),
    }
}

/// Parses an attribute of exactly `N` finite numbers.
fn numbers<const N: usize>(reader: &GeometryReader<'_>, e: ElementId, name: &str) -> Option<[f64; N]> {
    let text = reader.source.attr(e, name)?;
    let words = text.split([' ', ',', '\t', '\n', '\r']).filter(|w| !w.is_empty());
    let values: Option<Vec<f64>> = words.take(N + 1).map(|w| w.parse::<f64>().ok().filter(|v| v.is_finite())).collect();
    values?.try_into().ok()
}

/// Returns `true` if a part can be a letter, or part of one.
fn is_ink(p: &Part) -> bool {
    p.role == PartRole::Paint && p.painted()
}
