//! GIMP paths as artwork: warped, and written in a format that GIMP reads.

use super::artwork::{self, Artwork, Baseline, FileArtwork, WarpRequest, WarpedArtwork, WarpedResult, Which};
use super::beside;
use super::files::{display, split_reference};
use super::gimp_file::{GimpFile, resized};
use crate::export::{self, Exported};
use crate::failure::Failure;
use crate::format::{Choice, Format};
use crate::options::{CommonOptions, FrameChoice};
use crate::output::PendingFile;
use crate::page::PageNews;
use crate::report::{Fold, ReportedShape, SkippedShape};
use pathwarp::budget::{Budget, Limits};
use pathwarp::edit::{self, Offset};
use pathwarp::fold::{Orientation, Survey};
use pathwarp::kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::map::{Class, Map, Undeclared};
use pathwarp::param::Frame;
use pathwarp::recipe::{BuiltParts, BuiltRecipe, Step};
use pathwarp::refit::{self, PathReport, SharedEdges};
use pathwarp::{Error, GeometryError, Outline};
use pathwarp_gimp::{FileKind, GimpPath, Stroke, to_json, to_svg};
use pathwarp_svg::{Document, Edit, OnError, ReadOptions, ShapeReport};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

pub(super) use pathwarp_gimp::{HEAD, may_begin};

/// Opens an input for its paths; `None` if it is no GIMP file.
pub(super) fn open(
    input: &Path,
    options: &CommonOptions,
    target: Option<&Path>,
) -> Result<Option<Box<dyn FileArtwork>>, Failure> {
    let Some(file) = GimpFile::open(input, options.salvage, &options.reading.limits)? else { return Ok(None) };
    Ok(Some(Box::new(GimpArtwork::new(file, options, target)?)))
}

/// The path called `name`, or the only one, of a file; `None` if it is no GIMP file.
pub fn outline(file: &Path, name: Option<&str>, limits: &Limits) -> Result<Option<Outline>, Error> {
    let Some(file) = GimpFile::read(file, false, limits)? else { return Ok(None) };
    Ok(Some(name.map_or_else(|| file.only_path(), |name| file.path_named(name))?.outline()))
}

/// The paths of a GIMP file. Their plane is the canvas, in pixels.
struct GimpArtwork {
    file: GimpFile,
    format: GimpFormat,
    select: Vec<String>,
    exclude: Vec<String>,
    /// The indices of the paths to warp.
    selected: Vec<usize>,
    /// The outlines of those paths.
    outlines: Vec<Outline>,
    /// For each of those paths, the steps that hold for it; empty if all do.
    steps: Vec<Vec<usize>>,
    /// The steps of every part, if the steps divide the paths.
    parts: Vec<Vec<usize>>,
    budget: Arc<Budget>,
}

impl GimpArtwork {
    /// The paths of `file` that the options select.
    fn new(file: GimpFile, options: &CommonOptions, target: Option<&Path>) -> Result<Self, Failure> {
        let format = format(options, &file, target)?;
        let (select, exclude) = (options.select.clone(), options.exclude.clone());
        check_names(&file, select.iter().chain(&exclude))?;
        let size = std::fs::metadata(&file.path).map_or(0, |m| m.len());
        let limits = options.reading.limits.for_input(usize::try_from(size).unwrap_or(usize::MAX));
        let budget = Arc::new(Budget::new(limits));
        Ok(Self {
            file,
            format,
            select,
            exclude,
            selected: Vec::new(),
            outlines: Vec::new(),
            steps: Vec::new(),
            parts: Vec::new(),
            budget,
        })
    }

    fn path(&self, i: usize) -> &GimpPath {
        &self.file.file.paths[i]
    }

    /// Returns `true` if a path is to be warped: selected, not a guide, and not empty.
    fn is_selected(&self, p: &GimpPath, guides: &[String]) -> bool {
        !p.strokes.is_empty()
            && self.file.only.as_ref().is_none_or(|o| *o == p.name)
            && holds_for(&self.select, &self.exclude, &p.name)
            && !guides.contains(&p.name)
    }

