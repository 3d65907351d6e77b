use super::*;

fn shading(gradient: &str) -> Shading {
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'>{gradient}<rect width='100' height='80' \
         fill='url(#a)'/></svg>"
    );
    let tree = usvg::Tree::from_str(&svg, &usvg::Options::default()).unwrap();
    let usvg::Node::Path(path) = &tree.root().children()[0] else { panic!("{svg}") };
    Shading::of(path.fill().unwrap().paint()).unwrap()
}

const SMOOTH: &[&str] = &[
    "<linearGradient id='a' x2='.3' y2='.4'><stop stop-color='red'/><stop offset='.7' stop-color='#0f8'/><stop offset='1' \
     stop-color='blue' stop-opacity='.2'/></linearGradient>",
    "<radialGradient id='a' cx='.4' fx='.5' r='.4' gradientTransform='rotate(20) scale(1 .6)'><stop stop-color='red'/>\
     <stop offset='1' stop-color='#080' stop-opacity='0'/></radialGradient>",
    "<linearGradient id='a' spreadMethod='reflect' x2='.3'><stop stop-color='red'/><stop offset='1'/></linearGradient>",
];

#[test]
fn no_colour_changes_faster_than_the_bound() {
    for gradient in SMOOTH {
        let shading = shading(gradient);
        let (bound, mut fastest) = (shading.steepest(), 0.0_f64);
        for k in 0..20_000 {
            let p = Point::new(0.5 * f64::from(k % 200), 0.8 * f64::from(k / 200));
            for step in [Vec2::new(0.05, 0.0), Vec2::new(0.0, 0.05), Vec2::new(0.03, 0.04)] {
                let (a, b) = (shading.premultiplied(p), shading.premultiplied(p + step));
                fastest = a.iter().zip(b).map(|(a, b)| (a - b).abs() / 0.05).fold(fastest, f64::max);
            }
        }
        assert!(fastest <= bound * 1.001 && fastest > 0.2 * bound, "{gradient}: {fastest} {bound}");
    }
}

#[test]
fn jumps_count_if_they_are_shown() {
    let hard = "<linearGradient id='a'><stop offset='.5' stop-color='red'/><stop offset='.5' stop-color='blue'/>\
                </linearGradient>";
    let repeated = "<linearGradient id='a' spreadMethod='repeat' x2='.2'><stop stop-color='red'/><stop offset='1' \
                    stop-color='blue'/></linearGradient>";
    let places = |from: f64, to: f64| [Point::new(from, 5.0), Point::new(to, 50.0)].into_iter();
    assert!(shading(hard).steepest() > 1e3 && shading(repeated).steepest() == f64::INFINITY);
    assert!(shading(hard).jumps(places(0.0, 100.0), 0.05));
    assert!(!shading(hard).jumps(places(0.0, 40.0), 0.05));
    assert!(!shading(&hard.replace("blue", "#fe0000")).jumps(places(0.0, 100.0), 0.05));
    assert!(shading(repeated).jumps(places(0.0, 100.0), 0.05));
    for gradient in SMOOTH {
        assert!(!shading(gradient).jumps(places(0.0, 100.0), 0.05));
    }
}
