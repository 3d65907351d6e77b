//! Decodes the bytes of an XML file to UTF-8: UTF-16, and what the XML declaration names.

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE};
use std::borrow::Cow;
use std::ops::Range;

/// Bytes of the file among which the XML declaration must end.
const DECLARATION: usize = 256;

/// Decodes `bytes`. In the text of another encoding than UTF-8, the declaration names UTF-8.
///
/// # Errors
/// The position of the first byte that is wrong, and what is wrong with it.
pub(super) fn decoded(bytes: Cow<'_, [u8]>) -> Result<String, (usize, String)> {
    let Some(encoding) = foreign_encoding(&bytes)? else {
        return String::from_utf8(bytes.into_owned()).map_err(|e| {
            let hint = "this is not UTF-8 text, and no XML declaration names another encoding; save it as UTF-8";
            (e.utf8_error().valid_up_to(), hint.to_owned())
        });
    };
    let (text, malformed) = encoding.decode_with_bom_removal(&bytes);
    if malformed {
        return Err((
            malformed_at(encoding, &bytes),
            format!("this is not {} text; save it as UTF-8", encoding.name()),
        ));
    }
    let mut text = text.into_owned();
    if let Some(name) = declared(text.as_bytes()) {
        text.replace_range(name, "UTF-8");
    }
    Ok(text)
}

/// The encoding of a file that is not UTF-8: by its first bytes, or by the XML declaration.
fn foreign_encoding(bytes: &[u8]) -> Result<Option<&'static Encoding>, (usize, String)> {
    match bytes {
        [0xff, 0xfe, ..] | [b'<', 0, ..] => return Ok(Some(UTF_16LE)),
        [0xfe, 0xff, ..] | [0, b'<', ..] => return Ok(Some(UTF_16BE)),
        _ => {}
    }
    let Some(range) = declared(bytes) else { return Ok(None) };
    let label = &bytes[range.clone()];
    let encoding = Encoding::for_label(label).ok_or_else(|| {
        (range.start, format!("the encoding `{}` is unknown; save the file as UTF-8", String::from_utf8_lossy(label)))
    })?;
    // A declaration that can be read as single bytes is not UTF-16; drawing programs have saved such files.
    Ok(Some(encoding).filter(|e| ![UTF_8, UTF_16LE, UTF_16BE].contains(e)))
}

/// The place of the encoding's name in the XML declaration.
fn declared(bytes: &[u8]) -> Option<Range<usize>> {
    let head = &bytes[..bytes.len().min(DECLARATION)];
    let start = head.strip_prefix(b"\xef\xbb\xbf").map_or(0, |_| 3);
    let end = start + memchr::memmem::find(head.get(start..)?.strip_prefix(b"<?xml")?, b"?>")? + 5;
    let key = start + memchr::memmem::find(&head[start..end], b"encoding")? + b"encoding".len();
    let rest = &head[key..end];
    let open = rest.iter().position(|b| matches!(b, b'"' | b'\''))?;
    if rest[..open].iter().any(|b| !b.is_ascii_whitespace() && *b != b'=') {
        return None;
    }
    let length = rest[open + 1..].iter().position(|b| *b == rest[open])?;
    Some(key + open + 1..key + open + 1 + length)
}

/// The position of the first malformed byte.
fn malformed_at(encoding: &'static Encoding, bytes: &[u8]) -> usize {
    let mut decoder = encoding.new_decoder_with_bom_removal();
    let mut out = String::with_capacity(decoder.max_utf8_buffer_length(bytes.len()).unwrap_or_default());
    decoder.decode_to_string_without_replacement(bytes, &mut out, true).1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<String, (usize, String)> {
        decoded(Cow::Borrowed(bytes))
    }

    fn utf16(text: &str, unit: fn(u16) -> [u8; 2]) -> Vec<u8> {
        text.encode_utf16().flat_map(unit).collect()
    }

    #[test]
    fn utf16_with_and_without_a_mark() {
        let (source, mended) =
            ("<?xml version='1.0' encoding='UTF-16'?><t>ä€𝔘</t>", "<?xml version='1.0' encoding='UTF-8'?><t>ä€𝔘</t>");
        for unit in [u16::to_le_bytes, u16::to_be_bytes] {
            for mark in ["\u{feff}", ""] {
                assert_eq!(read(&utf16(&format!("{mark}{source}"), unit)).unwrap(), mended);
            }
        }
        // Half a pair.
        let mut broken = utf16("<t>", u16::to_le_bytes);
        broken.extend([0x35, 0xd8, b'<', 0]);
        let (at, what) = read(&broken).unwrap_err();
        assert!(at >= 6 && what.contains("UTF-16LE"), "{at} {what}");
    }

    #[test]
    fn the_declared_encoding_is_read() {
        for (label, byte, letter) in
            [("ISO-8859-1", 0xe4, 'ä'), ("windows-1251", 0xc6, 'Ж'), ("iso-8859-15", 0xa4, '€'), ("KOI8-R", 0xf6, 'Ж')]
        {
            for quote in ['"', '\''] {
                let mut source = format!("<?xml version=\"1.0\"  encoding = {quote}{label}{quote} ?><t>").into_bytes();
                source.extend([byte, b'<', b'/', b't', b'>']);
                let wanted = format!("<?xml version=\"1.0\"  encoding = {quote}UTF-8{quote} ?><t>{letter}</t>");
                assert_eq!(read(&source).unwrap(), wanted, "{label}");
            }
        }
        for text in [
            "<t>ä</t>",
            "<?xml version='1.0' encoding='utf-8'?><t>ä</t>",
            "<?xml version='1.0' encoding='UTF-16'?><t>ä</t>",
        ] {
            assert_eq!(read(text.as_bytes()).unwrap(), text);
        }
        assert!(read(b"<?xml version='1.0' encoding='klingon'?><t/>").unwrap_err().1.contains("klingon"));
        assert_eq!(read(b"<t>\xe4</t>").unwrap_err().0, 3);
    }
}
