//! The options that every deformation shares.

use crate::failure::Failure;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, value_parser};
use pathwarp::kurbo::Rect;
use pathwarp_svg::LetteringFrame;
use std::ffi::OsString;
use std::path::PathBuf;

/// The default tolerance as a part of the artwork's diagonal: a tenth of a pixel on a poster-sized screen, and finer than any
/// plotter draws.
const TOLERANCE_OF_DIAGONAL: f64 = 1e-4;

/// Where a percentage gets its meaning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum FrameChoice {
    /// Not said: the artwork, or of lettering what a deformation with a baseline wants.
    Default,
    Artwork,
    Lettering(LetteringFrame),
    ViewBox,
    Rect(Rect),
}

/// What becomes of gradients.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum GradientChoice {
    Fit,
    Exact,
    Keep,
}

/// The common options, read.
#[derive(Debug, Clone)]
pub(crate) struct Common {
    pub(crate) inputs: Vec<PathBuf>,
    pub(crate) out: Option<PathBuf>,
    pub(crate) out_dir: Option<PathBuf>,
    /// The copy of an XCF that the result is put into.
    pub(crate) into: Option<PathBuf>,
    /// Whether a damaged file of GIMP's gives the paths before the damage.
    pub(crate) salvage: bool,
    pub(crate) tolerance: Option<f64>,
    pub(crate) certify: bool,
    pub(crate) merge: bool,
    pub(crate) frame: FrameChoice,
    pub(crate) select: Vec<String>,
    pub(crate) exclude: Vec<String>,
    pub(crate) precision: Option<u8>,
    pub(crate) strokes: pathwarp_svg::Strokes,
    pub(crate) text: pathwarp_svg::TextMode,
    pub(crate) gradients: GradientChoice,
    pub(crate) patterns: pathwarp_svg::Patterns,
    pub(crate) page: pathwarp_svg::PageFit,
    pub(crate) structure: pathwarp_svg::Structure,
    /// Whether bitmaps in drawings are bent.
    pub(crate) images: bool,
    pub(crate) image_dpi: Option<f64>,
    pub(crate) image_size: Option<(u32, Option<u32>)>,
    pub(crate) on_error: pathwarp_svg::OnError,
    pub(crate) report: Option<PathBuf>,
    pub(crate) preview: Option<PathBuf>,
    pub(crate) write_recipe: Option<PathBuf>,
    pub(crate) embed_recipe: bool,
    /// The options that shape the result, as given: what a recipe saves.
    pub(crate) given: Vec<(String, Vec<String>)>,
    pub(crate) explain: bool,
    pub(crate) jobs: Option<usize>,
    pub(crate) quiet: bool,
}

