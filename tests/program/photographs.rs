//! PNG and JPEG files through the program: the same maps as for drawings.

use crate::support::{pathwarp, pathwarp_in, sample};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pathwarp_raster::{Picture, PictureFormat, Pixmap, Size, compare, decode_png, header_size, render};
use pathwarp_svg::usvg_tree;
use resvg::tiny_skia::ColorU8;
use std::fs;

/// Renders a drawing as a photograph.
fn photograph(svg: &str, width: u32) -> Pixmap {
    let tree = usvg_tree::parse_tree(svg.as_bytes(), "drawing", &pathwarp_svg::ReadOptions::default()).unwrap();
    render(&tree, Size::Width(width)).unwrap()
}

fn png(pixmap: Pixmap) -> Vec<u8> {
    Picture::from(pixmap).write(PictureFormat::Png).unwrap()
}

const DRAWING: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 200 120' width='200' height='120'>\
    <path fill='#eee' d='M0,0H200V120H0Z'/><circle cx='70' cy='60' r='45' fill='#b03'/>\
    <path fill='#05a' d='M110,20 L180,30 L150,100 Z'/></svg>";

/// Warping the photograph of a drawing equals photographing the warped drawing.
#[test]
fn photographing_and_warping_commute() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("in.svg"), DRAWING).unwrap();
    fs::write(dir.path().join("in.png"), png(photograph(DRAWING, 200))).unwrap();
    let cage = "M 5,115 C 70,130 120,90 195,118 C 180,80 210,40 190,10 C 140,-10 80,30 10,5 C 25,40 -5,80 5,115 Z";
    for (deformation, more) in [
        ("shaper", vec!["--shaper", cage]),
        ("swirl", vec!["--angle", "40"]),
        ("projective", vec!["--target", "0,120 200,110 160,20 30,5"]),
        ("mls", vec!["--pin", "10,110", "--pin", "190,110", "--pair", "100,20:120,10"]),
    ] {
        for (input, out) in [("in.svg", "out.svg"), ("in.png", "out.png")] {
            let mut args = vec![deformation, input, "-o", out];
            args.extend(&more);
            let output = pathwarp_in(dir.path(), &args, b"");
            assert!(output.status.success(), "{deformation}: {}", String::from_utf8_lossy(&output.stderr));
        }
        let ours = decode_png(&fs::read(dir.path().join("out.png")).unwrap()).unwrap();
        // The picture shows the bounding box of the warped drawing, in whole pixels.
        let svg = fs::read_to_string(dir.path().join("out.svg")).unwrap();
        let document = pathwarp_svg::Document::read(svg.as_bytes(), "out", &Default::default()).unwrap();
        let b = document.artwork_box(&Default::default()).unwrap();
        let (x, y) = ((b.x0 + 1e-3).floor(), (b.y0 + 1e-3).floor());
        let (w, h) = ((b.x1 - 1e-3).ceil() - x, (b.y1 - 1e-3).ceil() - y);
        assert_eq!((f64::from(ours.width()), f64::from(ours.height())), (w, h), "{deformation}");
        let page = svg.replace("viewBox='0 0 200 120'", &format!("viewBox='{x} {y} {w} {h}'"));
        let page = page.replace("width='200' height='120'", &format!("width='{w}' height='{h}'"));
        let difference = compare(&ours, &photograph(&page, ours.width())).unwrap();
        println!("{deformation}: mean {:.2}, over 64: {:.4}", difference.mean_abs, difference.share_over(64));
        assert!(difference.mean_abs < 2.0, "{deformation}: {}", difference.mean_abs);
        assert!(difference.share_over(64) < 0.01, "{deformation}: {}", difference.share_over(64));
        // Check that the comparison can fail: the unwarped photograph is far off.
        if (ours.width(), ours.height()) == (200, 120) {
            let still = compare(&ours, &photograph(DRAWING, 200)).unwrap();
            assert!(still.mean_abs > 4.0 * difference.mean_abs, "{deformation}: {}", still.mean_abs);
        }
    }
}

