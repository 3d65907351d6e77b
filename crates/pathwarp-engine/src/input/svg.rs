//! SVG drawings as artwork.

use super::artwork::{self, Artwork, Baseline, FileArtwork, WarpRequest, WarpedArtwork, WarpedResult, Which};
use super::before::{Edited, Edits, Original};
use super::beside;
use super::files::{display, not_a_drawing, read_options};
use super::gimp::GimpPaths;
use crate::bitmap::Bender;
use crate::caption::is_caption;
use crate::export::{self, KerfReport};
use crate::failure::Failure;
use crate::format::{Choice, DRAWINGS, Format};
use crate::links::Destination;
use crate::options::{CommonOptions, FrameChoice, OnFailure};
use crate::output::PendingFile;
use crate::page::{self, PageNews};
use crate::report::{Fold, ReportedShape};
use crate::units::units_per_px;
use crate::{advice, meter};
use pathwarp::budget::{Budget, Limit};
use pathwarp::edit::Area;
use pathwarp::fold::{self, Orientation, Survey};
use pathwarp::kurbo::{Affine, Rect, Size};
use pathwarp::map::{AffineMap, Map};
use pathwarp::param::Frame;
use pathwarp::recipe::{BuiltRecipe, Step};
use pathwarp::refit::Nodes;
use pathwarp::{Error, Outline, refit};
use pathwarp_raster::Picture;
use pathwarp_svg::engine::{LetterPlaces, LetteringFrame};
use pathwarp_svg::{
    Document, Edit, Filters, Gradients, Images, Origin, PageFit, Painter, ReadOptions, Selection, ShapeReport, Strokes,
    Structure, Warning, WarpOptions, WarpedDocument,
};
use rayon::prelude::*;
use std::cell::LazyCell;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// Fewest segments for which threads find folds faster.
const WORTH_THREADS: usize = 5000;

/// Relative difference of pages below which they have the same scale.
const SAME_SCALE: f64 = 1e-3;

/// Resolution of bitmaps in a draft, in pixels per inch.
const DRAFT_DPI: f64 = 24.0;

/// Tolerance of the edge of the part that a view in space hides behind other parts, as a share of the result's tolerance.
const HIDDEN: f64 = 0.2;

/// An SVG drawing. Its plane is root user space.
pub struct SvgArtwork {
    name: String,
    doc: Document,
    read: ReadOptions,
    selection: Selection,
    /// The selections of the steps, and of the parts to which the same steps apply; empty if all steps apply to everything.
    steps: Vec<Selection>,
    parts: Vec<Selection>,
    /// The format of the result, and where it goes.
    format: Format,
    pub(super) destination: Destination,
    /// The drawing as it was read, if `doc` has been edited.
    original: Option<Original>,
    /// The GIMP paths that the drawing was made from; such a drawing has neither page nor strokes.
    paths: Option<GimpPaths>,
}

impl SvgArtwork {
    /// Reads a drawing; `input` is its name, and `target` is the result's, whose extension determines the format.
    pub fn read(bytes: &[u8], input: &Path, options: &CommonOptions, target: Option<&Path>) -> Result<Self, Failure> {
        let format = format(options, input, target).map_err(|e| not_a_drawing(bytes, input, e))?;
        let (name, read) = (display(input), read_options(input, &options.reading));
        let of_pictures = [
            (options.crop, "crop", "--fit page fits the page of a drawing"),
            (options.ratio.is_some(), "ratio", "--page-width and --page-height give the page of a drawing its size"),
            (options.image_size.is_some(), "size", "--page-width gives the page of a drawing its size"),
        ];
        if let Some((_, option, instead)) = of_pictures.into_iter().find(|(given, ..)| *given) {
            return Err(Failure::usage(format!("--{option} is for PNG, JPEG and WebP files; {instead}")));
        }
        let doc = Document::read(bytes, &name, &bending(&read)).map_err(|e| not_a_drawing(bytes, input, e.into()))?;
        meter::count_pixels(doc.budget().taken(Limit::Pixels));
        Ok(Self::new(doc, name, read, selection(&options.select, &options.exclude), format, None))
    }

