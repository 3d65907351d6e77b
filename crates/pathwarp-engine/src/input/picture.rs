//! Photographs (PNG, JPEG, WebP) as artwork: warped pixel by pixel, by the same maps as a drawing.

use super::artwork::{self, Artwork, Baseline, FileArtwork, WarpRequest, WarpedArtwork, WarpedResult, Which};
use super::crop::{Crop, Source};
use super::files::{display, no_document};
use super::proportions::Proportions;
use crate::advice;
use crate::bitmap::{self, Pixel, ROUNDING, inverse};
use crate::failure::Failure;
use crate::format::{Choice, PICTURES};
use crate::options::{CommonOptions, FrameChoice};
use crate::page::PageNews;
use pathwarp::budget::{Budget, Exceeded};
use pathwarp::engine::BuiltParts;
use pathwarp::kurbo::{Affine, Point, Rect};
use pathwarp::map::Map;
use pathwarp::param::Frame;
use pathwarp::recipe::Step;
use pathwarp::{Error, Outline, fold};
use pathwarp_raster::{Extent, ImageWarp, Picture, PictureFormat, Pixmap, extent, header_size, shown, warp_image};
use pathwarp_svg::{OnError, PageFit};
use std::path::Path;
use std::sync::Arc;

/// A photograph. Its plane is in pixels, with the origin at the top left corner.
pub(crate) struct PictureArtwork {
    name: String,
    picture: Picture,
    format: PictureFormat,
    budget: Arc<Budget>,
    /// The picture's rectangle as an outline.
    outline: Outline,
}

impl PictureArtwork {
    pub(super) fn read(
        bytes: &[u8],
        input: &Path,
        options: &CommonOptions,
        target: Option<&Path>,
    ) -> Result<Self, Failure> {
        let format = Choice { what: "a picture is", among: PICTURES }.format(target, options.format)?;
        let format = format
            .of_picture(options.quality)
            .ok_or_else(|| Failure::usage("the format is not one of pictures; choose png, jpg or webp"))?;
        let name = display(input);
        for (given, option) in [
            (!options.select.is_empty(), "select"),
            (!options.exclude.is_empty(), "exclude"),
            (options.embed_recipe, "embed-recipe"),
            (options.preview.is_some(), "preview"),
            (options.page == PageFit::Shrink, "fit shrink"),
            (matches!(options.page, PageFit::Sheet(_)), "fit with a sheet of paper"),
            (options.page_width.is_some() || options.page_height.is_some(), "page-width"),
            (options.kerf.is_some(), "kerf"),
        ] {
            if given {
                return Err(Failure::usage(format!("--{option} is for SVG files; {name} is a picture")));
            }
        }
        let budget = Budget::new(options.reading.limits.for_input(bytes.len()));
        let (width, height) = header_size(bytes)?;
        let size = (f64::from(width), f64::from(height));
        let counted = bitmap::count_picture(&budget, Pixel::Decoded, size);
        counted.map_err(|e| Failure::Limited(too_much("reading a picture", size, &e, ""), e, 3))?;
        let picture = Picture::read_within(bytes, &budget.limits())?;
        if let Some(end) = picture.early_end.filter(|_| options.on_failure.of_shapes() == OnError::Stop) {
            let advice = "get a whole copy of it, or take what is there with --on-error skip";
            return Err(Failure::Input(format!("{name} {end}; {advice}")));
        }
        let (width, height) = (f64::from(picture.pixmap.width()), f64::from(picture.pixmap.height()));
        let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)].map(Point::from);
        Ok(Self { name, picture, format, budget: Arc::new(budget), outline: Outline::from_points(&corners, true) })
    }

    fn area(&self) -> Rect {
        Rect::new(0.0, 0.0, f64::from(self.picture.pixmap.width()), f64::from(self.picture.pixmap.height()))
    }

    /// Returns the part of the plane that `--fit` shows, and a point of the picture where the map is undefined, if any.
    fn page(&self, map: &Arc<dyn Map>, options: &CommonOptions) -> Result<(Rect, Option<Point>), Failure> {
        let area = self.area();
        let Extent { bounds, undefined, .. } = extent(area, Affine::IDENTITY, &**map, Affine::IDENTITY)
            .ok_or_else(|| Failure::Geometry(undefined_at(area.center())))?;
        if let Some(p) = undefined.filter(|_| options.on_failure.of_shapes() == OnError::Stop) {
            return Err(Failure::Geometry(format!("{}; --on-error skip leaves that part out", undefined_at(p))));
        }
        let page = match options.page {
            PageFit::None => area,
            PageFit::Grow => area.union(bounds),
            _ => bounds,
        };
        Ok((page, undefined))
    }

    /// Returns the size of a straightened frame: at `--ratio`, in its true proportions if they are reliable, or else by its mean sides.
    fn natural_size(&self, frame: Option<&Source>, options: &CommonOptions) -> Result<Natural, Failure> {
        let area = self.area();
        let (frame, sides) = match (frame, options.ratio) {
            (Some(frame), Some(sides)) => (frame, sides),
            (Some(frame), None) => {
                let seen = frame.proportions(area);
                return Ok((Some(frame.size_at(seen.map(|p| p.ratio))), seen));
            }
            (None, Some(_)) => {
                let advice = "with --crop, --size sets the size of others";
                let problem = "--ratio is for a frame that is straightened to an upright rectangle";
                return Err(Failure::usage(format!("{problem}; {advice}")));
            }
            (None, None) => return Ok((None, None)),
        };
        if matches!(options.image_size, Some((_, Some(_)))) {
            return Err(Failure::usage("--ratio and --size WxH both set the proportions; give --size a width alone"));
        }
        Ok((Some(frame.size_at(Some(frame.oriented(sides, area)))), None))
    }
}

