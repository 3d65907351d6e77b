//! Photographs that are straightened, and the data that accompanies their pixels. Files are read here by the rules of their formats.

use crate::support::{expect_code, pathwarp_in, sample};
use pathwarp_raster::{Picture, PictureFormat, Pixmap};
use resvg::tiny_skia::ColorU8;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

const JPEG: PictureFormat = PictureFormat::Jpeg { quality: 95 };

/// Squares across and down the board.
const BOARD: (u8, u8) = (8, 6);

/// The homography (u, v) ↦ (X/W, Y/W) by which a camera sees a board of these sides, which lies on the unit square, v down.
///
/// Its focal length is in pixels; it points at the middle of a picture of this size, and the board is turned about three axes.
fn camera(
    sides: (f64, f64),
    focal: f64,
    picture: (f64, f64),
    [tilt, turn, roll]: [f64; 3],
    distance: f64,
) -> [[f64; 3]; 3] {
    let about = |[x, y, z]: [f64; 3]| {
        let (x, y) = (x * roll.cos() - y * roll.sin(), x * roll.sin() + y * roll.cos());
        let (x, z) = (x * turn.cos() - z * turn.sin(), x * turn.sin() + z * turn.cos());
        let (y, z) = (y * tilt.cos() - z * tilt.sin(), y * tilt.sin() + z * tilt.cos());
        [x, y, z]
    };
    let [across, down] = [about([sides.0, 0.0, 0.0]), about([0.0, sides.1, 0.0])];
    let corner = [0, 1, 2].map(|i| f64::from(u8::from(i == 2)) * distance - 0.5 * (across[i] + down[i]));
    let columns =
        [across, down, corner].map(|[x, y, z]| [focal * x + 0.5 * picture.0 * z, focal * y + 0.5 * picture.1 * z, z]);
    [0, 1, 2].map(|row| columns.map(|column| column[row]))
}

/// The camera that sees the board.
static CAMERA: LazyLock<[[f64; 3]; 3]> =
    LazyLock::new(|| camera((f64::from(BOARD.0), f64::from(BOARD.1)), 900.0, (640.0, 480.0), [0.6, -0.35, 0.05], 17.0));

fn corners_seen(camera: &[[f64; 3]; 3]) -> [(f64, f64); 4] {
    [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)].map(|(u, v)| {
        let [x, y, w] = camera.map(|row| row[0] * u + row[1] * v + row[2]);
        (x / w, y / w)
    })
}

/// Returns the point of the board that a pixel shows, by the adjugate of the camera's matrix.
fn on_board(x: f64, y: f64) -> (f64, f64) {
    let [[a, b, c], [d, e, f], [g, h, i]] = *CAMERA;
    let adjugate = [
        [e * i - f * h, c * h - b * i, b * f - c * e],
        [f * g - d * i, a * i - c * g, c * d - a * f],
        [d * h - e * g, b * g - a * h, a * e - b * d],
    ];
    let [u, v, w] = adjugate.map(|row| row[0] * x + row[1] * y + row[2]);
    (u / w, v / w)
}

/// Returns a different colour for every square; neighbours are far apart.
fn color(column: u8, row: u8) -> [u8; 3] {
    [30 * column, 40 * row, if (column + row).is_multiple_of(2) { 220 } else { 20 }]
}

fn painted(width: u32, height: u32, paint: impl Fn(u32, u32) -> [u8; 3]) -> Pixmap {
    let mut pixmap = Pixmap::new(width, height).unwrap();
    for (i, p) in pixmap.pixels_mut().iter_mut().enumerate() {
        let [r, g, b] = paint(i as u32 % width, i as u32 / width);
        *p = ColorU8::from_rgba(r, g, b, 255).premultiply();
    }
    pixmap
}

