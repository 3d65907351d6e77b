//! The table that declares all common options.

use super::common::{
    CommonOptions, OnFailure, family_name, frame, image_size, limit, outset_step, positive, positive_length, ratio,
    side_of_page, simplify_step,
};
use crate::format::Format;
use pathwarp::refit::Nodes;
use pathwarp_svg::{Clones, Filters, Gradients, PageFit, Patterns, Strokes, Structure, TextMode};
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// An option that recipes store, without short name, default and conflicts.
const fn stored(name: &'static str, value: OptionValue, help: &'static str) -> CommonOption {
    CommonOption {
        name,
        short: None,
        alias: None,
        value,
        default: None,
        stored: true,
        reading: false,
        conflicts: &[],
        help,
    }
}

/// An option that names files or changes the printed output; recipes do not store it.
const fn of_the_run(name: &'static str, value: OptionValue, help: &'static str) -> CommonOption {
    CommonOption { stored: false, ..stored(name, value, help) }
}

/// Text that `set` parses; `name` stands for it in help.
const fn text(name: &'static str, minus: LeadingMinus, set: SetText) -> OptionValue {
    OptionValue::Text { name, minus, set }
}

/// An option that names the family for one of CSS's generic names.
const fn family(name: &'static str, set: SetText, help: &'static str) -> CommonOption {
    CommonOption { reading: true, ..stored(name, text("FAMILY", LeadingMinus::No, set), help) }
}

/// An option that names fonts besides the installed ones. `value` stands for its value in help.
const fn fonts(name: &'static str, value: &'static str, help: &'static str) -> CommonOption {
    let value = OptionValue::List {
        name: value,
        push: |o, path| {
            o.reading.fonts.paths.push(path.into());
            Ok(())
        },
    };
    CommonOption { reading: true, ..of_the_run(name, value, help) }
}

