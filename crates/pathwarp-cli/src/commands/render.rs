//! `pathwarp render IN.svg -o OUT.png`: draws an SVG file as a picture.

use super::file_args;
use crate::bitmap::encode;
use crate::failure::Failure;
use crate::format::{Choice, Format, PICTURES};
use crate::options::{Given, reading_args, some_options};
use crate::status::Status;
use crate::{advice, input, output, terminal};
use clap::{Arg, ArgGroup, ArgMatches, Command, value_parser};
use pathwarp_raster::{Color, RenderOptions, Size};
use pathwarp_svg::usvg_tree;
use std::str::FromStr as _;

pub(super) const NAME: &str = "render";

pub(super) fn command() -> Command {
    let pixels = |name: &'static str, help: &'static str| {
        Arg::new(name).long(name).value_name("PX").value_parser(value_parser!(u32).range(1..)).help(help)
    };
    Command::new(NAME)
        .about("Draw an SVG file as a picture: PNG, JPEG or WebP")
        .arg(file_args::file("INPUT", "An SVG file; - is standard input"))
        .arg(file_args::out(
            "OUT.png",
            "Write the picture to this file: .png, .jpg or .webp (without loss); - or none writes to standard output",
        ))
        .args(some_options(&["format", "quality", "quiet"]))
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
                .value_name("COLOUR|none")
                .value_parser(background)
                .help("Colour behind the drawing, as in CSS [default: none; white in a JPEG, which has no transparency]"),
        )
        .after_help(
            "Examples:\n  pathwarp render samples/logo.svg -o logo.png --width 800 --background white\n  pathwarp render \
             samples/logo.svg -o logo.jpg --scale 3 --quality 85\n  pathwarp render samples/logo.svg --format webp > logo.webp",
        )
        .args(reading_args())
}

pub(super) fn run(m: &ArgMatches) -> Result<Status, Failure> {
    let file = file_args::given(m, "INPUT")?;
    let target = file_args::target(m, [file])?;
    let options = Given::options(m).read()?;
    let format = Choice { what: "a picture is", among: PICTURES }.format(target, options.format)?;
    let size = if let Some(&w) = m.get_one::<u32>("width") {
        Size::Width(w)
    } else if let Some(&h) = m.get_one::<u32>("height") {
        Size::Height(h)
    } else {
        m.get_one::<f32>("scale").map_or(Size::Native, |s| Size::Scale(*s))
    };
    output::refuse_terminal(target, "the picture", format.extension())?;
    let background = match m.get_one::<Background>("background") {
        Some(Background(None)) if format == Format::Jpeg => {
            return Err(Failure::usage("--background none: a JPEG has no transparency; write a .png or .webp"));
        }
        Some(Background(color)) => *color,
        // Encoded as a JPEG, a picture gets white behind it.
        None => None,
    };
    let bytes = input::bytes(file)?;
    let name = input::display(file);
    let read = usvg_tree::read_tree(&bytes, &name, &input::read_options(file, &options.reading))
        .map_err(|e| input::not_a_drawing(&bytes, file, e.into()))?;
    let limits = options.reading.limits.for_input(bytes.len());
    let drawn = RenderOptions { size, background }.render_within(&read.tree, &limits);
    let picture = encode(drawn.map_err(|e| Failure::from(e).about(&name))?, format, options.quality)?;
    if !options.quiet {
        let lacking = advice::lacking(&read.missing_fonts, &read.unread, &read.undrawn, &read.notes);
        lacking.iter().for_each(|w| terminal::warning(&format!("{name}: {w}")));
    }
    output::write(target, &picture)?;
    Ok(Status::partial_if(!read.unread.is_empty() || !read.undrawn.is_empty()))
}

/// A colour behind the drawing; `None` for transparency.
#[derive(Clone)]
struct Background(Option<Color>);

/// Parses a colour as in CSS, or `none`.
fn background(text: &str) -> Result<Background, String> {
    if matches!(text, "none" | "transparent") {
        return Ok(Background(None));
    }
    let c =
        svgtypes::Color::from_str(text).map_err(|_| "is no colour; write white, #fff8e0, rgb(0 0 0 / 50%) or none")?;
    Ok(Background(Some(Color::from_rgba8(c.red, c.green, c.blue, c.alpha))))
}
