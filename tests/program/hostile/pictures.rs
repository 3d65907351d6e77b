//! Pictures, links, layers, masks and filters.

use super::bounded::{Folder, RECT, expect, svg};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use pathwarp_raster::{Picture, PictureFormat};
use std::io::Write as _;

/// The checksum of a chunk (PNG specification, annex D).
fn crc(chunk: &[u8]) -> u32 {
    !chunk.iter().fold(!0, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 })
    })
}

/// A chunk of a PNG.
pub fn chunk(kind: &[u8], data: &[u8]) -> Vec<u8> {
    let content = [kind, data].concat();
    [&u32::try_from(data.len()).unwrap().to_be_bytes()[..], &content, &crc(&content).to_be_bytes()].concat()
}

/// A PNG in greys.
pub fn png(width: u32, height: u32, pixels: &[Vec<u8>]) -> Vec<u8> {
    let header = [&width.to_be_bytes()[..], &height.to_be_bytes(), &[8, 0, 0, 0, 0]].concat();
    [b"\x89PNG\r\n\x1a\n".to_vec(), chunk(b"IHDR", &header), pixels.concat(), chunk(b"IEND", b"")].concat()
}

/// A PNG whose header announces a size, with a few bytes of pixels.
fn announcing(width: u32, height: u32) -> Vec<u8> {
    png(width, height, &[chunk(b"IDAT", &[120, 156, 3, 0])])
}

/// A PNG of one pixel with a colour profile of this many zeros.
fn with_profile(zeros: usize) -> Vec<u8> {
    let mut zlib = ZlibEncoder::new(Vec::new(), Compression::fast());
    (0..zeros >> 20).for_each(|_| zlib.write_all(&[0; 1 << 20]).unwrap());
    let content = [&b"iCCPname\0\0"[..], &zlib.finish().unwrap()].concat();
    let length = u32::try_from(content.len() - 4).unwrap().to_be_bytes();
    let mut png = resvg::tiny_skia::Pixmap::new(1, 1).unwrap().encode_png().unwrap();
    // After the signature and the header.
    png.splice(33..33, [&length[..], &content, &crc(&content).to_be_bytes()].concat());
    png
}

const IMAGE: &str = "<image width='80' height='80' href='p.png'/>";

#[test]
fn sizes_are_refused_before_decoding() {
    for (width, height) in [(60_000, 60_000), (1 << 28, 1), (1, 1 << 28), (u32::MAX >> 1, u32::MAX >> 1)] {
        let png = announcing(width, height);
        let folder = Folder::with(&[("p.png", &png), ("a.svg", &svg(IMAGE))]);
        folder.expect("a.svg", [3, 3], "pixels");
        let (code, said) = folder.run(&["swirl", "p.png", "-o", "o.png"]);
        assert_eq!((code, said.contains("pixels")), (3, true), "{said}");
    }
}

#[test]
fn damaged_bitmaps_are_reported() {
    let without_pixels = announcing(3, 3);
    let mut flipped = resvg::tiny_skia::Pixmap::new(30, 30).unwrap().encode_png().unwrap();
    // Within the pixels, after the signature, the header, and the head of their chunk.
    flipped[33 + 8 + 9] ^= 0x10;
    let junk = &b"\x89PNG\r\n\x1a\njunk, junk, junk, junk, junk"[..];
    for damaged in [junk, b"\x89PN", &without_pixels[..20], &without_pixels, &flipped] {
        let folder = Folder::with(&[("p.png", damaged), ("a.svg", &svg(&format!("{IMAGE}{RECT}")))]);
        for args in [
            &["swirl", "a.svg", "-o", "o.svg"][..],
            &["render", "a.svg", "-o", "o.png"],
            &["convert", "a.svg", "-o", "o.pdf"],
        ] {
            let (code, said) = folder.run(args);
            assert_eq!(code, 1, "{args:?}: {said}");
            assert!(said.contains(if args[0] == "swirl" { "image at 1:" } else { "p.png" }), "{args:?}: {said}");
        }
    }
}

#[test]
fn linked_and_nested_drawings_are_counted_together() {
    let inner = svg(&"<rect width='50' height='30'/><circle r='9'/>".repeat(2000));
    let links = "<image width='90' height='90' href='in.svg'/>".repeat(500);
    Folder::with(&[("in.svg", &inner), ("a.svg", &svg(&links))]).ample().expect("a.svg", [3, 3], "elements");
    let own = svg(&format!("<image width='90' height='90' href='a.svg'/>{RECT}"));
    Folder::with(&[("a.svg", &own)]).run_all("a.svg");
}

