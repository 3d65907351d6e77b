//! The first values of a deformation that is put on the drawing: those that change nothing yet and give every handle its place.
//!
//! Values not listed here follow from the registry: the parameters' own defaults, or else the example values (`Info::demo`) that
//! every deformation shows itself with. So the deformations of a plug-in open like the others.

use pathwarp::Outline;
use pathwarp::deform::Info;
use pathwarp::kurbo::{Affine, Rect};
use pathwarp::param::{Kind, Param, is_inline};
use std::collections::BTreeMap;

/// Values by deformation and parameter. Points are in % of the frame; path data is laid from the box 0,0,100,100 onto it.
const NEUTRAL: [(&str, &str, &[&str]); 12] = [
    (
        "shaper",
        "shaper",
        &[
            "M0,100 C33.3333,100 66.6667,100 100,100 C100,66.6667 100,33.3333 100,0 C66.6667,0 33.3333,0 0,0 C0,33.3333 0,66.6667 0,100 Z",
        ],
    ),
    ("envelope", "top", &["M0,0 C33.3333,0 66.6667,0 100,0"]),
    ("envelope", "bottom", &["M0,100 C33.3333,100 66.6667,100 100,100"]),
    ("bilinear", "target", &["0%,100% 100%,100% 100%,0% 0%,0%"]),
    ("projective", "target", &["0%,100% 100%,100% 100%,0% 0%,0%"]),
    ("birational", "top", &["0%,0% 33.3333%,0% 66.6667%,0% 100%,0%"]),
    ("birational", "bottom", &["0%,100% 33.3333%,100% 66.6667%,100% 100%,100%"]),
    ("bend", "along", &["M0,50 C33.3333,50 66.6667,50 100,50"]),
    (
        "mesh",
        "net",
        &["M0,0 C16.6667,0 33.3333,0 50,0 C66.6667,0 83.3333,0 100,0 \
         M0,33.3333 C16.6667,33.3333 33.3333,33.3333 50,33.3333 C66.6667,33.3333 83.3333,33.3333 100,33.3333 \
         M0,66.6667 C16.6667,66.6667 33.3333,66.6667 50,66.6667 C66.6667,66.6667 83.3333,66.6667 100,66.6667 \
         M0,100 C16.6667,100 33.3333,100 50,100 C66.6667,100 83.3333,100 100,100"],
    ),
    ("mls", "pair", &["0%,0%:0%,0%", "100%,0%:100%,0%", "100%,100%:100%,100%", "0%,100%:0%,100%", "50%,50%:50%,50%"]),
    ("similitude", "target", &["0%,100% 100%,100%"]),
    ("ffd", "degree", &["3x3"]),
];

/// Another way to begin with a deformation.
pub(crate) struct Variant {
    deformation: &'static str,
    /// Its name for people.
    pub(crate) label: &'static str,
    /// The parameter that takes the place of the usual ones.
    pub(crate) param: &'static str,
    /// A value that changes nothing, in the box 0,0,100,100.
    neutral: &'static str,
    /// A value that shows what it does.
    showing: &'static str,
}

const VARIANTS: [Variant; 2] = [
    Variant {
        deformation: "shaper",
        label: "Cage, 16 points",
        param: "net",
        neutral: "M0,100 C33.3333,100 66.6667,100 100,100 M0,66.6667 C33.3333,66.6667 66.6667,66.6667 100,66.6667 \
                  M0,33.3333 C33.3333,33.3333 66.6667,33.3333 100,33.3333 M0,0 C33.3333,0 66.6667,0 100,0",
        showing: "M0,100 C33,110 67,90 100,100 M0,67 C10,40 50,110 100,67 M0,33 C50,-10 90,60 100,33 M0,0 C33,10 67,-10 100,0",
    },
    Variant {
        deformation: "envelope",
        label: "Closed shape",
        param: "envelope",
        neutral: "M0,100 L50,100 L100,100 L100,50 L100,0 L50,0 L0,0 L0,50 Z",
        showing: "M10,95 L50,120 L90,95 L100,50 L90,5 L50,-20 L10,5 L0,50 Z",
    },
];

/// The other ways to begin with a deformation.
pub(crate) fn variants(deformation: &str) -> impl Iterator<Item = &'static Variant> {
    VARIANTS.iter().filter(move |v| v.deformation == deformation)
}

impl Variant {
    /// The first values for artwork in `frame`: those that change nothing, or those that show something.
    pub(crate) fn values(&self, frame: Rect, shows: bool) -> BTreeMap<String, Vec<String>> {
        let data = if shows { self.showing } else { self.neutral };
        BTreeMap::from([(self.param.to_owned(), vec![laid_out(data, frame)])])
    }
}

/// Values that show something, where the registry's example suits its own drawing only.
const SHOWING: [(&str, &str, &[&str]); 2] =
    [("anamorph", "distance", &["300%"]), ("anamorph", "onto", &["cylinder:radius=80%"])];

