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
