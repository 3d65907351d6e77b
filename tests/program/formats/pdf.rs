//! PDF files: their size in points.

use crate::support::geometry::documents;
use crate::support::pathwarp_in;

/// The width and height of a page in points.
fn page(pdf: &[u8]) -> [f64; 2] {
    let text = String::from_utf8_lossy(pdf);
    let list = text.split("/MediaBox [").nth(1).unwrap().split(']').next().unwrap().to_owned();
    let numbers: Vec<f64> = list.split_whitespace().map(|v| v.parse().unwrap()).collect();
    let [x, y, w, h] = numbers[..] else { panic!("{list}") };
    assert_eq!((x, y), (0.0, 0.0));
    [w, h]
}

#[test]
fn the_page_has_the_size_of_the_drawing() {
    let dir = tempfile::tempdir().unwrap();
    for (name, svg) in documents() {
        let out = pathwarp_in(dir.path(), &["convert", "-", "--format", "pdf"], svg.as_bytes());
        let size = page(&out.stdout);
        // 80 mm and 60 mm in points.
        let wanted = [80.0, 60.0].map(|mm| mm / 25.4 * 72.0);
        assert!(size.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-3), "{name}: {size:?} {wanted:?}");
        let again = pathwarp_in(dir.path(), &["convert", "-", "--format", "pdf"], svg.as_bytes());
        assert_eq!(out.stdout, again.stdout, "no dates, no random ids");
    }
}

/// Pages beyond 14400 points have a larger unit.
#[test]
fn a_huge_page_keeps_its_size() {
    let dir = tempfile::tempdir().unwrap();
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='11m' height='2m' viewBox='0 0 110 20'><path d='M0,0H9V9Z'/></svg>";
    let svg = svg.replace("11m", "11000mm").replace("2m'", "2000mm'");
    let out = pathwarp_in(dir.path(), &["convert", "-", "--format", "pdf"], svg.as_bytes());
    let text = String::from_utf8_lossy(&out.stdout);
    let unit: f64 = text.split("/UserUnit ").nth(1).unwrap().split_whitespace().next().unwrap().parse().unwrap();
    let [width, _] = page(&out.stdout);
    assert!(width <= 14_400.0 && (width * unit - 11_000.0 / 25.4 * 72.0).abs() < 0.05, "{width} {unit}");
}
