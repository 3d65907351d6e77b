//! `pathwarp text WORDS -o OUT.svg`: sets text as outlines, which any deformation takes as its input.

mod badge;
mod in_shape;
mod on_path;
mod style;

use crate::arguments::{self, OUTPUT_OPTIONS, reading_args, some_options};
use crate::commands::args::{choice, option, out_arg, switch, target};
use crate::ending::Status;
use crate::{data, mistakes, terminal};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use pathwarp::deform::Registry;
use pathwarp_engine::export::{self, Exported};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::format::{Choice, DRAWINGS, Format};
use pathwarp_engine::lettering::{REGULAR, bundled, find_font, laid_out_with_installed, read_font};
use pathwarp_engine::links::Destination;
use pathwarp_engine::options::CommonOptions;
use pathwarp_engine::weights::{Wanted, with_variations};
use pathwarp_engine::{Warper, advice, input, output};
use pathwarp_svg::ReadOptions;
use pathwarp_svg::engine::{FontFile, LetteringOptions, write_lettering, write_set_groups};
use pathwarp_text::{Align, Font, TextStyle};
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use style::Em;

pub(super) fn text_command(registry: &Registry) -> Command {
    Command::new("text")
        .about("Set text as outlines, the artwork of any deformation")
        .args(args(registry))
        .after_help(AFTER)
}

pub(super) fn badge_command(_: &Registry) -> Command {
    /// Options of `text` for the font and colour of one line of text.
    const SHARED: [&str; 10] =
        ["out", "font", "weight", "italic", "synthesize", "variation", "fill", "margin", "data", "letter-spacing"];
    let shared = text_and_font().into_iter().chain(spacing()).filter(|a| SHARED.contains(&a.get_id().as_str()));
    Command::new("badge")
        .about("Set two lines in a ring, around a drawing")
        .args(badge::args())
        .args(shared)
        .args(shaping().map(|a| a.help_heading(SHAPING)))
        .args(some_options(&OUTPUT_OPTIONS))
        .args(reading_args())
        .arg(switch("quiet", "Print no warnings").short('q'))
        .after_help(badge::AFTER)
}

/// Sets the text, once or for each row of a table, and writes the drawings. `typed` are the command's arguments, as typed.
pub(super) fn text(registry: &Registry, m: &ArgMatches, typed: &[OsString]) -> Result<Status, Failure> {
    let size = ("size", TextStyle::default().size);
    run(registry, m, typed, &Job { size, font: None, texts: both_texts, draw: |s, t, l| s.text(t, l) })
}

/// Makes the badge, once or for each row of a table, and writes the drawings.
pub(super) fn badge(registry: &Registry, m: &ArgMatches, typed: &[OsString]) -> Result<Status, Failure> {
    let texts = |m: &ArgMatches| {
        let mut words = m.get_many::<String>("WORDS").into_iter().flatten().cloned();
        Ok([words.next(), words.next()])
    };
    run(registry, m, typed, &Job { size: badge::WIDTH, font: Some(badge::FONT), texts, draw: |s, t, l| s.badge(t, l) })
}

