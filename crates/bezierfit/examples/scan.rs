use bezierfit::{Options, simplify};
use kurbo::{BezPath, ParamCurve, PathEl, Point, Shape};
fn main() {
    let mut seed = 1u64;
    let mut rnd = move || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((seed >> 11) as f64) / (1u64 << 53) as f64
    };
    let mut normal = move || {
        let (a, b) = (rnd(), rnd());
        (-2.0 * (1.0 - a).ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    };
    let poly = |p: &[Point], closed: bool| {
        let mut b = BezPath::new();
        b.move_to(p[0]);
        for q in &p[1..] {
            b.line_to(*q)
        }
        if closed {
            b.close_path()
        }
        b
    };
    let mut cases: Vec<(String, BezPath, f64)> = Vec::new();
    for n in [2000, 5000, 20000, 50000, 200000] {
        for s in [0.08, 0.15] {
            let p: Vec<Point> = (0..n)
                .map(|i| {
                    let f = std::f64::consts::TAU * i as f64 / n as f64;
                    let r = 80.0 + 12.0 * (3.0 * f).cos();
                    Point::new(r * f.cos() + s * normal(), r * f.sin() + s * normal())
                })
                .collect();
            cases.push((format!("noise {n} {s}"), poly(&p, true), 1.0));
        }
    }
    for r in [20.0, 40.0, 80.0, 120.0, 160.0] {
        // pixel outline
        let inside = |x: i32, y: i32| {
            let (x, y) = (x as f64 + 0.5, y as f64 + 0.5);
            x * x + y * y <= r * r
        };
        let (mut x, mut y) = ((0..).take_while(|x| inside(*x, 0)).last().unwrap() + 1, 0i32);
        let (mut dx, mut dy) = (0i32, 1i32);
        let start = (x, y);
        let mut p = vec![];
        loop {
            p.push(Point::new(x as f64, y as f64));
            // left-hand interior: moving direction d, interior on the left
            let next = [(dy, -dx), (dx, dy), (-dy, dx)]; // right, straight, left
            for (ex, ey) in next {
                // pixel on left of edge from (x,y) in direction e
                let l = match (ex, ey) {
                    (0, 1) => (x - 1, y),
                    (1, 0) => (x, y),
                    (0, -1) => (x, y - 1),
                    _ => (x - 1, y - 1),
                };
                let rr = match (ex, ey) {
                    (0, 1) => (x, y),
                    (1, 0) => (x, y - 1),
                    (0, -1) => (x - 1, y - 1),
                    _ => (x - 1, y),
                };
                if inside(l.0, l.1) && !inside(rr.0, rr.1) {
                    dx = ex;
                    dy = ey;
                    break;
                }
            }
            x += dx;
            y += dy;
            if (x, y) == start {
                break;
            }
        }
        cases.push((format!("pixels r={r}"), poly(&p, true), 1.0));
    }
    for (name, k, s) in [
        ("square", 4, 15.0),
        ("square", 4, 6.0),
        ("hexagon", 6, 23.0),
        ("hexagon", 6, 10.0),
        ("12", 12, 46.0),
        ("12", 12, 20.0),
    ] {
        let r = s / (2.0 * (std::f64::consts::PI / k as f64).sin());
        let p: Vec<Point> = (0..k)
            .map(|i| {
                let f = 0.1 + std::f64::consts::TAU * i as f64 / k as f64;
                Point::new(r * f.cos(), r * f.sin())
            })
            .collect();
        cases.push((format!("{name} s={s}"), poly(&p, true), 1.0));
    }
    let p: Vec<Point> = (0..150).map(|i| Point::new(i as f64, if i % 2 == 0 { 0.1 } else { -0.1 })).collect();
    cases.push(("zigzag".into(), poly(&p, false), 1.5));
    let p: Vec<Point> = (0..120).map(|i| Point::new((i / 2) as f64, ((i + 1) / 2) as f64)).collect();
    cases.push(("stairs".into(), poly(&p, false), 1.0));
    if std::env::args().len() > 1 {
        cases.clear();
    }
    for a in std::env::args().skip(1) {
        let (f, t) = a.split_once('@').unwrap();
        let d = std::fs::read_to_string(f).unwrap();
        for d in d.split(" d=\"").skip(1) {
            let d = d.split('"').next().unwrap();
            cases.push((f.rsplit('/').next().unwrap().into(), BezPath::from_svg(d).unwrap(), t.parse().unwrap()));
        }
    }
    let mut svg = String::from("<svg xmlns='http://www.w3.org/2000/svg' viewBox='-110 -110 220 220'>");
    for (name, path, tol) in &cases {
        let t = std::time::Instant::now();
        match simplify(path, &Options::new(*tol)) {
            Ok(f) => {
                // true distance of source vertices to result
                let segs: Vec<_> = f.path.segments().collect();
                let mut off = 0.0f64;
                let src: Vec<_> = path.segments().collect();
                let step = (src.len() / 3000).max(1);
                use kurbo::ParamCurveNearest;
                for s in src.iter().step_by(step) {
                    for k in 0..3 {
                        let p = s.eval(k as f64 / 3.0);
                        let d =
                            segs.iter().map(|s| s.nearest(p, 1e-6).distance_sq).fold(f64::INFINITY, f64::min).sqrt();
                        off = off.max(d);
                    }
                }
                println!(
                    "{name:20} {:6} -> {:4}  error {:.3} true {:.3} of {tol}  {:?}",
                    src.len(),
                    segs.len(),
                    f.report.max_error,
                    off,
                    t.elapsed()
                );
                if name.contains(&std::env::var("SHOW").unwrap_or("zzz".into())) {
                    println!("{}", f.path.to_svg());
                }
                let mut d = String::new();
                for s in &segs {
                    let (a, b) = (s.start(), s.end());
                    let c = s.to_cubic();
                    let z = std::env::var("DOT").map_or(1.0, |v| v.parse().unwrap());
                    if matches!(s, kurbo::PathSeg::Cubic(_)) {
                        d += &format!(
                            "<path d='M{},{}L{},{}M{},{}L{},{}' stroke='#07c' stroke-width='{}'/>",
                            a.x,
                            a.y,
                            c.p1.x,
                            c.p1.y,
                            b.x,
                            b.y,
                            c.p2.x,
                            c.p2.y,
                            z * 0.3
                        );
                    }
                    d += &format!(
                        "<rect x='{}' y='{}' width='{}' height='{}' fill='#07c' stroke='none'/>",
                        a.x - z,
                        a.y - z,
                        2.0 * z,
                        2.0 * z
                    );
                }
                let b = path.bounding_box().inflate(5.0, 5.0);
                let one = format!(
                    "<svg xmlns='http://www.w3.org/2000/svg' viewBox='{} {} {} {}' width='1400' height='{}' fill='none'><path d='{}' stroke='#c00' stroke-opacity='.5' stroke-width='{}'/><path d='{}' stroke='#000' stroke-width='{}' fill='#0001'/>{d}</svg>",
                    b.x0,
                    b.y0,
                    b.width(),
                    b.height(),
                    1400.0 * b.height() / b.width(),
                    path.to_svg(),
                    0.002 * b.width(),
                    f.path.to_svg(),
                    0.001 * b.width()
                );
                svg += &one;
                PathEl::ClosePath.is_finite();
                let _ = f.path.area();
            }
            Err(e) => println!("{name} {e}"),
        }
    }
    if let Ok(f) = std::env::var("OUT") {
        std::fs::write(f, format!("<body style='margin:0'>{}", svg.split_once('>').unwrap().1)).unwrap();
    }
}