/// The size of a straightened frame in pixels, and its proportions, if the photograph determines them.
type Natural = (Option<(f64, f64)>, Option<Proportions>);

fn undefined_at(p: Point) -> String {
    format!("the map is undefined on part of the picture, such as at {:.4},{:.4}", p.x, p.y)
}

impl Artwork for PictureArtwork {
    fn path_named(&self, name: &str) -> Result<Outline, Error> {
        Err(no_document(name))
    }

    fn remove_guides(&mut self, _guides: Vec<String>) {}

    fn divide(&mut self, _steps: &[Step]) -> Result<Vec<Vec<usize>>, Failure> {
        Err(Failure::usage("--select and --exclude are for drawings; a picture has no parts to name"))
    }

    fn bounding_box(&self, _which: Which) -> Option<Rect> {
        Some(self.area())
    }

    fn frame(&self, _: Which, choice: FrameChoice, _: Option<Rect>, _: Baseline) -> Result<Frame, Failure> {
        match choice {
            FrameChoice::Default | FrameChoice::Artwork | FrameChoice::ViewBox => Ok(Frame::new(self.area())),
            FrameChoice::Rect(r) => Ok(Frame::new(r.rect(self.units_per_px()))),
            FrameChoice::Lettering(_) => {
                Err(Failure::usage("--frame: a photograph has no lettering to put a frame around; give X,Y,W,H"))
            }
        }
    }

    fn budget(&self) -> &Arc<Budget> {
        &self.budget
    }

    fn outlines(&self, _which: Which) -> Vec<&Outline> {
        vec![&self.outline]
    }
}

impl FileArtwork for PictureArtwork {
    fn file_name(&self) -> String {
        self.name.clone()
    }

