//! Warp styles: ready-made bends of a box, each one bicubic net.
//!
//! The fifteen styles that drawing programs share, as data ([`style`], `styles.json`): the net of sixteen points that each makes
//! of the artwork's box. The numbers are those measured on the market leader's program and published with the OPuller editor
//! (AnatomikPerq, 2026); the arcs are the usual cubics of circles' arcs, and the inner points of the families with bent sides are
//! equation (7) of K. Koppinen, *A plane transformation from 16 control points*, which is the bilinear Coons patch.

mod style;

pub(super) use style::Bent;
pub use style::Style;

use super::built::{Built, Explanation, Overlay, Role};
use super::entry::{Case, Deformation, Example, Gallery, Info, Law};
use super::envelope::{self, corners::Ring};
use crate::error::Error;
use crate::map::{AffineMap, BicubicNet, Class, Map, Net};
use crate::outline::Seg;
use crate::param::{Kind, Param, Settings};
use kurbo::{Affine, CubicBez, Point, Rect};
use std::sync::Arc;
use style::StyleError;

pub(super) struct Warp;

/// The names, in the order of the menus where people know them from.
const NAMES: &[&str] = &[
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

static INFO: Info = Info::new("warp", "bend artwork in one of fifteen styles: arc, flag, fisheye, …")
    .gallery(Gallery { set: "styles", title: "styles", presets: "style", bend: Some("bend"), axis: Some("axis") })
    .group("Envelopes")
    .about("The warp styles that drawing programs share, by the nets measured on the best known of them: arc, arc-lower, arc-upper, arch, bulge, \
shell-lower, shell-upper, flag, wave, fish, rise, fisheye, inflate, squeeze, twist. --bend says how much and which way; \
`pathwarp gallery` draws them all. Names as Photoshop writes them (warpArc) are known too.\n\nBends beyond 100% go on by the same \
formula; those made of circles' arcs end at 190%. --horizontal and --vertical distort the result in addition, as if it leant away \
to a side.\n\nA style of your own is a TOML or JSON file: rules that move the sixteen points of a net (row,column; 0,0 is the top left \
one), formulas of w and h (the box), b (the bend), u and v (the point's place), and k, S, C for circles' arcs:\n\n  \
name = \"roof\"\n  family = \"boundary\"   # or \"points\", \"frame\": what distortions act on\n  \
moves = [{ at = \"0,1\", y = \"-b*h/2\" }, { at = \"0,2\", y = \"-b*h/2\" }]")
    .source("Nets measured on Adobe Illustrator 2026, published with the OPuller editor, 2026; completion: K. Koppinen, A plane \
transformation from 16 control points, equation (7)")
    .params(&[
        Param::new("style", Kind::NameOrFile(NAMES), "The style: a name, or a file of your own.").default("arc"),
        Param::number("bend", "How far it bends, and which way.").default("50%").slider(-1.0, 1.0),
        Param::new(
            "axis",
            Kind::Choice(&["horizontal", "vertical"]),
            "The direction in which artwork runs through the style.",
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
            "What is to stay straight: the artwork is put between the style's sides by a map that keeps it, as `envelope --keep` does.",
        )
        .default("nothing"),
    ])
    .demo(&[("style", "arc"), ("bend", "40%"), ("horizontal", "15%"), ("vertical", "-20%")])
    .examples(&[
        Example { what: "A word on an arc", command: "warp samples/lettering.svg --style arc --bend 50% --fit grow -o out.svg" },
        Example { what: "A logo on a flag", command: "warp samples/logo.svg --style flag --bend -30% -o out.svg" },
        Example {
            what: "A badge seen through a fisheye, leaning away to the right",
            command: "warp samples/badge.svg --style fisheye --bend 60% --horizontal -25% -o out.svg",
        },
        Example {
            what: "Lettering in a bulge whose uprights stay upright",
            command: "warp samples/lettering.svg --style bulge --bend 40% --keep verticals --fit grow -o out.svg",
        },
        Example {
            what: "A style from a file",
            command: "warp samples/lettering.svg --style samples/roof.toml --bend 80% --fit grow -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("style", "arc"), ("bend", "0")]),
        Law::Identity(&[("style", "shell-upper"), ("bend", "0"), ("axis", "vertical")]),
        Law::Identity(&[("style", "twist"), ("bend", "0%")]),
        Law::Same(&[("style", "warpArcUpper")], &[("style", "arc-upper"), ("bend", "0.5")]),
        // Arch and flag move uprights up and down.
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

impl Deformation for Warp {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let style = style(s)?;
        let bend = s.number("bend")?;
        if let Some(limit) = style.limit().filter(|l| bend.abs() > *l) {
            let most = limit * 100.0;
            let problem = format!("is out of range: {} bends from -{most}% to {most}%", style.name);
            return Err(Error::usage("bend", s.texts("bend").join(" "), problem));
        }
        let vertical = s.choice("axis")? == "vertical";
        let bent = Bent { bend, distortion: [s.number("horizontal")?, s.number("vertical")?], vertical };
        let rect = s.frame().rect;
        let wrong = |e: StyleError| Error::usage("style", s.texts("style").join(" "), e.to_string());
        let net = style.net(rect.width(), rect.height(), &bent).map_err(wrong)?;
        let keep = s.choice("keep")?;
        let mut built = if keep == "nothing" { over(rect, &net)? } else { kept(s, &style, keep, &net, &bent)? };
        built.note(format!(
            "style {}: bend {}%, {}{}",
            style.name,
            bend * 100.0,
            if vertical { "vertical" } else { "horizontal" },
            if style.title.is_empty() { String::new() } else { format!("; {}", style.title) }
        ));
        Ok(built)
    }
}

/// The sides of the style's net, and the map between them that keeps lines of one kind; where there is none, the styles that
/// have one are named.
fn kept(s: &Settings<'_>, style: &Style, keep: &str, net: &Net, bent: &Bent) -> Result<Built, Error> {
    let frame = s.frame().rect;
    let ring = |net: &Net| sides(&net.map(|row| row.map(|p| p + frame.origin().to_vec2())));
    let put = |style: &Style, net: &Net| -> Result<Built, Error> {
        // Sides that do not bend hold nothing of a style that moves the inside alone.
        let flat = style.net(frame.width(), frame.height(), &Bent { bend: 0.0, ..*bent });
        if bent.bend != 0.0 && flat.is_ok_and(|flat| same_sides(&flat, net)) {
            return Err(Error::usage("keep", keep, "its sides do not bend, only what is inside"));
        }
        envelope::over(&ring(net), s, keep, None)
    };
    put(style, net).map_err(|e| {
        let possible = |style: &Style| {
            let net = style.net(frame.width(), frame.height(), bent).ok();
            net.is_some_and(|n| put(style, &n).is_ok())
        };
        let names: Vec<String> = Style::builtin().into_iter().filter(possible).map(|style| style.name).collect();
        let others = if names.is_empty() {
            "no style can at this bend".into()
        } else {
            format!("it can with {}", names.join(", "))
        };
        let Error::Usage { problem, .. } = e else { return e };
        // What the envelope advises is for drawn curves.
        let what = problem.split(". No map").next().unwrap_or_default();
        Error::usage("keep", keep, format!("cannot be had with this style ({what}); {others}"))
    })
}

/// Whether two nets have the same outermost rows and columns.
fn same_sides(a: &Net, b: &Net) -> bool {
    let outer = |j: usize, c: usize| j == 0 || j == 3 || c == 0 || c == 3;
    (0..16).all(|k| !outer(k / 4, k % 4) || a[k / 4][k % 4] == b[k / 4][k % 4])
}

/// A net's four sides, as an envelope has them: bottom to the right, right side upwards, top to the left, left side downwards.
fn sides(net: &Net) -> Ring {
    let row = |r: usize| net[r];
    let column = |c: usize| [net[0][c], net[1][c], net[2][c], net[3][c]];
    let seg = |[a, b, c, d]: [Point; 4]| vec![Seg::Cubic(CubicBez::new(a, b, c, d))];
    let back = |[a, b, c, d]: [Point; 4]| [d, c, b, a];
    Ring { sides: [seg(row(3)), seg(back(column(3))), seg(back(row(0))), seg(column(0))], notes: Vec::new() }
}

/// The style asked for.
fn style(s: &Settings<'_>) -> Result<Style, Error> {
    if let Some(file) = s.file_if("style")? {
        return Style::from_file(&file.name, &file.text);
    }
    let name = s.texts("style").last().copied().unwrap_or_default();
    Style::builtin().into_iter().find(|style| style.is_called(name)).ok_or_else(|| {
        Error::usage("style", name, format!("is no style; there are {}, and files (TOML or JSON)", NAMES.join(", ")))
    })
}

/// The map of one net, given from the box's top left corner, over that box.
pub(super) fn over(rect: Rect, net: &Net) -> Result<Built, Error> {
    if !(rect.width() > 0.0 && rect.height() > 0.0) {
        return Err(crate::error::GeometryError::FlatFrame { width: rect.width(), height: rect.height() }.into());
    }
    let net: Net = net.map(|row| row.map(|p| p + rect.origin().to_vec2()));
    let pre = Affine::new([
        1.0 / rect.width(),
        0.0,
        0.0,
        1.0 / rect.height(),
        -rect.x0 / rect.width(),
        -rect.y0 / rect.height(),
    ]);
    let map = BicubicNet::new(&net, pre);
    let map: Arc<dyn Map> = match map.class() {
        Class::Affine(m) => Arc::new(AffineMap(crate::anchors::settled(m, &crate::param::Frame::new(rect)))),
        Class::Projective(_) | Class::Smooth => Arc::new(map),
    };
    let overlays = vec![
        Overlay { role: Role::Base, path: kurbo::Shape::to_path(&rect, 0.1) },
        Overlay { role: Role::Cage, path: super::shaper::rows_path(&net) },
    ];
    Ok(Built::new(map).explained(Explanation { overlays, ..Explanation::default() }))
}

#[cfg(test)]
mod tests;
