//! SVG drawings as artwork.

use super::artwork::{Artwork, WarpRequest, WarpedArtwork, WarpedResult};
use super::folds::{self, Fold};
use super::gimp_format::is_named_point_list_or_xcf;
use super::picture::is_named_picture;
use super::read::{display, read_options};
use super::{preview, surface};
use crate::advice;
use crate::bitmap::Bender;
use crate::failure::Failure;
use crate::options::{CommonOptions, FrameChoice, GradientChoice};
use crate::output::PendingFile;
use crate::report::{ReportedShape, SkippedShape, assurance_word};
use pathwarp::fold::{self, Orientation};
use pathwarp::kurbo::Rect;
use pathwarp::param::Frame;
use pathwarp::recipe::BuiltRecipe;
use pathwarp::refit;
use pathwarp::{Error, Outline};
use pathwarp_svg::{
    Document, Gradients, Images, LetterPlaces, LetteringFrame, Origin, ReadOptions, Selection, WarpOptions,
    WarpedDocument, compressed,
};
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::Arc;

/// An SVG drawing. Its plane is root user space.
pub(crate) struct SvgArtwork {
    name: String,
    doc: Document,
    read: ReadOptions,
    selection: Selection,
}

impl SvgArtwork {
    pub(super) fn read(
        bytes: &[u8],
        input: &Path,
        options: &CommonOptions,
        target: Option<&Path>,
    ) -> Result<Self, Failure> {
        if let Some(t) = target.filter(|t| is_named_point_list_or_xcf(t)) {
            let advice =
                "point lists and XCF are written for GIMP inputs only; `pathwarp convert` makes them from an SVG";
            return Err(Failure::usage(format!("{}: {advice}", t.display())));
        }
        if let Some(t) = target.filter(|t| is_named_picture(t)) {
            let advice = "a drawing is written as SVG; --preview and `pathwarp render` make pictures of it";
            return Err(Failure::usage(format!("{}: {advice}", t.display())));
        }
        let (name, read) = (display(input), read_options(input));
        let doc = Document::read(bytes, &name, &read)?;
        let selection =
            Selection { select: options.select.clone(), exclude: options.exclude.clone(), ..Selection::default() };
        Ok(Self { name, doc, read, selection })
    }

    fn warp_options(&self, request: &WarpRequest<'_>) -> WarpOptions {
        let WarpRequest { built, options, tolerance, .. } = request;
        let bender = Arc::new(Bender::new(Arc::new(built.map.clone()), options.image_dpi));
        let gradients = match options.gradients {
            GradientChoice::Fit => Gradients::Fit,
            GradientChoice::Auto => Gradients::Auto(bender.clone()),
            GradientChoice::Exact => Gradients::Exact(bender.clone()),
            GradientChoice::Keep => Gradients::Keep,
        };
        let letters = LetterPlaces { places: built.placement.letters.clone(), after: built.after.clone() };
        let refit = refit::Options::new(*tolerance).with_certify(options.certify).with_merge(options.merge);
        WarpOptions::new(refit)
            .with_precision(options.precision)
            .with_strokes(options.strokes)
            .with_text(options.text)
            .with_structure(options.structure)
            .with_selection(self.selection.clone())
            .with_on_error(options.on_error)
            .with_gradients(gradients)
            .with_patterns(options.patterns)
            .with_page(options.page)
            .with_copies(built.placement.copies.clone())
            .with_letters(letters)
            .with_images(if options.warp_images { Images::Warp(bender) } else { Images::Keep })
    }

    /// Every selected shape's orientation under the map.
    fn orientations(&self, built: &BuiltRecipe, options: &WarpOptions) -> Vec<(&str, Orientation)> {
        let shapes: Vec<_> = self.doc.selected(&options.selection).collect();
        // A letter that is placed on its own can fold only in a later step.
        let placed = self.doc.placed(options);
        let orientation = |(s, placed): (&'_ pathwarp_svg::Shape, &Option<Outline>)| match placed {
            Some(outline) => fold::orientation(outline, s.filled, &built.after),
            None => fold::orientation(&s.outline.repeated(&built.placement.copies), s.filled, &built.map),
        };
        let all: Vec<Orientation> = shapes.par_iter().map(|s| *s).zip(&placed).map(orientation).collect();
        shapes.iter().map(|s| s.id.as_str()).zip(all).collect()
    }

