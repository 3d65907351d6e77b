//! JPEG and WebP, from drawings and from pictures.

use crate::support::{expect_code, pathwarp_in, sample};
use pathwarp_oracle::difference;
use pathwarp_raster::{Picture, decode_png};
use std::fs;

#[test]
fn drawings_are_rendered_in_every_format() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name).display().to_string();
    let logo = sample("logo.svg").display().to_string();
    for name in ["a.png", "a.webp", "a.jpg", "small.jpeg"] {
        let quality: &[&str] = if name.starts_with("small") { &["--quality", "20"] } else { &[] };
        expect_code(0, &[&["render", &logo, "-o", &at(name), "--width", "500"], quality].concat());
    }
    let read = |name: &str| Picture::read(&fs::read(at(name)).unwrap()).unwrap().pixmap;
    let png = decode_png(&fs::read(at("a.png")).unwrap()).unwrap();
    // WebP loses nothing except the colour of nearly transparent pixels.
    assert!(difference(&png, &read("a.webp")).most() <= 1);
    let jpeg = read("a.jpg");
    let corner = jpeg.pixel(0, 0).unwrap();
    assert!(png.pixel(0, 0).unwrap().alpha() == 0 && corner.red() > 250 && corner.alpha() == 255, "white paper");
    let size = |name: &str| fs::metadata(at(name)).unwrap().len();
    assert!(size("small.jpeg") < size("a.jpg"));

    // A picture can have any background; a JPEG must have one.
    expect_code(0, &["render", &logo, "-o", &at("b.jpg"), "--background", "#ff8000", "--quality", "100"]);
    let b = read("b.jpg").pixel(1, 1).unwrap();
    assert!(b.red() > 250 && b.green().abs_diff(128) < 4 && b.blue() < 5, "{b:?}");
    let (_, said) = expect_code(2, &["render", &logo, "-o", &at("c.jpg"), "--background", "none"]);
    assert!(said.contains("a JPEG has no transparency"), "{said}");
    let (_, said) = expect_code(2, &["render", &logo, "--background", "reddish"]);
    assert!(said.contains("is not a colour"), "{said}");
}

#[test]
fn pictures_and_previews_follow_their_extension() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name).display().to_string();
    let logo = sample("logo.svg").display().to_string();
    expect_code(0, &["render", &logo, "-o", &at("a.webp"), "--background", "white"]);
    for (name, magic) in [("b.webp", &b"RIFF"[..]), ("b.jpg", b"\xff\xd8\xff"), ("b.png", b"\x89PNG")] {
        expect_code(0, &["swirl", &at("a.webp"), "-o", &at(name)]);
        assert!(fs::read(at(name)).unwrap().starts_with(magic), "{name}");
        let preview = format!("preview-{name}");
        expect_code(0, &["swirl", &logo, "-o", &at("c.svg"), "-q", "--preview", &at(&preview)]);
        assert!(fs::read(at(&preview)).unwrap().starts_with(magic), "{preview}");
    }
    let out = pathwarp_in(dir.path(), &["swirl", "a.webp", "--format", "webp"], b"");
    assert_eq!(out.stdout, fs::read(at("b.webp")).unwrap());
    expect_code(0, &["gallery", &logo, "-o", &at("sheet.jpg"), "--cell", "60x50"]);
    assert!(fs::read(at("sheet.jpg")).unwrap().starts_with(b"\xff\xd8\xff"));
}
