//! The page of the result under `--fit auto`, the default: it grows to hold artwork that leaves it, or stays; and the messages about it.

use super::common::text;
use crate::support::pathwarp_in;
use pathwarp::Outline;
use pathwarp::kurbo::{Point, Rect};
use pathwarp_raster::decode_png;
use serde_json::Value;
use std::fs;
use std::path::Path;

const ROOT: &str = "<svg xmlns='http://www.w3.org/2000/svg'";

/// Returns the result of a command that reads a drawing: exit code, file, messages.
#[track_caller]
fn run(line: &str, svg: &str) -> (Option<i32>, String, String) {
    run_in(tempfile::tempdir().unwrap().path(), line, svg)
}

fn run_in(folder: &Path, line: &str, svg: &str) -> (Option<i32>, String, String) {
    let args: Vec<&str> = line.split(' ').collect();
    let out = pathwarp_in(folder, &args, svg.as_bytes());
    (out.status.code(), text(&out.stdout), text(&out.stderr))
}

/// The value of an attribute of the root.
fn root_attr(svg: &str, name: &str) -> Option<String> {
    let (_, root) = svg[..svg.find('>')?].split_once("<svg")?;
    let (_, value) = root.split_once(&format!(" {name}="))?;
    let quote = value.chars().next()?;
    Some(value[1..].split(quote).next()?.to_owned())
}

/// Returns the viewBox, width and height of the result of moving a drawing, and the messages.
#[track_caller]
fn moved(root: &str, body: &str, line: &str) -> (String, String) {
    let (code, svg, said) = run(line, &format!("{ROOT} {root}>{body}</svg>"));
    assert_eq!(code, Some(0), "{said}");
    let all = ["viewBox", "width", "height"].map(|name| root_attr(&svg, name).unwrap_or_default());
    (all.join("|").trim_end_matches('|').to_owned(), said)
}

const BOX: &str = "<path d='M20 30H220V210H20Z'/>";

#[test]
fn it_grows_outwards_to_whole_units_with_its_margin_at_the_same_scale() {
    let down = "affine --move-y 63.4";
    let (page, said) = moved("viewBox='0 0 240 240'", BOX, down);
    // 20 units of margin below 273.4.
    assert_eq!(page, "0 0 240 294");
    assert_eq!(said, "note: the page grew from 240 × 240 to 240 × 294; --fit none keeps it\n");
    for (root, line, grown) in [
        ("viewBox='0 0 240 240' width='120mm' height='120mm'", down, "0 0 240 294|120mm|147mm"),
        ("width='240' height='240'", "affine --move-x 63.4", "0 0 304 240|304|240"),
        ("viewBox='0 0 240 240' width='100%' height='100%'", down, "0 0 240 294|100%|100%"),
        ("viewBox='0 0 240 240' width='480'", down, "0 0 240 294|480"),
        ("viewBox='-10.5 -8.25 240.5 240.25'", "affine --move-x -40.2 --move-y -50.1", "-31 -31 261 263"),
        ("viewBox='0 0 240 240' width='480' height='240'", "affine --move-x -160", "-170 0 530 240|530|240"),
        // Equal to the old page after rounding.
        ("viewBox='0 0 240 240'", "affine --move-x 20.000000001", "0 0 240 240"),
        ("viewBox='0 0 240 240'", "affine --move-x 34", "0 0 274 240"),
        // A margin alone does not make a page grow.
        ("viewBox='0 0 240 240'", "affine --move-x 19", "0 0 240 240"),
    ] {
        let (page, said) = moved(root, BOX, line);
        assert_eq!(
            (page.as_str(), said.lines().count()),
            (grown, usize::from(grown.split('|').next() != Some("0 0 240 240"))),
            "{root} {line}: {said}"
        );
    }
    let (page, said) = moved("viewBox='0 0 240 240'", BOX, "affine --move-y 63.4 -q");
    assert_eq!((page.as_str(), said.as_str()), ("0 0 240 294", ""));
    for (fit, expected) in [("none", "0 0 240 240"), ("grow", "0 0 240 273.4"), ("page", "0 73.4 240 220")] {
        let (page, said) = moved("viewBox='0 0 240 240'", BOX, &format!("{down} --fit {fit}"));
        assert_eq!((page.as_str(), said.contains("grew")), (expected, false), "{fit}");
    }
}