    /// Creates the drawing of GIMP's paths.
    pub(super) fn of_paths(paths: GimpPaths, format: Format, options: &CommonOptions) -> Result<Self, Failure> {
        let (name, read) = (paths.name(), options.reading.read_options());
        let doc = Document::read(paths.drawing().as_bytes(), &name, &read)?;
        Ok(Self::new(doc, name, read, Selection::default(), format, Some(paths)))
    }

    fn new(
        doc: Document,
        name: String,
        read: ReadOptions,
        selection: Selection,
        format: Format,
        paths: Option<GimpPaths>,
    ) -> Self {
        let (steps, parts, destination) = (Vec::new(), Vec::new(), Destination::default());
        Self { name, doc, read, selection, steps, parts, format, destination, original: None, paths }
    }

    /// Resets the count of work, for a drawing that is bent again and again.
    pub fn renew_budget(&mut self) {
        self.doc.renew_budget();
        if let Some(original) = &mut self.original {
            original.document.renew_budget();
        }
    }

    /// Undoes a division into parts.
    pub fn restore(&mut self, options: &CommonOptions) {
        self.selection = selection(&options.select, &options.exclude);
        (self.steps, self.parts) = (Vec::new(), Vec::new());
    }

    /// Returns the drawing as it was read.
    pub fn document(&self) -> &Document {
        self.original.as_ref().map_or(&self.doc, |o| &o.document)
    }

    /// Returns the numbers of segments before and after the edits, if the drawing was edited before bending.
    pub fn edited(&self) -> Option<[usize; 2]> {
        let count = |d: &Document, s: &Selection| d.selected(s).map(|s| s.outline.segs().count()).sum();
        let original = self.original.as_ref()?;
        Some([count(&original.document, &original.edits.whole), count(&self.doc, &self.selection)])
    }

    /// Returns a preview while something is dragged, and its page if that changes: within the tolerance, but with the source's nodes,
    /// affine fits of gradients and coarse bitmaps.
    pub fn draft(&self, request: &WarpRequest<'_>) -> Result<(String, Option<Rect>), Failure> {
        let draft = |part: usize, built: &BuiltRecipe| {
            let mut options =
                self.warp_options(request, part, built).with_gradients(Gradients::Fit).with_overhang(false);
            options.filters = Filters::Affine;
            let nodes = if request.edit.is_some() { options.refit.nodes } else { Nodes::Source };
            options.refit = options.refit.with_nodes(nodes);
            if let Images::Warp(_) = options.images {
                let bender = Bender::new(Arc::new(built.map.clone()), Some(DRAFT_DPI));
                options.images = Images::Warp(Arc::new(bender.with_budget(self.doc.budget().clone())));
            }
            options
        };
        let (_, warped) = self.warp_parts(&request.built.parts, draft)?;
        Ok((warped.svg, warped.page.map(|[_, after]| after)))
    }

    /// Returns the result in its format, without looking for folds.
    pub fn result(&self, request: &WarpRequest<'_>) -> Result<export::Exported, Failure> {
        let (_, warped, tolerance) = self.warp_for(request)?;
        self.export(warped.svg, request.options, tolerance)
    }

    fn export(&self, svg: String, options: &CommonOptions, tolerance: f64) -> Result<export::Exported, Failure> {
        export::drawing(svg, (self.format, &self.destination), &self.read, options, Some(tolerance))
    }

    /// Changes the format and the destination of the result.
    pub fn set_output(&mut self, format: Format, destination: Destination) {
        (self.format, self.destination) = (format, destination);
    }

    /// Returns the options that the drawing was read with.
    pub fn reading(&self) -> &ReadOptions {
        &self.read
    }

    /// Returns the selection that `which` means.
    fn selection(&self, which: Which) -> &Selection {
        let selection = match which {
            Which::All => None,
            Which::Step(i) => self.steps.get(i),
            Which::Part(i) => self.parts.get(i),
        };
        selection.unwrap_or(&self.selection)
    }

