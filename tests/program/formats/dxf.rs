//! DXF files, read back and compared with the SVG of the same command.

use super::dxf_reader::{Dxf, Entity};
use crate::support::geometry::{documents, drawing, far, gap, outlines};
use crate::support::{artwork, expect_code, pathwarp_in, sample};
use std::collections::{BTreeMap, HashSet};
use std::fs;
use std::path::Path;

/// The distance of samples from their curve.
const SAMPLING: f64 = 2e-4;

fn run(folder: &Path, args: &[&str], stdin: &[u8]) -> (Vec<u8>, String) {
    let out = pathwarp_in(folder, args, stdin);
    let said = String::from_utf8(out.stderr).unwrap();
    assert_eq!(out.status.code(), Some(0), "{args:?}: {said}");
    (out.stdout, said)
}

fn dxf(folder: &Path, args: &[&str], stdin: &[u8]) -> (Dxf, String) {
    let (bytes, said) = run(folder, &[args, &["--format", "dxf"]].concat(), stdin);
    (Dxf::read(std::str::from_utf8(&bytes).unwrap()), said)
}

fn kinds(file: &Dxf) -> BTreeMap<&str, usize> {
    let mut out = BTreeMap::new();
    file.entities.iter().for_each(|e| *out.entry(e.kind.as_str()).or_default() += 1);
    out
}

/// Two bars that cross are cut twice where they overlap, unless they are united: then there are twelve edges, with the total length of the
/// cross alone. Other paths and strokes stay apart, and simple shapes unchanged.
#[test]
fn filled_shapes_are_united_within_a_path() {
    let dir = tempfile::tempdir().unwrap();
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='100mm' viewBox='0 0 100 100'>\
               <path d='M40,10H60V90H40ZM10,40H90V60H10Z'/><path d='M40,10H60V20H40Z' fill='red'/>\
               <path d='M0,0L9,9M0,9L9,0' fill='none' stroke='blue'/></svg>";
    let length = |file: &Dxf| -> f64 {
        let walk =
            |line: &Vec<_>| -> f64 { line.windows(2).map(|w: &[pathwarp::kurbo::Point]| w[0].distance(w[1])).sum() };
        file.polylines().iter().map(walk).sum()
    };
    let strokes = 2.0 * 9.0 * 2f64.sqrt();
    let apart = length(&dxf(dir.path(), &["convert", "-"], svg.as_bytes()).0);
    let united = length(&dxf(dir.path(), &["convert", "-", "--union"], svg.as_bytes()).0);
    assert!((apart - (400.0 + 60.0 + strokes)).abs() < 0.01, "{apart}");
    assert!((united - (320.0 + 60.0 + strokes)).abs() < 0.1, "{united}");
}

/// One drawing in px, mm, inches and points always gives the same file: exact, in mm, y up.
#[test]
fn sizes_are_true_and_curves_exact() {
    let dir = tempfile::tempdir().unwrap();
    let wanted = outlines(drawing("80mm", "60mm", 1.0).as_bytes());
    for (name, svg) in documents() {
        let (file, said) = dxf(dir.path(), &["convert", "-"], svg.as_bytes());
        assert_eq!(said, "", "{name}");
        assert_eq!((file.variable("$INSUNITS"), file.variable("$MEASUREMENT")), ("4", "1"));
        let got = file.polylines();
        let (there, back) = (gap(&got, &wanted), gap(&wanted, &got));
        println!("{name}: {there:.6} mm there, {back:.6} mm back, {:?}", kinds(&file));
        assert!(there.max(back) < SAMPLING, "{name}: {there} {back}");
        // Every contour is one entity: arcs of the rounded rectangle are bulges, curves and an ellipse's arc with lines are splines.
        let expected = [("ARC", 1), ("CIRCLE", 1), ("ELLIPSE", 1), ("LINE", 2), ("LWPOLYLINE", 1), ("SPLINE", 2)];
        let found = kinds(&file);
        for (kind, n) in expected {
            assert_eq!(found.get(kind), Some(&n), "{name} {kind}: {found:?}");
        }
    }
}

