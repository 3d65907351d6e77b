//! `pathwarp DEFORMATION photo.png -o out.png`: a photograph under the same maps as a drawing.

use crate::common::{Common, FrameChoice};
use crate::deform::{Job, display};
use crate::failure::Failure;
use crate::output::Pending;
use crate::reference::References;
use crate::report;
use pathwarp::Outline;
use pathwarp::deform::Registry;
use pathwarp::kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::map::{Map, NewtonInverse};
use pathwarp::param::Frame;
use pathwarp::recipe::Recipe;
use pathwarp_raster::{Extent, ImageWarp, Picture, PictureFormat, Shade, extent, shade, shown, warp_image};
use pathwarp_svg::{BentImage, GradientPainter, GradientRequest, ImageRequest, ImageWarper, OnError};
use std::path::Path;
use std::sync::Arc;

/// A side that is longer than whole pixels by this much is rounding.
const ROUNDING: f64 = 1e-6;

/// Warps a PNG or JPEG. Its plane is in pixels, with the picture's left top corner at 0,0.
pub(crate) fn warp(
    registry: &Registry,
    recipe: &Recipe,
    common: &Common,
    input: &Path,
    target: Option<&Path>,
    bytes: &[u8],
) -> Result<Job, Failure> {
    let format = format(target)?;
    for (given, name) in [
        (!common.select.is_empty(), "select"),
        (!common.exclude.is_empty(), "exclude"),
        (common.embed_recipe, "embed-recipe"),
        (common.preview.is_some(), "preview"),
    ] {
        if given {
            return Err(Failure::usage(format!("--{name} is for SVG files; {} is a picture", display(input))));
        }
    }
    let mut recipe = recipe.clone();
    References::new(None).resolve(registry, &mut recipe)?;
    let picture = Picture::read(bytes)?;
    let area = Rect::new(0.0, 0.0, f64::from(picture.pixmap.width()), f64::from(picture.pixmap.height()));
    let frame = match common.frame {
        FrameChoice::Default | FrameChoice::Artwork | FrameChoice::ViewBox => area,
        FrameChoice::Rect(r) => r,
        FrameChoice::Lettering(_) => {
            return Err(Failure::usage("--frame: a photograph has no lettering to lay a frame round; give X,Y,W,H"));
        }
    };
    let corners = [(0.0, 0.0), (area.x1, 0.0), (area.x1, area.y1), (0.0, area.y1)].map(Point::from);
    let artwork = Outline::from_points(&corners, true);
    let built = recipe.build(registry, Frame::new(frame), &[&artwork].into_iter()).map_err(Failure::of_recipe)?;
    if !built.placement.copies.is_empty() {
        return Err(Failure::usage("a photograph cannot be repeated; --stretch repeat is for drawings"));
    }
    let map: Arc<dyn Map> = Arc::new(built.map.clone());

    let mut warnings: Vec<String> = built.steps.iter().flat_map(|s| s.explanation.warnings.clone()).collect();
    let nowhere = |p: Point| format!("the map is not defined on all of the picture, such as at {:.4},{:.4}", p.x, p.y);
    let Extent { bounds, undefined, .. } = extent(area, Affine::IDENTITY, &*map, Affine::IDENTITY)
        .ok_or_else(|| Failure::Geometry(nowhere(area.center())))?;
    if let Some(p) = undefined {
        if common.on_error == OnError::Stop {
            return Err(Failure::Geometry(format!("{}; --on-error skip leaves that part out", nowhere(p))));
        }
        warnings.push(nowhere(p));
    }
    let (visible, size) = size(bounds, common.image_size)?;
    let inverse = inverse(&map, area);
    let warp = ImageWarp {
        source: &picture.pixmap,
        placed: Affine::IDENTITY,
        map: &*map,
        inverse: &*inverse,
        shown: shown(visible, size),
        size,
    };
    let pixmap = warp_image(&warp)?;
    let out = Picture { pixmap, profile: picture.profile }.write(format)?;

    let mut output = Vec::new();
    let mut to_stdout = None;
    match target {
        Some(t) => output.push(Pending::new(t, &out)?),
        None => to_stdout = Some(out),
    }
    for file in built.steps.iter().flat_map(|s| &s.saves) {
        output.push(Pending::new(Path::new(&file.name), file.text.as_bytes())?);
    }
    let notes = if common.explain {
        built.steps.iter().flat_map(|s| s.explanation.notes.clone()).collect()
    } else {
        Vec::new()
    };
    let report = report::Input {
        file: display(input),
        output: target.map(|t| t.display().to_string()),
        tolerance: common.tolerance_for(Some(area)),
        shapes: Vec::new(),
        skipped: Vec::new(),
        warnings,
    };
    Ok(Job { report, output, to_stdout, notes, partly: undefined.is_some() })
}