    /// Bends every part of the drawing. Also returns the options for each part.
    fn warp_parts(
        &self,
        parts: &[BuiltRecipe],
        options: impl Fn(usize, &BuiltRecipe) -> WarpOptions,
    ) -> Result<(Vec<WarpOptions>, WarpedDocument), Error> {
        let options: Vec<WarpOptions> = parts.iter().enumerate().map(|(i, built)| options(i, built)).collect();
        let bends = parts.iter().zip(&options).map(|(built, options)| (&built.map as &dyn Map, options));
        let mut warped = self.doc.warp_each(&bends.collect::<Vec<_>>())?;
        if let (Some(back), Some(options)) = (warped.back, options.first()) {
            warped.svg = self.transformed(&warped.svg, back, options)?;
        }
        if let Some(original) = &self.original {
            warped.svg = original.without_added_ids(&warped.svg);
        }
        Ok((options, warped))
    }

    /// Scales and moves a whole result, which was warped with the options `warped`.
    fn transformed(&self, svg: &str, to: Affine, warped: &WarpOptions) -> Result<String, Error> {
        let doc = Document::read(svg.as_bytes(), &self.name, &bending(&self.read))?;
        let refit = refit::Options::new(warped.refit.tolerance).with_nodes(Nodes::Source);
        let options = WarpOptions::new(refit.with_budget(doc.budget().clone())).with_precision(warped.precision);
        let options = options.with_text(warped.text).with_structure(warped.structure).with_clones(warped.clones);
        Ok(doc.warp(&AffineMap(to), &options)?.svg)
    }

    /// Bends the drawing and embeds the recipe. The tolerance may be a length on the result's page. Also returns the options for each part
    /// and the tolerance in user units.
    fn warp_for(&self, request: &WarpRequest<'_>) -> Result<(Vec<WarpOptions>, WarpedDocument, f64), Failure> {
        let WarpRequest { built, options: common, mut tolerance, .. } = *request;
        if let Some(first) = advice::unread(&self.doc.unread_images()).first()
            && common.on_failure == OnFailure::Stop
        {
            return Err(Failure::Input(format!("{}: {first}; --on-error continue goes on without it", self.name)));
        }
        let (mut options, mut warped) = self.warp_parts(&built.parts, |i, part| self.warp_options(request, i, part))?;
        let missing = warped.warnings.iter().find(|w| matches!(w, Warning::MissingLetters(_)));
        if let Some(missing) = missing.filter(|_| common.on_failure == OnFailure::Stop) {
            return Err(Failure::Input(missing.to_string()));
        }
        // The scale of the result's page is known only after bending.
        if common.has_tolerance_of_result()
            && let Some(scale) = common.page_scale(self.size_px(warped.page))
            && (scale.by - 1.0).abs() > SAME_SCALE
        {
            tolerance /= scale.by;
            let line = request.line.clone();
            let finer = WarpRequest { tolerance, line, embedded_recipe: None, ..*request };
            (options, warped) = self.warp_parts(&built.parts, |i, part| self.warp_options(&finer, i, part))?;
        }
        if let Some(recipe) = &request.embedded_recipe {
            let source = self.destination.source(self.document(), &self.read)?;
            let origin = Origin { recipe: recipe.clone(), source };
            warped.svg = origin.embed(&warped.svg)?;
        }
        Ok((options, warped, tolerance))
    }

