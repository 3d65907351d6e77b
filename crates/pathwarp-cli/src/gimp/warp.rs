//! `pathwarp DEFORMATION art.xcf`: GIMP's paths warped, and given back in a form that GIMP takes.

use super::Input;
use crate::common::{Common, FrameChoice};
use crate::deform::{Job, display};
use crate::failure::Failure;
use crate::output::Pending;
use crate::reference::{Names, References};
use crate::{preview, report};
use pathwarp::deform::Registry;
use pathwarp::fold::{self, Orientation};
use pathwarp::kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::map::{Class, Map};
use pathwarp::param::Frame;
use pathwarp::recipe::Recipe;
use pathwarp::refit::{self, Assurance, SharedEdges};
use pathwarp::{GeometryError, Outline};
use pathwarp_gimp::{GimpPath, Kind, Stroke, to_json, to_svg};
use pathwarp_svg::{Document, OnError, ReadOptions};
use rayon::prelude::*;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::sync::Arc;

/// Warps the paths that are meant. Their plane is the canvas, in pixels.
pub(crate) fn warp(
    registry: &Registry,
    recipe: &Recipe,
    common: &Common,
    input: &Input,
    target: Option<&Path>,
) -> Result<Job, Failure> {
    let form = form(common, input, target)?;
    let mut references = References::new(Some(Names::Gimp(input)));
    let mut recipe = recipe.clone();
    references.resolve(registry, &mut recipe)?;
    let meant = meant(input, common, &references.guides);
    let outlines: Vec<Outline> = meant.iter().map(|&i| input.file.paths[i].outline()).collect();
    let boxes = outlines.iter().filter_map(Outline::bounding_box);
    let artwork = boxes.reduce(|a, b| a.union(b));
    let [width, height] = input.canvas();
    let frame = match common.frame {
        FrameChoice::Default | FrameChoice::Artwork => artwork.unwrap_or(Rect::new(0.0, 0.0, width, height)),
        FrameChoice::ViewBox => Rect::new(0.0, 0.0, width, height),
        FrameChoice::Rect(r) => r,
        FrameChoice::Lettering(_) => {
            return Err(Failure::usage("--frame: GIMP paths do not tell where their baseline is; give X,Y,W,H"));
        }
    };
    let built = recipe.build(registry, Frame::new(frame), &outlines.iter()).map_err(Failure::of_recipe)?;
    if built.steps.iter().filter_map(|s| s.space.as_ref()).any(|s| !s.files.is_empty()) {
        return Err(Failure::usage(
            "--mesh and --curves are for SVG files; give the paths as SVG (`pathwarp convert`)",
        ));
    }

    let tolerance = common.tolerance_for(artwork);
    let options = refit::Options {
        certify: common.certify,
        merge: common.merge,
        shared: Arc::new(SharedEdges::among(outlines.iter())),
        ..refit::Options::new(tolerance)
    };
    let places =
        if built.placement.copies.is_empty() { vec![Affine::IDENTITY] } else { built.placement.copies.clone() };
    let one = |(&i, outline): (&usize, &Outline)| {
        let path = &input.file.paths[i];
        (warped(path, &places, &built.map, &options), fold::orientation(outline, false, &built.map))
    };
    let results: Vec<_> = meant.par_iter().zip(&outlines).map(one).collect();

    let mut report = report::Input {
        file: display(&input.path),
        output: target.or(common.into.as_deref()).map(|t| t.display().to_string()),
        tolerance,
        shapes: Vec::new(),
        skipped: Vec::new(),
        warnings: built.steps.iter().flat_map(|s| s.explanation.warnings.clone()).chain(input.damage.clone()).collect(),
    };
    let all = results.iter().fold(Orientation::default(), |a, (_, o)| a.and(o));
    let mut strokes = Vec::with_capacity(meant.len());
    for (&i, (result, turned)) in meant.iter().zip(results) {
        let path = &input.file.paths[i];
        match result {
            Ok(mut done) => {
                let at = turned.folded_against(&all);
                if let Some(p) = at {
                    let what = "folds over near";
                    let why = "the map turns the plane over there";
                    report.warnings.push(format!("{} {what} {:.4},{:.4}: {why}", path.name, p.x, p.y));
                }
                if common.into.is_some() {
                    done.max_error += done.strokes.iter().map(rounding).fold(0.0, f64::max);
                }
                report.shapes.push(done.report(&path.name, places.len(), &turned, at));
                strokes.push((i, done.strokes));
            }
            Err(e) => {
                let e = e.on_shape(&path.name);
                if common.on_error == OnError::Stop {
                    return Err(Failure::Geometry(e.to_string()));
                }
                report.skipped.push(report::Skipped { id: path.name.clone(), why: e.to_string() });
                strokes.push((i, path.strokes.clone()));
            }
        }
    }

    // What has not been moved needs no rounding.
    let exact = built.map.class() == Class::Affine(Affine::IDENTITY) && built.placement.copies.is_empty();
    let decimals = common.precision.or((!exact).then(|| decimals(tolerance)));
    let with =
        |(i, strokes): &(usize, Vec<Stroke>)| GimpPath { strokes: strokes.clone(), ..input.file.paths[*i].clone() };
    let result: Vec<GimpPath> = strokes.iter().map(with).collect();
    let text = match form {
        Form::Json => to_json(Some([width, height]), &result),
        Form::Svg | Form::Into => to_svg([width, height], &result, decimals),
    };
    let mut output = Vec::new();
    if let Some(copy) = &common.into {
        output.push(put_into(&input.path, copy, &strokes)?);
    } else if let Some(t) = target {
        output.push(Pending::new(t, text.as_bytes())?);
    }
    for file in built.steps.iter().flat_map(|s| &s.saves) {
        output.push(Pending::new(Path::new(&file.name), file.text.as_bytes())?);
    }
    if let Some(file) = &common.preview {
        let before: Vec<GimpPath> = meant.iter().map(|&i| input.file.paths[i].clone()).collect();
        let (before, after) = (to_svg([width, height], &before, None), to_svg([width, height], &result, None));
        let doc = Document::read(before.as_bytes(), &report.file, &ReadOptions::default())?;
        output.push(Pending::new(file, &preview::draw(&doc, &after, &built, &ReadOptions::default())?)?);
    }
    let notes = if common.explain {
        built.steps.iter().flat_map(|s| s.explanation.notes.clone()).collect()
    } else {
        Vec::new()
    };
    let short = report.shapes.iter().any(|s| !s.over_budget.is_empty());
    let partly = !report.skipped.is_empty() || input.damage.is_some() || short;
    let to_stdout = (target.is_none() && common.into.is_none()).then(|| text.into_bytes());
    Ok(Job { report, output, to_stdout, notes, partly })
}

