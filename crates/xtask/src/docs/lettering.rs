//! `docs/lettering-on-paths.md`: lettering on curves and in envelopes.

use super::page::{CookbookEntry, CookbookPage};

pub(super) const PAGE: CookbookPage = CookbookPage {
    file: "docs/lettering-on-paths.md",
    pictures: "images/lettering-on-paths",
    intro: "# Lettering on paths

Text in a drawing, and outlines made by [`pathwarp text`](lettering.md), record their baselines and the extent of each letter. For
other outlines, give the box by `--frame X,Y,W,H` and the height by `bend --baseline`.

```sh
pathwarp text 'Summit Camp' | pathwarp bend - --along 'M0,120 Q250,0 500,120' --glyphs rotate --fit page -o out.svg
```

## Frames

The frame is the box that a deformation maps to its shape. `--frame` takes it from the lettering instead of the artwork's bounding box:

| `--frame` | bottom | top | left and right |
|---|---|---|---|
| `baseline-ascent` | the baseline | the font's ascent, with room for accents | the start and end of the line's advances |
| `baseline-capheight` | the baseline | the cap height | the same |
| `baseline-xheight` | the baseline | the x-height | the same |
| `ascent-descent` | the font's descent | the font's ascent | the same |
| `ink` | the bounding box of the letters | | |
| `artwork` | the bounding box of all artwork | | |

With several lines, the frame runs from the baseline of the lowest to the top of the highest. Descenders stay below the curve.
Baselines must be horizontal: pathwarp refuses rotated text with a message. After another step (`+`) the letters are ordinary
outlines, so these frames and setting letter by letter work in the first step only.

The default is `artwork`: in an envelope, a word with descenders should fill the shape, not hang out of it. `bend` instead puts the
baseline of lettering on its curve (`baseline-ascent`), as other programs do when they set type on a path, if the artwork is all
lettering and you give neither `--frame` nor `--baseline`. `--explain` says which applies.

## Letters

`bend --glyphs` says how letters sit on the curve. Every choice but `bend` moves each letter by an affine map, and so keeps its
nodes. Other programs call `rotate` Rainbow, `--skew` Skew, `--ribbon` 3D Ribbon and `stair` Stair Step.

| `--glyphs` | keeps | limits |
|---|---|---|
| `bend` | horizontals follow the curve, verticals are normal to it | letters fan out; a tight bend folds them, with a warning that names the letter |
| `rotate` | the shape of each letter | neighbours collide inside a tight bend, with a warning |
| `skew` | verticals | letters get thin where the curve is steep, and are mirrored where it runs backwards, with a warning |
| `ribbon` | horizontals | the same |
| `stair` | shape and orientation; letters only move | steep curves tear words apart |

Letters set one by one keep their size, times `--width`, and their spacing. `--stretch fit` spreads them over the curve, `scale` scales
them to fit it, and `repeat` repeats the line for as long as there is room. pathwarp warns about ink that overlaps, not about letters
that only come close. Letters of joined scripts, such as Arabic, come apart when set one by one: bend them instead.
",
    entries: &[
        CookbookEntry {
            name: "bend",
            title: "Letters that bend",
            text: "The baseline lies on the curve by default. Letters widen over a hill and narrow in a valley.",
            command: "bend samples/headline.svg --along 'M10,150 C160,40 320,250 470,130' -o out.svg",
        },
        CookbookEntry {
            name: "rotate",
            title: "Letters that turn",
            text: "Every letter sits on the curve at the middle of its advance and keeps its shape.",
            command: "bend samples/headline.svg --along 'M10,150 C160,40 320,250 470,130' --glyphs rotate -o out.svg",
        },
        CookbookEntry {
            name: "skew",
            title: "Vertical stems",
            text: "Shears each letter along the curve. Good for slopes and waves.",
            command: "bend samples/headline.svg --along 'M10,150 C160,40 320,250 470,130' --skew -o out.svg",
        },
        CookbookEntry {
            name: "ribbon",
            title: "Horizontal bars",
            text: "Stems are normal to the curve and bars stay horizontal, as on a ribbon that turns in space.",
            command: "bend samples/headline.svg --along 'M10,150 C160,40 320,250 470,130' --ribbon -o out.svg",
        },
        CookbookEntry {
            name: "even",
            title: "Even letters in a tight arch",
            text: "On the outside of an arch letters drift apart, on the inside they crowd. `--spacing even` measures distances at half the letter \
height, as the eye does. `--stretch fit` spreads the letters from end to end: all gaps grow equally, those between words twice as much.",
            command: "bend samples/headline.svg --along 'M120,220 A120,120 0 0 1 360,220' --glyphs rotate --spacing even --stretch fit -o out.svg",
        },
        CookbookEntry {
            name: "repeat",
            title: "A line all the way around",
            text: "As many copies of the line as fit, spread evenly with at least `--gap` between them. Gaps are measured between \
advances, not ink. Superscripts keep their height above the line.",
            command: "bend samples/lettering-text.svg --select '#subline' --along 'M-10,80 A250,150 0 1 1 490,80 A250,150 0 1 1 -10,80 Z' --stretch repeat --gap 14 --glyphs rotate -o out.svg",
        },
        CookbookEntry {
            name: "arch",
            title: "Arched, with upright stems",
            text: "In an envelope, a frame from baseline to cap height puts the feet of capitals on the lower curve and their tops on the upper \
one; `--keep verticals` keeps stems upright.",
            command: "envelope samples/headline.svg --frame baseline-capheight --bottom 'M30,210 Q240,130 450,210' --top 'M30,130 Q240,-50 450,130' --keep verticals -o out.svg",
        },
    ],
};
