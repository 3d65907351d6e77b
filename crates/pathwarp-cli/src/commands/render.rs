//! Commands for pictures: `render` draws an SVG file; `gallery` shows artwork under presets, or words in fonts, on one sheet.

use crate::arguments::{self, reading_args, some_options};
use crate::commands::args::{choice, file_arg, given_file, option, out_arg, switch, target};
use crate::ending::Status;
use crate::terminal;
use clap::{ArgGroup, ArgMatches, Command, value_parser};
use pathwarp::deform::{Deformation, Gallery, Registry};
use pathwarp::param::{Args, Axis, Frame, Param};
use pathwarp::refit;
use pathwarp_engine::bitmap::{Background, background, encode};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::format::{Choice, Format, PICTURES};
use pathwarp_engine::lettering::{REGULAR, find_font, laid_out, read_font};
use pathwarp_engine::links::Destination;
use pathwarp_engine::options::CommonOptions;
use pathwarp_engine::report::SkippedShape;
use pathwarp_engine::{advice, export, input, output};
use pathwarp_raster::{Picture, RenderOptions, Size};
use pathwarp_svg::engine::{LetteringOptions, families, write_lettering};
use pathwarp_svg::sheet::{Cell, SheetOptions, sheet};
use pathwarp_svg::{Document, ReadOptions, Selection, Skipped, WarpOptions, WarpedDocument, usvg_tree};
use pathwarp_text::TextStyle;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

pub(super) fn render_command() -> Command {
    let pixels = |name, help| option(name, "PX", help).value_parser(value_parser!(u32).range(1..));
    Command::new("render")
        .about("Draw an SVG file as a picture: PNG, JPEG or WebP")
        .arg(file_arg("INPUT", "An SVG file; - is standard input"))
        .arg(out_arg(
            "OUT.png",
            "Write the picture to this file: .png, .jpg or .webp (without loss); - or none writes to standard output",
        ))
        .args(some_options(&["format", "quality", "quiet"]))
        .arg(pixels("width", "Width in pixels"))
        .arg(pixels("height", "Height in pixels"))
        .arg(option("scale", "S", "Pixels per px of the drawing").value_parser(value_parser!(f32)))
        .group(ArgGroup::new("size").args(["width", "height", "scale"]))
        .arg(
            option(
                "background",
                "COLOUR|none",
                "Colour behind the drawing, as in CSS [default: none; white in a JPEG, which has no transparency]",
            )
            .value_parser(background),
        )
        .after_help(
            "Examples:\n  pathwarp render samples/logo.svg -o logo.png --width 800 --background white\n  pathwarp render \
             samples/logo.svg -o logo.jpg --scale 3 --quality 85\n  pathwarp render samples/logo.svg --format webp > logo.webp",
        )
        .args(reading_args())
}