/// A command that draws texts.
struct Job {
    /// The option that determines the page's unit, and its default in px.
    size: (&'static str, f64),
    /// The default font, if it is not the bundled one.
    font: Option<&'static str>,
    texts: fn(&ArgMatches) -> Result<[Option<String>; 2], Failure>,
    draw: Draw,
}

type Draw = fn(&Setting<'_>, &[Option<String>; 2], &LetteringOptions) -> Result<Drawn, Failure>;

/// A drawing of texts.
struct Drawn {
    svg: String,
    warnings: Vec<String>,
    /// Characters that no font has.
    missing: BTreeSet<char>,
}

/// Finds the fonts, and runs a job once or for each row of a table.
fn run(registry: &Registry, m: &ArgMatches, typed: &[OsString], job: &Job) -> Result<Status, Failure> {
    let given = m.get_many::<String>("font").into_iter().flatten().map(String::as_str);
    let names: Vec<&str> = given.chain(job.font.filter(|_| !m.contains_id("font"))).collect();
    let files = ["file", "center"].into_iter().filter_map(|f| m.try_get_one::<PathBuf>(f).ok()?.map(PathBuf::as_path));
    let reads: Vec<&Path> = files.chain(names.iter().copied().map(Path::new)).collect();
    let target = target(m, &reads)?;
    let options = arguments::given(m).read()?;
    let format = Choice { what: "lettering is", among: DRAWINGS }.format(target, options.format)?;
    let texts = (job.texts)(m)?;
    let em = Em::given(m, job.size.0, job.size.1)?;
    let style = style::style(m, &em)?;
    let weight = m.get_one::<String>("weight").map(|w| style::weight_of(w)).transpose()?;
    let (italic, synthesize) = (m.get_flag("italic"), m.get_flag("synthesize"));
    let read = options.reading.read_options();
    let find = |name: &&str| find_font(name, weight.unwrap_or(REGULAR), italic, &read);
    let files: Vec<FontFile> = names.iter().map(find).collect::<Result<_, _>>()?;
    let chosen = names.iter().zip(&files).map(|(name, file)| read_font(name, file));
    let chosen: Vec<Font<'_>> = chosen.chain([bundled()]).collect::<Result<_, _>>()?;
    let first = names.first().copied().unwrap_or("the bundled font");
    let wanted = Wanted { weight, italic, synthesize };
    style::check_style(&chosen[0], first, &wanted, &read)?;
    let mut warnings = Vec::new();
    if let Some(used) = wanted.other_weight(&chosen[0]) {
        let asked = m.get_one::<String>("weight").map_or("", String::as_str);
        warnings.push(format!("--weight {asked}: {first} has no such weight; {used:.0} is used"));
    }
    let fonts = with_variations(chosen, &style::axis_positions(m)?, &wanted)?;
    let lines: Vec<&str> = m.get_many::<String>("WORDS").into_iter().flatten().map(String::as_str).collect();
    warnings.extend(mistakes::unit_as_text(typed, &lines));
    if !m.get_flag("quiet") {
        warnings.iter().for_each(|w| terminal::warning(w));
    }
    let fill = m.get_one::<String>("fill").filter(|f| !f.is_empty()).cloned();
    let setting =
        Setting { registry, m, options, read, look: (weight.unwrap_or(REGULAR), italic), format, em, style, fonts };
    if !data::is_given(m) {
        return setting.write(job.draw, &texts, fill, target);
    }
    let templates: Vec<&str> = texts.iter().chain([&fill]).flatten().map(String::as_str).collect();
    data::for_each_row(registry, m, &templates, &reads, |row, target| {
        let texts = texts.each_ref().map(|t| t.as_ref().map(|t| row.filled_lines(t)));
        setting.write(job.draw, &texts, fill.as_ref().map(|f| row.filled(f)), Some(target))
    })
}

/// The fonts and the style for setting texts.
struct Setting<'a> {
    registry: &'a Registry,
    m: &'a ArgMatches,
    options: CommonOptions,
    read: ReadOptions,
    /// Weight and slant (`true` for italic) of fonts that are not named.
    look: (u16, bool),
    format: Format,
    em: Em,
    style: TextStyle,
    fonts: Vec<Font<'a>>,
}

impl Setting<'_> {
    /// Draws texts, and writes the drawing.
    fn write(
        &self,
        draw: Draw,
        texts: &[Option<String>; 2],
        fill: Option<String>,
        target: Option<&Path>,
    ) -> Result<Status, Failure> {
        let Drawn { svg, mut warnings, missing } = draw(self, texts, &self.page(fill, target)?)?;
        let lacking: Vec<char> = missing.into_iter().collect();
        warnings.extend((!lacking.is_empty()).then(|| advice::missing_letters(&lacking)));
        // `Back` keeps links as they are; lettering has none.
        let exported = export::drawing(svg, (self.format, &Destination::Back), &self.read, &self.options, None)?;
        let Exported { bytes, warnings: lost, kerf } = exported;
        if !self.m.get_flag("quiet") {
            warnings.iter().chain(&lost).for_each(|w| terminal::warning(w));
            kerf.iter().for_each(|k| terminal::note(&k.note()));
        }
        output::write(target, &bytes)?;
        Ok(Status::partial_if(!lacking.is_empty() || kerf.is_some_and(|k| k.is_partial())))
    }

