//! The common options as typed values.

use crate::failure::Failure;
use crate::format::Format;
use pathwarp::budget::{Limit, Limits};
use pathwarp::engine::RESOLUTION;
use pathwarp::kurbo::{Point, Rect, Size};
use pathwarp::param::{Args, Axis, Frame, Length, LengthUnit};
use pathwarp::recipe::Step;
use pathwarp::refit::Nodes;
use pathwarp_raster::Picture;
use pathwarp_svg::engine::{GenericFamilies, LetteringFrame, check_fonts};
use pathwarp_svg::{Clones, Filters, Gradients, OnError, PageFit, Patterns, ReadOptions, Strokes, Structure, TextMode};
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

/// Default tolerance as a fraction of the artwork's diagonal: a tenth of a pixel on a poster-sized screen, and finer than any
/// plotter draws.
pub(crate) const TOLERANCE_OF_DIAGONAL: f64 = 1e-4;

/// The box that percentages refer to.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[expect(missing_docs, reason = "the table of options says what each word means")]
pub enum FrameChoice {
    /// Not given: the artwork's box, or, for a deformation with a baseline, the box that it asks for around lettering.
    #[default]
    Default,
    Artwork,
    Lettering(LetteringFrame),
    ViewBox,
    Rect(TypedBox),
}

/// The reaction to an input or a shape that cannot be warped.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum OnFailure {
    /// Leave the input out and go on with the others.
    #[default]
    Continue,
    /// End the run and write nothing.
    Stop,
    /// Leave the shape unchanged, or the input out.
    Skip,
}

impl OnFailure {
    /// Returns the reaction to a shape.
    pub(crate) fn of_shapes(self) -> OnError {
        if self == Self::Skip { OnError::Skip } else { OnError::Stop }
    }
}

/// The values of the common options. `Default` holds the unset state; [`Given::read`](super::Given::read) applies the defaults
/// that the table declares and then the values given.
#[derive(Debug, Clone, Default, PartialEq)]
#[expect(missing_docs, reason = "the table of options has the help of each")]
pub struct CommonOptions {
    pub inputs: Vec<PathBuf>,
    /// Edits to do before all steps, in this order.
    pub edits: Vec<Step>,
    /// `None`: standard output.
    pub out: Option<PathBuf>,
    pub out_dir: Option<PathBuf>,
    /// `None`: by the extension.
    pub format: Option<Format>,
    /// Overwrite the inputs.
    pub in_place: bool,
    /// Warp the SVG files in folders.
    pub recursive: bool,
    /// Print what would be written, and write nothing.
    pub dry_run: bool,
    /// Copy of the input XCF that receives the warped paths.
    pub into: Option<PathBuf>,
    /// Read the paths before the damage in a damaged GIMP file.
    pub salvage: bool,
    pub tolerance: Option<Length>,
    pub certify: bool,
    pub nodes: Nodes,
    pub frame: FrameChoice,
    pub select: Vec<String>,
    pub exclude: Vec<String>,
    pub precision: Option<u8>,
    pub strokes: Strokes,
    /// Simplify the outlines of strokes.
    pub union: bool,
    pub text: TextMode,
    pub gradients: Gradients,
    pub filters: Filters,
    pub patterns: Patterns,
    pub page: PageFit,
    /// The size of the result's page.
    pub page_width: Option<Length>,
    pub page_height: Option<Length>,
    pub clones: Clones,
    pub structure: Structure,
    /// Warp the bitmaps in drawings.
    pub warp_images: bool,
    pub image_dpi: Option<f64>,
    /// Cut a warped picture to the image of the frame.
    pub crop: bool,
    /// Ratio of the longer to the shorter side of a cropped picture, or the reverse, as typed.
    pub ratio: Option<f64>,
    /// Keep the location in the metadata of a picture.
    pub keep_location: bool,
    /// Width, and height if given, of a warped picture in pixels.
    pub image_size: Option<(u32, Option<u32>)>,
    /// Write Bézier curves as polylines in a DXF.
    pub dxf_polylines: bool,
    /// Width of a cut; the contours of a DXF move to make room for it.
    pub kerf: Option<Length>,
    /// Selectors and colours of shapes that are not cut and do not move.
    pub engrave: Vec<String>,
    /// Keep the repetitions of lines that are drawn several times in a DXF.
    pub keep_duplicates: bool,
    /// Quality of a JPEG, from 1 to 100.
    pub quality: Option<u8>,
    pub on_failure: OnFailure,
    pub report: Option<PathBuf>,
    pub preview: Option<PathBuf>,
    /// Draw nodes and handles in pictures of curves.
    pub show_nodes: bool,
    /// Selectors of the paths whose images are drawn with their control polygons in previews.
    pub show_polygons: Vec<String>,
    pub write_recipe: Option<PathBuf>,
    pub embed_recipe: bool,
    pub explain: bool,
    /// Number of threads; `None`: one per core.
    pub jobs: Option<usize>,
    pub reading: Reading,
    pub quiet: bool,
}

