//! Nothing hides between samples: maps with features much smaller than the segments that run over them. Results are measured densely, at
//! parameters unrelated to those of the fitter.

use pathwarp::deform::{Ffd, Mesh, Registry};
use pathwarp::kurbo::{Affine, Point, Rect};
use pathwarp::map::{Chain, Map, inverse_over};
use pathwarp::param::{Args, Frame};
use pathwarp::refit::{Assurance, Nodes, Options, RefittedPath, warp_path};
use pathwarp::{Outline, check};
use pathwarp_oracle::curves::Curved as _;
use pathwarp_oracle::{Random, Run, far};
use std::sync::Arc;

const BOX: Rect = Rect::new(0.0, 0.0, 400.0, 300.0);
const TOLERANCE: f64 = 0.05;

/// A line, a rectangle, an arc, a cubic and a circle.
const SHAPES: [&str; 5] = [
    "M0,150H400",
    "M20,20H380V280H20Z",
    "M40,260A200,170 0 0 1 360,250",
    "M10,20C100,400 300,-100 390,280",
    "M60,150A140,140 0 1 1 340,150A140,140 0 1 1 60,150Z",
];

fn map_of(name: &str, args: &[(&str, &str)]) -> Arc<dyn Map> {
    Registry::builtin().get(name).unwrap().build_from(&Args::from_pairs(args), &Frame::new(BOX)).unwrap().map
}

/// Returns the largest distance of the true image from a path, by about `samples` of each segment, offset by an irrational fraction.
fn off(outline: &Outline, map: &dyn Map, warped: &RefittedPath, samples: usize) -> f64 {
    let place = |i: usize| (i as f64 + 0.5 + 0.4 * (i as f64 * 0.754_877_666_2).fract()) / (samples as f64 + 1.0);
    let points: Vec<Point> =
        outline.segs().flat_map(|seg| (0..samples).map(move |i| map.point(seg.eval(place(i))))).collect();
    far(&points, &[Run::of(&warped.path.curves()).sampled(8, TOLERANCE)]).0
}

/// Outcomes of paths under maps.
#[derive(Default)]
struct Found {
    right: usize,
    /// Reported as beyond the tolerance.
    warned: Vec<String>,
    /// Refused with an error.
    refused: usize,
    /// Beyond the tolerance without a report, or not even reported as checked.
    silent: Vec<String>,
}

impl Found {
    fn look(&mut self, what: &str, d: &str, map: &dyn Map, merge: bool, samples: usize) {
        let outline = Outline::from_svg(d).unwrap();
        let Ok(warped) = warp_path(
            &outline,
            map,
            &Options::new(TOLERANCE).with_nodes(if merge { Nodes::Fewest } else { Nodes::Source }),
        ) else {
            self.refused += 1;
            return;
        };
        let off = off(&outline, map, &warped, samples);
        let r = &warped.report;
        let says = || format!("{what} on {d}, merge {merge}: {off} is {:?} {}", r.assurance, r.max_error);
        if !r.unresolved.is_empty() {
            self.warned.push(says());
        } else if off <= TOLERANCE * (1.0 + 1e-6) && r.assurance >= Assurance::Checked {
            self.right += 1;
        } else {
            self.silent.push(says());
        }
    }

    /// Asserts that no result is wrong without a report, and that at most `given_up` are refused or reported.
    #[track_caller]
    fn judge(&self, given_up: usize) {
        assert!(self.silent.is_empty(), "{} of {}:\n{}", self.silent.len(), self.right, self.silent.join("\n"));
        let warned = self.warned.join("\n");
        assert!(self.refused + self.warned.len() <= given_up, "{} refused, warned of:\n{warned}", self.refused);
    }
}

#[test]
fn waves_that_fit_the_samples() {
    let mut found = Found::default();
    for phase in ["0", "90"] {
        let wave = map_of("wave", &[("length", "10"), ("height", "3"), ("phase", phase)]);
        for merge in [false, true] {
            let rect = "M10,10H180V95H10Z";
            found.look("a wave", rect, &*wave, merge, 1500);
            found.look("a cog", rect, &Chain::new([wave.clone(), map_of("polar", &[])]), merge, 1500);
        }
    }
    found.judge(0);
}