/// The arguments for clap.
pub(crate) fn args() -> Vec<Arg> {
    let file = |name: &'static str| Arg::new(name).long(name).value_name("FILE").value_parser(value_parser!(PathBuf));
    let flag = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue);
    let choice = |name: &'static str, words: &'static [&'static str]| {
        Arg::new(name).long(name).value_name(words.join("|")).value_parser(words.to_vec()).hide_possible_values(true)
    };
    let all = vec![
        Arg::new("INPUT")
            .num_args(0..)
            .value_parser(value_parser!(PathBuf))
            .help("SVG files (also .svgz), PNG and JPEG pictures, GIMP's paths (XCF, point lists; FILE or FILE#NAME); - or none reads standard input"),
        Arg::new("out").short('o').long("out").value_name("OUT").value_parser(value_parser!(PathBuf)).help(
            "Where to write the result; - or none writes to standard output",
        ),
        Arg::new("out-dir")
            .long("out-dir")
            .value_name("DIR")
            .value_parser(value_parser!(PathBuf))
            .conflicts_with("out")
            .help("Where to write the results of several inputs, under their own names"),
        Arg::new("into")
            .long("into")
            .value_name("COPY.xcf")
            .value_parser(value_parser!(PathBuf))
            .conflicts_with_all(["out", "out-dir"])
            .help("For an XCF: write it to COPY with its paths warped and every other byte kept"),
        flag("salvage").help("Of a damaged file of GIMP's, take the paths before the damage"),
        Arg::new("tolerance")
            .long("tolerance")
            .value_name("D")
            .allow_negative_numbers(true)
            .help("Largest distance between the true curve and the output, in user units; default 1e-4 of the artwork's diagonal"),
        flag("certify").help("Prove the distance where the deformation allows it, rather than measure it"),
        choice("merge", &["on", "off"]).help("Join pieces across smooth joints where that saves nodes; off keeps every node of the source [default: on]"),
        Arg::new("frame")
            .long("frame")
            .value_name("artwork|viewbox|baseline-ascent|baseline-capheight|…|X,Y,W,H")
            .allow_hyphen_values(true)
            .help(
                "The box that percentages and defaults refer to. Of lettering (text, or made by `pathwarp text`) also \
                 baseline-ascent, baseline-capheight, baseline-xheight (from the baseline up, between the ends of the lines), \
                 ascent-descent, or ink, the letters' own box [default: artwork; baseline-ascent where a deformation with a \
                 --baseline gets lettering and nothing else]",
            ),
        Arg::new("select")
            .long("select")
            .value_name("SEL")
            .action(ArgAction::Append)
            .help("Warp only these: #id, .class, an element's tag, or a label; may be given several times"),
        Arg::new("exclude")
            .long("exclude")
            .value_name("SEL")
            .action(ArgAction::Append)
            .help("Leave these as they are"),
        Arg::new("precision")
            .long("precision")
            .value_name("N")
            .value_parser(value_parser!(u8).range(0..=15))
            .help("Decimals of coordinates; default: enough for a hundredth of the tolerance"),
        choice("strokes", &["auto", "keep", "scale", "outline"]).help(
            "Strokes: keep their width, scale it by the local stretch, or turn them into outlines that are warped; auto scales \
             where that looks right and outlines elsewhere [default: auto]",
        ),
        choice("text", &["outline", "skip"]).help("Text: warp its outlines, or leave it as it is [default: outline]"),
        choice("gradients", &["fit", "exact", "keep"]).help(
            "Gradients: follow the artwork as an affine map can, become a picture cut to the shape where that would be seen to be \
             wrong, or stay [default: fit]",
        ),
        choice("patterns", &["auto", "instantiate", "fit", "keep"]).help(
            "Patterns: warp their tiles one by one, follow the artwork as an affine map can, or stay; auto warps tiles where \
             the difference is seen and they are not too many [default: auto]",
        ),
        choice("fit", &["none", "grow", "page"]).help(
            "The page: leave it, grow it to hold the warped artwork, or make it the artwork's box; a warning tells what leaves it \
             [default: none]",
        ),
        choice("structure", &["auto", "keep", "flatten"]).help(
            "The document: keep its text and structure wherever possible, insist on it, or write a flat new one [default: auto]",
        ),
        choice("images", &["warp", "keep"]).help(
            "Bitmaps in a drawing: warp their pixels, or place them as an affine map can [default: warp]",
        ),
        Arg::new("image-dpi").long("image-dpi").value_name("N").help(
            "Resolution of the warped bitmaps in a drawing, in pixels per inch of it; default: as fine as keeps every detail",
        ),
        Arg::new("image-size")
            .long("image-size")
            .value_name("W[xH]")
            .help("Pixels of the result when a PNG or JPEG is warped [default: as large as the warped picture is]"),
        choice("on-error", &["stop", "skip"]).help("A shape that cannot be warped: stop, or leave it as it is [default: stop]"),
        file("report").help("Write what was done, shape by shape, as JSON"),
        file("write-recipe").help("Save this command line as a recipe for `pathwarp run`"),
        flag("embed-recipe").help("Keep the recipe and the source in the output's <metadata>; `pathwarp unwarp` gives them back"),
        file("preview").help("Draw the artwork, its guides and the result as a PNG"),
        flag("explain").help("Say what was decided on your behalf: corners, sides, directions"),
        Arg::new("jobs").short('j').long("jobs").value_name("N").value_parser(value_parser!(u16).range(1..)).help(
            "Threads to use; default: one per core. The output does not depend on it",
        ),
        flag("quiet").short('q').help("No warnings, no progress"),
    ];
    all.into_iter().map(|a| if a.get_id() == "INPUT" { a } else { a.help_heading("Common options") }).collect()
}

