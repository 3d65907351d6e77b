//! `pathwarp text WORDS -o OUT.svg`: sets text as outlines, which any deformation takes as its input.

mod fonts;
mod style;
mod words;

use super::file_args;
use crate::failure::Failure;
use crate::status::Status;
use crate::{output, terminal};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use pathwarp_svg::{FontFile, LetteringOptions, bundled_font, write_lettering};
use pathwarp_text::{Font, layout};
use std::path::PathBuf;

pub(super) const NAME: &str = "text";

pub(super) fn command() -> Command {
    let value = |name: &'static str, value: &'static str, help: &'static str| {
        Arg::new(name).long(name).value_name(value).allow_hyphen_values(true).help(help)
    };
    let choice = |name: &'static str, words: &'static [&'static str], help: &'static str| {
        Arg::new(name)
            .long(name)
            .value_name(words.join("|"))
            .value_parser(words.to_vec())
            .hide_possible_values(true)
            .help(help)
    };
    let heading = "Spacing and lines";
    let shaping = "Shaping";
    Command::new(NAME)
        .about("Set words as outlines: lettering for any deformation")
        .arg(Arg::new("WORDS").num_args(0..).help(
            "The text; \\n starts a new line, and so does every further argument; \\\\ is a backslash; - reads standard input",
        ))
        .arg(
            Arg::new("file")
                .long("file")
                .value_name("FILE")
                .value_parser(value_parser!(PathBuf))
                .conflicts_with("WORDS")
                .help("Read the text from a file; - is standard input"),
        )
        .arg(file_args::out("OUT.svg", "Where to write the drawing; - or none writes to standard output"))
        .arg(
            value("font", "FILE|FAMILY", "A font file (FILE#2: the third of a collection) or the name of an installed family; given again, for what the ones before lack [default: the bundled Noto Sans]")
                .action(ArgAction::Append),
        )
        .arg(value("size", "LENGTH", "Size of the em [default: 72]"))
        .arg(value("weight", "100-900|NAME", "The family's font of that weight (thin, light, regular, medium, bold, black, …); the axis wght of a variable font"))
        .arg(Arg::new("italic").long("italic").action(ArgAction::SetTrue).help("The family's italic"))
        .arg(value("variation", "AXIS=N,…", "Places on the axes of a variable font, such as wght=600,wdth=80").action(ArgAction::Append))
        .arg(value("fill", "COLOUR", "The colour, as in CSS [default: black]"))
        .arg(value("margin", "LENGTH", "Room on the page around the text; % is of the size [default: 0]"))
        .arg(value("letter-spacing", "LENGTH", "Room added between letters; % is of the size [default: 0]").help_heading(heading))
        .arg(value("word-spacing", "LENGTH", "Room added to every space; % is of the size [default: 0]").help_heading(heading))
        .arg(value("line-height", "LENGTH", "From baseline to baseline; % is of the size [default: as the font says]").help_heading(heading))
        .arg(choice("align", &["start", "left", "center", "right", "justify"], "Where lines stand; justify widens the spaces of shorter lines [default: start]").help_heading(heading))
        .arg(choice("kerning", &["on", "off"], "Kern pairs of letters [default: on]").help_heading(shaping))
        .arg(choice("ligatures", &["auto", "on", "off"], "Set optional ligatures; auto: unless letters are spaced [default: auto]").help_heading(shaping))
        .arg(value("features", "TAG[=N],…", "OpenType features, such as ss01,liga=0,salt=2").action(ArgAction::Append).help_heading(shaping))
        .arg(choice("direction", &["auto", "ltr", "rtl"], "The text's base direction; auto: as its first letter [default: auto]").help_heading(shaping))
        .arg(value("language", "TAG", "The text's language, such as sr, tr or nl: some fonts have letters of its own").help_heading(shaping))
        .arg(value("script", "CODE", "The script of all text, such as Latn, Arab or Deva [default: of every letter]").help_heading(shaping))
        .arg(Arg::new("quiet").short('q').long("quiet").action(ArgAction::SetTrue).help("No warnings"))
        .after_help(
            "The outlines are the font's own curves. The page is as large as the ink and the lines together; \
             --margin makes room around them, and a deformation's --fit grow where it moves them. Every line is a group with data-baseline, every letter a path with data-glyph: place and \
             advance width. What no font has is drawn as the font draws what is missing, a warning names it, and the exit code is 1.\n\n\
             Examples:\n  pathwarp text Welcome -o word.svg\n  \
             pathwarp text Welcome --font 'DejaVu Serif' --weight bold --size 20mm --fill '#a30' -o word.svg\n  \
             pathwarp text 'The Old\\nBakery' --align center --line-height 110% --letter-spacing 4% -o sign.svg\n  \
             pathwarp text Flow --font Variable.ttf --variation wght=650,wdth=90 --features ss01 -o word.svg\n  \
             pathwarp text Welcome | pathwarp bend - --along 'M0,90 Q170,0 340,90' --fit grow -o arc.svg",
        )
}