    /// Returns the options for a part of the drawing.
    fn warp_options(&self, request: &WarpRequest<'_>, part: usize, built: &BuiltRecipe) -> WarpOptions {
        let WarpRequest { options, tolerance, .. } = request;
        let bender = Bender::new(Arc::new(built.map.clone()), options.image_dpi).with_budget(self.doc.budget().clone());
        let bender = Arc::new(bender);
        // A DXF holds no pictures: cutters and plotters follow only the shapes.
        let (gradients, filters) = match options.gradients {
            _ if self.format != Format::Dxf => (options.gradients, options.filters),
            Gradients::Keep => (Gradients::Keep, Filters::Affine),
            _ => (Gradients::Fit, Filters::Affine),
        };
        let first = built.indices.first().map(|&i| self.selection(Which::Step(i)).clone());
        let of_objects = built.placement.of_objects;
        let letters =
            LetterPlaces { places: built.placement.letters.clone(), of_objects, of: first, after: built.after.clone() };
        let refit = refit::Options::new(*tolerance).with_certify(options.certify).with_nodes(options.nodes);
        let refit = refit.with_budget(self.doc.budget().clone()).with_suited(request.suited);
        let warp = WarpOptions::new(refit)
            .with_precision(options.precision)
            .with_strokes(match options.strokes {
                // A cutter follows the centre line of a stroke.
                Strokes::Auto if self.format == Format::Dxf => Strokes::Keep,
                given => given,
            })
            .with_union(options.union)
            .with_text(options.text)
            .with_structure(options.structure)
            .with_selection(self.selection(Which::Part(part)).clone())
            .with_on_error(options.on_failure.of_shapes())
            .with_gradients(gradients)
            .with_filters(filters)
            .with_painter(Some(Painter::new(Arc::clone(&bender))))
            .with_patterns(options.patterns)
            .with_page(if self.reason_to_stay(request).is_some() { PageFit::None } else { options.page })
            .with_same_view(request.same_view)
            .with_grown(self.original.as_ref().and_then(|o| o.grown))
            .with_clones(options.clones)
            .with_copies(built.placement.copies.clone())
            .with_letters(letters)
            .with_images(if options.warp_images { Images::Warp(bender) } else { Images::Keep });
        let sight = built.steps.last().and_then(|s| s.sight.as_deref().cloned()).filter(|_| part == 0);
        let hidden = built.hidden(HIDDEN * tolerance).and_then(|o| Area::of(&o, true, HIDDEN * tolerance).ok());
        let warp = warp.with_line(request.line.clone()).with_sight(sight).with_hidden(hidden.map(Arc::new));
        let warp = request.edit.map_or(warp.clone(), |e| warp.editing(e));
        if self.paths.is_none() {
            return warp;
        }
        // The file stores nothing but paths.
        let warp = warp.with_strokes(Strokes::Keep).with_structure(Structure::Auto);
        warp.with_page(PageFit::None).with_overhang(false)
    }

    /// Returns the selection of each step.
    fn selections(&self, steps: &[Step]) -> Vec<Selection> {
        let guides = || self.selection.guides.clone();
        let selection = |s: &Step| Selection { guides: guides(), ..selection(&s.select, &s.exclude) };
        steps.iter().map(selection).collect()
    }

    /// Returns the size of the result's page in px; `page` is the page before and after in user units, if it changes.
    fn size_px(&self, page: Option<[Rect; 2]>) -> Size {
        let size = self.doc.size_px();
        page.map_or(size, |[before, after]| {
            Size::new(size.width * after.width() / before.width(), size.height * after.height() / before.height())
        })
    }