/// The photograph of the board on a yellow table.
fn board() -> Pixmap {
    painted(640, 480, |x, y| {
        let (u, v) = on_board(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let on_it = (0.0..1.0).contains(&u) && (0.0..1.0).contains(&v);
        if on_it { color((u * 8.0) as u8, (v * 6.0) as u8) } else { [250, 240, 60] }
    })
}

/// The corners of the board in the photograph, from its lower left over the right.
fn corners() -> [(f64, f64); 4] {
    corners_seen(&CAMERA)
}

fn run(folder: &Path, args: &[&str]) -> (i32, String) {
    let output = pathwarp_in(folder, args, b"");
    (output.status.code().unwrap(), String::from_utf8_lossy(&output.stderr).into_owned())
}

fn read(file: impl AsRef<Path>) -> Picture {
    Picture::read(&fs::read(file).unwrap()).unwrap()
}

fn size(file: impl AsRef<Path>) -> (u32, u32) {
    let pixmap = read(file).pixmap;
    (pixmap.width(), pixmap.height())
}

#[test]
fn a_board_comes_out_square_by_square() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    fs::write(dir.join("photo.png"), Picture::from(board()).write(PictureFormat::Png).unwrap()).unwrap();
    let quad = corners().map(|(x, y)| format!("{x},{y}")).join(" ");
    let whole = "0%,100% 100%,100% 100%,0% 0%,0%";
    let ways: [&[&str]; 3] = [
        &["projective", "photo.png", "--base", &quad, "--target", whole],
        // The target may have any position and shape: the size comes from the photograph.
        &["projective", "photo.png", "--base", &quad, "--target", "-900,50 -500,50 -500,-1000 -900,-1000"],
        &["projective", "photo.png", "--target", &quad, "--inverse"],
    ];
    let length = |a: usize, b: usize| {
        let (p, q) = (corners()[a], corners()[b]);
        (p.0 - q.0).hypot(p.1 - q.1)
    };
    let mean = |a: f64, b: f64| (0.5 * (a + b)).round() as u32;
    // The board is seen at an angle. Its true height needs more pixels than its sides have, and no detail of its width is lost.
    let width = mean(length(0, 1), length(2, 3));
    let natural = (width, (f64::from(width) * 0.75).round() as u32);
    assert!(natural.1 > mean(length(1, 2), length(3, 0)) + 20);
    for way in ways {
        for (wanted, expected) in
            [(None, natural), (Some("800x600"), (800, 600)), (Some("200"), (200, 200 * natural.1 / natural.0))]
        {
            let mut args = [way, &["--crop", "-o", "out.png"]].concat();
            args.extend(wanted.iter().flat_map(|size| ["--size", *size]));
            let (code, said) = run(dir, &args);
            assert!(code == 0 && said.contains("1.33 : 1") && said.lines().count() == 1, "{args:?}: {said}");
            let out = read(dir.join("out.png")).pixmap;
            assert!((out.height() as i32 - expected.1 as i32).abs() <= 1 && out.width() == expected.0, "{args:?}");
            for (column, row) in (0..BOARD.1).flat_map(|row| (0..BOARD.0).map(move |column| (column, row))) {
                let at = |i: u8, n: u8, side: u32| ((f64::from(i) + 0.5) / f64::from(n) * f64::from(side)) as u32;
                let (x, y) = (at(column, BOARD.0, out.width()), at(row, BOARD.1, out.height()));
                let p = out.pixel(x, y).unwrap();
                let off =
                    [p.red(), p.green(), p.blue()].into_iter().zip(color(column, row)).map(|(a, b)| a.abs_diff(b));
                assert!(off.max() <= Some(2) && p.alpha() == 255, "{args:?}: {column},{row} is {p:?}");
            }
            // Nothing of the table is left: its yellow has both red and green.
            let edge = (0..out.width()).flat_map(|x| [(x, 2), (x, out.height() - 3)]);
            let table = { edge }.filter(|(x, y)| out.pixel(*x, *y).is_some_and(|p| p.red() > 235 && p.green() > 225));
            assert_eq!(table.count(), 0, "{args:?}");
        }
    }
}

