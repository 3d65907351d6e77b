//! The report counts the contents of the file: every segment of every path that is written.

use pathwarp::Outline;
use pathwarp_oracle::drawings::{Bend, drawing, read, warp_options};
use pathwarp_svg::{Patterns, Strokes, Structure, WarpOptions};

/// Returns the number of segments, closing lines included, in all path data of a file.
fn segments(svg: &str) -> usize {
    let data = svg.split(" d=").skip(1).map(|d| d[1..].split(&d[..1]).next().unwrap());
    data.map(|d| Outline::from_svg_lossy(d).segs().count()).sum()
}

#[test]
fn reports_count_what_is_written() {
    let bodies = [
        (
            "a dashed path",
            "<path id='p' d='M10 20C30 0 60 50 90 20' fill='none' stroke='red' stroke-width='4' stroke-dasharray='2 3'/>",
        ),
        (
            "fill and stroke",
            "<rect id='p' x='10' y='10' width='50' height='40' fill='red' stroke='blue' stroke-width='6'/>",
        ),
        ("an open fill", "<path id='p' d='M10 20C30 0 60 50 90 20L40 80' fill='red'/>"),
        (
            "an open fill with a stroke",
            "<path id='p' d='M10 20C30 0 60 50 90 20L40 80' fill='red' stroke='blue' stroke-width='6'/>",
        ),
        ("a line with a fill", "<path id='p' d='M10 20L90 20' fill='red' stroke='blue' stroke-width='6'/>"),
        ("letters", "<text id='p' x='5' y='60' font-size='40'>ABC</text>"),
        (
            "letters with strokes",
            "<text id='p' x='5' y='60' font-size='40' stroke='red'>AB<tspan id='s'>C</tspan></text>",
        ),
        (
            "a copy",
            "<defs><rect id='d' width='30' height='20' stroke='red'/></defs><use id='p' href='#d' x='9' y='9'/>",
        ),
        (
            "a clip path",
            "<clipPath id='c'><circle id='d' cx='50' cy='50' r='30'/></clipPath><rect id='p' width='90' height='80' \
                         clip-path='url(#c)'/>",
        ),
        (
            "markers",
            "<marker id='m' markerWidth='3' markerHeight='3'><path d='M0 0h3v3z'/></marker><path id='p' d='M10 10H60V80' \
                     fill='none' stroke='red' stroke-width='3' marker-start='url(#m)' marker-end='url(#m)'/>",
        ),
    ];
    for (name, body) in bodies {
        for strokes in [Strokes::Auto, Strokes::Outline, Strokes::Scale, Strokes::Keep] {
            let options = warp_options().with_structure(Structure::Flatten).with_strokes(strokes);
            check(&format!("{name}, {strokes:?}"), body, &options);
        }
    }
}

/// The shape, the edges of its tiles' cells, and every tile count.
#[test]
fn tiles_count() {
    let body = "<pattern id='t' width='20' height='20' patternUnits='userSpaceOnUse'><circle cx='10' cy='10' r='7' \
                fill='red'/></pattern><rect id='p' x='5' y='5' width='80' height='70' fill='url(#t)'/>";
    let options = warp_options().with_structure(Structure::Flatten).with_patterns(Patterns::Instantiate);
    let w = read(&drawing(body)).warp(&Bend, &options).unwrap();
    let counted: usize = w.shapes.iter().map(|s| s.path.segments_out).sum();
    assert!(w.shapes.iter().any(|s| s.id == "p"), "{:?}", w.shapes);
    assert_eq!(counted, segments(&w.svg), "{:?}\n{}", w.shapes, w.svg);
}

#[track_caller]
fn check(name: &str, body: &str, options: &WarpOptions) {
    let w = read(&drawing(body)).warp(&Bend, options).unwrap();
    let counted: usize = w.shapes.iter().map(|s| s.path.segments_out).sum();
    assert_eq!(counted, segments(&w.svg), "{name}: {:?}\n{}", w.shapes, w.svg);
    // Markers have no separate element.
    let ids: Vec<&str> = w.shapes.iter().map(|s| s.id.as_str()).filter(|id| *id != "path").collect();
    assert!(ids.iter().all(|i| ids.iter().filter(|j| i == *j).count() == 1), "{name}: {ids:?}");
}
