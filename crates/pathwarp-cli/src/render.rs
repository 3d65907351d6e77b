//! `pathwarp render IN.svg -o OUT.png`.

use crate::failure::Failure;
use crate::output::Pending;
use crate::{Outcome, deform, output};
use clap::{Arg, ArgGroup, ArgMatches, Command, value_parser};
use pathwarp_raster::{Color, RenderOptions, Size, encode_png};
use std::path::PathBuf;

pub(crate) fn command() -> Command {
    let pixels = |name: &'static str, help: &'static str| {
        Arg::new(name).long(name).value_name("PX").value_parser(value_parser!(u32).range(1..)).help(help)
    };
    Command::new("render")
        .about("Draw an SVG file as a PNG")
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
                .value_name("OUT.png")
                .value_parser(value_parser!(PathBuf))
                .help("Where to write the picture; - or none writes to standard output"),
        )
        .arg(pixels("width", "Width in pixels"))
        .arg(pixels("height", "Height in pixels"))
        .arg(
            Arg::new("scale")
                .long("scale")
                .value_name("S")
                .value_parser(value_parser!(f32))
                .help("Pixels per px of the drawing"),
        )
        .group(ArgGroup::new("size").args(["width", "height", "scale"]))
        .arg(
            Arg::new("background")
                .long("background")
                .value_name("white|black|none")
                .value_parser(["white", "black", "none"])
                .hide_possible_values(true)
                .default_value("none")
                .help("What shows through"),
        )
        .after_help("Example:\n  pathwarp render samples/logo.svg -o logo.png --width 800 --background white")
}

pub(crate) fn run(m: &ArgMatches) -> Result<Outcome, Failure> {
    let Some(input) = m.get_one::<PathBuf>("INPUT") else { return Err(Failure::usage("INPUT is needed")) };
    let size = if let Some(&w) = m.get_one::<u32>("width") {
        Size::Width(w)
    } else if let Some(&h) = m.get_one::<u32>("height") {
        Size::Height(h)
    } else {
        m.get_one::<f32>("scale").map_or(Size::Native, |s| Size::Scale(*s))
    };
    let background = match m.get_one::<String>("background").map(String::as_str) {
        Some("white") => Some(Color::WHITE),
        Some("black") => Some(Color::BLACK),
        _ => None,
    };
    let tree = pathwarp_svg::parse_tree(&deform::read(input)?, &deform::display(input), &deform::read_options(input))?;
    let png = encode_png(&RenderOptions { size, background }.render(&tree)?)?;
    match m.get_one::<PathBuf>("out").filter(|o| o.as_os_str() != "-") {
        Some(out) => Pending::commit_all(vec![Pending::new(out, &png)?])?,
        None => output::to_stdout(&png)?,
    }
    Ok(Outcome::Done)
}
