//! Photographs (PNG, JPEG, WebP) as artwork: warped pixel by pixel, by the same maps as a drawing.

use super::artwork::{self, Artwork, Baseline, FileArtwork, WarpRequest, WarpedArtwork, WarpedResult, Which};
use super::files::{display, no_document};
use crate::advice;
use crate::bitmap::{self, Pixel, ROUNDING, inverse};
use crate::failure::Failure;
use crate::format::{Choice, PICTURES};
use crate::options::{CommonOptions, FrameChoice};
use crate::page::PageNews;
use pathwarp::budget::{Budget, Exceeded};
use pathwarp::kurbo::{Affine, Point, Rect};
use pathwarp::map::Map;
use pathwarp::param::Frame;
use pathwarp::recipe::{BuiltParts, Step};
use pathwarp::{Error, Outline, fold};
use pathwarp_raster::{Extent, ImageWarp, Picture, PictureFormat, extent, header_size, shown, warp_image};
use pathwarp_svg::OnError;
use std::path::Path;
use std::sync::Arc;

/// A photograph. Its plane is in pixels, with the origin at its top left corner.
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
        let format = format.of_picture(options.quality).unwrap_or_default();
        let name = display(input);
        for (given, option) in [
            (!options.select.is_empty(), "select"),
            (!options.exclude.is_empty(), "exclude"),
            (options.embed_recipe, "embed-recipe"),
            (options.preview.is_some(), "preview"),
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
        let (width, height) = (f64::from(picture.pixmap.width()), f64::from(picture.pixmap.height()));
        let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)].map(Point::from);
        Ok(Self { name, picture, format, budget: Arc::new(budget), outline: Outline::from_points(&corners, true) })
    }

    fn area(&self) -> Rect {
        Rect::new(0.0, 0.0, f64::from(self.picture.pixmap.width()), f64::from(self.picture.pixmap.height()))
    }
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
        if let Some(edit) = &options.edit {
            return Err(Failure::usage(format!(
                "{} works on the paths of drawings; a picture has none",
                edit.info.name
            )));
        }
        if !built.placement.copies.is_empty() {
            return Err(Failure::usage(
                "the deformation repeats the artwork, which works for drawings only, not for pictures",
            ));
        }
        let area = self.area();
        let map: Arc<dyn Map> = Arc::new(built.map.clone());
        let mut warnings = Vec::new();
        let undefined_at =
            |p: Point| format!("the map is undefined on part of the picture, such as at {:.4},{:.4}", p.x, p.y);
        let Extent { bounds, undefined, .. } = extent(area, Affine::IDENTITY, &*map, Affine::IDENTITY)
            .ok_or_else(|| Failure::Geometry(undefined_at(area.center())))?;
        if let Some(p) = undefined {
            if options.on_failure.of_shapes() == OnError::Stop {
                return Err(Failure::Geometry(format!("{}; --on-error skip leaves that part out", undefined_at(p))));
            }
            warnings.push(undefined_at(p));
        }
        let orientation = fold::orientation(&self.outline, true, &*map);
        warnings
            .extend(orientation.folded_against(&orientation).map(|at| artwork::fold_warning("the picture", &[], at)));
        let (visible, size) = size(bounds, options.image_size)?;
        let smaller = "give a smaller --image-size, or ";
        let too_much = |e| Failure::Limited(too_much("warping it to a picture", size, &e, smaller), e, 4);
        bitmap::count_picture(&self.budget, Pixel::Warped, size).map_err(too_much)?;
        let size = (size.0 as u32, size.1 as u32);
        let inverse = inverse(&map, area, &self.budget);
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
        let warped = Picture { pixmap, profile: self.picture.profile.clone() };
        Ok(WarpedArtwork {
            result: WarpedResult::Bytes(warped.write(self.format)?),
            shapes: Vec::new(),
            skipped: Vec::new(),
            warnings,
            page: PageNews::default(),
            files: Vec::new(),
            preview: None,
            partial: undefined.is_some(),
        })
    }
}

/// The message about a picture of this size that takes too much.
fn too_much(what: &str, (width, height): (f64, f64), e: &Exceeded, advice: &str) -> String {
    format!("{what} of {width:.0} x {height:.0} pixels takes {e}; {advice}{}", advice::raise(e))
}

/// The part of the plane that the result shows, and its size in pixels: by default one pixel per unit of the plane.
fn size(bounds: Rect, wanted: Option<(u32, Option<u32>)>) -> Result<(Rect, (f64, f64)), Failure> {
    let shown = match wanted {
        None => Rect::new(
            (bounds.x0 + ROUNDING).floor(),
            (bounds.y0 + ROUNDING).floor(),
            (bounds.x1 - ROUNDING).ceil(),
            (bounds.y1 - ROUNDING).ceil(),
        ),
        Some(_) => bounds,
    };
    if shown.width() <= 0.0 || shown.height() <= 0.0 {
        return Err(Failure::Geometry("the warped picture has no area".to_owned()));
    }
    let (width, height) = match wanted {
        None => (shown.width(), shown.height()),
        Some((w, Some(h))) => (f64::from(w), f64::from(h)),
        Some((w, None)) => (f64::from(w), (f64::from(w) * shown.height() / shown.width()).round().max(1.0)),
    };
    Ok((shown, (width, height)))
}
