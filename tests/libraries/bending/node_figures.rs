//! Positions of nodes in glyphs and icons: the figures of docs/benchmarks.md.

use super::nodes::built_in;
use pathwarp::kurbo::{BezPath, Point, Rect, Vec2};
use pathwarp::map::Map;
use pathwarp::refit::{Nodes, Options, warp_path};
use pathwarp::{Outline, Seg, Subpath};
use pathwarp_oracle::{arriving, cubics, leaving, turn};
use std::sync::Arc;

/// Returns the names of fonts and of the icons, each with its outlines.
fn drawings() -> Vec<(String, Vec<Outline>)> {
    let fonts = std::env::var("FONTS").unwrap_or_default();
    let style = pathwarp_text::TextStyle { size: 1000.0, ..Default::default() };
    let mut out = Vec::new();
    for file in fonts.split(':').filter(|f| !f.is_empty()) {
        let bytes = std::fs::read(file).unwrap();
        let font = [pathwarp_text::Font::new(&bytes, 0).unwrap()];
        let glyph = |c: char| {
            let text = pathwarp_text::layout(&c.to_string(), &font, &style).ok()?;
            let path: BezPath = text.lines.iter().flat_map(|l| &l.clusters).flat_map(|c| c.outline.iter()).collect();
            Some(Outline::from_svg(&path.to_svg()).unwrap()).filter(|o| !o.subpaths.is_empty())
        };
        let name = std::path::Path::new(file).file_stem().unwrap().to_string_lossy().into_owned();
        out.push((name, (' '..='~').filter_map(glyph).collect()));
    }
    let (icons, fetched) = pathwarp_oracle::corpus();
    let every = if fetched { icons.len() / 200 } else { 1 };
    out.push(("icons".to_owned(), icons.into_iter().step_by(every).take(200).collect()));
    out
}

/// Returns maps as the program makes them for a drawing in this box.
fn usual(frame: Rect) -> Vec<(&'static str, Arc<dyn Map>)> {
    let (Rect { x0, y0, x1, y1 }, w) = (frame, frame.width());
    let r = 0.6 * w.max(frame.height());
    let perspective = format!("{},{} {},{} {x1},{y1} {x0},{y1}", x0 + 0.2 * w, y0, x1 - 0.2 * w, y0);
    let heart = "M100,50 C118,0 200,0 200,65 C200,120 140,145 100,185 C60,145 0,120 0,65 C0,0 82,0 100,50 Z";
    let ring = format!("M-{r},0A{r},{r} 0 0 1 {r},0A{r},{r} 0 0 1 -{r},0Z");
    let mut out: Vec<(&str, Arc<dyn Map>)> = Vec::new();
    for style in ["arch", "bulge", "inflate", "flag", "fisheye"] {
        out.push((style, built_in("warp", &[("style", style), ("bend", "50%")], frame)));
    }
    out.push(("perspective", built_in("projective", &[("target", &perspective)], frame)));
    out.push(("heart", built_in("envelope", &[("envelope", heart), ("keep", "verticals")], frame)));
    out.push(("on a circle", built_in("bend", &[("along", &ring)], frame)));
    out
}

/// Returns the indices of a closed subpath's nodes that are its structure, by their definition.
fn structure(sub: &Subpath) -> Vec<usize> {
    let n = sub.segs.len();
    let axis = |v: Vec2| (0..2).find(|c| [v.x, v.y][*c].abs() <= 0.0087 * v.hypot());
    let is_structure = |i: usize| {
        let (before, after) = (&sub.segs[(i + n - 1) % n], &sub.segs[i]);
        let (into, away) = (arriving(&before.to_cubic()), leaving(&after.to_cubic()));
        let is_line = |s: &Seg| matches!(s, Seg::Line(_));
        let node = after.start();
        let side = |p: Point, c: usize| if c == 0 { p.x - node.x } else { p.y - node.y };
        let extreme = axis(into)
            .is_some_and(|c| axis(away) == Some(c) && side(before.eval(0.95), c) * side(after.eval(0.05), c) > 0.0);
        turn(into, away) > 0.5 || is_line(before) != is_line(after) || extreme
    };
    (0..n).filter(|i| is_structure(*i)).collect()
}

