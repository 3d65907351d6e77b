//! Numbers of the papers on free-form deformation, by the command line.

use super::common::text;
use crate::support::{expect_code, pathwarp_in, sample};
use std::fs;

/// The numbers that `map` prints for some points, line by line.
#[track_caller]
fn mapped(args: &[&str], points: &str) -> Vec<Vec<f64>> {
    let dir = tempfile::tempdir().unwrap();
    let out = pathwarp_in(dir.path(), &[&["map"], args].concat(), points.as_bytes());
    assert!(out.status.success(), "{}", text(&out.stderr));
    text(&out.stdout).lines().map(|l| l.split_whitespace().map(|n| n.parse().unwrap()).collect()).collect()
}

#[track_caller]
fn near(found: &[f64], expected: &[f64]) {
    let close = found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(close, "{found:?} {expected:?}");
}

/// Equations 3 to 6: (8, 4) has two preimages with equal weights, and one with w01 = 5/3.
#[test]
fn all_preimages_of_the_quadrilateral() {
    let expected = [1.0 / 3.0, 0.75, 2.0, 2.0];
    let target = ["--frame", "0,0,1,1", "--target", "8,6 12,4 12,0 0,0", "--target-as-drawn"];
    near(&mapped(&[&["bilinear"][..], &target, &["--inverse", "--all"]].concat(), "8 4")[0], &expected);
    let lattice =
        "ffd --degree 1x1 --at 0,0:0,0 --at 1,0:12,0 --at 0,1:8,6 --at 1,1:12,4 --frame 0,0,1,1 --inverse --all";
    let lattice: Vec<&str> = lattice.split(' ').collect();
    near(&mapped(&lattice, "8 4")[0], &expected);
    let weighted = [&lattice[..], &["--weight", "0,1:1.6666666666666667"]].concat();
    near(&mapped(&weighted, "8 4")[0], &[0.4, 2.0 / 3.0]);
    let rows = ["birational", "--frame", "0,0,1,1", "--left", "0,0 8,6", "--right", "12,0 12,4"];
    let weights = ["--weight", "0,0:1", "--weight", "1,0:1", "--weight", "1,1:1", "--inverse", "--all"];
    near(&mapped(&[&rows[..], &weights].concat(), "8 4")[0], &[0.4, 2.0 / 3.0]);
    // Outside a region nothing moves: a point there is its preimage, beside those inside.
    let moved =
        "ffd --degree 1x1 --region 0,0,1,1 --move 0,0:2,0 --move 1,0:2,0 --move 0,1:2,0 --move 1,1:2,0 --frame 0,0,1,1";
    let moved: Vec<&str> = moved.split(' ').chain(["--inverse", "--all"]).collect();
    near(&mapped(&moved, "2.5 0.5")[0], &[0.5, 0.5, 2.5, 0.5]);
    let (_, e) = expect_code(2, &["map", "ffd", "--all"]);
    assert!(e.contains("--inverse"), "{e}");
}

/// The net of figures 14.6 to 14.9 in these tests: columns of rows, from the regular positions.
const NET: [[(f64, f64); 4]; 3] = [
    [(-4.0, 6.0), (30.0, -34.0), (70.0, 22.0), (106.0, -10.0)],
    [(0.0, 50.0), (20.0, 38.0), (90.0, 68.0), (108.0, 50.0)],
    [(4.0, 92.0), (30.0, 120.0), (60.0, 84.0), (96.0, 108.0)],
];

fn lattice() -> Vec<String> {
    let mut args: Vec<String> = ["--degree", "3x2", "--region", "0,0,100,100", "--extend"].map(String::from).into();
    for (j, row) in NET.iter().enumerate() {
        for (i, (x, y)) in row.iter().enumerate() {
            args.extend(["--at".into(), format!("{i},{j}:{x},{y}")]);
        }
    }
    args
}

/// The point of a Bézier curve by its Bernstein polynomials.
fn bezier(points: &[(f64, f64)], t: f64) -> [f64; 2] {
    let n = points.len() - 1;
    let choose = |i: usize| (0..i).fold(1.0, |c, k| c * (n - k) as f64 / (k + 1) as f64);
    let b = |i: usize| choose(i) * t.powi(i as i32) * (1.0 - t).powi((n - i) as i32);
    points.iter().enumerate().fold([0.0; 2], |[x, y], (i, p)| [x + b(i) * p.0, y + b(i) * p.1])
}

/// Section 14.0.1: the line s = .6 becomes the curve through H₀(.6), H₁(.6), H₂(.6), the line t = .3 the curve through V₀(.3) … V₃(.3).
#[test]
fn control_points_of_deformed_lines() {
    let lattice = lattice();
    let exact = |path: &str| {
        let args = ["ffd", "--frame", "0,0,100,100", "--exact", path].into_iter();
        mapped(&args.chain(lattice.iter().map(String::as_str)).collect::<Vec<_>>(), "")
    };
    let upright = exact("M60,0 V100");
    assert_eq!(upright.len(), 4, "three control points and an empty line");
    for (found, row) in upright.iter().zip(NET) {
        let [x, y] = bezier(&row, 0.6);
        near(found, &[x, y, 1.0]);
    }
    let level = exact("M0,30 H100");
    assert_eq!(level.len(), 5);
    for (i, found) in level[..4].iter().enumerate() {
        let [x, y] = bezier(&NET.map(|row| row[i]), 0.3);
        near(found, &[x, y, 1.0]);
    }
    // A projective map gives a line weights; across them, a line keeps degree 1.
    let line = mapped(&["bilinear", "--frame", "0,0,1,1", "--target", "8,6 12,4 12,0 0,0", "--exact", "M0,0 V1"], "");
    assert_eq!(line.len(), 3);
    let (_, e) = expect_code(2, &["map", "swirl", "--frame", "0,0,1,1", "--exact", "M0,0 V1"]);
    assert!(e.contains("no exact image"), "{e}");
}

/// Figures 14.7 and 14.9: the polygon is drawn over the picture of the result, and only with the option.
#[test]
fn polygons_are_shown_in_previews() {
    let dir = tempfile::tempdir().unwrap();
    let svg = fs::read(sample("papers/lines.svg")).unwrap();
    let lattice = lattice();
    let green = |more: &[&str]| {
        let args = ["ffd", "-", "-o", "o.svg", "--preview", "p.png"].into_iter().chain(more.iter().copied());
        let args: Vec<&str> = args.chain(lattice.iter().map(String::as_str)).collect();
        let out = pathwarp_in(dir.path(), &args, &svg);
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        let png = pathwarp_raster::decode_png(&fs::read(dir.path().join("p.png")).unwrap()).unwrap();
        png.pixels().iter().filter(|p| (p.red(), p.green(), p.blue()) == (0x00, 0x9e, 0x73)).count()
    };
    assert_eq!(green(&[]), 0);
    assert!(green(&["--show-polygons", "#upright"]) > 300);
    let missing = ["ffd", "-", "-o", "o.svg", "--preview", "p.png", "--show-polygons", "#nothing"];
    let out = pathwarp_in(dir.path(), &missing, &svg);
    assert!(text(&out.stderr).contains("selects no path"), "{}", text(&out.stderr));
}
