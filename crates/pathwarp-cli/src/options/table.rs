//! The table of common options: each is declared here, and nowhere else.

use super::common::GradientChoice;
use super::definition::{CommonOption, LeadingMinus, OptionValue};
use super::parse;
use pathwarp_svg::{OnError, PageFit, Patterns, Strokes, Structure, TextMode};

/// An option without short name, default and conflicts, stored in recipes.
const fn stored(name: &'static str, value: OptionValue, help: &'static str) -> CommonOption {
    CommonOption { name, short: None, value, default: None, stored: true, conflicts: &[], help }
}

/// An option that names files or changes what is printed; recipes do not store it.
const fn of_the_run(name: &'static str, value: OptionValue, help: &'static str) -> CommonOption {
    CommonOption { stored: false, ..stored(name, value, help) }
}

/// All common options, in the order of help.
pub(crate) static OPTIONS: &[CommonOption] = &[
    CommonOption {
        short: Some('o'),
        ..of_the_run(
            "out",
            OptionValue::File { name: "OUT", set: |o, file| o.out = Some(file).filter(|f| f.as_os_str() != "-") },
            "Where to write the result; - or none writes to standard output",
        )
    },
    CommonOption {
        conflicts: &["out"],
        ..of_the_run(
            "out-dir",
            OptionValue::File { name: "DIR", set: |o, dir| o.out_dir = Some(dir) },
            "Where to write the results of several inputs, under their own names",
        )
    },
    CommonOption {
        conflicts: &["out", "out-dir"],
        ..of_the_run(
            "into",
            OptionValue::File { name: "COPY.xcf", set: |o, copy| o.into = Some(copy) },
            "For an XCF: write it to COPY with its paths warped and every other byte kept",
        )
    },
    stored(
        "salvage",
        OptionValue::Switch(|o| o.salvage = true),
        "Of a damaged file of GIMP's, take the paths before the damage",
    ),
    stored(
        "tolerance",
        OptionValue::Text {
            name: "D",
            minus: LeadingMinus::Number,
            set: |o, text| parse::positive(text).map(|d| o.tolerance = Some(d)),
        },
        "Largest distance between the true curve and the output, in user units; default 1e-4 of the artwork's diagonal",
    ),
    stored(
        "certify",
        OptionValue::Switch(|o| o.certify = true),
        "Prove the distance where the deformation allows it, rather than measure it",
    ),
    CommonOption {
        default: Some("on"),
        ..stored(
            "merge",
            OptionValue::Choice(&[("on", |o| o.merge = true), ("off", |o| o.merge = false)]),
            "Join pieces across smooth joints where that saves nodes; off keeps every node of the source",
        )
    },
    CommonOption {
        default: Some("artwork; baseline-ascent where a deformation with a --baseline gets lettering and nothing else"),
        ..stored(
            "frame",
            OptionValue::Text {
                name: "artwork|viewbox|baseline-ascent|baseline-capheight|…|X,Y,W,H",
                minus: LeadingMinus::Any,
                set: |o, text| parse::frame(text).map(|f| o.frame = f),
            },
            "The box that percentages and defaults refer to. Of lettering (text, or made by `pathwarp text`) also \
             baseline-ascent, baseline-capheight, baseline-xheight (from the baseline up, between the ends of the lines), \
             ascent-descent, or ink, the letters' own box",
        )
    },
    stored(
        "select",
        OptionValue::List { name: "SEL", push: |o, text| o.select.push(text.to_owned()) },
        "Warp only these: #id, .class, an element's tag, or a label; may be given several times",
    ),
    stored(
        "exclude",
        OptionValue::List { name: "SEL", push: |o, text| o.exclude.push(text.to_owned()) },
        "Leave these as they are",
    ),
    stored(
        "precision",
        OptionValue::Whole { name: "N", range: 0..=15, set: |o, n| o.precision = u8::try_from(n).ok() },
        "Decimals of coordinates; default: enough for a hundredth of the tolerance",
    ),
    CommonOption {
        default: Some("auto"),
        ..stored(
            "strokes",
            OptionValue::Choice(&[
                ("auto", |o| o.strokes = Strokes::Auto),
                ("keep", |o| o.strokes = Strokes::Keep),
                ("scale", |o| o.strokes = Strokes::Scale),
                ("outline", |o| o.strokes = Strokes::Outline),
            ]),
            "Strokes: keep their width, scale it by the local stretch, or turn them into outlines that are warped; auto scales \
             where that looks right and outlines elsewhere",
        )
    },
    CommonOption {
        default: Some("outline"),
        ..stored(
            "text",
            OptionValue::Choice(&[("outline", |o| o.text = TextMode::Outline), ("skip", |o| o.text = TextMode::Skip)]),
            "Text: warp its outlines, or leave it as it is",
        )
    },
    CommonOption {
        default: Some("fit"),
        ..stored(
            "gradients",
            OptionValue::Choice(&[
                ("fit", |o| o.gradients = GradientChoice::Fit),
                ("exact", |o| o.gradients = GradientChoice::Exact),
                ("keep", |o| o.gradients = GradientChoice::Keep),
            ]),
            "Gradients: follow the artwork as an affine map can, become a picture cut to the shape where that would be seen to \
             be wrong, or stay",
        )
    },
    CommonOption {
        default: Some("auto"),
        ..stored(
            "patterns",
            OptionValue::Choice(&[
                ("auto", |o| o.patterns = Patterns::Auto),
                ("instantiate", |o| o.patterns = Patterns::Instantiate),
                ("fit", |o| o.patterns = Patterns::Fit),
                ("keep", |o| o.patterns = Patterns::Keep),
            ]),
            "Patterns: warp their tiles one by one, follow the artwork as an affine map can, or stay; auto warps tiles where \
             the difference is seen and they are not too many",
        )
    },
    CommonOption {
        default: Some("none"),
        ..stored(
            "fit",
            OptionValue::Choice(&[
                ("none", |o| o.page = PageFit::None),
                ("grow", |o| o.page = PageFit::Grow),
                ("page", |o| o.page = PageFit::Page),
            ]),
            "The page: leave it, grow it to hold the warped artwork, or make it the artwork's box; a warning tells what leaves \
             it",
        )
    },
    CommonOption {
        default: Some("auto"),
        ..stored(
            "structure",
            OptionValue::Choice(&[
                ("auto", |o| o.structure = Structure::Auto),
                ("keep", |o| o.structure = Structure::Keep),
                ("flatten", |o| o.structure = Structure::Flatten),
            ]),
            "The document: keep its text and structure wherever possible, insist on it, or write a flat new one",
        )
    },
    CommonOption {
        default: Some("warp"),
        ..stored(
            "images",
            OptionValue::Choice(&[("warp", |o| o.warp_images = true), ("keep", |o| o.warp_images = false)]),
            "Bitmaps in a drawing: warp their pixels, or place them as an affine map can",
        )
    },
    stored(
        "image-dpi",
        OptionValue::Text {
            name: "N",
            minus: LeadingMinus::No,
            set: |o, text| parse::positive(text).map(|dpi| o.image_dpi = Some(dpi)),
        },
        "Resolution of the warped bitmaps in a drawing, in pixels per inch of it; default: as fine as keeps every detail",
    ),
    CommonOption {
        default: Some("as large as the warped picture is"),
        ..stored(
            "image-size",
            OptionValue::Text {
                name: "W[xH]",
                minus: LeadingMinus::No,
                set: |o, text| parse::image_size(text).map(|size| o.image_size = Some(size)),
            },
            "Pixels of the result when a PNG or JPEG is warped",
        )
    },
    CommonOption {
        default: Some("stop"),
        ..stored(
            "on-error",
            OptionValue::Choice(&[("stop", |o| o.on_error = OnError::Stop), ("skip", |o| o.on_error = OnError::Skip)]),
            "A shape that cannot be warped: stop, or leave it as it is",
        )
    },
    of_the_run(
        "report",
        OptionValue::File { name: "FILE", set: |o, file| o.report = Some(file) },
        "Write what was done, shape by shape, as JSON",
    ),
    of_the_run(
        "write-recipe",
        OptionValue::File { name: "FILE", set: |o, file| o.write_recipe = Some(file) },
        "Save this command line as a recipe for `pathwarp run`",
    ),
    of_the_run(
        "embed-recipe",
        OptionValue::Switch(|o| o.embed_recipe = true),
        "Keep the recipe and the source in the output's <metadata>; `pathwarp unwarp` gives them back",
    ),
    of_the_run(
        "preview",
        OptionValue::File { name: "FILE", set: |o, file| o.preview = Some(file) },
        "Draw the artwork, its guides and the result as a PNG",
    ),
    of_the_run(
        "explain",
        OptionValue::Switch(|o| o.explain = true),
        "Say what was decided on your behalf: corners, sides, directions",
    ),
    CommonOption {
        short: Some('j'),
        ..of_the_run(
            "jobs",
            OptionValue::Whole { name: "N", range: 1..=u16::MAX, set: |o, n| o.jobs = Some(n.into()) },
            "Threads to use; default: one per core. The output does not depend on it",
        )
    },
    CommonOption {
        short: Some('q'),
        ..of_the_run("quiet", OptionValue::Switch(|o| o.quiet = true), "No warnings, no progress")
    },
];
