//! Lettering that outlines tell of themselves, by their data attributes.

use super::{Heights, Letter, Line, paints};
use crate::scene::geometry::Reader;
use crate::scene::model::Part;
use crate::source::text::ElementId;
use pathwarp::kurbo::{Point, Vec2};
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, HashMap};

/// The lines that `<g data-baseline>` elements tell of. A letter belongs to the innermost one.
pub(crate) fn lines(reader: &Reader<'_>, parts: &[Part], by_source: &HashMap<ElementId, Vec<usize>>) -> Vec<Line> {
    let source = reader.source;
    let mut out: BTreeMap<ElementId, Line> = BTreeMap::new();
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

fn line(reader: &Reader<'_>, e: ElementId, [x0, y0, x1, y1]: [f64; 4]) -> Option<Line> {
    let source = reader.source;
    let frame = reader.transform_to_root(e)?;
    let label = source.ancestors(e).find_map(|a| source.attr(a, "aria-label"));
    let name = label.map_or_else(|| source.display_name(e), std::borrow::Cow::into_owned);
    Some(Line::new(name, Point::new(x0, y0), Point::new(x1, y1), heights(reader, e), frame, true))
}

fn letter(
    reader: &Reader<'_>,
    parts: &[Part],
    by_source: &HashMap<ElementId, Vec<usize>>,
    e: ElementId,
) -> Option<Letter> {
    let [x, y, advance] = numbers(reader, e, "data-glyph")?;
    let own: Vec<usize> = by_source.get(&e)?.iter().copied().filter(|&i| paints(&parts[i])).collect();
    let frame = parts[*own.first()?].frame;
    let [a, b, ..] = frame.as_coeffs();
    Some(Letter {
        name: reader
            .source
            .attr(e, "aria-label")
            .map_or_else(|| reader.source.display_name(e), std::borrow::Cow::into_owned),
        origin: frame * Point::new(x, y),
        advance: (Vec2::new(a, b) * advance).hypot(),
        owns: own.into_iter().map(|i| (i, 0..parts[i].local.subpaths.len())).collect(),
    })
}

fn heights(reader: &Reader<'_>, e: ElementId) -> Heights {
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

/// An attribute of exactly so many finite numbers.
fn numbers<const N: usize>(reader: &Reader<'_>, e: ElementId, name: &str) -> Option<[f64; N]> {
    let text = reader.source.attr(e, name)?;
    let words = text.split([' ', ',', '\t', '\n', '\r']).filter(|w| !w.is_empty());
    let all: Option<Vec<f64>> = words.take(N + 1).map(|w| w.parse::<f64>().ok().filter(|v| v.is_finite())).collect();
    all?.try_into().ok()
}
