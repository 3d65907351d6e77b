//! `pathwarp render IN.svg -o OUT.png`: draws an SVG file.

use super::file_args;
use crate::failure::Failure;
use crate::options::{Given, reading_args};
use crate::status::Status;
use crate::{advice, input, output, terminal};
use clap::{Arg, ArgGroup, ArgMatches, Command, value_parser};
use pathwarp_raster::{Color, RenderOptions, Size, encode_png};
use pathwarp_svg::usvg_tree;

pub(super) const NAME: &str = "render";

pub(super) fn command() -> Command {
    let pixels = |name: &'static str, help: &'static str| {
        Arg::new(name).long(name).value_name("PX").value_parser(value_parser!(u32).range(1..)).help(help)
    };
    Command::new(NAME)
        .about("Draw an SVG file as a PNG")
        .arg(file_args::file("INPUT", "An SVG file; - is standard input"))
        .arg(file_args::out("OUT.png", "Write the picture to this file; - or none writes to standard output"))
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
                .help("Colour behind the drawing"),
        )
        .args(reading_args())
        .after_help("Example:\n  pathwarp render samples/logo.svg -o logo.png --width 800 --background white")
}

pub(super) fn run(m: &ArgMatches) -> Result<Status, Failure> {
    let file = file_args::given(m, "INPUT")?;
    let target = file_args::target(m, [file])?;
    file_args::check_extension(target, &["png"])?;
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
    let reading = Given::reading(m)?;
    let bytes = input::bytes(file)?;
    let name = input::display(file);
    let read = usvg_tree::read_tree(&bytes, &name, &input::read_options(file, &reading))?;
    let limits = reading.limits.for_input(bytes.len());
    let drawn = RenderOptions { size, background }.render_within(&read.tree, &limits);
    let png = encode_png(&drawn.map_err(|e| Failure::from(e).about(&name))?)?;
    advice::unread(&read.unread).iter().for_each(|w| terminal::warning(&format!("{name}: {w}")));
    output::write(target, &png)?;
    Ok(Status::partial_if(!read.unread.is_empty()))
}
