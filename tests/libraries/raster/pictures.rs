//! Checks that pictures of every kind are read as other programs read them.
//!
//! The files in `pictures/` have 16 × 16 pixels in four tiles. They and the expected colours were written by Pillow 13 (libjpeg-turbo,
//! libwebp, zlib).

use crate::support::root;
use flate2::{Compression, Crc, write::ZlibEncoder};
use pathwarp_raster::{Error, Picture, PictureFormat, Pixmap, header_size};
use resvg::tiny_skia::PremultipliedColorU8;
use std::fs;
use std::io::Write;

type Rgba = [u8; 4];

const TILES: [Rgba; 4] = [[200, 30, 40, 255], [40, 180, 60, 255], [30, 60, 190, 255], [120, 120, 120, 255]];
const TRANSLUCENT: [Rgba; 4] = [[200, 30, 40, 255], [40, 180, 60, 200], [30, 60, 190, 100], [0, 0, 0, 0]];

fn file(name: &str) -> Vec<u8> {
    fs::read(root().join("tests/libraries/raster/pictures").join(name)).unwrap()
}

/// Returns all pixels, with straight alpha.
fn pixels(pixmap: &Pixmap) -> Vec<Rgba> {
    let straight = pixmap.pixels().iter().map(PremultipliedColorU8::demultiply);
    straight.map(|c| [c.red(), c.green(), c.blue(), c.alpha()]).collect()
}

/// Returns the pixels of a picture of four tiles, row by row.
fn tiled(tiles: &[Rgba; 4]) -> Vec<Rgba> {
    (0..256).map(|i| tiles[i / 128 * 2 + i % 16 / 8]).collect()
}

/// Asserts that no sample is off by more than `tolerance`.
fn assert_near(seen: &[Rgba], expected: &[Rgba], tolerance: u8, name: &str) {
    assert_eq!(seen.len(), expected.len(), "{name}");
    for (i, (a, b)) in seen.iter().zip(expected).enumerate() {
        assert!(a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= tolerance), "{name}, pixel {i}: {a:?} for {b:?}");
    }
}

/// Reads a file both ways and compares its pixels.
fn check(name: &str, tiles: &[Rgba; 4], tolerance: u8) {
    check_at(name, tiles, tolerance, |_| true);
}

fn check_at(name: &str, tiles: &[Rgba; 4], tolerance: u8, at: fn(usize) -> bool) {
    let bytes = file(name);
    assert_eq!(header_size(&bytes).unwrap(), (16, 16));
    let some = |all: Vec<Rgba>| all.into_iter().enumerate().filter(|(i, _)| at(*i)).map(|(_, p)| p).collect::<Vec<_>>();
    for read in [Picture::read, Picture::read_stored] {
        let seen = pixels(&read(&bytes).unwrap().pixmap);
        assert_eq!(seen.len(), 256);
        assert_near(&some(seen), &some(tiled(tiles)), tolerance, name);
    }
}

fn grey(values: [u8; 4]) -> [Rgba; 4] {
    values.map(|v| [v, v, v, 255])
}

#[test]
fn jpegs_of_every_colour_space() {
    check("ycbcr.jpg", &TILES, 1);
    check("progressive.jpg", &TILES, 1);
    check("rgb.jpg", &TILES, 1);
    check("grey.jpg", &grey([82, 124, 66, 120]), 1);
    check("cmyk.jpg", &[[176, 26, 35, 255], [35, 159, 53, 255], [26, 53, 168, 255], [106, 106, 106, 255]], 1);
    check("ycck.jpg", &[[44, 177, 170, 255], [170, 59, 155, 255], [177, 154, 52, 255], [106, 106, 106, 255]], 1);
}

#[test]
fn webps_of_every_kind() {
    check("lossless.webp", &TILES, 0);
    check("lossless-alpha.webp", &TRANSLUCENT, 1);
    // Colour is stored at half the resolution, so it mixes at the edges of tiles.
    let inside = |i: usize| (i % 8).abs_diff(4) < 3 && (i / 16 % 8).abs_diff(4) < 3;
    check_at("lossy.webp", &TILES, 2, inside);
    check_at("lossy-alpha.webp", &TRANSLUCENT, 3, inside);
    check("animated.webp", &TRANSLUCENT, 1);
}

/// Appends a chunk of a WebP; the content must have an even size.
fn riff(out: &mut Vec<u8>, name: &[u8; 4], content: &[u8]) {
    out.extend(name);
    out.extend(u32::try_from(content.len()).unwrap().to_le_bytes());
    out.extend(content);
}

