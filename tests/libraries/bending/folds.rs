//! `bend` warns of folds on the artwork, and only there.

use pathwarp::Outline;
use pathwarp::deform::Registry;
use pathwarp::map::Map;
use pathwarp::param::{Args, Frame};
use pathwarp::recipe::{Recipe, Step};

const ARTWORK: [&str; 5] = [
    "M10 90L95 80L40 5Z",
    "M50 0A50 30 0 1 1 50 60A50 30 0 1 1 50 0Z",
    "M0 0H100V60H0ZM4 4V56H96V4Z",
    "M0 0L50 40L100 0Z",
    "M0 60C0 20 100 20 100 60",
];
const ALONG: [&str; 6] = [
    "M0 50Q50 -40 100 50",
    "M0 0C40 90 60 -60 100 20",
    "M0 0H60A20 20 0 0 1 60 40H0",
    "M0 60A60 60 0 0 1 120 60",
    "circle:r=120",
    "M0 0L50 20L100 0",
];

/// Returns `true` if a bend warns of a fold, and the fraction of evenly spaced points of the artwork that it turns over.
fn bent(outline: &Outline, args: &[(&str, &str)]) -> (bool, f64) {
    let recipe = Recipe { steps: vec![Step::new("bend", Args::from_pairs(args))] };
    let frame = Frame::new(outline.bounding_box().unwrap());
    let built = recipe.build(&Registry::builtin(), frame, &std::iter::once(outline)).unwrap();
    let places = outline.segs().flat_map(|s| (0..4001).map(move |i| s.eval((f64::from(i) + 0.31) / 4001.0)));
    let dets: Vec<f64> = places.map(|p| built.map.jet(p).det()).collect();
    let over = dets.iter().filter(|d| **d < 0.0).count() as f64 / dets.len() as f64;
    (built.steps.iter().any(|s| s.explanation.warnings.iter().any(|w| w.contains("folds over itself"))), over)
}

#[test]
fn a_bend_warns_of_folds_on_the_artwork_alone() {
    let (mut folded, mut flat) = (0, 0);
    for d in ARTWORK {
        let outline = Outline::from_svg(d).unwrap();
        for along in ALONG {
            for stretch in ["scale", "fit"] {
                for (width, baseline) in
                    [("0.485", "50%"), ("1", "0%"), ("1.7", "50%"), ("0.9", "100%"), ("2.6", "40%")]
                {
                    let args = [("along", along), ("stretch", stretch), ("width", width), ("baseline", baseline)];
                    let (warned, over) = bent(&outline, &args);
                    if over == 0.0 {
                        assert!(!warned, "{d} {args:?}");
                        flat += 1;
                    } else if over > 0.005 {
                        assert!(warned, "{d} {args:?}: {over}");
                        folded += 1;
                    }
                }
            }
        }
    }
    assert!(folded > 50 && flat > 50, "{folded} {flat}");
}
