//! The page of a drawing under `--fit`: pages that stay as they are, and the notes and warnings about the page.

use crate::options::{CommonOptions, FrameChoice};
use crate::readable::three_figures;
use crate::units::MM_PER_PX;
use pathwarp::engine::decimal::trimmed;
use pathwarp::kurbo::Rect;
use pathwarp::recipe::Recipe;
use pathwarp_svg::engine::Overhang;
use pathwarp_svg::{Document, PageFit, Warning};

/// Side in px of the largest square page that counts as an icon's.
const ICON: f64 = 64.0;
/// Largest relative difference of a page's sides from those of a square, or of a sheet of paper.
const TOLERANCE: f64 = 0.005;

/// The largest sheets of the series A and B of ISO 216 and the series B of JIS P 0138, in mm. Each next sheet of a series is half as large.
const SERIES: [[f64; 2]; 3] = [[841.0, 1189.0], [1000.0, 1414.0], [1030.0, 1456.0]];
/// The number of the smallest sheet of a series, such as A10.
const SMALLEST: usize = 10;
/// Letter, Legal, and business cards (Europe, ISO 7810 ID-1, North America, China, Australia, Japan), in mm.
const SHEETS: [[f64; 2]; 8] = [
    [215.9, 279.4],
    [215.9, 355.6],
    [55.0, 85.0],
    [53.98, 85.6],
    [50.8, 88.9],
    [54.0, 90.0],
    [55.0, 90.0],
    [55.0, 91.0],
];

/// Returns the reason why the page of a drawing stays under `--fit auto`, if it does.
pub(crate) fn reason_to_stay(doc: &Document, options: &CommonOptions, recipe: &Recipe) -> Option<&'static str> {
    let mut values = recipe.steps.iter().flat_map(|s| s.args.iter()).flat_map(|(_, values)| values);
    if options.frame == FrameChoice::ViewBox || values.any(|v| v.contains("%page")) {
        return Some("the steps refer to it");
    }
    let (units, px) = (doc.view_box(), doc.size_px());
    let (units, px) = ([units.width(), units.height()], [px.width, px.height]);
    if !doc.is_measured() && is_near(px[0], px[1]) && px[0] <= ICON && is_near(units[0], units[1]) {
        return Some("it is an icon's");
    }
    // Some programs write px, mm, inches or points as plain numbers.
    let plain = [MM_PER_PX, 1.0, 25.4, 25.4 / 72.0].map(|mm| units.map(|v| v * mm));
    let sizes = plain.into_iter().filter(|_| !doc.is_measured()).chain([px.map(|v| v * MM_PER_PX)]);
    sizes.into_iter().any(is_paper).then_some("it is a sheet of paper")
}

fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() <= TOLERANCE * b
}

/// Returns `true` for the size of a sheet of paper in mm, upright or lying.
fn is_paper([w, h]: [f64; 2]) -> bool {
    let has_size = |[a, b]: [f64; 2]| is_near(w.min(h), a) && is_near(w.max(h), b);
    let in_series = |largest: [f64; 2]| {
        // ISO 216 rounds down to whole millimetres.
        let half = |[a, b]: &[f64; 2]| Some([(0.5 * b).floor(), *a]);
        std::iter::successors(Some(largest), half).take(SMALLEST + 1).any(has_size)
    };
    SHEETS.into_iter().any(has_size) || SERIES.into_iter().any(in_series)
}

/// The changes of a page.
#[derive(Debug, Clone, Default)]
pub struct PageNews {
    /// The page before and after, in user units, if it is adapted.
    pub change: Option<[Rect; 2]>,
    /// The factor by which the result is scaled to stay on its page, under `--fit shrink`.
    pub(crate) shrunk: Option<f64>,
    /// `true` if the program decided on the change, under `--fit auto`.
    pub(crate) is_automatic: bool,
    /// The artwork that extends past the page and did not before.
    pub(crate) overhang: Option<Overhang>,
    /// The reason why the page stays although it could have grown.
    pub(crate) stays: Option<&'static str>,
    /// `true` if nothing of the result lies on the page.
    pub is_blank: bool,
    /// The warning about artwork that has come onto the page.
    pub arrivals: Option<Warning>,
}

impl PageNews {
    /// Takes the news about the page, and the warning of arrivals, from the result of a warp.
    pub(crate) fn take(warped: &mut pathwarp_svg::WarpedDocument, fit: PageFit, stays: Option<&'static str>) -> Self {
        let arrivals = warped.warnings.iter().position(|w| matches!(w, Warning::Arrivals(_)));
        Self {
            change: warped.page,
            shrunk: warped.back.map(|to| to.determinant().sqrt()),
            is_automatic: fit == PageFit::Auto,
            overhang: warped.overhang,
            stays,
            is_blank: warped.blank,
            arrivals: arrivals.map(|i| warped.warnings.remove(i)),
        }
    }