/// Cameras with all kinds of lenses see sheets from all sides; the truth is the camera's matrix.
#[test]
fn photographs_tell_the_proportions_of_what_lies_in_them() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let picture: (f64, f64) = (1500.0, 1125.0);
    let photo = painted(1500, 1125, |_, _| [120, 140, 160]);
    fs::write(dir.join("photo.png"), Picture::from(photo).write(PictureFormat::Png).unwrap()).unwrap();
    let diagonal = picture.0.hypot(picture.1);
    let crop = |camera: &[[f64; 3]; 3], options: &[&str]| {
        let quad = corners_seen(camera).map(|(x, y)| format!("{x:.1},{y:.1}")).join(" ");
        let args =
            ["projective", "photo.png", "--target", &quad, "--target-as-drawn", "--inverse", "--crop", "-o", "out.png"];
        let (code, said) = run(dir, &[&args[..], options].concat());
        assert_eq!(code, 0, "{said}");
        (f64::from(size(dir.join("out.png")).0) / f64::from(size(dir.join("out.png")).1), said)
    };
    let mut told = 0;
    for (i, lens) in [0.6, 0.75, 0.9, 1.2, 1.6, 2.2].into_iter().enumerate() {
        let sides = [(2.1, 2.97), (2.97, 2.1), (2.0, 2.0), (1.0, 2.4)][i % 4];
        let turns = [0.75 - 0.07 * i as f64, 0.35 + 0.11 * i as f64 * (-1f64).powi(i as i32), 0.2 * i as f64 - 0.5];
        let camera = camera(sides, lens * diagonal, picture, turns, 6.0 * lens);
        let (ratio, said) = crop(&camera, &[]);
        let near = |a: f64, b: f64, by: f64| (a / b - 1.0).abs() < by;
        if said.contains("focal length") {
            told += 1;
            assert!(near(ratio, sides.0 / sides.1, 0.01), "{lens}, {turns:?}: {ratio}, {said}");
            let mm = said.split("focal length of ").nth(1).and_then(|t| t.split(' ').next()).unwrap();
            assert!(near(mm.parse().unwrap(), 43.27 * lens, 0.05), "{lens}: {said}");
        }
        // A sheet is upright or not as it is in space, however it is foreshortened.
        let upright = sides.0 < sides.1;
        if !near(sides.0, sides.1, 0.01) {
            for sheet in ["a4", "210:297", "297:210"] {
                let expected = if upright { 210.0 / 297.0 } else { 297.0 / 210.0 };
                let (ratio, said) = crop(&camera, &["--ratio", sheet]);
                assert!(near(ratio, expected, 0.003) && said.is_empty(), "{lens}, {sheet}: {ratio} {said}");
            }
        }
    }
    // In the second and the last, a pixel at one corner moves the ratio by more than 3 %.
    assert_eq!(told, 4);
    // A sheet seen from straight in front does not determine the lens, which is not needed then.
    let front = camera((2.1, 2.97), diagonal, picture, [0.0, 0.0, 0.3], 6.0);
    let (ratio, said) = crop(&front, &[]);
    assert!((ratio / (2.1 / 2.97) - 1.0).abs() < 0.005 && said.is_empty(), "{ratio} {said}");
    // Corners that no camera could see of a rectangle keep the mean of their sides.
    let drawn = [
        "projective",
        "photo.png",
        "--target",
        "150,475 640,520 685,160 235,95",
        "--inverse",
        "--crop",
        "-o",
        "out.png",
    ];
    assert_eq!(run(dir, &drawn), (0, String::new()));
    let (_, said) = run(dir, &[&drawn[..], &["--ratio", "letter", "--size", "300x200"]].concat());
    assert!(said.contains("--ratio") && said.contains("--size"), "{said}");
    assert_eq!(run(dir, &[&drawn[..], &["--ratio", "letter", "--size", "440"]].concat()).0, 0);
    assert_eq!(size(dir.join("out.png")), (440, 340));
    for (wrong, code) in [("0:3", 2), ("wide", 2), ("1:-2", 2), ("nan:1", 2), ("inf:1", 2)] {
        assert_eq!(run(dir, &[&drawn[..], &["--ratio", wrong]].concat()).0, code, "{wrong}");
    }
    assert_eq!(run(dir, &["swirl", "photo.png", "--ratio", "a4", "-o", "out.png"]).0, 2);
}

