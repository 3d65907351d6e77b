//! The run of one input: open, look up references, choose the frame, build, warp, report.

use super::links;
use super::plan::Job;
use crate::advice::{self, Flags};
use crate::edits::SIMPLIFY;
use crate::failure::Failure;
use crate::input::{Artwork, Baseline, Input, WarpRequest, WarpedResult, Which, display};
use crate::options::{CommonOptions, FrameChoice, Given};
use crate::output::PendingFile;
use crate::page::PageNews;
use crate::report::{FileReport, ReportedShape, StepSelection};
use crate::units::MM_PER_PX;
use crate::{recipe_file, references};
use pathwarp::deform::{Explanation, Registry, SavedFile};
use pathwarp::kurbo::{Point, Rect};
use pathwarp::map::Map;
use pathwarp::param::Frame;
use pathwarp::recipe::{BuiltParts, BuiltRecipe, Portion, Recipe, Step};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The work that all inputs share.
pub(super) struct Batch<'a> {
    pub(super) registry: &'a Registry,
    pub(super) recipe: &'a Recipe,
    pub(super) options: &'a CommonOptions,
    pub(super) given: &'a Given,
    pub(super) flags: Flags,
}

/// One input, warped. Nothing is written yet, not even to temporary files, except for `files`.
pub(super) struct WarpedInput {
    pub(super) result: WarpedResult,
    pub(super) report: FileReport,
    page: PageNews,
    pub(super) notes: Vec<String>,
    partial: bool,
    /// Files that deformations save.
    saves: Vec<SavedFile>,
    /// Files besides the result.
    files: Vec<PendingFile>,
    preview: Option<Vec<u8>>,
}

/// One input, warped. No file is in place yet.
pub(super) struct FileRun {
    pub(super) report: FileReport,
    pub(super) files: Vec<PendingFile>,
    /// What became of the page; the last warnings say so.
    pub(super) page: PageNews,
    /// The lines of `--explain`.
    pub(super) notes: Vec<String>,
    pub(super) partial: bool,
}

