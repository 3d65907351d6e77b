//! `map … --exact`: exact images of curves, as text, as JSON, or as splines of a DXF.
//!
//! Where the map's coordinates are quotients of polynomials, the image of a rational Bézier curve is a rational Bézier curve, of a higher
//! degree in general. Curves that cross a crease of the map or leave its domain are refused.

use crate::ending::Status;
use clap::{Arg, ArgMatches, value_parser};
use pathwarp::Outline;
use pathwarp::kurbo::{Point, Rect};
use pathwarp::map::{Class, Map, RationalBezier, exact_images};
use pathwarp::param::{Args, Frame, Param, Settings};
use pathwarp_engine::export::{MAX_DEGREE, Spline, write_splines};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::input;
use pathwarp_engine::options::Reading;
use pathwarp_engine::units::MM_PER_PX;
use pathwarp_engine::{output, references};
use pathwarp_solid::glam::{DVec3, DVec4};
use pathwarp_solid::patch::{self, Surface, json};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const EXACT: Param = Param::path(
    "exact",
    "Instead of points, print the control points and weights of the exact image of this path, or of the NURBS curves of a JSON file",
);

const OUT: &str = "out";

/// The arguments `--exact` and `--out`, the file for its result.
pub(super) fn args() -> [Arg; 2] {
    let exact = Arg::new(EXACT.name).long(EXACT.name).value_name("PATHREF").help(EXACT.help);
    let out = Arg::new(OUT).short('o').long(OUT).value_name("OUT").value_parser(value_parser!(PathBuf));
    [
        exact.allow_hyphen_values(true).conflicts_with_all(["points", "jacobian", "all"]),
        out.requires(EXACT.name).help("Write the curves of --exact to this file, .dxf or .json"),
    ]
}

/// The curves given by `--exact`.
pub(super) enum Curves {
    Path(Outline),
    Nurbs(Vec<Surface>),
}

impl Curves {
    /// Reads the curves, if the option is given.
    pub(super) fn read(m: &ArgMatches, reading: &Reading) -> Result<Option<Self>, Failure> {
        let Some(text) = m.get_one::<String>(EXACT.name) else { return Ok(None) };
        let file = Path::new(text);
        if file.extension().is_some_and(|e| e.eq_ignore_ascii_case("json")) {
            let bytes = input::bytes(file)?;
            if bytes.trim_ascii_start().starts_with(b"{") {
                let all = json::read(&bytes).map_err(|e| Failure::file(file, e))?;
                let is_flat = |s: &Surface| s.is_curve() && s.points.iter().all(|p| p.z == 0.0);
                let Some(i) = all.iter().position(|s| !is_flat(s)) else { return Ok(Some(Self::Nurbs(all))) };
                let problem = "is not in the plane z = 0; `pathwarp solid` deforms it";
                return Err(Failure::file(file, format!("{} {problem}", numbered(&all, i))));
            }
        }
        let mut args = Args::from_pairs(&[(EXACT.name, text)]);
        let params = [EXACT];
        let found = args.resolve_paths(&params, |reference| references::in_px(reference, reading).map(Some));
        let path = found.and_then(|()| Settings::new(&params, &args, &Frame::new(Rect::ZERO))?.path_if(EXACT.name));
        Ok(path.map_err(Failure::of_recipe)?.map(|path| Self::Path(path.outline)))
    }

    /// Returns the bounding box of the path, or of the curves' control points.
    pub(super) fn bounds(&self) -> Rect {
        let bounds = match self {
            Self::Path(path) => path.bounding_box(),
            Self::Nurbs(all) => {
                let points = all.iter().flat_map(|s| &s.points).map(|p| Point::new(p.x, p.y));
                Outline::from_points(&points.collect::<Vec<_>>(), false).bounding_box()
            }
        };
        bounds.unwrap_or(Rect::ZERO)
    }

