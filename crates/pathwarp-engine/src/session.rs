//! The pipeline from artwork and steps to a result and a report: look up references, choose frames, build steps, warp artwork. The command
//! line, the editor, Inkscape and other languages all run it.

use crate::advice::{self, Flags};
use crate::caption::is_caption;
use crate::edits;
use crate::export::KerfReport;
use crate::failure::Failure;
use crate::input::{
    Artwork, Baseline, FileArtwork, Input, Planned, Proportions, WarpRequest, WarpedResult, Which, display, planned,
};
use crate::links::Destination;
use crate::options::{CommonOptions, FrameChoice, Given};
use crate::output::PendingFile;
use crate::page::PageNews;
use crate::readable::listed;
use crate::report::{FileReport, ReportedShape, StepSelection};
use crate::units::MM_PER_PX;
use crate::{recipe_file, references};
use pathwarp::deform::{Explanation, Registry, SavedFile};
use pathwarp::engine::{BuiltParts, Portion};
use pathwarp::kurbo::{Point, Rect};
use pathwarp::map::Map;
use pathwarp::param::Frame;
use pathwarp::recipe::{BuiltRecipe, Recipe, Step};
use pathwarp_raster::Picture;
use pathwarp_svg::engine::CutLine;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Steps and options, to be applied to artwork.
pub struct Session<'a> {
    /// The deformations known.
    pub registry: &'a Registry,
    /// The steps, with the contents of the files that they name.
    pub recipe: &'a Recipe,
    /// The options, parsed.
    pub options: &'a CommonOptions,
    /// The options as given; a recipe that is written stores these.
    pub given: &'a Given,
}

/// Steps that are built for some artwork.
pub struct Ready {
    /// The steps that bend, with all references looked up.
    pub recipe: Recipe,
    /// The edit to do if no step bends.
    edit: Option<Step>,
    /// The maps of all parts of the artwork.
    pub built: BuiltParts,
    /// The frame of the first step.
    pub frame: Frame,
    /// For each step, or for the edit: its frame, if no earlier step has moved its artwork.
    starts: Vec<Option<Frame>>,
}

/// Most names in a note; the report lists all.
const NAMED: usize = 5;

/// The frame of all artwork, kept from call to call.
pub struct Framed {
    /// The guides, the edits that are done first, and the first step's baseline, for which the frame was chosen.
    chosen_for: (Vec<String>, Vec<Step>, Baseline),
    /// The box that percentages refer to.
    pub frame: Frame,
}

/// Warped artwork. Nothing is written yet, except for the temporary files behind `files`.
pub struct Warped {
    /// The warped file.
    pub result: WarpedResult,
    /// The report, without the name of an output.
    pub report: FileReport,
    /// The changes of the page; the last warnings describe them.
    pub page: PageNews,
    /// The lines of `--explain`.
    pub notes: Vec<String>,
    /// `true` if something was left out or missed the tolerance.
    pub partial: bool,
    /// Files that deformations save.
    pub saves: Vec<SavedFile>,
    /// Files besides the result.
    pub files: Vec<PendingFile>,
    /// The picture of `--preview`.
    pub preview: Option<Vec<u8>>,
}

/// Warps the content of a file called `name` by a recipe whose file references have been looked up. Linked pictures are looked up beside
/// `name`; with an empty name, they are not read. `destination` decides about links in the result. The switch `stop` ends the work.
pub fn warp_bytes(
    registry: &Registry,
    recipe: &Recipe,
    given: &Given,
    stop: Option<&'static AtomicBool>,
    (name, destination): (&Path, Destination),
    bytes: &[u8],
) -> Result<(Vec<u8>, Warped), Failure> {
    // A drawing keeps its page in the calling program; a picture has none.
    let mut options = if Picture::sniff(bytes) { given.read()? } else { given.keeping_pages().read()? };
    options.reading.stop(stop);
    let (session, flags) = (Session { registry, recipe, options: &options, given }, Flags::of(registry));
    let warped = Input::of_bytes(bytes, name, &options, (None, destination))
        .and_then(|mut input| session.warp(input.artwork(), &flags));
    let mut warped = warped.map_err(|f| f.about(&display(name)))?;
    match &mut warped.result {
        WarpedResult::Bytes(bytes) => Ok((std::mem::take(bytes), warped)),
        // Only an XCF is written to a file, and an XCF is never read from memory.
        WarpedResult::File(_) => Err(Failure::usage("the result is a file")),
    }
}