/// Options that say where things go or how loud to be, rather than what the result is.
const OF_THE_RUN: [&str; 12] = [
    "INPUT",
    "out",
    "out-dir",
    "into",
    "report",
    "preview",
    "write-recipe",
    "embed-recipe",
    "explain",
    "jobs",
    "quiet",
    "inverse",
];

/// All but the inputs.
pub(crate) fn options() -> impl Iterator<Item = Arg> {
    args().into_iter().filter(|a| a.get_id() != "INPUT")
}

/// The common options of a command line, as words that say the same.
pub(crate) fn as_typed(m: &ArgMatches) -> Vec<OsString> {
    let mut out = Vec::new();
    for a in options() {
        let id = a.get_id().as_str();
        if m.value_source(id) != Some(ValueSource::CommandLine) {
            continue;
        }
        if !a.get_action().takes_values() {
            out.push(format!("--{id}").into());
            continue;
        }
        for value in m.get_raw(id).into_iter().flatten() {
            let mut word = OsString::from(format!("--{id}="));
            word.push(value);
            out.push(word);
        }
    }
    out
}

/// The options that a recipe may hold, with their help.
pub(crate) fn recipe_options() -> impl Iterator<Item = (String, String)> {
    let shaping = args().into_iter().filter(|a| !OF_THE_RUN.contains(&a.get_id().as_str()));
    shaping.map(|a| (a.get_id().to_string(), a.get_help().map(ToString::to_string).unwrap_or_default()))
}

fn given(m: &ArgMatches) -> Vec<(String, Vec<String>)> {
    let mut out = Vec::new();
    for a in args() {
        let id = a.get_id().as_str();
        if OF_THE_RUN.contains(&id) || m.value_source(id) != Some(ValueSource::CommandLine) {
            continue;
        }
        let values = m.get_raw(id).into_iter().flatten().map(|v| v.to_string_lossy().into_owned());
        let values: Vec<String> =
            if a.get_action().takes_values() { values.collect() } else { vec!["true".to_owned()] };
        out.push((id.to_owned(), values));
    }
    out
}

impl Common {
    pub(crate) fn read(m: &ArgMatches) -> Result<Self, Failure> {
        let path = |name: &str| m.get_one::<PathBuf>(name).cloned();
        let word = |name: &str| m.get_one::<String>(name).map_or("", String::as_str);
        let words = |name: &str| m.get_many::<String>(name).map(|v| v.cloned().collect()).unwrap_or_default();
        let positive = |name: &str| -> Result<Option<f64>, Failure> {
            let Some(text) = m.get_one::<String>(name) else { return Ok(None) };
            match text.parse::<f64>() {
                Ok(v) if v > 0.0 && v.is_finite() => Ok(Some(v)),
                _ => Err(Failure::usage(format!("--{name}: `{text}` is not a positive number"))),
            }
        };
        let common = Self {
            inputs: m.get_many::<PathBuf>("INPUT").map(|v| v.cloned().collect()).unwrap_or_default(),
            out: path("out").filter(|p| p.as_os_str() != "-"),
            out_dir: path("out-dir"),
            into: path("into"),
            salvage: m.get_flag("salvage"),
            tolerance: positive("tolerance")?,
            certify: m.get_flag("certify"),
            merge: word("merge") != "off",
            frame: frame(m.get_one::<String>("frame"))?,
            select: words("select"),
            exclude: words("exclude"),
            precision: m.get_one::<u8>("precision").copied(),
            strokes: match word("strokes") {
                "keep" => pathwarp_svg::Strokes::Keep,
                "scale" => pathwarp_svg::Strokes::Scale,
                "outline" => pathwarp_svg::Strokes::Outline,
                _ => pathwarp_svg::Strokes::Auto,
            },
            text: if word("text") == "skip" { pathwarp_svg::TextMode::Skip } else { pathwarp_svg::TextMode::Outline },
            gradients: match word("gradients") {
                "exact" => GradientChoice::Exact,
                "keep" => GradientChoice::Keep,
                _ => GradientChoice::Fit,
            },
            patterns: match word("patterns") {
                "instantiate" => pathwarp_svg::Patterns::Instantiate,
                "fit" => pathwarp_svg::Patterns::Fit,
                "keep" => pathwarp_svg::Patterns::Keep,
                _ => pathwarp_svg::Patterns::Auto,
            },
            page: match word("fit") {
                "grow" => pathwarp_svg::PageFit::Grow,
                "page" => pathwarp_svg::PageFit::Page,
                _ => pathwarp_svg::PageFit::None,
            },
            structure: match word("structure") {
                "keep" => pathwarp_svg::Structure::Keep,
                "flatten" => pathwarp_svg::Structure::Flatten,
                _ => pathwarp_svg::Structure::Auto,
            },
            images: word("images") != "keep",
            image_dpi: positive("image-dpi")?,
            image_size: m.get_one::<String>("image-size").map(|t| image_size(t)).transpose()?,
            on_error: if word("on-error") == "skip" {
                pathwarp_svg::OnError::Skip
            } else {
                pathwarp_svg::OnError::Stop
            },
            report: path("report"),
            preview: path("preview"),
            write_recipe: path("write-recipe"),
            embed_recipe: m.get_flag("embed-recipe"),
            given: given(m),
            explain: m.get_flag("explain"),
            jobs: m.get_one::<u16>("jobs").map(|n| usize::from(*n)),
            quiet: m.get_flag("quiet"),
        };
        if common.inputs.len() > 1 {
            if common.out_dir.is_none() {
                return Err(Failure::usage("several inputs need --out-dir DIR; their results cannot share one file"));
            }
            if common.into.is_some() {
                return Err(Failure::usage("--into writes one file; give one XCF"));
            }
            if common.preview.is_some() {
                return Err(Failure::usage("--preview draws one input; give one"));
            }
        }
        Ok(common)
    }