/// The image of the rest of the photograph, beyond the horizon, does not matter.
#[test]
fn a_steep_floor_can_be_cropped() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    fs::write(dir.join("floor.png"), Picture::from(board()).write(PictureFormat::Png).unwrap()).unwrap();
    let args =
        ["projective", "floor.png", "--base", "0,470 640,470 400,250 240,250", "--target", "0,400 400,400 400,0 0,0"];
    assert_eq!(run(dir, &[&args[..], &["-o", "out.png"]].concat()).0, 4);
    assert_eq!(run(dir, &[&args[..], &["--crop", "-o", "out.png"]].concat()), (0, String::new()));
    // (640 + 160) / 2, and the length of the slanted sides.
    assert_eq!(size(dir.join("out.png")), (400, 240f64.hypot(220.0).round() as u32));
}

#[test]
fn a_cage_around_a_part_and_other_maps_are_cropped_to_the_frame() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    fs::write(dir.join("photo.png"), Picture::from(board()).write(PictureFormat::Png).unwrap()).unwrap();
    let cage = "M100,400 Q300,440 500,400 L500,100 Q300,140 100,100 Z";
    assert_eq!(
        run(dir, &["shaper", "photo.png", "--shaper", cage, "--inverse", "--crop", "-o", "out.png"]),
        (0, String::new())
    );
    // A parabola that rises by 20 over 400 is longer by the share 8/3 · (20/400)².
    assert_eq!(size(dir.join("out.png")), (403, 300));
    // The image of the whole photograph, which is no rectangle, has a pixel for each unit.
    let flag = ["warp", "photo.png", "--style", "flag", "-o"];
    assert_eq!(run(dir, &[&flag[..], &["page.png"]].concat()).0, 0);
    assert_eq!(run(dir, &[&flag[..], &["crop.png", "--crop"]].concat()).0, 0);
    let (page, crop) = (size(dir.join("page.png")), size(dir.join("crop.png")));
    assert!(page.0.abs_diff(crop.0) <= 1 && page.1.abs_diff(crop.1) <= 1, "{page:?} {crop:?}");
}

#[test]
fn fit_says_what_is_shown() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    fs::write(dir.join("photo.png"), Picture::from(board()).write(PictureFormat::Png).unwrap()).unwrap();
    let moved = ["affine", "photo.png", "--move-x", "100", "-o", "out.png", "--fit"];
    for (fit, expected, blank) in
        [("none", (640, 480), 100), ("grow", (740, 480), 100), ("page", (640, 480), 0), ("auto", (640, 480), 0)]
    {
        assert_eq!(run(dir, &[&moved[..], &[fit]].concat()).0, 0);
        assert_eq!(size(dir.join("out.png")), expected, "{fit}");
        let out = read(dir.join("out.png")).pixmap;
        let row = (0..out.width()).take_while(|x| out.pixel(*x, 200).is_some_and(|p| p.alpha() == 0));
        assert_eq!(row.count(), blank, "{fit}");
    }
    let sample = sample("logo.svg").display().to_string();
    for option in [&["--crop"][..], &["--size", "300"]] {
        let (_, said) = expect_code(2, &[&["swirl", &sample, "-o", "out.svg"], option].concat());
        assert!(said.contains(option[0]) && said.contains("PNG"), "{said}");
    }
    assert_eq!(run(dir, &[&moved[..], &["none", "--crop"]].concat()).0, 2);
    assert_eq!(run(dir, &["swirl", "photo.png", "-o", "out.png", "--page-width", "80mm"]).0, 2);
}

