//! Text warps: the forty shapes into which office programs put words.
//!
//! A shape has one or several pairs of guide curves, between which the artwork is spanned (`map::tiled`), or single guides, on which it
//! stands. The curves and their adjust values are those of ECMA-376, Part 1, *presetTextWarpDefinitions* (the preset text warps of
//! DrawingML, `prstTxWarp`), rewritten as data in `presets.json`.

mod shape;
#[cfg(test)]
mod tests;

use super::bend::{Align, Bend, Stretch};
use super::entry::{Built, ByHand, Case, Entry, Example, Gallery, Info, Law, Role};
use crate::anchors;
use crate::error::{Error, with_area};
use crate::map::{AffineMap, Guide, GuidePace, TileRow, Tiled, tiled};
use crate::outline::{Outline, Seg, Subpath};
use crate::param::{Axis, Kind, Letter, Settings, parameters, word_space};
use kurbo::{Affine, BezPath, Point, Rect, Size};
use shape::{GuideError, Guides};
use std::sync::Arc;

pub use shape::{ShapeBox, TextShape};

parameters! {
    /// A text shape of office programs over the artwork's box: wave, chevron, arch, inflate, …
    ///
    /// The box is spanned between the shape's guides by ruled maps, or stands on them, in one band or several.
    ///
    /// ```
    /// use pathwarp::{deform::{TextShape, WordArt}, kurbo::{Point, Rect}, map::Map};
    ///
    /// let roof = WordArt::new(Rect::new(0.0, 0.0, 100.0, 100.0), TextShape::named("triangle").unwrap()).build()?;
    /// assert!(roof.map.point(Point::new(75.0, 50.0)).distance(Point::new(75.0, 62.5)) < 1e-12);
    /// # Ok::<(), pathwarp::Error>(())
    /// ```
    #[derive(Debug, Clone, PartialEq)]
    pub struct WordArt(s, shape: TextShape) {
        /// The shape: a name, or a file of your own.
        param = new("preset", Kind::NameOrFile(NAMES)).needed();
        /// An adjust value, such as adj1=15000: in 1/100000 of the box or %, angles in 1/60000 degree or with a unit. Without a name, in
        /// their order.
        param = new("adj", Kind::Text("[NAME=]VALUE")).repeated();
        /// Spacing along the guides: even by length, or by their parameters.
        by_parameter: bool = either("by", &["arclength", "parameter"]);
        /// The box that the shape is drawn in: fit (for round shapes, one that suits the artwork's proportion), artwork (its own), or
        /// X,Y,W,H (user units or %).
        param = new("box", Kind::Text("BOX")).default("fit");
        /// The heights at which artwork is divided between bands, user units or %.
        param = new("split", Kind::Text("Y[,Y…]"));
        /// Distance that the artwork keeps from the guides, along its verticals, and from their ends.
        padding: f64 = length("padding", Axis::Y).default("0").within(0.0, 1e9).slider(0.0, 50.0);
        let frame: Rect = s.frame().rect;
        // A value for each of the shape's adjust values.
        let adjusted: Vec<f64> = adjusted(s, &shape)?;
        let split: Option<Vec<f64>> = s.texts("split").last().map(|text| split(s, text)).transpose()?;
        let shape_box: ShapeBox = match s.texts("box").last() {
            Some(&"fit") => ShapeBox::Fit,
            _ => s.rect_if("box")?.map_or(ShapeBox::Artwork, ShapeBox::Given),
        };
        let letters: Arc<[Letter]> = Arc::clone(&s.frame().letters);
    }
}

/// Tolerance of drawn guides, as a fraction of the sum of the box's width and height.
const GUIDE_TOLERANCE: f64 = 1e-4;

impl WordArt {
    /// Creates the text shape with its default adjust values over the box `frame`.
    #[must_use]
    pub fn new(frame: Rect, shape: TextShape) -> Self {
        Self::defaults(frame, shape)
    }