#[test]
fn polylines_keep_the_tolerance_and_contours_whole() {
    let dir = tempfile::tempdir().unwrap();
    for (name, svg) in documents() {
        let wanted = outlines(svg.as_bytes());
        let mut counts = Vec::new();
        for tolerance in [0.2, 0.02, 0.002] {
            let length = format!("{tolerance}mm");
            let args = ["convert", "-", "--dxf-curves", "polyline", "--tolerance", &length];
            let (file, _) = dxf(dir.path(), &args, svg.as_bytes());
            let got = file.polylines();
            let (there, back) = (gap(&got, &wanted), gap(&wanted, &got));
            assert!(there.max(back) < tolerance + SAMPLING, "{name} {tolerance}: {there} {back}");
            // One entity for each of the eight subpaths.
            assert_eq!(file.entities.len(), 8, "{name}: {:?}", kinds(&file));
            assert!(file.entities.iter().all(|e| matches!(e.kind.as_str(), "LWPOLYLINE" | "CIRCLE" | "ARC")));
            assert_eq!(file.entities.iter().filter(|e| e.kind == "LWPOLYLINE" && e.is_closed()).count(), 4);
            counts.push(got.iter().map(Vec::len).sum::<usize>());
        }
        assert!(counts[0] < counts[1] && counts[1] < counts[2], "{name}: {counts:?}");
    }
}

/// The DXF of every warped sample shows the drawing in the SVG of the same command, with the middle lines of strokes.
#[test]
fn warped_drawings_agree_with_their_svg() {
    let dir = tempfile::tempdir().unwrap();
    for name in artwork() {
        let input = sample(&name).display().to_string();
        for command in [&["warp", "--style", "flag"][..], &["affine", "--rotate", "20", "--skew-x", "15"]] {
            let args = [command, &[&input, "--quiet"]].concat();
            // Curves that become arcs are within a tenth of the tolerance.
            for (curves, tolerance) in [("spline", 0.005), ("polyline", 0.05)] {
                let more = ["--dxf-curves", curves, "--tolerance", "0.05mm"];
                let (svg, _) = run(
                    dir.path(),
                    &[&args[..], &more[2..], &["--strokes", "keep", "--gradients", "fit"]].concat(),
                    b"",
                );
                let exact = outlines(&svg);
                let (file, _) = dxf(dir.path(), &[&args[..], &more].concat(), b"");
                let got = file.polylines();
                let there = gap(&got, &exact);
                assert!(!got.is_empty(), "{name}");
                assert!(there < tolerance + 5.0 * SAMPLING, "{name} {command:?} {curves}: {there}");
            }
        }
    }
}

#[test]
fn groups_are_layers_and_colours_the_strokes() {
    let dir = tempfile::tempdir().unwrap();
    let (file, _) = dxf(dir.path(), &["convert", "-"], drawing("80mm", "60mm", 1.0).as_bytes());
    assert_eq!(file.layers(), [("0".to_owned(), 7), ("cut".to_owned(), 1), ("engrave".to_owned(), 132)]);
    let of = |layer: &str| -> Vec<&Entity> { file.entities.iter().filter(|e| e.text(8) == Some(layer)).collect() };
    let (cut, engrave) = (of("cut"), of("engrave"));
    assert_eq!(cut.len() + engrave.len(), file.entities.len());
    assert!(cut.iter().all(|e| e.text(62) == Some("1") && e.text(420).is_none()));
    // The colour is not in the index, so the true one is written, too.
    let true_color = 0x24_b3a8.to_string();
    assert!(engrave.iter().all(|e| e.text(420) == Some(&true_color)));

    // Inkscape's layers count at any depth, by their labels.
    let inkscape = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' \
        width='90' height='90'><g id='all'><g id='l1' inkscape:groupmode='layer' inkscape:label='Müller: cut'>\
        <g id='inner'><path d='M0,0H9V9Z'/></g></g><path d='M0,0H9V9'/></g></svg>";
    let (file, _) = dxf(dir.path(), &["convert", "-"], inkscape.as_bytes());
    let layers: Vec<&str> = file.entities.iter().map(|e| e.text(8).unwrap()).collect();
    assert_eq!(layers, ["M\\U+00FCller_ cut", "0"]);
}

