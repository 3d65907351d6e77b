//! Nets of 16 points: from a closed path of four sides, or given in full.
//!
//! The net is numbered p\[r\]\[s\]: row 0 is the bottom side run left to right, column 0 the left side run upwards.

use super::laying::Way;
use crate::anchors::{self, Arrangement};
use crate::deform::built::Explanation;
use crate::error::{Error, GeometryError};
use crate::map::{Net, complete_net};
use crate::outline::Seg;
use crate::param::NamedPath;
use kurbo::{BezPath, CubicBez, Point};

/// The choice of a cage's bottom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Bottom {
    /// The way of laying the base's corners on the cage's that distorts least.
    LeastDistorting,
    /// The paper's rule.
    Lowest,
    /// 1 to 4, as drawn.
    Side(usize),
}

/// Makes the net of a closed path with four sides. `base` are the four corners that it is laid onto, if there are four.
pub(super) fn from_cage(
    path: &NamedPath,
    bottom: Bottom,
    reverse: bool,
    base: Option<&[Point; 4]>,
    explanation: &mut Explanation,
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

    // The mean height of a cubic over its parameter is the mean of its control points' heights.
    let heights = sides.map(|c| (c.p0.y + c.p1.y + c.p2.y + c.p3.y) / 4.0);
    let lowest = Arrangement::by_rule(&corners, &heights);
    let (mut arrangement, why) = match (bottom, base) {
        (Bottom::Side(n), _) => (Arrangement::from_bottom(&corners, n - 1), "as given".to_owned()),
        (Bottom::LeastDistorting, Some(base)) => least_distorting(&path.name, base, &corners, lowest, explanation),
        _ => (lowest, "the lowest on the screen".to_owned()),
    };
    if reverse {
        arrangement.reversed = !arrangement.reversed;
    }
    explanation.notes.push(format!(
        "bottom side of {}: side {} as drawn, {}: {why}",
        path.name,
        arrangement.bottom + 1,
        if arrangement.reversed { "run backwards" } else { "run forwards" }
    ));
    Ok(complete_net(outer_net(&sides, &arrangement)))
}

/// Chooses the way of laying `base` on the corners that distorts least, and says why. A way that turns the artwork on its side is
/// a warning.
fn least_distorting(
    name: &str,
    base: &[Point; 4],
    corners: &[Point; 4],
    lowest: Arrangement,
    explanation: &mut Explanation,
) -> (Arrangement, String) {
    /// Turns beyond this, in degrees, leave the artwork on its side.
    const ON_ITS_SIDE: f64 = 60.0;
    let percent = |distortion: f64| (100.0 * distortion).round();
    let by_rule = Way::new(base, corners, lowest);
    let rule_distortion = percent(by_rule.distortion);
    let way = Way::least(base, corners, by_rule.arrangement);
    let chosen = percent(way.distortion);
    let is_rule = way.arrangement == lowest;
    if is_rule {
        return (lowest, format!("the lowest on the screen, and no side distorts the corners much less ({chosen} %)"));
    }
    if way.turn.abs() > ON_ITS_SIDE {
        explanation.warnings.push(format!(
            "the artwork is turned by {:.0}° to fit {name}, as upright it would be distorted more ({rule_distortion} % instead of \
             {chosen} %); `bottom lowest` keeps its lowest side at the bottom",
            way.turn
        ));
    }
    let side = lowest.bottom + 1;
    (
        way.arrangement,
        format!(
            "it distorts the corners least ({chosen} %; side {side}, the lowest on the screen, {rule_distortion} %)"
        ),
    )
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
