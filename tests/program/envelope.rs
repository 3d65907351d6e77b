//! Envelopes through the program: straightness measured on the output SVG, and shapes of the drawing as envelopes.

use crate::support::{expect_code, sample};
use pathwarp::kurbo::{Point, Rect};
use pathwarp_svg::{Document, ReadOptions};
use std::fs;

fn document(file: &std::path::Path) -> Document {
    Document::read(&fs::read(file).unwrap(), "out", &ReadOptions::default()).unwrap()
}

/// Dense samples along a named path of a drawing.
fn along(doc: &Document, name: &str) -> Vec<Point> {
    const SAMPLES: u32 = 500;
    let outline = doc.path(name).unwrap().outline;
    outline.segs().flat_map(|s| (0..=SAMPLES).map(move |i| s.eval(f64::from(i) / f64::from(SAMPLES)))).collect()
}

/// `--keep verticals` keeps vertical lines vertical within 0.1°, and `--keep horizontals` horizontal lines horizontal.
#[test]
fn kept_lines_are_straight_in_the_file() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out.svg").display().to_string();
    let grid = sample("grid.svg").display().to_string();
    let envelopes = sample("envelopes.svg").display().to_string();
    let (valley, hill) = (format!("{envelopes}#valley"), format!("{envelopes}#hill"));
    let lying = ["--bottom", &valley, "--top", &hill, "--keep", "verticals"];
    let standing = [
        "--left",
        "M30,220 C-10,150 60,90 20,10",
        "--right",
        "M200,220 C250,150 170,80 210,10",
        "--keep",
        "horizontals",
    ];
    for (args, prefix) in [(lying, "v"), (standing, "h")] {
        let mut all = vec!["envelope", &grid, "-o", &out, "--strokes", "keep", "--fit", "grow"];
        all.extend(args);
        let (_, messages) = expect_code(0, &all);
        assert!(messages.is_empty(), "{messages}");
        let doc = document(std::path::Path::new(&out));
        for k in 0..=10 {
            let name = format!("{prefix}{k}");
            let points = along(&doc, &name);
            let (a, b) = (points[0], points[points.len() - 1]);
            let (off, length) = if prefix == "v" { (b.x - a.x, b.y - a.y) } else { (b.y - a.y, b.x - a.x) };
            let lean = off.abs().atan2(length.abs()).to_degrees();
            assert!(lean < 0.1, "{name} leans by {lean}°");
            let bent = points.iter().map(|p| (*p - a).cross(b - a).abs() / (b - a).hypot()).fold(0.0, f64::max);
            // Coordinates are written to a hundredth of the tolerance.
            assert!(bent < 1e-3, "{name} is bent by {bent}");
        }
    }
}

/// A shape of the drawing serves as the envelope and stays unchanged; the artwork fills it without being mirrored.
#[test]
fn an_object_of_the_drawing_is_the_envelope() {
    let dir = tempfile::tempdir().unwrap();
    let (file, out) = (dir.path().join("in.svg"), dir.path().join("out.svg"));
    let shapes = [
        "<circle id='shape' cx='150' cy='90' r='70' fill='none'/>",
        "<ellipse id='shape' cx='75' cy='90' rx='35' ry='70' transform='scale(2 1)'/>",
        "<rect id='shape' x='80' y='20' width='140' height='140' rx='30'/>",
        "<path id='shape' d='M150,20 L220,20 L220,160 L80,160 L80,20 Z'/>",
    ];
    for shape in shapes {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 300 180'><rect id='box' width='100' height='50'/>\
<path id='flag' d='M5,5 L30,5 L5,20 Z'/>{shape}</svg>"
        );
        fs::write(&file, &svg).unwrap();
        let [input, output] = [&file, &out].map(|p| p.display().to_string());
        let (_, said) = expect_code(0, &["envelope", &input, "--envelope", "#shape", "--explain", "-o", &output]);
        assert!(said.contains("corners of") && said.contains("bottom side"), "{said}");
        assert!(fs::read_to_string(&out).unwrap().contains(shape), "the shape is left as it was");
        let doc = document(&out);
        let bounds = |points: Vec<Point>| {
            points
                .iter()
                .fold(None, |b: Option<Rect>, p| Some(b.map_or(Rect::from_points(*p, *p), |b| b.union_pt(*p))))
                .unwrap()
        };
        let filled = bounds(along(&doc, "box"));
        let near = |a: f64, b: f64| (a - b).abs() < 0.05;
        assert!(
            near(filled.x0, 80.0) && near(filled.x1, 220.0) && near(filled.y0, 20.0) && near(filled.y1, 160.0),
            "{shape}: {filled:?}"
        );
        // The small flag is in the upper left and not mirrored: its corners keep their orientation.
        let flag = doc.path("flag").unwrap().outline.subpaths[0].anchors();
        let middle = bounds(flag.clone()).center();
        assert!(middle.x < 150.0 && middle.y < 90.0, "{shape}: {flag:?}");
        let turn: f64 = flag.iter().zip(flag.iter().cycle().skip(1)).map(|(a, b)| a.to_vec2().cross(b.to_vec2())).sum();
        assert!(turn > 0.0, "{shape}: mirrored");
    }
}
