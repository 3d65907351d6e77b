//! `pathwarp compare A.svg B.svg`: measures the distance between two drawings, path by path and pixel by pixel.

use crate::arguments::{self, reading_args};
use crate::commands::args::{file_arg, given_file, option, switch};
use crate::ending::Status;
use crate::terminal;
use clap::{ArgMatches, Command, value_parser};
use pathwarp::budget::Exceeded;
use pathwarp::distance;
use pathwarp::kurbo::Rect;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::{input, output, readable};
use pathwarp_raster::{Color, Pixmap, RenderOptions, Size};
use pathwarp_svg::{Document, NamedPath, usvg_tree};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;
use std::sync::Arc;

/// Smallest visible difference of a colour channel, of 255.
const VISIBLE: u8 = 16;

pub(super) fn compare_command() -> Command {
    let limit = |name, value, help| option(name, value, help).value_parser(value_parser!(f64));
    Command::new("compare")
        .about("Measure the distance between two drawings, path by path and pixel by pixel")
        .arg(file_arg("A", "An SVG file"))
        .arg(file_arg("B", "An SVG file"))
        .arg(
            option("width", "PX", "Width in pixels of the renderings that are compared")
                .value_parser(value_parser!(u32).range(1..))
                .default_value("1000"),
        )
        .arg(limit("max-distance", "D", "Exit with 1 if a path differs by more than this, in user units"))
        .arg(limit("max-pixels", "SHARE", "Exit with 1 if more than this fraction of the pixels differs visibly (0 to 1)"))
        .arg(switch("json", "Print JSON"))
        .args(reading_args())
        .after_help(
            "Paths with the same id are compared; paths without an id are matched by their order within the closest ancestor that \
             has one, and what is left by place: those whose boxes are nearest and overlap or nearly so. The distance is the largest \
             from a point of either path to the other path. A path without a counterpart is exit code 1. A pixel differs visibly if \
             a channel differs by more than 16 of 255.\n\nExample:\n  pathwarp compare before.svg after.svg",
        )
}

#[derive(Serialize)]
struct Comparison {
    paths: Vec<PathPair>,
    only_in_a: Vec<String>,
    only_in_b: Vec<String>,
    max_distance: f64,
    /// `None` if the pages have different proportions.
    pixels: Option<Pixels>,
}

