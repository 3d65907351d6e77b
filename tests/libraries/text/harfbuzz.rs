//! Compares glyphs, positions, outlines and heights with HarfBuzz (recorded by `fonts/make.py`).

use super::common::{bundled, file};
use pathwarp::kurbo::{Affine, BezPath, PathEl, Point};
use pathwarp_text::{Direction, Feature, Font, TextStyle, Variation, layout};
use serde_json::Value;

/// A thousandth of a font unit: the single precision of HarfBuzz's outlines at coordinates up to some thousands.
const TOLERANCE: f64 = 1e-3;

struct HarfBuzzCase {
    name: String,
    all: Value,
}

impl HarfBuzzCase {
    fn text(&self, key: &str) -> String {
        self.all[key].as_str().unwrap().to_owned()
    }

    fn pairs(&self, key: &str) -> Vec<(String, f64)> {
        self.all[key].as_object().unwrap().iter().map(|(k, v)| (k.clone(), v.as_f64().unwrap())).collect()
    }

    fn upem(&self) -> f64 {
        self.all["upem"].as_f64().unwrap()
    }

    fn font_bytes(&self) -> Vec<u8> {
        match self.text("font").as_str() {
            "bundled" => bundled(),
            name => file(name),
        }
    }

    fn font<'a>(&self, bytes: &'a [u8]) -> Font<'a> {
        let places: Vec<Variation> =
            self.pairs("variations").iter().map(|(tag, v)| Variation::new(tag, *v).unwrap()).collect();
        Font::new(bytes, 0).unwrap().with_variations(&places).unwrap()
    }

    /// Returns a style in which a font unit is a user unit.
    fn style(&self) -> TextStyle {
        TextStyle {
            size: self.upem(),
            direction: if self.text("direction") == "rtl" { Direction::Rtl } else { Direction::Ltr },
            language: Some(self.text("language")),
            features: self.pairs("features").iter().map(|(tag, v)| Feature::new(tag, *v as u32).unwrap()).collect(),
            ..TextStyle::default()
        }
    }

    /// Returns the glyphs of HarfBuzz: number, byte in the text, advance, offsets.
    fn glyphs(&self) -> Vec<[f64; 5]> {
        let numbers = |g: &Value| -> Vec<f64> { g.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect() };
        self.all["glyphs"].as_array().unwrap().iter().map(|g| numbers(g).try_into().unwrap()).collect()
    }

    /// Returns the outline of a glyph from HarfBuzz, y up, in font units.
    fn outline(&self, glyph: u32) -> BezPath {
        let mut path = BezPath::new();
        for op in self.all["outlines"][glyph.to_string()].as_array().unwrap() {
            let p: Vec<f64> = op[1].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
            let at = |i: usize| Point::new(p[2 * i], p[2 * i + 1]);
            match op[0].as_str().unwrap() {
                "moveTo" => path.move_to(at(0)),
                "lineTo" => path.line_to(at(0)),
                "qCurveTo" => path.quad_to(at(0), at(1)),
                "curveTo" => path.curve_to(at(0), at(1), at(2)),
                "closePath" => path.close_path(),
                other => panic!("{other}"),
            }
        }
        path
    }
}

fn cases() -> Vec<HarfBuzzCase> {
    let all: Value = serde_json::from_slice(&file("harfbuzz.json")).unwrap();
    let cases = all["cases"].as_array().unwrap();
    assert!(cases.len() >= 19);
    cases.iter().map(|c| HarfBuzzCase { name: c["name"].as_str().unwrap().to_owned(), all: c.clone() }).collect()
}

/// Removes a line back to the start, which is drawn anyway when the subpath is closed.
fn without_closing_lines(path: &BezPath) -> Vec<PathEl> {
    let mut out: Vec<PathEl> = Vec::new();
    let mut start = Point::ZERO;
    for el in path.elements() {
        match (el, out.last()) {
            (PathEl::MoveTo(p), _) => start = *p,
            (PathEl::ClosePath, Some(PathEl::LineTo(p))) if p.distance(start) < TOLERANCE => {
                out.pop();
            }
            _ => {}
        }
        out.push(*el);
    }
    out
}

fn points(el: &PathEl) -> (char, Vec<Point>) {
    match *el {
        PathEl::MoveTo(p) => ('M', vec![p]),
        PathEl::LineTo(p) => ('L', vec![p]),
        PathEl::QuadTo(a, p) => ('Q', vec![a, p]),
        PathEl::CurveTo(a, b, p) => ('C', vec![a, b, p]),
        PathEl::ClosePath => ('Z', vec![]),
    }
}

