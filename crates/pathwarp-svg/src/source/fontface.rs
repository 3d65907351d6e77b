//! Fonts embedded in a drawing: `@font-face` rules in its style sheets (CSS Fonts 4, section 4) with a `data:` URL of a
//! TrueType, OpenType or WOFF 1.0 font.

use super::style::declarations;
use base64::Engine as _;
use std::io::Read as _;
use std::sync::Arc;
use usvg::fontdb::{Database, FaceInfo, Language, Source, Style, Weight};

/// Largest font to unpack, about ten times the usual size.
const LARGEST: usize = 64 << 20;

#[derive(Debug)]
struct Face {
    family: String,
    style: Option<Style>,
    weight: Option<Weight>,
    /// Content of an sfnt file.
    data: Vec<u8>,
}

/// Adds a drawing's embedded fonts. They replace other fonts of the same name.
pub(crate) fn add(mut db: Arc<Database>, text: &str) -> Arc<Database> {
    let faces = faces(text);
    if faces.is_empty() {
        return db;
    }
    let all = Arc::make_mut(&mut db);
    let same = |f: &&FaceInfo| f.families.iter().any(|n| faces.iter().any(|face| face.family == n.0));
    let taken: Vec<_> = all.faces().filter(same).map(|f| f.id).collect();
    taken.into_iter().for_each(|id| all.remove_face(id));
    for face in faces {
        for id in all.load_font_source(Source::Binary(Arc::new(face.data))) {
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
    db
}

fn faces(text: &str) -> Vec<Face> {
    let blocks = text.match_indices("@font-face").filter_map(|(i, _)| {
        let (_, rest) = text[i..].split_once('{')?;
        rest.split_once('}').map(|b| b.0)
    });
    blocks.filter_map(face).collect()
}

fn face(block: &str) -> Option<Face> {
    let of = |name: &str| declarations(block).filter(|d| d.0.eq_ignore_ascii_case(name)).last().map(|d| d.1);
    let family = of("font-family")?.trim_matches(['"', '\'']).to_owned();
    let style = of("font-style").and_then(|v| match v {
        "normal" => Some(Style::Normal),
        "italic" => Some(Style::Italic),
        v => v.starts_with("oblique").then_some(Style::Oblique),
    });
    let weight = of("font-weight").and_then(|v| match v {
        "normal" => Some(Weight::NORMAL),
        "bold" => Some(Weight::BOLD),
        v => v.parse().ok().map(Weight),
    });
    let src = of("src")?;
    let data = src.match_indices("data:").find_map(|(i, _)| font(&src[i..]))?;
    Some(Face { family, style, weight, data })
}

/// Decodes the font in a `data:` URL to an sfnt file.
fn font(url: &str) -> Option<Vec<u8>> {
    let (head, rest) = url.split_once(',')?;
    if !head.trim_end().ends_with(";base64") {
        return None;
    }
    let encoded = &rest[..rest.find(['"', '\'', ')']).unwrap_or(rest.len())];
    let encoded: String = encoded.split_whitespace().collect();
    let data = base64::engine::general_purpose::STANDARD.decode(encoded).ok()?;
    match data.get(..4)? {
        b"wOFF" => unpacked(&data),
        b"wOF2" => None,
        _ => Some(data),
    }
}

/// Unpacks WOFF 1.0 to the original sfnt file (W3C, *WOFF File Format 1.0*, sections 3 to 5).
fn unpacked(woff: &[u8]) -> Option<Vec<u8>> {
    const HEADER: usize = 44;
    const ENTRY: usize = 20;
    let long = |at: usize| Some(u32::from_be_bytes(woff.get(at..at + 4)?.try_into().ok()?));
    let size = |at: usize| long(at).map(|v| v as usize);
    let count = u16::from_be_bytes(woff.get(12..14)?.try_into().ok()?);
    let mut out = long(4)?.to_be_bytes().to_vec();
    // Search parameters of the table directory, required by some readers.
    let halves = u16::try_from(count.checked_ilog2()?).ok()?;
    let range = 16 << halves;
    for v in [count, range, halves, (count * 16).checked_sub(range)?] {
        out.extend(v.to_be_bytes());
    }
    let mut tables = Vec::new();
    let start = out.len() + 16 * usize::from(count);
    for i in 0..usize::from(count) {
        let at = HEADER + i * ENTRY;
        let (from, packed, length) = (size(at + 4)?, size(at + 8)?, size(at + 12)?);
        let data = woff.get(from..from.checked_add(packed)?)?;
        if length > LARGEST || tables.len() + length > LARGEST {
            return None;
        }
        out.extend(woff.get(at..at + 4)?);
        for v in [long(at + 16)?, u32::try_from(start + tables.len()).ok()?, long(at + 12)?] {
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