impl CommonOptions {
    /// Returns the tolerance given, or the default for artwork with this bounding box, in user units.
    ///
    /// # Errors
    /// [`Failure::Usage`] if the tolerance given is finer than the rounding of the artwork's coordinates.
    pub fn tolerance_for(&self, artwork: Option<Rect>, frame: &Frame) -> Result<f64, Failure> {
        distance(self.tolerance, TOLERANCE_OF_DIAGONAL, artwork, frame)
    }

    /// Returns the scale that fits a page of this size in px into `--page-width` and `--page-height`, if any is given.
    pub(crate) fn page_scale(&self, page: Size) -> Option<PageScale> {
        let sides = [(self.page_width, page.width), (self.page_height, page.height)];
        let scales = sides.into_iter().filter_map(|(given, side)| {
            let Length { value, unit, .. } = given?;
            Some(PageScale { by: value * unit.px().unwrap_or(1.0) / side, unit })
        });
        scales.filter(|s| s.by > 0.0 && s.by.is_finite()).reduce(|a, b| if b.by < a.by { b } else { a })
    }

    /// Returns `true` if the tolerance is a length on the result's page, which differs in scale from the source's.
    pub(crate) fn has_tolerance_of_result(&self) -> bool {
        let resizes = self.page_width.is_some() || self.page_height.is_some();
        resizes && self.tolerance.is_some_and(|t| t.unit.px().is_some())
    }
}

/// Returns a tolerance in user units; if none is given, a share of the diagonal of the artwork's bounding box.
pub(crate) fn distance(
    given: Option<Length>,
    share: f64,
    artwork: Option<Rect>,
    frame: &Frame,
) -> Result<f64, Failure> {
    if let Some(tolerance) = given.map(|d| d.in_units(Axis::Diagonal, frame)).filter(|d| *d > 0.0) {
        return measurable("tolerance", tolerance, artwork).map(|()| tolerance);
    }
    let diagonal = artwork.map_or(0.0, |r| r.width().hypot(r.height()));
    Ok(if diagonal > 0.0 { diagonal * share } else { share })
}

/// Refuses a distance that is finer than the rounding of the artwork's coordinates.
pub fn measurable(option: &str, distance: f64, artwork: Option<Rect>) -> Result<(), Failure> {
    let largest = artwork.map_or(0.0, |r| r.x0.abs().max(r.x1.abs()).max(r.y0.abs()).max(r.y1.abs()));
    let finest = RESOLUTION * largest;
    if distance < finest {
        let problem = "is finer than the numbers it would be measured with; use at least";
        return Err(Failure::usage(format!("--{option}: {distance:e} {problem} {finest:.0e}")));
    }
    Ok(())
}

/// The new size of a page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PageScale {
    /// The scale of the new page, relative to the old one.
    pub(crate) by: f64,
    /// The unit of the size given.
    pub(crate) unit: LengthUnit,
}