/// Reads `lossy-alpha.webp` as the only frame of an animation, with a wrong height, at which the decoder itself would panic.
#[test]
fn frames_of_webps_are_as_large_as_they_say() {
    let still = file("lossy-alpha.webp");
    // The chunks with the size come before those with the pixels.
    let parts = &still[still.windows(4).position(|name| name == b"ALPH").unwrap()..];
    let animation = |height: u8| {
        let mut frame = [[0; 6].as_slice(), &[15, 0, 0, height - 1, 0, 0], &[50, 0, 0, 2]].concat();
        frame.extend(parts);
        let mut chunks = b"WEBP".to_vec();
        riff(&mut chunks, b"VP8X", &[0x12, 0, 0, 0, 15, 0, 0, 15, 0, 0]);
        riff(&mut chunks, b"ANIM", &[0; 6]);
        riff(&mut chunks, b"ANMF", &frame);
        let mut out = Vec::new();
        riff(&mut out, b"RIFF", &chunks);
        out
    };
    let still = Picture::read(&still).unwrap();
    assert_eq!(Picture::read(&animation(16)).unwrap(), still);
    for height in [1, 8, 15] {
        assert_eq!(header_size(&animation(height)), Ok((16, 16)));
        assert!(matches!(Picture::read(&animation(height)), Err(Error::Decode(_))), "{height}");
    }
}

/// Chunks that announce more bytes than the file has are ignored.
#[test]
fn metadata_cut_short_are_left_out() {
    let still = file("lossy-alpha.webp");
    for name in [b"ICCP", b"EXIF"] {
        let mut cut = still.clone();
        cut.extend(name);
        cut.extend([0xfe, 0xff, 0xff, 0x7f, 1, 2, 3, 4]);
        let riff = u32::try_from(cut.len() - 8).unwrap();
        cut[4..8].copy_from_slice(&riff.to_le_bytes());
        assert_eq!(Picture::read(&cut).unwrap(), Picture::read(&still).unwrap());
    }
}

#[test]
fn pngs_with_animations_are_their_default_image() {
    check("animated.png", &TILES, 0);
    check("default-image.png", &TILES, 0);
}

/// Orientation 6: the first row is the right side, so pixels stored on the left are at the top.
#[test]
fn orientation_is_found_in_every_format() {
    let [a, b, c, d] = TILES;
    for name in ["turned.jpg", "turned.png", "turned.webp"] {
        let upright = Picture::read(&file(name)).unwrap().pixmap;
        assert_near(&pixels(&upright), &tiled(&[c, a, d, b]), 1, name);
        let stored = Picture::read_stored(&file(name)).unwrap().pixmap;
        assert_near(&pixels(&stored), &tiled(&TILES), 1, name);
    }
}

/// Appends a chunk of a PNG.
fn chunk(out: &mut Vec<u8>, name: &[u8; 4], content: &[u8]) {
    let mut crc = Crc::new();
    crc.update(name);
    crc.update(content);
    out.extend(u32::try_from(content.len()).unwrap().to_be_bytes());
    out.extend([&name[..], content, &crc.sum().to_be_bytes()].concat());
}

/// Encodes a PNG from its rows, each preceded by the number of its filter.
fn png(
    [width, height]: [u32; 2],
    depth: u8,
    color: u8,
    is_interlaced: bool,
    extra: &[(&[u8; 4], &[u8])],
    rows: &[u8],
) -> Vec<u8> {
    let mut out = b"\x89PNG\r\n\x1a\n".to_vec();
    let rest = [depth, color, 0, 0, u8::from(is_interlaced)];
    chunk(&mut out, b"IHDR", &[&width.to_be_bytes()[..], &height.to_be_bytes(), &rest].concat());
    for (name, content) in extra {
        chunk(&mut out, name, content);
    }
    let mut zlib = ZlibEncoder::new(Vec::new(), Compression::fast());
    zlib.write_all(rows).unwrap();
    chunk(&mut out, b"IDAT", &zlib.finish().unwrap());
    chunk(&mut out, b"IEND", b"");
    out
}

/// Returns the pixels of a PNG of one row.
fn row(width: u32, depth: u8, color: u8, extra: &[(&[u8; 4], &[u8])], samples: &[u8]) -> Vec<Rgba> {
    let bytes = png([width, 1], depth, color, false, extra, &[&[0], samples].concat());
    pixels(&Picture::read(&bytes).unwrap().pixmap)
}