#[test]
fn what_left_its_page_altogether_takes_it_along_with_its_margin() {
    let (page, said) = moved("viewBox='0 0 240 240' width='480' height='480'", BOX, "affine --move-x 300.5 --move-y 7");
    // 20 units on the left, where the box ends at 320.5 and 520.5.
    assert_eq!(page, "300 17 241 220|482|440");
    assert!(
        said.contains("nothing is left on the page, 240 × 240 at 0,0") && said.contains("241 × 220 at 300,17"),
        "{said}"
    );
    // A ring around the page leaves nothing on it, though its box does.
    let ring = "<path fill-rule='evenodd' d='M20 20H220V220H20ZM30 30H210V210H30Z'/>";
    let (page, said) = moved("viewBox='0 0 240 240'", ring, "affine --scale-x 2 --scale-y 2");
    assert_eq!(page, "-100 -100 440 440", "{said}");
}

/// The marks lie off the page of the original, whose margin does not count them.
#[test]
fn marks_for_the_viewer_leave_the_margin() {
    let line = "anamorph --eye-height 350 --distance 400 --onto plane:floor --sight-mark --fit page";
    let sides = |root| moved(root, BOX, line).0.split(' ').map(|n| n.parse().unwrap()).collect::<Vec<f64>>();
    let (tight, wide) = (sides("viewBox='20 30 200 180'"), sides("viewBox='10 20 220 200'"));
    let growth: Vec<f64> = tight.iter().zip(&wide).map(|(tight, wide)| (wide - tight).round()).collect();
    assert_eq!(growth, [-10.0, -10.0, 20.0, 20.0], "{tight:?} {wide:?}");
}

#[test]
fn icons_and_paper_keep_their_pages() {
    let body = |w: f64, h: f64| format!("<path d='M{0} {1}H{2}V{3}H{0}Z'/>", 0.1 * w, 0.1 * h, 0.9 * w, 0.9 * h);
    let line = "affine --move-x 20% --move-y 1%";
    for (root, w, h, stays) in [
        ("viewBox='0 0 24 24'", 24.0, 24.0, true),
        ("viewBox='0 -960 960 960' width='24' height='24'", 960.0, -960.0, true),
        ("width='64' height='64'", 64.0, 64.0, true),
        ("viewBox='0 0 65 65'", 65.0, 65.0, false),
        ("viewBox='0 0 24 48'", 24.0, 48.0, false),
        ("viewBox='0 0 24 24' width='1em' height='1em'", 24.0, 24.0, true),
        ("viewBox='0 0 24 24' width='65' height='65'", 24.0, 24.0, false),
        ("viewBox='0 0 50 50' width='50mm' height='50mm'", 50.0, 50.0, false),
        ("viewBox='0 0 16 16' width='16mm'", 16.0, 16.0, false),
        ("viewBox='0 0 64 64' width='1.5cm' height='1.5cm'", 64.0, 64.0, false),
        ("width='.5in' height='.5in'", 48.0, 48.0, false),
        ("viewBox='0 0 30 30' width='30pt' height='30pt'", 30.0, 30.0, false),
        // The numbers of a sheet of paper, but in px, and another size in cm.
        ("viewBox='0 0 210 297' width='10.5cm' height='20cm'", 210.0, 297.0, false),
        ("viewBox='0 0 210 297' width='210mm' height='297mm'", 210.0, 297.0, true),
        ("viewBox='0 0 1000 707' width='42cm' height='29.7cm'", 1000.0, 707.0, true),
        ("viewBox='0 0 100 100' width='8.5in' height='11in'", 100.0, 100.0, true),
        ("width='11in' height='8.5in'", 1056.0, 816.0, true),
        ("width='612pt' height='1008pt'", 816.0, 1344.0, true),
        ("width='794' height='1123'", 794.0, 1123.0, true),
        ("viewBox='0 0 595.28 841.89'", 595.28, 841.89, true),
        ("width='85mm' height='55mm'", 321.0, 207.0, true),
        ("width='3.5in' height='2in'", 336.0, 192.0, true),
        ("width='88mm' height='125mm'", 332.0, 472.0, true),
        ("width='210.9mm' height='297mm'", 797.0, 1122.0, true),
        ("width='212mm' height='297mm'", 801.0, 1122.0, false),
        ("width='210mm' height='210mm'", 793.0, 793.0, false),
    ] {
        let (page, said) = moved(root, &body(w, h), line);
        let is_kept = said.contains("the page stays, as it is") && said.lines().count() == 1;
        assert_eq!(is_kept, stays, "{root}: {said}");
        assert_eq!(said.contains("the page grew"), !stays, "{root}: {said}");
        assert_eq!(page.contains("viewBox") || root.contains(page.split('|').next().unwrap()), stays, "{root}: {page}");
    }
}

