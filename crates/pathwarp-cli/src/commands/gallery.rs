//! `pathwarp gallery ART -o SHEET`: the artwork under every style, on one sheet.

use crate::failure::Failure;
use crate::status::Status;
use crate::{input, output};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use pathwarp::deform::Registry;
use pathwarp::param::{Args, Frame, Kind};
use pathwarp::refit;
use pathwarp_raster::{RenderOptions, Size, encode_png};
use pathwarp_svg::{Document, ReadOptions, Selection, WarpOptions, sheet};
use rayon::prelude::*;
use std::path::PathBuf;

/// Of the artwork's diagonal: far below a pixel of any sheet.
const TOLERANCE: f64 = 2e-4;

pub(super) const NAME: &str = "gallery";

pub(super) fn command() -> Command {
    Command::new("gallery")
        .about("Draw artwork under every style on one sheet")
        .arg(
            Arg::new("INPUT")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .help("An SVG file; - is standard input"),
        )
        .arg(
            Arg::new("out")
                .short('o')
                .long("out")
                .value_name("SHEET.svg|SHEET.png")
                .value_parser(value_parser!(PathBuf))
                .help("Where to write the sheet; - or none writes SVG to standard output"),
        )
        .arg(
            Arg::new("set")
                .long("set")
                .value_name("styles|wordart|all")
                .value_parser(["styles", "wordart", "all"])
                .hide_possible_values(true)
                .default_value("styles")
                .help("The warp styles, the text shapes, or both"),
        )
        .arg(Arg::new("all").long("all").action(ArgAction::SetTrue).conflicts_with("set").help("The same as --set all"))
        .arg(
            Arg::new("bend")
                .long("bend")
                .value_name("NUMBER")
                .allow_hyphen_values(true)
                .default_value("50%")
                .help("How far the styles bend"),
        )
        .arg(
            Arg::new("axis")
                .long("axis")
                .value_name("horizontal|vertical")
                .value_parser(["horizontal", "vertical"])
                .hide_possible_values(true)
                .default_value("horizontal")
                .help("The direction in which artwork runs through the styles"),
        )
        .arg(
            Arg::new("columns")
                .long("columns")
                .value_name("N")
                .value_parser(value_parser!(u32).range(1..=64))
                .default_value("4")
                .help("Cells side by side"),
        )
        .arg(
            Arg::new("cell")
                .long("cell")
                .value_name("WxH")
                .value_parser(cell)
                .default_value("260x190")
                .help("The size of a cell in px"),
        )
        .arg(
            Arg::new("scale")
                .long("scale")
                .value_name("S")
                .value_parser(value_parser!(f32))
                .default_value("1")
                .help("Pixels per px of a PNG sheet"),
        )
        .after_help(
            "What is on a sheet has one scale; only what is much larger is made to fit. Labels are outlines: they look the same everywhere.\n\nExamples:\n  \
             pathwarp gallery samples/logo.svg -o sheet.svg\n  \
             pathwarp gallery samples/lettering.svg --set wordart --columns 5 -o sheet.png\n  \
             pathwarp gallery samples/badge.svg --bend -30% --axis vertical -o sheet.svg",
        )
}

/// `WxH`, each from 40 to 4000.
fn cell(text: &str) -> Result<(f64, f64), String> {
    let side = |t: &str| t.trim().parse::<f64>().ok().filter(|v| (40.0..=4000.0).contains(v));
    let sides = text.split_once(['x', 'X', '×']).and_then(|(w, h)| side(w).zip(side(h)));
    sides.ok_or_else(|| "is not WxH, such as 260x190, each from 40 to 4000".into())
}

pub(super) fn run(registry: &Registry, m: &ArgMatches) -> Result<Status, Failure> {
    let file = super::file_args::given(m, "INPUT")?;
    let word = |name: &str| m.get_one::<String>(name).map_or("", String::as_str);
    let set = if m.get_flag("all") { "all" } else { word("set") };
    let read = input::read_options(file);
    let doc = input::document(file)?;
    let frame = doc.artwork_box(&Selection::default()).ok_or_else(|| Failure::file(file, "holds nothing to warp"))?;

    let mut wanted: Vec<(&str, &str, Args)> = Vec::new();
    if set != "wordart" {
        for name in names(registry, "warp", "style") {
            wanted.push((
                "warp",
                name,
                Args::from_pairs(&[("style", name), ("bend", word("bend")), ("axis", word("axis"))]),
            ));
        }
    }
    if set != "styles" {
        for name in names(registry, "wordart", "preset") {
            wanted.push(("wordart", name, Args::from_pairs(&[("preset", name)])));
        }
    }
    let one = |(deformation, label, args): &(&str, &str, Args)| -> Result<sheet::Cell, Failure> {
        let svg = warped(registry, &doc, frame, deformation, args)?;
        Ok(sheet::Cell { svg, label: (*label).to_owned() })
    };
    let mut cells: Vec<sheet::Cell> = wanted.par_iter().map(one).collect::<Result<_, _>>()?;
    if set != "wordart" {
        let svg = String::from_utf8_lossy(doc.source()).into_owned();
        cells.insert(0, sheet::Cell { svg, label: "as it is".into() });
    }

    let name = file.file_name().map_or_else(|| "standard input".into(), |n| n.to_string_lossy().into_owned());
    let title = match set {
        "wordart" => format!("{name}: text shapes"),
        "all" => format!("{name}: styles at {}, text shapes", word("bend")),
        _ => format!("{name}: bend {}{}", word("bend"), if word("axis") == "vertical" { ", vertical" } else { "" }),
    };
    let options = sheet::SheetOptions {
        columns: m.get_one::<u32>("columns").map_or(4, |n| *n as usize),
        cell: m.get_one::<(f64, f64)>("cell").copied().unwrap_or((260.0, 190.0)),
        title,
    };
    let svg = sheet::sheet(&cells, &options, &read)?;
    let Some(out) = m.get_one::<PathBuf>("out").filter(|o| o.as_os_str() != "-") else {
        output::to_stdout(svg.as_bytes())?;
        return Ok(Status::Complete);
    };
    let bytes = if out.extension().is_some_and(|e| e.eq_ignore_ascii_case("png")) {
        let tree = pathwarp_svg::parse_tree(svg.as_bytes(), "the sheet", &ReadOptions::default())?;
        let size = Size::Scale(m.get_one::<f32>("scale").copied().unwrap_or(1.0));
        encode_png(&RenderOptions { size, background: None }.render(&tree)?)?
    } else {
        svg.into_bytes()
    };
    output::write(Some(out), &bytes)?;
    Ok(Status::Complete)
}

/// The names that a deformation's parameter lists.
fn names(registry: &Registry, deformation: &str, param: &str) -> &'static [&'static str] {
    let params = registry.get(deformation).map_or(&[][..], |e| e.info().params);
    match params.iter().find(|p| p.name == param).map(|p| p.kind) {
        Some(Kind::NameOrFile(names)) => names,
        _ => &[],
    }
}

fn warped(
    registry: &Registry,
    doc: &Document,
    frame: pathwarp::kurbo::Rect,
    deformation: &str,
    args: &Args,
) -> Result<String, Failure> {
    let entry = registry.get(deformation).ok_or_else(|| Failure::usage(format!("there is no {deformation}")))?;
    let built = entry.build_from(args, &Frame::new(frame))?;
    let tolerance = TOLERANCE * frame.width().hypot(frame.height());
    Ok(doc.warp(&built.map, &WarpOptions::new(refit::Options::new(tolerance)))?.svg)
}
