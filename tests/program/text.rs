//! `pathwarp text`: its output, alone and as the input of deformations.

use crate::support::{expect_code, pathwarp_in, root, words};
use pathwarp::Outline;
use pathwarp::kurbo::{Point, Rect};
use pathwarp_svg::{Document, ReadOptions};
use std::fs;
use std::path::Path;

/// Runs a pipeline of commands from the project's root. Returns the output of the last one and all messages.
#[track_caller]
fn pipeline(stages: &[Vec<String>]) -> (Vec<u8>, String) {
    let (mut drawing, mut said) = (Vec::new(), String::new());
    for stage in stages {
        let args: Vec<&str> = stage.iter().map(String::as_str).collect();
        let out = pathwarp_in(&root(), &args, &drawing);
        said += &String::from_utf8(out.stderr).unwrap();
        assert_eq!(out.status.code(), Some(0), "{args:?}: {said}");
        drawing = out.stdout;
    }
    (drawing, said)
}

/// Splits `a | b | c` into commands of words as a shell does, without the program's name.
fn stages(line: &str) -> Vec<Vec<String>> {
    words(line).split(|w| w == "|").map(<[String]>::to_vec).collect()
}

/// Runs a pipeline whose only message is that the page of a bent word follows the word.
#[track_caller]
fn quiet(stages: &[Vec<String>]) -> Vec<u8> {
    let (drawing, said) = pipeline(stages);
    assert!(said.lines().all(|l| l.starts_with("note: the page grew")), "{stages:?}: {said}");
    drawing
}

#[track_caller]
fn run(line: &str) -> Vec<u8> {
    quiet(&stages(line))
}

#[track_caller]
fn svg(line: &str) -> String {
    String::from_utf8(run(line)).unwrap()
}

fn outline(drawing: &[u8]) -> Outline {
    let doc = Document::read(drawing, "out", &ReadOptions::default()).unwrap();
    Outline { subpaths: doc.shapes().iter().flat_map(|s| s.outline.subpaths.clone()).collect() }
}

fn bounds(drawing: &[u8]) -> Rect {
    outline(drawing).bounding_box().unwrap()
}

/// The numbers in every occurrence of an attribute.
fn numbers(svg: &str, attribute: &str) -> Vec<Vec<f64>> {
    let start = format!(" {attribute}=\"");
    let values = svg.split(&start).skip(1).map(|rest| rest.split('"').next().unwrap());
    values.map(|v| v.split(' ').map(|n| n.parse().unwrap()).collect()).collect()
}

#[track_caller]
fn near(a: &[f64], b: &[f64]) {
    assert!(a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6), "{a:?} is not {b:?}");
}

/// Noto Sans, 1000 units to the em: ascent 1069, descent 293, capitals 714, small letters 536 high; H 741 and i 258 wide.
#[test]
fn baselines_heights_and_letters_are_recorded_correctly() {
    let drawing = run("text 'Hi\nH' --size 100 --letter-spacing 10");
    let text = String::from_utf8(drawing.clone()).unwrap();
    for (attribute, value) in
        [("data-ascent", 106.9), ("data-descent", 29.3), ("data-cap-height", 71.4), ("data-x-height", 53.6)]
    {
        assert_eq!(numbers(&text, attribute), [[value]]);
    }
    let lines = numbers(&text, "data-baseline");
    near(&lines[0], &[0.0, 106.9, 109.9, 106.9]);
    near(&lines[1], &[0.0, 106.9 + 136.2, 74.1, 106.9 + 136.2]);
    let letters = numbers(&text, "data-glyph");
    near(&letters[0], &[0.0, 106.9, 74.1]);
    near(&letters[1], &[84.1, 106.9, 25.8]);
    near(&letters[2], &[0.0, 243.1, 74.1]);
    // The attributes agree with the drawing: the H stands on its baseline and has the cap height.
    let doc = Document::read(&drawing, "out", &ReadOptions::default()).unwrap();
    let h = doc.shapes()[0].outline.bounding_box().unwrap();
    near(&[h.y0, h.y1], &[106.9 - 71.4, 106.9]);
    // Its stems begin 98 units from the origin and end at an equal distance from the advance.
    assert!(h.x0 > 9.0 && h.x0 < 10.5 && (74.1 - h.x1 - h.x0).abs() < 0.5, "{h:?}");
    // The page holds the lines.
    near(&numbers(&text, "viewBox")[0], &[0.0, 0.0, 109.9, 2.0 * 136.2]);
    assert!(text.contains("<title>Hi H</title>") && text.contains("<g aria-label=\"Hi&#10;H\""), "{text}");
}