#[test]
fn batches_and_steps_that_refer_to_the_page_keep_it() {
    let dir = tempfile::tempdir().unwrap();
    let svg = format!("{ROOT} viewBox='0 0 240 240'>{BOX}</svg>");
    let write = |name: &str| fs::write(dir.path().join(name), &svg).unwrap();
    let page = |name: &str| root_attr(&fs::read_to_string(dir.path().join(name)).unwrap(), "viewBox").unwrap();
    ["a.svg", "b.svg"].into_iter().for_each(write);
    for (line, result) in [
        ("affine --move-y 63 --out-dir out a.svg b.svg", "out/b.svg"),
        ("affine --move-y 63 --out-dir one a.svg", "one/a.svg"),
        ("affine --move-y 63 --in-place b.svg", "b.svg"),
        ("affine --move-y 63 -o {stem}-c.svg a.svg b.svg", "a-c.svg"),
        ("affine --move-y 63 --frame viewbox a.svg -o d.svg", "d.svg"),
        ("affine --move-y 63 a.svg -o e.svg", "e.svg"),
        ("affine --move-y 63 a.svg -o f.svg --write-recipe r.toml", "f.svg"),
        ("run r.toml a.svg -o g.svg", "g.svg"),
        ("run r.toml a.svg b.svg --out-dir h", "h/a.svg"),
    ] {
        let (code, _, said) = run_in(dir.path(), line, "");
        assert_eq!((code, said.lines().count()), (Some(0), 1), "{line}: {said}");
        let grows = ["e.svg", "f.svg", "g.svg"].contains(&result);
        assert_eq!(page(result), if grows { "0 0 240 293" } else { "0 0 240 240" }, "{line}");
        assert_eq!(said.contains("the page grew"), grows, "{line}: {said}");
    }
    // There and back, the page is unchanged.
    let there = ["projective", "--target", "0%,20% 100%,0% 100%,120% 0%,100%", "--frame", "viewbox"];
    for way in [&["a.svg", "-o", "there.svg"][..], &["--inverse", "there.svg", "-o", "back.svg"]] {
        assert_eq!(pathwarp_in(dir.path(), &[&there[..], way].concat(), b"").status.code(), Some(0));
    }
    assert_eq!([page("there.svg"), page("back.svg")], ["0 0 240 240"; 2]);
    let boxed = |name: &str| {
        let svg = fs::read_to_string(dir.path().join(name)).unwrap();
        Outline::from_svg(svg.split('\'').find(|t| t.starts_with('M')).unwrap()).unwrap().bounding_box().unwrap()
    };
    let (a, b) = (boxed("a.svg"), boxed("back.svg"));
    assert!((a.x0 - b.x0).abs() + (a.y0 - b.y0).abs() + (a.x1 - b.x1).abs() + (a.y1 - b.y1).abs() < 0.05, "{b:?}");
    // The source is embedded unchanged.
    assert_eq!(run_in(dir.path(), "affine --move-y 63 --embed-recipe a.svg -o i.svg", "").0, Some(0));
    assert_eq!(run_in(dir.path(), "unwarp i.svg", "").1, svg);
}

