//! `pathwarp text WORDS -o OUT.svg`: lettering as outlines, the input of any deformation.

use crate::failure::Failure;
use crate::output::Pending;
use crate::{Outcome, deform, output, terminal};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use pathwarp::kurbo::Rect;
use pathwarp::param::{Args, Axis, Frame, Settings};
use pathwarp_svg::{FontFile, LetteringOptions, bundled_font, system_font, write_lettering};
use pathwarp_text::{Align, Direction, Font, Ligatures, Style, Variation, features, layout, variations};
use std::path::{Path, PathBuf};

/// The weight of regular fonts, and what some others are called (OpenType 1.9.1, OS/2 usWeightClass).
const WEIGHTS: [(&str, u16); 9] = [
    ("thin", 100),
    ("extralight", 200),
    ("light", 300),
    ("regular", 400),
    ("medium", 500),
    ("semibold", 600),
    ("bold", 700),
    ("extrabold", 800),
    ("black", 900),
];
const REGULAR: u16 = 400;

pub(crate) fn command() -> Command {
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
    Command::new("text")
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
        .arg(
            Arg::new("out")
                .short('o')
                .long("out")
                .value_name("OUT.svg")
                .value_parser(value_parser!(PathBuf))
                .help("Where to write the drawing; - or none writes to standard output"),
        )
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

pub(crate) fn run(m: &ArgMatches) -> Result<Outcome, Failure> {
    let word = |name: &str| m.get_one::<String>(name).map_or("", String::as_str);
    let text = text(m)?;
    let style = style(m)?;
    let weight = m.get_one::<String>("weight").map(|w| weight_of(w)).transpose()?;
    let names: Vec<&str> = m.get_many::<String>("font").into_iter().flatten().map(String::as_str).collect();
    let files: Vec<(&str, FontFile)> = names
        .iter()
        .map(|name| find(name, weight.unwrap_or(REGULAR), m.get_flag("italic")).map(|file| (*name, file)))
        .collect::<Result<_, _>>()?;
    let mut fonts: Vec<Font<'_>> = Vec::with_capacity(files.len() + 1);
    for (name, file) in &files {
        fonts.push(Font::new(&file.bytes, file.index).map_err(|e| Failure::Input(format!("{name}: {e}")))?);
    }
    let bundled = Font::new(bundled_font(), 0).map_err(|e| Failure::Input(e.to_string()))?;
    fonts.push(bundled);
    let fonts = at_place(fonts, &places(m)?, weight)?;

    let set = layout(&text, &fonts, &style).map_err(|e| failure(&e))?;
    let fill = Some(word("fill")).filter(|f| !f.is_empty()).map(str::to_owned);
    let margin = length(m, "margin", style.size)?.unwrap_or(0.0);
    let svg = write_lettering(&set, &LetteringOptions { fill, margin })?;
    if !set.missing.is_empty() && !m.get_flag("quiet") {
        terminal::warning(&missing(&set.missing, &names));
    }
    match m.get_one::<PathBuf>("out").filter(|o| o.as_os_str() != "-") {
        Some(out) => Pending::commit_all(vec![Pending::new(out, svg.as_bytes())?])?,
        None => output::to_stdout(svg.as_bytes())?,
    }
    Ok(if set.missing.is_empty() { Outcome::Done } else { Outcome::Partly })
}

/// The text of the arguments, a file or standard input.
fn text(m: &ArgMatches) -> Result<String, Failure> {
    let words: Vec<&str> = m.get_many::<String>("WORDS").into_iter().flatten().map(String::as_str).collect();
    let file = match (m.get_one::<PathBuf>("file"), &words[..]) {
        (Some(file), _) => file.clone(),
        (None, ["-"]) => PathBuf::from("-"),
        (None, []) => return Err(Failure::usage("text: WORDS are needed, or --file FILE; - reads standard input")),
        (None, words) => return Ok(words.iter().map(|w| unescaped(w)).collect::<Vec<_>>().join("\n")),
    };
    let name = deform::display(&file);
    let text = String::from_utf8(deform::read(&file)?)
        .map_err(|e| Failure::Input(format!("{name}: is no UTF-8 text (byte {})", e.utf8_error().valid_up_to())))?;
    // A byte order mark is no character, and the newline at a file's end starts no line.
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let text = text.strip_suffix('\n').unwrap_or(text);
    Ok(text.strip_suffix('\r').unwrap_or(text).to_owned())
}

/// `\n` and `\\` as what they stand for.
fn unescaped(word: &str) -> String {
    let mut out = String::with_capacity(word.len());
    let mut chars = word.chars().peekable();
    while let Some(c) = chars.next() {
        match (c, chars.peek()) {
            ('\\', Some('n')) => {
                chars.next();
                out.push('\n');
            }
            ('\\', Some('\\')) => {
                chars.next();
                out.push('\\');
            }
            _ => out.push(c),
        }
    }
    out
}

fn style(m: &ArgMatches) -> Result<Style, Failure> {
    let word = |name: &str| m.get_one::<String>(name).map(String::as_str);
    let base = Style::default();
    let size = length(m, "size", base.size)?.unwrap_or(base.size);
    let mut all = Vec::new();
    for list in m.get_many::<String>("features").into_iter().flatten() {
        all.extend(features(list).map_err(|e| Failure::usage(format!("--features: {e}")))?);
    }
    Ok(Style {
        size,
        letter_spacing: length(m, "letter-spacing", size)?.unwrap_or(0.0),
        word_spacing: length(m, "word-spacing", size)?.unwrap_or(0.0),
        line_height: length(m, "line-height", size)?,
        align: match word("align") {
            Some("left") => Align::Left,
            Some("center") => Align::Center,
            Some("right") => Align::Right,
            Some("justify") => Align::Justify,
            _ => Align::Start,
        },
        direction: match word("direction") {
            Some("ltr") => Direction::Ltr,
            Some("rtl") => Direction::Rtl,
            _ => Direction::Auto,
        },
        script: word("script").map(str::to_owned),
        language: word("language").map(str::to_owned),
        kerning: word("kerning") != Some("off"),
        ligatures: match word("ligatures") {
            Some("on") => Ligatures::On,
            Some("off") => Ligatures::Off,
            _ => Ligatures::Auto,
        },
        features: all,
    })
}

/// A length with a unit; `%` is of `size`.
fn length(m: &ArgMatches, name: &str, size: f64) -> Result<Option<f64>, Failure> {
    let Some(text) = m.get_one::<String>(name) else { return Ok(None) };
    let frame = Frame::new(Rect::new(0.0, 0.0, size, size));
    let args = Args::new();
    Ok(Some(Settings::new(&[], &args, &frame)?.length_in(name, text, Axis::X)?))
}

fn weight_of(text: &str) -> Result<u16, Failure> {
    let named = WEIGHTS.iter().find(|(name, _)| text.eq_ignore_ascii_case(name)).map(|(_, w)| *w);
    let weight = named.or_else(|| text.parse().ok()).filter(|w| (1..=1000).contains(w));
    weight.ok_or_else(|| {
        let names: Vec<&str> = WEIGHTS.iter().map(|(name, _)| *name).collect();
        Failure::usage(format!("--weight: `{text}` is neither a number from 1 to 1000 nor one of {}", names.join(", ")))
    })
}

/// What is given as places on axes.
fn places(m: &ArgMatches) -> Result<Vec<Variation>, Failure> {
    let mut all = Vec::new();
    for list in m.get_many::<String>("variation").into_iter().flatten() {
        all.extend(variations(list).map_err(|e| Failure::usage(format!("--variation: {e}")))?);
    }
    Ok(all)
}

/// The fonts at their places: `--variation` means the first font; `--weight` every one that has such an axis.
fn at_place<'a>(fonts: Vec<Font<'a>>, places: &[Variation], weight: Option<u16>) -> Result<Vec<Font<'a>>, Failure> {
    let mut out = Vec::with_capacity(fonts.len());
    for (i, font) in fonts.into_iter().enumerate() {
        let mut own = Vec::new();
        if let Some(w) = weight
            && let Some(axis) = font.axes().iter().find(|a| a.tag == "wght")
        {
            own.extend(Variation::new("wght", f64::from(w).clamp(axis.min, axis.max)).ok());
        }
        if i == 0 {
            own.extend_from_slice(places);
        }
        let font = if own.is_empty() {
            font
        } else {
            font.with_variations(&own).map_err(|e| Failure::usage(format!("--variation: {e}")))?
        };
        out.push(font);
    }
    Ok(out)
}

