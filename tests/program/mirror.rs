//! Drawings for mirrors, seen from the eye by an independent ray tracer.

use crate::support::{expect_code, root};
use pathwarp::kurbo::Point;
use pathwarp_svg::{ReadOptions, usvg_tree};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use std::fs;

type Space = [f64; 3];

fn add(a: Space, b: Space, k: f64) -> Space {
    std::array::from_fn(|i| a[i] + b[i] * k)
}

fn dot(a: Space, b: Space) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// A drawing as pixels, in its coordinates.
struct Picture {
    pixels: Pixmap,
    origin: Point,
    scale: f64,
}

impl Picture {
    fn new(svg: &[u8], scale: f64) -> Self {
        let read = ReadOptions::default().with_system_fonts(false);
        let tree = usvg_tree::parse_tree(svg, "picture", &read).unwrap();
        let text = std::str::from_utf8(svg).unwrap();
        let view: Vec<f64> = text
            .split("viewBox=\"")
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap()
            .split(' ')
            .map(|v| v.parse().unwrap())
            .collect();
        let [w, h] = [view[2], view[3]].map(|v| (v * scale).ceil() as u32);
        let mut pixels = Pixmap::new(w, h).unwrap();
        pixels.fill(Color::WHITE);
        let by = (scale * view[2] / f64::from(tree.size().width())) as f32;
        resvg::render(&tree, Transform::from_scale(by, by), &mut pixels.as_mut());
        Self { pixels, origin: Point::new(view[0], view[1]), scale }
    }

    fn at(&self, p: Point) -> Option<[u8; 3]> {
        let q = (p - self.origin) * self.scale;
        let pixel = (q.x >= 0.0 && q.y >= 0.0).then(|| self.pixels.pixel(q.x as u32, q.y as u32))??;
        Some([pixel.red(), pixel.green(), pixel.blue()])
    }
}

/// The face, 40 mm wide, in a cylinder 60 mm thick: units of the drawing are quarters of a millimetre. In space, x is right, y up and z
/// towards the viewer, from the middle of the foot at 100,248.
#[test]
fn a_face_looks_right_in_its_mirror() {
    let dir = tempfile::tempdir().unwrap();
    let file = |name: &str| dir.path().join(name).to_str().unwrap().to_owned();
    let (out, mesh) = (file("out.svg"), file("out.obj"));
    let face = root().join("samples/mirror/face.svg");
    let words = [
        "anamorph",
        face.to_str().unwrap(),
        "--mirror",
        "cylinder:diameter=60mm",
        "--picture-width",
        "40mm",
        "--distance",
        "40cm",
        "--eye-height",
        "30cm",
        "--sight-mark",
        "--fit",
        "page",
        "--mesh",
        &mesh,
        "--no-system-fonts",
        "-o",
        &out,
    ];
    expect_code(0, &words.map(str::to_owned));
    let result = fs::read(&out).unwrap();
    let (drawn, source) = (Picture::new(&result, 2.0), Picture::new(&fs::read(&face).unwrap(), 4.0));
    let (eye, radius) = ([0.0, 1200.0, 1600.0], 120.0);
    // The picture is square to the line from the eye to the foot; the artwork is 168 units wide, its bottom at 248 under its middle.
    let forward = eye.map(|v: f64| -v / 2000.0);
    let (right, up): (Space, Space) = ([1.0, 0.0, 0.0], [0.0, 0.8, -0.6]);
    assert!(dot(forward, up).abs() < 1e-12);
    let shrunk = 160.0 / 168.0;
    let (mut same, mut all) = (0, 0);
    for i in 0..84 {
        for j in 0..120 {
            let p = Point::new(17.0 + 2.0 * f64::from(i), 9.0 + 2.0 * f64::from(j));
            let picture = add(add([0.0; 3], right, (p.x - 100.0) * shrunk), up, (248.0 - p.y) * shrunk);
            let d = add(picture, eye, -1.0);
            // The first intersection with x² + z² = r².
            let (a, b, c) = (
                d[0] * d[0] + d[2] * d[2],
                d[0] * eye[0] + d[2] * eye[2],
                eye[0] * eye[0] + eye[2] * eye[2] - radius * radius,
            );
            let hit = add(eye, d, (-b - (b * b - a * c).sqrt()) / a);
            let n = [hit[0] / radius, 0.0, hit[2] / radius];
            let r = add(d, n, -2.0 * dot(d, n));
            let table = add(hit, r, -hit[1] / r[1]);
            let (Some(seen), Some(want)) = (drawn.at(Point::new(100.0 + table[0], 248.0 + table[2])), source.at(p))
            else {
                continue;
            };
            all += 1;
            same += i32::from(seen.iter().zip(want).all(|(a, b)| a.abs_diff(b) < 40));
        }
    }
    // Edges are a pixel wide.
    assert!(all > 9000 && f64::from(same) > 0.95 * f64::from(all), "{same} of {all}");
    let text = String::from_utf8(result).unwrap();
    assert!(text.contains("eye 300 mm above the table, 400 mm from the mirror's middle"));
    the_mesh_shows_all(&fs::read_to_string(&mesh).unwrap(), radius);
}

