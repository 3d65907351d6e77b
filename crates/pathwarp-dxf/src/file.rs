//! The parts of a file around its entities: header, tables, blocks, objects.

use crate::codes::Codes;
use crate::layers::Layers;
use crate::model::Options;
use pathwarp::kurbo::Point;

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

/// `$INSUNITS`: millimetres.
const MILLIMETRES: i64 = 4;

/// Writes everything up to the first entity.
pub(crate) fn start(out: &mut Codes, layers: &Layers, options: &Options) {
    header(out, options);
    section(out, "TABLES");
    table(out, "VPORT", handle::VIEWPORTS, 0);
    end_table(out);
    line_types(out);
    layer_table(out, layers);
    styles(out);
    table(out, "VIEW", handle::VIEWS, 0);
    end_table(out);
    table(out, "UCS", handle::COORDINATES, 0);
    end_table(out);
    table(out, "APPID", handle::PROGRAMS, 1);
    record(out, "APPID", 5, handle::PROGRAMS, "AcDbRegAppTableRecord").text(2, "ACAD").whole(70, 0);
    end_table(out);
    table(out, "DIMSTYLE", handle::DIMENSIONS, 1);
    out.text(100, "AcDbDimStyleTable");
    record(out, "DIMSTYLE", 105, handle::DIMENSIONS, "AcDbDimStyleTableRecord").text(2, "Standard").whole(70, 0);
    end_table(out);
    table(out, "BLOCK_RECORD", handle::BLOCKS, 2);
    for (name, handle) in SPACES {
        out.text(0, "BLOCK_RECORD").handle(5, handle).handle(330, handle::BLOCKS);
        out.text(100, "AcDbSymbolTableRecord").text(100, "AcDbBlockTableRecord").text(2, name);
    }
    end_table(out);
    end_section(out);
    blocks(out);
    section(out, "ENTITIES");
}

/// Writes everything behind the last entity.
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

fn table(out: &mut Codes, name: &str, handle: u64, entries: usize) {
    out.text(0, "TABLE").text(2, name).handle(5, handle).handle(330, 0);
    out.text(100, "AcDbSymbolTable").whole(70, entries as i64);
}

fn end_table(out: &mut Codes) {
    out.text(0, "ENDTAB");
}

/// Starts an entry of a table. `code` is that of its handle.
fn record<'c>(out: &'c mut Codes, name: &str, code: u16, table: u64, class: &str) -> &'c mut Codes {
    let handle = out.new_handle();
    out.text(0, name).handle(code, handle).handle(330, table).text(100, "AcDbSymbolTableRecord").text(100, class)
}

fn line_types(out: &mut Codes) {
    let types = [("ByBlock", ""), ("ByLayer", ""), ("Continuous", "Solid line")];
    table(out, "LTYPE", handle::LINE_TYPES, types.len());
    for (name, meaning) in types {
        record(out, "LTYPE", 5, handle::LINE_TYPES, "AcDbLinetypeTableRecord").text(2, name).whole(70, 0);
        out.text(3, meaning).whole(72, 65).whole(73, 0).length(40, 0.0);
    }
    end_table(out);
}

fn layer_table(out: &mut Codes, layers: &Layers) {
    table(out, "LAYER", handle::LAYERS, layers.all.len());
    for (name, color) in &layers.all {
        record(out, "LAYER", 5, handle::LAYERS, "AcDbLayerTableRecord").text(2, name).whole(70, 0);
        out.whole(62, (*color).into()).text(6, "Continuous");
    }
    end_table(out);
}

fn styles(out: &mut Codes) {
    table(out, "STYLE", handle::STYLES, 1);
    record(out, "STYLE", 5, handle::STYLES, "AcDbTextStyleTableRecord").text(2, "Standard").whole(70, 0);
    out.length(40, 0.0).length(41, 1.0).length(50, 0.0).whole(71, 0).length(42, 2.5).text(3, "txt").text(4, "");
    end_table(out);
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