    /// Returns the reason why the page stays although it could grow.
    fn reason_to_stay(&self, request: &WarpRequest<'_>) -> Option<&'static str> {
        if request.options.page != PageFit::Auto {
            return None;
        }
        page::reason_to_stay(&self.doc, request.options, request.recipe)
    }

    /// Returns the orientation of every shape of a part under the map.
    fn orientations(
        &self,
        part: usize,
        built: &BuiltRecipe,
        options: &WarpOptions,
    ) -> Result<Vec<(&str, Orientation)>, Error> {
        let bounds = self.bounding_box(Which::Part(part));
        let copies = &built.placement.copies;
        let shapes: Vec<_> = self.doc.selected(&options.selection).collect();
        let segments: usize = shapes.iter().map(|s| s.outline.segs().count()).sum();
        let all_copies = bounds.and_then(|b| match copies.as_slice() {
            [] => Some(b),
            places => places.iter().map(|m| m.transform_rect_bbox(b)).reduce(|a, b| a.union(b)),
        });
        let survey = Survey::new(&built.map, all_copies, segments * copies.len().max(1));
        let filled = shapes.iter().filter(|s| s.filled).count();
        survey.spend(filled, segments, copies.len(), self.doc.budget())?;
        // A letter placed by itself can fold only in a later step.
        let placed = self.doc.placed(options);
        let orientation = |(s, placed): (&&pathwarp_svg::Shape, &Option<Outline>)| match placed {
            Some(outline) => fold::orientation(outline, s.filled, &built.after),
            None => survey.orientation_of_copies(&s.outline, copies, s.filled),
        };
        let all: Vec<Orientation> = if survey.samples() && segments >= WORTH_THREADS {
            shapes.par_iter().zip(&placed).map(orientation).collect()
        } else {
            shapes.iter().zip(&placed).map(orientation).collect()
        };
        Ok(shapes.iter().map(|s| s.id.as_str()).zip(all).collect())
    }

    /// Returns the orientation of every picture of a part under the map.
    fn picture_orientations(
        &self,
        part: usize,
        built: &BuiltRecipe,
        options: &WarpOptions,
    ) -> Result<Vec<(String, Orientation)>, Error> {
        let pictures = self.doc.picture_edges(&options.selection);
        if pictures.is_empty() || matches!(options.images, Images::Keep) {
            return Ok(Vec::new());
        }
        let survey = Survey::new(&built.map, self.bounding_box(Which::Part(part)), 4 * pictures.len());
        survey.spend(pictures.len(), 4 * pictures.len(), 1, self.doc.budget())?;
        let orientation = |o: &Outline| survey.orientation_of_copies(o, &built.placement.copies, true);
        Ok(pictures.into_iter().map(|(name, edge)| (name, orientation(&edge))).collect())
    }

    /// Finds the folds of the shapes and pictures of a part. Returns those of shapes by id, and the warnings.
    fn folds(
        &self,
        part: usize,
        built: &BuiltRecipe,
        options: &WarpOptions,
        warped: &WarpedDocument,
    ) -> Result<(HashMap<&str, Fold>, Vec<String>), Error> {
        // A view in space cuts away the parts that would overlap, which lie behind others.
        if options.hidden.is_some() {
            return Ok((HashMap::new(), Vec::new()));
        }
        // Parts of a text or `use` share an id and count as one shape in the report.
        let mut by_id: HashMap<&str, Orientation> = HashMap::new();
        let mut all = Orientation::default();
        for (id, o) in self.orientations(part, built, options)? {
            all = all.and(&o);
            let sum = by_id.entry(id).or_default();
            *sum = sum.and(&o);
        }
        let pictures = self.picture_orientations(part, built, options)?;
        all = pictures.iter().fold(all, |all, (_, o)| all.and(o));
        // Folds count against the orientation of most of the artwork, or against the unturned one if the corners of its box keep that.
        all = self.bounding_box(Which::Part(part)).map_or(all, |bounds| all.usual(&built.map, bounds));
        let (mut out, mut warnings) = (HashMap::new(), Vec::new());
        let placement = &built.placement;
        let survey = LazyCell::new(|| Survey::new(&built.map, None, 1));
        let lettering = LazyCell::new(|| self.doc.lettering(&options.selection));
        let letters = LazyCell::new(|| {
            // Letters placed one by one do not follow the map.
            let letters = if placement.letters.is_empty() { lettering.letters() } else { &[] };
            artwork::letters_by_shape(self.doc.selected(&options.selection).map(|s| (&*s.id, &*s.outline)), letters)
        });
        for (name, o) in &pictures {
            warnings.extend(o.folded_against(&all).map(|at| artwork::fold_warning(name, &[], at)));
        }
        for s in &warped.shapes {
            let Some((&id, o)) = by_id.get_key_value(s.id.as_str()).filter(|(id, _)| !out.contains_key(**id)) else {
                continue;
            };
            let fold = Fold::of(o, &all);
            if let Some(at) = fold.at {
                let orientation = |o: &Outline| survey.orientation_of_copies(o, &placement.copies, true);
                let letters = artwork::folded(letters.get(id), &all, orientation);
                warnings.push(artwork::fold_warning(id, &letters, at));
            }
            out.insert(id, fold);
        }
        Ok((out, warnings))
    }

    /// Returns the report of every shape, and the fold warnings.
    fn shape_reports(
        &self,
        parts: &[BuiltRecipe],
        options: &[WarpOptions],
        warped: &WarpedDocument,
    ) -> Result<(Vec<ReportedShape>, Vec<String>), Error> {
        let (mut folds, mut warnings) = (Vec::new(), Vec::new());
        for (part, (built, options)) in parts.iter().zip(options).enumerate() {
            let (folds_of_part, warnings_of_part) = self.folds(part, built, options, warped)?;
            folds.push(folds_of_part);
            warnings.extend(warnings_of_part);
        }
        let report = |s: &ShapeReport| {
            let found = folds.iter().enumerate().find_map(|(part, folds)| Some((part, folds.get(s.id.as_str())?)));
            let steps = found.filter(|_| !self.parts.is_empty());
            let steps = steps.map(|(part, _)| parts[part].indices.iter().map(|i| i + 1).collect());
            let fold = found.map_or(Fold { count: 0, at: None }, |(_, fold)| fold.clone());
            ReportedShape { shape: s.clone(), steps, fold }
        };
        Ok((warped.shapes.iter().map(report).collect(), warnings))
    }
}

/// Returns options for a drawing that is bent and not rendered: JPEG pictures get the size at which they show in their header, and are
/// decoded only where they are bent.
fn bending(read: &ReadOptions) -> ReadOptions {
    read.clone().with_turned(Some(Picture::sized))
}

/// Returns the selection of what is named in `select`, or else of everything, except what is named in `exclude`.
fn selection(select: &[String], exclude: &[String]) -> Selection {
    Selection { select: select.to_vec(), exclude: exclude.to_vec(), ..Selection::default() }
}

/// Returns the format of the result. An unknown extension that is also the input's means SVG.
fn format(options: &CommonOptions, input: &Path, target: Option<&Path>) -> Result<Format, Failure> {
    let is_of_input = |t: &&Path| Format::of(t).is_none() && t.extension() == input.extension();
    let known = target.filter(|t| !is_of_input(t));
    let format = Choice { what: "a drawing is", among: DRAWINGS }.format(known, options.format)?;
    if options.embed_recipe && !matches!(format, Format::Svg | Format::Svgz) {
        let word = format.extension();
        return Err(Failure::usage(format!("--embed-recipe is for SVG files; a .{word} has no place for the source")));
    }
    Ok(format)
}

impl Artwork for SvgArtwork {
    fn path_named(&self, name: &str) -> Result<Outline, Error> {
        match &self.paths {
            Some(paths) => Ok(paths.file.path_named(name)?.outline()),
            None => Ok(self.document().path(name)?.outline),
        }
    }