    /// Sets the first adjust values, in the shape's order: lengths in 1/100000 of the box, angles in 1/60000 degree.
    #[must_use]
    pub fn adjust(mut self, values: &[f64]) -> Self {
        let missing = self.adjusted.get(values.len()..).unwrap_or_default();
        self.adjusted = values.iter().chain(missing).copied().collect();
        self
    }

    setters! {
        /// Sets the y of the lines between bands, rising, one less than there are bands. Default: even.
        split(heights: &[f64]) => split: Some(heights.to_vec());
        /// Sets the box that the shape is drawn in.
        shape_box(shape_box: ShapeBox);
        /// Sets the artwork's letters. By default the artwork is divided between their lines, and fewer lines than guides take the
        /// first guides only.
        letters(letters: Arc<[Letter]>);
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Geometry`] for a flat box; [`Error::Usage`] for adjust values out of range, a wrong split, a wrong formula, or
    /// a guide that has no length in this box, or a padding that leaves no room.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        let Self { frame: rect, shape, adjusted, .. } = self;
        with_area(*rect)?;
        if let Some(extra) = adjusted.get(shape.adj.len()) {
            return Err(no_adjust_value(shape, &extra.to_string()));
        }
        for (a, value) in shape.adj.iter().zip(adjusted) {
            a.check(*value, &shape.name)?;
        }
        let wrong = |problem: String| Error::usage("preset", shape.name.clone(), problem);
        let guides = |w, h| shape.guides(w, h, adjusted).map_err(|e: GuideError| wrong(e.to_string()));
        let lines = shape::lines(&self.letters, *rect);
        let bands = match guides(rect.width(), rect.height())? {
            Guides::Between(b) => b.len(),
            // Artwork without known lines counts as one, unless it is laid into a given box.
            Guides::Along(p) if self.split.is_none() && (self.shape_box == ShapeBox::Fit || !lines.is_empty()) => {
                p.len().min(lines.len().max(1))
            }
            Guides::Along(p) => p.len(),
        };
        let cuts = self.cuts(bands, &lines)?;
        let shape_box = self.placed_box(&cuts, &guides)?;
        let mut built = Built::new(Arc::new(AffineMap::IDENTITY));
        let values = shape.adj.iter().zip(adjusted).map(|(a, v)| format!("{} {v}", a.name)).collect::<Vec<_>>();
        built.note(format!("text shape {}: {}, {bands} band(s)", shape.name, values.join(", ")));
        if shape_box != *rect {
            let Rect { x0, y0, .. } = shape_box;
            built.note(format!("box of the shape: {x0:.6},{y0:.6},{:.6},{:.6}", shape_box.width(), shape_box.height()));
        }
        let placed_guides = || guides(shape_box.width(), shape_box.height());
        let padded = self.padded(placed_guides()?, &cuts, shape_box)?;
        let rows = padded.band_maps(placed_guides()?, &cuts, shape_box, &mut built)?;
        let map = rows.and_then(|rows| Tiled::over(padded.frame, cuts, rows));
        let map = map.ok_or_else(|| {
            wrong("has a guide that shrinks to a point in this box; choose an `adj` nearer to its default".into())
        })?;
        built.map = anchors::simplified(map, *rect);
        Ok(built)
    }

    /// Returns the box in which the shape is drawn, for artwork divided into bands at the heights `cuts`.
    fn placed_box(&self, cuts: &[f64], guides: &dyn Fn(f64, f64) -> Result<Guides, Error>) -> Result<Rect, Error> {
        let rect = self.frame;
        match self.shape_box {
            ShapeBox::Given(given) => return Ok(given.abs()),
            ShapeBox::Artwork => return Ok(rect),
            ShapeBox::Fit => {}
        }
        match guides(1.0, 1.0)? {
            Guides::Along(paths) => {
                // Round a closed path, a word space separates the end of the text from its start.
                let space = word_space(&self.letters).unwrap_or(0.0);
                let side = paths.iter().take(cuts.len() + 1).enumerate().map(|(k, path)| {
                    let space = if shape::is_closed(path) { space } else { 0.0 };
                    shape::side(path, rect.width() + space, self.band(cuts, k).height())
                });
                let side = side.fold(0.0, f64::max);
                Ok(Rect::from_center_size(rect.center(), Size::new(side, side)))
            }
            Guides::Between(_) if !self.shape.round => Ok(rect),
            Guides::Between(_) => {
                // The search runs near the origin, where rounding does not hide a flat minimum.
                let at_origin = Self { frame: rect - rect.origin().to_vec2(), ..self.clone() };
                let cuts: Vec<f64> = cuts.iter().map(|y| y - rect.y0).collect();
                let found = shape::least_distorting(at_origin.frame, |b| {
                    let mut built = Built::new(Arc::new(AffineMap::IDENTITY));
                    let rows = at_origin.band_maps(guides(b.width(), b.height())?, &cuts, b, &mut built)?;
                    Ok::<_, Error>(rows.and_then(|rows| Tiled::over(at_origin.frame, cuts.clone(), rows)))
                })?;
                Ok(found + rect.origin().to_vec2())
            }
        }
    }

    /// Returns the deformation with a larger frame, whose map into the shape leaves the padding between the artwork and the guides.
    fn padded(&self, guides: Guides, cuts: &[f64], shape_box: Rect) -> Result<Self, Error> {
        const SAMPLES: usize = 128;
        let (rect, last) = (self.frame, cuts.len());
        if self.padding == 0.0 || matches!(guides, Guides::Along(_)) {
            return Ok(self.clone());
        }
        let rows = self.band_maps(guides, cuts, shape_box, &mut Built::new(Arc::new(AffineMap::IDENTITY)))?;
        let Some(map) = rows.and_then(|rows| Tiled::over(rect, cuts.to_vec(), rows)) else { return Ok(self.clone()) };
        let image_of_row = |y: f64| -> Vec<Point> {
            let x = |i: usize| rect.x0 + rect.width() * i as f64 / SAMPLES as f64;
            (0..=SAMPLES).map(|i| map.point(Point::new(x(i), y))).collect()
        };
        let length = |ps: &[Point]| ps.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>();
        // The padding as shares of the guides' length, and of the height of the first and the last band. Inner bands get no padding.
        let (mut x_share, mut y_shares) = (0f64, [0.0; 2]);
        for (k, y_share) in [0, last].into_iter().zip(&mut y_shares) {
            let band = self.band(cuts, k);
            let [top, bottom] = [1e-12, 1.0 - 1e-12].map(|v| image_of_row(band.y0 + v * band.height()));
            let least = top.iter().zip(&bottom).map(|(p, q)| p.distance(*q)).fold(f64::INFINITY, f64::min);
            x_share = x_share.max(self.padding / length(&top).min(length(&bottom)));
            *y_share = self.padding / least;
        }
        // A single band is padded on both sides.
        let sides = if last == 0 { 2.0 } else { 1.0 };
        if !(x_share < 0.5 && y_shares.iter().all(|share| sides * share < 1.0)) {
            return Err(Error::usage("padding", self.padding.to_string(), "leaves nothing of the shape"));
        }
        let growth = |k: usize, share: f64| self.band(cuts, k).height() * share / (1.0 - sides * share);
        let wide = rect.inflate(rect.width() * x_share / (1.0 - 2.0 * x_share), 0.0);
        let frame = Rect { y0: rect.y0 - growth(0, y_shares[0]), y1: rect.y1 + growth(last, y_shares[1]), ..wide };
        Ok(Self { frame, ..self.clone() })
    }

    /// Returns band `k` of the artwork's box, between two cuts.
    fn band(&self, cuts: &[f64], k: usize) -> Rect {
        let rect = self.frame;
        let y0 = if k == 0 { rect.y0 } else { cuts[k - 1] };
        Rect { y0, y1: cuts.get(k).copied().unwrap_or(rect.y1), ..rect }
    }

    /// Returns the maps of the bands; `None` if a guide has no length.
    fn band_maps(
        &self,
        guides: Guides,
        cuts: &[f64],
        shape_box: Rect,
        built: &mut Built,
    ) -> Result<Option<Vec<TileRow>>, Error> {
        let shift = Affine::translate(shape_box.origin().to_vec2());
        let moved = |segs: &[Seg]| -> Vec<Seg> { segs.iter().map(|g| g.transformed(shift)).collect() };
        let tolerance = GUIDE_TOLERANCE * (shape_box.width() + shape_box.height());
        let drawn = |segs: &[Seg]| -> BezPath { outline(segs).to_bez_path(tolerance) };
        match guides {
            Guides::Between(pairs) => {
                let pace = if self.by_parameter { GuidePace::Parameter } else { GuidePace::ArcLength };
                let row = |(k, [top, bottom]): (usize, &[Vec<Seg>; 2])| {
                    let (top, bottom) = (moved(top), moved(bottom));
                    built.overlay(Role::Cage, drawn(&top));
                    built.overlay(Role::Cage, drawn(&bottom));
                    tiled::ruled_row(self.band(cuts, k), &Guide::new(&top, pace)?, &Guide::new(&bottom, pace)?)
                };
                Ok(pairs.iter().enumerate().map(row).collect())
            }
            Guides::Along(paths) => {
                let mut rows = Vec::with_capacity(cuts.len() + 1);
                for (k, path) in paths.iter().take(cuts.len() + 1).enumerate() {
                    let path = moved(path);
                    built.overlay(Role::Cage, drawn(&path));
                    let bent = self.standing(&path, self.band(cuts, k))?;
                    built.explanation.warnings.extend(bent.explanation.warnings);
                    rows.push(TileRow { cuts: Vec::new(), maps: vec![bent.map] });
                }
                Ok(Some(rows))
            }
        }
    }

    /// Stands a band of artwork on `path`: true to size if the box was fitted to the artwork, else scaled to the path's length.
    fn standing(&self, path: &[Seg], band: Rect) -> Result<Built, Error> {
        let scale = if self.shape_box == ShapeBox::Fit { 1.0 } else { shape::length(path) / band.width() };
        let bend = Bend::new(band, &outline(path)).baseline(band.y1 + self.padding / scale).as_drawn(true);
        let is_loose = || shape::is_loose(path, band.width(), band.height(), word_space(&self.letters).unwrap_or(0.0));
        match self.shape_box {
            // Text that leaves more of the path free is centred on its top; other text begins at the path's start.
            ShapeBox::Fit if shape::is_closed(path) && is_loose() => {
                bend.even(true).offset((shape::share_at_top(path) - 0.5) * shape::mid_length(path, band.height()))
            }
            ShapeBox::Fit if shape::is_closed(path) => bend.even(true).align(Align::Start),
            ShapeBox::Fit => bend.even(true),
            _ => bend.stretch(Stretch::Scale),
        }
        .build()
    }

    /// Returns the heights between bands.
    fn cuts(&self, bands: usize, lines: &[shape::TextLine]) -> Result<Vec<f64>, Error> {
        let rect = self.frame;
        let Some(split) = &self.split else {
            if let Some(cuts) = shape::gaps(lines, rect).filter(|_| lines.len() == bands) {
                return Ok(cuts);
            }
            return Ok((1..bands).map(|k| rect.y0 + rect.height() * (k as f64 / bands as f64)).collect());
        };
        let is_inside = split.iter().all(|y| *y > rect.y0 && *y < rect.y1);
        if split.len() + 1 == bands && is_inside && split.windows(2).all(|w| w[0] < w[1]) {
            return Ok(split.clone());
        }
        let count = bands - 1;
        let text = split.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        let problem =
            format!("is not a rising list of heights between {} and {}; this shape takes {count}", rect.y0, rect.y1);
        Err(Error::usage("split", text, problem))
    }
}

/// Returns the error for an adjust value that the shape does not have.
fn no_adjust_value(shape: &TextShape, text: &str) -> Error {
    let known: Vec<&str> = shape.adj.iter().map(|a| a.name.as_str()).collect();
    Error::usage(
        "adj",
        text,
        format!("sets no adjust value of {}; its adjust values are {}", shape.name, known.join(", ")),
    )
}

fn outline(segs: &[Seg]) -> Outline {
    let start = segs.first().map(Seg::start).unwrap_or_default();
    Outline { subpaths: vec![Subpath { start, segs: segs.to_vec(), closed: false }] }
}

/// The names of the shapes, in the order of the standard's families.
const NAMES: &[&str] = &[
    "plain",
    "stop",
    "triangle",
    "triangle-inverted",
    "chevron",
    "chevron-inverted",
    "ring-inside",
    "ring-outside",
    "arch-up",
    "arch-down",
    "circle",
    "button",
    "arch-up-pour",
    "arch-down-pour",
    "circle-pour",
    "button-pour",
    "curve-up",
    "curve-down",
    "can-up",
    "can-down",
    "wave1",
    "wave2",
    "double-wave1",
    "wave4",
    "inflate",
    "deflate",
    "inflate-bottom",
    "deflate-bottom",
    "inflate-top",
    "deflate-top",
    "deflate-inflate",
    "deflate-inflate-deflate",
    "fade-right",
    "fade-left",
    "fade-up",
    "fade-down",
    "slant-up",
    "slant-down",
    "cascade-up",
    "cascade-down",
];

static INFO: Info = Info::new("wordart", "put artwork into one of the forty text shapes of office programs")
    .gallery(Gallery { set: "wordart", title: "text shapes", presets: "preset", bend: None, axis: None })
    .group("Envelopes")
    .by_hand(ByHand {
        label: Some("Text shape"),
        ..ByHand::NONE
    })
    .with_letters()
    .about("The text effects that word processors and presentations offer under Transform, from their published formulas: \
plain, triangle, chevron, arch-up, ring-inside, wave1, inflate, slant-up, cascade-up and the others below; \
`pathwarp gallery --set wordart` draws them all. The names \
in menus (\"Chevron Up\") and files (textChevron) work too.\n\nThe artwork's box is spanned between the guides; in \
arch-up, arch-down, circle and button it stands on them instead. Shapes are drawn in the artwork's box, but round ones (these four, the pours \
and the rings) in one that suits its proportion: on a single guide, letters keep their size, measured at half their height, in a square that \
the text fills, and short words in one so large that no letter is twice as wide at one end as at the other; between two guides, the box that \
distorts least. Lettering of fewer lines than button has guides takes the first ones, and artwork that is not lettering the first, unless --split divides it. --box artwork draws these in the artwork's box too, and \
--box X,Y,W,H in any box; text on a single guide is then scaled to its length.\n\ndeflate-inflate has two bands, \
deflate-inflate-deflate, button and button-pour have three, for as many lines of text. --split sets the heights at which the artwork is \
divided; by default between as many lines, or evenly.\n\nA shape of your own is a TOML or JSON file of adjust values, formulas over w and h (the \
box) and guides written like path data (`round = true`: the box suits the artwork's proportion):\n\n  name = \"hill\"\n  adj = [{ name = \"adj\", default = 40000, least = 0, most = 80000 }]\n  \
let = [\"y = adj*h/100000\"]\n  bands = [[\"M 0,y Q w/2,-y w,y\", \"M 0,h L w,h\"]]")
    .source("ECMA-376, Office Open XML File Formats, Part 1, presetTextWarpDefinitions (DrawingML prstTxWarp, 20.1.9.19)")
    .params(WordArt::PARAMS)
    .demo(&[("preset", "wave1"), ("adj", "adj1=15000"), ("adj", "adj2=4000")])
    .examples(&[
        Example { what: "A word as a wave", command: "wordart samples/lettering.svg --preset wave1 -o out.svg" },
        Example {
            what: "A roof by its name in menus, steeper",
            command: "wordart samples/lettering.svg --preset 'Chevron Up' --adj 45% -o out.svg",
        },
        Example {
            what: "On an arch, from low on the left to low on the right",
            command: "wordart samples/logo.svg --preset arch-up --adj 150deg --fit page -o out.svg",
        },
        Example {
            what: "A chevron with room around the word",
            command: "wordart samples/lettering.svg --preset chevron --padding 12 -o out.svg",
        },
        Example {
            what: "Round a ring, by the curves' parameters",
            command: "wordart samples/lettering.svg --preset circle-pour --adj adj2=70% --by parameter -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("preset", "plain")]),
        Law::Identity(&[("preset", "wave2"), ("adj", "0")]),
        Law::Identity(&[("preset", "slant-up"), ("adj", "0")]),
        Law::Identity(&[("preset", "fade-up"), ("adj", "0%"), ("by", "parameter")]),
        Law::Same(&[("preset", "textChevron")], &[("preset", "Chevron: Up"), ("adj", "adj=25%")]),
        Law::Same(&[("preset", "deflate-inflate")], &[("preset", "deflate-inflate"), ("split", "50%")]),
        Law::KeepsLinesAlong(&[("preset", "slant-down")], (0.0, 1.0)),
        Law::KeepsLinesAlong(&[("preset", "slant-down")], (1.0, 0.0)),
        Law::Area(&[("preset", "slant-up"), ("adj", "40%")], 0.6),
    ])
    .cases(&[
        Case { args: &[("preset", "triangle")], at: (0.0, 0.0), to: (0.0, 50.0), tolerance: 1e-12 },
        Case { args: &[("preset", "triangle")], at: (50.0, 0.0), to: (50.0, 0.0), tolerance: 1e-12 },
        Case { args: &[("preset", "triangle")], at: (75.0, 50.0), to: (75.0, 62.5), tolerance: 1e-12 },
        Case {
            args: &[("preset", "can-up"), ("adj", "70000")],
            at: (50.0, 0.0),
            to: (50.0, 0.0),
            tolerance: 1e-9,
        },
        // Half a circle: a quarter of the way is 45 degrees.
        Case {
            args: &[("preset", "arch-up"), ("box", "artwork")],
            at: (25.0, 100.0),
            to: (50.0 - 50.0 * R2, 50.0 - 50.0 * R2),
            tolerance: 1e-9,
        },
    ]);

const R2: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| {
    let name = s.texts("preset").last().copied().unwrap_or_default();
    let shape = match s.file_if("preset")? {
        Some(file) => TextShape::from_file(&file.name, &file.text)?,
        None => TextShape::named(name).ok_or_else(|| {
            let known = format!("; there are {}, and files", NAMES.join(", "));
            Error::advised("preset", name, "is not a text shape", known)
        })?,
    };
    WordArt::read(s, shape)?.build()
});

/// Reads the adjust values, with defaults for those not given.
fn adjusted(s: &Settings<'_>, shape: &TextShape) -> Result<Vec<f64>, Error> {
    let mut values: Vec<f64> = shape.adj.iter().map(|a| a.default).collect();
    let texts = if s.given("adj") { s.texts("adj") } else { Vec::new() };
    for (n, text) in texts.into_iter().enumerate() {
        let (index, value) = match text.split_once('=') {
            None => (n, text),
            Some((name, value)) => {
                (shape.adj.iter().position(|a| a.name == name.trim()).unwrap_or(usize::MAX), value.trim())
            }
        };
        let a = shape.adj.get(index).ok_or_else(|| no_adjust_value(shape, text))?;
        let v = if value.ends_with('%') {
            s.number_in("adj", value)? * 1e5
        } else if value.ends_with(|c: char| c.is_alphabetic() || c == '°') {
            s.angle_in("adj", value)? * 6e4
        } else {
            s.number_in("adj", value)?
        };
        a.check(v, &shape.name)?;
        values[index] = v;
    }
    Ok(values)
}

/// Reads the heights between bands.
fn split(s: &Settings<'_>, text: &str) -> Result<Vec<f64>, Error> {
    let height = |t: &str| {
        let y = s.length_in("split", t, Axis::Y)?;
        Ok(if t.ends_with('%') { s.frame().rect.y0 + y } else { y })
    };
    text.split([',', ' ']).filter(|t| !t.is_empty()).map(height).collect()
}