impl Session<'_> {
    /// Looks up references in the artwork, chooses frames and builds steps. An editor passes `framed` to keep the frame from call to call.
    pub fn ready(&self, artwork: &mut dyn Artwork, framed: Option<&mut Option<Framed>>) -> Result<Ready, Failure> {
        let mut recipe = self.recipe.clone();
        let guides = references::resolve_names(self.registry, &mut recipe, |name| artwork.path_named(name))?;
        artwork.remove_guides(guides.clone());
        let (edits, recipe) = edits::divided(&recipe)?;
        let mut edits_before = [&self.options.edits[..], &edits].concat();
        let edit = edits_before.pop_if(|last| recipe.steps.is_empty() && !is_caption(last));
        let steps = edit.as_ref().map_or(&recipe.steps[..], std::slice::from_ref);
        artwork.edit_first(&edits_before, steps, self.options)?;
        let baseline_of = |s: &Step| baseline(self.registry, s);
        let baseline = steps.first().map_or(Baseline::None, baseline_of);
        let known = framed.map(|cache| self.framed(artwork, (guides, edits_before, baseline), cache)).transpose()?;
        let is_selective = steps.iter().any(Step::is_selective);
        let mut parts = if is_selective { artwork.divide(steps)? } else { vec![(0..steps.len()).collect()] };
        if edit.is_some() {
            parts.iter_mut().for_each(Vec::clear);
        }
        let portion = |(i, steps): (usize, Vec<usize>)| Portion { steps, outlines: artwork.outlines(Which::Part(i)) };
        let portions: Vec<Portion<'_>> = parts.into_iter().enumerate().map(portion).collect();
        let start = |i: usize| match &known {
            _ if !recipe.starts(i, &portions) => Ok(None),
            Some(frame) if !is_selective => Ok(Some(frame.clone())),
            _ => self.frame(artwork, Which::Step(i), baseline_of(&recipe.steps[i])).map(Some),
        };
        let starts: Vec<Option<Frame>> = (0..recipe.steps.len()).map(start).collect::<Result<_, Failure>>()?;
        let built = recipe.build_parts(self.registry, &starts, &portions, artwork.budget());
        let built = built.map_err(Failure::of_recipe)?;
        check_maps(&built.whole)?;
        let frame = match known.or_else(|| starts.iter().flatten().next().cloned()) {
            Some(frame) => frame,
            None => self.frame(artwork, Which::All, Baseline::None)?,
        };
        let starts = if edit.is_some() { vec![Some(frame.clone())] } else { starts };
        Ok(Ready { recipe, edit, built, frame, starts })
    }

    /// Returns the frame of the selected artwork.
    fn frame(&self, artwork: &dyn Artwork, which: Which, baseline: Baseline) -> Result<Frame, Failure> {
        let frame = artwork.frame(which, self.options.frame, artwork.bounding_box(which), baseline)?;
        let frame = frame.with_units_per_px(artwork.units_per_px());
        Ok(match artwork.page() {
            Some(page) => frame.with_page(page),
            None => frame,
        })
    }

    /// Returns the frame of all artwork: the cached one if nothing that it depends on has changed.
    fn framed(
        &self,
        artwork: &dyn Artwork,
        chosen_for: (Vec<String>, Vec<Step>, Baseline),
        cache: &mut Option<Framed>,
    ) -> Result<Frame, Failure> {
        if let Some(framed) = cache.as_ref().filter(|f| f.chosen_for == chosen_for) {
            return Ok(framed.frame.clone());
        }
        let frame = self.frame(artwork, Which::All, chosen_for.2)?;
        *cache = Some(Framed { chosen_for, frame: frame.clone() });
        Ok(frame)
    }

    /// Returns the request to warp artwork by steps that are built for it, with the tolerance for its frame.
    pub fn request<'r>(&'r self, artwork: &dyn Artwork, ready: &'r Ready) -> Result<WarpRequest<'r>, Failure> {
        let (options, painted) = (self.options, artwork.painted_box());
        let edit = ready.edit.as_ref().map(|step| planned(step, options, (painted, &ready.frame), true));
        let (edit, line, tolerance, suited) = match edit.transpose()? {
            Some(Planned { edit, line, tolerance, suited }) => (Some(edit), line, tolerance, suited),
            None => {
                let tolerance = options.tolerance_for(painted, &ready.frame)?;
                (None, CutLine::default(), tolerance, options.tolerance.is_none())
            }
        };
        let (recipe, built) = (self.recipe, &ready.built);
        let (embedded_recipe, same_view) = (None, false);
        Ok(WarpRequest { recipe, built, options, tolerance, suited, edit, line, embedded_recipe, same_view })
    }

    /// Warps artwork and writes nothing. Messages of the steps name parameters as flags.
    pub fn warp(&self, artwork: &mut dyn FileArtwork, flags: &Flags) -> Result<Warped, Failure> {
        let options = self.options;
        let ready = self.ready(artwork, None)?;
        let Ready { built, frame, starts, .. } = &ready;
        let whole = &built.whole;
        let is_visible = artwork.bounding_box(Which::All).is_some();
        let stretched = stretched(artwork, built);
        let embed = || recipe_file::write(self.registry, self.recipe, self.given, Path::new(""));
        let embedded_recipe = options.embed_recipe.then(embed).transpose()?;
        let request = WarpRequest { embedded_recipe, ..self.request(artwork, &ready)? };
        let tolerance = request.tolerance;
        let warped = ready.checked(artwork.warp(&request))?;

        let mut warnings: Vec<String> = in_flags(flags, whole, |e| &e.warnings).chain(warped.warnings).collect();
        warnings.extend(stretched);
        warnings.extend(warped.page.warnings());
        let shapes = || warped.shapes.iter().map(|s| &s.shape);
        warnings.extend(ready.edit.as_ref().and_then(|_| advice::vanished(shapes())));
        let coarse = too_coarse(options.precision, &warped.shapes);
        let is_coarse = coarse.is_some();
        warnings.extend(coarse);
        let report = FileReport {
            file: artwork.file_name(),
            output: None,
            error: None,
            tolerance: Some(warped.tolerance.unwrap_or(tolerance)),
            frame: Some(xywh(frame.rect)),
            selections: selections(&ready.recipe, whole),
            baseline: frame.baseline,
            page: warped.page.change.map(|[_, after]| xywh(after)),
            shapes: warped.shapes,
            skipped: warped.skipped,
            kerf: warped.kerf,
            proportions: warped.proportions,
            warnings,
        };
        let partial = warped.partial || is_coarse || report.is_partial();
        let mut notes = Vec::new();
        if !options.quiet {
            match ready.edit.as_ref().map(|edit| edit.deformation.as_str()) {
                Some("simplify") => notes.push(simplify_note(&report.shapes)),
                Some("contour") => notes.extend(islands_note(&report.shapes)),
                _ => {}
            }
            notes.extend(unite_note(&report.shapes));
            notes.extend(report.kerf.iter().map(KerfReport::note));
            notes.extend(report.proportions.iter().map(Proportions::note));
        }
        if options.explain {
            notes.extend(frame_notes(options.frame, ready.steps(), starts, is_visible));
            notes.extend(in_flags(flags, whole, |e| &e.notes));
            notes.extend(strokes_note(&report.shapes));
            notes.extend(gradients_note(&report.shapes));
            notes.extend(filters_note(&warped.filters));
        }
        Ok(Warped {
            result: warped.result,
            page: warped.page,
            saves: ready.built.whole.steps.into_iter().flat_map(|s| s.saves).collect(),
            files: warped.files,
            preview: warped.preview,
            report,
            notes,
            partial,
        })
    }
}

