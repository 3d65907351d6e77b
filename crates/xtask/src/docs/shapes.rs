//! `docs/shapes.md`: words and a logo in every sample shape, with pictures and figures.

use crate::chore::{ChoreError, at};
use crate::shell::{pipe, render};
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use pathwarp::Outline;
use pathwarp::deform::Envelope;
use pathwarp::kurbo::{Point, Rect, Vec2};
use pathwarp::map::Jet;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

const PAGE: &str = "docs/shapes.md";
const PICTURES: &str = "docs/images/shapes";
/// The drawing of all shapes.
const SAMPLE: &str = "samples/shapes.svg";
/// The artwork put into the shapes: a name, and the command that writes it to standard output.
const ARTWORK: [(&str, &[&str]); 5] = [
    ("word", &["text", "OPEN", "-o", "-"]),
    ("two", &["text", "LOVE", "MUSIC", "--font", "display", "-o", "-"]),
    ("three", &["text", "LOVE", "MUSIC", "ALWAYS", "--font", "display", "-o", "-"]),
    ("four", &["text", "LOVE", "MUSIC", "ALWAYS", "FOREVER", "--font", "display", "-o", "-"]),
    ("logo", &["affine", "samples/logo.svg", "-o", "-"]),
];
/// Artwork and a shape that has no room for it.
const REFUSED: (&str, &str) = ("four", "crescent");
/// The box that the figures are computed for, of the size of a short word.
const FRAME: Rect = Rect::new(0.0, 0.0, 300.0, 100.0);
/// Samples along each axis of that box.
const SAMPLES: u32 = 41;

/// The id and path data of every shape.
fn shapes(root: &Path) -> Result<Vec<(String, String)>, ChoreError> {
    let file = root.join(SAMPLE);
    let text = fs::read_to_string(&file).map_err(at(&file))?;
    let attribute = |line: &str, name: &str| Some(line.split_once(name)?.1.split_once('"')?.0.to_owned());
    Ok(text.lines().filter_map(|l| Some((attribute(l, "<path id=\"")?, attribute(l, " d=\"")?))).collect())
}

/// Measures of the look of a word in a shape.
struct Figures {
    /// `true` if the shape is filled in columns.
    columns: bool,
    /// The fraction of samples where the map mirrors.
    folded: f64,
    /// The largest lean of a stem, in degrees.
    lean: f64,
    /// The 95th percentile of the ratio of the largest to the smallest stretch, relative to the mean stretches along both axes.
    uneven: f64,
}

impl Figures {
    fn measure(path: &str) -> Result<Self, ChoreError> {
        let outline = Outline::from_svg(path).map_err(|e| e.to_string())?;
        let built = Envelope::new(FRAME, &outline).lettering(true).build().map_err(|e| e.to_string())?;
        let sample = |k: u32| {
            let part = |i: u32| (f64::from(i) + 0.5) / f64::from(SAMPLES);
            Point::new(FRAME.x0 + part(k % SAMPLES) * FRAME.width(), FRAME.y0 + part(k / SAMPLES) * FRAME.height())
        };
        let jets: Vec<Jet> = (0..SAMPLES * SAMPLES).map(|k| built.map.jet(sample(k))).collect();
        let count = jets.len() as f64;
        let mean = |column: fn(&Jet) -> Vec2| jets.iter().map(|j| column(j).hypot()).sum::<f64>() / count;
        let (x, y) = (mean(|j| j.dx), mean(|j| j.dy));
        let mut ratios: Vec<f64> = jets
            .iter()
            .map(|j| {
                let (dx, dy) = (j.dx / x, j.dy / y);
                // σ₁² + σ₂² and σ₁·σ₂ of the Jacobian.
                let (sum, product) = (dx.hypot2() + dy.hypot2(), dx.cross(dy).abs());
                let root = (sum * sum - 4.0 * product * product).max(0.0).sqrt();
                ((sum + root) / (sum - root)).sqrt()
            })
            .collect();
        ratios.sort_by(f64::total_cmp);
        Ok(Self {
            columns: built.explanation.notes.iter().any(|n| n.contains("columns")),
            folded: jets.iter().filter(|j| j.dx.cross(j.dy) <= 0.0).count() as f64 / count,
            lean: jets.iter().map(|j| j.dy.x.abs().atan2(j.dy.y).to_degrees()).fold(0.0, f64::max),
            uneven: ratios[ratios.len() * 95 / 100],
        })
    }
}

