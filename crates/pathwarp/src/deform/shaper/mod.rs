//! The 16-point shaper: artwork is bent into a closed path of four curved sides.
//!
//! The map is F = h₂ ∘ F₀ ∘ h₁ (Markku Koppinen, *A plane transformation from 16 control points*, equation 8, to which all numbers
//! of equations here refer). F₀ is the bicubic map of a 4×4 net (equation 3). The user draws its outer twelve points as a closed path
//! of four cubic sides; the inner four follow by equation 7 ([`complete_net`](crate::map::complete_net)). h₁ takes the base to the
//! unit square, h₂ the shaper's corners to the target. They are direct similitudes for two anchors, projective maps for four. In a net,
//! row 0 is the bottom side run left to right, and column 0 is the left side run upwards.
//!
//! Of the eight ways to lay the corners of a base on the corners of a cage, the one that distorts least is chosen, judged by the best
//! direct similitude between them. Relative to their means, let the corners be the complex numbers bᵢ and cᵢ. The residual, as a share of
//! the cage's size, is √(1 − |Σ b̄ᵢcᵢ|² ÷ (Σ|bᵢ|² Σ|cᵢ|²)).

#[cfg(test)]
mod tests;

use super::entry::{Built, ByHand, Case, Entry, Example, Explanation, Info, Law, Pairs, Role, Variant};
use crate::anchors::{self, Anchors, Arrangement};
use crate::error::{Error, GeometryError, check_range, show};
use crate::map::{AffineMap, BicubicNet, Chain, Class, Map, Net, complete_net};
use crate::outline::Outline;
use crate::param::{Frame, Kind, NamedPath, Settings, parameters};
use kurbo::{BezPath, CubicBez, Point, Rect, Vec2};
use std::sync::Arc;

parameters! {
    /// The 16-point shaper: the artwork's box, or a base, bent into a closed path of four curved sides.
    ///
    /// F = h₂ ∘ F₀ ∘ h₁ with F₀ the bicubic map of a 4×4 net whose outer twelve points are the path's, h₁ the map of the base to
    /// the unit square and h₂ the map of the shaper's corners to the target: similitudes for two anchors, projective for four.
    ///
    /// ```
    /// use pathwarp::{Outline, deform::Shaper, kurbo::{Point, Rect}, map::Map};
    ///
    /// let cage = Outline::from_svg("M10,90 Q40,110 95,85 L90,15 5,10 Z")?;
    /// let built = Shaper::new(Rect::new(0.0, 0.0, 100.0, 100.0), &cage).build()?;
    /// assert!(built.map.point(Point::new(50.0, 50.0)).distance(Point::new(46.875, 55.625)) < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[derive(Debug, Clone, PartialEq)]
    pub struct Shaper(s, cage: Cage) {
        /// The closed path of four sides (lines, curves or arcs) to bend the artwork into.
        param = path("shaper");
        /// Instead of --shaper, all 16 control points: four paths of one cubic each, or 16 points, row by row, the bottom row
        /// first, each left to right.
        param = path("net").repeated();
        /// Two or four anchors in the source that are laid onto the shaper's bottom side or its four corners. Default: the
        /// corners of the artwork's box.
        base: Option<NamedPath> = path("base");
        /// Two or four anchors: the images of the shaper's bottom corners, or of all four. Default: those corners themselves.
        target: Option<NamedPath> = path("target");
        /// The side that is the bottom: 1 to 4, in the order they were drawn, or the lowest on the screen. Default: the one that
        /// distorts the corners least.
        param = new("bottom", Kind::Text("N or lowest"));
        /// Run the bottom side the other way (right to left): the result is mirrored.
        reverse: bool = flag("reverse-shaper");
        /// Take the base's anchors in the order they were drawn.
        base_as_drawn: bool = flag("base-as-drawn");
        /// Take the target's anchors in the order they were drawn.
        target_as_drawn: bool = flag("target-as-drawn");
        let bottom: Bottom = bottom(s)?;
        let frame: Rect = s.frame().rect;
    }
}

/// The source of the net.
#[derive(Debug, Clone, PartialEq)]
enum Cage {
    Path(NamedPath),
    /// All 16 points, and their name for messages.
    Net(Box<Net>, String),
}