    /// Prints the images, or writes them to the file of `--out`.
    pub(super) fn write_images(&self, map: &dyn Map, m: &ArgMatches) -> Result<Status, Failure> {
        let wrong = |problem: String| Failure::usage(format!("--exact: {problem}"));
        let target = m.get_one::<PathBuf>(OUT).map(PathBuf::as_path);
        let bytes = match target.map(|file| file.extension().unwrap_or_default().to_ascii_lowercase()) {
            None => self.text(map).map_err(wrong)?,
            Some(format) if format == "json" => {
                let all = self.splines(map).and_then(|all| check_degrees(&all, patch::MAX_DEGREE).map(|()| all));
                json::write(&all.map_err(wrong)?).map_err(Failure::Output)?
            }
            Some(format) if format == "dxf" => {
                let mut all = self.splines(map).map_err(wrong)?;
                all.iter_mut().flat_map(|s| &mut s.points).for_each(|p| *p *= DVec3::new(MM_PER_PX, -MM_PER_PX, 0.0));
                dxf(&all).map_err(wrong)?
            }
            Some(_) => return Err(Failure::usage("--out: curves of --exact are written as .dxf or .json".to_owned())),
        };
        output::write(target, bytes.as_bytes())?;
        Ok(Status::Complete)
    }

    /// Formats every control point as a line with x, y and weight, and ends each curve with an empty line.
    fn text(&self, map: &dyn Map) -> Result<String, String> {
        let mut out = String::new();
        for curve in self.contours(map)?.iter().flat_map(|c| &c.images) {
            for [x, y, w] in &curve.points {
                let _ = writeln!(out, "{} {} {w}", x / w, y / w);
            }
            out.push('\n');
        }
        Ok(out)
    }

    /// Returns the images of all contours, piece by piece.
    fn contours(&self, map: &dyn Map) -> Result<Vec<Contour>, String> {
        let (mut out, mut number) = (Vec::new(), 0);
        match self {
            Self::Path(path) => {
                for subpath in &path.subpaths {
                    let mut images = Vec::new();
                    for seg in &subpath.segs {
                        number += 1;
                        images.extend(exact_images(map, seg).ok_or_else(|| no_image(&format!("segment {number}")))?);
                    }
                    out.push(Contour { name: String::new(), images, closed: subpath.closed });
                }
            }
            Self::Nurbs(all) => {
                for (i, s) in all.iter().enumerate() {
                    let (pieces, what) = (s.pieces().0, numbered(all, i));
                    let images = pieces.iter().map(|p| image(map, &p.points[..=p.degree[0]], &what));
                    let images = images.collect::<Result<_, _>>()?;
                    out.push(Contour { name: s.name.clone(), images, closed: false });
                }
            }
        }
        Ok(out)
    }

    /// Returns the image of each contour as one spline. A map that is linear in homogeneous coordinates keeps the knots.
    fn splines(&self, map: &dyn Map) -> Result<Vec<Surface>, String> {
        if let (Self::Nurbs(all), Class::Affine(_) | Class::Projective(_)) = (self, map.class()) {
            let linear = all.iter().map(|s| {
                let n = s.size()[0];
                let points = s.points[..n].iter().zip(&s.weights).map(|(p, w)| [p.x * w, p.y * w, *w]).collect();
                let image = map.image(&RationalBezier { points })?;
                image.hull()?;
                Some(spline(&s.name, [s.degree[0], n], s.knots[0].clone(), &image.points))
            });
            if let Some(all) = linear.collect() {
                return Ok(all);
            }
        }
        let all = self.contours(map)?;
        all.iter().enumerate().map(|(i, c)| c.joined().ok_or_else(|| no_weights(i + 1))).collect()
    }
}

/// The image of a subpath or of a spline.
struct Contour {
    name: String,
    images: Vec<RationalBezier>,
    closed: bool,
}

impl Contour {
    /// Joins the images to one spline of their highest degree; `None` if a weight is not positive.
    fn joined(&self) -> Option<Surface> {
        let parts = &self.images;
        let degree = parts.iter().map(RationalBezier::degree).max()?.max(1);
        let mut points: Vec<[f64; 3]> = Vec::with_capacity(degree * parts.len() + 1);
        for part in parts {
            part.hull()?;
            let raised = part.raised(degree).points;
            // Scaling homogeneous control points does not change a curve, so the weights can be made to agree at joints.
            let last = points.pop().unwrap_or([0.0, 0.0, 1.0]);
            let scale = last[2] / raised[0][2];
            points.extend(raised.iter().map(|p| p.map(|v| v * scale)));
        }
        if self.closed {
            let ([x, y, w], last) = (points[0], points.last_mut()?);
            *last = [x, y, w].map(|v| v / w * last[2]);
        }
        // A joint is a knot of the multiplicity `degree`, an end one of one more.
        let is_end = |joint: usize| joint == 0 || joint == parts.len();
        let multiplicity = |joint: usize| degree + usize::from(is_end(joint));
        let knots = (0..=parts.len()).flat_map(|k| std::iter::repeat_n(k as f64, multiplicity(k))).collect();
        Some(spline(&self.name, [degree, points.len()], knots, &points))
    }
}