/// Appends an entry of big-endian TIFF: tag, type, count, value.
fn entry(out: &mut Vec<u8>, tag: u16, kind: u16, count: u32, value: u32) {
    out.extend([tag.to_be_bytes(), kind.to_be_bytes()].concat());
    out.extend([count.to_be_bytes(), value.to_be_bytes()].concat());
}

/// Metadata as a camera writes them (EXIF 2.32, 4.5): the camera turned by 90°, its maker's notes, a position and a thumbnail.
fn exif() -> Vec<u8> {
    let mut out = b"MM\0\x2a\0\0\0\x08".to_vec();
    out.extend(6u16.to_be_bytes());
    entry(&mut out, 0x0100, 3, 1, 160 << 16);
    entry(&mut out, 0x0101, 3, 1, 80 << 16);
    entry(&mut out, 0x010f, 2, 8, 300);
    entry(&mut out, 0x0112, 3, 1, 6 << 16);
    entry(&mut out, 0x8769, 4, 1, 100);
    entry(&mut out, 0x8825, 4, 1, 150);
    out.extend(200u32.to_be_bytes());
    out.resize(100, 0);
    out.extend(3u16.to_be_bytes());
    entry(&mut out, 0x927c, 7, 9, 308);
    entry(&mut out, 0xa002, 4, 1, 160);
    entry(&mut out, 0xa003, 4, 1, 80);
    out.resize(150, 0);
    out.extend(1u16.to_be_bytes());
    entry(&mut out, 0x0002, 5, 3, 320);
    out.resize(200, 0);
    out.extend(2u16.to_be_bytes());
    entry(&mut out, 0x0201, 4, 1, 350);
    entry(&mut out, 0x0202, 4, 1, 9);
    out.resize(300, 0);
    out.extend(b"Maker A\0Its notes   LATITUDE and the minutes");
    out.resize(350, 0);
    out.extend(b"THUMBNAIL");
    out
}

/// The entries of a directory: tag to value or offset, and the offset of the next directory.
fn directory(tiff: &[u8], at: usize) -> (BTreeMap<u16, u32>, u32) {
    let short = |at: usize| u16::from_be_bytes(tiff[at..at + 2].try_into().unwrap());
    let long = |at: usize| u32::from_be_bytes(tiff[at..at + 4].try_into().unwrap());
    let end = at + 2 + 12 * usize::from(short(at));
    let value = |e: usize| if short(e + 2) == 3 { short(e + 8).into() } else { long(e + 8) };
    let entries = (at + 2..end).step_by(12).map(|e| (short(e), value(e))).collect();
    (entries, long(end))
}

/// An ICC profile's header (ICC.1:2022, 7.2) for a colour space.
fn profile(space: &[u8; 4]) -> Vec<u8> {
    let mut out = vec![0; 132];
    out[3] = 132;
    out[12..20].copy_from_slice(&[*b"mntr", *space].concat());
    out[36..40].copy_from_slice(b"acsp");
    out
}

/// The content of segments (JPEG) or chunks (PNG, WebP) that start with `head`.
fn parts(file: &[u8], head: &[u8]) -> Vec<Vec<u8>> {
    let big = |b: &[u8]| b.iter().fold(0, |n, b| n << 8 | usize::from(*b));
    let (mut at, mut all) = (0, Vec::new());
    if file.starts_with(b"\xff\xd8") {
        at = 2;
        // Up to the pixels.
        while file[at + 1] != 0xda {
            let end = at + 2 + big(&file[at + 2..at + 4]);
            all.push(file[at + 4..end].to_vec());
            at = end;
        }
    } else if file.starts_with(b"RIFF") {
        at += 12;
        while at < file.len() {
            let length = u32::from_le_bytes(file[at + 4..at + 8].try_into().unwrap()) as usize;
            all.push([&file[at..at + 4], &file[at + 8..at + 8 + length]].concat());
            at += 8 + length + length % 2;
        }
    } else {
        at += 8;
        while at < file.len() {
            let length = big(&file[at..at + 4]);
            all.push(file[at + 4..at + 8 + length].to_vec());
            at += 12 + length;
        }
    }
    all.iter().filter_map(|part| part.strip_prefix(head)).map(<[u8]>::to_vec).collect()
}