/// Checks the table, the mirror and the image seen by the eye, besides the drawing itself. The size of a page in px is a number of single
/// precision, and so is its size in millimetres.
fn the_mesh_shows_all(obj: &str, radius: f64) {
    let mut name = "";
    let mut counts = [0; 4];
    for line in obj.lines() {
        if let Some(next) = line.strip_prefix("o ") {
            name = next;
            if name == "table" {
                counts[0] += 1;
            }
            counts[3] += i32::from(name == "mouth");
        }
        let Some(v) = line.strip_prefix("v ") else { continue };
        let v: Vec<f64> = v.split(' ').map(|t| t.parse().unwrap()).collect();
        match name {
            "table" => assert!(v[1] < 0.0 && v[1] > -1.0, "{v:?}"),
            "mirror" => {
                counts[1] += 1;
                assert!((v[0].hypot(v[2]) - radius).abs() < 1e-7 * radius && v[1] > -1e-9, "{v:?}");
            }
            "mouth" if counts[1] == 0 => assert!(v[1].abs() < 1e-9, "{v:?}"),
            // In the plane square to the line of sight.
            "mouth" => {
                counts[2] += 1;
                assert!((v[1] * 0.6 + v[2] * 0.8).abs() < 1e-7 * radius, "{v:?}");
            }
            _ => {}
        }
    }
    assert!(counts[0] == 1 && counts[1] > 20 && counts[2] > 10 && counts[3] == 2, "{counts:?}");
}

/// There and back: a photograph of a drawing for a mirror, and the image that the mirror would show.
#[test]
fn a_photograph_of_an_old_drawing_is_restored() {
    let dir = tempfile::tempdir().unwrap();
    let file = |name: &str| dir.path().join(name).to_str().unwrap().to_owned();
    let (there, back) = (file("there.svg"), file("back.svg"));
    let face = root().join("samples/mirror/face.svg");
    let common =
        ["--mirror", "cylinder:diameter=60mm", "--foot", "100,248", "--distance", "40cm", "--eye-height", "30cm"];
    let run = |input: &str, output: &str, more: &[&str]| {
        let words = [&["anamorph", input][..], &common, more, &["--no-system-fonts", "-o", output]].concat();
        expect_code(0, &words.iter().map(|w| (*w).to_owned()).collect::<Vec<_>>());
    };
    run(face.to_str().unwrap(), &there, &["--frame", "16,8,168,240"]);
    run(&there, &back, &["--inverse", "--frame", "16,8,168,240"]);
    let [a, b] = [fs::read(&face).unwrap(), fs::read(&back).unwrap()].map(|svg| Picture::new(&svg, 4.0));
    let (mut same, mut all) = (0, 0);
    for i in 0..84 {
        for j in 0..119 {
            let p = Point::new(17.0 + 2.0 * f64::from(i), 9.0 + 2.0 * f64::from(j));
            let (Some(a), Some(b)) = (a.at(p), b.at(p)) else { continue };
            all += 1;
            same += i32::from(a.iter().zip(b).all(|(a, b)| a.abs_diff(b) < 40));
        }
    }
    assert!(all > 9000 && f64::from(same) > 0.98 * f64::from(all), "{same} of {all}");
}