#[track_caller]
fn same(ours: &BezPath, theirs: &BezPath, what: &str) {
    let (ours, theirs) = (without_closing_lines(ours), without_closing_lines(theirs));
    assert_eq!(ours.len(), theirs.len(), "{what}");
    for (i, (a, b)) in ours.iter().zip(&theirs).enumerate() {
        let ((kind_a, a), (kind_b, b)) = (points(a), points(b));
        assert_eq!(kind_a, kind_b, "{what}, piece {i}");
        for (p, q) in a.iter().zip(&b) {
            assert!(p.distance(*q) < TOLERANCE, "{what}, piece {i}: {p} is not {q}");
        }
    }
}

#[test]
fn glyphs_and_positions_match_harfbuzz() {
    for case in cases() {
        let bytes = case.font_bytes();
        let set = layout(&case.text("text"), &[case.font(&bytes)], &case.style()).unwrap();
        let [line] = &set.lines[..] else { panic!("{}", case.name) };
        let ours: Vec<(f64, &pathwarp_text::PlacedGlyph)> =
            line.clusters.iter().flat_map(|c| c.glyphs.iter().map(move |g| (c.origin.x, g))).collect();
        let theirs = case.glyphs();
        let ids = |all: &[[f64; 5]]| all.iter().map(|g| g[0] as u32).collect::<Vec<_>>();
        assert_eq!(ours.iter().map(|(_, g)| g.id).collect::<Vec<_>>(), ids(&theirs), "{}", case.name);
        let mut pen = 0.0;
        for ((x, g), [_, _, advance, dx, dy]) in ours.iter().zip(&theirs) {
            let off = (x + g.dx - pen - dx).abs() + (g.dy + dy).abs() + (g.advance - advance).abs();
            assert!(off < TOLERANCE, "{}: {g:?} at {x}", case.name);
            pen += advance;
        }
        assert!((line.end.x - line.start.x - pen).abs() < TOLERANCE, "{}", case.name);
    }
}

/// The characters of a cluster extend from its first one to the first one of the next cluster.
#[test]
fn clusters_match_harfbuzz() {
    for case in cases() {
        let (bytes, text) = (case.font_bytes(), case.text("text"));
        let set = layout(&text, &[case.font(&bytes)], &case.style()).unwrap();
        let mut starts: Vec<usize> = case.glyphs().iter().map(|g| g[1] as usize).collect();
        starts.dedup();
        let mut sorted = starts.clone();
        sorted.sort_unstable();
        sorted.push(text.len());
        let expected: Vec<&str> = starts.iter().map(|s| &text[*s..*sorted.iter().find(|e| *e > s).unwrap()]).collect();
        let ours: Vec<&str> = set.lines[0].clusters.iter().map(|c| c.text.as_str()).collect();
        assert_eq!(ours, expected, "{}", case.name);
    }
}

#[test]
fn outlines_match_harfbuzz() {
    for case in cases() {
        let bytes = case.font_bytes();
        let set = layout(&case.text("text"), &[case.font(&bytes)], &case.style()).unwrap();
        let baseline = set.lines[0].start.y;
        let mut pen = 0.0;
        let mut theirs = BezPath::new();
        for [id, _, advance, dx, dy] in case.glyphs() {
            let place = Affine::translate((pen + dx, baseline - dy)) * Affine::FLIP_Y;
            theirs.extend(place * case.outline(id as u32));
            pen += advance;
        }
        let mut ours = BezPath::new();
        ours.extend(set.lines[0].clusters.iter().flat_map(|c| c.outline.iter()));
        same(&ours, &theirs, &case.name);
    }
}

#[test]
fn heights_match_harfbuzz() {
    for case in cases() {
        let bytes = case.font_bytes();
        let ours = case.font(&bytes).metrics(case.upem());
        let theirs = |key: &str| case.all["heights"][key].as_f64().unwrap();
        for (key, ours) in [
            ("ascent", ours.ascent),
            ("descent", ours.descent),
            ("line_gap", ours.line_gap),
            ("cap_height", ours.cap_height),
            ("x_height", ours.x_height),
        ] {
            // HarfBuzz rounds the variations of a variable font to whole units.
            assert!((ours - theirs(key)).abs() <= 0.5 + TOLERANCE, "{}: {key} {ours}", case.name);
        }
    }
}