/// Reports the numbers of nodes before and after simplifying, and the largest error.
fn simplify_note(shapes: &[ReportedShape]) -> String {
    let sum = |count: fn(&ReportedShape) -> usize| shapes.iter().map(count).sum::<usize>();
    let (before, after) = (sum(|s| s.shape.path.segments_in), sum(|s| s.shape.path.segments_out));
    let error = shapes.iter().map(|s| s.shape.path.max_error).fold(0.0, f64::max);
    let is_short = (1e-3..1e4).contains(&error) || error == 0.0;
    let error = if is_short { format!("{error:.3}") } else { format!("{error:.2e}") };
    format!("{before} nodes became {after}, within {error} units of the original")
}

/// Reports the number of lines around the artwork, if there are several.
fn islands_note(shapes: &[ReportedShape]) -> Option<String> {
    let count = shapes.first()?.shape.copies;
    let advice = "which lie further apart than twice the distance; --join bridges them";
    (count > 1).then(|| format!("{count} lines around {count} islands, {advice}"))
}

/// Reports which shapes have become one.
fn unite_note(shapes: &[ReportedShape]) -> Option<String> {
    let results: Vec<&ReportedShape> = shapes.iter().filter(|s| !s.shape.united.is_empty()).collect();
    let names: Vec<&str> = results.iter().flat_map(|s| &s.shape.united).map(String::as_str).collect();
    let (before, after) = (names.len(), results.len());
    (after > 0).then(|| format!("{before} shapes became {after}: {}", listed(&names, NAMED)))
}

