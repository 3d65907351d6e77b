//! The registry's entry: reads a [`Warp`] from text.

use super::{Style, Warp};
use crate::deform::built::Built;
use crate::deform::entry::{ByHand, Case, Deformation, Example, Gallery, Info, Law};
use crate::deform::envelope::Keep;
use crate::error::Error;
use crate::param::{Kind, Param, Settings};

pub(in crate::deform) struct Entry;

/// The built-in styles, in the order of drawing programs' menus.
pub(super) const NAMES: &[&str] = &[
    "arc",
    "arc-lower",
    "arc-upper",
    "arch",
    "bulge",
    "shell-lower",
    "shell-upper",
    "flag",
    "wave",
    "fish",
    "rise",
    "fisheye",
    "inflate",
    "squeeze",
    "twist",
];

pub(super) static INFO: Info = Info::new("warp", "bend artwork in one of fifteen styles: arc, flag, fisheye, …")
    .gallery(Gallery { set: "styles", title: "styles", presets: "style", bend: Some("bend"), axis: Some("axis") })
    .group("Envelopes")
    .by_hand(ByHand {
        label: Some("Style"),
        labels: &[("horizontal", "Distort horizontally"), ("vertical", "Distort vertically")],
        ..ByHand::NONE
    })
    .about("The warp styles that drawing programs share, by the nets measured on the best known of them: arc, arc-lower, arc-upper, arch, bulge, \
shell-lower, shell-upper, flag, wave, fish, rise, fisheye, inflate, squeeze, twist. --bend sets the amount and the direction; \
`pathwarp gallery` draws them all. Photoshop's names (warpArc) work too.\n\nBends beyond 100% continue by the same \
formula; those made of circular arcs end at 190%. --horizontal and --vertical distort the result in addition, as if it leaned away \
to a side.\n\nA style of your own is a TOML or JSON file: rules that move the sixteen points of a net (row,column; 0,0 is the top left \
one), with formulas of w and h (the box), b (the bend), u and v (the point's position), and k, S, C for circular arcs:\n\n  \
name = \"roof\"\n  family = \"boundary\"   # or \"points\", \"frame\": the part that distortions act on\n  \
moves = [{ at = \"0,1\", y = \"-b*h/2\" }, { at = \"0,2\", y = \"-b*h/2\" }]")
    .source("Nets measured on Adobe Illustrator 2026, published with the OPuller editor, 2026; completion: K. Koppinen, A plane \
transformation from 16 control points, equation (7)")
    .params(&[
        Param::new("style", Kind::NameOrFile(NAMES), "The style: a name, or a file of your own.").default("arc"),
        Param::number("bend", "Amount and direction of the bend.").default("50%").within(-10.0, 10.0).slider(-1.0, 1.0),
        Param::new(
            "axis",
            Kind::Choice(&["horizontal", "vertical"]),
            "The direction of the style.",
        )
        .default("horizontal"),
        Param::number("horizontal", "Distortion: the right side grows by this, the left one shrinks.")
            .default("0%")
            .within(-1.0, 1.0),
        Param::number("vertical", "Distortion: the lower side grows by this, the upper one shrinks.")
            .default("0%")
            .within(-1.0, 1.0),
        Param::new(
            "keep",
            Kind::Choice(&["nothing", "verticals", "horizontals", "lines"]),
            "Lines that stay straight: the artwork is put between the style's sides by a map that keeps them, as `envelope --keep` does.",
        )
        .default("nothing"),
    ])
    .demo(&[("style", "arc"), ("bend", "40%"), ("horizontal", "15%"), ("vertical", "-20%")])
    .examples(&[
        Example { what: "A word on an arc", command: "warp samples/lettering.svg --style arc --bend 50% -o out.svg" },
        Example { what: "A logo on a flag", command: "warp samples/logo.svg --style flag --bend -30% -o out.svg" },
        Example {
            what: "A badge seen through a fisheye, leaning away to the right",
            command: "warp samples/badge.svg --style fisheye --bend 60% --horizontal -25% -o out.svg",
        },
        Example {
            what: "Lettering in a bulge whose verticals stay vertical",
            command: "warp samples/lettering.svg --style bulge --bend 40% --keep verticals -o out.svg",
        },
        Example {
            what: "A style from a file",
            command: "warp samples/lettering.svg --style samples/roof.toml --bend 80% -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("style", "arc"), ("bend", "0")]),
        Law::Identity(&[("style", "shell-upper"), ("bend", "0"), ("axis", "vertical")]),
        Law::Identity(&[("style", "twist"), ("bend", "0%")]),
        Law::Same(&[("style", "warpArcUpper")], &[("style", "arc-upper"), ("bend", "0.5")]),
        // Arch and flag move verticals up and down.
        Law::KeepsLinesAlong(&[("style", "arch"), ("bend", "-70%")], (0.0, 1.0)),
        Law::KeepsLinesAlong(&[("style", "flag"), ("bend", "150%")], (0.0, 1.0)),
        Law::Area(&[("style", "flag"), ("bend", "30%")], 1.0),
        // On a square the box itself is its transpose.
        Law::KeepsLinesAlong(&[("style", "arch"), ("axis", "vertical")], (1.0, 0.0)),
    ])
    .cases(&[
        // A half circle: its middle lies the cubic's 3/4·(2/3·diameter) above the ends.
        Case { args: &[("style", "arch"), ("bend", "100%")], at: (50.0, 0.0), to: (50.0, -50.0), tolerance: 1e-12 },
        // The wings of a full fan are level.
        Case { args: &[("style", "arc"), ("bend", "100%")], at: (0.0, 0.0), to: (-100.0, 100.0), tolerance: 1e-12 },
        Case { args: &[("style", "arc"), ("bend", "100%")], at: (50.0, 100.0), to: (50.0, 50.0), tolerance: 1e-12 },
        // 3·(1/3)(2/3)²·100 up and down again.
        Case {
            args: &[("style", "flag"), ("bend", "50%")],
            at: (100.0 / 3.0, 50.0),
            to: (100.0 / 3.0, 50.0 + 200.0 / 9.0),
            tolerance: 1e-12,
        },
        Case {
            args: &[("style", "rise"), ("bend", "50%"), ("axis", "vertical")],
            at: (50.0, 0.0),
            to: (50.0, 0.0),
            tolerance: 1e-12,
        },
    ]);

impl Deformation for Entry {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let warp = Warp {
            frame: s.frame().rect,
            style: style(s)?,
            bend: s.number("bend")?,
            horizontal: s.number("horizontal")?,
            vertical: s.number("vertical")?,
            sideways: s.choice("axis")? == "vertical",
            keep: Keep::named(s.choice("keep")?),
        };
        warp.build()
    }
}

/// Reads the style, by name or from a file.
fn style(s: &Settings<'_>) -> Result<Style, Error> {
    if let Some(file) = s.file_if("style")? {
        return Style::from_file(&file.name, &file.text);
    }
    let name = s.texts("style").last().copied().unwrap_or_default();
    Style::named(name).ok_or_else(|| {
        Error::advised(
            "style",
            name,
            "is not a style",
            format!("; there are {}, and files (TOML or JSON)", NAMES.join(", ")),
        )
    })
}