#[test]
fn bumps_waves_and_steps_by_formulas() {
    let mut found = Found::default();
    for y in [
        "y-20*exp(-(x-200)^2/64)",
        "y+6*cos(2*pi*17*u)",
        "y+3*tanh((x-123)*9)",
        "y+abs(sin(x))",
        "y+4*mod(x/9,1)",
        "y+30*noise(x/30,y/30)",
        "y+20/(1+exp(-(x-77.7)*8))",
        "y+max(0,3-abs(x-91))",
    ] {
        for merge in [false, true] {
            found.look(y, "M0,0H400V300H0Z", &*map_of("expr", &[("y", y)]), merge, 4000);
        }
    }
    found.judge(0);
}

#[test]
fn small_swirls() {
    let mut found = Found::default();
    for falloff in ["soft", "sharp", "endless"] {
        let swirl = map_of("swirl", &[("angle", "90"), ("falloff", falloff), ("radius", "5")]);
        found.look(falloff, "M0,150H400M10,20C100,400 300,-100 390,280", &*swirl, true, 9000);
    }
    found.judge(0);
}

/// Every built-in map declares how closely its curves must be sampled, and so does its inverse.
#[test]
fn built_in_maps_are_not_merely_sampled() {
    let frame = check::frame();
    let art = Outline::from_svg("M31,42L68,55M60,35C70,40 64,52 50,50").unwrap();
    let mut seen = 0;
    for entry in Registry::builtin().entries() {
        let info = entry.info();
        let map = entry.build_from(&Args::from_pairs(info.demo), &frame).unwrap().map;
        let image = map.jet(Point::new(50.0, 50.0)).p;
        let moved = Affine::translate(image - Point::new(50.0, 50.0)) * Affine::scale_about(0.2, (50.0, 50.0));
        for (way, map, art) in [
            ("it", map.clone(), art.clone()),
            ("its inverse", inverse_over(map.clone(), frame.rect), art.transformed(moved)),
        ] {
            if let Ok(w) = warp_path(&art, &*map, &Options::new(0.01)) {
                assert!(w.report.assurance > Assurance::Sampled, "{}, {way}", info.name);
                seen += 1;
            }
        }
    }
    assert!(seen > Registry::builtin().entries().len() * 3 / 2, "{seen}");
}

/// Returns a formula with features down to a thousandth of the frame.
fn formula(r: &mut Random) -> String {
    let (at, y, share) = (r.between(40.0, 360.0), r.between(20.0, 280.0), r.between(0.0, 1.0));
    let width = 400.0 * 10f64.powf(r.between(-3.0, -1.0));
    let k = 0.02 * 50f64.powf(r.between(0.0, 1.0));
    match r.below(8) {
        0 => format!("y+20*exp(-((x-{at})/{width})^2)"),
        1 => format!("y-9*exp(-((x-{at})^2+(y-{y})^2)/{})", width * width),
        2 => format!("y+5*sin({k}*x)*cos({}*y+{share})", 0.7 * k),
        3 => format!("y+12/(1+exp(-(x-{at})/{width}))"),
        4 => format!("y+6*abs(sin({k}*x+{share}))"),
        5 => format!("y+min(8*sin({k}*x),max(-3,4*cos({}*y)))", 1.3 * k),
        6 => format!("y+7*tanh((x-{at})/{width})+{width}*noise(x/{width},y/{width})"),
        _ => format!("y+{width}*mod(x/{width}+y/90,1)+3*smoothstep({at},{},x)", at + width),
    }
}

/// Kinds of maps with small features.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Wave,
    Small,
    Formula,
    Grid,
    Style,
}

const KINDS: [Kind; 5] = [Kind::Wave, Kind::Small, Kind::Formula, Kind::Grid, Kind::Style];