/// Returns the messages of all steps, with parameters as flags.
fn in_flags(
    flags: &Flags,
    built: &BuiltRecipe,
    messages: impl Fn(&Explanation) -> &Vec<String>,
) -> impl Iterator<Item = String> {
    built.steps.iter().flat_map(move |s| messages(&s.explanation)).map(|m| flags.in_text(m))
}

/// Reports the part of the artwork that each step applies to, if they differ.
fn selections(recipe: &Recipe, built: &BuiltRecipe) -> Vec<StepSelection> {
    if !recipe.steps.iter().any(Step::is_selective) {
        return Vec::new();
    }
    let of_step = |(step, frame): (&Step, &Frame)| StepSelection {
        deformation: step.deformation.clone(),
        select: step.select.clone(),
        exclude: step.exclude.clone(),
        frame: xywh(frame.rect),
    };
    recipe.steps.iter().zip(&built.frames).map(of_step).collect()
}

/// Describes the frames of the steps that no other step precedes.
fn frame_notes(choice: FrameChoice, steps: &[Step], starts: &[Option<Frame>], is_visible: bool) -> Vec<String> {
    let are_selective = steps.iter().any(Step::is_selective);
    let note = |(i, (step, frame)): (usize, (&Step, &Option<Frame>))| {
        let note = frame_note(choice, frame.as_ref()?, is_visible);
        let parts = if step.select.is_empty() { String::new() } else { format!(" for {}", step.select.join(", ")) };
        Some(if are_selective { format!("step {}, {}{parts}: {note}", i + 1, step.deformation) } else { note })
    };
    steps.iter().zip(starts).enumerate().filter_map(note).collect()
}

/// Describes the frame: its box, and why it was chosen. `is_visible` is `true` if any artwork is visible.
fn frame_note(choice: FrameChoice, frame: &Frame, is_visible: bool) -> String {
    let [x, y] = frame.units_per_px;
    let Rect { x0, y0, .. } = frame.rect;
    let (width, height) = (frame.rect.width(), frame.rect.height());
    let why = match (choice, frame.baseline) {
        (FrameChoice::Default, Some(_)) => {
            "the artwork is lettering (--frame baseline-ascent), whose baseline lies on the curve".to_owned()
        }
        (FrameChoice::Default | FrameChoice::Artwork, _) if is_visible => "the visible artwork".to_owned(),
        (FrameChoice::Default | FrameChoice::Artwork, _) => "the page, as no artwork is visible".to_owned(),
        (FrameChoice::ViewBox, _) => "the page (--frame viewbox)".to_owned(),
        (FrameChoice::Rect(_), _) => "given by --frame".to_owned(),
        (FrameChoice::Lettering(_), _) => "the lettering (--frame)".to_owned(),
    };
    let baseline = frame.baseline.map(|y| format!(", baseline at {y:.4}")).unwrap_or_default();
    format!(
        "frame: {width:.4} × {height:.4} user units at {x0:.4},{y0:.4} ({:.2} × {:.2} mm){baseline}: {why}",
        width / x * MM_PER_PX,
        height / y * MM_PER_PX,
    )
}

/// Counts the strokes that stayed strokes, with their error, and those that became outlines.
fn strokes_note(shapes: &[ReportedShape]) -> Option<String> {
    let outlined: usize = shapes.iter().map(|s| s.shape.outlined_strokes).sum();
    let scaled = || shapes.iter().filter_map(|s| Some((s.shape.stroke_error?, &s.shape.id)));
    let worst = scaled().reduce(|a, b| if b.0 > a.0 { b } else { a });
    let outlined = (outlined > 0).then(|| format!("{outlined} became outlines (--strokes scale|keep prevents that)"));
    let scaled = worst.map(|(error, id)| {
        format!("{} stayed strokes, within {error:.3} units of the exact ones (the farthest: {id})", scaled().count())
    });
    let parts: Vec<String> = [scaled, outlined].into_iter().flatten().collect();
    (!parts.is_empty()).then(|| format!("strokes: {}", parts.join("; ")))
}