#[test]
fn sizes_formats_and_exit_codes() {
    let dir = tempfile::tempdir().unwrap();
    let picture = Picture { profile: Some(b"a profile".to_vec()), ..photograph(DRAWING, 200).into() };
    fs::write(
        dir.path().join("in.jpg"),
        picture.write(PictureFormat::Jpeg { quality: PictureFormat::QUALITY }).unwrap(),
    )
    .unwrap();
    let run = |more: &[&str]| {
        let mut args = vec!["affine", "in.jpg", "--rotate", "90"];
        args.extend(more);
        pathwarp_in(dir.path(), &args, b"")
    };
    let code = |more: &[&str]| run(more).status.code().unwrap();
    let read = |name: &str| Picture::read(&fs::read(dir.path().join(name)).unwrap()).unwrap();
    let size = |p: &Picture| (p.pixmap.width(), p.pixmap.height());

    assert_eq!(code(&["-o", "turned.jpg"]), 0);
    assert_eq!((size(&read("turned.jpg")), read("turned.jpg").profile), ((120, 200), picture.profile.clone()));
    assert_eq!(code(&["-o", "small.png", "--size", "60"]), 0);
    assert_eq!((size(&read("small.png")), read("small.png").profile), ((60, 100), picture.profile.clone()));
    assert_eq!(code(&["-o", "wide.png", "--size", "60x20"]), 0);
    assert_eq!(size(&read("wide.png")), (60, 20));
    assert_eq!(size(&Picture::read(&run(&[]).stdout).unwrap()), (120, 200));

    let before = fs::read_dir(dir.path()).unwrap().count();
    assert_eq!(code(&["-o", "out.svg"]), 2);
    assert_eq!(code(&["-o", "out.png", "--select", "path"]), 2);
    assert_eq!(code(&["-o", "out.png", "--size", "0x4"]), 2);
    assert_eq!(code(&["-o", "out.png", "--size", "60000x60000"]), 4);
    fs::write(dir.path().join("in.jpg"), b"\xff\xd8\xff\xe0 no more").unwrap();
    assert_eq!(code(&["-o", "out.png"]), 3);
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), before);
    // An SVG file may have any other name.
    let svg = sample("logo.svg");
    assert!(pathwarp(&["swirl", svg.to_str().unwrap()]).status.success());
}

/// A bent picture in a drawing looks like the bent drawing from which it was rendered.
#[test]
fn a_picture_in_a_drawing_bends_with_it() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("shot.png"), png(photograph(DRAWING, 800))).unwrap();
    fs::write(dir.path().join("in.svg"), DRAWING).unwrap();
    let frame = ["--frame", "0,0,200,120"];
    let image = |attributes: &str| {
        format!(
            "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' \
             viewBox='0 0 200 120' width='200' height='120'>{attributes}</svg>"
        )
    };
    let pictures = [
        ("plain", image("<image id='i' width='200' height='120' xlink:href='shot.png'/>")),
        (
            "placed",
            image(
                "<g transform='translate(-30 10)'><image id='i' transform='scale(2 1)' x='15' y='-10' width='100' height='120' preserveAspectRatio='none' href='shot.png'/></g>",
            ),
        ),
        (
            "copied",
            image(
                "<defs><image id='i' width='100' height='60' href='shot.png'/></defs><use href='#i' transform='scale(2)'/>",
            ),
        ),
    ];
    let cage = "M 5,115 C 70,130 120,90 195,118 C 180,80 210,40 190,10 C 140,-10 80,30 10,5 C 25,40 -5,80 5,115 Z";
    let run = |input: &str, out: &str, more: &[&str]| {
        let mut args = vec!["shaper", input, "-o", out, "--shaper", cage, "--fit", "none"];
        args.extend(frame);
        args.extend(more);
        let output = pathwarp_in(dir.path(), &args, b"");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code().unwrap(), said)
    };
    assert_eq!(run("in.svg", "out.svg", &[]).0, 0);
    let shot = |name: &str| photograph(&fs::read_to_string(dir.path().join(name)).unwrap(), 400);
    let expected = shot("out.svg");
    for (name, svg) in pictures {
        fs::write(dir.path().join("picture.svg"), svg).unwrap();
        for structure in ["auto", "flatten"] {
            let (code, said) = run("picture.svg", "bent.svg", &["--structure", structure]);
            assert_eq!(code, 0, "{name}, {structure}: {said}");
            let difference = compare(&shot("bent.svg"), &expected).unwrap();
            println!("{name}, {structure}: mean {:.2}, over 64: {:.4}", difference.mean_abs, difference.share_over(64));
            assert!(difference.mean_abs < 1.5, "{name}, {structure}: {}", difference.mean_abs);
            assert!(difference.share_over(64) < 0.005, "{name}, {structure}: {}", difference.share_over(64));
        }
        assert!(fs::read_to_string(dir.path().join("bent.svg")).unwrap().contains("data:image/png"));
        // Kept pixels can only be placed by an affine map: the difference is visible and reported.
        let (code, said) = run("picture.svg", "kept.svg", &["--images", "keep"]);
        assert!(code == 1 && said.contains("affine fit"), "{name}: {code} {said}");
        let fine = fs::metadata(dir.path().join("bent.svg")).unwrap().len();
        assert_eq!(run("picture.svg", "coarse.svg", &["--image-dpi", "24"]).0, 0);
        assert!(fs::metadata(dir.path().join("coarse.svg")).unwrap().len() < fine / 4, "{name}");
    }
}