    /// The places among the selected paths of what is meant.
    fn places(&self, which: Which) -> impl Iterator<Item = usize> {
        (0..self.selected.len()).filter(move |&i| match (which, self.steps.get(i)) {
            (Which::All, _) | (_, None) => true,
            (Which::Step(s), Some(steps)) => steps.contains(&s),
            (Which::Part(k), Some(steps)) => self.parts[k] == *steps,
        })
    }

    /// The index of the part that a selected path is in.
    fn part(&self, place: usize) -> usize {
        self.steps.get(place).and_then(|own| self.parts.iter().position(|p| p == own)).unwrap_or(0)
    }

    /// Writes the warped paths in the format chosen. Returns the result and what the format could not take.
    fn write(&self, warped: &WarpedPaths, request: &WarpRequest<'_>) -> Result<(WarpedResult, Vec<String>), Failure> {
        let canvas = self.file.canvas();
        // Coordinates that have not moved are not rounded.
        let stays = |b: &BuiltRecipe| {
            request.edit.is_none() && b.map.class() == Class::Affine(Affine::IDENTITY) && b.placement.copies.is_empty()
        };
        let unmoved = request.built.parts.iter().all(stays);
        let precision = request.options.precision.or((!unmoved).then(|| {
            let contours = self.outlines.iter().flat_map(|o| request.contours(o));
            decimals_for(contours.fold(request.tolerance, f64::min))
        }));
        let format = match (self.format, &request.options.into) {
            (GimpFormat::IntoXcf, Some(copy)) => {
                let file = copy_with_paths(&self.file.path, copy, &warped.strokes)?;
                return Ok((WarpedResult::File(file), Vec::new()));
            }
            (GimpFormat::Paths(format), _) => format,
            (GimpFormat::IntoXcf, None) => Format::Svg,
        };
        let paths = warped.paths(self);
        let Exported { bytes, warnings } = match format {
            Format::PointList => {
                let (canvas, paths) = resized(canvas, &paths, request.options);
                to_json(Some(canvas), &paths).into_bytes().into()
            }
            drawing => {
                let svg = to_svg(canvas, &paths, precision);
                export::drawing(svg, drawing, &ReadOptions::default(), request.options, Some(request.tolerance))?
            }
        };
        Ok((WarpedResult::Bytes(bytes), warnings))
    }

    fn preview(&self, warped: &WarpedPaths, built: &BuiltParts, file: (&Path, Option<u8>)) -> Result<Vec<u8>, Failure> {
        let canvas = self.file.canvas();
        let before: Vec<GimpPath> = self.selected.iter().map(|&i| self.path(i).clone()).collect();
        let (before, after) = (to_svg(canvas, &before, None), to_svg(canvas, &warped.paths(self), None));
        let doc = Document::read(before.as_bytes(), &self.file_name(), &ReadOptions::default())?;
        beside::preview(&doc, (&after, Affine::IDENTITY), built, &ReadOptions::default(), file)
    }
}

impl Artwork for GimpArtwork {
    fn path_named(&self, name: &str) -> Result<Outline, Error> {
        Ok(self.file.path_named(name)?.outline())
    }

    fn remove_guides(&mut self, guides: Vec<String>) {
        let paths = self.file.file.paths.iter().enumerate();
        self.selected = paths.filter(|(_, p)| self.is_selected(p, &guides)).map(|(i, _)| i).collect();
        self.outlines = self.selected.iter().map(|&i| self.path(i).outline()).collect();
    }

    fn divide(&mut self, steps: &[Step]) -> Result<Vec<Vec<usize>>, Failure> {
        check_names(&self.file, steps.iter().flat_map(|s| s.select.iter().chain(&s.exclude)))?;
        let of = |&i: &usize| -> Vec<usize> {
            let holds = |s: &Step| holds_for(&s.select, &s.exclude, &self.path(i).name);
            steps.iter().enumerate().filter(|(_, s)| holds(s)).map(|(i, _)| i).collect()
        };
        let of_paths: Vec<(usize, Vec<usize>)> = self.selected.iter().map(|i| (*i, of(i))).collect();
        let held: Vec<_> = of_paths.into_iter().filter(|(_, steps)| !steps.is_empty()).collect();
        self.outlines = held.iter().map(|(i, _)| self.path(*i).outline()).collect();
        (self.selected, self.steps) = held.into_iter().unzip();
        self.parts = self.steps.iter().cloned().collect::<BTreeSet<_>>().into_iter().collect();
        Ok(self.parts.clone())
    }

