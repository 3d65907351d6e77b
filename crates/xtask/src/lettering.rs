//! `docs/lettering-on-paths.md`: what becomes of lettering on curves and in envelopes.

use crate::cookbook::{Job, Page};

pub(crate) const PAGE: Page = Page {
    file: "docs/lettering-on-paths.md",
    pictures: "images/lettering-on-paths",
    intro: "# Lettering on paths

Text in a drawing, and outlines made by [`pathwarp text`](lettering.md), tell where their baselines are and where each letter begins and
ends. Other outlines do not: for those `--frame X,Y,W,H` names the box, and `bend --baseline` the height.

```sh
pathwarp text 'Summit Camp' | pathwarp bend - --along 'M0,120 Q250,0 500,120' --glyphs rotate --fit page -o out.svg
```

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

Letters set one by one keep their size, times `--width`, and their distances. `--stretch fit` spreads them over the curve, `scale` sizes
them to it, `repeat` sets the line again as often as there is room. Warnings are of ink: letters that only come near each other
are not told of. The letters of joined scripts, such as Arabic, part where they are set one by one: bend them.
",
    jobs: &[
        Job {
            name: "bend",
            title: "Letters that bend",
            text: "The baseline is on the curve without further words. Letters widen above a hill and narrow in a valley.",
            command: "bend samples/headline.svg --along 'M10,150 C160,40 320,250 470,130' -o out.svg",
        },
        Job {
            name: "rotate",
            title: "Letters that turn",
            text: "Every letter stands on the curve at the middle of its advance, and keeps its shape.",
            command: "bend samples/headline.svg --along 'M10,150 C160,40 320,250 470,130' --glyphs rotate -o out.svg",
        },
        Job {
            name: "skew",
            title: "Uprights stay upright",
            text: "Each letter is sheared along the curve: good for slopes and waves.",
            command: "bend samples/headline.svg --along 'M10,150 C160,40 320,250 470,130' --skew -o out.svg",
        },
        Job {
            name: "ribbon",
            title: "Levels stay level",
            text: "Stems stand on the curve, bars stay level, as on a ribbon that turns in space.",
            command: "bend samples/headline.svg --along 'M10,150 C160,40 320,250 470,130' --ribbon -o out.svg",
        },
        Job {
            name: "even",
            title: "Even letters in a tight arch",
            text: "Outside an arch letters drift apart, inside they crowd. `--spacing even` counts distances at half the letters' height, where \
the eye does; `--stretch fit` spreads the letters from end to end: all gaps grow alike, those between words twice.",
            command: "bend samples/headline.svg --along 'M120,220 A120,120 0 0 1 360,220' --glyphs rotate --spacing even --stretch fit -o out.svg",
        },
        Job {
            name: "repeat",
            title: "A line all round",
            text: "As many as there is room for, with at least `--gap` between them, spread evenly. Lines that are repeated stand as far apart as \
their advances, not their ink. Raised letters keep their height above the line.",
            command: "bend samples/lettering-text.svg --select '#subline' --along 'M-10,80 A250,150 0 1 1 490,80 A250,150 0 1 1 -10,80 Z' --stretch repeat --gap 14 --glyphs rotate -o out.svg",
        },
        Job {
            name: "arch",
            title: "Arched, with upright stems",
            text: "In an envelope, the frame from the baseline to the capitals puts their feet on the lower curve and their heads on the upper \
one; `--keep verticals` keeps stems upright.",
            command: "envelope samples/headline.svg --frame baseline-capheight --bottom 'M30,210 Q240,130 450,210' --top 'M30,130 Q240,-50 450,130' --keep verticals -o out.svg",
        },
    ],
};