    fn remove_guides(&mut self, guides: Vec<String>) {
        self.selection.guides = guides;
    }

    fn edit_first(&mut self, edits: &[Step], steps: &[Step], options: &CommonOptions) -> Result<(), Failure> {
        if edits.is_empty() {
            if let Some(original) = self.original.take() {
                self.doc = original.document;
            }
            return Ok(self.doc.check_selection(&self.selection)?);
        }
        let steps = if steps.iter().any(Step::is_selective) { self.selections(steps) } else { Vec::new() };
        if self.paths.is_some() && edits.iter().any(is_caption) {
            return Err(Failure::usage("GIMP's paths have no fills; caption is for drawings"));
        }
        let edits = Edits { edits: edits.to_vec(), whole: self.selection.clone(), steps };
        if self.original.as_ref().is_some_and(|o| o.edits == edits) {
            return Ok(());
        }
        let Edited { document: edited, grown, warnings } =
            edits.apply(self.document(), &self.name, &bending(&self.read), options)?;
        let before = std::mem::replace(&mut self.doc, edited);
        let document = self.original.take().map_or(before, |o| o.document);
        self.original = Some(Original { document, edits, grown, warnings });
        Ok(())
    }

    fn divide(&mut self, steps: &[Step]) -> Result<Vec<Vec<usize>>, Failure> {
        let mut all = self.selections(steps);
        all.iter().try_for_each(|s| self.doc.check_selection(s))?;
        // The selection for the whole recipe restricts every step.
        let whole = all.len();
        all.push(self.selection.clone());
        let mut divisions = self.doc.divide(&all);
        divisions.retain_mut(|d| d.among.pop_if(|last| *last == whole).is_some() && !d.among.is_empty());
        let parts_of = |step: usize| divisions.iter().filter(move |d| d.among.contains(&step)).map(|d| &d.selection);
        self.steps = (0..whole).map(|step| self.doc.united(parts_of(step))).collect();
        let (steps_of_parts, parts) = divisions.into_iter().map(|d| (d.among, d.selection)).unzip();
        self.parts = parts;
        self.selection = self.doc.united(self.parts.iter());
        Ok(steps_of_parts)
    }