pub(super) fn render(m: &ArgMatches) -> Result<Status, Failure> {
    let file = given_file(m, "INPUT")?;
    let target = target(m, [file])?;
    let options = arguments::given(m).read()?;
    let format = Choice { what: "a picture is", among: PICTURES }.format(target, options.format)?;
    let side = |name: &str| m.get_one::<u32>(name).copied();
    let size = match (side("width"), side("height"), m.get_one::<f32>("scale")) {
        (Some(width), ..) => Size::Width(width),
        (None, Some(height), _) => Size::Height(height),
        (None, None, scale) => scale.map_or(Size::Native, |s| Size::Scale(*s)),
    };
    terminal::refuse_terminal(target, "the picture", format.extension())?;
    let background = m.get_one::<Background>("background");
    if matches!(background, Some(Background(None))) && format == Format::Jpeg {
        return Err(Failure::usage("--background none: a JPEG has no transparency; write a .png or .webp"));
    }
    // By default, JPEG files get a white background when they are encoded.
    let background = background.and_then(|b| b.0);
    let bytes = input::bytes(file)?;
    let name = input::display(file);
    let read = usvg_tree::read_tree(&bytes, &name, &input::read_options(file, &options.reading));
    let read = read.map_err(|e| input::not_a_drawing(&bytes, file, e.into()))?;
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

/// The formats of sheets.
const SHEETS: &[Format] = &[Format::Svg, Format::Svgz, Format::Pdf, Format::Png, Format::Jpeg, Format::WebP];

/// Tolerance as a fraction of the artwork's diagonal, far below a pixel of any sheet.
const TOLERANCE: f64 = 2e-4;

/// The word that selects all sets.
const ALL: &str = "all";

const FONTS: &str = "fonts";

/// Returns the deformations with presets.
fn sets(registry: &Registry) -> impl Iterator<Item = (&dyn Deformation, Gallery)> {
    // Sets whose presets bend by an amount come before sets of shapes.
    let all = || registry.entries().iter().filter_map(|e| Some((&**e, e.info().gallery?)));
    all().filter(|(_, g)| g.bend.is_some()).chain(all().filter(|(_, g)| g.bend.is_none()))
}

pub(super) fn gallery_command(registry: &Registry) -> Command {
    let sets: Vec<&str> = sets(registry).map(|(_, g)| g.set).chain([ALL]).collect();
    Command::new("gallery")
        .about("Draw artwork under every preset of a set, or words in every font, on one sheet")
        .arg(file_arg("INPUT", "An SVG file; - is standard input").required(false).required_unless_present(FONTS))
        .arg(out_arg(
            "SHEET.svg|SHEET.png",
            "Write the sheet to this file: .svg, .svgz, .pdf, .png, .jpg or .webp; - or none writes SVG to standard output",
        ))
        .args(some_options(&["format", "quality", "page-width", "page-height", "show-nodes"]))
        .arg(choice("set", &sets, "The set of presets to draw, or all of them").default_value(sets[0]))
        .arg(switch(ALL, "The same as --set all").conflicts_with("set"))
        .arg(
            option(FONTS, "WORDS", "Draw these words in every installed family that has their letters, and in the bundled ones")
                .conflicts_with_all(["INPUT", "set", ALL]),
        )
        .arg(
            option("bend", "NUMBER", "Amount of bend of the presets that bend")
                .allow_hyphen_values(true)
                .default_value("50%"),
        )
        .arg(
            choice("axis", &["horizontal", "vertical"], "Direction in which artwork runs through the presets")
                .default_value("horizontal"),
        )
        .arg(
            option("columns", "N", "Number of cells per row")
                .value_parser(value_parser!(u32).range(1..=64))
                .default_value("4"),
        )
        .arg(option("cell", "WxH", "Size of a cell in px").value_parser(cell).default_value("260x190"))
        .arg(
            option("scale", "S", "Pixels per px of a sheet that is a picture")
                .value_parser(value_parser!(f32))
                .default_value("1"),
        )
        .args(reading_args())
        .after_help(
            "All cells have the same scale, except that a much larger result is reduced to fit. Labels are outlines, so they look the \
             same everywhere.\n\nExamples:\n  \
             pathwarp gallery samples/logo.svg -o sheet.svg\n  \
             pathwarp gallery samples/lettering.svg --set wordart --columns 5 -o sheet.png\n  \
             pathwarp gallery samples/badge.svg --bend -30% --axis vertical -o sheet.svg\n  \
             pathwarp gallery --fonts 'Old Bakery' -o fonts.png\n  \
             pathwarp gallery samples/logo.svg --page-width 210mm --page-height 297mm -o sheet.pdf",
        )
}

/// Parses `WxH`, each from 40 to 4000.
fn cell(text: &str) -> Result<(f64, f64), String> {
    let side = |t: &str| t.trim().parse::<f64>().ok().filter(|v| (40.0..=4000.0).contains(v));
    let sides = text.split_once(['x', 'X', '×']).and_then(|(w, h)| side(w).zip(side(h)));
    sides.ok_or_else(|| "is not WxH, such as 260x190, each from 40 to 4000".into())
}

pub(super) fn gallery(registry: &Registry, m: &ArgMatches) -> Result<Status, Failure> {
    let (file, fonts) = (m.get_one::<PathBuf>("INPUT").map(PathBuf::as_path), m.get_one::<String>(FONTS));
    let target = target(m, file)?;
    let options = arguments::given(m).read()?;
    let format = Choice { what: "a sheet is", among: SHEETS }.format(target, options.format)?;
    if format.of_picture(None).is_some() && (options.page_width.is_some() || options.page_height.is_some()) {
        return Err(Failure::usage(
            "--page-width and --page-height are for sheets as .svg or .pdf; --scale enlarges a picture",
        ));
    }
    let file = file.unwrap_or(Path::new("-"));
    let Contents { mut cells, title, left_out } = match fonts {
        Some(words) => in_fonts(words, &options)?,
        None => under_presets(registry, m, file, &options)?,
    };
    let layout = SheetOptions {
        columns: m.get_one::<u32>("columns").map_or(4, |n| *n as usize),
        cell: m.get_one::<(f64, f64)>("cell").copied().unwrap_or((260.0, 190.0)),
        title,
    };
    let read = input::read_options(file, &options.reading);
    if options.show_nodes {
        for cell in &mut cells {
            cell.svg = Document::read(cell.svg.as_bytes(), &cell.label, &read)?.with_nodes_shown();
        }
    }
    let svg = sheet(&cells, &layout, &read)?;
    let plain = ReadOptions::default().with_turned(Some(Picture::turned)).with_limits(options.reading.limits);
    let bytes = if format.of_picture(None).is_some() {
        let tree = usvg_tree::parse_tree(svg.as_bytes(), "the sheet", &plain)?;
        let size = Size::Scale(m.get_one::<f32>("scale").copied().unwrap_or(1.0));
        let limits = options.reading.limits.for_input(svg.len());
        let drawn = RenderOptions { size, background: None }.render_within(&tree, &limits)?;
        encode(drawn, format, options.quality)?
    } else {
        export::drawing(svg, (format, &Destination::Back), &plain, &options, None)?.bytes
    };
    left_out.iter().for_each(|reason| terminal::warning(reason));
    output::write(target, &bytes)?;
    Ok(Status::partial_if(!left_out.is_empty()))
}

/// The cells and the title of a sheet, with the reasons for missing cells.
struct Contents {
    cells: Vec<Cell>,
    title: String,
    left_out: Vec<String>,
}

/// Sets words in every installed family that has all their letters.
fn in_fonts(words: &str, options: &CommonOptions) -> Result<Contents, Failure> {
    let (read, limits) = (options.reading.read_options(), options.reading.limits.for_input(words.len()));
    let families = families(&read);
    // The cell, and `true` if the family has all letters.
    let set = |family: &String| -> Result<_, Failure> {
        let file = find_font(family, REGULAR, false, &read)?;
        let text = laid_out(words, &[read_font(family, &file)?], &TextStyle::default(), &limits)?;
        let svg = write_lettering(&text, &LetteringOptions::default())?;
        Ok((Cell { svg, label: family.clone() }, text.missing.is_empty()))
    };
    // Skip fonts that cannot be read: installed files may be damaged or without outlines.
    let set: Vec<_> = families.par_iter().map(set).filter_map(Result::ok).collect();
    let cells: Vec<Cell> = set.into_iter().filter(|(_, has_all)| *has_all).map(|(cell, _)| cell).collect();
    if cells.is_empty() {
        return Err(Failure::usage(format!("--{FONTS}: no installed family has all letters of “{words}”")));
    }
    let (shown, all) = (cells.len(), families.len());
    Ok(Contents { cells, title: format!("{words}: {shown} of {all} families have its letters"), left_out: Vec::new() })
}

/// Bends a drawing by every preset of a set.
fn under_presets(
    registry: &Registry,
    m: &ArgMatches,
    file: &Path,
    options: &CommonOptions,
) -> Result<Contents, Failure> {
    let word = |name: &str| m.get_one::<String>(name).map_or("", String::as_str);
    let set = if m.get_flag(ALL) { ALL } else { word("set") };
    let (bend, axis) = (word("bend"), word("axis"));
    let doc = input::document(file, &options.reading)?;
    let bounds = doc.seen_box(&Selection::default()).ok_or_else(|| Failure::file(file, "holds nothing to warp"))?;
    let sets: Vec<(&dyn Deformation, Gallery)> = sets(registry).filter(|(_, g)| set == ALL || g.set == set).collect();
    let presets = sets.iter().flat_map(|(entry, gallery)| presets(*entry, gallery, bend, axis));
    let presets: Vec<Preset<'_>> = presets.collect();
    let lettering = doc.lettering(&Selection::default());
    let frame = Frame::new(bounds);
    let frame = if lettering.is_level() { frame.with_letters(lettering.letters().into()) } else { frame };
    let draw = |p: &Preset<'_>| {
        let WarpedDocument { svg, skipped, .. } = p.warp(&doc, &frame)?;
        Ok((Cell { svg, label: p.name.to_owned() }, skipped))
    };
    let drawn: Vec<(Cell, Vec<Skipped>)> = presets.par_iter().map(draw).collect::<Result<_, Failure>>()?;
    let (mut cells, skipped): (Vec<Cell>, Vec<_>) = drawn.into_iter().unzip();
    let skipped = reasons(skipped.iter().flatten());
    // If presets bend by an amount, the sheet shows the unbent artwork, too.
    if sets.iter().any(|(_, g)| g.bend.is_some()) {
        let svg = doc.decoded().into_owned();
        cells.insert(0, Cell { svg, label: "as it is".into() });
    }
    let left_out = skipped.iter().map(|reason| format!("{}: {reason}", input::display(file))).collect();
    Ok(Contents { cells, title: title(file, &sets, bend, axis), left_out })
}