#[test]
fn pngs_of_every_colour_type_and_depth() {
    let opaque = |values: &[u8]| values.iter().map(|v| [*v, *v, *v, 255]).collect::<Vec<_>>();
    assert_eq!(row(4, 1, 0, &[], &[0b0110_0000]), opaque(&[0, 255, 255, 0]));
    assert_eq!(row(4, 2, 0, &[], &[0b0001_1011]), opaque(&[0, 85, 170, 255]));
    assert_eq!(row(3, 4, 0, &[], &[0x07, 0xf0]), opaque(&[0, 119, 255]));
    assert_eq!(row(3, 8, 0, &[], &[0, 77, 255]), opaque(&[0, 77, 255]));
    assert_eq!(row(2, 8, 2, &[], &[1, 2, 3, 250, 251, 252]), [[1, 2, 3, 255], [250, 251, 252, 255]]);
    assert_eq!(row(2, 8, 4, &[], &[9, 255, 200, 0]), [[9, 9, 9, 255], [0, 0, 0, 0]]);
    assert_eq!(row(2, 8, 6, &[], &[255, 0, 255, 128, 7, 8, 9, 255]), [[255, 0, 255, 128], [7, 8, 9, 255]]);
    assert_eq!(row(1, 16, 2, &[], &[1, 0, 2, 0, 3, 0]), [[1, 2, 3, 255]]);
    assert_eq!(row(1, 16, 4, &[], &[255, 255, 0x80, 0x80]), [[255, 255, 255, 128]]);
    assert_eq!(row(1, 16, 6, &[], &[1, 1, 2, 2, 3, 3, 255, 255]), [[1, 2, 3, 255]]);
}

/// Each of 65,536 levels becomes the nearest of 256.
#[test]
fn sixteen_bits_are_rounded() {
    let samples: Vec<u8> = (0..=u16::MAX).flat_map(u16::to_be_bytes).collect();
    let rows: Vec<u8> = samples.chunks(512).flat_map(|row| [&[0], row].concat()).collect();
    let seen = pixels(&Picture::read(&png([256, 256], 16, 0, false, &[], &rows)).unwrap().pixmap);
    for (v, pixel) in (0..=u16::MAX).zip(seen) {
        let nearest = (f64::from(v) / 65535.0 * 255.0).round() as u8;
        assert_eq!(pixel, [nearest, nearest, nearest, 255], "{v}");
    }
}

#[test]
fn palettes_and_transparent_colours_of_pngs() {
    let palette: &[u8] = &[255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255];
    let colors: [Rgba; 4] = [[255, 0, 0, 0], [0, 255, 0, 128], [0, 0, 255, 255], [255, 255, 255, 255]];
    let mut shown = colors;
    // With premultiplied alpha, transparent pixels are black.
    shown[0] = [0; 4];
    let extra: [(&[u8; 4], &[u8]); 2] = [(b"PLTE", palette), (b"tRNS", &[0, 128])];
    assert_eq!(row(4, 2, 3, &extra, &[0b0001_1011]), shown);
    assert_eq!(row(4, 4, 3, &extra, &[0x01, 0x23]), shown);
    assert_eq!(row(4, 8, 3, &extra, &[0, 1, 2, 3]), shown);
    assert_eq!(row(2, 1, 3, &extra, &[0b0100_0000]), shown[..2]);
    assert_eq!(row(2, 8, 0, &[(b"tRNS", &[0, 7])], &[7, 8]), [[0; 4], [8, 8, 8, 255]]);
    assert_eq!(row(2, 8, 2, &[(b"tRNS", &[0, 1, 0, 2, 0, 3])], &[1, 2, 3, 1, 2, 4]), [[0; 4], [1, 2, 4, 255]]);
    assert_eq!(row(2, 16, 0, &[(b"tRNS", &[1, 2])], &[1, 2, 1, 3]), [[0; 4], [1, 1, 1, 255]]);
}

/// At such palettes, the decoder itself would panic.
#[test]
fn palettes_that_end_within_a_colour_are_errors() {
    for length in [3, 4, 5, 6] {
        let bytes = png([1, 1], 8, 3, false, &[(b"PLTE", &[9, 8, 7, 6, 5, 4][..length])], &[0, 0]);
        assert_eq!(header_size(&bytes), Ok((1, 1)), "{length}");
        match Picture::read(&bytes) {
            Ok(picture) => assert_eq!((length % 3, pixels(&picture.pixmap)), (0, vec![[9, 8, 7, 255]])),
            Err(e) => assert!(length % 3 != 0 && matches!(e, Error::Decode(_)), "{length}"),
        }
    }
}

/// Adam7: of 2 × 2 pixels, the first pass holds the first pixel, the sixth the second one, and the seventh the second row.
#[test]
fn interlaced_pngs() {
    let bytes = png([2, 2], 8, 0, true, &[], &[0, 10, 0, 20, 0, 30, 40]);
    assert_eq!(pixels(&Picture::read(&bytes).unwrap().pixmap), grey([10, 20, 30, 40]));
}