    fn bounding_box(&self, which: Which) -> Option<Rect> {
        let selection = self.selection(which);
        if self.paths.is_some() { self.doc.artwork_box(selection) } else { self.doc.seen_box(selection) }
    }

    fn painted_box(&self) -> Option<Rect> {
        if self.paths.is_some() { self.bounding_box(Which::All) } else { self.doc.painted_box(&self.selection) }
    }

    fn uncut_box(&self, which: Which, bounds: Rect) -> Option<Rect> {
        if self.paths.is_some() { None } else { self.doc.uncut_box(self.selection(which), bounds) }
    }

    fn frame(
        &self,
        which: Which,
        choice: FrameChoice,
        bounds: Option<Rect>,
        baseline: Baseline,
    ) -> Result<Frame, Failure> {
        let artwork = || Frame::new(bounds.unwrap_or_else(|| self.doc.view_box()));
        let plain = match choice {
            FrameChoice::Default | FrameChoice::Artwork => Some(artwork()),
            FrameChoice::ViewBox => Some(Frame::new(self.doc.view_box())),
            FrameChoice::Rect(r) => Some(Frame::new(r.rect(self.units_per_px()))),
            FrameChoice::Lettering(_) => None,
        };
        // Skip the lettering if possible: finding it takes longer than reading the drawing.
        let lettering = match (&plain, baseline) {
            (Some(frame), Baseline::None) => return Ok(frame.clone()),
            _ => self.doc.lettering(self.selection(which)),
        };
        let frame = match (choice, plain) {
            (FrameChoice::Lettering(kind), _) => {
                lettering.frame(kind).map_err(|e| Error::input(&self.name, advice::lettering_frame(&e)))?
            }
            (FrameChoice::Default, _) if baseline == Baseline::Open && lettering.is_all() && lettering.is_level() => {
                lettering.frame(LetteringFrame::BaselineAscent).unwrap_or_else(|_| artwork())
            }
            (_, plain) => plain.unwrap_or_else(artwork),
        };
        let frame = if lettering.is_level() { frame.with_letters(lettering.letters().into()) } else { frame };
        Ok(frame.with_objects(self.doc.objects(self.selection(which)).into()))
    }

    fn units_per_px(&self) -> [f64; 2] {
        units_per_px(&self.doc)
    }

    fn page(&self) -> Option<Rect> {
        Some(self.doc.view_box())
    }

    fn budget(&self) -> &Arc<Budget> {
        self.doc.budget()
    }

    fn outlines(&self, which: Which) -> Vec<&Outline> {
        self.doc.selected(self.selection(which)).map(|s| &*s.outline).collect()
    }
}

/// Warns of lengths of a contour if the page has no unit.
fn unmeasured(doc: &Document, request: &WarpRequest<'_>) -> Option<String> {
    const UNITS: [&str; 6] = ["mm", "cm", "in", "pt", "pc", "q"];
    let Some(Edit::Contour(_)) = request.edit else { return None };
    let args = &request.recipe.steps.last()?.args;
    let mut lengths = ["by", "bleed"].iter().flat_map(|name| args.get(name));
    let length = lengths.find(|v| UNITS.iter().any(|unit| v.to_lowercase().ends_with(unit)))?;
    let has_size = doc.is_measured() || request.options.page_width.or(request.options.page_height).is_some();
    let advice = "--page-width gives the page its size";
    (!has_size).then(|| format!("the page has no unit: {length} is taken at 96 px per inch; {advice}"))
}

/// Warns of gradients that became pictures.
fn pictured(shapes: &[ReportedShape]) -> Option<String> {
    match shapes.iter().map(|s| s.shape.pictures).sum() {
        0 => None,
        1 => Some("a gradient became a picture; --gradients fit keeps it vector".into()),
        n => Some(format!("{n} gradients became pictures; --gradients fit keeps them vector")),
    }
}

impl FileArtwork for SvgArtwork {
    fn file_name(&self) -> String {
        self.name.clone()
    }