    fn bounding_box(&self, which: Which) -> Option<Rect> {
        self.places(which).filter_map(|i| self.outlines[i].bounding_box()).reduce(|a, b| a.union(b))
    }

    fn frame(&self, _: Which, choice: FrameChoice, bounds: Option<Rect>, _: Baseline) -> Result<Frame, Failure> {
        let [width, height] = self.file.canvas();
        let canvas = Rect::new(0.0, 0.0, width, height);
        match choice {
            FrameChoice::Default | FrameChoice::Artwork => Ok(Frame::new(bounds.unwrap_or(canvas))),
            FrameChoice::ViewBox => Ok(Frame::new(canvas)),
            FrameChoice::Rect(r) => Ok(Frame::new(r.rect(self.units_per_px()))),
            FrameChoice::Lettering(_) => {
                Err(Failure::usage("--frame: GIMP paths do not store their baseline; give X,Y,W,H"))
            }
        }
    }

    fn budget(&self) -> &Arc<Budget> {
        &self.budget
    }

    fn outlines(&self, which: Which) -> Vec<&Outline> {
        self.places(which).map(|i| &self.outlines[i]).collect()
    }
}

impl FileArtwork for GimpArtwork {
    fn file_name(&self) -> String {
        display(&self.file.path)
    }

    fn warp(&self, request: &WarpRequest<'_>) -> Result<WarpedArtwork, Failure> {
        let WarpRequest { built, options, .. } = request;
        if let Some(param) = beside::surface_requested(&built.whole) {
            return Err(Failure::usage(format!(
                "--{param} is for SVG files; convert the paths to SVG first (`pathwarp convert`)"
            )));
        }
        if request.edit == Some(Edit::Outline) {
            return Err(Failure::usage("GIMP's paths have no strokes that could become outlines"));
        }
        let mut warped = self.warp_paths(request)?;
        let empty = self.selected.is_empty();
        if empty {
            warped.warnings.push("there is nothing to warp: no paths with strokes".into());
        }
        let (result, lost) = self.write(&warped, request)?;
        warped.warnings.extend(lost);
        let preview = options.preview.as_deref().map(|file| self.preview(&warped, built, (file, options.quality)));
        Ok(WarpedArtwork {
            filters: Default::default(),
            result,
            page: PageNews::default(),
            tolerance: None,
            files: Vec::new(),
            preview: preview.transpose()?,
            shapes: warped.shapes,
            skipped: warped.skipped,
            warnings: warped.warnings,
            partial: empty || self.file.damage.is_some(),
        })
    }
}

/// The selected paths under the map.
struct WarpedPaths {
    /// The new strokes of every selected path, by its index in the file.
    strokes: Vec<(usize, Vec<Stroke>)>,
    shapes: Vec<ReportedShape>,
    skipped: Vec<SkippedShape>,
    warnings: Vec<String>,
}

impl WarpedPaths {
    fn paths(&self, artwork: &GimpArtwork) -> Vec<GimpPath> {
        let path =
            |(i, strokes): &(usize, Vec<Stroke>)| GimpPath { strokes: strokes.clone(), ..artwork.path(*i).clone() };
        self.strokes.iter().map(path).collect()
    }
}

/// With fewer segments, starting threads takes longer than the work.
const WORTH_THREADS: usize = 1000;

/// What bends a part of the paths.
struct PartBend<'a> {
    map: &'a dyn Map,
    places: Vec<Affine>,
    refit: refit::Options,
    survey: Survey<'a>,
    segments: usize,
}