/// A photograph with as much detail as real ones: smooth colours, edges, and some grain.
fn landscape(width: u32, height: u32) -> Picture {
    let mut pixmap = photograph(DRAWING, width);
    assert_eq!(pixmap.height(), height);
    let mut seed = 7_u32;
    for (i, p) in pixmap.pixels_mut().iter_mut().enumerate() {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let (x, y) = (f64::from(i as u32 % width), f64::from(i as u32 / width));
        let light = 30.0 * (x / 37.0).sin() * (y / 53.0).cos() + f64::from(seed >> 24) / 16.0 - 8.0;
        let c = |v: u8| (0.8 * f64::from(v) + light + 20.0).clamp(0.0, 255.0) as u8;
        *p = ColorU8::from_rgba(c(p.red()), c(p.green()), c(p.blue()), 255).premultiply();
    }
    pixmap.into()
}

/// The pictures that a drawing embeds as JPEG.
fn embedded(svg: &str) -> Vec<Vec<u8>> {
    let texts = svg.split("data:image/jpeg;base64,").skip(1).map(|t| t.split(['"', '\'']).next().unwrap());
    texts.map(|t| STANDARD.decode(t).unwrap()).collect()
}

#[test]
fn bent_photographs_stay_jpegs_of_like_quality() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let (size, photo) = ((400, 240), landscape(400, 240));
    let bent = |svg: &str, more: &[&str]| {
        fs::write(dir.join("in.svg"), svg).unwrap();
        let args = ["warp", "in.svg", "--style", "flag", "--bend", "50%", "--fit", "none", "-o", "out.svg"];
        let output = pathwarp_in(dir, &[&args[..], more].concat(), b"");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{said}");
        (fs::read_to_string(dir.join("out.svg")).unwrap(), said)
    };
    let drawing = |file: &[u8], media_type: &str, attributes: &str| {
        let data = STANDARD.encode(file);
        format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 300' width='400' height='300'>\
             <clipPath id='c'><circle cx='210' cy='150' r='90'/></clipPath>\
             <filter id='f' x='-.5' y='-.5' width='2' height='2'><feDropShadow dx='9' dy='9' stdDeviation='0'/></filter>\
             <rect width='400' height='300' fill='#025'/>\
             <image x='100' y='90' width='200' height='120' {attributes} href='data:{media_type};base64,{data}'/></svg>"
        )
    };
    let lossless = photo.write(PictureFormat::Png).unwrap();
    for (quality, attributes) in [
        (60, ""),
        (75, "clip-path='url(#c)'"),
        (90, "filter='url(#f)'"),
        (95, "transform='rotate(20 200 150) scale(.9)'"),
    ] {
        let file = photo.write(PictureFormat::Jpeg { quality }).unwrap();
        for structure in ["auto", "flatten"] {
            let (svg, _) = bent(&drawing(&file, "image/jpeg", attributes), &["--structure", structure]);
            let found = embedded(&svg);
            assert_eq!(found.len(), 1, "{attributes}");
            // The outline covers this fraction of the picture's box; pixels beyond it show nothing.
            let (w, h) = header_size(&found[0]).unwrap();
            let per_pixel = |bytes: usize, (w, h): (u32, u32)| bytes as f64 / (f64::from(w) * f64::from(h));
            let growth = per_pixel(found[0].len(), (w, h)) / per_pixel(file.len(), size);
            println!("{quality} {attributes}: {w} x {h}, {growth:.2} times the bytes of a pixel");
            assert!(growth < 1.5, "{quality}, {attributes}: {growth}");
            // The result looks like the drawing with a lossless photograph, edges included.
            let (exact, _) = bent(&drawing(&lossless, "image/png", attributes), &["--structure", structure]);
            assert!(embedded(&exact).is_empty() && exact.contains("data:image/png"));
            let (a, b) = (photograph(&svg, 400), photograph(&exact, 400));
            let difference = compare(&a, &b).unwrap();
            let (mean, over) = (difference.mean_abs, difference.share_over(64));
            println!("{quality} {attributes}, {structure}: mean {mean:.2}, over 64: {over:.5}");
            assert!(mean < 2.5 && over < 0.001, "{quality} {attributes} {structure}: {mean} {over}");
            // The comparison can fail: without the outline, colours continue beyond the edge.
            let unclipped = photograph(&svg.replace("clip-path", "data-clip"), 400);
            assert!(compare(&unclipped, &b).unwrap().share_over(64) > 0.01, "{attributes}");
        }
    }
    // Grey stays grey, and a PNG stays a lossless PNG.
    let mut grey = landscape(400, 240).pixmap;
    grey.pixels_mut().iter_mut().for_each(|p| *p = ColorU8::from_rgba(p.red(), p.red(), p.red(), 255).premultiply());
    let colored = Picture::from(grey).write(PictureFormat::Jpeg { quality: 80 }).unwrap();
    let (svg, said) = bent(&drawing(&colored, "image/jpeg", ""), &[]);
    let found = Picture::read(&embedded(&svg)[0]).unwrap().pixmap;
    assert!(found.pixels().iter().all(|p| p.red().abs_diff(p.blue()) <= 2), "{said}");
    // A photograph in CMYK becomes RGB, with a warning.
    let inks = include_bytes!("../libraries/raster/pictures/cmyk.jpg");
    let (svg, said) = bent(&drawing(inks, "image/jpeg", ""), &[]);
    assert!(said.contains("CMYK") && embedded(&svg).len() == 1, "{said}");
    assert!(!bent(&drawing(&colored, "image/jpeg", ""), &[]).1.contains("CMYK"));
}