/// Lists the first reasons why something is not warped, or is left out, in a cell, and counts the others.
fn reasons<'a>(skipped: impl Iterator<Item = &'a Skipped>) -> Vec<String> {
    const NAMED: usize = 10;
    let all: BTreeSet<String> = skipped.map(|s| SkippedShape::from(s.clone()).to_string()).collect();
    let more = all.len().saturating_sub(NAMED);
    let mut out: Vec<String> = all.into_iter().take(NAMED).collect();
    out.extend((more > 0).then(|| format!("and {more} more")));
    out
}

/// Returns the title of the sheet: the file, and the sets, with the bend where it applies.
fn title(file: &Path, sets: &[(&dyn Deformation, Gallery)], bend: &str, axis: &str) -> String {
    let name = file.file_name().map_or_else(|| "standard input".into(), |n| n.to_string_lossy().into_owned());
    if let [(_, only)] = sets
        && only.bend.is_some()
    {
        return format!("{name}: bend {bend}{}", if axis == "vertical" { ", vertical" } else { "" });
    }
    let titles = sets.iter().map(|(_, g)| match g.bend {
        Some(_) => format!("{} at {bend}", g.title),
        None => g.title.to_owned(),
    });
    format!("{name}: {}", titles.collect::<Vec<_>>().join(", "))
}