/// CAD programs refuse files with handles that are missing or occur twice, or with entities on unknown layers.
#[test]
fn handles_are_unique_and_references_resolve() {
    let dir = tempfile::tempdir().unwrap();
    let (file, _) = dxf(dir.path(), &["convert", sample("logo.svg").to_str().unwrap()], b"");
    let mut handles = HashSet::new();
    let records: Vec<_> = file.pairs.split(|p| p.0 == 0).collect();
    for r in &records {
        // A dimension style has its handle under 105, since 5 is one of its settings.
        let is_header = r.contains(&(2, "HEADER".to_owned()));
        if let Some((_, handle)) = r.iter().find(|p| p.0 == 5 || p.0 == 105).filter(|_| !is_header) {
            assert!(handles.insert(u64::from_str_radix(handle, 16).unwrap()), "{handle} twice");
        }
    }
    for (_, owner) in records.iter().flat_map(|r| r.iter()).filter(|p| p.0 == 330 || p.0 == 350) {
        let owner = u64::from_str_radix(owner, 16).unwrap();
        assert!(owner == 0 || handles.contains(&owner), "{owner:X}");
    }
    let seed = u64::from_str_radix(file.variable("$HANDSEED"), 16).unwrap();
    assert!(handles.iter().all(|h| *h < seed));
    let layers: HashSet<String> = file.layers().into_iter().map(|l| l.0).collect();
    assert!(file.entities.iter().all(|e| layers.contains(e.text(8).unwrap())));
}

/// Messages name and count the content that outlines cannot show. A clip path that cuts nothing is not reported.
#[test]
fn losses_are_reported() {
    let dir = tempfile::tempdir().unwrap();
    let png = dir.path().join("a.png");
    expect_code(0, &["render", sample("icon.svg").to_str().unwrap(), "-o", png.to_str().unwrap()]);
    let page = |body: &str| {
        format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='90' height='90'><defs><clipPath id='all'>\
             <rect width='90' height='90'/></clipPath><clipPath id='half'><circle cx='9' cy='9' r='9'/></clipPath>\
             <filter id='f'><feGaussianBlur stdDeviation='2'/></filter></defs>{body}</svg>"
        )
    };
    let square = "<path d='M5,5H40V40H5Z'/>";
    for (body, part) in [
        (format!("<g clip-path='url(#all)'>{square}</g>"), ""),
        (
            format!("<g clip-path='url(#half)'>{square}</g>"),
            "of 1 group, parts that a clip path or mask hides are in it",
        ),
        (format!("<g filter='url(#f)'>{square}</g>"), "left out 1 filter"),
        (format!("{square}<image href='a.png' width='9' height='9'/>"), "left out 1 bitmap"),
        ("<path d='M5,5H40' stroke='red' stroke-width='1mm'/>".to_owned(), "1 stroke wider than 0.5 mm"),
        ("<path d='M5,5H40' stroke='red' stroke-width='0.1mm'/>".to_owned(), ""),
    ] {
        fs::write(dir.path().join("in.svg"), page(&body)).unwrap();
        let (file, said) = dxf(dir.path(), &["convert", "in.svg"], b"");
        assert_eq!(file.entities.len(), 1, "{body}");
        assert!(if part.is_empty() { said.is_empty() } else { said.contains(part) }, "{body}: {said}");
    }
    // Shapes that a clip path hides entirely are omitted.
    fs::write(dir.path().join("in.svg"), page("<g clip-path='url(#half)'><path d='M50,50H60V60Z'/></g>")).unwrap();
    let (file, said) = dxf(dir.path(), &["convert", "in.svg"], b"");
    assert!(file.entities.is_empty() && said.is_empty(), "{said}");
}

/// Drawings of maps, far from the origin, are where their page shows them.
#[test]
fn far_drawings_lie_on_their_page() {
    let dir = tempfile::tempdir().unwrap();
    let near = outlines(far(0.0, 0.0).as_bytes());
    for [x, y] in [[1e6, 2e6], [3.67e7, -5.5e6]] {
        let (file, _) = dxf(dir.path(), &["convert", "-"], far(x, y).as_bytes());
        let got = file.polylines();
        let (there, back) = (gap(&got, &near), gap(&near, &got));
        assert!(there.max(back) < SAMPLING, "{x}: {there} {back}");
    }
}