    fn warp(&self, request: &WarpRequest<'_>) -> Result<WarpedArtwork, Failure> {
        let WarpRequest { built, options: common, .. } = request;
        match request.edit.filter(|_| self.paths.is_some()) {
            Some(Edit::Outline) => {
                return Err(Failure::usage("GIMP's paths have no strokes that could become outlines"));
            }
            Some(Edit::Unite { .. } | Edit::Contour(_)) => {
                return Err(Failure::usage("GIMP's paths have no fills; unite and contour are for drawings"));
            }
            _ => {}
        }
        let (options, mut warped, tolerance) = self.warp_for(request)?;
        let page = PageNews::take(&mut warped, common.page, self.reason_to_stay(request));
        let (mut shapes, folds) = self.shape_reports(&built.parts, &options, &warped)?;
        let mut warnings: Vec<String> = warped.warnings.iter().map(ToString::to_string).collect();
        warnings.extend(self.original.iter().flat_map(|o| &o.warnings).cloned());
        let damage = self.paths.as_ref().and_then(|p| p.file.damage.clone());
        let is_damaged = damage.is_some();
        warnings.extend(damage);
        let is_empty = !self.doc.has_artwork(&self.selection);
        if is_empty {
            warnings.push("there is nothing to warp: no shapes, text or images; the drawing stays as it is".into());
        }
        warnings.extend(unmeasured(&self.doc, request));
        warnings.extend(pictured(&shapes));
        warnings.extend(match warped.filters[0].len() {
            0 => None,
            1 => Some("a filter became a picture; --filters affine keeps it".into()),
            n => Some(format!("{n} filters became pictures; --filters affine keeps them")),
        });
        warnings.extend(folds);
        let unread = self.doc.unread_images();
        warnings.extend(advice::unread_besides(&unread, &warped.skipped));
        beside::check_surface(built)?;
        let parts = built.parts.iter().zip(&options);
        let surfaces = parts.map(|(part, options)| beside::surface_files(&self.doc, part, options));
        let surfaces = surfaces.collect::<Result<Vec<_>, _>>()?.concat();
        let files = surfaces.iter().map(|(file, text)| PendingFile::new(file, text.as_bytes()));
        let files = files.collect::<Result<_, _>>()?;
        let result = (warped.svg.as_str(), warped.back.unwrap_or_default());
        let preview = common.preview.as_deref();
        let preview = preview.map(|file| beside::preview(&self.doc, result, built, &self.read, (file, common)));
        let (result, (lost, kerf)) = match &self.paths {
            Some(paths) => {
                let guides = &self.selection.guides;
                paths.written(&warped.svg, guides, (self.format, common, tolerance), &mut shapes)?
            }
            None => {
                let result = self.export(warped.svg, common, tolerance)?;
                (WarpedResult::Bytes(result.bytes), (result.warnings, result.kerf))
            }
        };
        warnings.extend(lost);
        Ok(WarpedArtwork {
            result,
            shapes,
            skipped: warped.skipped.into_iter().map(Into::into).collect(),
            warnings,
            files,
            preview: preview.transpose()?,
            partial: is_empty || is_damaged || !unread.is_empty() || kerf.as_ref().is_some_and(KerfReport::is_partial),
            kerf,
            proportions: None,
            page,
            filters: warped.filters,
            tolerance: Some(tolerance),
        })
    }
}
