//! `docs/lettering-on-paths.md`: what becomes of lettering on curves and in envelopes.

use crate::cookbook::{Job, Page};

pub(crate) const PAGE: Page = Page {
    file: "docs/lettering-on-paths.md",
    pictures: "images/lettering-on-paths",
    intro: "# Lettering on paths

Text in a drawing, and outlines made by `pathwarp text`, tell where their baselines are and where each letter begins and ends. Other
outlines do not: for those `--frame X,Y,W,H` names the box, and `bend --baseline` the height.

## Frames

The frame is the box that a deformation lays onto its shape. With `--frame` it follows the lettering instead of the artwork's box:

| `--frame` | bottom | top | left and right |
|---|---|---|---|
| `baseline-ascent` | the baseline | the font's ascent, with room for accents | the ends of the line's advances |
| `baseline-capheight` | the baseline | the height of capitals | the same |
| `baseline-xheight` | the baseline | the height of small letters | the same |
| `ascent-descent` | the font's descent | the font's ascent | the same |
| `ink` | the letters' own box | | |
| `artwork` | the box of everything | | |

Of several lines, the lowest line's baseline and the highest line's height count. What hangs below the baseline stays below the curve.
Baselines have to be level; a turned text is refused with a message. After another step (`+`) the letters are outlines like any
others: frames and letter-wise setting belong to the first step.

The default is `artwork`: in an envelope, a word with descenders should fill the shape, not hang out of it. But `bend` puts the
baseline of lettering on its curve (`baseline-ascent`), as everything that sets type on a path does, as long as the artwork is nothing but
lettering and neither `--frame` nor `--baseline` says otherwise. `--explain` tells.

## Letters

`bend --glyphs` says how letters stand on the curve. All but `bend` are affine for each letter, so that nodes stay as they
are. The names in other programs' menus: `rotate` is Rainbow, `--skew` Skew, `--ribbon` 3D Ribbon, `stair` Stair Step.

| `--glyphs` | what holds | where it fails |
|---|---|---|
| `bend` | what is level follows the curve, uprights stand on it | letters fan out; a tight bend folds them, with a warning that names the letter |
| `rotate` | letters keep their shape | neighbours run into each other inside a tight bend, with a warning |
| `skew` | uprights stay upright | where the curve is steep letters get thin, where it runs back they are mirrored, with a warning |
| `ribbon` | levels stay level | the same |
| `stair` | letters only move | steep curves tear words apart |
",
    jobs: &[
        Job {
            name: "bend",
            title: "Letters that bend",
            text: "The baseline is on the curve without further words. Letters widen above a hill and narrow in a valley.",
            command: "bend samples/lettering-text.svg --select '#headline' --along 'M20,120 C160,0 320,220 460,100' -o out.svg",
        },
        Job {
            name: "rotate",
            title: "Letters that turn",
            text: "Every letter stands on the curve at the middle of its advance, and keeps its shape.",
            command: "bend samples/lettering-text.svg --select '#headline' --along 'M20,120 C160,0 320,220 460,100' --glyphs rotate -o out.svg",
        },
        Job {
            name: "skew",
            title: "Uprights stay upright",
            text: "Each letter is sheared along the curve: good for slopes and waves.",
            command: "bend samples/lettering-text.svg --select '#headline' --along 'M20,120 C160,0 320,220 460,100' --skew -o out.svg",
        },
        Job {
            name: "ribbon",
            title: "Levels stay level",
            text: "Stems stand on the curve, bars stay level, as on a ribbon that turns in space.",
            command: "bend samples/lettering-text.svg --select '#headline' --along 'M20,120 C160,0 320,220 460,100' --ribbon -o out.svg",
        },
        Job {
            name: "even",
            title: "Even letters in a tight arch",
            text: "Outside an arch letters drift apart, inside they crowd. `--spacing even` counts distances at half the letters' height, where \
the eye does; `--stretch fit` spreads the letters from end to end.",
            command: "bend samples/lettering-text.svg --select '#headline' --along 'M130,150 A110,110 0 0 1 350,150' --glyphs rotate --spacing even --stretch fit -o out.svg",
        },
        Job {
            name: "repeat",
            title: "A word all round",
            text: "As many as there is room for, with at least `--gap` between them, spread evenly. Repeated words stand as far apart as \
their advances, not their ink.",
            command: "bend samples/lettering-text.svg --select '#headline' --along 'M40,330 A200,200 0 1 1 440,330 A200,200 0 1 1 40,330 Z' --stretch repeat --gap 12% --glyphs rotate -o out.svg",
        },
        Job {
            name: "arch",
            title: "Arched, with upright stems",
            text: "In an envelope, the frame from the baseline to the capitals puts their feet on the lower curve and their heads on the upper \
one; `--keep verticals` keeps stems upright.",
            command: "envelope samples/lettering-text.svg --select '#headline' --frame baseline-capheight --bottom 'M50,170 Q240,90 430,170' --top 'M50,110 Q240,-30 430,110' --keep verticals -o out.svg",
        },
    ],
};