/// A JPEG of 160 × 80 pixels with these metadata.
fn photograph(exif: &[u8], profile: Vec<u8>) -> Vec<u8> {
    let pixmap = painted(160, 80, |x, y| [x as u8, 2 * y as u8, (x * y % 251) as u8]);
    let exif = Some(exif.to_vec());
    // Other tests check that metadata are written at the positions that the format requires.
    Picture { profile: Some(profile), exif, ..Picture::from(pixmap) }.write(JPEG).unwrap()
}

#[test]
fn profile_and_exif_go_along() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    fs::write(dir.join("photo.jpg"), photograph(&exif(), profile(b"RGB "))).unwrap();
    for (out, exif_head, icc_head) in [
        ("out.jpg", &b"Exif\0\0"[..], &b"ICC_PROFILE\0\x01\x01"[..]),
        ("out.png", b"eXIf", b"iCCP"),
        ("out.webp", b"EXIF", b"ICCP"),
    ] {
        for keeps_location in [false, true] {
            let mut args = vec!["affine", "photo.jpg", "--scale-x", "1.5", "-o", out];
            args.extend(keeps_location.then_some("--keep-location"));
            assert_eq!(run(dir, &args), (0, String::new()));
            // Turned upright it is 80 × 160, then 120 wide.
            assert_eq!(size(dir.join(out)), (120, 160));
            let file = fs::read(dir.join(out)).unwrap();
            let [tiff] = &parts(&file, exif_head)[..] else { panic!("{out}: no EXIF") };
            let (main, next) = directory(tiff, 8);
            let has = |word: &str| tiff.windows(word.len()).any(|w| w == word.as_bytes());
            assert_eq!((main[&0x0112], main[&0x0100], main[&0x0101], next), (1, 120, 160, 0), "{out}");
            let exif = directory(tiff, main[&0x8769] as usize).0;
            assert_eq!((exif[&0xa002], exif[&0xa003]), (120, 160));
            // The maker's notes keep their position, since they may contain offsets from the start.
            assert!(tiff[300..].starts_with(b"Maker A\0Its notes") && exif[&0x927c] == 308);
            assert!(!has("THUMBNAIL"), "{out}");
            assert_eq!((has("LATITUDE"), main.contains_key(&0x8825)), (keeps_location, keeps_location), "{out}");
            if keeps_location {
                assert_eq!(directory(tiff, main[&0x8825] as usize).0[&2], 320);
            }
            let [icc] = &parts(&file, icc_head)[..] else { panic!("{out}: no profile") };
            if out == "out.png" {
                // A name, a zero, the method, and packed data.
                let start = icc.iter().position(|b| *b == 0).unwrap() + 2;
                let mut unpacked = Vec::new();
                let mut packed = flate2::read::ZlibDecoder::new(&icc[start..]);
                std::io::Read::read_to_end(&mut packed, &mut unpacked).unwrap();
                assert_eq!(unpacked, profile(b"RGB "));
            } else {
                assert_eq!(icc, &profile(b"RGB "), "{out}");
            }
        }
    }
}

/// Pixels are RGB, so any other profile would show them wrong; damaged metadata are of no use. A warning reports both.
#[test]
fn what_does_not_fit_is_left_out_and_said() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    for (exif, space, said) in
        [(&exif()[..], b"CMYK", "not one for RGB"), (&exif()[..90], b"RGB ", "EXIF data are damaged")]
    {
        let mut photo = photograph(exif, profile(b"RGB "));
        let at = photo.windows(4).position(|w| w == b"RGB ").unwrap();
        photo[at..at + 4].copy_from_slice(space);
        fs::write(dir.join("photo.jpg"), photo).unwrap();
        let (code, warned) = run(dir, &["affine", "photo.jpg", "--rotate", "90", "-o", "out.jpg"]);
        assert!(code == 0 && warned.contains(said) && warned.lines().count() == 1, "{code} {warned}");
        let out = fs::read(dir.join("out.jpg")).unwrap();
        let kept = (parts(&out, b"Exif\0\0").len(), parts(&out, b"ICC_PROFILE\0").len());
        assert_eq!(kept, if space == b"CMYK" { (1, 0) } else { (0, 1) });
    }
}