/// The first values of a deformation for artwork in `frame`.
pub(crate) fn opening(info: &Info, frame: Rect) -> BTreeMap<String, Vec<String>> {
    let mut out: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (_, param, values) in NEUTRAL.iter().filter(|(deformation, ..)| *deformation == info.name) {
        if let Some(p) = info.params.iter().find(|p| p.name == *param) {
            let laid = values.iter().map(|v| if is_path_data(p, v) { laid_out(v, frame) } else { (*v).to_owned() });
            out.insert((*param).to_owned(), laid.collect());
        }
    }
    // A preset stands for itself; the first one is as good as any.
    if let Some((gallery, p)) = info.gallery.and_then(|g| Some((g, info.params.iter().find(|p| p.name == g.presets)?)))
        && p.default.is_none()
        && let Kind::NameOrFile([first, ..]) = p.kind
    {
        out.insert(gallery.presets.to_owned(), vec![(*first).to_owned()]);
        return out;
    }
    if out.is_empty() && !shows_something(info) { example(info, frame) } else { out }
}

/// The values that show the effect of a deformation on artwork in `frame`.
pub(crate) fn example(info: &Info, frame: Rect) -> BTreeMap<String, Vec<String>> {
    let mut out: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (_, param, values) in SHOWING.iter().filter(|(deformation, ..)| *deformation == info.name) {
        out.insert((*param).to_owned(), values.iter().map(|v| (*v).to_owned()).collect());
    }
    if !out.is_empty() {
        return out;
    }
    for (name, value) in info.demo {
        if let Some(p) = info.params.iter().find(|p| p.name == *name) {
            out.entry((*name).to_owned()).or_default().push(from_demo(p, value, frame));
        }
    }
    out
}

/// Returns `true` if the defaults alone build a map worth looking at: no parameter is needed, and at least one has a default.
fn shows_something(info: &Info) -> bool {
    let has_default = |p: &Param| p.default.is_some() && matches!(p.kind, Kind::Number | Kind::Length(_) | Kind::Angle);
    info.params.iter().all(|p| !p.needed) && info.params.iter().filter(|p| has_default(p)).count() > 1
}

fn is_path_data(p: &Param, value: &str) -> bool {
    p.kind == Kind::Path && is_inline(value) && value.trim_start().starts_with(['M', 'm'])
}

/// Path data laid from the box 0,0,100,100 onto the frame.
fn laid_out(data: &str, frame: Rect) -> String {
    let Ok(outline) = Outline::from_svg(data) else { return data.to_owned() };
    let place = Affine::translate(frame.origin().to_vec2())
        * Affine::scale_non_uniform(0.01 * frame.width(), 0.01 * frame.height());
    crate::grips::path_data(&outline.transformed(place))
}

/// An example value for the frame 0,0,100,100, for this frame: its coordinates become percentages.
fn from_demo(p: &Param, value: &str, frame: Rect) -> String {
    if is_path_data(p, value) {
        return laid_out(value, frame);
    }
    let is_number = |t: &str| t.parse::<f64>().is_ok();
    let percent = |t: &str| if is_number(t) { format!("{t}%") } else { t.to_owned() };
    let points = |v: &str| {
        let words = v.split(' ').map(|word| {
            let pairs = word.split(':').map(|pair| pair.split(',').map(percent).collect::<Vec<_>>().join(","));
            pairs.collect::<Vec<_>>().join(":")
        });
        words.collect::<Vec<_>>().join(" ")
    };
    match p.kind {
        Kind::Point | Kind::Path | Kind::Text("X,Y" | "X,Y:X,Y") | Kind::Length(_) => points(value),
        _ => value.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::deform::Registry;
    use pathwarp::kurbo::Point;
    use pathwarp::map::Map as _;
    use pathwarp::param::{Args, Frame};
    use pathwarp::recipe::{Recipe, Step};

    const FRAME: Rect = Rect::new(20.0, 30.0, 684.0, 230.0);

    fn build(info: &Info) -> pathwarp::recipe::BuiltRecipe {
        build_with(info, opening(info, FRAME))
    }

    fn build_with(info: &Info, values: BTreeMap<String, Vec<String>>) -> pathwarp::recipe::BuiltRecipe {
        let mut args = Args::new();
        for (name, values) in values {
            args.set(&name, values);
        }
        let art = Outline::from_svg("M20,30 H684 V230 H20 Z").unwrap();
        let recipe = Recipe { steps: vec![Step::new(info.name, args)] };
        let built = recipe.build(&Registry::builtin(), Frame::new(FRAME), &std::iter::once(&art));
        built.unwrap_or_else(|e| panic!("{}: {e}", info.name))
    }

    #[test]
    fn every_deformation_opens() {
        for entry in Registry::builtin().entries() {
            build(entry.info());
        }
    }

    #[test]
    fn neutral_values_move_nothing() {
        let registry = Registry::builtin();
        let info = |name: &str| registry.get(name).unwrap().info();
        let usual = NEUTRAL.iter().map(|(name, ..)| (*name, build(info(name))));
        let others = VARIANTS.iter().map(|v| (v.label, build_with(info(v.deformation), v.values(FRAME, false))));
        for (name, built) in usual.chain(others) {
            for p in [Point::new(20.0, 30.0), Point::new(333.0, 111.0), Point::new(600.0, 200.0)] {
                let off = built.map.point(p).distance(p);
                assert!(off < 1e-2, "{name} moves {p} by {off}");
            }
        }
        for v in &VARIANTS {
            let p = FRAME.center() + pathwarp::kurbo::Vec2::new(60.0, 30.0);
            let built = build_with(info(v.deformation), v.values(FRAME, true));
            assert!(built.map.point(p).distance(p) > 5.0, "{} shows nothing", v.label);
        }
    }
}