/// What the result is written as.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    Svg,
    Json,
    Into,
}

fn form(common: &Common, input: &Input, target: Option<&Path>) -> Result<Form, Failure> {
    if common.embed_recipe {
        return Err(Failure::usage(
            "--embed-recipe is for SVG files; --write-recipe saves the recipe beside the result",
        ));
    }
    if let Some(copy) = &common.into {
        if !matches!(input.file.kind, Kind::Xcf(_)) {
            let what =
                if let Kind::PackedXcf(_) = input.file.kind { "it is packed; unpack it first" } else { "it is none" };
            let file = display(&input.path);
            return Err(Failure::usage(format!("--into puts paths back into a plain XCF, and as for {file}, {what}")));
        }
        if input.damage.is_some() {
            return Err(Failure::usage("--into needs a sound XCF; a damaged one's paths go to SVG or JSON (-o)"));
        }
        if !copy.extension().is_some_and(|e| e.eq_ignore_ascii_case("xcf")) {
            let copy = copy.display();
            return Err(Failure::usage(format!("--into writes an XCF, and {copy} is not called one (.xcf)")));
        }
        if let (Ok(a), Ok(b)) = (copy.canonicalize(), input.path.canonicalize())
            && a == b
        {
            return Err(Failure::usage("--into names the input itself; give the copy another name"));
        }
        return Ok(Form::Into);
    }
    let Some(extension) = target.and_then(Path::extension) else { return Ok(Form::Svg) };
    match extension.to_string_lossy().to_ascii_lowercase().as_str() {
        "svg" => Ok(Form::Svg),
        "json" => Ok(Form::Json),
        "xcf" => {
            Err(Failure::usage("an XCF holds more than paths: --into COPY.xcf writes the input with its paths warped"))
        }
        other => Err(Failure::usage(format!("GIMP's paths are written as .svg or .json, not as .{other}"))),
    }
}

/// The paths to be warped, by their place: not guides, and with something to warp.
fn meant(input: &Input, common: &Common, guides: &[String]) -> Vec<usize> {
    let names = |list: &[String], name: &str| list.iter().any(|s| s.strip_prefix('#').unwrap_or(s) == name);
    let is_meant = |p: &GimpPath| {
        !p.strokes.is_empty()
            && input.only.as_ref().is_none_or(|o| *o == p.name)
            && (common.select.is_empty() || names(&common.select, &p.name))
            && !names(&common.exclude, &p.name)
            && !guides.contains(&p.name)
    };
    let paths = input.file.paths.iter().enumerate();
    paths.filter(|(_, p)| is_meant(p)).map(|(i, _)| i).collect()
}