/// The options of every command that reads drawings.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Reading {
    /// Limits on the work that an input may cause.
    pub limits: Limits,
    /// Read linked files from anywhere, not only beside the input.
    pub external: bool,
    /// The fonts for text.
    pub fonts: Fonts,
    /// The folder that links are relative to; `None`: the input's.
    pub(crate) base: Option<PathBuf>,
}

/// The fonts for text.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Fonts {
    /// Files, and folders of them.
    pub paths: Vec<PathBuf>,
    /// Ignore the installed fonts.
    pub(crate) no_system: bool,
    pub(crate) generic: GenericFamilies,
}

impl Reading {
    /// Checks that the paths named as fonts are fonts.
    pub fn check(&self) -> Result<(), Failure> {
        Ok(check_fonts(&self.fonts.paths)?)
    }

    /// Lets a switch end the work.
    pub(crate) fn stop(&mut self, switch: Option<&'static AtomicBool>) {
        self.limits = switch.map_or(self.limits, |switch| self.limits.stopped_by(switch));
    }

    /// Returns the library's options for reading.
    pub fn read_options(&self) -> ReadOptions {
        ReadOptions::default()
            .with_turned(Some(Picture::turned))
            .with_limits(self.limits)
            .with_external(self.external)
            .with_fonts(self.fonts.paths.clone())
            .with_system_fonts(!self.fonts.no_system)
            .with_generic_families(self.fonts.generic.clone())
    }
}

/// A position and size as typed, without percentages.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TypedBox([Length; 4]);

impl TypedBox {
    /// The box in user units of a drawing.
    pub fn rect(&self, units_per_px: [f64; 2]) -> Rect {
        let scale = Frame::new(Rect::ZERO).with_units_per_px(units_per_px);
        let [x, y, w, h] = self.0;
        let (x, y) = (x.in_units(Axis::X, &scale), y.in_units(Axis::Y, &scale));
        Rect::from_origin_size(Point::new(x, y), Size::new(w.in_units(Axis::X, &scale), h.in_units(Axis::Y, &scale)))
    }
}

/// Parses a positive, finite number.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(v) if v > 0.0 && v.is_finite() => Ok(v),
        _ => Err(format!("`{text}` is not a positive number")),
    }
}

/// Parses a limit, `NAME=N` or `NAME=none`.
pub(super) fn limit(text: &str, limits: &mut Limits) -> Result<(), String> {
    let (name, value) = text.split_once('=').ok_or_else(|| format!("`{text}` is not NAME=N, such as work=1e9"))?;
    let limit = Limit::named(name.trim()).ok_or_else(|| match name.trim() {
        old @ ("comparisons" | "segments" | "letters" | "painting" | "evaluations") => {
            format!(
                "`{old}` is now part of the limit `work`: --limit work=N, of which a default run has {:.0e}",
                Limits::default().of(Limit::Work)
            )
        }
        "image-bytes" => "`image-bytes` is now part of the limit `bytes`: --limit bytes=N".to_owned(),
        other => crate::advice::unknown("limit", other, Limit::ALL.into_iter().map(Limit::name)),
    })?;
    let most = if value.trim() == "none" { f64::INFINITY } else { positive(value.trim())? };
    *limits = limits.with(limit, most);
    Ok(())
}

/// Parses a positive length.
pub(super) fn positive_length(text: &str) -> Result<Length, String> {
    let length: Length = text.parse().map_err(|e| format!("`{text}` {e}"))?;
    if length.value > 0.0 { Ok(length) } else { Err(format!("`{text}` is not positive")) }
}

/// Parses a length; `None` if it is zero.
fn some_length(text: &str) -> Result<Option<Length>, String> {
    let length: Length = text.parse().map_err(|e| format!("`{text}` {e}"))?;
    Ok(Some(length).filter(|l| l.value != 0.0))
}

/// Parses the distance of `--simplify` as an edit; `None` if it is zero.
pub(super) fn simplify_step(text: &str) -> Result<Option<Step>, String> {
    let length = some_length(text)?;
    if length.is_some_and(|l| l.value < 0.0) {
        return Err(format!("`{text}` is below zero"));
    }
    Ok(length.map(|_| Step::new("simplify", Args::from_pairs(&[("within", text)]))))
}