impl GimpArtwork {
    fn part_bend<'a>(&self, k: usize, built: &'a BuiltRecipe, request: &WarpRequest<'_>) -> PartBend<'a> {
        let outlines = || self.places(Which::Part(k)).map(|i| &self.outlines[i]);
        let contours: Vec<Vec<f64>> = outlines().map(|o| request.contours(o)).collect();
        let refit = refit::Options::new(request.tolerance)
            .with_certify(request.options.certify)
            .with_merge(request.options.merge)
            .with_budget(Arc::clone(&self.budget))
            .with_suited(request.suited)
            .with_shared(Arc::new(SharedEdges::held(outlines().zip(contours.iter().map(Vec::as_slice)))));
        let copies = &built.placement.copies;
        let places = if copies.is_empty() { vec![Affine::IDENTITY] } else { copies.clone() };
        let segments: usize = outlines().map(|o| o.segs().count()).sum();
        let survey = Survey::new(&built.map, self.bounding_box(Which::Part(k)), segments);
        let Some(Edit::Simplify { corner, .. }) = request.edit else {
            return PartBend { map: &built.map, places, refit, survey, segments };
        };
        PartBend { map: &Undeclared, places, refit: refit.with_merge(true).with_corner(corner), survey, segments }
    }

    fn warp_paths(&self, request: &WarpRequest<'_>) -> Result<WarpedPaths, Failure> {
        let WarpRequest { built, options, .. } = request;
        let bends: Vec<PartBend<'_>> =
            built.parts.iter().enumerate().map(|(k, b)| self.part_bend(k, b, request)).collect();
        let segments: usize = bends.iter().map(|b| b.segments).sum();
        let spent = bends.iter().try_for_each(|b| b.survey.spend(0, b.segments, b.places.len(), &self.budget));
        spent.map_err(Error::from)?;
        let warp = |place: usize| {
            let b = &bends[self.part(place)];
            let path = self.path(self.selected[place]);
            let strokes = match request.edit {
                Some(Edit::Offset(offset)) => moved_strokes(&self.outlines[place], &offset, &b.refit),
                _ => warp_strokes(path, &b.places, b.map, &b.refit),
            };
            let strokes = if matches!(request.edit, Some(Edit::Simplify { .. })) {
                strokes.map(|w| w.or_fewer(path))
            } else {
                strokes
            };
            (strokes, b.survey.orientation(&self.outlines[place], false))
        };
        let results: Vec<(Result<WarpedStrokes, GeometryError>, Orientation)> = if segments < WORTH_THREADS {
            (0..self.selected.len()).map(warp).collect()
        } else {
            (0..self.selected.len()).into_par_iter().map(warp).collect()
        };

        // A part that is mirrored does not fold over the others.
        let mut all = vec![Orientation::default(); bends.len()];
        for (place, (_, o)) in results.iter().enumerate() {
            let sum = &mut all[self.part(place)];
            *sum = sum.and(o);
        }
        let mut out = WarpedPaths {
            strokes: Vec::with_capacity(results.len()),
            shapes: Vec::with_capacity(results.len()),
            skipped: Vec::new(),
            warnings: self.file.damage.iter().cloned().collect(),
        };
        for (place, (&i, (result, orientation))) in self.selected.iter().zip(results).enumerate() {
            let (path, part) = (self.path(i), self.part(place));
            match result {
                Ok(mut warped) => {
                    let fold = Fold::of(&orientation, &all[part]);
                    out.warnings.extend(fold.at.map(|at| artwork::fold_warning(&path.name, &[], at)));
                    if self.format == GimpFormat::IntoXcf {
                        warped.report.max_error +=
                            warped.strokes.iter().map(single_precision_error).fold(0.0, f64::max);
                    }
                    let steps = self.steps.get(place).map(|all| all.iter().map(|i| i + 1).collect());
                    let shape = ShapeReport::new(&path.name, bends[part].places.len(), warped.report);
                    out.shapes.push(ReportedShape { shape, steps, fold });
                    out.strokes.push((i, warped.strokes));
                }
                Err(e) => {
                    let e = e.on_shape(&path.name);
                    if options.on_failure.of_shapes() == OnError::Stop {
                        return Err(Error::Geometry(e).into());
                    }
                    out.skipped.push(SkippedShape { id: path.name.clone(), why: e.to_string() });
                    out.strokes.push((i, path.strokes.clone()));
                }
            }
        }
        Ok(out)
    }
}