/// A path under the map.
struct Done {
    strokes: Vec<Stroke>,
    segments_in: usize,
    segments_out: usize,
    max_error: f64,
    assurance: Assurance,
    over_budget: Vec<Point>,
}

impl Done {
    fn report(&self, name: &str, copies: usize, turned: &Orientation, folded_at: Option<Point>) -> report::Shape {
        report::Shape {
            id: name.to_owned(),
            copies,
            segments_in: self.segments_in,
            segments_out: self.segments_out,
            max_error: self.max_error,
            certified: self.assurance != Assurance::Checked,
            assurance: report::assurance_word(self.assurance),
            folds: if folded_at.is_some() { turned.changes.max(1) } else { 0 },
            folded_at: folded_at.map(|p| [p.x, p.y]),
            over_budget: self.over_budget.iter().map(|p| [p.x, p.y]).collect(),
            paint_residual: None,
            pictures: 0,
        }
    }
}

fn warped(path: &GimpPath, places: &[Affine], map: &dyn Map, options: &refit::Options) -> Result<Done, GeometryError> {
    let mut done = Done {
        strokes: Vec::new(),
        segments_in: 0,
        segments_out: 0,
        max_error: 0.0,
        assurance: Assurance::Exact,
        over_budget: Vec::new(),
    };
    let anchors = |s: &Stroke| if s.closed { s.anchors() } else { s.anchors().saturating_sub(1) };
    for (place, stroke) in places.iter().flat_map(|p| path.strokes.iter().map(move |s| (*p, s))) {
        let moved = |m: Affine| {
            let points = stroke.points.iter().map(|&[x, y]| m * Point::new(x, y));
            Stroke { closed: stroke.closed, points: points.map(|p| [p.x, p.y]).collect() }
        };
        let class = map.class();
        if let Class::Affine(m) = class {
            // Every control point, also those that no curve shows, and every anchor stays.
            let m = m * place;
            done.strokes.push(if m == Affine::IDENTITY { stroke.clone() } else { moved(m) });
            done.segments_in += anchors(stroke);
            done.segments_out += anchors(stroke);
            continue;
        }
        let placed = moved(place);
        let Some(subpath) = placed.subpath() else { continue };
        if subpath.segs.is_empty() {
            done.strokes.push(lone(&placed, map)?);
            continue;
        }
        let result = refit::warp_path(&Outline { subpaths: vec![subpath] }, map, options)?;
        let outline = Outline::from(&result.path);
        done.strokes.extend(outline.subpaths.iter().map(Stroke::from_subpath));
        let r = result.report;
        done.segments_in += r.segments_in;
        done.segments_out += r.segments_out;
        done.max_error = done.max_error.max(r.max_error);
        done.assurance = done.assurance.min(r.assurance);
        done.over_budget.extend(r.over_budget);
    }
    Ok(done)
}

/// Anchors without a curve: they go where the map takes them, and their handles turn with it.
fn lone(stroke: &Stroke, map: &dyn Map) -> Result<Stroke, GeometryError> {
    let mut points = Vec::with_capacity(stroke.points.len());
    for [incoming, anchor, outgoing] in stroke.triples() {
        let j = map.jet(anchor);
        let along = |v: Vec2| j.p + j.dx * v.x + j.dy * v.y;
        let image = [along(incoming - anchor), j.p, along(outgoing - anchor)];
        if image.iter().any(|p| !p.is_finite()) {
            return Err(GeometryError::Infinity { shape: "path".to_owned(), at: anchor });
        }
        points.extend(image.map(|p| [p.x, p.y]));
    }
    Ok(Stroke { closed: stroke.closed, points })
}

/// How far single precision moves a stroke's points.
fn rounding(s: &Stroke) -> f64 {
    let off = |v: f64| f64::from(v as f32) - v;
    s.points.iter().map(|&[x, y]| off(x).hypot(off(y))).fold(0.0, f64::max)
}

/// Decimals enough for a hundredth of the tolerance.
fn decimals(tolerance: f64) -> u8 {
    const MOST: f64 = 12.0;
    (2.0 - tolerance.log10()).ceil().clamp(0.0, MOST) as u8
}

fn put_into(from: &Path, copy: &Path, strokes: &[(usize, Vec<Stroke>)]) -> Result<Pending, Failure> {
    let source = File::open(from).map_err(|e| Failure::file(from, format!("cannot be read: {e}")))?;
    Pending::written(copy, |file| {
        let mut to = BufWriter::new(file);
        pathwarp_gimp::rewrite(source, &mut to, strokes).map_err(|e| e.to_string())?;
        std::io::Write::flush(&mut to).map_err(|e| format!("cannot be written: {e}"))
    })
}