    /// Sets a text, and one below it.
    fn text(&self, texts: &[Option<String>; 2], lettering: &LetteringOptions) -> Result<Drawn, Failure> {
        let Self { registry, m, options, .. } = self;
        let limits = options.reading.limits.for_input(texts.iter().flatten().map(String::len).sum());
        let set =
            |text: &String| laid_out_with_installed(text, &self.fonts, &self.style, self.look, &self.read, &limits);
        let [text, below] = texts.each_ref().map(|t| t.as_ref().map(set).transpose());
        let (text, below) = (text?, below?);
        let (svg, warnings) = match &text {
            Some(text) if !on_path::is_asked_for(m) && !in_shape::is_asked_for(m) => {
                (write_lettering(text, lettering)?, Vec::new())
            }
            text => {
                let set = match text {
                    Some(text) if in_shape::is_asked_for(m) => in_shape::set(registry, m, text, &self.em, options)?,
                    _ => on_path::set(registry, m, [text.as_ref(), below.as_ref()], &self.em, options)?,
                };
                let title: Vec<&str> =
                    [text.as_ref(), below.as_ref()].into_iter().flatten().map(|t| t.text.as_str()).collect();
                (write_set_groups(&title.join(" "), &set.lines, lettering)?, set.warnings)
            }
        };
        let missing = text.iter().chain(&below).flat_map(|t| t.missing.iter().copied()).collect();
        let svg = if m.get_flag("unite") { united(registry, svg, m)? } else { svg };
        Ok(Drawn { svg, warnings, missing })
    }

    /// Makes a badge from an upper text and a lower one.
    fn badge(&self, texts: &[Option<String>; 2], lettering: &LetteringOptions) -> Result<Drawn, Failure> {
        let Self { registry, m, fonts, em, options, read, look, .. } = self;
        let badge = badge::Badge { registry, m, fonts, em, options, read, look: *look }.draw(texts)?;
        let title: Vec<&str> = texts.iter().flatten().map(String::as_str).collect();
        let svg = write_set_groups(&title.join(" "), &badge.groups, lettering)?;
        Ok(Drawn { svg, warnings: badge.warnings, missing: badge.missing })
    }

    /// Returns the colour, and the page with its margin. Without `--margin`, only a drawing for display has one: it is written to a
    /// file, not as DXF, and its size has no unit.
    fn page(&self, fill: Option<String>, target: Option<&Path>) -> Result<LetteringOptions, Failure> {
        const MARGIN: f64 = 0.06;
        let is_shown =
            target.is_some_and(|t| !output::is_device(t)) && self.format != Format::Dxf && self.em.unit.is_none();
        let usual = if is_shown { MARGIN * self.em.size } else { 0.0 };
        let margin = self.em.length(self.m, "margin")?.unwrap_or(usual);
        let around_ink = self.style.align == Align::Fill && margin > 0.0;
        Ok(LetteringOptions { fill, margin, around_ink, unit: self.em.unit })
    }
}

fn united(registry: &Registry, svg: String, m: &ArgMatches) -> Result<String, Failure> {
    let mut unite = Warper::edit(registry, "unite", &[("by", "all")]).map_err(|e| Failure::usage(e.to_string()))?;
    if let Some(tolerance) = m.get_one::<String>("tolerance") {
        unite.set_option("tolerance", tolerance).map_err(|e| Failure::usage(e.to_string()))?;
    }
    let drawing = unite.warp_drawing(svg.as_bytes(), None).map_err(|e| Failure::Geometry(e.to_string()))?;
    Ok(String::from_utf8(drawing.bytes).unwrap_or(svg))
}

const SPACING: &str = "Spacing and lines";
const SHAPING: &str = "Shaping";

const AFTER: &str = "The outlines are the font's own curves. The page holds the ink and the lines, and the margin around them. \
Every line is a group with data-baseline, every letter a path with data-glyph (position and advance). A character that no \
font has is drawn as the first font draws missing characters; a warning names it, and the exit code is 1.

Examples:
  pathwarp text Welcome -o word.svg
  pathwarp text Welcome --font 'DejaVu Serif' --weight bold --size 20mm --fill '#a30' -o word.svg
  pathwarp text LOVE MUSIC --align fill --gap 6% -o poster.svg
  pathwarp text LOVE MUSIC ALWAYS --in heart -o heart.svg
  pathwarp text 'The Old\\nBakery' --align center --line-height 110% --letter-spacing 4% -o sign.svg
  pathwarp text Flow --font Variable.ttf --variation wght=650,wdth=90 --features ss01 -o word.svg
  pathwarp text Welcome --size 40mm --unite -o sign.dxf
  pathwarp text '{name}' --data samples/names.csv --font display -o 'out/{name}.svg'
  pathwarp text 'HARBOUR COFFEE' --below 'SINCE 1887' --on circle:r=60mm -o badge.svg
  pathwarp text 'Round and round' --on spiral:turns=2,inner=9mm,outer=40mm --size 8mm -o out.svg
  pathwarp text Welcome | pathwarp bend - --along 'M0,90 Q170,0 340,90' -o arc.svg";

