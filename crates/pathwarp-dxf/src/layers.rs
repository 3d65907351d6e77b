//! The layers of a file.

use crate::color::{FOREGROUND, nearest};
use crate::model::Shape;
use std::collections::HashMap;
use std::fmt::Write as _;

/// The layer that every file has.
pub(crate) const ZERO: &str = "0";

/// Longest name in characters.
const LONGEST: usize = 255;

/// The layers, in the order of their first shapes.
pub(crate) struct Layers {
    /// Name as written, and index of the colour of the first shape.
    pub(crate) all: Vec<(String, u8)>,
    /// The place of a name as given.
    places: HashMap<String, usize>,
}

impl Layers {
    pub(crate) fn of(shapes: &[Shape<'_>]) -> Self {
        let mut out = Self { all: vec![(ZERO.to_owned(), FOREGROUND)], places: HashMap::new() };
        let mut known: HashMap<String, usize> = HashMap::from([(ZERO.to_owned(), 0)]);
        for shape in shapes {
            if out.places.contains_key(shape.layer) {
                continue;
            }
            let name = written(shape.layer);
            let place = *known.entry(name.to_lowercase()).or_insert_with(|| {
                out.all.push((name, shape.color.map_or(FOREGROUND, |c| nearest(c).0)));
                out.all.len() - 1
            });
            out.places.insert(shape.layer.to_owned(), place);
        }
        out
    }

    /// The name of a shape's layer as written.
    pub(crate) fn name(&self, layer: &str) -> &str {
        self.places.get(layer).and_then(|i| self.all.get(*i)).map_or(ZERO, |(name, _)| name)
    }
}

/// A name as DXF allows it.
fn written(name: &str) -> String {
    let mut out = String::new();
    for c in name.trim().chars().take(LONGEST) {
        match c {
            '<' | '>' | '/' | '\\' | '"' | ':' | ';' | '?' | '*' | '|' | ',' | '=' | '`' => out.push('_'),
            c if c.is_control() => out.push('_'),
            c if c.is_ascii() => out.push(c),
            c => {
                for unit in c.encode_utf16(&mut [0; 2]) {
                    let _ = write!(out, "\\U+{unit:04X}");
                }
            }
        }
    }
    if out.is_empty() { ZERO.to_owned() } else { out }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::Outline;

    #[test]
    fn names_are_made_fit() {
        let outline = Outline::default();
        let names = ["Cut", "cut", "a/b:c", " ", "Schön", ""];
        let shapes: Vec<Shape<'_>> =
            names.iter().map(|layer| Shape { layer, color: Some([0, 255, 0]), outline: &outline }).collect();
        let layers = Layers::of(&shapes);
        let written: Vec<&str> = names.iter().map(|n| layers.name(n)).collect();
        assert_eq!(written, ["Cut", "Cut", "a_b_c", "0", "Sch\\U+00F6n", "0"]);
        assert_eq!(layers.all.len(), 4);
        assert_eq!(layers.all[1], ("Cut".to_owned(), 3));
    }
}
