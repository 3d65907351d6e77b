//! Nets of 16 points: from a closed path of four sides, or given in full.
//!
//! The net is numbered p\[r\]\[s\]: row 0 is the bottom side run left to right, column 0 the left side run upwards.

use crate::anchors::{self, Arrangement};
use crate::error::{Error, GeometryError};
use crate::map::{Net, complete_net};
use crate::outline::Seg;
use crate::param::NamedPath;
use kurbo::{BezPath, CubicBez, Point};

/// Makes the net of a closed path with four sides. Its bottom is the side `bottom`, 1 to 4, or chosen by the paper's rule.
pub(super) fn from_cage(
    path: &NamedPath,
    bottom: Option<usize>,
    reverse: bool,
    notes: &mut Vec<String>,
) -> Result<Net, Error> {
    const EXPECTED: &str = "exactly four, in one closed path";
    let sub = anchors::closed_subpath(path, EXPECTED, |lines| lines == 3)?;
    let drawn = sub.anchors();
    let corners: [Point; 4] = drawn.try_into().map_err(|drawn: Vec<Point>| GeometryError::AnchorCount {
        path: path.name.clone(),
        found: drawn.len(),
        anchors: drawn.into_iter().take(8).collect(),
        expected: EXPECTED,
    })?;
    anchors::general(&path.name, &corners)?;
    let sides: [CubicBez; 4] = std::array::from_fn(|i| sub.segs[i].to_cubic());

    let mut arrangement = match bottom {
        Some(n) => Arrangement::from_bottom(&corners, n - 1),
        None => {
            // The mean height of a cubic over its parameter is the mean of its control points' heights.
            let heights = sides.map(|c| (c.p0.y + c.p1.y + c.p2.y + c.p3.y) / 4.0);
            Arrangement::by_rule(&corners, &heights)
        }
    };
    if reverse {
        arrangement.reversed = !arrangement.reversed;
    }
    notes.push(format!(
        "bottom side of {}: side {} as drawn, {}",
        path.name,
        arrangement.bottom + 1,
        if arrangement.reversed { "run backwards" } else { "run forwards" }
    ));
    Ok(complete_net(outer_net(&sides, &arrangement)))
}

/// Arranges the outer twelve points; the inner four are still to be completed.
pub(super) fn outer_net(sides: &[CubicBez; 4], a: &Arrangement) -> Net {
    let backwards = |c: CubicBez| CubicBez::new(c.p3, c.p2, c.p1, c.p0);
    // Four sides head to tail: bottom, right, top (right to left), left (downwards).
    let ring: [CubicBez; 4] = std::array::from_fn(|i| {
        if a.reversed { backwards(sides[(a.bottom + 4 - i) % 4]) } else { sides[(a.bottom + i) % 4] }
    });
    let [bottom, right, top, left] = [ring[0], ring[1], backwards(ring[2]), backwards(ring[3])];
    let inner = Point::ORIGIN;
    [
        [bottom.p0, bottom.p1, bottom.p2, bottom.p3],
        [left.p1, inner, inner, right.p1],
        [left.p2, inner, inner, right.p2],
        [top.p0, top.p1, top.p2, top.p3],
    ]
}

/// Reads a net given in full: four rows of one cubic each, or 16 points.
pub(super) fn from_rows(given: &[NamedPath]) -> Result<Net, Error> {
    let name = &given[0].name;
    let subpaths: Vec<_> = given.iter().flat_map(|p| &p.outline.subpaths).collect();
    let rows: Option<Vec<[Point; 4]>> = if subpaths.len() == 4 && subpaths.iter().all(|s| s.segs.len() == 1) {
        let row = |s: &Seg| {
            let c = s.to_cubic();
            [c.p0, c.p1, c.p2, c.p3]
        };
        Some(subpaths.iter().map(|s| row(&s.segs[0])).collect())
    } else {
        let points: Vec<Point> = subpaths.iter().flat_map(|s| s.anchors()).collect();
        (points.len() == 16).then(|| points.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect())
    };
    let Some([a, b, c, d]) = rows.as_deref() else {
        let anchors: Vec<Point> = subpaths.iter().flat_map(|s| s.anchors()).collect();
        return Err(GeometryError::AnchorCount {
            path: name.clone(),
            found: anchors.len(),
            anchors: anchors.into_iter().take(8).collect(),
            expected: "16 points, or four paths of one cubic each",
        }
        .into());
    };
    Ok([*a, *b, *c, *d])
}

/// Returns the closed path of a net's four sides.
pub(super) fn sides_path(n: &Net) -> BezPath {
    let mut p = BezPath::new();
    p.move_to(n[0][0]);
    p.curve_to(n[0][1], n[0][2], n[0][3]);
    p.curve_to(n[1][3], n[2][3], n[3][3]);
    p.curve_to(n[3][2], n[3][1], n[3][0]);
    p.curve_to(n[2][0], n[1][0], n[0][0]);
    p.close_path();
    p
}

/// Returns the eight curves of a net.
pub(in crate::deform) fn rows_path(n: &Net) -> BezPath {
    let mut p = BezPath::new();
    for (i, row) in n.iter().enumerate() {
        p.move_to(row[0]);
        p.curve_to(row[1], row[2], row[3]);
        p.move_to(n[0][i]);
        p.curve_to(n[1][i], n[2][i], n[3][i]);
    }
    p
}