/// All common options, in the order of help.
pub static OPTIONS: &[CommonOption] = &[
    CommonOption {
        short: Some('o'),
        ..of_the_run(
            "out",
            OptionValue::File { name: "OUT", set: |o, file| o.out = Some(file).filter(|f| f.as_os_str() != "-") },
            "Write the result to this file, in the format of its extension (--format); - or none writes to standard \
             output. {stem} in the name stands for the input's name without extension",
        )
    },
    CommonOption {
        default: Some("auto"),
        conflicts: &["into"],
        ..of_the_run(
            "format",
            OptionValue::Choice(&[
                ("auto", |o| o.format = None),
                ("svg", |o| o.format = Some(Format::Svg)),
                ("svgz", |o| o.format = Some(Format::Svgz)),
                ("pdf", |o| o.format = Some(Format::Pdf)),
                ("dxf", |o| o.format = Some(Format::Dxf)),
                ("png", |o| o.format = Some(Format::Png)),
                ("jpg", |o| o.format = Some(Format::Jpeg)),
                ("webp", |o| o.format = Some(Format::WebP)),
                ("json", |o| o.format = Some(Format::PointList)),
            ]),
            "Format of the result: of a drawing svg, svgz, pdf or dxf (outlines in mm), of a picture png, jpg or webp \
             (without loss), of GIMP paths also json. auto goes by the extension; to standard output drawings are \
             written as svg, pictures as png. With --out-dir it names the files, too",
        )
    },
    CommonOption {
        conflicts: &["out"],
        ..of_the_run(
            "out-dir",
            OptionValue::File { name: "DIR", set: |o, dir| o.out_dir = Some(dir) },
            "Write the results of several inputs to this folder, under their own names, or under another, such as \
             DIR/{stem}-bent.svg; missing folders are created",
        )
    },
    CommonOption {
        conflicts: &["out-dir"],
        ..of_the_run(
            "in-place",
            OptionValue::Switch(|o| o.in_place = true),
            "Overwrite the inputs; without it, an output that is also an input is an error",
        )
    },
    CommonOption {
        short: Some('r'),
        ..of_the_run(
            "recursive",
            OptionValue::Switch(|o| o.recursive = true),
            "Warp the SVG files (.svg, .svgz) in folders and the folders below; --out-dir gets the same folders",
        )
    },
    of_the_run(
        "dry-run",
        OptionValue::Switch(|o| o.dry_run = true),
        "Print which file would be written for each input, and write none",
    ),
    CommonOption {
        conflicts: &["out", "out-dir"],
        ..of_the_run(
            "into",
            OptionValue::File { name: "COPY.xcf", set: |o, copy| o.into = Some(copy) },
            "For an XCF: write a copy of it with its paths warped and every other byte kept",
        )
    },
    stored(
        "salvage",
        OptionValue::Switch(|o| o.salvage = true),
        "Read the paths before the damage in a damaged GIMP file",
    ),
    stored(
        "simplify",
        text("D", LeadingMinus::Any, |o, text| simplify_step(text).map(|step| drop(o.edits.splice(0..0, step)))),
        "Before bending, give paths the fewest nodes within this distance, such as 0.2mm or 0.1% (of the artwork's diagonal), as \
         `pathwarp simplify` does",
    ),
    stored(
        "outset",
        text("D", LeadingMinus::Any, |o, text| outset_step(text).map(|step| o.edits.extend(step))),
        "Before bending, let areas grow by this distance, as `pathwarp offset` does; below zero, they shrink",
    ),
    CommonOption {
        default: Some("1e-4 of the artwork's diagonal, and for small contours 2e-3 of their own"),
        ..stored(
            "tolerance",
            text("D", LeadingMinus::Number, |o, text| positive_length(text).map(|d| o.tolerance = Some(d))),
            "Largest distance between the exact curve and the output: user units, or a length such as 0.05mm. If it is given, it holds for \
             all contours alike",
        )
    },
    stored(
        "certify",
        OptionValue::Switch(|o| o.certify = true),
        "Prove the distance where the deformation allows it, instead of measuring it",
    ),
    CommonOption {
        default: Some("auto"),
        alias: Some("merge"),
        ..stored(
            "nodes",
            OptionValue::Choice(&[
                ("auto", |o| o.nodes = Nodes::Auto),
                ("fewest", |o| o.nodes = Nodes::Fewest),
                ("extremes", |o| o.nodes = Nodes::Extremes),
                ("source", |o| o.nodes = Nodes::Source),
                ("on", |o| o.nodes = Nodes::Fewest),
                ("off", |o| o.nodes = Nodes::Source),
            ]),
            "Where curves have nodes: auto where the artwork has them at extremes and at ends of lines and arcs, fewest where that saves most, \
             extremes at all horizontal and vertical extremes of the result, source (as --merge off) where the artwork has them",
        )
    },
    CommonOption {
        default: Some("artwork; baseline-ascent if a deformation with a baseline gets only lettering"),
        ..stored(
            "frame",
            text("artwork|viewbox|baseline-ascent|baseline-capheight|…|X,Y,W,H", LeadingMinus::Any, |o, text| {
                frame(text).map(|f| o.frame = f)
            }),
            "Box that percentages and defaults refer to. For lettering (text, or output of `pathwarp text`) also \
             baseline-ascent, baseline-capheight, baseline-xheight (from the baseline up, between the ends of the \
             lines), ascent-descent, or ink (the bounding box of the letters). X, Y, W and H may have units, such as 20mm",
        )
    },
    stored(
        "select",
        OptionValue::List {
            name: "SEL",
            push: |o, text| {
                o.select.push(text.to_owned());
                Ok(())
            },
        },
        "Warp only these: #id, .class, an element's tag, a label, or a place as reports have it (path at 12:5); may be given several times. In several parts of a chain, each \
         holds for its own step",
    ),
    stored(
        "exclude",
        OptionValue::List {
            name: "SEL",
            push: |o, text| {
                o.exclude.push(text.to_owned());
                Ok(())
            },
        },
        "Leave these unchanged; takes the same values as --select",
    ),
    CommonOption {
        default: Some("enough for a hundredth of the tolerance; a tenth of that of small contours"),
        ..stored(
            "precision",
            OptionValue::Whole { name: "N", range: 0..=15, set: |o, n| o.precision = u8::try_from(n).ok() },
            "Decimals of coordinates",
        )
    },
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
            "Strokes: keep their width, scale it by the local stretch, or convert them to outlines that are \
             warped; auto keeps them in a DXF, where cutters follow their middle, and else scales if the edges are then within the tolerance, the width is right within 2 %, or the \
             stroke is a hairline (no wider than the tolerance or, on a page measured in mm, cm, in, pt or pc, than \
             0.1 mm), and outlines elsewhere",
        )
    },
    stored(
        "union",
        OptionValue::Switch(|o| o.union = true),
        "Make outlines of strokes simple, and in a DXF those of filled shapes, as cutters need them: no overlaps and no inner loops within a path. \
         `pathwarp unite` makes one shape of several",
    ),
    CommonOption {
        default: Some("outline"),
        ..stored(
            "text",
            OptionValue::Choice(&[("outline", |o| o.text = TextMode::Outline), ("skip", |o| o.text = TextMode::Skip)]),
            "Text: warp its outlines, or leave it unchanged",
        )
    },
    fonts("font-file", "FILE", "Use this font for text, too; may be given several times"),
    fonts("fonts-dir", "DIR", "Use the fonts in this folder and the folders below, too; may be given several times"),
    CommonOption {
        reading: true,
        ..stored(
            "no-system-fonts",
            OptionValue::Switch(|o| o.reading.fonts.no_system = true),
            "Use only the fonts that are given or embedded in the drawing, and the bundled Noto Sans",
        )
    },
    family(
        "serif-family",
        |o, name| family_name(name).map(|n| o.reading.fonts.generic.serif = Some(n)),
        "The family that serif stands for",
    ),
    family(
        "sans-serif-family",
        |o, name| family_name(name).map(|n| o.reading.fonts.generic.sans_serif = Some(n)),
        "The family that sans-serif stands for",
    ),
    family(
        "cursive-family",
        |o, name| family_name(name).map(|n| o.reading.fonts.generic.cursive = Some(n)),
        "The family that cursive stands for",
    ),
    family(
        "fantasy-family",
        |o, name| family_name(name).map(|n| o.reading.fonts.generic.fantasy = Some(n)),
        "The family that fantasy stands for",
    ),
    family(
        "monospace-family",
        |o, name| family_name(name).map(|n| o.reading.fonts.generic.monospace = Some(n)),
        "The family that monospace stands for",
    ),
    CommonOption {
        default: Some("auto"),
        ..stored(
            "gradients",
            OptionValue::Choice(&[
                ("auto", |o| o.gradients = Gradients::Auto),
                ("exact", |o| o.gradients = Gradients::Exact),
                ("fit", |o| o.gradients = Gradients::Fit),
                ("keep", |o| o.gradients = Gradients::Keep),
            ]),
            "Gradients follow the best affine fit. Where its colours would be off by more than 3 % (auto) or 0.6 % \
             (exact), the nearest gradient with more stops takes its place, or else a picture clipped to the shape; fit never \
             makes pictures, keep leaves them unchanged",
        )
    },
    CommonOption {
        default: Some("auto"),
        ..stored(
            "filters",
            OptionValue::Choice(&[
                ("auto", |o| o.filters = Filters::Auto),
                ("affine", |o| o.filters = Filters::Affine),
                ("picture", |o| o.filters = Filters::Picture),
            ]),
            "Filters follow the best affine fit (affine). Where that would look wrong (auto) or in any case (picture), a picture \
             shows what they draw; a shape with a shadow or glow stays a shape",
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
            "Patterns: warp every tile, follow the best affine fit, or stay unchanged; auto warps the tiles where the \
             difference is visible and they are not too many",
        )
    },
    CommonOption {
        default: Some("auto"),
        ..stored(
            "fit",
            OptionValue::Choice(&[
                ("auto", |o| o.page = PageFit::Auto),
                ("none", |o| o.page = PageFit::None),
                ("grow", |o| o.page = PageFit::Grow),
                ("page", |o| o.page = PageFit::PageWithMargin),
                ("shrink", |o| o.page = PageFit::Shrink),
                ("a3", |o| o.page = PageFit::Sheet([297.0, 420.0])),
                ("a4", |o| o.page = PageFit::Sheet([210.0, 297.0])),
                ("letter", |o| o.page = PageFit::Sheet([215.9, 279.4])),
                ("tabloid", |o| o.page = PageFit::Sheet([279.4, 431.8])),
            ]),
            "Page: leave it unchanged (none), grow it to hold the warped artwork, make it the bounding box of the artwork with the \
             margin of the original (page), scale the result back into it (shrink), or make it a sheet of paper \
             (a3, a4, letter, tabloid), upright or on its side, with the artwork in its true size in the middle. auto grows it, to whole units and with its margin, \
             where artwork leaves it, and says so; the pages of icons (square, up to 64 px), of paper sizes, of batches, and those that \
             steps refer to stay, with a warning if artwork extends past them",
        )
    },
    stored(
        "page-width",
        text("LENGTH", LeadingMinus::Any, |o, text| side_of_page(text).map(|l| o.page_width = Some(l))),
        "Width of the result's page, such as 80mm; its height is in proportion. A --tolerance and --kerf with units are lengths of the result \
         then, while lengths in parameters are those of the source",
    ),
    stored(
        "page-height",
        text("LENGTH", LeadingMinus::Any, |o, text| side_of_page(text).map(|l| o.page_height = Some(l))),
        "Height of the result's page; with --page-width, the page is as large as fits inside both",
    ),
    CommonOption {
        default: Some("copy"),
        ..stored(
            "clones",
            OptionValue::Choice(&[("copy", |o| o.clones = Clones::Copy), ("follow", |o| o.clones = Clones::Follow)]),
            "Clones (use) that are not warped themselves, of shapes that are: copy what they showed, so that they look as \
             before, or let them follow the warped shape",
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
            "Document: keep its text and structure where possible, fail if they cannot be kept, or write a new \
             flat document",
        )
    },
    CommonOption {
        default: Some("warp"),
        ..stored(
            "images",
            OptionValue::Choice(&[("warp", |o| o.warp_images = true), ("keep", |o| o.warp_images = false)]),
            "Bitmaps in a drawing: warp their pixels, or place them by the best affine fit",
        )
    },
    CommonOption {
        default: Some("high enough to keep every detail"),
        ..stored(
            "image-dpi",
            text("N", LeadingMinus::No, |o, text| positive(text).map(|dpi| o.image_dpi = Some(dpi))),
            "Resolution of the warped bitmaps in a drawing, in pixels per inch of the drawing; also of what filters draw in \
             a PDF (there 300 by default)",
        )
    },
    CommonOption {
        conflicts: &["fit"],
        ..stored(
            "crop",
            OptionValue::Switch(|o| o.crop = true),
            "Cut a warped PNG, JPEG or WebP to the image of the frame: of the corners given to a perspective, of what a cage around part of \
             a photograph holds (--inverse), or else of the whole picture. If that is upright, it gets the frame's true proportions, where \
             the photograph tells them, and as many pixels as its sides have there. Without it, --fit page (as auto) shows all of the warped picture, none keeps the photograph's edges",
        )
    },
    stored(
        "ratio",
        text("W:H", LeadingMinus::No, |o, text| ratio(text).map(|r| o.ratio = Some(r))),
        "Proportions of what --crop cuts out: 210:297, a4, letter or square; the longer side is the one that is longer in the photograph",
    ),
    CommonOption {
        alias: Some("size"),
        default: Some("the size of the warped picture"),
        ..stored(
            "image-size",
            text("W[xH]", LeadingMinus::No, |o, text| image_size(text).map(|size| o.image_size = Some(size))),
            "Size in pixels of a warped PNG, JPEG or WebP",
        )
    },
    stored(
        "keep-location",
        OptionValue::Switch(|o| o.keep_location = true),
        "Keep the place where a photograph was taken in its EXIF data; without it, they come along without the place and the thumbnail",
    ),
    CommonOption {
        default: Some("spline"),
        ..stored(
            "dxf-curves",
            OptionValue::Choice(&[("spline", |o| o.dxf_polylines = false), ("polyline", |o| o.dxf_polylines = true)]),
            "Curves in a DXF: splines, or for programs that know none, polylines within the tolerance; either way, \
             each contour is one entity. Lines, arcs and circles are exact in both",
        )
    },
    stored(
        "kerf",
        text("D", LeadingMinus::Any, |o, text| positive_length(text).map(|d| o.kerf = Some(d))),
        "Width of the cut, such as 0.2mm: the outer contours of a DXF grow by half of it and holes shrink, so that parts have \
         their size. Lines whose ends meet are one contour; other open lines stay",
    ),
    stored(
        "engrave",
        OptionValue::List {
            name: "SEL",
            push: |o, text| {
                o.engrave.push(text.to_owned());
                Ok(())
            },
        },
        "With --kerf, what is not cut, and stays: #id, .class, a layer, or a colour such as blue; may be given several times",
    ),
    CommonOption {
        default: Some("once"),
        ..stored(
            "duplicates",
            OptionValue::Choice(&[("once", |o| o.keep_duplicates = false), ("keep", |o| o.keep_duplicates = true)]),
            "Lines and contours that a DXF would hold twice in the same place, layer and colour, with --kerf of whatever layer and colour: \
             once, or as they are drawn",
        )
    },
    CommonOption {
        default: Some("92"),
        ..stored(
            "quality",
            OptionValue::Whole { name: "N", range: 1..=100, set: |o, n| o.quality = u8::try_from(n).ok() },
            "Quality of a JPEG, from 1 (small) to 100 (fine)",
        )
    },
    CommonOption {
        default: Some("continue"),
        ..stored(
            "on-error",
            OptionValue::Choice(&[
                ("continue", |o| o.on_failure = OnFailure::Continue),
                ("stop", |o| o.on_failure = OnFailure::Stop),
                ("skip", |o| o.on_failure = OnFailure::Skip),
            ]),
            "If an input cannot be read or one of its shapes cannot be warped: continue with the other inputs, stop \
             and write nothing, or skip only the shape and leave it unchanged",
        )
    },
    of_the_run(
        "report",
        OptionValue::File { name: "FILE", set: |o, file| o.report = Some(file) },
        "Write a report of every shape as JSON; - writes it to standard output",
    ),
    of_the_run(
        "write-recipe",
        OptionValue::File { name: "FILE", set: |o, file| o.write_recipe = Some(file) },
        "Save this command line as a recipe for `pathwarp run`; - writes it to standard output",
    ),
    of_the_run(
        "embed-recipe",
        OptionValue::Switch(|o| o.embed_recipe = true),
        "Store the recipe and the source in the output's <metadata>; `pathwarp unwarp` restores them",
    ),
    of_the_run(
        "preview",
        OptionValue::File { name: "FILE", set: |o, file| o.preview = Some(file) },
        "Draw the artwork, its guides and the result as a picture (.png, .jpg or .webp; - is a PNG on standard output)",
    ),
    of_the_run(
        "show-nodes",
        OptionValue::Switch(|o| o.show_nodes = true),
        "Draw nodes and handles over the curves of the picture",
    ),
    of_the_run(
        "show-polygons",
        OptionValue::List {
            name: "SEL",
            push: |o, text| {
                o.show_polygons.push(text.to_owned());
                Ok(())
            },
        },
        "Draw the control polygons of these paths' exact images in the picture of --preview; may be given several times",
    ),
    of_the_run(
        "explain",
        OptionValue::Switch(|o| o.explain = true),
        "Print the decisions made for you: corners, sides, directions",
    ),
    CommonOption {
        short: Some('j'),
        default: Some("one per core"),
        ..of_the_run(
            "jobs",
            OptionValue::Whole { name: "N", range: 1..=u16::MAX, set: |o, n| o.jobs = Some(n.into()) },
            "Number of threads; the output does not depend on it",
        )
    },
    CommonOption {
        reading: true,
        ..of_the_run(
            "limit",
            OptionValue::List { name: "NAME=N", push: |o, text| limit(text, &mut o.reading.limits) },
            "Raise or lower a limit on the work that an input may cause, such as work=1e9, or memory=none; may be given \
         several times. The limits are bytes, elements, pixels (of pictures), work, memory (in bytes) and, as the last resort, \
         seconds (of processor time, 130 at first, more than ten times what all of the work usually takes); without this option they grow with \
         the size of the input and its pictures",
        )
    },
    CommonOption {
        reading: true,
        ..of_the_run(
            "allow-external",
            OptionValue::Switch(|o| o.reading.external = true),
            "Read linked pictures and drawings from anywhere, not only beside the input or in folders below it, and let a \
         recipe name files by absolute paths",
        )
    },
    CommonOption {
        reading: true,
        ..of_the_run(
            "base-dir",
            OptionValue::File { name: "DIR", set: |o, folder| o.reading.base = Some(folder) },
            "The folder that links to pictures and drawings are relative to, instead of the input's",
        )
    },
    CommonOption {
        short: Some('q'),
        ..of_the_run("quiet", OptionValue::Switch(|o| o.quiet = true), "Print no warnings and no progress")
    },
];

