//! Warps of Photoshop layers, as the command line hands them over: JSON made of the file's warp descriptors.

use super::quilt::{File, Quilt};
use crate::deform::built::Built;
use crate::deform::warp::{self, Bent, Style};
use crate::error::Error;
use crate::param::Settings;
use kurbo::Rect;
use serde::Deserialize;

/// What the file holds.
#[derive(Deserialize)]
#[serde(untagged)]
enum Warps {
    All {
        warps: Vec<Warp>,
    },
    /// A file written by hand needs no list.
    One(Warp),
}

/// A layer's warp: the fields of its descriptor.
#[derive(Deserialize)]
struct Warp {
    #[serde(default)]
    layer: String,
    #[serde(alias = "warpStyle")]
    style: String,
    /// Percent.
    #[serde(default, alias = "warpValue")]
    value: f64,
    #[serde(default, alias = "warpPerspective")]
    perspective: f64,
    #[serde(default, alias = "warpPerspectiveOther")]
    perspective_other: f64,
    #[serde(default)]
    vertical: bool,
    /// Its points, of a custom warp.
    mesh: Option<File>,
}

pub(super) enum Found {
    /// A style, set up.
    Style(Built),
    /// A quilt, and its layer's name.
    Quilt(Quilt, String),
}

/// The warp of the layer asked for, over `region`.
pub(super) fn read(s: &Settings<'_>, region: Rect) -> Result<Found, Error> {
    let Some(file) = s.file_if("psd")? else {
        return Err(Error::Missing { param: "psd".into(), hint: "a Photoshop file".into() });
    };
    let parsed: Warps = serde_json::from_str(&file.text).map_err(|_| {
        Error::input(
            &file.name,
            "is neither a Photoshop file nor JSON of a warp: {\"style\": \"warpArc\", \"value\": 50}",
        )
    })?;
    let warps = match parsed {
        Warps::All { warps } => warps,
        Warps::One(warp) => vec![warp],
    };
    let wrong = |what: String| Error::input(&file.name, what);
    let wanted = s.texts("layer").last().copied();
    let listed = warps.iter().map(|w| format!("`{}` ({})", w.layer, w.style)).collect::<Vec<_>>().join(", ");
    let mut fits = warps.into_iter().filter(|w| wanted.map_or(w.style != "warpNone", |l| w.layer == l));
    let warp = match (fits.next(), fits.next()) {
        (Some(one), None) => one,
        (None, _) if listed.is_empty() => return Err(wrong("has no layer with a warp".into())),
        (None, _) => return Err(wrong(format!("has no such warped layer; there are {listed}"))),
        (Some(_), Some(_)) => {
            return Err(wrong(format!("has several warped layers; say which with `layer`: {listed}")));
        }
    };
    if let Some(mesh) = warp.mesh {
        return Ok(Found::Quilt(Quilt::from_file(&file.name, mesh, region)?.on(region), warp.layer));
    }
    let style = Style::named(&warp.style).ok_or_else(|| {
        wrong(format!("layer `{}` has the warp {}, which has no known formula", warp.layer, warp.style))
    })?;
    let bent = Bent {
        bend: warp.value / 100.0,
        distortion: [warp.perspective / 100.0, warp.perspective_other / 100.0],
        vertical: warp.vertical,
    };
    let net = style.net(region.width(), region.height(), &bent).map_err(|e| wrong(format!("its style {e}")))?;
    let mut built = warp::over(region, &net)?;
    built.note(format!("layer {}: style {}, bend {}%", warp.layer, style.name(), warp.value));
    Ok(Found::Style(built))
}