/// Returns `true` if names that are selected and excluded hold for a path.
fn holds_for(select: &[String], exclude: &[String], path: &str) -> bool {
    let names = |list: &[String]| list.iter().any(|s| s.strip_prefix('#').unwrap_or(s) == path);
    (select.is_empty() || names(select)) && !names(exclude)
}

fn check_names<'a>(file: &GimpFile, mut names: impl Iterator<Item = &'a String>) -> Result<(), Error> {
    names.try_for_each(|name| file.path_named(name.strip_prefix('#').unwrap_or(name)).map(|_| ()))
}

/// Number of decimals that keeps rounding below a hundredth of the tolerance.
fn decimals_for(tolerance: f64) -> u8 {
    const MOST: f64 = 12.0;
    (2.0 - tolerance.log10()).ceil().clamp(0.0, MOST) as u8
}

/// Copies the XCF `from` to `copy` with new strokes for some paths.
fn copy_with_paths(from: &Path, copy: &Path, strokes: &[(usize, Vec<Stroke>)]) -> Result<PendingFile, Failure> {
    let source = File::open(from).map_err(|e| Failure::file(from, format!("cannot be read: {e}")))?;
    PendingFile::with_writer(copy, |file| {
        let mut to = BufWriter::new(file);
        pathwarp_gimp::rewrite(source, &mut to, strokes).map_err(|e| e.to_string())?;
        to.flush().map_err(|e| format!("cannot be written: {e}"))
    })
}

/// A path's strokes under a map.
pub(super) struct WarpedStrokes {
    pub(super) strokes: Vec<Stroke>,
    pub(super) report: PathReport,
}

impl WarpedStrokes {
    /// The strokes of `path`, unless these have fewer segments.
    pub(super) fn or_fewer(self, path: &GimpPath) -> Self {
        let segments = self.report.segments_in;
        if self.report.segments_out < segments {
            return self;
        }
        let mut report = PathReport::default();
        (report.segments_in, report.segments_out) = (segments, segments);
        Self { strokes: path.strokes.clone(), report }
    }
}

/// Warps the strokes of `path`, one copy for each of `places`.
pub(super) fn warp_strokes(
    path: &GimpPath,
    places: &[Affine],
    map: &dyn Map,
    options: &refit::Options,
) -> Result<WarpedStrokes, GeometryError> {
    let mut out = WarpedStrokes { strokes: Vec::new(), report: PathReport::default() };
    let segments = |s: &Stroke| if s.closed { s.anchors() } else { s.anchors().saturating_sub(1) };
    for (place, stroke) in places.iter().flat_map(|p| path.strokes.iter().map(move |s| (*p, s))) {
        if let Class::Affine(m) = map.class() {
            // Every control point is kept, including handles that belong to no segment.
            let m = m * place;
            out.strokes.push(if m == Affine::IDENTITY { stroke.clone() } else { transformed(stroke, m) });
            out.report.segments_in += segments(stroke);
            out.report.segments_out += segments(stroke);
            continue;
        }
        let placed = transformed(stroke, place);
        let Some(subpath) = placed.subpath() else { continue };
        if subpath.segs.is_empty() {
            out.strokes.push(warp_single_anchors(&placed, map)?);
            continue;
        }
        let result = refit::warp_path(&Outline { subpaths: vec![subpath] }, map, options)?;
        let outline = Outline::from(&result.path);
        out.strokes.extend(outline.subpaths.iter().map(Stroke::from_subpath));
        let r = result.report;
        out.report.segments_in += r.segments_in;
        out.report.segments_out += r.segments_out;
        out.report.add(r);
    }
    Ok(out)
}

/// The strokes at a distance from an outline.
pub(super) fn moved_strokes(
    outline: &Outline,
    offset: &Offset,
    options: &refit::Options,
) -> Result<WarpedStrokes, GeometryError> {
    let moved = edit::moved(outline, offset, options, &[])?;
    let strokes = Outline::from(&moved.path).subpaths.iter().map(Stroke::from_subpath).collect();
    Ok(WarpedStrokes { strokes, report: moved.report })
}

