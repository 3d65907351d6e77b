//! The promise of `simplify` and `outline`: few nodes within the distance, measured between the text of the source and of the result.

use super::paths::drawn;
use crate::support::pathwarp_in;
use pathwarp::kurbo::Vec2;
use pathwarp_oracle::curves::{self, Curve};
use pathwarp_oracle::{Random, Run, Sampled, far};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Runs a command over a drawing and returns its result and its messages.
fn run(args: &[&str], svg: &str) -> (String, String) {
    let out = pathwarp_in(std::env::temp_dir().as_path(), args, svg.as_bytes());
    assert!(out.status.success(), "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
    (String::from_utf8(out.stdout).unwrap(), String::from_utf8(out.stderr).unwrap())
}

fn drawing(d: &str) -> String {
    format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 300 300'><path id=\"a\" d=\"{d}\"/></svg>")
}

/// The path data of the only path.
fn data(svg: &str) -> Vec<Vec<Curve>> {
    curves::read(svg.split_once(" d=\"").unwrap().1.split_once('"').unwrap().0)
}

/// The distance between two paths in both directions.
fn apart(a: &[Vec<Curve>], b: &[Vec<Curve>], tolerance: f64) -> f64 {
    let [a, b]: [Vec<Run<'_>>; 2] = [a, b].map(|p| p.iter().map(|s| Run::of(s)).collect());
    let [a, b]: [Vec<Sampled<'_>>; 2] = [&a, &b].map(|p| p.iter().map(|s| s.sampled(300, tolerance)).collect());
    let one = |a: &[Sampled<'_>], b: &[Sampled<'_>]| a.iter().map(|s| far(&s.points, b).0).fold(0.0, f64::max);
    one(&a, &b).max(one(&b, &a))
}

/// A circle of radius 100 in `n` cubics, or as a polygon.
fn circle(n: usize, polygon: bool) -> String {
    let at = |i: usize| Vec2::from_angle(TAU * i as f64 / n as f64);
    let k = 4.0 / 3.0 * (TAU / n as f64 / 4.0).tan();
    let mut d = String::new();
    for i in 0..=n {
        let p = |v: Vec2| format!("{:.4} {:.4}", 150.0 + 100.0 * v.x, 150.0 + 100.0 * v.y);
        let _ = match (i, polygon) {
            (0, _) => write!(d, "M{}", p(at(0))),
            (_, true) => write!(d, "L{}", p(at(i % n))),
            _ => {
                let (a, b) = (at(i - 1), at(i % n));
                let turned = |v: Vec2| Vec2::new(-v.y, v.x) * k;
                write!(d, "C{} {} {}", p(a + turned(a)), p(b - turned(b)), p(b))
            }
        };
    }
    d + "Z"
}

#[test]
fn a_circle_of_forty_cubics_gets_four() {
    let source = drawing(&circle(40, false));
    let (svg, said) = run(&["simplify", "--tolerance", "0.1"], &source);
    let path = data(&svg);
    assert_eq!(path[0].len(), 4, "{svg}");
    assert!(apart(&data(&source.replace('\'', "\"")), &path, 0.1) <= 0.1);
    assert!(said.contains("40 nodes became 4"), "{said}");
}

#[test]
fn paths_of_drawings_get_fewer_nodes_within_the_distance() {
    let (mut fewer, mut r) = (0, Random::new(17));
    for _ in 0..60 {
        let (kind, d) = drawn(&mut r);
        if kind != "of drawings" {
            continue;
        }
        let (svg, _) = run(&["simplify", "--tolerance", "0.05"], &drawing(&d));
        let (before, after) = (data(&drawing(&d)), data(&svg));
        let count = |p: &[Vec<Curve>]| p.iter().map(Vec::len).sum::<usize>();
        assert!(count(&after) <= count(&before), "{d}\n{svg}");
        fewer += usize::from(count(&after) < count(&before));
        let distance = apart(&before, &after, 0.05);
        assert!(distance <= 0.0501, "{distance}: {d}\n{svg}");
    }
    assert!(fewer > 2, "{fewer} got fewer nodes");
}

#[test]
fn only_what_gets_fewer_nodes_is_written_anew() {
    let c = circle(40, false);
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 300 300'><defs><path id='d' d='{c}'/></defs>\n\
         <rect  x='1' y='2' width='30' height='10' rx='2'/><circle r='5'/><text y='20'>Word</text>\n\
         <path d='M0,0 L10,0 L10,10 z'/><use href='#d' class='x'/><use href='#d' transform='scale(.5)'/></svg>"
    );
    let (out, said) = run(&["simplify"], &svg);
    let (before, after) = (svg.split_once("'/></defs>").unwrap().1, out.split_once("'/></defs>").unwrap().1);
    assert_eq!(before, after);
    assert!(out.len() < svg.len() / 2 && said.contains("became"), "{out}\n{said}");
}

#[test]
fn strokes_and_text_become_outlines_and_nothing_else_changes() {
    let kept = "<path d='M1 1h9v9z' fill='red'/><rect width='5' height='6'/>";
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{kept}<path d='M10 50H90' stroke='blue' stroke-width='8'/>\
         <text x='5' y='90'>Word</text></svg>"
    );
    let (out, _) = run(&["outline"], &svg);
    assert!(out.contains(kept) && !out.contains("<text"), "{out}");
    let stroke = out.split("<path").find(|p| p.contains("fill=\"blue\"") || p.contains("#0000ff")).unwrap();
    let corners = curves::read(stroke.split_once("d=\"").unwrap().1.split_once('"').unwrap().0);
    let bounds = corners[0].iter().map(|c| c.at(0.0)).fold((f64::MAX, f64::MIN), |(a, b), p| (a.min(p.y), b.max(p.y)));
    assert_eq!((corners[0].len(), bounds), (4, (46.0, 54.0)), "{stroke}");
    let (skipped, _) = run(&["outline", "--text", "skip"], &svg);
    assert!(skipped.contains("<text"), "{skipped}");
}
