//! The options of `pathwarp text`.

use super::super::file_args;
use super::on_path;
use crate::options::{reading_args, some_options};
use clap::{Arg, ArgAction, value_parser};
use pathwarp::deform::Registry;
use std::path::PathBuf;

const SPACING: &str = "Spacing and lines";
const SHAPING: &str = "Shaping";

pub(super) const AFTER: &str = "The outlines are the font's own curves. The page holds the ink and the lines; --margin adds room around them. \
Every line is a group with data-baseline, every letter a path with data-glyph (position and advance). A character that no \
font has is drawn as the first font draws missing characters; a warning names it, and the exit code is 1.

Examples:
  pathwarp text Welcome -o word.svg
  pathwarp text Welcome --font 'DejaVu Serif' --weight bold --size 20mm --fill '#a30' -o word.svg
  pathwarp text LOVE MUSIC --align fill --gap 6% -o poster.svg
  pathwarp text 'The Old\\nBakery' --align center --line-height 110% --letter-spacing 4% -o sign.svg
  pathwarp text Flow --font Variable.ttf --variation wght=650,wdth=90 --features ss01 -o word.svg
  pathwarp text Welcome --size 40mm -o sign.dxf
  pathwarp text 'HARBOUR COFFEE' --below 'SINCE 1887' --on circle:r=60mm -o badge.svg
  pathwarp text 'Round and round' --on spiral:turns=2,inner=9mm,outer=40mm --size 8mm -o out.svg
  pathwarp text Welcome | pathwarp bend - --along 'M0,90 Q170,0 340,90' -o arc.svg";

/// An option with a value that is parsed later, and may start with a minus.
fn value(name: &'static str, value: &'static str, help: &'static str) -> Arg {
    Arg::new(name).long(name).value_name(value).allow_hyphen_values(true).help(help)
}

/// An option with one of these words as its value.
fn choice(name: &'static str, words: &'static [&'static str], help: &'static str) -> Arg {
    Arg::new(name)
        .long(name)
        .value_name(words.join("|"))
        .value_parser(words.to_vec())
        .hide_possible_values(true)
        .help(help)
}

/// All options, in the order of help.
pub(super) fn args(registry: &Registry) -> Vec<Arg> {
    let mut all = text_and_font();
    all.extend(on_path::args(registry));
    all.extend(some_options(&["format", "dxf-curves", "tolerance"]));
    all.extend(spacing().map(|a| a.help_heading(SPACING)));
    all.extend(shaping().map(|a| a.help_heading(SHAPING)));
    all.extend(reading_args());
    all.push(Arg::new("quiet").short('q').long("quiet").action(ArgAction::SetTrue).help("Print no warnings"));
    all
}

fn text_and_font() -> Vec<Arg> {
    vec![
        Arg::new("WORDS").num_args(0..).help(
            "The text. \\n and every further argument start a new line; \\\\ is a backslash; - reads standard input",
        ),
        Arg::new("file")
            .long("file")
            .value_name("FILE")
            .value_parser(value_parser!(PathBuf))
            .conflicts_with("WORDS")
            .help("Read the text from a file; - is standard input"),
        file_args::out(
            "OUT.svg",
            "Write the drawing to this file: .svg, .svgz, .pdf or .dxf; - or none writes to standard output",
        ),
        value(
            "font",
            "FILE|FAMILY",
            "A font file (FILE#2 is the third font of a collection) or an installed family; further fonts supply the \
             characters that the ones before lack [default: the bundled Noto Sans]",
        )
        .action(ArgAction::Append),
        value("size", "LENGTH", "Size of the em; with a unit such as 20mm, the page has that unit too [default: 72]"),
        value(
            "weight",
            "100-900|NAME",
            "Weight within the family (thin, light, regular, medium, bold, black, …); sets the axis wght of a variable font",
        ),
        Arg::new("italic").long("italic").action(ArgAction::SetTrue).help("Use the family's italic"),
        Arg::new("synthesize").long("synthesize").action(ArgAction::SetTrue).help(
            "Make what a font lacks: a bolder weight by thickening its outlines, an italic by slanting them by 14°; without it, that is \
             an error",
        ),
        value("variation", "AXIS=N,…", "Positions on the axes of a variable font, such as wght=600,wdth=80")
            .action(ArgAction::Append),
        value("fill", "COLOUR", "Colour, as in CSS [default: black]"),
        value("margin", "LENGTH", "Margin around the text; percentages refer to the size [default: 0]"),
    ]
}

fn spacing() -> impl Iterator<Item = Arg> {
    [
        value("letter-spacing", "LENGTH", "Space added between letters; percentages refer to the size [default: 0]"),
        value("word-spacing", "LENGTH", "Space added to every word space; percentages refer to the size [default: 0]"),
        value(
            "line-height",
            "LENGTH",
            "Distance between baselines; percentages refer to the size [default: the font's line height]",
        ),
        value("gap", "LENGTH", "Distance between lines from ink to ink, instead of a line height, and between repeats on a path; percentages refer to the size")
            .conflicts_with("line-height"),
        choice(
            "align",
            &["start", "left", "center", "right", "justify", "fill"],
            "Alignment of lines; justify widens the word spaces of shorter lines, fill sizes every line until its ink is as wide as \
             that of the widest [default: start, on a path center]",
        ),
    ]
    .into_iter()
}

fn shaping() -> impl Iterator<Item = Arg> {
    [
        choice("kerning", &["on", "off"], "Kern pairs of letters [default: on]"),
        choice(
            "ligatures",
            &["auto", "on", "off"],
            "Use optional ligatures; auto uses them unless letters are spaced [default: auto]",
        ),
        value("features", "TAG[=N],…", "OpenType features, such as ss01,liga=0,salt=2").action(ArgAction::Append),
        choice(
            "direction",
            &["auto", "ltr", "rtl"],
            "Base direction of the text; auto follows its first letter [default: auto]",
        ),
        value("language", "TAG", "Language of the text, such as sr, tr or nl; selects the forms a font has for it"),
        value("script", "CODE", "Script of all text, such as Latn, Arab or Deva [default: that of each letter]"),
    ]
    .into_iter()
}