/// One common option.
pub struct CommonOption {
    /// Long name, and the key in a recipe's `[options]`.
    pub name: &'static str,
    /// Its letter on a command line.
    pub short: Option<char>,
    /// Another long name, which recipes may have, too.
    pub alias: Option<&'static str>,
    /// The kind of its value, with the function that sets it.
    pub value: OptionValue,
    /// Default, in words for help. The default of a [`Choice`](OptionValue::Choice) is one of its words.
    pub default: Option<&'static str>,
    /// `true` if recipes store the option, because it shapes the result instead of naming files or changing the printed output.
    pub stored: bool,
    /// `true` if every command that reads drawings has the option.
    pub reading: bool,
    /// Options that cannot be given together with this one; one of the two lists the other.
    pub conflicts: &'static [&'static str],
    /// A sentence about its effect.
    pub help: &'static str,
}

/// Sets an option whose value needs no parsing.
pub(crate) type Set = fn(&mut CommonOptions);
/// Parses the value of an option and sets it.
pub(crate) type SetText = fn(&mut CommonOptions, &str) -> Result<(), String>;

/// The kind of value an option takes, the `name` that stands for the value in help, and the function that updates [`CommonOptions`].
#[expect(missing_docs, reason = "names, ranges and setters")]
pub enum OptionValue {
    /// Present or absent; takes no value.
    Switch(Set),
    /// One of these words.
    Choice(&'static [(&'static str, Set)]),
    /// A whole number in a range.
    Whole { name: &'static str, range: RangeInclusive<u16>, set: fn(&mut CommonOptions, u16) },
    /// Text with a syntax. The function's error describes the fault and does not name the option.
    Text { name: &'static str, minus: LeadingMinus, set: SetText },
    /// Text; may be given several times.
    List { name: &'static str, push: SetText },
    /// A file or folder.
    File { name: &'static str, set: fn(&mut CommonOptions, PathBuf) },
}

/// The values that may start with a minus on a command line instead of being taken for options, if only to be refused by `set`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "names, ranges and setters")]
pub enum LeadingMinus {
    No,
    /// Only if it is a number.
    Number,
    Any,
}

impl CommonOption {
    /// Finds an option by its long name or alias.
    pub(crate) fn named(name: &str) -> Option<&'static Self> {
        OPTIONS.iter().find(|o| o.name == name || o.alias == Some(name))
    }

    /// Returns the help text with the default.
    pub fn help(&self) -> String {
        match self.default {
            Some(d) => format!("{} [default: {d}]", self.help),
            None => self.help.to_owned(),
        }
    }

    /// Returns `true` if the option may be given several times.
    pub(crate) fn repeats(&self) -> bool {
        matches!(self.value, OptionValue::List { .. })
    }

    /// Returns the words of a choice, except `on` and `off`, which only belong to its [`alias`](Self::alias).
    pub fn words(&self) -> Vec<&'static str> {
        let OptionValue::Choice(words) = &self.value else { return Vec::new() };
        let is_old = |word: &str| self.alias.is_some() && ["on", "off"].contains(&word);
        words.iter().map(|(word, _)| *word).filter(|word| !is_old(word)).collect()
    }

    /// Checks a value against its kind: one of the words, a number in the range, or `true` for a switch (recipes drop `false` before).
    pub(crate) fn check(&self, value: &str) -> Result<(), String> {
        match &self.value {
            OptionValue::Switch(_) if value != "true" => Err(format!("`{value}` is neither true nor false")),
            OptionValue::Choice(words) if !words.iter().any(|(word, _)| *word == value) => {
                Err(format!("`{value}` is not one of {}", self.words().join(", ")))
            }
            OptionValue::Whole { range, .. } if !value.parse().is_ok_and(|n| range.contains(&n)) => {
                Err(format!("`{value}` is not a whole number from {} to {}", range.start(), range.end()))
            }
            _ => Ok(()),
        }
    }
}