/// A preset with its deformation's arguments.
struct Preset<'a> {
    entry: &'a dyn Deformation,
    name: &'static str,
    args: Args,
}

/// Returns the presets of a deformation.
fn presets<'a>(entry: &'a dyn Deformation, gallery: &Gallery, bend: &str, axis: &str) -> Vec<Preset<'a>> {
    let names = entry.info().params.iter().find(|p| p.name == gallery.presets).map_or(&[][..], Param::names);
    let preset = |&name: &&'static str| {
        let mut args = Args::from_pairs(&[(gallery.presets, name)]);
        gallery.bend.into_iter().for_each(|param| args.push(param, bend));
        gallery.axis.into_iter().for_each(|param| args.push(param, axis));
        Preset { entry, name, args }
    };
    names.iter().map(preset).collect()
}

impl Preset<'_> {
    /// Bends the artwork by the preset.
    fn warp(&self, doc: &Document, frame: &Frame) -> Result<WarpedDocument, Failure> {
        let built = self.entry.build_from(&self.args, frame)?;
        let tolerance = TOLERANCE * frame.extent(Axis::Diagonal);
        let refit = refit::Options::new(tolerance).with_nodes(refit::Nodes::Source).with_budget(doc.budget().clone());
        Ok(doc.warp(&built.map, &WarpOptions::new(refit))?)
    }
}
