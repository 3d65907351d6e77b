//! The text of a DXF file: group codes, colours, layers, and the parts of a file around its entities.
//!
//! A file is a list of pairs of lines: a group code, which gives the meaning of the value, and the value. 0 begins a part or an object,
//! 2 is a name, 5 a handle, 330 the owner's handle, 100 the class of what follows, 8 a layer, 62 and 420 are colours, 10 to 39
//! coordinates, and 70 to 79 flags or numbers.

use crate::model::{Options, Shape};
use pathwarp::engine::decimal::push_trimmed;
use pathwarp::kurbo::Point;
use std::collections::HashMap;
use std::fmt::{Display, Write as _};

/// Handles of the objects that every file has. Each is unique.
mod handle {
    pub(super) const VIEWPORTS: u64 = 0x1;
    pub(super) const LINE_TYPES: u64 = 0x2;
    pub(super) const LAYERS: u64 = 0x3;
    pub(super) const STYLES: u64 = 0x4;
    pub(super) const VIEWS: u64 = 0x5;
    pub(super) const COORDINATES: u64 = 0x6;
    pub(super) const PROGRAMS: u64 = 0x7;
    pub(super) const DIMENSIONS: u64 = 0x8;
    pub(super) const BLOCKS: u64 = 0x9;
    pub(super) const DICTIONARY: u64 = 0xA;
    pub(super) const GROUPS: u64 = 0xB;
    pub(super) const PAPER_SPACE: u64 = 0x11;
}

/// The handle of the block that entities are part of.
pub(crate) const MODEL_SPACE: u64 = 0x10;

/// Value of `$INSUNITS` for millimetres.
const MILLIMETRES: i64 = 4;

/// Writes the parts of a file before the first entity.
pub(crate) fn start(out: &mut Codes, layers: &Layers, options: &Options) {
    header(out, options);
    section(out, "TABLES");
    table(out, "VPORT", handle::VIEWPORTS, 0, |_| {});
    line_types(out);
    layer_table(out, layers);
    styles(out);
    table(out, "VIEW", handle::VIEWS, 0, |_| {});
    table(out, "UCS", handle::COORDINATES, 0, |_| {});
    table(out, "APPID", handle::PROGRAMS, 1, |out| {
        entry(out, "APPID", 5, handle::PROGRAMS, "AcDbRegAppTableRecord").text(2, "ACAD").whole(70, 0);
    });
    table(out, "DIMSTYLE", handle::DIMENSIONS, 1, |out| {
        out.text(100, "AcDbDimStyleTable");
        entry(out, "DIMSTYLE", 105, handle::DIMENSIONS, "AcDbDimStyleTableRecord").text(2, "Standard").whole(70, 0);
    });
    table(out, "BLOCK_RECORD", handle::BLOCKS, SPACES.len(), |out| {
        for (name, handle) in SPACES {
            out.text(0, "BLOCK_RECORD").handle(5, handle).handle(330, handle::BLOCKS);
            out.text(100, "AcDbSymbolTableRecord").text(100, "AcDbBlockTableRecord").text(2, name);
        }
    });
    end_section(out);
    blocks(out);
    section(out, "ENTITIES");
}

/// Writes the parts of a file after the last entity, and returns the text.
pub(crate) fn finish(mut out: Codes) -> String {
    end_section(&mut out);
    section(&mut out, "OBJECTS");
    out.text(0, "DICTIONARY").handle(5, handle::DICTIONARY).handle(330, 0).text(100, "AcDbDictionary").whole(281, 1);
    out.text(3, "ACAD_GROUP").handle(350, handle::GROUPS);
    out.text(0, "DICTIONARY").handle(5, handle::GROUPS).handle(330, handle::DICTIONARY);
    out.text(100, "AcDbDictionary").whole(281, 1);
    end_section(&mut out);
    out.text(0, "EOF");
    out.finish()
}

/// The blocks for drawings and for pages.
const SPACES: [(&str, u64); 2] = [("*Model_Space", MODEL_SPACE), ("*Paper_Space", handle::PAPER_SPACE)];