/// The ink of each line, by the path data of its letters.
fn ink_of_lines(drawing: &str) -> Vec<Rect> {
    let lines = drawing.split("<g data-baseline").skip(1);
    let of = |line: &str| {
        let data = line.split(" d=\"").skip(1).map(|d| d.split('"').next().unwrap());
        data.map(|d| Outline::from_svg(d).unwrap().bounding_box().unwrap()).reduce(|a, b| a.union(b)).unwrap()
    };
    lines.map(of).collect()
}

#[test]
fn words_fill_a_block() {
    let drawing = svg("text LOVE MUSIC --align fill --gap 6% --size 100");
    let ink = ink_of_lines(&drawing);
    near(&[ink[0].x0, ink[1].x0, ink[1].y0 - ink[0].y1], &[0.0, 0.0, 6.0]);
    near(&[ink[0].x1], &[ink[1].x1]);
    let plain = ink_of_lines(&svg("text LOVE MUSIC --size 100"));
    near(&[ink[1].width()], &[plain[1].width()]);
    near(&[ink[0].width() / ink[0].height()], &[plain[0].width() / plain[0].height()]);
    // The larger line has larger heights, by which it can be bent.
    let scale = ink[0].width() / plain[0].width();
    near(&numbers(&drawing, "data-cap-height").concat(), &[71.4, 71.4 * scale]);
    // Bent into a box, the block fills it edge to edge.
    let bent = run(
        "text LOVE MUSIC --align fill --gap 6% | envelope - --bottom 'M0,200 H300' --top 'M0,0 H300' --keep verticals",
    );
    let all = bounds(&bent);
    assert!((all.x0.abs() + all.y0.abs() + (all.x1 - 300.0).abs() + (all.y1 - 200.0).abs()) < 0.2, "{all:?}");
    expect_code(2, &["text", "A", "B", "--gap", "6%", "--line-height", "90%"]);
}

#[test]
fn text_is_read_from_arguments_files_and_standard_input() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("words.txt");
    fs::write(&file, "\u{feff}one & <two>\r\nthree\r\n").unwrap();
    let expected = run(r"text 'one & <two>\nthree'");
    assert_eq!(run("text 'one & <two>' three"), expected);
    assert_eq!(run(&format!("text --file '{}'", file.display())), expected);
    for args in [&["text", "-"][..], &["text", "--file", "-"]] {
        let out = pathwarp_in(dir.path(), args, &fs::read(&file).unwrap());
        assert_eq!((out.status.code(), &out.stdout), (Some(0), &expected), "{args:?}");
    }
    let out = dir.path().join("out.svg");
    expect_code(0, &["text", r"one & <two>\nthree", "--margin", "0", "-o", &out.display().to_string()]);
    assert_eq!(fs::read(out).unwrap(), expected);
}

#[test]
fn lengths_have_units() {
    // 3 units of 100 are 3 %; an inch is 96 px. (A size in inches makes a page in inches.)
    assert_eq!(run("text ab --size 100 --letter-spacing 3%"), run("text ab --size 100 --letter-spacing 3"));
    assert_eq!(run("text ab --letter-spacing 1in"), run("text ab --letter-spacing 96"));
    assert_eq!(run("text ab --size 96px"), run("text ab --size 96"));
    assert_eq!(run("text 'a\nb' --size 50 --line-height 120%"), run("text 'a\nb' --size 50 --line-height 60"));
}