impl Shaper {
    /// Lays the box `frame`, or the [`base`](Self::base), into a closed path of four lines, curves or arcs. Of the eight ways to lay the
    /// base's corners on the corners of the path, the one nearest to a similitude is chosen. Near ties go to the paper's rule: the bottom
    /// is the side that lies lowest on the screen, run left to right.
    #[must_use]
    pub fn new(frame: Rect, cage: &Outline) -> Self {
        Self::defaults(frame, Cage::Path(NamedPath { name: "shaper".into(), outline: cage.clone() }))
    }

    /// Lays the box `frame`, or the [`base`](Self::base), onto 16 control points, given by rows from the bottom, each left to right.
    #[must_use]
    pub fn from_net(frame: Rect, net: [[Point; 4]; 4]) -> Self {
        Self::defaults(frame, Cage::Net(Box::new(net), "net".into()))
    }

    setters! {
        /// Sets the bottom side of the closed path: 1 to 4, in the order they were drawn.
        bottom(side: usize) => bottom: Bottom::Side(side);
    }

    /// Takes the side that lies lowest on the screen for the bottom, however much that distorts.
    #[must_use]
    pub fn lowest_bottom(self) -> Self {
        Self { bottom: Bottom::Lowest, ..self }
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Geometry`] when the path is not closed or has other than four sides, when anchors coincide, or when three of the four
    /// anchors of a projective map lie on a line (also the shaper's, for four targets); [`Error::Usage`] when there is no such bottom side.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        let mut explanation = Explanation::default();
        if let Bottom::Side(n) = self.bottom {
            check_range("bottom", n as f64, 1.0, 4.0)?;
        }
        let base = match &self.base {
            Some(path) => anchors::of_path(path, self.base_as_drawn),
            None => anchors::frame_corners(&Frame::new(self.frame)),
        };
        let target = self.target.as_ref().map(|t| anchors::of_path(t, self.target_as_drawn)).transpose()?;
        // Only a projective map to the target forbids corners on a line.
        let usable =
            if matches!(target, Some(Anchors::Four(_))) { anchors::check_general } else { anchors::check_distinct };
        let (net, path, name) = match &self.cage {
            Cage::Path(path) => {
                let corners = match &base {
                    Ok(Anchors::Four(corners)) if self.target.is_none() => Some(corners),
                    _ => None,
                };
                let net = self.net_from_sides(path, usable, corners, &mut explanation)?;
                (net, sides_path(&net), &path.name)
            }
            Cage::Net(net, name) => (**net, rows_path(net), name),
        };
        let corners = [net[0][0], net[0][3], net[3][3], net[3][0]];
        if matches!(self.cage, Cage::Net(..)) {
            usable(name, &corners)?;
        }
        let notes = &mut explanation.notes;
        let listed = list_points(&corners);
        notes.push(format!("corners of {name}: {listed} (bottom left, bottom right, top right, top left)"));

        let base = base?;
        notes.push(format!("base: {} ({})", list_points(base.points()), kind_of_map(&base)));
        let h2 = match &target {
            None => {
                notes.push("target: none, the result lies where the shaper lies".into());
                None
            }
            Some(t) => {
                notes.push(format!("target: {} ({})", list_points(t.points()), kind_of_map(t)));
                Some(to_target(name, &corners, t)?)
            }
        };
        let map = compose(&anchors::to_standard("base", &base)?, net, h2);
        // If only rounding moves the frame, the map is the identity.
        let map = anchors::simplified(map, self.frame);

        let mut built = Built::new(map);
        built.explanation = explanation;
        built.overlay(Role::Cage, path);
        built.overlay(Role::Base, base.outline().to_bez_path(0.0));
        if let Some(t) = target {
            built.overlay(Role::Target, t.outline().to_bez_path(0.0));
        }
        Ok(built)
    }

    /// Makes the net of a closed path with four sides. `base` holds the base's corners if it has four; `usable` checks the path's.
    fn net_from_sides(
        &self,
        path: &NamedPath,
        usable: fn(&str, &[Point]) -> Result<(), GeometryError>,
        base: Option<&[Point; 4]>,
        explanation: &mut Explanation,
    ) -> Result<Net, Error> {
        const EXPECTED: &str = "exactly four, in one closed path";
        // Three lines that do not return to their start are closed by a fourth.
        let sub = anchors::closed_subpath(path, EXPECTED, |lines| lines == 3)?;
        let drawn = sub.anchors();
        let wrong_count = |drawn: Vec<Point>| GeometryError::anchor_count(&path.name, &drawn, EXPECTED);
        let corners: [Point; 4] = drawn.try_into().map_err(wrong_count)?;
        usable(&path.name, &corners)?;
        let sides: [CubicBez; 4] = std::array::from_fn(|i| sub.segs[i].to_cubic());

        // The mean height of a cubic over its parameter is the mean of its control points' heights.
        let heights = sides.map(|c| (c.p0.y + c.p1.y + c.p2.y + c.p3.y) / 4.0);
        let lowest = Arrangement::by_rule(&corners, &heights);
        let (mut arrangement, why) = match (self.bottom, base) {
            (Bottom::Side(n), _) => (Arrangement::from_bottom(&corners, n - 1), "as given".to_owned()),
            (Bottom::LeastDistorting, Some(base)) => least_distorting(&path.name, base, &corners, lowest, explanation),
            _ => (lowest, "the lowest on the screen".to_owned()),
        };
        if self.reverse {
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
}

/// Composes h₂ ∘ F₀ ∘ h₁, with h₁ and h₂ folded into F₀ where they are affine.
fn compose(h1: &Arc<dyn Map>, net: Net, h2: Option<Arc<dyn Map>>) -> Arc<dyn Map> {
    let (net, h2) = match h2.as_ref().map(Map::class) {
        Some(Class::Affine(m)) => (net.map(|row| row.map(|p| m * p)), None),
        _ => (net, h2),
    };
    let (h1, to_square) = match h1.class() {
        Class::Affine(m) => (None, m),
        _ => (Some(h1.clone()), kurbo::Affine::IDENTITY),
    };
    let f0 = Arc::new(BicubicNet::new(&net, to_square)) as Arc<dyn Map>;
    if h1.is_none() && h2.is_none() {
        return f0;
    }
    Arc::new(Chain::new(h1.into_iter().chain([f0]).chain(h2)))
}

/// Returns the map of the shaper's corners to the target.
fn to_target(name: &str, corners: &[Point; 4], target: &Anchors) -> Result<Arc<dyn Map>, Error> {
    match *target {
        Anchors::Two([p, q]) => {
            let m = AffineMap::similitude(corners[0], corners[1], p, q).ok_or_else(|| GeometryError::Coincident {
                path: name.to_owned(),
                which: [1, 2],
                at: corners[0],
            })?;
            Ok(Arc::new(m))
        }
        Anchors::Four(q) => Ok(Arc::new(anchors::projective("target", *corners, q)?)),
    }
}

/// Describes h₁ or h₂ by its anchors.
fn kind_of_map(a: &Anchors) -> &'static str {
    match a {
        Anchors::Two(_) => "two anchors: a similitude",
        Anchors::Four(_) => "four anchors: a projective map",
    }
}

fn list_points(points: &[Point]) -> String {
    points.iter().map(|p| show(*p)).collect::<Vec<_>>().join(" ")
}

/// The rule that chooses the bottom side of a cage.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Bottom {
    /// The way of laying the base's corners on the cage's that distorts least.
    LeastDistorting,
    /// The paper's rule: the side that lies lowest on the screen.
    Lowest,
    /// This side, 1 to 4 in the order drawn.
    Side(usize),
}

/// Returns the way of laying `base` on the corners that distorts least, and its reason. Warns if it turns the artwork on its side.
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
    let by_rule = CornerMatch::new(base, corners, lowest);
    let rule_distortion = percent(by_rule.distortion);
    let best = CornerMatch::best(base, corners, lowest);
    let chosen = percent(best.distortion);
    if best.arrangement == lowest {
        return (lowest, format!("the lowest on the screen, and no side distorts the corners much less ({chosen} %)"));
    }
    if best.turn.abs() > ON_ITS_SIDE {
        explanation.warnings.push(format!(
            "the artwork is turned by {:.0}° to fit {name}, as upright it would be distorted more ({rule_distortion} % instead of \
             {chosen} %); `bottom lowest` keeps its lowest side at the bottom",
            best.turn
        ));
    }
    let side = lowest.bottom + 1;
    let least = format!(
        "it distorts the corners least ({chosen} %; side {side}, the lowest on the screen, {rule_distortion} %)"
    );
    (best.arrangement, least)
}

/// Returns the net of four sides, with the inner four points still at the origin.
fn outer_net(sides: &[CubicBez; 4], a: &Arrangement) -> Net {
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
fn from_rows(given: &[NamedPath]) -> Result<Net, Error> {
    let name = &given[0].name;
    let subpaths: Vec<_> = given.iter().flat_map(|p| &p.outline.subpaths).collect();
    let points: Vec<Point> = given.iter().flat_map(|p| p.outline.anchors()).collect();
    let rows: Option<Vec<[Point; 4]>> = if subpaths.len() == 4 && subpaths.iter().all(|s| s.segs.len() == 1) {
        let cubics = subpaths.iter().map(|s| s.segs[0].to_cubic());
        Some(cubics.map(|c| [c.p0, c.p1, c.p2, c.p3]).collect())
    } else {
        (points.len() == 16).then(|| points.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect())
    };
    let Some([a, b, c, d]) = rows.as_deref() else {
        let expected = "16 points, or four paths of one cubic each";
        return Err(GeometryError::anchor_count(name, &points, expected).into());
    };
    Ok([*a, *b, *c, *d])
}

/// Returns the closed path of a net's four sides.
fn sides_path(n: &Net) -> BezPath {
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

/// Distortions that differ by less than this are ties. So neither artwork nor cages with sides up to about 1:1.3 are turned on their side.
const TIE: f64 = 0.25;

/// One way to lay the corners of the base on the corners of the cage.
struct CornerMatch {
    arrangement: Arrangement,
    /// Residual of the best similitude, as a share of the cage's size, 0 to 1.
    distortion: f64,
    /// Angle by which that similitude turns, −180° to 180°, clockwise on the screen.
    turn: f64,
}

impl CornerMatch {
    /// Judges an arrangement of the cage's corners for the corners of a base: bottom left, bottom right, top right, top left.
    fn new(base: &[Point; 4], cage: &[Point; 4], arrangement: Arrangement) -> Self {
        let order = arrangement.order();
        let (b, c) = (centred(*base), centred(order.map(|i| cage[i])));
        let sum = b.iter().zip(&c).fold(Vec2::ZERO, |s, (b, c)| s + Vec2::new(b.dot(*c), b.cross(*c)));
        let size = |v: &[Vec2; 4]| v.iter().map(|p| p.hypot2()).sum::<f64>();
        let kept = sum.hypot2() / (size(&b) * size(&c));
        Self { arrangement, distortion: (1.0 - kept).max(0.0).sqrt(), turn: sum.angle().to_degrees() }
    }

    /// Returns the way that distorts least; among ties `lowest`, or else the one that turns least. Ways that mirror the artwork are
    /// excluded, because mirroring hardly distorts a narrow box.
    fn best(base: &[Point; 4], cage: &[Point; 4], lowest: Arrangement) -> Self {
        let by_rule = Self::new(base, cage, lowest);
        let all = (0..8).map(|i| Self::new(base, cage, Arrangement { bottom: i % 4, reversed: i >= 4 }));
        let mirrors = |m: &Self| area(base) * area(&m.arrangement.order().map(|i| cage[i])) < 0.0;
        let all: Vec<Self> = all.filter(|m| !mirrors(m)).collect();
        let least = all.iter().map(|m| m.distortion).fold(by_rule.distortion, f64::min);
        let ties = |m: &Self| m.distortion < least + TIE;
        if ties(&by_rule) {
            return by_rule;
        }
        all.into_iter().filter(ties).min_by(|a, b| a.turn.abs().total_cmp(&b.turn.abs())).unwrap_or(by_rule)
    }
}

/// Returns the signed area of a quadrilateral.
fn area(q: &[Point; 4]) -> f64 {
    0.5 * (q[2] - q[0]).cross(q[3] - q[1])
}

fn centred(points: [Point; 4]) -> [Vec2; 4] {
    let mean = points.iter().fold(Vec2::ZERO, |sum, p| sum + p.to_vec2()) / 4.0;
    points.map(|p| p.to_vec2() - mean)
}

static INFO: Info = Info::new("shaper", "bend artwork into a closed path of four curved sides")
    .group("Envelopes")
    .by_hand(ByHand {
        label: Some("Cage"),
        fixed: &["shaper", "net", "base", "target"],
        neutral: &[(
            "shaper",
            "M0,100 C33.3333,100 66.6667,100 100,100 C100,66.6667 100,33.3333 100,0 C66.6667,0 33.3333,0 0,0 C0,33.3333 0,66.6667 0,100 Z",
        )],
        variants: &[Variant {
            label: "Cage, 16 points",
            param: "net",
            neutral: "M0,100 C33.3333,100 66.6667,100 100,100 M0,66.6667 C33.3333,66.6667 66.6667,66.6667 100,66.6667 \
                      M0,33.3333 C33.3333,33.3333 66.6667,33.3333 100,33.3333 M0,0 C33.3333,0 66.6667,0 100,0",
            showing: "M0,100 C33,110 67,90 100,100 M0,67 C10,40 50,110 100,67 M0,33 C50,-10 90,60 100,33 M0,0 C33,10 67,-10 100,0",
        }],
        ..ByHand::NONE
    })
    .guides(&["shaper", "base", "target"], 1)
    .about("Draw a closed path with four anchors: that is the shape. The artwork's box (or the base) is laid onto it, side by \
side, and everything inside follows smoothly. With a target, the shaper's corners are then moved there, so that its \
size and position do not matter.\n\nThe bottom is the side that lies lowest on the screen, run left to right, unless another \
way of laying the four corners distorts them much less, as for a wide logo in a tilted shape. The paper always takes the lowest (--bottom lowest); but of a shape that leans, the lowest \
side may be a short one, and the artwork would be squeezed and lie on its side, which seldom is meant. --bottom and --reverse-shaper \
overrule the choice, and --explain says what was chosen and why. Bases and targets of two anchors are run left to right, \
those of four start with their lowest side; --base-as-drawn and --target-as-drawn take them as they were drawn.\n\nA base of \
two anchors fixes only the bottom side: artwork twice as tall as the base is wide reaches past the shaper's top.")
    .source("Markku Koppinen, A plane transformation from 16 control points, equations (1)-(10)")
    .params(Shaper::PARAMS)
    .demo(&[("shaper", "M 10,90 C 40,110 60,70 95,85 C 85,60 105,40 90,15 C 60,-5 40,35 5,10 C 15,40 0,60 10,90 Z")])
    .examples(&[
        Example {
            what: "Bend a logo into a path of another file",
            command: "shaper samples/logo.svg --shaper samples/banner.svg -o out.svg",
        },
        Example {
            what: "The paper's example: Base, Target and Shaper are paths of the document itself",
            command: "shaper samples/paper-two-anchors.svg --base '#Base' --target '#Target' --shaper '#Shaper' -o out.svg --preview out.png",
        },
        Example {
            what: "A cage typed in place, explained",
            command: "shaper samples/monogram.svg --shaper 'M0,120 Q60,90 120,120 L110,0 Q60,30 10,0 Z' --explain -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("shaper", "0,0 100,0 100,100 0,100")]),
        Law::Identity(&[("shaper", "M0,100 L0,0 L100,0 L100,100 Z")]),
        Law::Identity(&[("shaper", "0,0 10,0 10,10 0,10"), ("target", "0,100 100,100")]),
        Law::Area(&[("shaper", "0,0 50,0 50,50 0,50")], 0.25),
        Law::Same(
            // With a target, the shaper's size and position do not matter.
            &[("shaper", "M 10,90 Q 40,110 95,85 L 90,15 5,10 Z"), ("base", "0,100 100,100"), ("target", "5,90 70,80")],
            &[("shaper", "M 30,190 Q 90,230 200,180 L 190,40 20,30 Z"), ("base", "0,100 100,100"), ("target", "5,90 70,80")],
        ),
        Law::Same(
            // Neither does the start of a closed path, nor its direction.
            &[("shaper", "M 10,90 Q 40,110 95,85 L 90,15 5,10 Z")],
            &[("shaper", "M 90,15 L 95,85 Q 40,110 10,90 L 5,10 Z")],
        ),
        Law::KeepsLines(&[("shaper", "0,0 100,0 100,100 0,100"), ("target", "0,100 100,90 80,20 10,0")]),
    ])
    .cases(&[
        // Corners on corners; the bottom side's middle on the bottom arc's middle (a quadratic: (10+2·40+95)/4, ...).
        Case { args: CASE, at: (0.0, 100.0), to: (10.0, 90.0), tolerance: 1e-12 },
        Case { args: CASE, at: (100.0, 100.0), to: (95.0, 85.0), tolerance: 1e-12 },
        Case { args: CASE, at: (100.0, 0.0), to: (90.0, 15.0), tolerance: 1e-12 },
        Case { args: CASE, at: (50.0, 100.0), to: (46.25, 98.75), tolerance: 1e-12 },
        // The middle of a Coons patch: half the sum of the sides' middles less the corners' mean.
        Case { args: CASE, at: (50.0, 50.0), to: (46.875, 55.625), tolerance: 1e-12 },
    ]);

const CASE: Pairs = &[("shaper", "M 10,90 Q 40,110 95,85 L 90,15 5,10 Z")];

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| {
    let cage = match (s.path_if("shaper")?, s.paths("net")?) {
        (Some(_), rows) if !rows.is_empty() => {
            let problem = "cannot go with `shaper`: one of them gives the net";
            return Err(Error::usage("net", rows[0].name.clone(), problem));
        }
        (Some(path), _) => Cage::Path(path),
        (None, rows) if !rows.is_empty() => {
            if s.given("bottom") || s.given("reverse-shaper") {
                let problem = "is taken as given; `bottom` and `reverse-shaper` go with `shaper`";
                return Err(Error::usage("net", rows[0].name.clone(), problem));
            }
            Cage::Net(Box::new(from_rows(&rows)?), rows[0].name.clone())
        }
        _ => {
            let hint = "the closed path of four sides to bend the artwork into (or `net` with 16 points)";
            return Err(Error::missing("shaper", hint));
        }
    };
    Shaper::read(s, cage)?.build()
});

fn bottom(s: &Settings<'_>) -> Result<Bottom, Error> {
    match s.texts("bottom").last() {
        None => Ok(Bottom::LeastDistorting),
        Some(&"lowest") => Ok(Bottom::Lowest),
        Some(text) => match text.trim().parse::<i32>() {
            Ok(side) => {
                check_range("bottom", f64::from(side), 1.0, 4.0).map(|_| Bottom::Side(side.unsigned_abs() as usize))
            }
            Err(_) => Err(Error::usage("bottom", *text, "is neither a side, 1 to 4, nor the word lowest")),
        },
    }
}

#[cfg(test)]
mod laying_tests {
    use super::*;

    /// Returns a box of this shape, turned clockwise: bottom left, bottom right, top right, top left.
    fn turned(width: f64, height: f64, degrees: f64) -> [Point; 4] {
        let corners = [(-width, height), (width, height), (width, -height), (-width, -height)];
        let (sin, cos) = degrees.to_radians().sin_cos();
        corners.map(|(x, y)| Point::new(7.0 + x * cos - y * sin, -3.0 + x * sin + y * cos))
    }

    #[test]
    fn similar_cages_are_not_distorted_however_they_lie() {
        for (width, degrees) in [4.0, 10.0].iter().flat_map(|w| (-89..=89).map(move |d| (*w, f64::from(d)))) {
            let (base, cage) = (turned(width, 1.0, 0.0), turned(3.0 * width, 3.0, degrees));
            // The cage may be drawn from any corner, in either direction.
            for start in 0..8 {
                let drawn: [Point; 4] =
                    std::array::from_fn(|i| cage[(if start < 4 { start + i } else { start + 4 - i }) % 4]);
                let heights = std::array::from_fn(|i| 0.5 * (drawn[i].y + drawn[(i + 1) % 4].y));
                let way = CornerMatch::best(&base, &drawn, Arrangement::by_rule(&drawn, &heights));
                assert!(way.distortion < 1e-7, "{width}:1 by {degrees}°, from {start}: {}", way.distortion);
                assert!((way.turn - degrees).abs() < 1e-6, "{width}:1 by {degrees}°, from {start}: {}", way.turn);
            }
        }
    }

    #[test]
    fn near_squares_follow_the_rule() {
        for (w, h) in [(1.25, 1.0), (1.0, 1.25), (1.0, 1.0)] {
            let (base, cage) = (turned(w, h, 0.0), turned(1.0, 1.0, 20.0));
            let heights = std::array::from_fn(|i| 0.5 * (cage[i].y + cage[(i + 1) % 4].y));
            let rule = Arrangement::by_rule(&cage, &heights);
            let (bottom, reversed) = (rule.bottom, rule.reversed);
            let way = CornerMatch::best(&base, &cage, rule);
            assert_eq!((way.arrangement.bottom, way.arrangement.reversed), (bottom, reversed));
        }
    }

    #[test]
    fn reflections_are_the_worst() {
        let base = turned(2.0, 1.0, 0.0);
        let way = |bottom, reversed| CornerMatch::new(&base, &base, Arrangement { bottom, reversed }).distortion;
        assert!(way(0, false) < 1e-7 && way(2, false) < 1e-7);
        // At each corner, |b|² is 4 + 1 up to a factor, of which the mirror image leaves 4 − 1: √(1 − (3/5)²).
        assert!((way(0, true) - 0.8).abs() < 1e-12, "{}", way(0, true));
        // On its side 4 of 5 remain: √(1 − (4/5)²).
        assert!((way(1, false) - 0.6).abs() < 1e-12, "{}", way(1, false));
    }
}