    fn warp(&self, request: &WarpRequest<'_>) -> Result<WarpedArtwork, Failure> {
        let WarpRequest { built: BuiltParts { whole: built, .. }, options, .. } = request;
        if request.edit.is_some() {
            return Err(Failure::usage(advice::NO_PATHS_TO_EDIT));
        }
        if !built.placement.copies.is_empty() {
            let problem = "the deformation repeats the artwork, which works for drawings only, not for pictures";
            return Err(Failure::usage(problem));
        }
        let area = self.area();
        let map: Arc<dyn Map> = Arc::new(built.map.clone());
        let inverse = inverse(&map, area, &self.budget);
        let mut warnings: Vec<String> = self.picture.early_end.iter().map(|end| format!("the picture {end}")).collect();
        let crop = if options.crop { Some(Crop::of(built, request.recipe)?) } else { None };
        let source = crop.as_ref().and_then(|c| c.source(&inverse));
        let (bounds, undefined) = match &crop {
            Some(crop) => (crop.bounds, None),
            None => self.page(&map, options)?,
        };
        warnings.extend(undefined.map(undefined_at));
        let orientation = fold::orientation(source.as_ref().map_or(&self.outline, |s| &s.outline), true, &*map);
        let fold = orientation.folded_against(&orientation).filter(|_| built.steps.iter().all(|s| s.hidden.is_none()));
        warnings.extend(fold.map(|at| artwork::fold_warning("the picture", &[], at)));
        let (natural, proportions) = self.natural_size(source.as_ref(), options)?;
        let (visible, size) = size(bounds, natural, options.image_size)?;
        let smaller = "give a smaller --size, or ";
        let too_much = |e| Failure::Limited(too_much("warping it to a picture", size, &e, smaller), e, 4);
        bitmap::count_picture(&self.budget, Pixel::Warped, size).map_err(too_much)?;
        let size = (size.0 as u32, size.1 as u32);
        let warp = ImageWarp {
            source: &self.picture.pixmap,
            placed: Affine::IDENTITY,
            map: &*map,
            inverse: &inverse,
            shown: shown(visible, size),
            size,
        };
        let pixmap = warp_image(&warp)?;
        self.budget.exceeded().map_or(Ok(()), |e| Err(too_much(e)))?;
        let is_visible = |p: &Pixmap| p.pixels().iter().any(|c| c.alpha() > 0);
        if is_visible(&self.picture.pixmap) && !is_visible(&pixmap) {
            warnings.push("nothing of the picture is in the result".to_owned());
        }
        let warped = self.picture.remade(pixmap, options.keep_location);
        let lost = [
            (self.picture.profile.is_some() && warped.profile.is_none(), "the colour profile is not one for RGB"),
            (self.picture.exif.is_some() && warped.exif.is_none(), "the EXIF data are damaged or too long"),
        ];
        warnings.extend(lost.into_iter().filter(|(is, _)| *is).map(|(_, why)| format!("{why}; the result has none")));
        Ok(WarpedArtwork {
            filters: Default::default(),
            result: WarpedResult::Bytes(warped.write(self.format)?),
            shapes: Vec::new(),
            skipped: Vec::new(),
            warnings,
            page: PageNews::default(),
            tolerance: None,
            files: Vec::new(),
            preview: None,
            kerf: None,
            proportions,
            partial: undefined.is_some() || self.picture.early_end.is_some(),
        })
    }
}

/// Returns the message about a picture of this size that exceeds a limit.
fn too_much(what: &str, (width, height): (f64, f64), e: &Exceeded, advice: &str) -> String {
    format!("{what} of {width:.0} x {height:.0} pixels takes {e}; {advice}{}", advice::raise(e))
}

/// Returns the part of the plane that the result shows, and its size in pixels: by default `natural`, or else one pixel per unit.
fn size(
    bounds: Rect,
    natural: Option<(f64, f64)>,
    wanted: Option<(u32, Option<u32>)>,
) -> Result<(Rect, (f64, f64)), Failure> {
    let shown = match wanted {
        None if natural.is_none() => Rect::new(
            (bounds.x0 + ROUNDING).floor(),
            (bounds.y0 + ROUNDING).floor(),
            (bounds.x1 - ROUNDING).ceil(),
            (bounds.y1 - ROUNDING).ceil(),
        ),
        _ => bounds,
    };
    if shown.width() <= 0.0 || shown.height() <= 0.0 {
        return Err(Failure::Geometry("the warped picture has no area".to_owned()));
    }
    let (width, height) = natural.unwrap_or((shown.width(), shown.height()));
    let pixels = |length: f64| length.round().max(1.0);
    let size = match wanted {
        None => (pixels(width), pixels(height)),
        Some((w, Some(h))) => (f64::from(w), f64::from(h)),
        Some((w, None)) => (f64::from(w), pixels(f64::from(w) * height / width)),
    };
    Ok((shown, size))
}