#[test]
fn the_same_words_are_the_same_bytes() {
    let line = "text 'Grand Hotel\nשלום 日 q\u{302}' --align justify --quiet";
    let (first, second) =
        (pathwarp_in(&root(), &refs(&words(line)), b""), pathwarp_in(&root(), &refs(&words(line)), b""));
    assert_eq!(first.status.code(), Some(1));
    assert!(first.stderr.is_empty() && !first.stdout.is_empty());
    assert_eq!(first.stdout, second.stdout);
}

fn refs(words: &[String]) -> Vec<&str> {
    words.iter().map(String::as_str).collect()
}

/// On an arc of radius 300 the feet of letters touch the arc, and capitals rise above it by the cap height.
#[test]
fn text_into_bend() {
    const TOLERANCE: f64 = 0.01;
    let drawing = run(
        "text HI --size 100 | bend - --along 'M-100,350 A300,300 0 0 1 500,350' --tolerance 0.01 --baseline 0% --fit grow",
    );
    let centre = Point::new(200.0, 350.0);
    let radii = |o: &Outline| o.segs().map(|s| s.start().distance(centre)).collect::<Vec<f64>>();
    let radii = radii(&outline(&drawing));
    let (low, high) = radii.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), r| (l.min(*r), h.max(*r)));
    assert!((low - 300.0).abs() < TOLERANCE && (high - 371.4).abs() < TOLERANCE, "{low} to {high}");
}

/// An envelope with straight sides is an affine map: the ink fills the rectangle.
#[test]
fn text_into_envelope() {
    let drawing = run("text 'Hot Tea' | envelope - --bottom 'M10,150 H410' --top 'M10,50 H410' --fit grow");
    let b = bounds(&drawing);
    assert!((b.x0 - 10.0).abs() + (b.x1 - 410.0).abs() + (b.y0 - 50.0).abs() + (b.y1 - 150.0).abs() < 1e-6, "{b:?}");
}

/// Under an arch the vertical lines of a word in the bundled font stay vertical within 0.1°.
#[test]
fn vertical_lines_stay_vertical_under_an_arch() {
    /// The shortest vertical line, in the serifs of I, is 4.68 long, and the arch only lengthens lines.
    const LEAST: f64 = 4.0;
    let upright =
        |p: Point, q: Point| (q.y - p.y).abs() > LEAST && ((q.x - p.x) / (q.y - p.y)).atan().to_degrees().abs() < 0.1;
    let count = |drawing: &[u8]| outline(drawing).segs().filter(|s| upright(s.start(), s.end())).count();
    let word = "text HILTEN --size 90";
    let arched = run(&format!(
        "{word} | envelope - --bottom 'M20,180 H516' --top 'M20,110 Q268,-80 516,110' --keep verticals --fit grow"
    ));
    let before = count(&run(word));
    // H has six, I two and four in its serifs, L three, T four, E six, N four.
    assert_eq!(before, 29);
    assert_eq!(count(&arched), before);
    // Between slanted sides they do not, so the test can fail.
    let leaning = run(&format!("{word} | envelope - --bottom 'M20,180 H516' --top 'M90,60 H446' --fit grow"));
    assert!(count(&leaning) < before / 2);
}

/// A warp without bend changes nothing; with bend it moves outlines, and the words keep their names.
#[test]
fn text_into_warp() {
    let word = "text Regatta --size 80";
    let plain = run(word);
    let same = run(&format!("{word} | warp - --style flag --bend 0%"));
    let ends = |d: &[u8]| outline(d).segs().map(pathwarp::Seg::end).collect::<Vec<_>>();
    let (a, b) = (ends(&plain), ends(&same));
    assert!(a.len() == b.len() && a.iter().zip(&b).all(|(p, q)| p.distance(*q) < 1e-6));
    let bent = svg(&format!("{word} | warp - --style flag --bend 50% --fit grow"));
    assert!(bent.contains("<title>Regatta</title>") && bent.contains("aria-label=\"R\""));
    assert!(bounds(bent.as_bytes()).height() > 1.3 * bounds(&plain).height());
}

