//! Curves as dense polylines, and the distance between two sets of them.

use pathwarp::Seg;
use pathwarp::kurbo::{Affine, Point};
use pathwarp_oracle::Polygon;
use pathwarp_svg::{Document, ReadOptions};

/// Millimetres per px.
pub const MM: f64 = 25.4 / 96.0;
/// Distance of points along a segment, in mm.
const STEP: f64 = 0.05;

/// A drawing of 80 mm by 60 mm with lines, circles, ellipses, arcs, quadratics and cubics; `per_mm` units are a millimetre.
pub fn drawing(width: &str, height: &str, per_mm: f64) -> String {
    let [w, h] = [80.0, 60.0].map(|v| v * per_mm);
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' viewBox='0 0 {w} {h}'>\n\
         <g transform='scale({per_mm})' fill='none' stroke-width='0.1'>\n\
         <g id='cut' stroke='#f00'>\n\
         <rect x='2' y='2' width='30' height='20' rx='4'/><circle cx='50' cy='14' r='10'/>\n\
         <path d='M70,2 V22 M74,2 l4,20'/>\n\
         <path d='M40,40 a6,6 0 1 1 6,6'/>\n\
         </g>\n\
         <g id='engrave' fill='#24b3a8'>\n\
         <ellipse cx='16' cy='40' rx='12' ry='6' transform='rotate(25 16 40)'/>\n\
         <path d='M34,55 C36,40 44,62 52,52 S60,40 64,50 Q70,58 76,48 V56 H34 Z'/>\n\
         <path d='M60,30 A9,5 30 0 1 74,34 L70,40 Z'/>\n\
         </g></g></svg>"
    )
}

/// Returns that drawing in documents with different units.
pub fn documents() -> [(&'static str, String); 4] {
    [
        ("px", drawing("302.36220472440942", "226.77165354330708", 96.0 / 25.4)),
        ("mm", drawing("80mm", "60mm", 1.0)),
        ("inch", drawing("3.1496062992125986in", "2.3622047244094488in", 1.0 / 25.4)),
        ("points", drawing("8cm", "60mm", 72.0 / 25.4)),
    ]
}

/// The painted outlines of an SVG as polylines in mm, y up from the bottom of the page.
pub fn outlines(svg: &[u8]) -> Vec<Vec<Point>> {
    let doc = Document::read(svg, "svg", &ReadOptions::default()).unwrap();
    let to_mm = Affine::new([MM, 0.0, 0.0, -MM, 0.0, doc.size_px().height * MM]) * doc.user_to_px();
    let painted = doc.shapes().iter().filter(|s| s.painted);
    let subpaths = painted.flat_map(|s| s.outline.transformed(to_mm).subpaths);
    let points = |segs: &[Seg]| {
        let one = |s: &Seg| {
            let c = s.to_cubic();
            let length = c.p0.distance(c.p1) + c.p1.distance(c.p2) + c.p2.distance(c.p3);
            let n = (length / STEP).clamp(20.0, 2000.0).ceil() as usize;
            let s = *s;
            (0..=n).map(move |i| s.eval(i as f64 / n as f64))
        };
        segs.iter().flat_map(one).collect::<Vec<Point>>()
    };
    subpaths.map(|s| points(&s.segs)).filter(|p| !p.is_empty()).collect()
}

/// Returns the largest distance from a point of `a` to the lines of `b`.
pub fn gap(a: &[Vec<Point>], b: &[Vec<Point>]) -> f64 {
    let edges = |lines: &[Vec<Point>]| -> Vec<[Point; 2]> {
        lines.iter().flat_map(|l| l.windows(2)).map(|w| [w[0], w[1]]).collect()
    };
    let lines = Polygon::new(edges(b));
    // Include points on long lines.
    let between = |[p, q]: &[Point; 2]| {
        let n = (p.distance(*q) / 0.1).ceil().max(1.0) as usize;
        (0..=n).map(|i| lines.distance(p.lerp(*q, i as f64 / n as f64))).fold(0.0, f64::max)
    };
    edges(a).iter().map(between).fold(0.0, f64::max)
}

/// Returns a drawing on a page of 100 mm at x, y: a path, a circle, and a group with a transform.
pub fn far(x: f64, y: f64) -> String {
    let at = |u: f64, v: f64| format!("{} {}", x + u, y + v);
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='100mm' viewBox='{} 100 100'>\n\
         <path d='M{}C{} {} {}L{}Z' fill='none' stroke='red' stroke-width='.1'/>\n\
         <circle cx='{}' cy='{}' r='12.34'/>\n\
         <g transform='translate({x} {y})'><path d='M5.5 60.25h20.125v11.3l-7 8.2Z'/></g></svg>",
        at(0.0, 0.0),
        at(10.1, 20.2),
        at(30.3, 5.05),
        at(50.7, 60.6),
        at(80.25, 41.3),
        at(35.0, 90.15),
        x + 70.5,
        y + 70.25
    )
}
