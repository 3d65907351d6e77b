//! `pathwarp text WORDS -o OUT.svg`: sets text as outlines, which any deformation takes as its input.

mod args;
mod fonts;
mod on_path;
mod style;
mod words;

use super::file_args;
use crate::advice::mistakes;
use crate::export;
use crate::failure::Failure;
use crate::format::{Choice, DRAWINGS};
use crate::options::Given;
use crate::status::Status;
use crate::{advice, output, terminal};
use clap::{ArgMatches, Command};
use fonts::Wanted;
use pathwarp::budget::{Exceeded, Limit, Limits, cost};
use pathwarp::deform::Registry;
use pathwarp_svg::{FontFile, LetteringOptions, bundled_font, write_lettering, write_set_lines};
use pathwarp_text::{Font, TextLimits, layout_within};
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use style::Em;

pub(super) const NAME: &str = "text";

pub(super) fn command(registry: &Registry) -> Command {
    Command::new(NAME)
        .about("Set text as outlines, the artwork of any deformation")
        .args(args::args(registry))
        .after_help(args::AFTER)
}

/// Sets the text and writes the drawing.
pub(super) fn run(registry: &Registry, m: &ArgMatches, words: &[OsString]) -> Result<Status, Failure> {
    let read = m.get_one::<PathBuf>("file").map(PathBuf::as_path).into_iter();
    let names: Vec<&str> = m.get_many::<String>("font").into_iter().flatten().map(String::as_str).collect();
    let target = file_args::target(m, read.chain(names.iter().map(Path::new)))?;
    let options = Given::options(m).read()?;
    let format = Choice { what: "lettering is", among: DRAWINGS }.format(target, options.format)?;
    let texts = words::both(m)?;
    let em = Em::given(m)?;
    let style = style::style(m, &em)?;
    let weight = m.get_one::<String>("weight").map(|w| fonts::weight_of(w)).transpose()?;
    let (italic, synthesize) = (m.get_flag("italic"), m.get_flag("synthesize"));
    let read = options.reading.read_options();
    let find = |name: &&str| fonts::find(name, weight.unwrap_or(fonts::REGULAR), italic, &read);
    let files: Vec<FontFile> = names.iter().map(find).collect::<Result<_, _>>()?;
    let mut chosen: Vec<Font<'_>> = Vec::with_capacity(files.len() + 1);
    for (name, file) in names.iter().zip(&files) {
        chosen.push(Font::new(&file.bytes, file.index).map_err(|e| Failure::Input(format!("{name}: {e}")))?);
    }
    chosen.push(Font::new(bundled_font(), 0).map_err(|e| Failure::Input(e.to_string()))?);
    let first = names.first().copied().unwrap_or("the bundled font");
    fonts::check_style(&chosen[0], first, &Wanted { weight, italic, synthesize }, &read)?;
    let wanted = Wanted { weight, italic, synthesize };
    if let Some(has) = wanted.other_weight(&chosen[0]).filter(|_| !m.get_flag("quiet")) {
        let asked = m.get_one::<String>("weight").map_or("", String::as_str);
        terminal::warning(&format!("--weight {asked}: {first} has no such weight; {has:.0} is used"));
    }
    let chosen = fonts::with_variations(chosen, &fonts::axis_positions(m)?, &Wanted { weight, italic, synthesize })?;

    let limits = options.reading.limits.for_input(texts.iter().flatten().map(String::len).sum());
    let most = |cost: f64| (limits.of(Limit::Work) / cost) as usize;
    let most = TextLimits { letters: most(cost::LETTER), segments: most(cost::SEGMENT) };
    let set = |text: &String| layout_within(text, &chosen, &style, &most).map_err(|e| failure(&e, &limits));
    let [text, below] = texts.map(|t| t.as_ref().map(set).transpose());
    let (text, below) = (text?, below?);
    let fill = m.get_one::<String>("fill").filter(|f| !f.is_empty()).cloned();
    let margin = em.length(m, "margin")?.unwrap_or(0.0);
    let lettering = LetteringOptions { fill, margin, unit: em.unit };
    let lines: Vec<&str> = m.get_many::<String>("WORDS").into_iter().flatten().map(String::as_str).collect();
    let mut warnings: Vec<String> = mistakes::unit_as_text(words, &lines).into_iter().collect();
    let svg = match &text {
        Some(text) if !on_path::is_asked_for(m) => write_lettering(text, &lettering)?,
        _ => {
            let on_path = on_path::set(registry, m, [text.as_ref(), below.as_ref()], &em, &options)?;
            warnings.extend(on_path.warnings);
            write_set_lines(&on_path.lines, &lettering)?
        }
    };
    let lacking: BTreeSet<char> = text.iter().chain(&below).flat_map(|t| t.missing.iter().copied()).collect();
    let lacking: Vec<char> = lacking.into_iter().collect();
    warnings.extend((!lacking.is_empty()).then(|| missing(&lacking, &names)));
    if !m.get_flag("quiet") {
        warnings.iter().for_each(|w| terminal::warning(w));
    }
    let result = export::drawing(svg, format, &read, &options, None)?;
    output::write(target, &result.bytes)?;
    Ok(Status::partial_if(!lacking.is_empty()))
}

/// Maps an error of the layout: a bad option is wrong usage, anything else a problem of the font or the text.
fn failure(e: &pathwarp_text::Error, limits: &Limits) -> Failure {
    use pathwarp_text::Error as E;
    match e {
        E::Style { .. } | E::Empty => Failure::usage(e.to_string()),
        E::Setting { .. } => Failure::usage(format!("--script or --language: {e}")),
        &E::TooLarge { needed, most, .. } => {
            let work = limits.of(Limit::Work);
            let needed = work * needed as f64 / most as f64;
            let exceeded = Exceeded { limit: Limit::Work, most: work, needed, cut: true };
            Failure::Input(format!("{e}; {}", advice::raise(&exceeded)))
        }
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