impl Batch<'_> {
    /// Warps one input; without a target the result goes to standard output.
    pub(super) fn run(&self, job: &Job) -> Result<FileRun, Failure> {
        let target = job.target.as_deref();
        let mut input = Input::open(&job.input, self.options, target)?;
        let WarpedInput { result, mut report, page, notes, partial, saves, preview, files: others } =
            self.warp(&mut input)?;
        report.output = target.or(self.options.into.as_deref()).map(|t| t.display().to_string());
        let mut files = Vec::new();
        match (result, target) {
            (WarpedResult::File(file), _) => files.push(file),
            (WarpedResult::Bytes(bytes), Some(t)) => {
                files.push(PendingFile::new(t, &links::moved(&bytes, &job.input, t))?);
            }
            (WarpedResult::Bytes(bytes), None) => files.push(PendingFile::stdout(bytes)),
        }
        files.extend(others);
        for file in saves {
            files.push(PendingFile::new(Path::new(&file.name), file.text.as_bytes())?);
        }
        if let (Some(file), Some(png)) = (&job.preview, preview) {
            files.push(PendingFile::new(file, &png)?);
        }
        Ok(FileRun { report, files, page, notes, partial })
    }

    /// Warps one input and writes nothing. The report names no output.
    pub(super) fn warp(&self, input: &mut Input) -> Result<WarpedInput, Failure> {
        let Batch { registry, options, .. } = self;
        let artwork = input.artwork();
        let mut recipe = self.recipe.clone();
        let guides = references::resolve_names(registry, &mut recipe, |name| artwork.path_named(name))?;
        artwork.remove_guides(guides);

        let parts = divided(artwork, &recipe)?;
        let bounds = artwork.bounding_box(Which::All);
        let starts = starts(registry, &recipe, artwork, &parts, options.frame, None)?;
        let first = starts.iter().flatten().next().cloned().unwrap_or_else(|| Frame::new(Rect::ZERO));
        let tolerance = options.tolerance_for(artwork.painted_box(), &first)?;
        let built = build(registry, &recipe, artwork, &parts, &starts)?;
        let whole = &built.whole;
        // The map of a plug-in may fail at any time. Nothing that was computed with it is used, not even another error.
        let sound = || whole.failure().map_or(Ok(()), |e| Err(Failure::of_recipe(e)));
        sound()?;

        let stretch = |(k, part): (usize, &BuiltRecipe)| {
            let (which, frame) = (Which::Part(k), part.frames.first()?.rect);
            let uncut =
                artwork.bounding_box(which).filter(|b| *b == frame).and_then(|b| artwork.uncut_box(which, b))?;
            Some((uncut, stretch_beyond(&part.map, frame, uncut)?))
        };
        let stretched: Vec<_> = built.parts.iter().enumerate().filter_map(stretch).collect();

        let embed = || recipe_file::write(*registry, &recipe, self.given, Path::new(""));
        let embedded_recipe = options.embed_recipe.then(embed).transpose()?;
        let request = WarpRequest {
            recipe: self.recipe,
            built: &built,
            options,
            tolerance,
            suited: options.tolerance.is_none(),
            edit: options.edit.as_ref().map(|e| e.read(&first)).transpose()?,
            embedded_recipe,
            same_view: false,
        };
        let warped = artwork.warp(&request);
        sound()?;
        let warped = warped.map_err(|f| explained(f, &built))?;

        let mut warnings: Vec<String> = self.in_flags(whole, |e| &e.warnings).chain(warped.warnings).collect();
        warnings.extend(stretched.into_iter().map(|(uncut, stretch)| advice::stretched(uncut, stretch)));
        warnings.extend(warped.page.warnings());
        let coarse = too_coarse(options.precision, &warped.shapes);
        let is_coarse = coarse.is_some();
        warnings.extend(self.vanished(&warped.shapes));
        warnings.extend(coarse);
        let frame = first.rect;
        let report = FileReport {
            file: artwork.file_name(),
            output: None,
            error: None,
            tolerance: Some(tolerance),
            frame: Some([frame.x0, frame.y0, frame.width(), frame.height()]),
            selections: selections(&recipe, whole),
            baseline: first.baseline,
            page: warped.page.change.map(|[_, r]| [r.x0, r.y0, r.width(), r.height()]),
            shapes: warped.shapes,
            skipped: warped.skipped,
            warnings,
        };
        let partial = warped.partial || is_coarse || report.is_partial();
        let notes = self.notes(whole, &frames(options.frame, &recipe, &starts, bounds.is_some()), &report.shapes);
        Ok(WarpedInput {
            result: warped.result,
            page: warped.page,
            saves: built.whole.steps.into_iter().flat_map(|s| s.saves).collect(),
            files: warped.files,
            preview: warped.preview,
            report,
            notes,
            partial,
        })
    }

    /// The decisions made on the user's behalf.
    fn notes(&self, built: &BuiltRecipe, framed: &[String], shapes: &[ReportedShape]) -> Vec<String> {
        let mut notes: Vec<String> = self.simplified(shapes).into_iter().collect();
        if !self.options.explain {
            return notes;
        }
        notes.extend_from_slice(framed);
        notes.extend(self.in_flags(built, |e| &e.notes));
        notes.extend(strokes(shapes));
        notes
    }

    /// The numbers of nodes before and after, and the largest error, if that is what the run is for.
    fn simplified(&self, shapes: &[ReportedShape]) -> Option<String> {
        let asked = self.options.edit.as_ref().is_some_and(|e| e.info == &SIMPLIFY) && !self.options.quiet;
        let sum = |of: fn(&ReportedShape) -> usize| shapes.iter().map(of).sum::<usize>();
        let (before, after) = (sum(|s| s.segments_in), sum(|s| s.segments_out));
        let error = shapes.iter().map(|s| s.max_error).fold(0.0, f64::max);
        let error =
            if (1e-3..1e4).contains(&error) || error == 0.0 { format!("{error:.3}") } else { format!("{error:.2e}") };
        asked.then(|| format!("{before} nodes became {after}, within {error} units of the original"))
    }

    /// The warning about shapes of which nothing is left.
    fn vanished(&self, shapes: &[ReportedShape]) -> Option<String> {
        const NAMED: usize = 5;
        self.options.edit.as_ref()?;
        let gone: Vec<&str> =
            shapes.iter().filter(|s| s.segments_in > 0 && s.segments_out == 0).map(|s| s.id.as_str()).collect();
        let more = if gone.len() > NAMED { format!(" and {} more", gone.len() - NAMED) } else { String::new() };
        let named = gone[..gone.len().min(NAMED)].join(", ");
        (!gone.is_empty()).then(|| format!("nothing is left of {named}{more}: narrower than the distance"))
    }

    /// Messages of all steps, with parameters as flags.
    fn in_flags(
        &self,
        built: &BuiltRecipe,
        messages: impl Fn(&Explanation) -> &Vec<String>,
    ) -> impl Iterator<Item = String> {
        built.steps.iter().flat_map(move |s| messages(&s.explanation)).map(|m| self.flags.in_text(m))
    }
}

/// The steps of every part of the artwork.
pub(crate) fn divided(artwork: &mut dyn Artwork, recipe: &Recipe) -> Result<Vec<Vec<usize>>, Failure> {
    if recipe.steps.iter().any(Step::is_selective) {
        return artwork.divide(&recipe.steps);
    }
    Ok(vec![(0..recipe.steps.len()).collect()])
}