impl Ready {
    /// Returns the steps that bend, or else the last edit.
    fn steps(&self) -> &[Step] {
        self.edit.as_ref().map_or(&self.recipe.steps[..], std::slice::from_ref)
    }

    /// Returns the outcome of a warp. If the map of a plug-in has failed meanwhile, that failure takes precedence over any result or other
    /// error. An error where the map is undefined is completed by the operation that is undefined there, if a step knows it.
    pub fn checked<T>(&self, outcome: Result<T, Failure>) -> Result<T, Failure> {
        check_maps(&self.built.whole)?;
        outcome.map_err(|failure| self.explained(failure))
    }

    /// Adds the undefined operation to an error where the map is undefined.
    fn explained(&self, failure: Failure) -> Failure {
        let Some((shape, at)) = failure.infinity() else { return failure };
        let reason = |part: &BuiltRecipe| {
            let mut p = at;
            part.steps.iter().find_map(|step| {
                let why = step.undefined.as_ref().and_then(|why| why(p));
                p = step.map.point(p);
                why
            })
        };
        let Some(why) = self.built.parts.iter().find_map(reason) else { return failure };
        let problem = format!("{shape} cannot be warped: at {:.4},{:.4} {why}", at.x, at.y);
        Failure::Geometry(format!("{problem}; change the formula, or leave this shape out (--on-error skip)"))
    }
}

/// Returns the failure of a plug-in or function, whose map gives meaningless numbers from then on.
pub(crate) fn check_maps(built: &BuiltRecipe) -> Result<(), Failure> {
    built.failure().map_or(Ok(()), |e| Err(Failure::of_recipe(e)))
}

/// Returns x, y, width and height of a box, for reports.
fn xywh(r: Rect) -> [f64; 4] {
    [r.x0, r.y0, r.width(), r.height()]
}

/// Warns of artwork that the page cuts off and the map stretches.
fn stretched(artwork: &dyn Artwork, built: &BuiltParts) -> Vec<String> {
    let of_part = |(i, part): (usize, &BuiltRecipe)| {
        let (which, frame) = (Which::Part(i), part.frames.first()?.rect);
        let uncut = artwork.bounding_box(which).filter(|b| *b == frame).and_then(|b| artwork.uncut_box(which, b))?;
        Some(advice::stretched(uncut, stretch_beyond(&part.map, frame, uncut)?))
    };
    built.parts.iter().enumerate().filter_map(of_part).collect()
}

/// Returns the kind of baseline that a step has.
fn baseline(registry: &Registry, step: &Step) -> Baseline {
    let Some(info) = registry.get(&step.deformation).map(|e| e.info()) else { return Baseline::None };
    match info.baseline {
        None if info.letters => Baseline::Given,
        None => Baseline::None,
        Some(param) if step.args.get(param).is_empty() => Baseline::Open,
        Some(_) => Baseline::Given,
    }
}

/// Warns if the decimals are too few for the tolerance.
fn too_coarse(precision: Option<u8>, shapes: &[ReportedShape]) -> Option<String> {
    /// Share of the tolerance from which an error counts; a little more than one, since errors are estimates.
    const EXCESS: f64 = 1.001;
    let worst = shapes.iter().map(|s| &s.shape.path).max_by(|a, b| a.share.total_cmp(&b.share))?;
    let (decimals, error, tolerance) = (precision?, worst.max_error, worst.max_error / worst.share);
    (worst.share > EXCESS).then(|| {
        format!(
            "--precision {decimals} is too coarse for the tolerance of {tolerance:.3e}: with the rounding, shapes are off by up to \
             {error:.3e}; give more decimals, or a larger --tolerance"
        )
    })
}

/// Number of samples on each side of a box.
const SAMPLES: u32 = 16;
/// Shortest distance from the frame that counts, as a share of the frame's diagonal.
const FAR: f64 = 0.02;
/// Smallest ratio that deserves a warning.
const STRETCHED: f64 = 3.0;