fn header(out: &mut Codes, options: &Options) {
    let [width, height] = options.page;
    section(out, "HEADER");
    out.text(9, "$ACADVER").text(1, "AC1018");
    out.text(9, "$DWGCODEPAGE").text(3, "ANSI_1252");
    out.text(9, "$INSUNITS").whole(70, MILLIMETRES);
    out.text(9, "$MEASUREMENT").whole(70, 1);
    out.text(9, "$LUNITS").whole(70, 2);
    out.text(9, "$EXTMIN").point(10, Point::ORIGIN);
    out.text(9, "$EXTMAX").point(10, Point::new(width, height));
    out.text(9, "$LIMMIN").length(10, 0.0).length(20, 0.0);
    out.text(9, "$LIMMAX").length(10, width).length(20, height);
    out.text(9, "$CLAYER").text(8, "0");
    out.text(9, "$HANDSEED").text(5, Codes::SEED);
    end_section(out);
}

fn section(out: &mut Codes, name: &str) {
    out.text(0, "SECTION").text(2, name);
}

fn end_section(out: &mut Codes) {
    out.text(0, "ENDSEC");
}

/// Writes a table with `count` entries, which `entries` writes.
fn table(out: &mut Codes, name: &str, handle: u64, count: usize, entries: impl FnOnce(&mut Codes)) {
    out.text(0, "TABLE").text(2, name).handle(5, handle).handle(330, 0);
    out.text(100, "AcDbSymbolTable").whole(70, count as i64);
    entries(out);
    out.text(0, "ENDTAB");
}

/// Starts an entry of a table. `code` is the group code of its handle.
fn entry<'c>(out: &'c mut Codes, name: &str, code: u16, table: u64, class: &str) -> &'c mut Codes {
    let handle = out.new_handle();
    out.text(0, name).handle(code, handle).handle(330, table).text(100, "AcDbSymbolTableRecord").text(100, class)
}

fn line_types(out: &mut Codes) {
    let types = [("ByBlock", ""), ("ByLayer", ""), ("Continuous", "Solid line")];
    table(out, "LTYPE", handle::LINE_TYPES, types.len(), |out| {
        for (name, meaning) in types {
            entry(out, "LTYPE", 5, handle::LINE_TYPES, "AcDbLinetypeTableRecord").text(2, name).whole(70, 0);
            out.text(3, meaning).whole(72, 65).whole(73, 0).length(40, 0.0);
        }
    });
}

fn layer_table(out: &mut Codes, layers: &Layers) {
    table(out, "LAYER", handle::LAYERS, layers.all.len(), |out| {
        for (name, color) in &layers.all {
            entry(out, "LAYER", 5, handle::LAYERS, "AcDbLayerTableRecord").text(2, name).whole(70, 0);
            out.whole(62, (*color).into()).text(6, "Continuous");
        }
    });
}

fn styles(out: &mut Codes) {
    table(out, "STYLE", handle::STYLES, 1, |out| {
        entry(out, "STYLE", 5, handle::STYLES, "AcDbTextStyleTableRecord").text(2, "Standard").whole(70, 0);
        out.length(40, 0.0).length(41, 1.0).length(50, 0.0).whole(71, 0).length(42, 2.5).text(3, "txt").text(4, "");
    });
}

fn blocks(out: &mut Codes) {
    section(out, "BLOCKS");
    for (name, owner) in SPACES {
        let [start, end] = [out.new_handle(), out.new_handle()];
        out.text(0, "BLOCK").handle(5, start).handle(330, owner).text(100, "AcDbEntity").text(8, "0");
        out.text(100, "AcDbBlockBegin").text(2, name).whole(70, 0).point(10, Point::ORIGIN).text(3, name).text(1, "");
        out.text(0, "ENDBLK").handle(5, end).handle(330, owner).text(100, "AcDbEntity").text(8, "0");
        out.text(100, "AcDbBlockEnd");
    }
    end_section(out);
}

/// The layer that every file has.
const LAYER_0: &str = "0";

/// Largest number of characters in a name.
const MAX_NAME: usize = 255;

/// The layers, in the order of their first shapes.
pub(crate) struct Layers {
    /// Name as written, and index of the colour of the first shape.
    all: Vec<(String, u8)>,
    /// Index in `all` by the name of a layer as given.
    indices: HashMap<String, usize>,
}