/// Artwork off the page counts only where the warp moves it onto the page.
#[test]
fn what_was_outside_never_grows_the_page() {
    let off = "<path id='a' d='M260 20h30v30h-30z'/><path id='b' d='M20 300h30v30h-30z'/><image id='c' x='-90' y='20' width='40' height='40' \
               href='data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=='/>";
    let (page, said) = moved("viewBox='0 0 240 240'", &format!("{BOX}{off}"), "affine --move-x 5");
    assert_eq!((page.as_str(), said.as_str()), ("0 0 240 240", ""));
    // Growing to the right by 30 shows none of it. Artwork that does not move is shown by growing alone.
    let (page, said) = moved("viewBox='0 0 240 240'", &format!("{BOX}{off}"), "affine --move-x 30");
    assert_eq!((page.as_str(), said.lines().count()), ("0 0 270 240", 1), "{said}");
    let (page, said) = moved("viewBox='0 0 240 240'", &format!("{BOX}{off}"), "affine --move-x 100");
    assert_eq!(page, "0 0 340 240");
    assert!(said.contains("1 shape that lay off the page has moved onto it: c"), "{said}");
    let (page, said) = moved(
        "viewBox='0 0 240 240'",
        &format!("{}{off}", BOX.replace("<path", "<path id='x'")),
        "affine --move-x 100 --select #x --select #c",
    );
    assert_eq!(page, "0 0 340 240");
    assert!(said.contains("2 shapes that lay off the page have moved onto it: a, c"), "{said}");
    let onto = "<path id='a' d='M260 20h30v30h-30z'/>";
    let (page, said) =
        moved("viewBox='0 0 240 240'", &format!("<path d='M60 60H100V100Z'/>{onto}"), "affine --move-x -40");
    assert_eq!(page, "0 0 240 240");
    assert!(said.contains("1 shape that lay off the page has moved onto it: a") && said.lines().count() == 1, "{said}");
    // Half of the shape was off the page, and leaves it on the other side. The part that was visible is held.
    let half = "<path d='M-100 60H100V100H-100Z'/>";
    assert_eq!(moved("viewBox='0 0 240 240'", half, "affine --move-x 30").0, "0 0 240 240");
    assert_eq!(moved("viewBox='0 0 240 240'", half, "affine --move-x 150").0, "0 0 250 240");
    // The border of a drawing extends outside by half its width.
    let border =
        "<rect width='240' height='240' fill='none' stroke='red' stroke-width='8'/><path d='M60 60H100V100Z'/>";
    assert_eq!(moved("viewBox='0 0 240 240'", border, "affine --move-x 0.001").0, "0 0 240 240");
    assert_eq!(moved("viewBox='0 0 240 240'", border, "affine --move-x 3").0, "0 0 243 240");
    // Guides, invisible shapes, and shapes hidden by a clip path do not count.
    for hidden in [
        "<path d='M60 60H230V100Z' fill='none'/>",
        "<g opacity='0'><path d='M60 60H230V100Z'/></g>",
        "<clipPath id='c'><path d='M60 60H90V90H60Z'/></clipPath><path d='M60 60H230V100Z' clip-path='url(#c)'/>",
        "<path d='M60 60H230V100Z' visibility='hidden'/>",
    ] {
        let body = format!("<path d='M60 60H100V100Z'/>{hidden}");
        assert_eq!(moved("viewBox='0 0 240 240'", &body, "affine --move-x 50").0, "0 0 240 240", "{hidden}");
    }
    // A drawing without a page has none to grow.
    let (page, said) = moved("", BOX, "affine --move-x 500");
    assert_eq!((page.as_str(), said.as_str()), ("", ""));
}

