//! `pathwarp DEFORMATION photo.png -o out.png`: a photograph under the same maps as a drawing.

use crate::common::{Common, FrameChoice};
use crate::deform::{Job, display};
use crate::failure::Failure;
use crate::output::Pending;
use crate::reference::References;
use crate::report;
use pathwarp::Outline;
use pathwarp::deform::Registry;
use pathwarp::kurbo::{Affine, Point, Rect};
use pathwarp::map::{Map, NewtonInverse};
use pathwarp::param::Frame;
use pathwarp::recipe::Recipe;
use pathwarp_raster::{Extent, ImageWarp, Picture, PictureFormat, extent, warp_image};
use pathwarp_svg::OnError;
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
        FrameChoice::Artwork | FrameChoice::ViewBox => area,
        FrameChoice::Rect(r) => r,
    };
    let corners = [(0.0, 0.0), (area.x1, 0.0), (area.x1, area.y1), (0.0, area.y1)].map(Point::from);
    let artwork = Outline::from_points(&corners, true);
    let built = recipe.build(registry, Frame::new(frame), &[&artwork].into_iter())?;
    let map: Arc<dyn Map> = Arc::new(built.map.clone());

    let mut warnings: Vec<String> = built.steps.iter().flat_map(|s| s.warnings.clone()).collect();
    let nowhere = |p: Point| format!("the map is not defined on all of the picture, such as at {:.4},{:.4}", p.x, p.y);
    let Extent { bounds, undefined, .. } =
        extent(area, &*map).ok_or_else(|| Failure::Geometry(nowhere(area.center())))?;
    if let Some(p) = undefined {
        if common.on_error == OnError::Stop {
            return Err(Failure::Geometry(format!("{}; --on-error skip leaves that part out", nowhere(p))));
        }
        warnings.push(nowhere(p));
    }
    let (shown, size) = size(bounds, common.image_size)?;
    let inverse = inverse(&map, area);
    let warp = ImageWarp {
        source: &picture.pixmap,
        placed: Affine::IDENTITY,
        map: &*map,
        inverse: &*inverse,
        target: shown,
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
    for (file, text) in built.steps.iter().flat_map(|s| &s.saves) {
        output.push(Pending::new(Path::new(file), text.as_bytes())?);
    }
    let notes = if common.explain { built.steps.iter().flat_map(|s| s.notes.clone()).collect() } else { Vec::new() };
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

/// The map's own inverse, or Newton's method over the picture.
fn inverse(map: &Arc<dyn Map>, area: Rect) -> Arc<dyn Map> {
    /// Beyond the picture by this share of its diagonal: what the pixels along its edge cover.
    const REACH: f64 = 0.02;
    /// Enough starts for a map that bends a few times across the picture.
    const PIECES: [usize; 2] = [6, 6];
    let reach = REACH * area.width().hypot(area.height());
    map.inverse().unwrap_or_else(|| Arc::new(NewtonInverse::new(Arc::clone(map), area, reach, PIECES)))
}
