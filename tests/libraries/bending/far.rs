//! Moved by ten million units together with its artwork, every deformation gives an equal map. Only `expr` is written in coordinates.

use pathwarp::deform::{Built, Registry};
use pathwarp::kurbo::{Point, Rect, Vec2};
use pathwarp::map::{Map, inverse_over};
use pathwarp::param::{Args, Frame};

/// An offset so large that a unit is a ten-millionth of the coordinates; exact in binary.
const FAR: Vec2 = Vec2::new(1e7, -1.2e7);
const FRAME: Rect = Rect::new(0.0, 0.0, 100.0, 100.0);
/// Largest difference, as a fraction of the frame's width.
const SAME: f64 = 1e-8;

/// A deformation, and settings with `@` before each x,y that is a point.
type Setting = (&'static str, &'static [(&'static str, &'static str)]);

/// Settings of every deformation except `expr`.
const SETTINGS: &[Setting] = &[
    (
        "shaper",
        &[("shaper", "M@10,90C@40,110 @60,70 @95,85C@85,60 @105,40 @90,15C@60,-5 @40,35 @5,10C@15,40 @0,60 @10,90Z")],
    ),
    (
        "shaper",
        &[
            ("shaper", "M@10,90C@40,110 @60,70 @95,85C@85,60 @105,40 @90,15C@60,-5 @40,35 @5,10C@15,40 @0,60 @10,90Z"),
            ("base", "@10,80 @90,80"),
            ("target", "@0,90 @80,70"),
        ],
    ),
    (
        "envelope",
        &[
            (
                "envelope",
                "M@8,78Q@30,96 @50,84T@95,85C@85,60 @105,40 @90,15L@70,6C@50,-5 @30,30 @5,10C@15,40 @0,60 @8,78Z",
            ),
            ("corners", "1,3,4,6"),
        ],
    ),
    (
        "envelope",
        &[("envelope", "M@50,0C@80,0 @100,20 @100,50C@100,80 @80,100 @50,100C@20,100 @0,80 @0,50C@0,20 @20,0 @50,0Z")],
    ),
    (
        "envelope",
        &[("envelope", "M@50,90C@0,50 @0,10 @25,10C@40,10 @50,25 @50,30C@50,25 @60,10 @75,10C@100,10 @100,50 @50,90Z")],
    ),
    ("warp", &[("style", "arc"), ("bend", "40%"), ("horizontal", "15%"), ("vertical", "-20%")]),
    ("warp", &[("style", "fisheye"), ("bend", "40%")]),
    ("warp", &[("style", "twist"), ("bend", "40%")]),
    ("wordart", &[("preset", "wave1"), ("adj", "adj1=15000"), ("adj", "adj2=4000")]),
    ("wordart", &[("preset", "circle-pour")]),
    ("wordart", &[("preset", "button-pour")]),
    ("wordart", &[("preset", "ring-inside")]),
    ("wordart", &[("preset", "arch-up")]),
    ("wordart", &[("preset", "circle")]),
    ("bilinear", &[("target", "@0,100 @95,90 @75,20 @15,5")]),
    ("birational", &[("top", "@0,10 @30,-25 @70,30 @100,5"), ("bottom", "@5,90 @35,110 @60,70 @95,100")]),
    ("bend", &[("along", "M@-10,60Q@25,35 @50,45T@110,50")]),
    ("bend", &[("along", "M@0,60A50,40 0 0 1 @110,50"), ("stretch", "scale"), ("spacing", "even")]),
    ("bend", &[("along", "M@-10,60Q@25,35 @50,45T@110,50"), ("by", "parameter")]),
    ("polar", &[("turn", "15")]),
    ("polar", &[("turn", "15"), ("spacing", "conformal"), ("sweep", "200")]),
    (
        "ffd",
        &[("degree", "3x2"), ("move", "1,0:5,25"), ("move", "2,1:15,-20"), ("at", "0,2:@-10,105"), ("weight", "1,1:2")],
    ),
    ("ffd", &[("spline", "true"), ("cells", "5x4"), ("move", "2,2:9,4"), ("pin", "@50,50:@60,40")]),
    (
        "mesh",
        &[(
            "net",
            "M@0,10C@20,10 @30,0 @50,0C@70,0 @80,10 @100,10M@0,40C@20,40 @35,30 @50,33C@65,36 @80,40 @100,40\
M@5,70C@20,70 @30,60 @50,66C@70,72 @80,70 @95,70M@0,100C@20,105 @30,95 @50,100C@70,105 @80,105 @100,110",
        )],
    ),
    ("triangle", &[("move", "0,1,1:10,15"), ("weight", "1,1,0:2")]),
    ("triangle", &[("reference", "@0,0 @100,0 @20,110"), ("degree", "1"), ("move", "1,0,0:10,15"), ("extend", "true")]),
    ("mls", &[("pin", "@10,90"), ("pin", "@90,90"), ("pair", "@50,15:@60,5"), ("pair", "@52,55:@45,48")]),
    ("mls", &[("pin", "@10,90"), ("pair", "@50,15:@60,5"), ("pair", "@52,55:@45,48"), ("kind", "affine")]),
    ("mls", &[("pin", "@10,90"), ("pair", "@50,15:@60,5"), ("pair", "@52,55:@45,48"), ("kind", "similar")]),
    ("projective", &[("target", "@0,100 @100,90 @75,20 @15,5")]),
    ("anamorph", &[("distance", "500"), ("eye-height", "400"), ("onto", "plane:floor")]),
    ("anamorph", &[("distance", "500"), ("eye-height", "400"), ("onto", "plane:ramp=20")]),
    ("anamorph", &[("distance", "500"), ("onto", "plane:wall=-35")]),
    ("anamorph", &[("distance", "500"), ("onto", "plane:wall=-35"), ("view", "@20,30,200")]),
    ("anamorph", &[("distance", "300"), ("onto", "cylinder:radius=80")]),
    ("anamorph", &[("distance", "300"), ("onto", "cone:top-radius=90,bottom-radius=70"), ("eye", "@40,70")]),
    ("anamorph", &[("distance", "200"), ("onto", "sphere:eye"), ("view", "@105,120,150")]),
    ("anamorph", &[("distance", "120"), ("onto", "sphere:radius=150,inside"), ("view", "@60,20,150")]),
    ("anamorph", &[("eye", "@-30,20"), ("push", "1,1:2")]),
    ("anamorph", &[("eye", "inf:0.2,-1,1.5"), ("onto", "plane:floor")]),
    ("anamorph", &[("eye", "inf:20deg,10deg"), ("onto", "cylinder:radius=80")]),
    ("anamorph", &[("eye", "inf:1,-0.5"), ("degree", "2"), ("away", "1,1:9")]),
    ("anamorph", &[("mirror", "cylinder:radius=60"), ("distance", "300"), ("eye-height", "250")]),
    ("anamorph", &[("mirror", "sphere:radius=250"), ("distance", "400"), ("eye-height", "350"), ("foot", "@40,150")]),
    ("anamorph", &[("eye", "@50,200"), ("reference", "@0,100 @100,100 @50,0"), ("point", "@50,40:1.25")]),
    ("wave", &[("angle", "20"), ("phase", "30"), ("grow", "0.5")]),
    ("wave", &[("angle", "20"), ("kind", "push"), ("length", "7")]),
    ("swirl", &[("angle", "120"), ("radius", "40"), ("falloff", "sharp")]),
    ("swirl", &[("angle", "120"), ("radius", "40"), ("falloff", "endless"), ("center", "@30,40")]),
    ("bulge", &[("amount", "1"), ("radius", "40")]),
    ("lens", &[("field", "120"), ("from", "rectilinear"), ("to", "equisolid")]),
    ("mobius", &[("pole", "@60,250")]),
    ("mobius", &[("from", "@0,0 @100,0 @50,100"), ("to", "@10,0 @90,10 @40,90")]),
    ("similitude", &[("target", "@20,90 @80,70")]),
    ("affine", &[("rotate", "20"), ("scale-x", "80%"), ("skew-x", "15")]),
];

