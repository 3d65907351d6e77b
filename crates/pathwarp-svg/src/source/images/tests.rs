use crate::source::images::*;
use std::io::Write as _;

fn chunk(name: &[u8], content: &[u8]) -> Vec<u8> {
    let length = u32::try_from(content.len()).unwrap().to_be_bytes();
    let mut sum = Crc::new();
    sum.update(name);
    sum.update(content);
    [&length, name, content, &sum.sum().to_be_bytes()].concat()
}

#[test]
fn profiles_are_unpacked_up_to_the_limit() {
    let mut zlib = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    zlib.write_all(&[7; 5000]).unwrap();
    let profile = chunk(b"iCCP", &[&b"name\0\0"[..], &zlib.finish().unwrap()].concat());
    let png = |chunks: &[Vec<u8>]| [SIGNATURE, &chunks.concat()].concat();
    let header = chunk(b"IHDR", &[0; 13]);
    let with = png(&[header.clone(), profile.clone()]);
    assert_eq!([unpacked_profile(&with, 9000), unpacked_profile(&with, 100)], [5000, 101]);
    // Of a damaged profile, what can be unpacked; after the pixels, decoders look for none.
    assert!(unpacked_profile(&with[..with.len() - 9], 9000) <= 5000);
    assert_eq!(unpacked_profile(&png(&[header, chunk(b"IDAT", b"x"), profile]), 9000), 0);
    assert_eq!(unpacked_profile(b"GIF89a", 9000), 0);
}

#[test]
fn missing_and_damaged_pixels_are_noticed() {
    let packed = |pixels: &[u8]| {
        let mut zlib = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        zlib.write_all(pixels).unwrap();
        zlib.finish().unwrap()
    };
    // Three rows of two pixels in red, green and blue, each after its filter.
    let header = chunk(b"IHDR", &[0, 0, 0, 2, 0, 0, 0, 3, 8, 2, 0, 0, 0]);
    let png = |pixels: &[u8]| [SIGNATURE, &header, &chunk(b"IDAT", pixels)].concat();
    let good = png(&packed(&[0; 21]));
    let cut = [0, 1, CHECKSUM + 1].map(|n| is_unreadable(&good[..good.len() - n]));
    assert_eq!(cut, [false, true, true]);
    assert!(is_unreadable(&png(&packed(&[0; 9]))) && is_unreadable(&png(b"no pixels")) && is_unreadable(&png(b"")));
    for at in SIGNATURE.len() + HEAD..good.len() {
        // Lengths, and the names by which chunks are known.
        let is_frame = (SIGNATURE.len() + header.len()..).take(HEAD).any(|i| i == at);
        let mut bytes = good.clone();
        bytes[at] ^= 0x10;
        assert!(is_frame || is_unreadable(&bytes), "{at}");
    }
    let indexed = |colors: &[u8]| {
        let header = chunk(b"IHDR", &[0, 0, 0, 1, 0, 0, 0, 1, 8, 3, 0, 0, 0]);
        is_unreadable(&[SIGNATURE, &header, &chunk(b"PLTE", colors), &chunk(b"IDAT", &packed(&[0; 2]))].concat())
    };
    assert_eq!([6, 5, 4].map(|n| indexed(&[9; 6][..n])), [false, true, true]);
    let gif = |page: [u8; 2], frame: [u8; 2]| {
        let comment = b"!\xfe\x02hi\0";
        let frame = [b',', 0, 0, 0, 0, frame[0], 0, frame[1], 0, 0];
        [b"GIF89a", &[page[0], 0, page[1], 0, 0x80, 0, 0][..], &[0; 6], comment, &frame].concat()
    };
    let found = [([3, 3], [3, 3]), ([3, 3], [1, 2]), ([3, 3], [3, 4])].map(|(p, f)| is_unreadable(&gif(p, f)));
    assert_eq!(found, [false, false, true]);
    assert!((0..30).all(|n| !is_unreadable(&gif([3, 3], [2, 2])[..n.min(29)])));
}