#[test]
fn layers_masks_and_filters_are_drawn_within_bounds() {
    let large = |body: &str| {
        let text =
            String::from_utf8(svg(body)).unwrap().replace("width='100' height='100'>", "width='4000' height='4000'>");
        Folder::with(&[("a.svg", text.as_bytes())])
    };
    let masks: String =
        (1..30).map(|i| format!("<mask id='m{i}'><g mask='url(#m{})'>{RECT}</g></mask>", i - 1)).collect();
    large(&format!("<mask id='m0'>{RECT}</mask>{masks}<g mask='url(#m29)'>{RECT}</g>")).expect(
        "a.svg",
        [0, 3],
        "the limit",
    );
    for filter in [
        "<feTurbulence numOctaves='20' baseFrequency='.1'/>",
        "<feTurbulence numOctaves='1000000' baseFrequency='.1'/>",
        "<feMorphology operator='dilate' radius='40'/>",
        "<feGaussianBlur stdDeviation='1000'/><feGaussianBlur stdDeviation='1000'/>",
        &"<feDiffuseLighting><feDistantLight azimuth='9'/></feDiffuseLighting>".repeat(100),
        &format!("<feConvolveMatrix order='100' kernelMatrix='{}'/>", "1 ".repeat(10_000)),
    ] {
        let body = format!(
            "<filter id='f' x='-9' y='-9' width='20' height='20'>{filter}</filter><g filter='url(#f)'>{RECT}</g>"
        );
        let all = large(&body).run_all("a.svg");
        assert_eq!(all[3].0, 3, "{filter}: {}", all[3].1);
    }
    let tile = "<pattern id='p' width='1e5' height='1e5' patternUnits='userSpaceOnUse'><circle r='1'/></pattern>";
    expect(&format!("{tile}<rect width='90' height='90' fill='url(#p)'/>"), [0, 3], "work");
    expect("<path d='M0 0H100' stroke='red' stroke-dasharray='1e-6'/>", [0, 3], "work");
    let folder = Folder::with(&[("a.svg", &svg(RECT))]);
    assert_eq!(folder.run(&["render", "a.svg", "-o", "o.png", "--width", "100000"]).0, 3);
    assert_eq!(folder.run(&["render", "a.svg", "-o", "o.png", "--width", "3000"]).0, 0);
}

#[test]
fn packed_profiles_are_counted() {
    let folder = Folder::with(&[("p.png", &with_profile(300 << 20)), ("a.svg", &svg(IMAGE))]);
    folder.expect("a.svg", [3, 3], "bytes");
    assert_eq!(folder.run(&["swirl", "p.png", "-o", "o.png"]).0, 0, "the picture itself is small");
    // Thirty together.
    Folder::with(&[("p.png", &with_profile(3 << 20)), ("a.svg", &svg(&IMAGE.repeat(30)))]).expect(
        "a.svg",
        [3, 3],
        "bytes",
    );
    Folder::with(&[("p.png", &with_profile(1 << 20)), ("a.svg", &svg(IMAGE))]).expect("a.svg", [0, 0], "");
}

/// A WebP of one pixel whose profile, at the end of the file, has an announced size of two gigabytes.
#[test]
fn profiles_longer_than_the_file_are_not_held() {
    let picture = Picture::from(resvg::tiny_skia::Pixmap::new(1, 1).unwrap());
    let plain = picture.write(PictureFormat::WebP).unwrap();
    let size = [0x20, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    let chunks = [b"WEBPVP8X\x0a\0\0\0", &size[..], &plain[12..], b"ICCP\xfe\xff\xff\x7fprofile "].concat();
    let webp = [b"RIFF", &u32::try_from(chunks.len()).unwrap().to_le_bytes()[..], &chunks].concat();
    let folder = Folder::with(&[("p.webp", &webp), ("a.svg", &svg(&IMAGE.replace("png", "webp")))]);
    assert_eq!(folder.run(&["swirl", "p.webp", "-o", "o.png"]).0, 0);
    folder.run_all("a.svg");
}

/// A page of one pixel, and a frame of 65,535 × 65,535.
#[test]
fn frames_larger_than_their_page_are_not_held() {
    let gif = b"GIF89a\x01\0\x01\0\x80\0\0\0\0\0\xff\xff\xff,\0\0\0\0\xff\xff\xff\xff\0\x02\x02\x4c\x01\0;";
    let folder = Folder::with(&[("p.png", gif), ("a.svg", &svg(&format!("{IMAGE}{RECT}")))]);
    folder.expect("a.svg", [1, 1], "p.png");
    assert_eq!(folder.run(&["convert", "a.svg", "-o", "o.pdf"]).0, 1);
}

#[test]
fn pictures_are_counted_before_each_is_decoded() {
    let png = resvg::tiny_skia::Pixmap::new(3000, 3000).unwrap().encode_png().unwrap();
    let folder = Folder::with(&[("p.png", &png), ("a.svg", &svg(&IMAGE.repeat(60)))]);
    let all = folder.run_all("a.svg");
    assert!(all[0].0 == 3 && all[0].1.contains("--limit pixels="), "{}", all[0].1);
    folder.run(&["swirl", "a.svg", "-o", "o.pdf"]);
    // A strip, most of whose pixels have no point in the source.
    let strip = resvg::tiny_skia::Pixmap::new(1, 65_535).unwrap().encode_png().unwrap();
    let folder = Folder::with(&[("p.png", &strip), ("a.svg", &svg(IMAGE))]);
    folder.run(&["warp", "p.png", "--style", "flag", "-o", "o.jpg"]);
    folder.run_all("a.svg");
}