/// Sets the text and writes the drawing.
pub(super) fn run(m: &ArgMatches) -> Result<Status, Failure> {
    let text = words::words(m)?;
    let style = style::style(m)?;
    let weight = m.get_one::<String>("weight").map(|w| fonts::weight_of(w)).transpose()?;
    let names: Vec<&str> = m.get_many::<String>("font").into_iter().flatten().map(String::as_str).collect();
    let find = |name: &&str| fonts::find(name, weight.unwrap_or(fonts::REGULAR), m.get_flag("italic"));
    let files: Vec<FontFile> = names.iter().map(find).collect::<Result<_, _>>()?;
    let mut chosen: Vec<Font<'_>> = Vec::with_capacity(files.len() + 1);
    for (name, file) in names.iter().zip(&files) {
        chosen.push(Font::new(&file.bytes, file.index).map_err(|e| Failure::Input(format!("{name}: {e}")))?);
    }
    chosen.push(Font::new(bundled_font(), 0).map_err(|e| Failure::Input(e.to_string()))?);
    let chosen = fonts::with_variations(chosen, &fonts::axis_positions(m)?, weight)?;

    let set = layout(&text, &chosen, &style).map_err(|e| failure(&e))?;
    let fill = m.get_one::<String>("fill").filter(|f| !f.is_empty()).cloned();
    let margin = style::length(m, "margin", style.size)?.unwrap_or(0.0);
    let svg = write_lettering(&set, &LetteringOptions { fill, margin })?;
    if !set.missing.is_empty() && !m.get_flag("quiet") {
        terminal::warning(&missing(&set.missing, &names));
    }
    output::write(file_args::target(m), svg.as_bytes())?;
    Ok(Status::partial_if(!set.missing.is_empty()))
}

/// Maps an error of the layout: a bad option is wrong usage, anything else a problem of the font or the text.
fn failure(e: &pathwarp_text::Error) -> Failure {
    use pathwarp_text::Error as E;
    match e {
        E::Style { .. } | E::Empty => Failure::usage(e.to_string()),
        E::Setting { .. } => Failure::usage(format!("--script or --language: {e}")),
        _ => Failure::Input(e.to_string()),
    }
}

/// The warning about characters that no font has.
fn missing(chars: &[char], names: &[&str]) -> String {
    /// Number of characters that fit a line or two.
    const SHOWN: usize = 12;
    let shown: Vec<String> = chars.iter().take(SHOWN).map(|c| format!("{c} (U+{:04X})", u32::from(*c))).collect();
    let more = chars.len().saturating_sub(SHOWN);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let fonts = if names.is_empty() { "the bundled font" } else { "the fonts" };
    let lack = if names.is_empty() { "lacks" } else { "lack" };
    format!("{fonts} {lack} {}{more}; name a font that has them with --font", shown.join(", "))
}