#[test]
fn what_is_wrong_with_a_picture_is_said() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let pixmap = painted(160, 80, |x, y| [x as u8, y as u8, 99]);
    let whole = Picture { exif: Some(exif()), ..Picture::from(pixmap) }.write(PictureFormat::WebP).unwrap();
    // The EXIF data of a WebP come last.
    let at = whole.windows(4).rposition(|w| w == b"EXIF").unwrap();
    fs::write(dir.join("whole.webp"), &whole).unwrap();
    fs::write(dir.join("cut.webp"), &whole[..at + 60]).unwrap();
    fs::write(dir.join("torn.jpg"), [b"XX", &whole[..]].concat()).unwrap();
    let still =
        |file: &str, more: &[&str]| run(dir, &[&["affine", file, "--rotate", "0", "-o", "out.png"], more].concat());
    assert_eq!(still("whole.webp", &[]), (0, String::new()));
    for (file, more, wanted, said) in [
        ("cut.webp", &[][..], 0, "EXIF data are damaged"),
        ("torn.jpg", &[], 3, "torn.jpg: does not begin as a PNG, JPEG or WebP picture"),
        ("whole.webp", &["--kerf", "1mm"], 2, "--kerf is for SVG files"),
        ("whole.webp", &["--fit", "none", "+", "affine", "--move-x", "999"], 0, "nothing of the picture"),
    ] {
        let (code, found) = still(file, more);
        assert!(code == wanted && found.contains(said), "{file} {more:?}: {code} {found}");
    }
}

#[test]
fn a_jpeg_cut_short_is_said_to_be() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let whole = fs::read(sample("label.jpg")).unwrap();
    fs::write(dir.join("whole.jpg"), &whole).unwrap();
    fs::write(dir.join("cut.jpg"), &whole[..whole.len() / 2]).unwrap();
    fs::write(dir.join("head.jpg"), &whole[..whole.len() / 200]).unwrap();
    let still = |file: &str, more: &[&str]| {
        run(dir, &[&["affine", file, "--scale-x", "1", "-o", "out.png", "--fit", "none"], more].concat())
    };
    assert_eq!(still("whole.jpg", &[]), (0, String::new()));
    let expected = read(dir.join("out.png")).pixmap;
    fs::remove_file(dir.join("out.png")).unwrap();
    for file in ["cut.jpg", "head.jpg"] {
        let (code, said) = still(file, &[]);
        assert!(code == 3 && said.contains("ends early") && !dir.join("out.png").exists(), "{code} {said}");
    }
    let (code, said) = still("cut.jpg", &["--on-error", "skip"]);
    let lines = said.split("after ").nth(1).and_then(|s| s.split(' ').next()).unwrap().parse::<u32>().unwrap();
    assert!(code == 1 && said.contains(" of 600 lines"), "{code} {said}");
    // Half of the bytes hold about half of the lines. Those are exact, and no others are invented.
    assert!((200..400).contains(&lines), "{said}");
    let found = read(dir.join("out.png")).pixmap;
    let all = (4 * lines * expected.width()) as usize;
    assert_eq!(found.data()[..all], expected.data()[..all]);
    assert!(found.data()[all..].iter().all(|b| *b == 0));
    // A missing end mark alone is no loss.
    fs::write(dir.join("whole.jpg"), &whole[..whole.len() - 2]).unwrap();
    assert_eq!(still("whole.jpg", &[]), (0, String::new()));
}