/// Returns the value with its marked points moved.
fn moved(value: &str, by: Vec2) -> String {
    let mut parts = value.split('@');
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let is_number = |c: char| c.is_ascii_digit() || c == '-' || c == '.';
        let (x, rest) = part.split_once(',').unwrap();
        let end = rest.find(|c| !is_number(c)).unwrap_or(rest.len());
        let (y, rest) = rest.split_at(end);
        let [x, y] = [x, y].map(|v| v.parse::<f64>().unwrap());
        out += &format!("{},{}{rest}", x + by.x, y + by.y);
    }
    out
}

/// Builds the setting for a frame of 100 × 100 that is moved.
fn built((name, pairs): &Setting, by: Vec2) -> Built {
    let mut args = Args::new();
    for (key, value) in *pairs {
        args.push(key, moved(value, by));
    }
    let frame = Frame::new(FRAME + by);
    let entry = Registry::builtin().get(name).unwrap().clone();
    entry.build_from(&args, &frame).unwrap_or_else(|e| panic!("{name} {pairs:?}: {e}"))
}

#[test]
fn every_deformation_is_the_same_far_from_the_origin() {
    let mut wrong = Vec::new();
    for setting in SETTINGS {
        let (near, far) = (built(setting, Vec2::ZERO), built(setting, FAR));
        let back = inverse_over(far.map.clone(), FRAME + FAR);
        let [mut worst, mut returned] = [0.0f64; 2];
        for k in 0..400_u32 {
            // Multiples of 1/64 are exact far away, too.
            let at = |n: u32| f64::from((k * n) % 6400) / 64.0;
            let p = Point::new(at(997), at(2213));
            let (a, b) = (near.map.point(p), far.map.point(p + FAR));
            if a.is_finite() || b.is_finite() {
                worst = worst.max((b - FAR).distance(a)).max(if a.is_finite() && b.is_finite() { 0.0 } else { 1.0 });
            }
            // Where the map folds, the way there and back ends at some point with an equal image.
            let p = back.point(b);
            if p.is_finite() {
                returned = returned.max(far.map.point(p).distance(b));
            }
        }
        if worst.max(returned) > SAME * FRAME.width() {
            wrong.push(format!("{setting:?}: {worst:e}, back {returned:e}"));
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), SETTINGS.len(), wrong.join("\n"));
}

#[test]
fn every_deformation_is_looked_at_far_from_the_origin() {
    let missing: Vec<_> = Registry::builtin()
        .entries()
        .iter()
        .map(|e| e.info().name)
        .filter(|n| *n != "expr" && SETTINGS.iter().all(|s| s.0 != *n))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}