/// Compares how much the map stretches the artwork between the frame and the edge of `uncut` with how much it stretches the frame. Returns
/// the ratio if it is large. Skips maps of other programs, which may fail at points that no shape has.
pub(super) fn stretch_beyond(map: &dyn Map, frame: Rect, uncut: Rect) -> Option<f64> {
    if map.prefers_batches() {
        return None;
    }
    let diagonal = frame.size().to_vec2().hypot();
    let frame_stretch = image_diagonal(map, frame)? / diagonal;
    let ratio = edge_points(uncut).filter_map(|p| {
        let nearest = Point::new(p.x.clamp(frame.x0, frame.x1), p.y.clamp(frame.y0, frame.y1));
        let length = p.distance(nearest);
        (length > FAR * diagonal).then(|| map.point(p).distance(map.point(nearest)) / length / frame_stretch)
    });
    let most = ratio.filter(|r| r.is_finite()).fold(0.0, f64::max);
    (most > STRETCHED).then_some(most)
}

/// Returns the diagonal of the image of a box under a map, if it has a size.
fn image_diagonal(map: &dyn Map, rect: Rect) -> Option<f64> {
    let image = edge_points(rect).map(|p| map.point(p)).filter(|p| p.is_finite());
    let bounds = image.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b))?;
    Some(bounds.size().to_vec2().hypot()).filter(|d| *d > 0.0)
}

/// Returns points along the sides of a box.
fn edge_points(r: Rect) -> impl Iterator<Item = Point> {
    (0..SAMPLES).flat_map(move |i| {
        let t = f64::from(i) / f64::from(SAMPLES);
        let (x, y) = (r.x0 + t * r.width(), r.y0 + t * r.height());
        [
            Point::new(x, r.y0),
            Point::new(r.x1, y),
            Point::new(r.x1 - t * r.width(), r.y1),
            Point::new(r.x0, r.y1 - t * r.height()),
        ]
    })
}

/// Names the shapes whose gradients became pictures.
fn gradients_note(shapes: &[ReportedShape]) -> Option<String> {
    let pictured: Vec<&str> = shapes.iter().filter(|s| s.shape.pictures > 0).map(|s| s.shape.id.as_str()).collect();
    let names = listed(&pictured, NAMED);
    (!pictured.is_empty()).then(|| format!("gradients: pictures on {names} (--gradients fit prevents that)"))
}

/// Names the elements whose filters became pictures, and those whose filters kept their affine fits.
fn filters_note([pictured, kept]: &[Vec<String>; 2]) -> Option<String> {
    let note = |names: &Vec<String>, before: &str, after: &str| {
        (!names.is_empty()).then(|| format!("{before} {}{after}", listed(names, NAMED)))
    };
    let pictures = note(pictured, "pictures on", " (--filters affine prevents that)");
    let all: Vec<String> = pictures.into_iter().chain(note(kept, "affine fits on", "")).collect();
    (!all.is_empty()).then(|| format!("filters: {}", all.join("; ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::kurbo::Vec2;
    use pathwarp::map::Jet;

    /// (x, y) ↦ (x, y + x³/100²).
    struct Cubic;

    impl Map for Cubic {
        fn jet(&self, p: Point) -> Jet {
            let steep = 3.0 * p.x * p.x / 1e4;
            Jet { p: Point::new(p.x, p.y + p.x.powi(3) / 1e4), dx: Vec2::new(1.0, steep), dy: Vec2::new(0.0, 1.0) }
        }
    }

    #[test]
    fn only_growth_far_outside_counts() {
        let frame = Rect::new(0.0, 0.0, 100.0, 100.0);
        let beyond = |x1| stretch_beyond(&Cubic, frame, Rect { x1, ..frame });
        assert_eq!([beyond(100.0), beyond(102.0)], [None, None]);
        // From 100 to 300 the cubic rises by 2,600; the frame's diagonal grows from 141 to 224.
        let wanted = 200f64.hypot(2600.0) / 200.0 / (100f64.hypot(200.0) / 100f64.hypot(100.0));
        assert!((beyond(300.0).unwrap() - wanted).abs() < 0.1);
        let larger = pathwarp::map::AffineMap(pathwarp::kurbo::Affine::scale(7.0));
        assert_eq!(stretch_beyond(&larger, frame, Rect::new(-900.0, -900.0, 900.0, 900.0)), None);
    }
}