/// Returns `true` if the result has a node at the image of a node of the source, or at the image's extreme within a turn of 20° from it.
fn is_kept(sub: &Subpath, i: usize, map: &dyn Map, nodes: &[(Point, [Vec2; 2])], near: f64) -> bool {
    let n = sub.segs.len();
    let image = map.jet(sub.segs[i].start()).p;
    if nodes.iter().any(|(p, _)| p.distance(image) <= 1e-6 * near.max(1e-3)) {
        return true;
    }
    let place = |k: isize| {
        let k = k.rem_euclid(256 * n as isize) as usize;
        let (seg, t) = (&sub.segs[k / 256], (k % 256) as f64 / 256.0);
        let jet = map.jet(seg.eval(t));
        (jet.p, jet.push(seg.deriv(t)))
    };
    let along = |[u, v]: [Vec2; 2]| (u.x == 0.0 && v.x == 0.0) || (u.y == 0.0 && v.y == 0.0);
    [1, -1].into_iter().any(|way| {
        let start = 256 * i as isize;
        let first = place(start + way).1;
        (1..256).take_while(|k| turn(place(start + way * k).1, first) <= 21.0).any(|k| {
            let [(p, u), (q, v)] = [place(start + way * k), place(start + way * (k + 1))];
            (u.x * v.x <= 0.0 || u.y * v.y <= 0.0)
                && nodes
                    .iter()
                    .any(|(at, handles)| at.distance(p).min(at.distance(q)) <= p.distance(q) + near && along(*handles))
        })
    })
}

fn nodes_of(path: &BezPath) -> Vec<(Point, [Vec2; 2])> {
    let all = cubics(path);
    let before = |i: usize| (0..all.len()).find(|j| all[*j].p3 == all[i].p0).unwrap_or(i);
    (0..all.len()).map(|i| (all[i].p0, [arriving(&all[before(i)]), leaving(&all[i])])).collect()
}

/// Prints the figures of docs/benchmarks.md, which has the command.
#[test]
#[ignore = "takes minutes"]
fn figures() {
    let mut all = [0; 5];
    for (name, outlines) in drawings() {
        for k in 0..8 {
            let (mut map_name, mut sums) = ("", [0; 5]);
            for outline in &outlines {
                let Some(frame) = outline.bounding_box().filter(|b| b.area() > 0.0) else { continue };
                let (title, map) = usual(frame).swap_remove(k);
                map_name = title;
                let tolerance = 1e-4 * frame.width().hypot(frame.height());
                let options = Options::new(tolerance).with_suited(true);
                for (j, nodes) in [Nodes::Fewest, Nodes::Auto, Nodes::Extremes].into_iter().enumerate() {
                    let Ok(warped) = warp_path(outline, &map, &options.clone().with_nodes(nodes)) else { continue };
                    sums[j] += warped.report.segments_out;
                    if nodes == Nodes::Auto {
                        let found = nodes_of(&warped.path);
                        for sub in outline.subpaths.iter().filter(|s| s.closed && s.segs.len() > 1) {
                            for i in structure(sub) {
                                sums[3] += 1;
                                sums[4] += usize::from(is_kept(sub, i, &*map, &found, tolerance));
                            }
                        }
                    }
                }
            }
            row(&format!("{name}, {map_name}"), &sums);
            (0..5).for_each(|j| all[j] += sums[j]);
        }
    }
    row("all", &all);
}

fn row(name: &str, [fewest, auto, extremes, structure, kept]: &[usize; 5]) {
    let to = |n: usize| n as f64 / *fewest as f64;
    let share = 100.0 * *kept as f64 / *structure as f64;
    println!("{name:<36} {fewest:>6} {:>7.3} {:>7.3} {share:>8.2} % of {structure}", to(*auto), to(*extremes));
}
