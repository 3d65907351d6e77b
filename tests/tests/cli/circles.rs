//! Circles and arcs as path references.

use super::common::text;
use crate::support::pathwarp_in;

#[track_caller]
fn mapped(along: &str, points: &str) -> Vec<[f64; 2]> {
    let dir = tempfile::tempdir().unwrap();
    let args = ["map", "bend", "--along", along, "--baseline", "0", "--frame", "0,0,100,50"];
    let out = pathwarp_in(dir.path(), &args, points.as_bytes());
    assert!(out.status.success(), "{}", text(&out.stderr));
    let point = |line: &str| {
        let (x, y) = line.split_once(' ').unwrap();
        [x.parse().unwrap(), y.parse().unwrap()]
    };
    text(&out.stdout).lines().map(point).collect()
}

/// The baseline runs along the true circle: the middle on its top, a quarter of the circumference further on its right.
#[test]
fn artwork_bends_along_circles_and_arcs() {
    const QUARTER: f64 = 10.0 * std::f64::consts::FRAC_PI_2;
    let points = format!("50 50\n{} 50\n50 45\n{} 50", 50.0 + QUARTER, 50.0 + 0.5 * QUARTER);
    let r2 = std::f64::consts::FRAC_1_SQRT_2;
    let upper = [[50.0, 15.0], [60.0, 25.0], [50.0, 10.0], [50.0 + 10.0 * r2, 25.0 - 10.0 * r2]];
    let near = |got: &[[f64; 2]], expected: &[[f64; 2]], what: &str| {
        for (a, b) in got.iter().zip(expected) {
            assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9, "{what}: {a:?} {b:?}");
        }
    };
    for along in [
        "circle:r=10",
        "circle:r=10%",
        "circle:r=10,cx=50%,cy=25",
        "arc:r=10,from=180,to=360",
        "arc:r=10,from=0.5turn,to=0",
    ] {
        // The last one is the lower half.
        let got = mapped(along, &points);
        if along.ends_with("to=0") {
            near(&got, &[[50.0, 35.0], [60.0, 25.0], [50.0, 30.0], [50.0 + 10.0 * r2, 25.0 + 10.0 * r2]], along);
        } else {
            near(&got, &upper, along);
        }
    }
    near(&mapped("circle:r=1in,cx=0,cy=0", "50 50"), &[[0.0, -96.0]], "an inch");
}

/// Millimetres are those of the page, also in an option of another deformation.
#[test]
fn a_circle_in_a_drawing_has_its_size_on_the_page() {
    let dir = tempfile::tempdir().unwrap();
    let drawing =
        "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' viewBox='0 0 100 50'><path id='p' d='M30,25H70'/></svg>";
    let args = ["bend", "-", "--along", "circle:r=20mm,cx=50mm,cy=60mm", "-q", "--frame", "0,0,100,50"];
    let out = pathwarp_in(dir.path(), &args, drawing.as_bytes());
    let list = pathwarp_in(dir.path(), &["paths", "-", "--json"], &out.stdout);
    let list: serde_json::Value = serde_json::from_slice(&list.stdout).unwrap();
    let points = list["paths"][0]["strokes"][0]["points"].as_array().unwrap();
    // Incoming handle, anchor, outgoing handle.
    for anchor in points.chunks(3).map(|c| &c[1]) {
        let (x, y) = (anchor[0].as_f64().unwrap() - 50.0, anchor[1].as_f64().unwrap() - 60.0);
        assert!((x.hypot(y) - 20.0).abs() < 0.01, "{anchor}");
    }
    let args = ["envelope", "-", "--envelope", "circle:r=20mm", "-q"];
    let out = pathwarp_in(dir.path(), &args, drawing.replace("M30,25H70", "M30,20H70V40H30Z").as_bytes());
    assert!(out.status.success(), "{}", text(&out.stderr));
}

#[test]
fn errors_name_the_wrong_value() {
    let dir = tempfile::tempdir().unwrap();
    for (along, part) in [
        ("circle:", "has no r: write circle:r=60mm"),
        ("circle:r=-2mm", "must be larger than 0"),
        ("circle:r=2,x=5", "`x`; circle takes r, cx, cy"),
        ("arc:r=2,from=0", "has no to"),
        ("arc:r=2,from=0,to=500", "at most 360°"),
        ("arc:r=2,from=here,to=5", "wrong from: `here`"),
    ] {
        let out = pathwarp_in(dir.path(), &["bend", "-", "--along", along], super::common::SQUARE.as_bytes());
        let said = text(&out.stderr);
        assert!(out.status.code() == Some(2) && said.contains(part) && said.contains("--along"), "{along}: {said}");
    }
}