/// The text of the page.
fn page_text(root: &Path) -> Result<String, ChoreError> {
    let mut out = String::from(
        "# A word in a shape\n\n<!-- Written by `cargo xtask docs`; edit crates/xtask/src/docs/shapes.rs. -->\n\n\
```sh\npathwarp text OPEN --in leaf -o leaf.svg\n```\n\n\
The 24 shapes below have names, which work wherever a path is named: `envelope logo.svg --envelope heart`. Such a shape has the middle of \
the artwork, and its width; `heart,ratio=1.2` sets width to height, `heart,width=80mm` the width. A file or a path of the drawing that has \
the name wins over it. `samples/shapes.svg` draws them all.\n\n\
Any other closed path is a shape, too: path data, or an object of a drawing, `FILE#NAME`. `text … --in SHAPE` sets words in it, with the \
options of `text`; `text … | pathwarp envelope - --envelope SHAPE` is the same with the options of `envelope`. A shape with four corners of its own, such as a flag or a banner, bends \
the word between its four sides. Every other shape is filled as letterers do it: in columns, so that stems stay upright, between the lower \
and the upper outline. The letters end where the shape is still a quarter of its greatest height (`--ends`), and `--padding 3` keeps them \
off the outline. `--explain` says what was chosen; `--keep verticals` or `--keep nothing` overrules it.\n\n\
Several lines, recognised by their baselines, are each set to the width of the shape at their height: `text LOVE MUSIC ALWAYS --in heart`. The \
gaps between them are even, stems stand, and letters are about equally high and wide. At a notch a line follows the outline, or is divided. Short words are not stretched without \
limit, but spaced. Where a shape has no room for a line, as the crescent has none for four, the program names it. `envelope --lines together` bends all lines as one block. \
Artwork without letters takes whatever distorts it \
less, and goes from end to end.\n",
    );
    let titles = ["One word", "Two lines", "Three lines", "Four lines", "A logo"];
    for ((name, _), title) in ARTWORK.iter().zip(titles) {
        let _ = write!(out, "\n![{title} in 24 shapes](images/shapes/{name}.png)\n");
    }
    out.push_str(
        "\n## Figures\n\nFor a word three times as wide as high: the share of it that is folded over, the largest lean of a stem, and the \
95th percentile of the ratio of the largest to the smallest stretch at a place, after the mean stretch along each axis is taken out.\n\n\
| shape | filled | folded | stems lean | stretch |\n|---|---|---|---|---|\n",
    );
    for (name, path) in shapes(root)? {
        let f = Figures::measure(&path)?;
        let how = if f.columns { "in columns" } else { "between four sides" };
        let _ = writeln!(out, "| {name} | {how} | {:.0} % | {:.0}° | {:.1} |", 100.0 * f.folded, f.lean, f.uneven);
    }
    Ok(out)
}

/// Writes the page and its pictures.
pub(super) fn write(root: &Path, program: &Path) -> Result<(), ChoreError> {
    let page = root.join(PAGE);
    fs::write(&page, page_text(root)?).map_err(at(&page))?;
    let folder = root.join(PICTURES);
    fs::create_dir_all(&folder).map_err(at(&folder))?;
    for (name, command) in ARTWORK {
        let command: Vec<String> = command.iter().map(|w| (*w).to_owned()).collect();
        let artwork = pipe(root, program, &command, &[])?;
        let file = root.join(SAMPLE);
        let mut sheet = fs::read_to_string(&file).map_err(at(&file))?.replace("</svg>", "");
        for (id, _) in shapes(root)?.into_iter().filter(|s| (name, s.0.as_str()) != REFUSED) {
            let path = format!("{SAMPLE}#{id}");
            let args = ["envelope", "-", "--envelope", &path, "--fit", "grow", "--quiet", "-o", "-"].map(str::to_owned);
            let bent = String::from_utf8_lossy(&pipe(root, program, &args, &artwork)?).into_owned();
            let _ = write!(sheet, "<image {WHOLE} href=\"data:image/svg+xml;base64,");
            sheet.push_str(&BASE64_STANDARD.encode(with_sheet_page(&bent)));
            sheet.push_str("\"/>");
        }
        sheet.push_str("</svg>");
        render(root, program, sheet.as_bytes(), "1440", &folder.join(format!("{name}.png")))?;
    }
    Ok(())
}

/// The page size of the drawing of all shapes.
const WHOLE: &str = "width=\"1440\" height=\"960\"";

/// Gives a drawing the page of the drawing of all shapes.
fn with_sheet_page(drawing: &str) -> String {
    let Some((before, rest)) = drawing.split_once("<svg ") else { return drawing.to_owned() };
    let (tag, content) = rest.split_once('>').unwrap_or((rest, ""));
    let kept = |part: &&str| !["width=", "height=", "viewBox="].iter().any(|name| part.starts_with(name));
    let tag: Vec<&str> = tag.split_inclusive("\" ").filter(kept).collect();
    format!("{before}<svg {WHOLE} viewBox=\"0 0 1440 960\" {}>{content}", tag.concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chore::workspace;

    /// Every shape is filled without folds; in columns, stems are upright.
    #[test]
    fn shapes_are_filled_well() {
        let all = shapes(&workspace()).unwrap();
        assert_eq!(all.len(), 24);
        for (name, path) in all {
            let f = Figures::measure(&path).unwrap();
            assert_eq!(f.folded, 0.0, "{name} folds");
            assert!(!f.columns || f.lean < 1e-6, "{name}: stems lean by {}°", f.lean);
        }
    }

    #[test]
    fn the_page_is_up_to_date() {
        let root = workspace();
        let stored = fs::read_to_string(root.join(PAGE)).unwrap_or_default();
        assert!(stored == page_text(&root).unwrap(), "{PAGE} is out of date: run `cargo xtask docs`");
    }
}