#[test]
fn a_result_with_nothing_on_its_page_is_exit_1() {
    let dir = tempfile::tempdir().unwrap();
    let svg = format!("{ROOT} viewBox='0 0 240 240'>{BOX}</svg>");
    let away = "affine --move-x 900";
    let (code, _, said) = run(&format!("{away} --fit none"), &svg);
    assert!(code == Some(1) && said.contains("nothing is on the page"), "{code:?} {said}");
    let (code, _, said) = run(away, &svg.replace("240 240", "24 24").replace("20 30H220V210H20", "2 3H22V21H2"));
    assert!(code == Some(1) && said.contains("nothing is on the page"), "{code:?} {said}");
    assert_eq!(run(away, &svg).0, Some(0));
    assert_eq!(run(&format!("{away} --fit page"), &svg).0, Some(0));
    // Artwork that is not warped stays on the page.
    let two = svg.replace("<path", "<path id='x' d='M1 1H9V9Z'/><path id='y'");
    assert_eq!(run(&format!("{away} --fit none --select #y"), &two).0, Some(0));
    // A batch warns once.
    (0..5).for_each(|i| fs::write(dir.path().join(format!("{i}.svg")), &svg).unwrap());
    let (code, _, said) = run_in(dir.path(), "affine --move-x 900 -r . --out-dir out", "");
    assert_eq!((code, said.lines().count()), (Some(1), 2), "{said}");
    assert!(said.contains("nothing is on the page of 5 of 5 results, such as that of"), "{said}");
}

/// The reference is the box of the written path data.
#[test]
fn the_page_holds_random_artwork_and_no_more() {
    let mut seed = 7_u64;
    let mut random = |least: f64, most: f64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        least + (most - least) * ((seed >> 33) as f64 / f64::from(1_u32 << 31))
    };
    let dir = tempfile::tempdir().unwrap();
    let mut grown = 0;
    for i in 0..40 {
        let [w, h] = [random(90.0, 400.0), random(90.0, 400.0)].map(f64::round);
        let (x0, y0) = (random(-50.0, 50.0), random(-50.0, 50.0));
        let mut at = || format!("{:.3},{:.3}", x0 + random(0.0, w), y0 + random(0.0, h));
        let d = format!("M{} C{} {} {} L{}Z", at(), at(), at(), at(), at());
        let svg = format!("{ROOT} viewBox='{x0} {y0} {w} {h}'><path d='{d}'/></svg>");
        let line = [
            "warp --style flag --bend 60%",
            "swirl",
            "wave --height 30%",
            "bulge --amount 0.8",
            "affine --rotate 33",
            "polar",
            "affine --move-x 70% --move-y -40%",
            "warp --style arc --bend -70%",
        ][i % 8];
        let (code, out, said) = run_in(dir.path(), &format!("{line} --report r.json"), &svg);
        assert_eq!(code, Some(0), "{line}: {said}");
        let view: Vec<f64> = root_attr(&out, "viewBox").unwrap().split(' ').map(|v| v.parse().unwrap()).collect();
        let (old, page) =
            (Rect::new(x0, y0, x0 + w, y0 + h), Rect::new(view[0], view[1], view[0] + view[2], view[1] + view[3]));
        let ink = out
            .split(['\'', '"'])
            .filter(|t| t.starts_with('M'))
            .map(|d| Outline::from_svg(d).unwrap().bounding_box().unwrap());
        let ink = ink.reduce(|a, b| a.union(b)).unwrap();
        let near = 4e-4 * w.max(h);
        let own = Outline::from_svg(&d).unwrap().bounding_box().unwrap();
        let margin =
            [own.x0 - x0, own.y0 - y0, x0 + w - own.x1, y0 + h - own.y1].into_iter().fold(f64::INFINITY, f64::min);
        let grows = said.contains("the page grew");
        for (was, is, ink) in [
            (old.x0, page.x0, ink.x0),
            (old.y0, page.y0, ink.y0),
            (-old.x1, -page.x1, -ink.x1),
            (-old.y1, -page.y1, -ink.y1),
        ] {
            let least = if grows { margin.max(0.0) } else { 0.0 };
            assert!(is + least <= ink + near, "{line} {svg}: {page:?} does not hold {ink} with {least}");
            if (is - was).abs() > 1e-6 {
                let most = 1.0 + least + near;
                assert!(
                    (is - is.round()).abs() < 1e-5 && is < was && ink - is < most,
                    "{line} {svg}: {page:?} for {ink}"
                );
            }
        }
        grown += usize::from(said.contains("the page grew from"));
        let report: Value = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
        assert_eq!(report["inputs"][0]["page"].is_array(), said.contains("the page grew"), "{line}: {said}");
    }
    assert!(grown > 10, "{grown}");
}