/// A font by its file, or else by its family.
fn find(name: &str, weight: u16, italic: bool) -> Result<FontFile, Failure> {
    let read = |path: &Path, index| deform::read(path).map(|bytes| FontFile { bytes, index });
    let path = Path::new(name);
    if path.is_file() {
        return read(path, 0);
    }
    if let Some((file, index)) = name.rsplit_once('#')
        && let Ok(index) = index.parse()
    {
        return read(Path::new(file), index);
    }
    let kinds = ["ttf", "otf", "ttc", "otc", "woff", "woff2", "pfb"];
    let looks_like_file = name.contains(['/', '\\'])
        || path.extension().and_then(|e| e.to_str()).is_some_and(|e| kinds.iter().any(|k| e.eq_ignore_ascii_case(k)));
    if looks_like_file {
        return read(path, 0);
    }
    Ok(system_font(name, weight, italic)?)
}

/// What is wrong with the options is wrong usage; the rest is a font's or a text's fault.
fn failure(e: &pathwarp_text::Error) -> Failure {
    use pathwarp_text::Error as E;
    match e {
        E::Style { .. } | E::Empty => Failure::usage(e.to_string()),
        E::Setting { .. } => Failure::usage(format!("--script or --language: {e}")),
        _ => Failure::Input(e.to_string()),
    }
}

fn missing(chars: &[char], names: &[&str]) -> String {
    /// More than this are not read by anybody.
    const SHOWN: usize = 12;
    let shown: Vec<String> = chars.iter().take(SHOWN).map(|c| format!("{c} (U+{:04X})", u32::from(*c))).collect();
    let more = chars.len().saturating_sub(SHOWN);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let fonts = if names.is_empty() { "the bundled font" } else { "the fonts" };
    let lack = if names.is_empty() { "lacks" } else { "lack" };
    format!("{fonts} {lack} {}{more}; name a font that has them with --font", shown.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escapes() {
        assert_eq!(unescaped(r"a\nb\\n\t\"), "a\nb\\n\\t\\");
    }
}