    /// Reports that `--fit auto` enlarged the page, or moved it when nothing was left on it, or that `--fit shrink` keeps the result on it.
    pub fn note(&self) -> Option<String> {
        if let Some(scale) = self.shrunk {
            return Some(match three_figures(100.0 * scale).as_str() {
                "100" => "the result is moved back onto its page".to_owned(),
                percent => format!("the result is scaled to {percent} % and moved back onto its page"),
            });
        }
        let [before, after] = self.change.filter(|_| self.is_automatic)?;
        let size = |r: Rect| format!("{} × {}", trimmed(r.width(), 2), trimmed(r.height(), 2));
        let (old, new) = (size(before), size(after));
        Some(if before.union(after) == after {
            format!("the page grew from {old} to {new}; --fit none keeps it")
        } else {
            let corner = |r: Rect| format!("{},{}", trimmed(r.x0, 2), trimmed(r.y0, 2));
            let (old_corner, new_corner) = (corner(before), corner(after));
            format!(
                "nothing is left on the page, {old} at {old_corner}, so it moved to the artwork, {new} at {new_corner}; --fit none keeps it"
            )
        })
    }

    /// Returns the warnings about the page.
    pub fn warnings(&self) -> Vec<String> {
        let arrivals = self.arrivals.as_ref().map(ToString::to_string);
        let overhang = self.overhang.filter(|_| !self.is_blank).map(|o| overhang(o, self.stays));
        let blank = self.is_blank.then(|| {
            "nothing is on the page of the result; --fit page sets it to the artwork, --fit shrink moves that back"
                .to_owned()
        });
        [arrivals, overhang, blank].into_iter().flatten().collect()
    }
}

/// Describes artwork that extends past the page, with the options that change it.
fn overhang(o: Overhang, stays: Option<&str>) -> String {
    let names = ["left", "top", "right", "bottom"];
    let sides: Vec<&str> = names.iter().zip(o.by).filter(|(_, by)| *by > 0.0).map(|(name, _)| *name).collect();
    let most = o.by.into_iter().fold(0.0, f64::max);
    let stays = stays.map_or_else(String::new, |why| format!("; the page stays, as {why}"));
    format!(
        "the artwork extends past the page by up to {} units ({} %; {}){stays}; --fit grow enlarges the page, --fit page fits it to the \
         artwork, --fit shrink scales the result back into it",
        three_figures(most),
        three_figures(100.0 * o.share),
        sides.join(", ")
    )
}

/// The changes of the pages of a batch: one warning of each kind for all.
#[derive(Debug, Default)]
pub struct PageCounts {
    /// The number of inputs whose artwork extends past the page, those with blank pages included.
    overhangs: usize,
    /// The largest share of the page's size by which artwork extends past it, with the input concerned.
    most: Option<(f64, String)>,
    /// The number of inputs without anything on their page, and the first of them.
    blank: (usize, Option<String>),
    /// The number of inputs where artwork has come onto the page, and the first of them.
    arrivals: (usize, Option<String>),
}

impl PageCounts {
    /// Adds the input `file` to the counts.
    pub fn add(&mut self, news: &PageNews, file: &str) {
        if let Some(o) = news.overhang {
            self.overhangs += 1;
            if self.most.as_ref().is_none_or(|(most, _)| o.share > *most) {
                self.most = Some((o.share, file.to_owned()));
            }
        }
        for (has, (count, first)) in [(news.is_blank, &mut self.blank), (news.arrivals.is_some(), &mut self.arrivals)] {
            *count += usize::from(has);
            if has && first.is_none() {
                *first = Some(file.to_owned());
            }
        }
    }

    /// Returns `true` if a page has nothing on it.
    pub fn are_blank(&self) -> bool {
        self.blank.0 > 0
    }

    /// Returns the warnings about a batch of `inputs` files.
    pub fn warnings(&self, inputs: usize) -> Vec<String> {
        let overhangs = self.most.as_ref().map(|(share, file)| {
            format!(
                "the artwork of {} of {inputs} inputs extends past the page, most that of {file} ({} %); --fit grow enlarges the pages, \
                 --fit page fits them to the artwork, --fit shrink scales the results back into them",
                self.overhangs,
                three_figures(100.0 * share)
            )
        });
        let (count, first) = &self.blank;
        let blank = first.as_ref().map(|file| {
            format!(
                "nothing is on the page of {count} of {inputs} results, such as that of {file}; --fit page sets the pages to the artwork"
            )
        });
        let (count, first) = &self.arrivals;
        let arrivals = first.as_ref().map(|file| {
            format!("in {count} of {inputs} inputs, such as {file}, shapes that lay off the page have moved onto it")
        });
        [overhangs, blank, arrivals].into_iter().flatten().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::is_paper;

    #[test]
    fn sheets_of_paper_are_known_within_half_a_percent() {
        // ISO 216, table 1: A5, A10, B5, B10; Letter; a business card; and A4 by a little.
        for sheet in
            [[148.0, 210.0], [37.0, 26.0], [176.0, 250.0], [44.0, 31.0], [215.9, 279.4], [85.0, 55.0], [210.9, 298.2]]
        {
            assert!(is_paper(sheet), "{sheet:?}");
        }
        for other in [[100.0, 100.0], [200.0, 100.0], [212.0, 297.0], [210.0, 300.0], [640.0, 480.0]] {
            assert!(!is_paper(other), "{other:?}");
        }
    }
}