/// Artwork on the front of a cylinder, seen from beside: a wall of it hides another. Shapes, strokes and pictures are compared with rays.
#[test]
fn a_view_shows_what_the_camera_sees_first() {
    let dir = tempfile::tempdir().unwrap();
    let file = |name: &str| dir.path().join(name).to_str().unwrap().to_owned();
    let inside = r##"<rect x="20" y="20" width="200" height="200" fill="#fd8"/><g fill="#48c"><path d="M40,40h70v70h-70z"/><circle cx="165"
 cy="75" r="38" stroke="#222" stroke-width="6"/><circle cx="75" cy="165" r="38" fill="none" stroke="#a22" stroke-width="10"/></g><path
 d="M130,130h70v70h-70z" fill="#2a6"/><path d="M30,30L210,210" stroke="#808" stroke-width="9" stroke-dasharray="20 9" fill="none"/>"##;
    let svg = |view: &str, inside: &str| {
        format!(r#"<svg xmlns="http://www.w3.org/2000/svg" width="240" height="240" viewBox="{view}">{inside}</svg>"#)
    };
    fs::write(file("photo.svg"), svg("20 20 200 200", inside)).unwrap();
    expect_code(0, &["render", &file("photo.svg"), "-o", &file("photo.png"), "--width", "800"].map(str::to_owned));
    fs::write(file("shapes.svg"), svg("0 0 240 240", inside)).unwrap();
    let photo = r#"<image x="20" y="20" width="200" height="200" href="photo.png"/>"#;
    fs::write(file("pictures.svg"), svg("0 0 240 240", photo)).unwrap();
    let source = Picture::new(&fs::read(file("shapes.svg")).unwrap(), 4.0);
    // x right, y down, z away from the viewer. The cylinder touches the drawing in its middle.
    let (radius, distance, middle) = (160.0, 300.0, [120.0, 120.0, 0.0]);
    let (eye, axis) = (add(middle, [0.0, 0.0, -1.0], distance), add(middle, [0.0, 0.0, 1.0], radius));
    for (name, camera) in
        [("shapes", [900.0, -250.0, 200.0]), ("shapes", [-700.0, 400.0, 90.0]), ("pictures", [900.0, -250.0, 200.0])]
    {
        let [x, y, z] = camera;
        let view = format!("{x},{y},{}", -z);
        let (from, out) = (file(&format!("{name}.svg")), file("out.svg"));
        let words =
            ["anamorph", &from, "--distance", "300", "--onto", "cylinder:radius=160", "--view", &view, "-o", &out];
        expect_code(0, &words.map(str::to_owned));
        let drawn = Picture::new(&fs::read(&out).unwrap(), 2.0);
        let sight = add(middle, camera, -1.0);
        let reach = dot(sight, sight).sqrt();
        let forward = sight.map(|v| v / reach);
        let flat = forward[0].hypot(forward[2]);
        let right = [forward[2] / flat, 0.0, -forward[0] / flat];
        let down = std::array::from_fn(|i| {
            forward[(i + 1) % 3] * right[(i + 2) % 3] - forward[(i + 2) % 3] * right[(i + 1) % 3]
        });
        // The points of the artwork on a ray, the nearer one first.
        let seen = |v: Point| {
            let ray = add(add(sight, right, v.x - middle[0]), down, v.y - middle[1]);
            let start = add(camera, axis, -1.0);
            let (a, b, c) = (
                ray[0] * ray[0] + ray[2] * ray[2],
                ray[0] * start[0] + ray[2] * start[2],
                start[0] * start[0] + start[2] * start[2] - radius * radius,
            );
            let root = (b * b - a * c).sqrt();
            [-b - root, -b + root].into_iter().filter_map(move |k| {
                let q = add(camera, ray, k / a);
                let normal = [q[0] - axis[0], 0.0, q[2] - axis[2]];
                let p = add(eye, add(q, eye, -1.0), distance / (q[2] + distance));
                let on_artwork = p[..2].iter().all(|v| (20.0..220.0).contains(v));
                (on_artwork && dot(normal, add(q, eye, -1.0)) < 0.0).then(|| Point::new(p[0], p[1]))
            })
        };
        let (mut same, mut behind, mut all, mut folded) = (0, 0, 0, 0);
        for k in 0..300 * 300 {
            let v = drawn.origin + pathwarp::kurbo::Vec2::new(f64::from(k % 300), f64::from(k / 300)) * 1.37;
            let points: Vec<Point> = seen(v).collect();
            let (Some(first), Some(last), Some(color)) = (points.first(), points.last(), drawn.at(v)) else { continue };
            let has =
                |p: &Point| source.at(*p).is_some_and(|want| color.iter().zip(want).all(|(a, b)| a.abs_diff(b) < 40));
            all += 1;
            same += i32::from(has(first));
            folded += i32::from(points.len() == 2);
            behind += i32::from(points.len() == 2 && has(last));
        }
        // Edges are a pixel wide, and many on a narrow picture.
        assert!(
            all > 4000 && folded > 500 && f64::from(same) > 0.95 * f64::from(all),
            "{name} {view}: {same} of {all}, {folded}"
        );
        // The colours tell the two walls apart.
        assert!(f64::from(behind) < 0.7 * f64::from(folded), "{name}: {behind} of {folded}");
    }
}
