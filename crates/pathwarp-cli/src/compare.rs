//! `pathwarp compare A.svg B.svg`: how far two drawings are apart, path by path and pixel by pixel.

use crate::failure::Failure;
use crate::{Outcome, deform, output};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use pathwarp::distance;
use pathwarp_raster::{Color, RenderOptions, Size};
use pathwarp_svg::NamedPath;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::PathBuf;

/// A difference of this much in a channel is seen.
const VISIBLE: u8 = 16;

pub(crate) fn command() -> Command {
    let file =
        |name: &'static str| Arg::new(name).required(true).value_parser(value_parser!(PathBuf)).help("An SVG file");
    let limit = |name: &'static str, value: &'static str, help: &'static str| {
        Arg::new(name).long(name).value_name(value).value_parser(value_parser!(f64)).help(help)
    };
    Command::new("compare")
        .about("Measure how far two drawings are apart, path by path and pixel by pixel")
        .arg(file("A"))
        .arg(file("B"))
        .arg(
            Arg::new("width")
                .long("width")
                .value_name("PX")
                .value_parser(value_parser!(u32).range(1..))
                .default_value("1000")
                .help("Width of the pictures that are compared"),
        )
        .arg(limit("max-distance", "D", "Exit with 1 if a path differs by more, in user units"))
        .arg(limit("max-pixels", "SHARE", "Exit with 1 if more than this share of the pixels differs visibly (0 to 1)"))
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("As JSON"))
        .after_help(
            "Paths of the same id are compared: the largest distance from a point of one to the other, both ways. A pixel \
             differs visibly when a channel is off by more than 16 of 255.\n\nExample:\n  pathwarp compare before.svg after.svg",
        )
}

#[derive(Serialize)]
struct Comparison {
    paths: Vec<PathPair>,
    only_in_a: Vec<String>,
    only_in_b: Vec<String>,
    max_distance: f64,
    pixels: Pixels,
}

#[derive(Serialize)]
struct PathPair {
    id: String,
    segments_a: usize,
    segments_b: usize,
    /// `None`: one of them is empty.
    distance: Option<f64>,
}

#[derive(Serialize)]
struct Pixels {
    width: u32,
    height: u32,
    max_channel: u8,
    mean: f64,
    visible_share: f64,
}

pub(crate) fn run(m: &ArgMatches) -> Result<Outcome, Failure> {
    let file = |name: &str| m.get_one::<PathBuf>(name).cloned().ok_or_else(|| Failure::usage("two files are needed"));
    let (a, b) = (deform::document(&file("A")?)?, deform::document(&file("B")?)?);
    let (paths_a, paths_b) = (a.paths(), b.paths());
    // The first of an id counts, as for every reader of SVG.
    let by_id = |paths: &[NamedPath]| -> HashMap<String, usize> {
        paths.iter().enumerate().rev().map(|(i, p)| (p.id.clone(), i)).collect()
    };
    let (index_a, index_b) = (by_id(&paths_a), by_id(&paths_b));
    let pairs: Vec<PathPair> = paths_a
        .par_iter()
        .filter_map(|p| index_b.get(&p.id).map(|i| (p, &paths_b[*i])))
        .map(|(p, q)| PathPair {
            id: p.id.clone(),
            segments_a: p.outline.segs().count(),
            segments_b: q.outline.segs().count(),
            distance: distance::symmetric(&p.outline, &q.outline),
        })
        .collect();
    let missing = |from: &[NamedPath], to: &HashMap<String, usize>| -> Vec<String> {
        from.iter().filter(|p| !to.contains_key(&p.id)).map(|p| p.id.clone()).collect()
    };
    let size = Size::Width(m.get_one::<u32>("width").copied().unwrap_or(1000));
    let render = |d: &pathwarp_svg::Document| RenderOptions { size, background: Some(Color::WHITE) }.render(d.tree());
    let difference = pathwarp_raster::compare(&render(&a)?, &render(&b)?)?;
    let result = Comparison {
        max_distance: pairs.iter().filter_map(|p| p.distance).fold(0.0, f64::max),
        only_in_a: missing(&paths_a, &index_b),
        only_in_b: missing(&paths_b, &index_a),
        paths: pairs,
        pixels: Pixels {
            width: difference.width,
            height: difference.height,
            max_channel: difference.max_channel,
            mean: difference.mean_abs,
            visible_share: difference.share_over(VISIBLE),
        },
    };
    let text = if m.get_flag("json") {
        serde_json::to_string_pretty(&result).map_err(|e| Failure::usage(e.to_string()))? + "\n"
    } else {
        table(&result)
    };
    output::to_stdout(text.as_bytes())?;
    let over = |name: &str, value: f64| m.get_one::<f64>(name).is_some_and(|most| value > *most);
    let apart = over("max-distance", result.max_distance) || over("max-pixels", result.pixels.visible_share);
    Ok(if apart { Outcome::Partly } else { Outcome::Done })
}

fn table(c: &Comparison) -> String {
    let mut out = String::new();
    let width = c.paths.iter().map(|p| p.id.chars().count()).max().unwrap_or(0).max(4);
    let _ = writeln!(out, "{:width$}  segments      distance", "id");
    for p in &c.paths {
        let d = p.distance.map_or_else(|| "empty".to_owned(), |d| format!("{d:.6}"));
        let _ = writeln!(out, "{:width$}  {:>4} {:>4}  {d:>12}", p.id, p.segments_a, p.segments_b);
    }
    for (name, ids) in [("first", &c.only_in_a), ("second", &c.only_in_b)] {
        if !ids.is_empty() {
            let _ = writeln!(out, "only in the {name}: {}", ids.join(", "));
        }
    }
    let _ = writeln!(out, "largest distance: {:.6}", c.max_distance);
    let p = &c.pixels;
    let _ = writeln!(
        out,
        "pixels ({} x {}): {:.4} % differ visibly, mean {:.4}/255, largest {}/255",
        p.width,
        p.height,
        p.visible_share * 100.0,
        p.mean,
        p.max_channel
    );
    out
}