/// The page of a drawing, by its `viewBox`.
fn page(drawing: &str) -> Rect {
    let n = &numbers(drawing, "viewBox")[0];
    Rect::from_origin_size((n[0], n[1]), (n[2], n[3]))
}

/// A file for viewing has a margin of 6 % of the size; on paper, for machines and in pipes the page is as large as the text.
#[test]
fn drawings_have_a_margin() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out.svg").display().to_string();
    let file = |options: &str| {
        let line = format!("text LOVE MUSIC {options} -o {out}");
        let (_, said) = expect_code(0, &words(&line).iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(said, "");
        fs::read_to_string(&out).unwrap()
    };
    let bare = page(&svg("text LOVE MUSIC --size 100"));
    assert_eq!(bare, page(&file("--size 100 --margin 0")));
    assert_eq!(bare.inflate(6.0, 6.0), page(&file("--size 100")));
    assert_eq!(bare.inflate(3.0, 3.0), page(&file("--size 100 --margin 3")));
    assert_eq!(page(&svg("text LOVE MUSIC --size 100mm")), page(&file("--size 100mm").replace("mm", "")));
    // Blocks that fill have equal margins on all sides.
    let block = file("--size 100 --align fill --gap 4");
    near_rect(page(&block), bounds(block.as_bytes()).inflate(6.0, 6.0));
}

#[track_caller]
fn near_rect(a: Rect, b: Rect) {
    near(&[a.x0, a.y0, a.x1, a.y1], &[b.x0, b.y0, b.x1, b.y1]);
}

#[test]
fn characters_no_font_has_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out.svg").display().to_string();
    let (_, said) = expect_code(1, &["text", "a日本b", "-o", &out, "--no-system-fonts"]);
    assert!(said.contains("日 (U+65E5)") && said.contains("本 (U+672C)") && said.contains("--font"), "{said}");
    // They are drawn with the font's glyph for missing characters.
    assert_eq!(fs::read_to_string(&out).unwrap().matches("<path").count(), 4);
}

/// Fira Sans Extra Condensed Black, 1000 units to the em (tables OS/2 and hmtx): capitals 696 high, H 548 wide.
#[test]
fn the_display_face_has_the_letters_of_europe() {
    let drawing = svg("text 'HÉĲő Ωώλ ЖёґЂ Ử€' --font display --size 100 --no-system-fonts");
    near(&numbers(&drawing, "data-cap-height")[0], &[69.6]);
    near(&numbers(&drawing, "data-glyph")[0][2..], &[54.8]);
    assert_eq!(numbers(&drawing, "data-glyph").len(), 13);
}