fn transformed(stroke: &Stroke, m: Affine) -> Stroke {
    let points = stroke.points.iter().map(|&[x, y]| m * Point::new(x, y));
    Stroke { closed: stroke.closed, points: points.map(|p| [p.x, p.y]).collect() }
}

/// Maps anchors that have no segment, and their handles by the map's derivative.
fn warp_single_anchors(stroke: &Stroke, map: &dyn Map) -> Result<Stroke, GeometryError> {
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

/// Largest distance by which single precision, in which an XCF stores coordinates, moves a point of the stroke.
pub(super) fn single_precision_error(s: &Stroke) -> f64 {
    let off = |v: f64| f64::from(v as f32) - v;
    s.points.iter().map(|&[x, y]| off(x).hypot(off(y))).fold(0.0, f64::max)
}

/// The form in which warped GIMP paths are written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum GimpFormat {
    Paths(Format),
    /// A copy of the input XCF.
    IntoXcf,
}

/// The formats of GIMP paths.
pub(crate) const PATHS: &[Format] = &[Format::Svg, Format::Svgz, Format::Pdf, Format::Dxf, Format::PointList];

/// The format for the options and the target, `None` being standard output.
///
/// # Errors
/// The options ask for something that this file cannot be written as.
pub(super) fn format(options: &CommonOptions, input: &GimpFile, target: Option<&Path>) -> Result<GimpFormat, Failure> {
    if options.embed_recipe {
        return Err(Failure::usage(
            "--embed-recipe is for SVG files; --write-recipe saves the recipe beside the result",
        ));
    }
    if let Some(copy) = &options.into {
        check_into(input, copy)?;
        return Ok(GimpFormat::IntoXcf);
    }
    if target.is_some_and(|t| Format::of(t) == Some(Format::Xcf)) {
        return Err(Failure::usage(
            "an XCF holds more than paths; --into COPY.xcf writes a copy of the input with its paths warped (--into \
             INPUT.xcf --in-place overwrites the input)",
        ));
    }
    Ok(GimpFormat::Paths(Choice { what: "GIMP paths are", among: PATHS }.format(target, options.format)?))
}

/// Checks that the paths of `input` can be written into its copy.
fn check_into(input: &GimpFile, copy: &Path) -> Result<(), Failure> {
    let problem = match input.file.kind {
        FileKind::Xcf(_) if input.damage.is_some() => "is damaged; write its paths to SVG or JSON (-o)",
        FileKind::Xcf(_) => "",
        FileKind::PackedXcf(_) => "is packed; unpack it first",
        _ => "is not an XCF",
    };
    if !problem.is_empty() {
        let file = display(&input.path);
        return Err(Failure::usage(format!("--into copies a plain, undamaged XCF; {file} {problem}")));
    }
    if !copy.extension().is_some_and(|e| e.eq_ignore_ascii_case("xcf")) {
        return Err(Failure::usage(format!("--into writes an XCF; give {} the extension .xcf", copy.display())));
    }
    Ok(())
}

/// The name of the SVG made from a GIMP input: `art.xcf.gz#Cage` gives `art-Cage.svg`. `None` for other inputs.
pub fn svg_name(input: &Path) -> Option<String> {
    const ENDINGS: [&str; 6] = [".xcf", ".xcf.gz", ".xcf.bz2", ".xcf.xz", ".json", ".txt"];
    let text = input.to_string_lossy();
    let (file, name) = if input.is_file() { (input.to_owned(), None) } else { split_reference(&text) };
    let file = file.file_name()?.to_string_lossy().into_owned();
    let stem = ENDINGS.iter().rev().find_map(|e| file.strip_suffix(e))?;
    Some(match name {
        Some(name) => format!("{stem}-{}.svg", file_name(name)),
        None => format!("{stem}.svg"),
    })
}

/// A path's name as part of a file name: letters and digits of any script are kept, everything else becomes a hyphen.
pub fn file_name(name: &str) -> String {
    let plain = name.chars().map(|c| if c.is_alphanumeric() || matches!(c, '_' | '.' | '-') { c } else { '-' });
    plain.collect::<String>().trim_matches(['-', '.']).to_owned()
}
