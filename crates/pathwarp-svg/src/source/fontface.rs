//! Loads fonts embedded in a drawing: `@font-face` rules in its style sheets (CSS Fonts 4, section 4) with a `data:` URL of a
//! TrueType, OpenType or WOFF 1.0 font.

use super::elements::declarations;
use super::fonts::{Bytes, load_unnamed, set_browser_metrics, size_of_listing};
use base64::Engine as _;
use pathwarp::budget::{Budget, Exceeded, Limit, cost};
use pathwarp_text::GlyphWork;
use std::collections::BTreeMap;
use std::io::Read as _;
use std::sync::Arc;
use usvg::fontdb::{Database, FaceInfo, Language, Source, Style, Weight};
use usvg::roxmltree::{Document, Node};

/// An embedded font with the properties that its rule gives it.
#[derive(Debug)]
struct Face {
    family: String,
    style: Option<Style>,
    weight: Option<Weight>,
    /// Content of an sfnt file.
    data: Vec<u8>,
}

/// Adds a drawing's embedded fonts. They replace other fonts with their names.
///
/// # Errors
/// [`Exceeded`] if the fonts exceed the budget, unpacked or with the letters of the text.
pub(crate) fn add(mut db: Arc<Database>, xml: &Document<'_>, budget: &Budget) -> Result<Arc<Database>, Exceeded> {
    let faces = faces(xml.input_text(), budget)?;
    if faces.is_empty() {
        return Ok(db);
    }
    count_letters(xml, &faces, budget)?;
    let all = Arc::make_mut(&mut db);
    let same = |f: &&FaceInfo| f.families.iter().any(|n| faces.iter().any(|face| face.family == n.0));
    let taken: Vec<_> = all.faces().filter(same).map(|f| f.id).collect();
    taken.into_iter().for_each(|id| all.remove_face(id));
    for face in faces {
        let mut data = face.data;
        set_browser_metrics(&mut data, 0);
        let data: Bytes = Arc::new(data);
        let mut ids = all.load_font_source(Source::Binary(data.clone())).to_vec();
        if ids.is_empty() {
            ids.extend(load_unnamed(all, &data, face.family.clone()));
        }
        for id in ids {
            let Some(info) = all.face(id).cloned() else { continue };
            all.remove_face(id);
            all.push_face_info(FaceInfo {
                families: vec![(face.family.clone(), Language::English_UnitedStates)],
                style: face.style.unwrap_or(info.style),
                weight: face.weight.unwrap_or(info.weight),
                ..info
            });
        }
    }
    Ok(db)
}

/// Checks the work of outlining all letters of the text in each font.
fn count_letters(xml: &Document<'_>, faces: &[Face], budget: &Budget) -> Result<(), Exceeded> {
    let mut letters: BTreeMap<char, u64> = BTreeMap::new();
    let shown = xml.descendants().filter(|n| n.is_element() && n.tag_name().name() == "text");
    let texts = shown.flat_map(|n| n.descendants()).filter(Node::is_text).filter_map(|n| n.text());
    texts.flat_map(str::chars).for_each(|c| *letters.entry(c).or_default() += 1);
    for face in faces {
        let Some(mut work) = GlyphWork::new(&face.data, 0) else { continue };
        let total: u64 = letters.iter().map(|(c, n)| n * work.of_letter(*c)).sum();
        budget.check(Limit::Work, cost::SEGMENT * total as f64)?;
    }
    Ok(())
}

/// Reads the fonts of all rules in a text.
fn faces(text: &str, budget: &Budget) -> Result<Vec<Face>, Exceeded> {
    let mut out = Vec::new();
    let mut rest = text;
    while let Some((_, rule)) = rest.split_once("@font-face") {
        let Some((block, after)) = rule.split_once('{').and_then(|(_, body)| body.split_once('}')) else { break };
        out.extend(face(block, budget)?);
        rest = after;
    }
    Ok(out)
}