/// An option with a value that is parsed later, and may start with a minus.
fn value(name: &'static str, value: &'static str, help: &'static str) -> Arg {
    option(name, value, help).allow_hyphen_values(true)
}

/// Returns all options, in the order of help.
fn args(registry: &Registry) -> Vec<Arg> {
    let mut all = text_and_font();
    all.push(in_shape::arg());
    all.extend(on_path::args(registry));
    all.extend(some_options(&OUTPUT_OPTIONS));
    all.extend(spacing().map(|a| a.help_heading(SPACING)));
    all.extend(shaping().map(|a| a.help_heading(SHAPING)));
    all.extend(reading_args());
    all.push(switch("quiet", "Print no warnings").short('q'));
    all
}

fn text_and_font() -> Vec<Arg> {
    vec![
        Arg::new("WORDS").num_args(0..).help(
            "The text. \\n and every further argument start a new line; \\\\ is a backslash; - reads standard input",
        ),
        option("file", "FILE", "Read the text from a file; - is standard input")
            .value_parser(value_parser!(PathBuf))
            .conflicts_with("WORDS"),
        out_arg(
            "OUT.svg",
            "Write the drawing to this file: .svg, .svgz, .pdf or .dxf; - or none writes to standard output",
        ),
        value(
            "font",
            "FILE|FAMILY",
            "A font file (FILE#2 is the third font of a collection), an installed family, or display, a bundled heavy condensed face; \
             further fonts supply the characters that the ones before lack [default: the bundled Noto Sans]",
        )
        .action(ArgAction::Append),
        value("size", "LENGTH", "Size of the em; with a unit such as 20mm, the page has that unit too [default: 72]"),
        value(
            "weight",
            "100-900|NAME",
            "Weight within the family (thin, light, regular, medium, bold, black, …); sets the axis wght of a variable font",
        ),
        switch("italic", "Use the family's italic"),
        switch(
            "synthesize",
            "Make what a font lacks: a bolder weight by thickening its outlines, an italic by slanting them by 14°; without it, that is \
             an error",
        ),
        value("variation", "AXIS=N,…", "Positions on the axes of a variable font, such as wght=600,wdth=80")
            .action(ArgAction::Append),
        value("fill", "COLOUR", "Colour, as in CSS [default: black]"),
        switch("unite", "Make one shape of letters that overlap or join, for cutters, as `pathwarp unite` does"),
        value(
            "margin",
            "LENGTH",
            "Margin around the text; percentages refer to the size [default: 6%; 0 on standard output, in DXF, and with a --size in mm or another \
             unit]",
        ),
        data::arg(),
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

/// Returns the text and the text of `--below`; the latter may be alone.
fn both_texts(m: &ArgMatches) -> Result<[Option<String>; 2], Failure> {
    let below = m.get_one::<String>("below").map(|t| unescaped(t));
    let given = m.contains_id("file") || m.get_many::<String>("WORDS").is_some_and(|mut w| w.any(|w| !w.is_empty()));
    let text = (given || below.is_none()).then(|| given_text(m)).transpose()?;
    Ok([text, below])
}

/// Returns the text from the arguments, a file or standard input.
fn given_text(m: &ArgMatches) -> Result<String, Failure> {
    let words: Vec<&str> = m.get_many::<String>("WORDS").into_iter().flatten().map(String::as_str).collect();
    let file = match (m.get_one::<PathBuf>("file"), &words[..]) {
        (Some(file), _) => file.clone(),
        (None, ["-"]) => PathBuf::from("-"),
        (None, []) => return Err(Failure::usage("text: give WORDS, or --file FILE; - reads standard input")),
        (None, words) => return Ok(words.iter().map(|w| unescaped(w)).collect::<Vec<_>>().join("\n")),
    };
    let text = data::decoded(&input::bytes(&file)?, &input::display(&file))?;
    let text = text.strip_suffix('\n').unwrap_or(&text);
    Ok(text.strip_suffix('\r').unwrap_or(text).to_owned())
}

/// Replaces `\n` by a newline and `\\` by a backslash.
fn unescaped(word: &str) -> String {
    let parts = word.split(r"\\").map(|part| part.replace(r"\n", "\n"));
    parts.collect::<Vec<_>>().join(r"\")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escapes() {
        assert_eq!(unescaped(r"a\nb\\n\t\"), "a\nb\\n\\t\\");
        assert_eq!(unescaped(r"\\\n\n\\\"), "\\\n\n\\\\");
    }
}