    /// The tolerance for artwork of this box.
    pub(crate) fn tolerance_for(&self, artwork: Option<Rect>) -> f64 {
        let diagonal = artwork.map_or(0.0, |r| r.width().hypot(r.height()));
        self.tolerance.unwrap_or(if diagonal > 0.0 { diagonal * TOLERANCE_OF_DIAGONAL } else { TOLERANCE_OF_DIAGONAL })
    }
}

/// A size typed as W or `WxH`.
fn image_size(text: &str) -> Result<(u32, Option<u32>), Failure> {
    let number = |t: &str| t.trim().parse::<u32>().ok().filter(|n| *n > 0);
    let size = match text.split_once(['x', 'X', '×']) {
        None => number(text).map(|w| (w, None)),
        Some((w, h)) => number(w).zip(number(h)).map(|(w, h)| (w, Some(h))),
    };
    size.ok_or_else(|| Failure::usage(format!("--image-size: `{text}` is neither W nor WxH in whole pixels")))
}

fn frame(text: Option<&String>) -> Result<FrameChoice, Failure> {
    let Some(text) = text else { return Ok(FrameChoice::Default) };
    Ok(match text.as_str() {
        "artwork" => FrameChoice::Artwork,
        "viewbox" => FrameChoice::ViewBox,
        "ink" => FrameChoice::Lettering(LetteringFrame::Ink),
        "baseline-ascent" => FrameChoice::Lettering(LetteringFrame::BaselineAscent),
        "baseline-capheight" => FrameChoice::Lettering(LetteringFrame::BaselineCapHeight),
        "baseline-xheight" => FrameChoice::Lettering(LetteringFrame::BaselineXHeight),
        "ascent-descent" => FrameChoice::Lettering(LetteringFrame::AscentDescent),
        t => FrameChoice::Rect(rect(t)?),
    })
}

/// A box typed as X,Y,W,H.
pub(crate) fn rect(t: &str) -> Result<Rect, Failure> {
    let numbers: Result<Vec<f64>, _> = t.split(',').map(|w| w.trim().parse::<f64>()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, w, h]) if w > 0.0 && h > 0.0 && (x + y + w + h).is_finite() => Ok(Rect::new(x, y, x + w, y + h)),
        _ => Err(Failure::usage(format!(
            "--frame: `{t}` is none of artwork, viewbox, X,Y,W,H (W and H positive); of lettering baseline-ascent, \
baseline-capheight, baseline-xheight, ascent-descent, ink"
        ))),
    }
}