/// Whether a file of this name would hold pixels.
pub(crate) fn is_named_as_one(path: &Path) -> bool {
    path.extension().is_some() && format(Some(path)).is_ok()
}

/// What a file of this name holds.
fn format(target: Option<&Path>) -> Result<PictureFormat, Failure> {
    let Some(extension) = target.and_then(Path::extension) else { return Ok(PictureFormat::Png) };
    match extension.to_string_lossy().to_ascii_lowercase().as_str() {
        "png" => Ok(PictureFormat::Png),
        "jpg" | "jpeg" => Ok(PictureFormat::Jpeg),
        other => Err(Failure::usage(format!("a picture is written as .png or .jpg, not as .{other}"))),
    }
}

/// The part of the plane that the result shows, and in how many pixels: by default one per pixel of the source's plane.
fn size(bounds: Rect, wanted: Option<(u32, Option<u32>)>) -> Result<(Rect, (u32, u32)), Failure> {
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
    if width * height > f64::from(pathwarp_raster::MAX_PIXELS) {
        return Err(Failure::Geometry(format!(
            "the warped picture would have {width:.0} x {height:.0} pixels, more than {}; give --image-size",
            pathwarp_raster::MAX_PIXELS
        )));
    }
    Ok((shown, (width as u32, height as u32)))
}

/// Bends the bitmaps in drawings.
pub struct Bender {
    map: Arc<dyn Map>,
    /// Pixels per inch; `None`: as many as keep every detail.
    dpi: Option<f64>,
}

impl Bender {
    /// For one map, at so many pixels per inch; `None`: as many as keep every detail.
    #[must_use]
    pub fn new(map: Arc<dyn Map>, dpi: Option<f64>) -> Self {
        Self { map, dpi }
    }
}

impl ImageWarper for Bender {
    fn warp(&self, r: &ImageRequest<'_>) -> Result<BentImage, String> {
        /// Where the map squeezes, more pixels are needed everywhere to keep what is there; at most so many times as many.
        const GROWTH: f64 = 4.0;
        /// And never more than this: the file holds them as text.
        const MOST: f64 = 16e6;
        let picture = Picture::read_stored(r.data).map_err(|e| e.to_string())?;
        let area = Rect::new(0.0, 0.0, f64::from(picture.pixmap.width()), f64::from(picture.pixmap.height()));
        let nowhere = "the map is not defined on all of it";
        let e = extent(area, r.placed, r.map, r.after).filter(|e| e.undefined.is_none()).ok_or(nowhere)?;
        let (width, height) = (e.bounds.width(), e.bounds.height());
        if !(width > 0.0 && height > 0.0) {
            return Err("nothing is left of its area".to_owned());
        }
        let most = (GROWTH * area.area()).clamp(1.0, MOST);
        let finest = (most / (width * height)).sqrt();
        let wanted = match self.dpi {
            Some(dpi) => {
                let unit = (r.to_px * r.after.inverse()).determinant().abs().sqrt();
                (dpi / PX_PER_INCH * unit).min((MOST / (width * height)).sqrt())
            }
            None => (1.0 / e.squeeze).min(finest),
        };
        let pixels = |length: f64| (length * wanted - ROUNDING).ceil().clamp(1.0, MOST);
        let size = (pixels(width), pixels(height));
        let inverse = inverse(&self.map, r.placed.transform_rect_bbox(area));
        let warp = ImageWarp {
            source: &picture.pixmap,
            placed: r.placed,
            map: r.map,
            inverse: &*inverse,
            shown: r.after.inverse() * shown(e.bounds, (size.0 as u32, size.1 as u32)),
            size: (size.0 as u32, size.1 as u32),
        };
        let pixmap = warp_image(&warp).map_err(|e| e.to_string())?;
        let png = Picture { pixmap, profile: picture.profile }.write(PictureFormat::Png).map_err(|e| e.to_string())?;
        Ok(BentImage { png, area: e.bounds })
    }
}