/// Returns a GIF with a page of 4 × 3 pixels and a frame that repeats the colours 0, 1, 2, 3, of which 2 is transparent.
fn gif(frame: [u16; 4], is_interlaced: bool) -> Vec<u8> {
    let mut out = b"GIF89a\x04\0\x03\0\x81\0\0".to_vec();
    out.extend([255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255]);
    out.extend(b"!\xf9\x04\x01\0\0\x02\0,");
    out.extend(frame.iter().flat_map(|n| n.to_le_bytes()));
    out.extend([if is_interlaced { 0x40 } else { 0 }, 2]);
    // Codes of three bits: 4 clears the table, 5 ends. The table is cleared before every colour, so it never grows.
    let colors = (0..u32::from(frame[2]) * u32::from(frame[3])).flat_map(|i| [4, i % 4]);
    let bits: Vec<bool> = colors.chain([5]).flat_map(|code| [code & 1 != 0, code & 2 != 0, code & 4 != 0]).collect();
    let data: Vec<u8> =
        bits.chunks(8).map(|b| b.iter().rev().fold(0, |byte, bit| byte << 1 | u8::from(*bit))).collect();
    for block in data.chunks(255) {
        out.push(u8::try_from(block.len()).unwrap());
        out.extend(block);
    }
    out.extend([0, b';']);
    out
}

#[test]
fn frames_of_gifs_have_their_place() {
    let shown = |frame, is_interlaced| {
        let bytes = gif(frame, is_interlaced);
        assert_eq!(header_size(&bytes).unwrap(), (4, 3));
        assert!(matches!(Picture::read(&bytes), Err(Error::Decode(_))), "a photograph is no GIF");
        let letter = |c: &Rgba| match c {
            [255, 0, 0, 255] => 'r',
            [0, 255, 0, 255] => 'g',
            [255, 255, 255, 255] => 'w',
            [0, 0, 0, 0] => '.',
            other => panic!("{other:?}"),
        };
        let pixels = pixels(&Picture::read_stored(&bytes).unwrap().pixmap);
        pixels.chunks(4).map(|row| row.iter().map(letter).collect::<String>()).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(shown([0, 0, 4, 3], false), "rg.w rg.w rg.w");
    assert_eq!(shown([0, 1, 4, 2], false), ".... rg.w rg.w");
    assert_eq!(shown([1, 1, 2, 2], false), ".... .rg. ..w.");
    // Frames larger than the page, beyond a corner, and outside.
    assert_eq!(shown([0, 0, 5, 4], false), "rg.w g.wr .wrg");
    assert_eq!(shown([2, 2, 4, 3], false), ".... .... ..rg");
    assert_eq!(shown([4, 0, 2, 2], false), ".... .... ....");
    assert_eq!(shown([0, 3, 2, 2], false), ".... .... ....");
    // Rows 0 and 2, then row 1.
    assert_eq!(shown([0, 0, 3, 3], true), "rg.. .wr. wrg.");
    for none in [[0, 0, 0, 3], [0, 0, 3, 0], [0, 0, 0, 0]] {
        assert!(matches!(Picture::read_stored(&gif(none, false)), Err(Error::Decode(_))));
    }
}

/// Stripes one pixel wide keep their colours, since colours are not averaged before they are packed.
#[test]
fn jpegs_are_as_fine_in_colour_as_in_brightness() {
    let mut pixmap = Pixmap::new(16, 16).unwrap();
    for (i, p) in pixmap.data_mut().chunks_exact_mut(4).enumerate() {
        p.copy_from_slice(if i % 2 == 0 { &[200, 60, 60, 255] } else { &[60, 60, 200, 255] });
    }
    let expected = pixels(&pixmap);
    let picture = Picture::from(pixmap);
    for quality in [80, 100] {
        let back = Picture::read(&picture.write(PictureFormat::Jpeg { quality }).unwrap()).unwrap();
        assert_near(&pixels(&back.pixmap), &expected, if quality == 100 { 3 } else { 25 }, &quality.to_string());
    }
}

#[test]
fn profiles_survive_in_every_format() {
    let mut profile = b"\0\0\0\0 of more than a segment of a JPEG".to_vec();
    profile.extend((0..150_000_u32).flat_map(|i| i.wrapping_mul(i).to_be_bytes()));
    let picture = Picture { profile: Some(profile.clone()), ..Picture::from(Pixmap::new(3, 2).unwrap()) };
    for format in [PictureFormat::Png, PictureFormat::Jpeg { quality: 50 }, PictureFormat::WebP] {
        assert!(
            Picture::read(&picture.write(format).unwrap()).unwrap().profile.as_ref() == Some(&profile),
            "{format:?}"
        );
    }
}

#[test]
fn sides_that_a_format_does_not_have_are_errors() {
    let long = Picture::from(Pixmap::new(65_536, 1).unwrap());
    for format in [PictureFormat::Jpeg { quality: 50 }, PictureFormat::WebP] {
        assert!(matches!(long.write(format), Err(Error::Encode(_))), "{format:?}");
    }
    assert!(long.write(PictureFormat::Png).is_ok());
}