/// Returns the curve with these homogeneous points as a surface with two equal rows.
fn spline(name: &str, [degree, n]: [usize; 2], knots: Vec<f64>, points: &[[f64; 3]]) -> Surface {
    let row: Vec<DVec3> = points.iter().map(|[x, y, w]| DVec3::new(x / w, y / w, 0.0)).collect();
    let weights: Vec<f64> = points.iter().take(n).map(|p| p[2]).collect();
    Surface {
        name: name.to_owned(),
        degree: [degree, 1],
        knots: [knots, vec![0.0, 0.0, 1.0, 1.0]],
        points: row.repeat(2),
        weights: weights.repeat(2),
        trims: Vec::new(),
    }
}

/// Returns the image of a rational Bézier curve that no crease crosses. Errors call the curve `what`.
fn image(map: &dyn Map, points: &[DVec4], what: &str) -> Result<RationalBezier, String> {
    /// Number of parameters at which the image is compared with the map, and the tolerance relative to the coordinates.
    const SAMPLES: u32 = 64;
    const ROUNDING: f64 = 1e-9;
    let curve = RationalBezier { points: points.iter().map(|p| [p.x, p.y, p.w]).collect() };
    let branch = map.branch(curve.eval(0.5));
    let image = branch.as_deref().map_or_else(|| map.image(&curve), |m| m.image(&curve));
    let image = image.ok_or_else(|| no_image(what))?.reduced();
    let holds = |i| {
        let t = f64::from(i) / f64::from(SAMPLES);
        let (source, wanted) = (curve.eval(t), map.point(curve.eval(t)));
        image.eval(t).distance(wanted) <= ROUNDING * (source.to_vec2().hypot() + wanted.to_vec2().hypot())
    };
    let crossed = || format!("{what} meets a crease of the map or the end of its domain; cut it there");
    (0..=SAMPLES).all(holds).then_some(image).ok_or_else(crossed)
}

/// Returns the error that a weight of a contour's image is not positive.
fn no_weights(contour: usize) -> String {
    let advice = "cut it into shorter curves, or warp its drawing with -o out.dxf, which fits curves";
    format!("contour {contour} has control points beyond infinity, for which a spline has no weights: {advice}")
}

fn no_image(what: &str) -> String {
    format!("{what} has no exact image: the map's coordinates are not quotients of polynomials there")
}

/// Names one of several curves in a message by its number, and its name if it has one.
fn numbered(all: &[Surface], i: usize) -> String {
    let name = &all[i].name;
    let kind = if all[i].is_curve() { "curve" } else { "surface" };
    format!("{kind} {}{}", i + 1, if name.is_empty() { String::new() } else { format!(" ({name})") })
}

/// Writes curves in space, in millimetres, as the splines of a DXF. The error names the curve at fault and advises.
pub(super) fn dxf(curves: &[Surface]) -> Result<String, String> {
    if let Some(i) = curves.iter().position(|s| !s.is_curve()) {
        return Err(format!("{}: a DXF holds curves alone; write surfaces as .json or .bpt", numbered(curves, i)));
    }
    check_degrees(curves, MAX_DEGREE)?;
    let points: Vec<Vec<[f64; 3]>> = curves.iter().map(|s| s.points.iter().map(DVec3::to_array).collect()).collect();
    // A curve is a surface whose second row of control points repeats the first.
    let splines = curves.iter().zip(&points).map(|(s, points)| Spline {
        layer: &s.name,
        degree: s.degree[0],
        knots: &s.knots[0],
        points: &points[..s.size()[0]],
        weights: &s.weights[..s.size()[0]],
    });
    Ok(write_splines(&splines.collect::<Vec<_>>()))
}

/// Checks that no curve has a higher degree than its format allows.
fn check_degrees(curves: &[Surface], most: usize) -> Result<(), String> {
    let Some(i) = curves.iter().position(|s| s.degree[0] > most) else { return Ok(()) };
    let (name, degree) = (numbered(curves, i), curves[i].degree[0]);
    let advice =
        if most < patch::MAX_DEGREE { "write .json" } else { "leave --out away, which prints its control points" };
    Err(format!(
        "{name} has degree {degree}, and a file of this format at most {most}: {advice}, take a tool of a lower degree, or fit curves \
         within a tolerance (warp the drawing with -o out.dxf)"
    ))
}