/// Returns a map of a kind, its description, and the samples of a segment that show its features.
fn any_map(kind: Kind, r: &mut Random) -> (String, Arc<dyn Map>, usize) {
    let text = |v: f64| format!("{v}");
    let n = (1 + r.below(300)) as f64;
    let center = format!("{},{}", r.between(20.0, 380.0), r.between(20.0, 280.0));
    let small = text(r.between(3.0, 8.0));
    let (name, args): (&str, Vec<(&str, String)>) = match kind {
        Kind::Wave => {
            let phase = text(10.0 * r.below(36) as f64);
            let kind = r.one_of(&["shear", "push"]).to_owned();
            let height = if kind == "push" { 0.1 * 400.0 / n } else { r.between(0.5, 9.0) };
            ("wave", vec![("length", text(400.0 / n)), ("phase", phase), ("height", text(height)), ("kind", kind)])
        }
        Kind::Formula => ("expr", vec![("y", formula(r))]),
        Kind::Small => {
            let angle = text(r.between(-200.0, 200.0));
            match r.below(4) {
                0 => {
                    let falloff = r.one_of(&["soft", "sharp", "endless"]).to_owned();
                    ("swirl", vec![("angle", angle), ("radius", small), ("center", center), ("falloff", falloff)])
                }
                1 => {
                    let (amount, edge) = (text(r.between(-0.8, 0.9)), r.one_of(&["soft", "sharp"]).to_owned());
                    ("bulge", vec![("radius", small), ("center", center), ("amount", amount), ("edge", edge)])
                }
                2 => {
                    // Focal lengths down to a thousandth of the frame.
                    let to = r.one_of(&["equidistant", "equisolid"]).to_owned();
                    let field = text(359.0 - 10f64.powf(r.between(-0.3, 2.3)));
                    (
                        "lens",
                        vec![("from", "stereographic".to_owned()), ("to", to), ("field", field), ("center", center)],
                    )
                }
                _ => {
                    let at = text(r.between(20.0, 350.0));
                    ("mls", vec![("pair", format!("{at},150:{at},140")), ("pin", format!("{at},153"))])
                }
            }
        }
        Kind::Grid => {
            let deep = r.between(1.0, 4.0);
            let map = if r.below(2) == 0 {
                let mut grid = Ffd::new(BOX).degree(3, 3).cells(40, 2).extend(true);
                for i in (0..43).step_by(2) {
                    grid = grid.shift(i, 1, (0.0, deep));
                }
                grid.build()
            } else {
                let point = |i: usize, j: usize| {
                    Point::new(
                        i as f64 * 400.0 / 120.0,
                        j as f64 * 100.0 + if i.is_multiple_of(2) { deep } else { 0.0 },
                    )
                };
                Mesh::new(BOX, (0..4).map(|j| (0..121).map(|i| point(i, j)).collect()).collect()).build()
            };
            return (format!("a grid, {deep} deep"), map.unwrap().map, 9973);
        }
        Kind::Style => {
            let bend = text(r.between(-1.5, 1.5));
            if r.below(2) == 0 {
                let style = r.one_of(&["wave", "flag", "fish", "rise", "twist", "arc"]);
                ("warp", vec![("style", style.to_owned()), ("bend", bend)])
            } else {
                let preset = r.one_of(&["wave1", "wave2", "double-wave1", "wave4", "button"]);
                ("wordart", vec![("preset", preset.to_owned())])
            }
        }
    };
    let pairs: Vec<(&str, &str)> = args.iter().map(|(k, v)| (*k, v.as_str())).collect();
    (format!("{name} {args:?}"), map_of(name, &pairs), if kind == Kind::Wave { 30 * n as usize + 997 } else { 9973 })
}

/// Runs random maps of a kind over all shapes.
fn sweep(kind: Kind, seed: u64, count: usize) -> Found {
    let (mut r, mut found) = (Random::new(seed), Found::default());
    for i in 0..count {
        let (what, map, samples) = any_map(kind, &mut r);
        found.look(&what, r.one_of(&SHAPES), &*map, i % 2 == 0, samples);
    }
    found
}

/// Runs chains of two maps of any kinds over all shapes.
fn chains(seed: u64, count: usize) -> Found {
    let (mut r, mut found) = (Random::new(seed), Found::default());
    for i in 0..count {
        let ([one, two], d) = ([r.one_of(&KINDS), r.one_of(&KINDS)], r.one_of(&SHAPES));
        let ((first, map, n), (second, other, m)) = (any_map(one, &mut r), any_map(two, &mut r));
        found.look(&format!("{first} + {second}"), d, &Chain::new([map, other]), i % 2 == 0, n.max(m));
    }
    found
}

#[test]
fn nothing_hides_in_random_maps() {
    for (kind, count) in KINDS.into_iter().zip([10, 14, 20, 6, 8]) {
        sweep(kind, 1, count).judge(2);
    }
}

#[test]
fn nothing_hides_in_random_chains() {
    chains(1, 16).judge(4);
}

/// Run with `cargo test --release --test libraries hidden -- --ignored --nocapture`; `docs/benchmarks.md` has the counts.
#[test]
#[ignore = "thousands of maps take minutes"]
fn nothing_hides_in_thousands_of_maps() {
    let all = KINDS.into_iter().map(|kind| (format!("{kind:?}"), sweep(kind, 2, 600)));
    for (kind, found) in all.chain([("Chain".to_owned(), chains(2, 600))]) {
        let Found { right, warned, refused, silent } = found;
        println!("{kind}: {right} right, {} warned of, {refused} refused, {} silent", warned.len(), silent.len());
        println!("{}\n{}", warned.join("\n"), silent.join("\n"));
    }
}