/// The frames of the steps whose artwork no other step has moved before. `known` is that of all artwork.
pub(crate) fn starts(
    registry: &Registry,
    recipe: &Recipe,
    artwork: &dyn Artwork,
    parts: &[Vec<usize>],
    choice: FrameChoice,
    known: Option<&Frame>,
) -> Result<Vec<Option<Frame>>, Failure> {
    let portions: Vec<Portion<'_>> =
        parts.iter().map(|steps| Portion { steps: steps.clone(), outlines: Vec::new() }).collect();
    let frame = |i: usize| -> Result<Option<Frame>, Failure> {
        let which = Which::Step(i);
        match known {
            _ if !recipe.starts(i, &portions) => Ok(None),
            Some(known) => Ok(Some(known.clone())),
            None => {
                let baseline = baseline(registry, &recipe.steps[i]);
                let frame = artwork.frame(which, choice, artwork.bounding_box(which), baseline)?;
                Ok(Some(frame.with_units_per_px(artwork.units_per_px())))
            }
        }
    };
    (0..recipe.steps.len()).map(frame).collect()
}

/// Builds the steps of every part of the artwork.
pub(crate) fn build(
    registry: &Registry,
    recipe: &Recipe,
    artwork: &dyn Artwork,
    parts: &[Vec<usize>],
    starts: &[Option<Frame>],
) -> Result<BuiltParts, Failure> {
    let portion =
        |(k, steps): (usize, &Vec<usize>)| Portion { steps: steps.clone(), outlines: artwork.outlines(Which::Part(k)) };
    let portions: Vec<Portion<'_>> = parts.iter().enumerate().map(portion).collect();
    recipe.build_parts(registry, starts, &portions, artwork.budget()).map_err(Failure::of_recipe)
}

/// What the steps hold for, for the report.
fn selections(recipe: &Recipe, built: &BuiltRecipe) -> Vec<StepSelection> {
    if !recipe.steps.iter().any(Step::is_selective) {
        return Vec::new();
    }
    let of_step = |(step, frame): (&Step, &Frame)| StepSelection {
        deformation: step.deformation.clone(),
        select: step.select.clone(),
        exclude: step.exclude.clone(),
        frame: [frame.rect.x0, frame.rect.y0, frame.rect.width(), frame.rect.height()],
    };
    recipe.steps.iter().zip(&built.frames).map(of_step).collect()
}

/// The notes about the frames of the steps that start.
fn frames(choice: FrameChoice, recipe: &Recipe, starts: &[Option<Frame>], seen: bool) -> Vec<String> {
    let several = recipe.steps.iter().any(Step::is_selective);
    let note = |(i, (step, frame)): (usize, (&Step, &Option<Frame>))| {
        let note = frame_note(choice, frame.as_ref()?, seen);
        let of = if step.select.is_empty() { String::new() } else { format!(" for {}", step.select.join(", ")) };
        Some(if several { format!("step {}, {}{of}: {note}", i + 1, step.deformation) } else { note })
    };
    recipe.steps.iter().zip(starts).enumerate().filter_map(note).collect()
}