/// The box of the written path data lies on the page with its margin, or else a warning names the remedy.
#[test]
fn results_are_scaled_back_into_their_pages() {
    let boxed = |svg: &str| {
        let data = svg.split(['\'', '"']).filter(|t| t.starts_with('M'));
        data.map(|d| Outline::from_svg(d).unwrap().bounding_box().unwrap()).reduce(|a, b| a.union(b)).unwrap()
    };
    for (page, w, h) in [
        ("viewBox='0 0 24 24'", 24.0_f64, 24.0_f64),
        ("viewBox='0 0 210 297' width='210mm' height='297mm'", 210.0, 297.0),
        ("viewBox='0 0 300 90' width='300' height='90'", 300.0, 90.0),
    ] {
        let [x0, y0, x1, y1] = [0.1 * w, 0.2 * h, 0.9 * w, 0.8 * h];
        let margin = (0.1 * w).min(0.2 * h);
        let body = format!(
            "<path d='M{x0} {y0}H{x1}V{y1}H{x0}Z'/><rect x='{x0}' y='{y0}' width='{}' height='{}'/>",
            0.1 * w,
            0.1 * h
        );
        for line in [
            "affine --move-x 70%",
            "affine --scale-x 3 --scale-y 3",
            "warp --style flag --bend 90%",
            "affine --move-y -400%",
        ] {
            let svg = format!("{ROOT} {page}>{body}</svg>");
            assert!(run(&format!("{line} --fit none"), &svg).2.contains("--fit shrink"));
            let (code, out, said) = run(&format!("{line} --fit shrink"), &svg);
            assert_eq!((code, said.lines().count()), (Some(0), 1), "{page} {line}: {said}");
            assert!(said.contains("moved back onto its page"), "{said}");
            let root = |svg: &str| ["viewBox", "width", "height"].map(|name| root_attr(svg, name));
            assert_eq!(root(&out), root(&svg), "{line}");
            let (ink, near) = (boxed(&out), 4e-4 * w.max(h));
            let room = Rect::new(0.0, 0.0, w, h).inflate(near - margin, near - margin);
            assert_eq!(room.union(ink), room, "{page} {line}: {ink}");
            // Everything keeps its position in the whole, at one scale.
            let whole = boxed(&run(&format!("{line} --fit none"), &svg).1);
            let by = ink.width() / whole.width();
            assert!((ink.height() - by * whole.height()).abs() < near && by < 1.0 + near, "{line}: {ink} of {whole}");
            let tight = (ink.width() - room.width()).abs().min((ink.height() - room.height()).abs());
            assert!(by > 1.0 - near || tight < 3.0 * near, "{line}: {ink} in {room}");
        }
        // Artwork that stays on its page is unchanged.
        let (_, out, said) = run("affine --move-x 1% --fit shrink", &format!("{ROOT} {page}>{body}</svg>"));
        assert_eq!((said.as_str(), boxed(&out).width() - 0.8 * w < 1e-6), ("", true));
    }
}

/// A page in per cent of the window, without a viewBox, cuts artwork on its left and above.
#[test]
fn a_page_of_the_window_grows_at_its_scale() {
    for (root, line, grown) in [
        ("width='100%' height='100%'", "affine --move-x -63.4", "-44 0 264 210|264|210"),
        ("width='100%'", "affine --move-y -63.4", "0 -34 220 244|220"),
        ("width='100%' height='300'", "affine --move-y -63.4", "0 -34 220 334|220|334"),
        // The window extends to the right.
        ("width='100%' height='100%'", "affine --move-x 20", "|100%|100%"),
    ] {
        let (page, said) = moved(root, BOX, line);
        assert_eq!((page.as_str(), said.contains("grew")), (grown, !grown.starts_with('|')), "{root} {line}: {said}");
    }
}