impl Layers {
    pub(crate) fn from_shapes(shapes: &[Shape<'_>]) -> Self {
        let mut out = Self { all: vec![(LAYER_0.to_owned(), FOREGROUND)], indices: HashMap::new() };
        // Names that differ only in case are one layer.
        let mut by_lowercase: HashMap<String, usize> = HashMap::from([(LAYER_0.to_owned(), 0)]);
        for shape in shapes {
            if out.indices.contains_key(shape.layer) {
                continue;
            }
            let name = escape_name(shape.layer);
            let index = *by_lowercase.entry(name.to_lowercase()).or_insert_with(|| {
                out.all.push((name, shape.color.map_or(FOREGROUND, |c| nearest_color(c).0)));
                out.all.len() - 1
            });
            out.indices.insert(shape.layer.to_owned(), index);
        }
        out
    }

    /// Returns the name of a shape's layer as written.
    pub(crate) fn name(&self, layer: &str) -> &str {
        self.indices.get(layer).map_or(LAYER_0, |i| &self.all[*i].0)
    }
}

/// Converts a name to the characters that DXF allows.
fn escape_name(name: &str) -> String {
    let mut out = String::new();
    for c in name.trim().chars().take(MAX_NAME) {
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
    if out.is_empty() { LAYER_0.to_owned() } else { out }
}

/// Index of the colour that is black on a light and white on a dark background.
const FOREGROUND: u8 = 7;

/// The named colours 1 to 6.
const NAMED: [[u8; 3]; 6] = [[255, 0, 0], [255, 255, 0], [0, 255, 0], [0, 255, 255], [0, 0, 255], [255, 0, 255]];

/// The greys 8 and 9, and 250 to 254, as index and brightness.
const GREYS: [(u8, u8); 7] = [(8, 128), (9, 192), (250, 51), (251, 91), (252, 132), (253, 173), (254, 214)];

/// Brightest channel of the shades of a hue, from the first pair of ten to the last.
const LEVELS: [f64; 5] = [255.0, 165.0, 127.0, 76.0, 38.0];

/// Returns the index of the nearest of AutoCAD's colours, and `true` if it is this very colour by its definition, in every program.
pub(crate) fn nearest_color(color: [u8; 3]) -> (u8, bool) {
    if color == [0; 3] || color == [255; 3] {
        return (FOREGROUND, true);
    }
    if let Some((index, _)) = (1..).zip(NAMED).find(|(_, c)| *c == color) {
        return (index, true);
    }
    let distance =
        |c: [u8; 3]| -> i32 { c.iter().zip(color).map(|(a, b)| (i32::from(*a) - i32::from(b)).pow(2)).sum() };
    let greys = GREYS.iter().map(|(i, v)| (*i, [*v; 3]));
    let shades = (10..250).map(|i| (i, shade(i)));
    let foreground = [(FOREGROUND, [0; 3]), (FOREGROUND, [255; 3])];
    let all = (1..).zip(NAMED).chain(foreground).chain(greys).chain(shades);
    (all.min_by_key(|(_, c)| distance(*c)).map_or(FOREGROUND, |(i, _)| i), false)
}

/// Returns one of the colours 10 to 249: 24 hues of ten shades, of which every second is half saturated.
fn shade(index: u8) -> [u8; 3] {
    /// Hues from one named colour to the next, a sixth of the colour circle.
    const PER_SIXTH: f64 = 4.0;
    let (hue, shade) = ((index - 10) / 10, (index - 10) % 10);
    let level = LEVELS[usize::from(shade / 2)];
    let floor = if shade % 2 == 0 { 0.0 } else { 0.5 };
    let sixth = f64::from(hue) / PER_SIXTH;
    // Red is brightest at 0 sixths, green at 2, blue at 4; a channel vanishes two sixths away.
    [0.0, 4.0, 2.0].map(|turn| {
        let distance = (sixth + turn).rem_euclid(6.0);
        let distance = distance.min(6.0 - distance);
        let strength = (2.0 - distance).clamp(0.0, 1.0);
        (level * (floor + (1.0 - floor) * strength)) as u8
    })
}

/// Decimals of lengths in millimetres: a millionth of a micrometre.
const LENGTH_DECIMALS: usize = 9;

/// Decimals of angles, parameters and ratios, so that a point at a hundred metres is off by less than a millionth of a micrometre.
const RATIO_DECIMALS: usize = 14;

/// The first handle that tables do not use.
const FIRST_HANDLE: u64 = 0x100;

/// The text of a file under construction.
pub(crate) struct Codes {
    text: String,
    /// Handle of the next new object.
    next: u64,
}

impl Codes {
    pub(crate) fn new() -> Self {
        Self { text: String::new(), next: FIRST_HANDLE }
    }

    pub(crate) fn text(&mut self, code: u16, value: &str) -> &mut Self {
        self.value(code, value)
    }

    pub(crate) fn whole(&mut self, code: u16, value: i64) -> &mut Self {
        self.value(code, value)
    }

    pub(crate) fn length(&mut self, code: u16, value: f64) -> &mut Self {
        self.number(code, value, LENGTH_DECIMALS)
    }

    /// Writes an angle, parameter or ratio.
    pub(crate) fn ratio(&mut self, code: u16, value: f64) -> &mut Self {
        self.number(code, value, RATIO_DECIMALS)
    }

    /// Writes a number with the fewest digits that determine it.
    pub(crate) fn shortest(&mut self, code: u16, value: f64) -> &mut Self {
        self.number(code, value, value.to_string().len())
    }

    /// Writes a point with x, y and z.
    pub(crate) fn point(&mut self, code: u16, p: Point) -> &mut Self {
        self.length(code, p.x).length(code + 10, p.y).length(code + 20, 0.0)
    }

    pub(crate) fn handle(&mut self, code: u16, handle: u64) -> &mut Self {
        self.value(code, format_args!("{handle:X}"))
    }

    /// Returns the handle of a new object.
    pub(crate) fn new_handle(&mut self) -> u64 {
        self.next += 1;
        self.next - 1
    }

    fn value(&mut self, code: u16, value: impl Display) -> &mut Self {
        let _ = write!(self.text, "{code:>3}\n{value}\n");
        self
    }

    fn number(&mut self, code: u16, value: f64, decimals: usize) -> &mut Self {
        let mut text = String::new();
        push_trimmed(&mut text, value, decimals);
        // Some readers tell a real number from a whole one by its point.
        if !text.contains('.') {
            text += ".0";
        }
        self.value(code, text)
    }

    /// Returns the text, in which `$HANDSEED` gets the first free handle.
    pub(crate) fn finish(self) -> String {
        self.text.replacen(Self::SEED, &format!("{:X}", self.next), 1)
    }

    /// Placeholder for the first free handle until all handles are known.
    pub(crate) const SEED: &str = "{first free handle}";
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
        let layers = Layers::from_shapes(&shapes);
        let written: Vec<&str> = names.iter().map(|n| layers.name(n)).collect();
        assert_eq!(written, ["Cut", "Cut", "a_b_c", "0", "Sch\\U+00F6n", "0"]);
        assert_eq!(layers.all.len(), 4);
        assert_eq!(layers.all[1], ("Cut".to_owned(), 3));
    }

    /// Compares with colours as AutoCAD shows them.
    #[test]
    fn known_colours() {
        for (index, color) in [
            (10, 0xff_0000),
            (11, 0xff_7f7f),
            (12, 0xa5_0000),
            (15, 0x7f_3f3f),
            (20, 0xff_3f00),
            (30, 0xff_7f00),
            (50, 0xff_ff00),
            (90, 0x00_ff00),
            (130, 0x00_ffff),
            (140, 0x00_bfff),
            (170, 0x00_00ff),
            (200, 0xbf_00ff),
            (210, 0xff_00ff),
            (249, 0x26_1316),
        ] {
            let [_, r, g, b] = u32::to_be_bytes(color);
            let off = shade(index).iter().zip([r, g, b]).map(|(a, b)| a.abs_diff(b)).max();
            assert!(off <= Some(1), "{index}: {:?}", shade(index));
        }
    }

    #[test]
    fn the_nearest_is_found() {
        assert_eq!(nearest_color([0, 0, 0]), (7, true));
        assert_eq!(nearest_color([0, 0, 255]), (5, true));
        assert_eq!(nearest_color([254, 1, 0]).0, 1);
        assert_eq!(nearest_color([255, 127, 1]), (30, false));
        assert_eq!(nearest_color([130, 130, 130]).0, 8);
    }
}