#[test]
fn faults_are_named() {
    let variable = "crates/pathwarp-text/tests/fonts/variable.ttf";
    for (code, args, part) in [
        (2, &["text"][..], "WORDS"),
        (2, &["text", ""], "empty"),
        (2, &["text", "a", "--font", "No Such Family Anywhere"], "`No Such Family Anywhere`"),
        // One letter is misspelt; the bundled family is always available.
        (2, &["text", "a", "--font", "Notto Snas"], "similar families: Noto Sans"),
        (3, &["text", "a", "--font", "missing.ttf"], "missing.ttf"),
        (3, &["text", "a", "--font", "samples/logo.svg"], "not a readable font"),
        (3, &["text", "a", "--font", "crates/pathwarp-text/tests/fonts/cff.otf#3"], "counted from 0"),
        (2, &["text", "a", "--font", variable, "--variation", "slnt=5"], "wght (100 to 900)"),
        (2, &["text", "a", "--font", variable, "--variation", "wght=1000"], "100 to 900"),
        (2, &["text", "a", "--variation", "wght=600"], "not a variable font"),
        (2, &["text", "a", "--variation", "wght"], "wght=600"),
        (2, &["text", "a", "--features", "ligatures"], "four characters"),
        (2, &["text", "a", "--weight", "heavy"], "semibold"),
        (2, &["text", "a", "--weight", "bold"], "the bundled font has no weight near 700, only 400"),
        (2, &["text", "a", "--italic"], "the bundled font has no italic, only 400"),
        (2, &["text", "a", "--italic", "--font", variable], "has no italic"),
        (2, &["text", "a", "--font", "crates/pathwarp-text/tests/fonts/cff.otf", "--weight", "900"], "near 900"),
        (2, &["text", "a", "--size", "0"], "size"),
        (2, &["text", "a", "--size", "3 parsecs"], "parsecs"),
        (2, &["text", "a", "--fill", "url(#x)"], "colour"),
        (2, &["text", "a", "--script", "Wxyz"], "Wxyz"),
        (3, &["text", "--file", "samples/missing.txt"], "samples/missing.txt"),
    ] {
        let (out, said) = expect_code(code, args);
        assert!(out.is_empty() && said.contains(part), "{args:?}: {said}");
    }
    let out = pathwarp_in(Path::new("."), &["text", "-"], b"caf\xe9");
    assert_eq!(out.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&out.stderr).contains("UTF-8"));
}

/// Weights and axis positions change the letters.
#[test]
fn weights_and_axes_are_set() {
    let font = "--font crates/pathwarp-text/tests/fonts/variable.ttf";
    let at = |options: &str| svg(&format!("text HT {font} {options}"));
    assert_eq!(at("--weight semibold"), at("--variation wght=600"));
    assert_eq!(at("--weight regular"), at(""));
    // The advances of H and T at those positions, in thousandths of the em, from HarfBuzz.
    for (options, h, t) in [
        ("", 741.0, 556.0),
        ("--weight 600", 756.0, 569.0),
        ("--weight black", 766.0, 591.0),
        ("--variation wdth=62.5", 533.0, 381.0),
    ] {
        near(&numbers(&at(options), "data-baseline")[0][2..3], &[(h + t) * 0.072]);
    }
}

#[test]
fn every_command_of_the_guide_runs() {
    let page = fs::read_to_string(root().join("docs/lettering.md")).unwrap();
    let commands: Vec<&str> = page.lines().filter_map(|l| l.strip_prefix("pathwarp ")).collect();
    // Tables have separate tests.
    let commands: Vec<&str> = commands.into_iter().filter(|c| !c.contains("--data")).collect();
    assert!(commands.len() >= 7, "{commands:?}");
    for command in commands {
        let mut stages = stages(&command.replace("| pathwarp", "|"));
        let last = stages.last_mut().unwrap();
        assert_eq!(last.pop().as_deref(), Some("out.svg"), "{command}");
        last.push("-".to_owned());
        let (drawing, said) = pipeline(&stages);
        assert_eq!(said, "", "{command}");
        assert!(!outline(&drawing).subpaths.is_empty(), "{command}");
    }
}

#[test]
fn examples_in_help_run() {
    let (help, _) = expect_code(0, &["help", "text"]);
    let examples: Vec<&str> = help.lines().filter_map(|l| l.strip_prefix("  pathwarp text ")).collect();
    assert!(examples.len() >= 4, "{help}");
    // Skip the examples that name a font: it may not be installed.
    for example in examples.iter().filter(|e| !e.contains("--font")) {
        let mut stages = stages(&format!("text {}", example.replace("| pathwarp", "|")));
        let last = stages.last_mut().unwrap();
        let out = last.pop().unwrap();
        let (_, format) = out.rsplit_once('.').unwrap();
        last.extend(["-".to_owned(), "--format".to_owned(), format.to_owned()]);
        quiet(&stages);
    }
}