/// A turned photograph has the size at which it is shown, and its bytes are unchanged where it is not bent. This one ends with its header,
/// so decoding and encoding would change it.
#[test]
fn turned_photographs_that_are_not_bent_are_not_decoded() {
    // An APP1 segment with orientation (0x0112) = 6: the first row is the right side.
    const TURNED: &[u8] = b"\xff\xe1\x00\x22Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0";
    let dir = tempfile::tempdir().unwrap();
    let wide = Picture::from(photograph(DRAWING, 200));
    let mut file = wide.write(PictureFormat::Jpeg { quality: PictureFormat::QUALITY }).unwrap();
    file.splice(2..2, TURNED.iter().copied());
    let scan = file.windows(2).position(|w| w == b"\xff\xda").unwrap() + 2;
    file.truncate(scan + usize::from(u16::from_be_bytes([file[scan], file[scan + 1]])));
    assert!(Picture::read(&file).unwrap().early_end.is_some());
    fs::write(dir.path().join("turned.jpg"), &file).unwrap();
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 300 300'><image id='i' href='turned.jpg'/></svg>";
    fs::write(dir.path().join("in.svg"), svg).unwrap();
    for structure in ["keep", "flatten"] {
        let args = ["affine", "in.svg", "--rotate", "90", "--structure", structure, "--fit", "none", "-o", "out.svg"];
        let output = pathwarp_in(dir.path(), &[&args[..], &["--report", "-"]].concat(), b"");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(report["inputs"][0]["frame"], serde_json::json!([0.0, 0.0, 120.0, 200.0]));
        let result = fs::read_to_string(dir.path().join("out.svg")).unwrap();
        let embedded = format!("data:image/jpeg;base64,{}", STANDARD.encode(&file));
        assert!(result.contains(if structure == "keep" { "turned.jpg" } else { &embedded }), "{result}");
    }
}