/// The lines that a preview draws over the result are moved back with it: the cage lies on the edge of a square that fills it.
#[test]
fn lines_of_a_preview_are_moved_back_with_the_result() {
    let folder = tempfile::tempdir().unwrap();
    let svg =
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path fill='blue' d='M10,10H90V90H10Z'/></svg>";
    let cage = "-100%,-50% 200%,-50% 200%,150% -100%,150%";
    let args = ["shaper", "-", "--shaper", cage, "--fit", "shrink", "--preview", "p.png", "-o", "o.svg"];
    assert_eq!(pathwarp_in(folder.path(), &args, svg.as_bytes()).status.code(), Some(0));
    let picture = decode_png(&fs::read(folder.path().join("p.png")).unwrap()).unwrap();
    let result = picture.width() / 2 + 4;
    let boxed = |is: fn([u8; 3]) -> bool| {
        let pixels = (0..picture.height()).flat_map(|y| (result..picture.width()).map(move |x| (x, y)));
        let found = pixels.filter(|&(x, y)| picture.pixel(x, y).is_some_and(|p| is([p.red(), p.green(), p.blue()])));
        let points = found.map(|(x, y)| Point::new(f64::from(x), f64::from(y)));
        points.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b)).unwrap()
    };
    let (square, lines) = (boxed(|[r, _, b]| b > 200 && r < 60), boxed(|[r, _, b]| r > 180 && b < 80));
    let near = square.inflate(12.0, 12.0);
    assert!(square.width() > 100.0 && lines.width() > 100.0 && near.union(lines) == near, "{lines} around {square}");
}

/// A sheet keeps millimetres in any units of the drawing, and the artwork lies in its middle.
#[test]
fn a_sheet_of_paper_holds_the_artwork_in_its_true_size() {
    // The box is 200 × 180 units around 120, 120; 3.7795… units are a millimetre without other scale.
    let px = 96.0 / 25.4;
    for (root, fit, sides, per_mm) in [
        ("viewBox='0 0 240 240'", "a4", [297.0, 210.0], px),
        ("viewBox='0 0 240 240' width='120mm' height='120mm'", "a3", [420.0, 297.0], 2.0),
        ("viewBox='0 0 240 240' width='480'", "letter", [279.4, 215.9], px / 2.0),
        ("width='100%' style='height:80mm'", "tabloid", [431.8, 279.4], px),
    ] {
        let (page, said) = moved(root, BOX, &format!("affine --move-y 0 --fit {fit}"));
        let parts: Vec<&str> = page.split('|').collect();
        let view: Vec<f64> = parts[0].split(' ').map(|v| v.parse().unwrap()).collect();
        let [w, h] = sides.map(|s| s * per_mm);
        let want = [120.0 - 0.5 * w, 120.0 - 0.5 * h, w, h];
        assert!(view.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-5 * w), "{root}: {page}, not {want:?}");
        assert_eq!(parts[1..], sides.map(|s| format!("{s}mm")), "{root}");
        assert_eq!(said, "", "{root}");
    }
    let (code, svg, said) = run(
        "affine --scale-x 4 --scale-y 10 --fit a4",
        &format!("{ROOT} viewBox='0 0 240 240' width='120mm' height='120mm'>{BOX}</svg>"),
    );
    // 400 mm × 900 mm, upright: 95 and 301.5 mm too much on each side, of which the second is more beside 297.
    assert_eq!(code, Some(0), "{said}");
    assert_eq!([root_attr(&svg, "width"), root_attr(&svg, "height")], ["210mm", "297mm"].map(|v| Some(v.to_owned())));
    assert!(said.contains("past the page by up to 603 units (102 %; left, top, right, bottom)"), "{said}");
    let (code, _, said) =
        run("affine --fit a4 --page-width 10cm", &format!("{ROOT} viewBox='0 0 240 240'>{BOX}</svg>"));
    assert!(code == Some(2) && said.contains("a sheet of paper has its own size"), "{said}");
}