impl GradientPainter for Bender {
    fn paint(&self, r: &GradientRequest<'_>) -> Result<BentImage, String> {
        /// Samples per pixel of the drawing, each way: what a screen of twice the density shows.
        const DENSITY: f64 = 2.0;
        /// At least so many along the longer side: small drawings are made to be shown larger.
        const LEAST: f64 = 256.0;
        /// And never more than this in all: the file holds them as text.
        const MOST: f64 = 2e6;
        /// Nor in all pictures of a drawing.
        const MOST_TOGETHER: f64 = 64e6;
        /// Pixels around the shape, for renderers that interpolate.
        const AROUND: f64 = 2.0;
        let (width, height) = (r.target.width(), r.target.height());
        if !(width > 0.0 && height > 0.0 && (width + height).is_finite()) {
            return Err("nothing is left of the shape's area".to_owned());
        }
        let unit = (r.to_px * r.after.inverse()).determinant().abs().sqrt();
        let wanted = match self.dpi {
            Some(dpi) => dpi / PX_PER_INCH * unit,
            None => (DENSITY * unit).max(LEAST / width.max(height)),
        };
        let most = MOST.min(MOST_TOGETHER / r.among.max(1) as f64);
        let wanted = wanted.min((most / (width * height)).sqrt()).min(most / width.max(height));
        let pixels = |length: f64| (length * wanted + 2.0 * AROUND).ceil().clamp(1.0, MOST);
        let size = (pixels(width), pixels(height));
        let target = Rect::from_center_size(r.target.center(), (size.0 / wanted, size.1 / wanted));
        let size = (size.0 as u32, size.1 as u32);
        let inverse = inverse(&self.map, r.placed.transform_rect_bbox(r.area));
        let pixmap = shade(&Shade {
            color: r.color,
            placed: r.placed,
            inverse: &*inverse,
            shown: r.after.inverse() * shown(target, size),
            size,
        });
        let picture = Picture { pixmap: pixmap.map_err(|e| e.to_string())?, profile: None };
        Ok(BentImage { png: picture.write(PictureFormat::Png).map_err(|e| e.to_string())?, area: target })
    }
}

/// Pixels per inch of a drawing at 100 %.
const PX_PER_INCH: f64 = 96.0;

/// The map's own inverse if it knows all of `area`, or Newton's method over it.
fn inverse(map: &Arc<dyn Map>, area: Rect) -> Arc<dyn Map> {
    /// Beyond the picture by this share of its diagonal: what the pixels along its edge cover.
    const REACH: f64 = 0.02;
    /// Places along a side where the inverse is tried.
    const TRIED: usize = 9;
    let diagonal = area.width().hypot(area.height());
    let returns = |inverse: &Arc<dyn Map>| {
        let at = |i: usize| (i as f64 + 0.5) / TRIED as f64;
        let places = (0..TRIED * TRIED).map(|k| (at(k % TRIED), at(k / TRIED)));
        let places = places.map(|(u, v)| area.origin() + Vec2::new(u * area.width(), v * area.height()));
        places.filter(|p| map.point(*p).is_finite()).all(|p| inverse.point(map.point(p)).distance(p) < 1e-3 * diagonal)
    };
    let own = map.inverse().filter(returns);
    own.unwrap_or_else(|| Arc::new(NewtonInverse::over(Arc::clone(map), area, REACH)))
}
