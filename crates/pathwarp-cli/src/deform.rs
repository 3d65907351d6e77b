//! Running deformations over files: read, build, warp, write, report.

use crate::common::{Common, FrameChoice, GradientChoice};
use crate::failure::Failure;
use crate::output::{self, Pending};
use crate::picture::Bender;
use crate::reference::{Names, References};
use crate::report::{self, Report, Totals};
use crate::{Outcome, gimp, picture, preview, recipe_file, space, terminal};
use clap::ArgMatches;
use pathwarp::deform::Registry;
use pathwarp::fold::{self, Orientation};
use pathwarp::kurbo::Rect;
use pathwarp::outline::Outline;
use pathwarp::param::Frame;
use pathwarp::recipe::{BuiltRecipe, Recipe};
use pathwarp::refit;
use pathwarp_raster::Picture;
use pathwarp_svg::{
    Document, Gradients, Images, LetterPlaces, LetteringFrame, Origin, Overhang, ReadOptions, Selection, WarpOptions,
    Warped, compressed,
};
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};
use std::io::{IsTerminal, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// One input, warped, nothing written yet.
pub(crate) struct Job {
    pub(crate) report: report::Input,
    pub(crate) output: Vec<Pending>,
    /// What goes to standard output.
    pub(crate) to_stdout: Option<Vec<u8>>,
    pub(crate) notes: Vec<String>,
    pub(crate) partly: bool,
}

/// `pathwarp DEFORMATION …`.
pub(crate) fn run(registry: &Registry, recipe: &Recipe, matches: &ArgMatches) -> Result<Outcome, Failure> {
    let started = Instant::now();
    let common = Common::read(matches)?;
    let inputs = if common.inputs.is_empty() { vec![PathBuf::from("-")] } else { common.inputs.clone() };
    let targets = targets(&common, &inputs)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(common.jobs.unwrap_or(0))
        .build()
        .map_err(|e| Failure::usage(format!("--jobs: {e}")))?;

    let bar = progress(&common, inputs.len());
    let jobs: Result<Vec<Job>, Failure> = pool.install(|| {
        let one = |(input, target): (&PathBuf, &Option<PathBuf>)| {
            let job = warp(registry, recipe, &common, input, target.as_deref());
            bar.inc(1);
            job.map_err(|f| f.about(&display(input)))
        };
        inputs.par_iter().zip(&targets).map(one).collect()
    });
    bar.finish_and_clear();
    let jobs = jobs?;

    let mut outcome = Outcome::Done;
    let mut pending = Vec::new();
    let mut reports = Vec::new();
    let mut printed = Vec::new();
    for job in jobs {
        for n in &job.notes {
            terminal::note(n);
        }
        if !common.quiet {
            tell(&job.report);
        }
        if job.partly {
            outcome = Outcome::Partly;
        }
        pending.extend(job.output);
        printed.extend(job.to_stdout);
        reports.push(job.report);
    }
    if let Some(file) = &common.report {
        let report = Report {
            tool: "pathwarp",
            version: env!("CARGO_PKG_VERSION"),
            steps: recipe.steps.iter().map(|s| s.deformation.clone()).collect(),
            totals: Totals::of(&reports, started.elapsed().as_secs_f64()),
            inputs: reports,
        };
        let mut json = serde_json::to_vec_pretty(&report).map_err(|e| Failure::file(file, e))?;
        json.push(b'\n');
        pending.push(Pending::new(file, &json)?);
    }
    if let Some(file) = &common.write_recipe {
        let text = saved(registry, recipe, &common, file.parent().unwrap_or(Path::new("")))?;
        pending.push(Pending::new(file, text.as_bytes())?);
    }
    Pending::commit_all(pending)?;
    for bytes in printed {
        output::to_stdout(&bytes)?;
    }
    Ok(outcome)
}

/// The recipe file for this run.
fn saved(registry: &Registry, recipe: &Recipe, common: &Common, folder: &Path) -> Result<String, Failure> {
    recipe_file::write(registry, recipe, &common.given, folder).map_err(Failure::Input)
}

/// Where each input's result goes; `None` is standard output.
fn targets(common: &Common, inputs: &[PathBuf]) -> Result<Vec<Option<PathBuf>>, Failure> {
    let Some(dir) = &common.out_dir else { return Ok(vec![common.out.clone(); inputs.len()]) };
    let mut out: Vec<Option<PathBuf>> = Vec::with_capacity(inputs.len());
    for i in inputs {
        let name = i.file_name().filter(|n| *n != "-");
        let mut to = dir.join(name.ok_or_else(|| Failure::usage("--out-dir needs named inputs"))?);
        if let Some(name) = gimp::svg_name(i) {
            to.set_file_name(name);
        }
        if out.contains(&Some(to.clone())) {
            return Err(Failure::usage(format!("two inputs would both be written to {}", to.display())));
        }
        out.push(Some(to));
    }
    std::fs::create_dir_all(dir).map_err(|e| Failure::file(dir, format!("cannot be made: {e}")))?;
    Ok(out)
}

fn progress(common: &Common, files: usize) -> indicatif::ProgressBar {
    if common.quiet || files < 2 || !std::io::stderr().is_terminal() {
        return indicatif::ProgressBar::hidden();
    }
    let bar = indicatif::ProgressBar::new(files as u64);
    if let Ok(style) = indicatif::ProgressStyle::with_template("{bar:32} {pos}/{len} files  {eta} left") {
        bar.set_style(style);
    }
    bar
}

pub(crate) fn display(input: &Path) -> String {
    if input.as_os_str() == "-" { "standard input".into() } else { input.display().to_string() }
}

/// Reads a file, or standard input.
pub(crate) fn read(input: &Path) -> Result<Vec<u8>, Failure> {
    if input.as_os_str() == "-" {
        let mut bytes = Vec::new();
        std::io::stdin().lock().read_to_end(&mut bytes).map_err(|e| Failure::Input(format!("standard input: {e}")))?;
        if gimp::is_xcf(&bytes) {
            return Err(Failure::Input(
                "standard input: an XCF is read by seeking in it; name the file instead".into(),
            ));
        }
        return Ok(bytes);
    }
    std::fs::read(input).map_err(|e| Failure::file(input, format!("cannot be read: {e}")))
}

/// Reads an SVG document; linked images are looked for beside it.
pub(crate) fn document(input: &Path) -> Result<Document, Failure> {
    let bytes = read(input)?;
    Ok(Document::read(&bytes, &display(input), &read_options(input))?)
}

pub(crate) fn read_options(input: &Path) -> ReadOptions {
    let folder = match input.parent() {
        Some(p) if p.as_os_str().is_empty() => Some(PathBuf::from(".")),
        other => other.map(Path::to_path_buf),
    };
    ReadOptions { base_dir: folder, ..ReadOptions::default() }
}

fn warp(
    registry: &Registry,
    recipe: &Recipe,
    common: &Common,
    input: &Path,
    target: Option<&Path>,
) -> Result<Job, Failure> {
    if let Some(file) = gimp::Input::open(input, common.salvage)? {
        return gimp::warp(registry, recipe, common, &file, target);
    }
    if common.into.is_some() {
        return Err(Failure::usage(format!("--into puts paths back into an XCF; {} is none", display(input))));
    }
    let bytes = read(input)?;
    if Picture::is_one(&bytes) {
        return picture::warp(registry, recipe, common, input, target, &bytes);
    }
    if let Some(t) = target.filter(|t| gimp::is_form_of_gimps(t)) {
        let what = "point lists and XCF are written of GIMP's files; `pathwarp convert` makes them of an SVG";
        return Err(Failure::usage(format!("{}: {what}", t.display())));
    }
    if let Some(t) = target.filter(|t| picture::is_named_as_one(t)) {
        let what = "a drawing is written as SVG; --preview and `pathwarp render` make pictures of it";
        return Err(Failure::usage(format!("{}: {what}", t.display())));
    }
    let doc = Document::read(&bytes, &display(input), &read_options(input))?;
    let mut references = References::new(Some(Names::Svg(&doc)));
    let mut recipe = recipe.clone();
    references.resolve(registry, &mut recipe)?;
    let selection =
        Selection { select: common.select.clone(), exclude: common.exclude.clone(), guides: references.guides };
    let artwork_box = doc.artwork_box(&selection);
    let frame = frame(&doc, &selection, common.frame, artwork_box, wants_baseline(registry, &recipe))?;
    let artwork: Vec<&Outline> = doc.selected(&selection).map(|s| &s.outline).collect();
    let baseline = frame.baseline;
    let built = recipe.build(registry, frame, &artwork.iter().copied()).map_err(Failure::of_recipe)?;

    let tolerance = common.tolerance_for(artwork_box);
    let bender = Arc::new(Bender::new(Arc::new(built.map.clone()), common.image_dpi));
    let options = WarpOptions {
        precision: common.precision,
        strokes: common.strokes,
        text: common.text,
        structure: common.structure,
        selection,
        on_error: common.on_error,
        gradients: match common.gradients {
            GradientChoice::Fit => Gradients::Fit,
            GradientChoice::Exact => Gradients::Exact(bender.clone()),
            GradientChoice::Keep => Gradients::Keep,
        },
        patterns: common.patterns,
        page: common.page,
        copies: built.placement.copies.clone(),
        letters: LetterPlaces { places: built.placement.letters.clone(), after: built.after.clone() },
        images: if common.images { Images::Warp(bender) } else { Images::Keep },
        ..WarpOptions::new(refit::Options {
            certify: common.certify,
            merge: common.merge,
            ..refit::Options::new(tolerance)
        })
    };
    let mut warped = doc.warp(&built.map, &options)?;
    if common.embed_recipe {
        let text = saved(registry, &recipe, common, Path::new(""))?;
        warped.svg = Origin { recipe: text, source: doc.source().to_vec() }.embed(&warped.svg)?;
    }
    let report = report(&doc, &built, &options, &warped, &display(input), target);

    let mut output = Vec::new();
    if let Some(t) = target {
        let packed = t.extension().is_some_and(|e| e.eq_ignore_ascii_case("svgz"));
        let packed =
            packed.then(|| compressed(&warped.svg)).transpose().map_err(|e| Failure::file(t, e.to_string()))?;
        output.push(Pending::new(t, packed.as_deref().unwrap_or(warped.svg.as_bytes()))?);
    }
    for (file, text) in space::files(&doc, &built, &options)? {
        output.push(Pending::new(&file, text.as_bytes())?);
    }
    for file in built.steps.iter().flat_map(|s| &s.saves) {
        output.push(Pending::new(Path::new(&file.name), file.text.as_bytes())?);
    }
    if let Some(file) = &common.preview {
        output.push(Pending::new(file, &preview::draw(&doc, &warped.svg, &built, &read_options(input))?)?);
    }
    let mut notes = Vec::new();
    if common.explain {
        if let (FrameChoice::Default, Some(y)) = (common.frame, baseline) {
            notes.push(format!(
                "frame: the artwork is lettering; its baseline, at {y:.6}, lies on the curve (--frame baseline-ascent)"
            ));
        }
        notes.extend(built.steps.iter().flat_map(|s| s.explanation.notes.clone()));
    }
    let partly = !report.skipped.is_empty() || report.shapes.iter().any(|s| !s.over_budget.is_empty());
    let to_stdout = target.is_none().then(|| warped.svg.into_bytes());
    Ok(Job { report, output, to_stdout, notes, partly })
}

/// Returns `true` if the recipe's first step has a baseline that was left at its default.
fn wants_baseline(registry: &Registry, recipe: &Recipe) -> bool {
    let Some(step) = recipe.steps.first() else { return false };
    let baseline = registry.get(&step.deformation).and_then(|e| e.info().baseline);
    baseline.is_some_and(|param| step.args.get(param).is_empty())
}

/// The frame that was chosen, with the letters in it.
fn frame(
    doc: &Document,
    selection: &Selection,
    choice: FrameChoice,
    artwork_box: Option<Rect>,
    on_baseline: bool,
) -> Result<Frame, Failure> {
    let lettering = doc.lettering(selection);
    let artwork = || Frame::new(artwork_box.unwrap_or_else(|| doc.view_box()));
    let frame = match choice {
        FrameChoice::Default if on_baseline && lettering.is_all() && lettering.is_level() => {
            lettering.frame(LetteringFrame::BaselineAscent).unwrap_or_else(|_| artwork())
        }
        FrameChoice::Default | FrameChoice::Artwork => artwork(),
        FrameChoice::ViewBox => Frame::new(doc.view_box()),
        FrameChoice::Rect(r) => Frame::new(r),
        FrameChoice::Lettering(kind) => lettering.frame(kind)?,
    };
    Ok(if lettering.is_level() { frame.with_letters(lettering.letters().into()) } else { frame })
}

fn report(
    doc: &Document,
    built: &BuiltRecipe,
    options: &WarpOptions,
    warped: &Warped,
    file: &str,
    target: Option<&Path>,
) -> report::Input {
    let folds = folds(doc, built, options);
    let mut warnings: Vec<String> = built.steps.iter().flat_map(|s| s.explanation.warnings.clone()).collect();
    warnings.extend(warped.warnings.iter().cloned());
    warnings.extend(warped.overhang.map(beyond_the_page));
    // Parts of one text or `use` share an id, and are one shape in the report.
    let mut by_id: HashMap<&str, Orientation> = HashMap::new();
    let mut all = Orientation::default();
    for (id, o) in &folds {
        all = all.and(o);
        let sum = by_id.entry(id).or_default();
        *sum = sum.and(o);
    }
    let mut told = HashSet::new();
    let mut shapes = Vec::with_capacity(warped.shapes.len());
    for s in &warped.shapes {
        let o = by_id.get(s.id.as_str()).copied().unwrap_or_default();
        let at = o.folded_against(&all);
        if let Some(at) = at
            && told.insert(&s.id)
        {
            let id = &s.id;
            warnings.push(format!("{id} folds over near {:.4},{:.4}: the map turns the plane over there", at.x, at.y));
        }
        shapes.push(report::Shape {
            id: s.id.clone(),
            copies: s.copies,
            segments_in: s.segments_in,
            segments_out: s.segments_out,
            max_error: s.max_error,
            certified: s.assurance != refit::Assurance::Checked,
            assurance: report::assurance_word(s.assurance),
            folds: if at.is_some() { o.changes.max(1) } else { 0 },
            folded_at: at.map(|p| [p.x, p.y]),
            over_budget: s.over_budget.iter().map(|p| [p.x, p.y]).collect(),
            paint_residual: s.paint_residual,
            pictures: s.pictures,
        });
    }
    report::Input {
        file: file.to_owned(),
        output: target.map(|t| t.display().to_string()),
        tolerance: options.refit.tolerance,
        shapes,
        skipped: warped.skipped.iter().map(|s| report::Skipped { id: s.id.clone(), why: s.why.clone() }).collect(),
        warnings,
    }
}

/// Artwork beyond the page is not seen.
fn beyond_the_page(o: Overhang) -> String {
    let names = ["left", "top", "right", "bottom"];
    let sides: Vec<&str> = names.iter().zip(o.by).filter(|(_, by)| *by > 0.0).map(|(name, _)| *name).collect();
    let most = o.by.into_iter().fold(0.0, f64::max);
    format!(
        "the artwork leaves the page by up to {} units ({} %; {}); --fit grow makes room for it, --fit page fits the page to it",
        three_figures(most),
        three_figures(100.0 * o.share),
        sides.join(", ")
    )
}

/// A positive number with the three figures that tell how much it is.
fn three_figures(v: f64) -> String {
    /// Nobody's page is so small.
    const MOST_DECIMALS: f64 = 12.0;
    let decimals = (2.0 - v.log10().floor()).clamp(0.0, MOST_DECIMALS) as usize;
    let text = format!("{v:.decimals$}");
    if decimals == 0 { text } else { text.trim_end_matches('0').trim_end_matches('.').to_owned() }
}

/// Every selected shape's orientation under the map.
fn folds<'a>(doc: &'a Document, built: &BuiltRecipe, options: &WarpOptions) -> Vec<(&'a str, Orientation)> {
    let shapes: Vec<_> = doc.selected(&options.selection).collect();
    // Letters that are placed one by one fold only where a later step folds them.
    let placed = doc.placed(options);
    let one = |(s, placed): (&'a pathwarp_svg::Shape, &Option<Outline>)| {
        let orientation = match placed {
            Some(outline) => fold::orientation(outline, s.filled, &built.after),
            None => fold::orientation(&s.outline.repeated(&built.placement.copies), s.filled, &built.map),
        };
        (s.id.as_str(), orientation)
    };
    shapes.into_par_iter().zip(&placed).map(one).collect()
}

/// Warnings and leavings, for people.
fn tell(r: &report::Input) {
    /// More than this is for the report.
    const SHOWN: usize = 8;
    let of = |what: &str| format!("{}: {what}", r.file);
    for w in r.warnings.iter().take(SHOWN) {
        terminal::warning(&of(w));
    }
    for s in r.skipped.iter().take(SHOWN) {
        terminal::warning(&of(&format!("{} is not warped: {}", s.id, s.why)));
    }
    for s in r.shapes.iter().filter(|s| !s.over_budget.is_empty()).take(SHOWN) {
        let [x, y] = s.over_budget[0];
        terminal::warning(&of(&format!(
            "{} misses the tolerance near {x:.4},{y:.4}: the error there is up to {:.3e}",
            s.id, s.max_error
        )));
    }
    let more = r.warnings.len().saturating_sub(SHOWN) + r.skipped.len().saturating_sub(SHOWN);
    if more > 0 {
        terminal::warning(&of(&format!("and {more} more; --report FILE lists them all")));
    }
}