/// Parses the distance of `--outset` as an edit; `None` if it is zero. Areas shrink if it is negative.
pub(super) fn outset_step(text: &str) -> Result<Option<Step>, String> {
    let args = match text.trim().strip_prefix('-') {
        Some(by) => Args::from_pairs(&[("by", by), ("side", "inside")]),
        None => Args::from_pairs(&[("by", text)]),
    };
    Ok(some_length(text)?.map(|_| Step::new("offset", args)))
}

/// Parses a side of a page.
pub(super) fn side_of_page(text: &str) -> Result<Length, String> {
    let length = positive_length(text)?;
    if length.unit == LengthUnit::Percent { Err(format!("`{text}` is not a length, such as 80mm")) } else { Ok(length) }
}

/// Parses proportions: `W:H`, or the name of a sheet.
pub(super) fn ratio(text: &str) -> Result<f64, String> {
    let sides = match text {
        "square" => Some((1.0, 1.0)),
        "letter" => Some((8.5, 11.0)),
        "a4" | "A4" => Some((210.0, 297.0)),
        _ => text.split_once(':').and_then(|(w, h)| w.trim().parse().ok().zip(h.trim().parse::<f64>().ok())),
    };
    let ratio = sides.filter(|(w, h)| *w > 0.0 && *h > 0.0).map(|(w, h): (f64, f64)| w / h);
    let ratio = ratio.filter(|r| (1e-3..=1e3).contains(r));
    ratio.ok_or_else(|| format!("`{text}` is neither a ratio of sides such as 210:297 nor a4, letter or square"))
}

/// Parses a size in pixels, `W` or `WxH`.
pub(super) fn image_size(text: &str) -> Result<(u32, Option<u32>), String> {
    let number = |t: &str| t.trim().parse::<u32>().ok().filter(|n| *n > 0);
    let size = match text.split_once(['x', 'X', '×']) {
        None => number(text).map(|w| (w, None)),
        Some((w, h)) => number(w).zip(number(h)).map(|(w, h)| (w, Some(h))),
    };
    size.ok_or_else(|| format!("`{text}` is neither W nor WxH in whole pixels"))
}

/// Parses a frame: one of its names, or a box.
pub(super) fn frame(text: &str) -> Result<FrameChoice, String> {
    Ok(match text {
        "artwork" => FrameChoice::Artwork,
        "viewbox" => FrameChoice::ViewBox,
        "ink" => FrameChoice::Lettering(LetteringFrame::Ink),
        "baseline-ascent" => FrameChoice::Lettering(LetteringFrame::BaselineAscent),
        "baseline-capheight" => FrameChoice::Lettering(LetteringFrame::BaselineCapHeight),
        "baseline-xheight" => FrameChoice::Lettering(LetteringFrame::BaselineXHeight),
        "ascent-descent" => FrameChoice::Lettering(LetteringFrame::AscentDescent),
        t => FrameChoice::Rect(rect(t)?),
    })
}

/// Parses a box, `X,Y,W,H`.
pub fn rect(text: &str) -> Result<TypedBox, String> {
    let lengths: Result<Vec<Length>, _> = text.split(',').map(str::parse).collect();
    let lengths = lengths.ok().filter(|all| all.iter().all(|l| l.unit != LengthUnit::Percent));
    match lengths.as_deref() {
        Some(&[x, y, w, h]) if w.value > 0.0 && h.value > 0.0 => Ok(TypedBox([x, y, w, h])),
        _ => Err(format!(
            "`{text}` is not one of artwork, viewbox, X,Y,W,H (lengths; W and H positive) or, for lettering, \
             baseline-ascent, baseline-capheight, baseline-xheight, ascent-descent, ink"
        )),
    }
}

/// Parses a family's name.
pub(super) fn family_name(text: &str) -> Result<String, String> {
    let name = text.trim().trim_matches(['"', '\'']);
    if name.is_empty() { Err("the name is empty".into()) } else { Ok(name.to_owned()) }
}