#[derive(Serialize)]
struct PathPair {
    id: String,
    segments_a: usize,
    segments_b: usize,
    /// `None` if either path is empty.
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

pub(super) fn compare_files(m: &ArgMatches) -> Result<Status, Failure> {
    let reading = arguments::reading(m)?;
    let size = Size::Width(m.get_one::<u32>("width").copied().unwrap_or(1000));
    let options = RenderOptions { size, background: Some(Color::WHITE) };
    let read = |name: &str| -> Result<(Document, Pixmap), Failure> {
        let file = given_file(m, name)?;
        let document = input::document(file, &reading)?;
        let shown = usvg_tree::shown(&document, &input::read_options(file, &reading))?;
        let picture = options.render_counted(&shown, document.budget())?;
        Ok((document, picture))
    };
    let result = compare(&read("A")?, &read("B")?)?;
    let text = if m.get_flag("json") {
        readable::json(&result).map_err(|e| Failure::usage(e.to_string()))? + "\n"
    } else {
        table(&result)
    };
    output::to_stdout(text.as_bytes())?;
    let exceeds = |name: &str, value: f64| m.get_one::<f64>(name).is_some_and(|most| value > *most);
    // Pages of different proportions differ everywhere.
    let share = result.pixels.as_ref().map_or(f64::INFINITY, |p| p.visible_share);
    let is_beyond = exceeds("max-distance", result.max_distance) || exceeds("max-pixels", share);
    let has_unmatched = !result.only_in_a.is_empty() || !result.only_in_b.is_empty();
    Ok(Status::partial_if(is_beyond || has_unmatched))
}

fn compare((a, shown_a): &(Document, Pixmap), (b, shown_b): &(Document, Pixmap)) -> Result<Comparison, Failure> {
    let (paths_a, paths_b) = (a.paths(), b.paths());
    let mut counterparts = counterparts(&paths_a, &paths_b);
    match_by_boxes(&paths_a, &paths_b, &mut counterparts);
    let pair = |(p, counterpart): (&NamedPath, &Option<usize>)| {
        let q = &paths_b[(*counterpart)?];
        let distance = distance::symmetric_within(&p.outline, &q.outline, a.budget());
        let (segments_a, segments_b) = (p.outline.segs().count(), q.outline.segs().count());
        Some(distance.map(|distance| PathPair { id: p.id.clone(), segments_a, segments_b, distance }))
    };
    let paths: Result<Vec<PathPair>, Exceeded> = paths_a.par_iter().zip(&counterparts).filter_map(pair).collect();
    let paths = paths.map_err(|e| pathwarp::Error::limit(a.name(), "comparing it takes", e))?;
    let unpaired = paths_a.iter().zip(&counterparts).filter(|(_, i)| i.is_none());
    let only_in_a = unpaired.map(|(p, _)| p.id.clone()).collect();
    let only_in_b = unpaired_in(&paths_b, &counterparts).map(|i| paths_b[i].id.clone()).collect();
    let pixels = match pathwarp_raster::compare(shown_a, shown_b) {
        Ok(difference) => Some(Pixels {
            width: difference.width,
            height: difference.height,
            max_channel: difference.max_channel,
            mean: difference.mean_abs,
            visible_share: difference.share_over(VISIBLE),
        }),
        Err(pathwarp_raster::Error::SizesDiffer { .. }) => None,
        Err(e) => return Err(e.into()),
    };
    let max_distance = paths.iter().filter_map(|p| p.distance).fold(0.0, f64::max);
    Ok(Comparison { paths, only_in_a, only_in_b, max_distance, pixels })
}

/// Returns, for every path of `a`, the index of its counterpart in `b`: the first path with an equal id, which is the one that SVG readers
/// use. Paths without an id are matched by their order within the closest ancestor with an id or, if the drawings differ in the number of
/// such paths there, by their position in the file.
fn counterparts(a: &[NamedPath], b: &[NamedPath]) -> Vec<Option<usize>> {
    // Paths without an id by the id of that ancestor.
    let unnamed = |paths: &[NamedPath]| {
        let mut by_group: HashMap<Arc<str>, Vec<usize>> = HashMap::new();
        for (i, group) in paths.iter().enumerate().filter_map(|(i, p)| Some((i, p.group.clone()?))) {
            by_group.entry(group).or_default().push(i);
        }
        by_group
    };
    let unnamed_b = unnamed(b);
    let mut out = vec![None; a.len()];
    let mut matched: HashSet<usize> = HashSet::new();
    for (group, in_a) in unnamed(a) {
        if let Some(in_b) = unnamed_b.get(&group).filter(|in_b| in_b.len() == in_a.len()) {
            in_a.iter().zip(in_b).for_each(|(i, j)| out[*i] = Some(*j));
            matched.extend(in_b);
        }
    }
    let rest = b.iter().enumerate().rev().filter(|(j, _)| !matched.contains(j));
    let by_id: HashMap<(bool, &str), usize> = rest.map(|(j, q)| ((q.group.is_none(), q.id.as_str()), j)).collect();
    for (counterpart, p) in out.iter_mut().zip(a) {
        *counterpart = counterpart.or_else(|| by_id.get(&(p.group.is_none(), p.id.as_str())).copied());
    }
    out
}

/// Returns the paths of `b` without counterpart. A repeated id counts only once.
fn unpaired_in(b: &[NamedPath], counterparts: &[Option<usize>]) -> impl Iterator<Item = usize> {
    let paired: HashSet<usize> = counterparts.iter().flatten().copied().collect();
    let ids: HashSet<&str> = paired.iter().map(|&i| b[i].id.as_str()).collect();
    (0..b.len()).filter(move |&i| !paired.contains(&i) && (b[i].group.is_some() || !ids.contains(b[i].id.as_str())))
}

/// Matches the remaining paths by the distance of their boxes, nearest first. Boxes farther apart than half their size do not match.
fn match_by_boxes(a: &[NamedPath], b: &[NamedPath], counterparts: &mut [Option<usize>]) {
    /// Most pairs that are compared. Larger numbers of paths are matched by their order in the file.
    const MOST: usize = 4_000_000;
    let left_a: Vec<usize> = (0..a.len()).filter(|&i| counterparts[i].is_none()).collect();
    let left_b: Vec<usize> = unpaired_in(b, counterparts).collect();
    if left_a.len().saturating_mul(left_b.len()) > MOST {
        left_a.iter().zip(&left_b).for_each(|(&i, &j)| counterparts[i] = Some(j));
        return;
    }
    let boxes = |paths: &[NamedPath], left: &[usize]| -> Vec<(usize, Rect)> {
        left.iter().filter_map(|&i| Some((i, paths[i].outline.bounding_box()?))).collect()
    };
    let boxes_b = boxes(b, &left_b);
    let distance =
        |p: &Rect, q: &Rect| (p.x0 - q.x0).abs() + (p.y0 - q.y0).abs() + (p.x1 - q.x1).abs() + (p.y1 - q.y1).abs();
    let mut pairs = Vec::new();
    for (i, p) in boxes(a, &left_a) {
        let margin = 0.5 * p.width().max(p.height());
        let near = boxes_b.iter().filter(|(_, q)| p.inflate(margin, margin).overlaps(*q));
        pairs.extend(near.map(|(j, q)| (distance(&p, q), i, *j)));
    }
    pairs.sort_by(|p, q| p.0.total_cmp(&q.0).then((p.1, p.2).cmp(&(q.1, q.2))));
    let mut taken = HashSet::new();
    for (_, i, j) in pairs {
        if counterparts[i].is_none() && taken.insert(j) {
            counterparts[i] = Some(j);
        }
    }
}

fn table(c: &Comparison) -> String {
    let mut out = String::new();
    let ids: Vec<_> = c.paths.iter().map(|p| readable::safe_name(&p.id)).collect();
    let width = terminal::column(ids.iter().map(AsRef::as_ref));
    let _ = writeln!(out, "{:width$}  segments      distance", "id");
    for (p, id) in c.paths.iter().zip(ids) {
        let d = p.distance.map_or_else(|| "empty".to_owned(), |d| format!("{d:.6}"));
        let _ = writeln!(out, "{id:width$}  {:>4} {:>4}  {d:>12}", p.segments_a, p.segments_b);
    }
    for (name, ids) in [("first", &c.only_in_a), ("second", &c.only_in_b)] {
        if !ids.is_empty() {
            let ids = ids.join(", ");
            let _ = writeln!(out, "only in the {name}: {}", readable::safe_name(&ids));
        }
    }
    let _ = writeln!(out, "largest distance: {:.6}", c.max_distance);
    let Some(p) = &c.pixels else {
        out.push_str("pixels: not compared, as the pages have different proportions\n");
        return out;
    };
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