/// The frame: the box, and the reason for it. `seen` is `true` if any artwork is visible.
fn frame_note(choice: FrameChoice, frame: &Frame, seen: bool) -> String {
    let [x, y] = frame.units_per_px;
    let Rect { x0, y0, .. } = frame.rect;
    let (width, height) = (frame.rect.width(), frame.rect.height());
    let why = match (choice, frame.baseline) {
        (FrameChoice::Default, Some(_)) => {
            "the artwork is lettering (--frame baseline-ascent), whose baseline lies on the curve".to_owned()
        }
        (FrameChoice::Default | FrameChoice::Artwork, _) if seen => "the visible artwork".to_owned(),
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
fn strokes(shapes: &[ReportedShape]) -> Option<String> {
    let outlined: usize = shapes.iter().map(|s| s.outlined_strokes).sum();
    let scaled = || shapes.iter().filter_map(|s| Some((s.stroke_error?, &s.id)));
    let worst = scaled().reduce(|a, b| if b.0 > a.0 { b } else { a });
    let outlined = (outlined > 0).then(|| format!("{outlined} became outlines (--strokes scale|keep prevents that)"));
    let scaled = worst.map(|(error, id)| {
        format!("{} stayed strokes, within {error:.3} units of the exact ones (the farthest: {id})", scaled().count())
    });
    let parts: Vec<String> = [scaled, outlined].into_iter().flatten().collect();
    (!parts.is_empty()).then(|| format!("strokes: {}", parts.join("; ")))
}

/// Adds to an error where the map is undefined which operation is, if a step can say so.
pub(crate) fn explained(failure: Failure, built: &BuiltParts) -> Failure {
    let Some((shape, at)) = failure.infinity() else { return failure };
    let reason = |part: &BuiltRecipe| {
        let mut p = at;
        part.steps.iter().find_map(|step| {
            let why = step.undefined.as_ref().and_then(|why| why(p));
            p = step.map.point(p);
            why
        })
    };
    match built.parts.iter().find_map(reason) {
        Some(why) => {
            let place = format!("{shape} cannot be warped: at {:.4},{:.4} {why}", at.x, at.y);
            Failure::Geometry(format!("{place}; change the formula, or leave this shape out (--on-error skip)"))
        }
        None => failure,
    }
}

/// The baseline of a step.
pub(crate) fn baseline(registry: &Registry, step: &Step) -> Baseline {
    let Some(info) = registry.get(&step.deformation).map(|e| e.info()) else { return Baseline::None };
    match info.baseline {
        None if info.letters => Baseline::Given,
        None => Baseline::None,
        Some(param) if step.args.get(param).is_empty() => Baseline::Open,
        Some(_) => Baseline::Given,
    }
}

/// Warns of decimals that are too few for the tolerance.
fn too_coarse(precision: Option<u8>, shapes: &[ReportedShape]) -> Option<String> {
    let worst = shapes.iter().max_by(|a, b| a.share.total_cmp(&b.share))?;
    let (n, off, tolerance) = (precision?, worst.max_error, worst.max_error / worst.share);
    (worst.share > 1.001).then(|| {
        format!(
            "--precision {n} is too coarse for the tolerance of {tolerance:.3e}: with the rounding, shapes are off by up to {off:.3e}; \
             give more decimals, or a larger --tolerance"
        )
    })
}

/// The outcome of a warp in memory.
pub(crate) struct InMemory {
    pub(crate) bytes: Vec<u8>,
    pub(crate) report: FileReport,
    /// The lines of `--explain`.
    pub(crate) notes: Vec<String>,
}

/// Warps the content of a file called `name` by a recipe whose file references have been looked up. Linked pictures are looked up
/// beside `name`, which is empty if there is no such place. The switch `stop` ends the work.
pub(crate) fn warp_bytes(
    registry: &Registry,
    recipe: &Recipe,
    given: &Given,
    stop: Option<&'static AtomicBool>,
    name: &Path,
    bytes: &[u8],
) -> Result<InMemory, Failure> {
    let mut options = given.keeping_pages().read()?;
    options.reading.stop(stop);
    let batch = Batch { registry, recipe, options: &options, given, flags: Flags::of(registry) };
    let warped = Input::of_bytes(bytes, name, &options, None).and_then(|mut input| batch.warp(&mut input));
    let warped = warped.map_err(|f| f.about(&display(name)))?;
    match warped.result {
        WarpedResult::Bytes(bytes) => Ok(InMemory { bytes, report: warped.report, notes: warped.notes }),
        // Only an XCF is written to a file, and it is not read from memory.
        WarpedResult::File(_) => Err(Failure::usage("the result is a file")),
    }
}

/// Samples of a side of a box.
const SAMPLES: u32 = 16;
/// Shortest length beyond the frame that counts, relative to the frame's diagonal.
const FAR: f64 = 0.02;
/// Smallest ratio that is worth a warning.
const STRETCHED: f64 = 3.0;

/// Compares how much the map stretches the artwork between the frame and the edge of `uncut` with how much it stretches the frame. Returns
/// the ratio if it is large. Does not ask maps that are other programs: they may fail at points that no shape has.
pub(super) fn stretch_beyond(map: &dyn Map, frame: Rect, uncut: Rect) -> Option<f64> {
    if map.prefers_batches() {
        return None;
    }
    let size = frame.size().to_vec2().hypot();
    let of_frame = image_size(map, frame)? / size;
    let stretch = edge(uncut).filter_map(|p| {
        let inside = Point::new(p.x.clamp(frame.x0, frame.x1), p.y.clamp(frame.y0, frame.y1));
        let length = p.distance(inside);
        (length > FAR * size).then(|| map.point(p).distance(map.point(inside)) / length / of_frame)
    });
    let most = stretch.filter(|s| s.is_finite()).fold(0.0, f64::max);
    (most > STRETCHED).then_some(most)
}

/// The diagonal of the image of a box.
fn image_size(map: &dyn Map, rect: Rect) -> Option<f64> {
    let image = edge(rect).map(|p| map.point(p)).filter(|p| p.is_finite());
    let bounds = image.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b))?;
    Some(bounds.size().to_vec2().hypot()).filter(|d| *d > 0.0)
}

/// Points around a box.
fn edge(r: Rect) -> impl Iterator<Item = Point> {
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