    /// The report of every shape, and the fold warnings.
    fn shape_reports(
        &self,
        built: &BuiltRecipe,
        options: &WarpOptions,
        warped: &WarpedDocument,
    ) -> (Vec<ReportedShape>, Vec<String>) {
        // Parts of one text or `use` share an id and count as one shape in the report.
        let mut by_id: HashMap<&str, Orientation> = HashMap::new();
        let mut all = Orientation::default();
        for (id, o) in self.orientations(built, options) {
            all = all.and(&o);
            let sum = by_id.entry(id).or_default();
            *sum = sum.and(&o);
        }
        let (mut shapes, mut warnings) = (Vec::with_capacity(warped.shapes.len()), Vec::new());
        let mut warned = HashSet::new();
        for s in &warped.shapes {
            let fold = Fold::of(&by_id.get(s.id.as_str()).copied().unwrap_or_default(), &all);
            if let Some(at) = fold.at
                && warned.insert(&s.id)
            {
                warnings.push(folds::warning(&s.id, at));
            }
            shapes.push(shape_report(s, &fold));
        }
        (shapes, warnings)
    }
}

fn shape_report(s: &pathwarp_svg::ShapeReport, fold: &Fold) -> ReportedShape {
    ReportedShape {
        id: s.id.clone(),
        copies: s.copies,
        segments_in: s.segments_in,
        segments_out: s.segments_out,
        max_error: s.max_error,
        certified: s.assurance != refit::Assurance::Checked,
        assurance: assurance_word(s.assurance),
        folds: fold.count,
        folded_at: fold.place(),
        over_budget: s.over_budget.iter().map(|p| [p.x, p.y]).collect(),
        paint_residual: s.paint_residual,
        pictures: s.pictures,
    }
}

impl Artwork for SvgArtwork {
    fn file_name(&self) -> String {
        self.name.clone()
    }

    fn path_named(&self, name: &str) -> Result<Outline, Error> {
        Ok(self.doc.path(name)?.outline)
    }

    fn remove_guides(&mut self, guides: Vec<String>) {
        self.selection.guides = guides;
    }

    fn bounding_box(&self) -> Option<Rect> {
        self.doc.seen_box(&self.selection)
    }

    fn frame(&self, choice: FrameChoice, bounds: Option<Rect>, on_baseline: bool) -> Result<Frame, Failure> {
        let lettering = self.doc.lettering(&self.selection);
        let artwork = || Frame::new(bounds.unwrap_or_else(|| self.doc.view_box()));
        let frame = match choice {
            FrameChoice::Default if on_baseline && lettering.is_all() && lettering.is_level() => {
                lettering.frame(LetteringFrame::BaselineAscent).unwrap_or_else(|_| artwork())
            }
            FrameChoice::Default | FrameChoice::Artwork => artwork(),
            FrameChoice::ViewBox => Frame::new(self.doc.view_box()),
            FrameChoice::Rect(r) => Frame::new(r),
            FrameChoice::Lettering(kind) => {
                lettering.frame(kind).map_err(|e| Error::input(&self.name, advice::lettering_frame(&e)))?
            }
        };
        Ok(if lettering.is_level() { frame.with_letters(lettering.letters().into()) } else { frame })
    }

    fn outlines(&self) -> Vec<&Outline> {
        self.doc.selected(&self.selection).map(|s| &s.outline).collect()
    }

    fn warp(&self, request: &WarpRequest<'_>) -> Result<WarpedArtwork, Failure> {
        let WarpRequest { built, options: common, .. } = request;
        let options = self.warp_options(request);
        let mut warped = self.doc.warp(&built.map, &options)?;
        if let Some(recipe) = &request.embedded_recipe {
            let origin = Origin { recipe: recipe.clone(), source: self.doc.source().to_vec() };
            warped.svg = origin.embed(&warped.svg)?;
        }
        let (shapes, folds) = self.shape_reports(built, &options, &warped);
        let mut warnings = warped.warnings;
        warnings.extend(warped.overhang.map(advice::overhang));
        warnings.extend(folds);
        let surfaces = surface::files(&self.doc, built, &options)?;
        let files = surfaces.iter().map(|(file, text)| PendingFile::new(file, text.as_bytes()));
        let files = files.collect::<Result<_, _>>()?;
        let preview = common.preview.is_some().then(|| preview::draw(&self.doc, &warped.svg, built, &self.read));
        let result = match request.target {
            Some(t) if t.extension().is_some_and(|e| e.eq_ignore_ascii_case("svgz")) => {
                compressed(&warped.svg).map_err(|e| Failure::file(t, e))?
            }
            _ => warped.svg.into_bytes(),
        };
        Ok(WarpedArtwork {
            result: WarpedResult::Bytes(result),
            shapes,
            skipped: warped.skipped.into_iter().map(|s| SkippedShape { id: s.id, why: s.why }).collect(),
            warnings,
            files,
            preview: preview.transpose()?,
            partial: false,
        })
    }
}