/// Reads the font of a rule. Returns `None` if it has none in a supported format.
fn face(block: &str, budget: &Budget) -> Result<Option<Face>, Exceeded> {
    let declarations: Vec<_> = declarations(block).collect();
    let value = |name: &str| declarations.iter().rfind(|d| d.0.eq_ignore_ascii_case(name)).map(|d| d.1);
    let (Some(family), Some(src)) = (value("font-family"), value("src")) else { return Ok(None) };
    let family = family.trim_matches(['"', '\'']).to_owned();
    let style = value("font-style").and_then(|v| match v {
        "normal" => Some(Style::Normal),
        "italic" => Some(Style::Italic),
        v => v.starts_with("oblique").then_some(Style::Oblique),
    });
    let weight = value("font-weight").and_then(|v| match v {
        "normal" => Some(Weight::NORMAL),
        "bold" => Some(Weight::BOLD),
        v => v.parse().ok().map(Weight),
    });
    // Base64 contains no colon, so this cannot split within the data.
    for url in src.split("data:").skip(1) {
        if let Some(data) = font(url, budget)? {
            return Ok(Some(Face { family, style, weight, data }));
        }
    }
    Ok(None)
}

/// Decodes the font in a `data:` URL, given without the scheme, to an sfnt file.
fn font(url: &str, budget: &Budget) -> Result<Option<Vec<u8>>, Exceeded> {
    let Some(data) = decoded(url) else { return Ok(None) };
    match data.get(..4) {
        Some(b"wOFF") => {
            budget.take(Limit::Bytes, unpacked_size(&data).unwrap_or(0) as f64)?;
            Ok(unpacked(&data))
        }
        Some(b"ttcf") => {
            let size = size_of_listing(&data, budget.room(Limit::Bytes) as u64);
            budget.take(Limit::Bytes, size as f64).map_err(Exceeded::cut_short)?;
            Ok(Some(data))
        }
        Some(b"wOF2") | None => Ok(None),
        Some(_) => Ok(Some(data)),
    }
}

/// Decodes the base64 of a `data:` URL.
fn decoded(url: &str) -> Option<Vec<u8>> {
    let (head, rest) = url.split_once(',')?;
    if !head.trim_end().ends_with(";base64") {
        return None;
    }
    let encoded = &rest[..rest.find(['"', '\'', ')']).unwrap_or(rest.len())];
    let encoded: String = encoded.split_whitespace().collect();
    base64::engine::general_purpose::STANDARD.decode(encoded).ok()
}

/// Size in bytes of a WOFF's header.
const HEADER: usize = 44;
/// Size in bytes of an entry in a WOFF's table directory.
const ENTRY: usize = 20;

/// Reads a big-endian number of 32 bits.
fn long(woff: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_be_bytes(woff.get(at..at.checked_add(4)?)?.try_into().ok()?))
}

/// The number of tables in a WOFF.
fn table_count(woff: &[u8]) -> Option<u16> {
    Some(u16::from_be_bytes(woff.get(12..14)?.try_into().ok()?))
}

/// The unpacked size of all tables, according to the directory.
fn unpacked_size(woff: &[u8]) -> Option<u64> {
    let count = usize::from(table_count(woff)?);
    (0..count).map(|i| long(woff, HEADER + i * ENTRY + 12).map(u64::from)).sum()
}

/// Unpacks WOFF 1.0 to the original sfnt file (W3C, *WOFF File Format 1.0*, sections 3 to 5).
fn unpacked(woff: &[u8]) -> Option<Vec<u8>> {
    let long = |at: usize| long(woff, at);
    let size = |at: usize| long(at).map(|v| v as usize);
    let count = table_count(woff)?;
    let mut out = long(4)?.to_be_bytes().to_vec();
    // Search parameters of the table directory, required by some readers.
    let selector = u16::try_from(count.checked_ilog2()?).ok()?;
    let range = 16_u16.checked_mul(1 << selector)?;
    for v in [count, range, selector, count.checked_mul(16)? - range] {
        out.extend(v.to_be_bytes());
    }
    let mut tables = Vec::new();
    let start = out.len() + 16 * usize::from(count);
    for i in 0..usize::from(count) {
        let entry = HEADER + i * ENTRY;
        let (from, packed, length) = (size(entry + 4)?, size(entry + 8)?, size(entry + 12)?);
        let data = woff.get(from..from.checked_add(packed)?)?;
        // The tag, the checksum, and position and length in the new file.
        out.extend(woff.get(entry..entry + 4)?);
        for v in [long(entry + 16)?, u32::try_from(start + tables.len()).ok()?, long(entry + 12)?] {
            out.extend(v.to_be_bytes());
        }
        if packed < length {
            let before = tables.len();
            flate2::read::ZlibDecoder::new(data).take(length as u64).read_to_end(&mut tables).ok()?;
            if tables.len() - before != length {
                return None;
            }
        } else {
            tables.extend(data);
        }
        tables.resize(tables.len().next_multiple_of(4), 0);
    }
    out.append(&mut tables);
    Some(out)
}
