//! Commands that people type in their first hour: each gets an answer that tells them the right one.

use super::common::{SQUARE, text};
use crate::support::pathwarp_in;
use std::fs;
use std::path::Path;

/// A folder with `a.svg`, `my logo.svg` and a folder `art`.
fn folder() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("a.svg"), SQUARE).unwrap();
    fs::write(dir.path().join("my logo.svg"), SQUARE).unwrap();
    fs::create_dir(dir.path().join("art")).unwrap();
    fs::write(dir.path().join("art/cat.svg"), SQUARE).unwrap();
    dir
}

/// Asserts that each line, split at spaces, fails with this code and this message.
fn refused(folder: &Path, lines: &[(&str, i32, &str)]) {
    for (line, code, part) in lines {
        let out = pathwarp_in(folder, &line.split(' ').collect::<Vec<_>>(), b"");
        let said = text(&out.stderr);
        assert_eq!(out.status.code(), Some(*code), "{line}: {said}");
        assert!(said.contains(part), "{line}: {said}");
        assert!(out.stdout.is_empty(), "{line}: {}", text(&out.stdout));
    }
}

#[test]
fn words_of_other_programs_name_the_command() {
    let dir = folder();
    refused(
        dir.path(),
        &[
            ("flag a.svg", 2, "flag is a style of warp: pathwarp warp IN.svg --style flag"),
            ("arch a.svg", 2, "arch is a style of warp"),
            ("Fisheye a.svg", 2, "--style fisheye"),
            ("inflate a.svg", 2, "inflate is a style of warp"),
            ("button a.svg", 2, "button is a preset of wordart"),
            ("circle a.svg", 2, "bend IN.svg --along circle:r=60mm"),
            ("skew a.svg", 2, "affine IN.svg --skew-x"),
            ("rotate a.svg 30", 2, "affine IN.svg --rotate"),
            ("mirror a.svg", 2, "--scale-x -1"),
            ("twirl a.svg", 2, "swirl IN.svg"),
            ("liquify a.svg", 2, "mls IN.svg"),
            ("mug a.svg", 2, "anamorph IN.svg"),
            ("trace a.svg", 2, "Trace Bitmap"),
            ("png a.svg", 2, "render IN.svg -o OUT.png"),
            ("a.svg", 2, "a.svg is a drawing, not a command"),
            ("gone.svg", 2, "is a drawing, not a command"),
            ("art", 2, "is a folder"),
            ("affine a.svg --scale 2", 2, "use --scale-x or --scale-y"),
            ("affine a.svg --angle 20", 2, "use --rotate"),
            ("affine a.svg + flag", 2, "flag is a style of warp"),
            ("warp a.svg + affine --scale 2", 2, "use --scale-x or --scale-y"),
            ("warp a.svg --output b.svg", 2, "use --out"),
            ("affine a.svg --width 200", 2, "use --scale-x 1.5 (a factor"),
            ("warp a.svg -style flag", 2, "use --style"),
            ("warp a.svg -bend=40%", 2, "use --bend"),
            ("warp a.svg + affine -rotate 5", 2, "use --rotate"),
            // Not read as the options -r and -o.
            ("affine a.svg -rotate=5", 2, "use --rotate"),
            ("warp a.svg -b 40%", 2, "--help lists the options"),
            ("bend a.svg --along circle,60mm", 2, "write circle,ratio=1.2 or circle,width=80mm"),
            ("bend a.svg --along circle:60mm", 2, "write circle:r=60mm"),
            ("text A --on arc", 2, "write arc:r=60mm,from=180,to=360"),
            ("help zzzz", 2, "`pathwarp list` shows all"),
            ("solid twist b.stl", 2, "unrecognized subcommand"),
            ("polar a.svg --angle 90", 2, "use --sweep"),
            ("affine a.svg --slant 12", 2, "use --skew-x"),
            ("expr a.svg --formula x+y", 2, "use --x 'x + 4*sin(y/16)'"),
            ("text A --curve 40", 2, "use --on circle:r=60mm"),
            ("warp --input a.svg", 2, "files are named without an option"),
            ("warp a.svg --force", 2, "use --in-place"),
            ("warp a.svg --tolerence 1", 2, "use --tolerance"),
            ("perspective a.svg --scale 2", 2, "--help lists the options"),
            ("sphere a.svg", 2, "--onto sphere:"),
            ("dxf a.svg", 2, "convert IN.svg -o OUT.dxf"),
            ("kerf a.svg 2mm", 2, "offset IN.svg --by"),
            ("expand a.svg", 2, "outline IN.svg"),
            ("inkscape", 2, "install inkscape"),
        ],
    );
    let out = pathwarp_in(
        dir.path(),
        &["perspective", "a.svg", "--target", "0%,100% 100%,100% 75%,0% 25%,0%", "-o", "p.svg"],
        b"",
    );
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
    let out = pathwarp_in(
        dir.path(),
        &["projective", "a.svg", "--target", "0%,100% 100%,100% 75%,0% 25%,0%", "-o", "q.svg"],
        b"",
    );
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
    assert_eq!(fs::read(dir.path().join("p.svg")).unwrap(), fs::read(dir.path().join("q.svg")).unwrap());
    for (word, part) in [
        ("perspective", "projective"),
        ("flag", "--style flag"),
        ("skew", "affine IN.svg --skew-x"),
        ("liquify", "swirl IN.svg"),
        ("trace", "Path › Trace Bitmap"),
        ("rotate", "rotate: affine — "),
    ] {
        let out = pathwarp_in(dir.path(), &["help", word], b"");
        assert_eq!(out.status.code(), Some(0), "{word}: {}", text(&out.stderr));
        assert!(text(&out.stdout).contains(part), "{word}: {}", text(&out.stdout));
    }
}

#[test]
fn values_and_names_that_spaces_have_torn() {
    let dir = folder();
    refused(
        dir.path(),
        &[
            (
                "warp a.svg --bend -40 % -o o.svg",
                2,
                "there is no file %; a number and its unit are one word: --bend -40%",
            ),
            ("warp a.svg --bend=-40 % -o o.svg", 2, "--bend -40%"),
            ("affine a.svg --move-x 10 mm -o o.svg", 2, "--move-x 10mm"),
            (
                "projective a.svg --target 0%,100% 100%,100% 75%,0% 25%,0% -o o.svg",
                2,
                "--target '0%,100% 100%,100% 75%,0% 25%,0%'",
            ),
            (
                "bend a.svg --along M0,100 Q150,20 300,100 -o o.svg",
                2,
                "a value with spaces needs quotes: --along 'M0,100 Q150,20",
            ),
            (
                "warp a.svg out.svg",
                2,
                "out.svg: there is no such file; if the result is to be written there: -o out.svg",
            ),
            ("warp a.svg --style flag out.pdf", 2, "-o out.pdf"),
            ("warp a.svg art/cat.svg", 2, "to write to art/cat.svg: -o art/cat.svg"),
            ("warp my logo.svg -o o.svg", 2, "a name with spaces needs quotes: 'my logo.svg'"),
            ("warp gone.svg a.svg", 3, "gone.svg: there is no such file"),
            ("warp a.svg to b.svg", 2, "there is no file to; name the result with -o b.svg"),
            ("warp a.svg into", 2, "-o OUT.svg"),
            ("render a.svg out.png", 2, "-o out.png"),
            ("render my logo.svg", 2, "a name with spaces needs quotes: 'my logo.svg'"),
            ("paths my logo.svg", 2, "'my logo.svg'"),
            ("mls a.svg --pair 5,5 6,6 -o o.svg", 2, "a pair has a colon: --pair 5,5:6,6"),
        ],
    );
    let out = pathwarp_in(dir.path(), &["text", "A", "--size", "40", "mm", "--no-system-fonts"], b"");
    assert_eq!(out.status.code(), Some(0));
    assert!(text(&out.stderr).contains("--size 40mm"), "{}", text(&out.stderr));
    assert!(text(&out.stdout).matches("data-baseline").count() == 2, "the text is set");
    let out = pathwarp_in(dir.path(), &["text", "40", "mm", "--no-system-fonts"], b"");
    assert_eq!(text(&out.stderr), "");
}

#[test]
fn names_that_are_no_files_here() {
    let dir = folder();
    refused(
        dir.path(),
        &[
            (
                "warp https://example.org/logo.svg -o o.svg",
                3,
                "download the drawing first: curl -O 'https://example.org/logo.svg'",
            ),
            ("render http://example.org/a.svg -o o.png", 3, "curl -O"),
            ("warp file:///tmp/a.svg -o o.svg", 3, "write the path itself: /tmp/a.svg"),
            ("warp ~/a.svg -o o.svg", 3, "$HOME"),
            ("warp art\\cat.svg -o o.svg", 3, "write art/cat.svg"),
            ("warp C:\\Users\\me\\a.svg -o o.svg", 3, "/mnt/c/Users/me/a.svg"),
            ("warp A.svg -o o.svg", 3, "did you mean a.svg?"),
            ("warp art/cat.sgv -o o.svg", 3, "did you mean art/cat.svg?"),
            ("warp none/cat.svg -o o.svg", 3, "the folder none does not exist"),
            ("warp *.png -o o.svg", 3, "no file matches the pattern"),
            ("shaper a.svg --shaper https://example.org/c.svg -o o.svg", 3, "curl -O"),
            ("edit https://example.org/a.svg", 3, "curl -O"),
            ("edit A.svg", 3, "did you mean a.svg?"),
            ("run recipe.toml a.svg", 3, "recipe.toml: there is no such file"),
            ("run a.svg", 3, "a.svg is a drawing, not a recipe"),
            ("warp a.svg -o o-{name}.svg", 2, "{name} stands for nothing; {stem}"),
            ("warp a.svg --out-dir out/{file}", 2, "{file} stands for nothing"),
            ("warp a.svg -o o.svg --preview {}.png", 2, "{} stands for nothing"),
        ],
    );
    assert!(!dir.path().join("o-{name}.svg").exists());
}

#[test]
fn files_that_are_no_drawings_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let at = |n: usize, magic: &[u8]| [&vec![1; n][..], magic, &[0; 64]].concat();
    let kinds: Vec<(&str, Vec<u8>, &str, &str)> = vec![
        ("a.pdf", b"%PDF-1.7\n%\xe2\xe3".to_vec(), "a PDF", "SVG"),
        ("a.ai", b"%PDF-1.5\n".to_vec(), "an Illustrator document", "File › Export › SVG"),
        ("old.ai", b"%!PS-Adobe-3.0\n".to_vec(), "an Illustrator document", "SVG"),
        ("a.eps", b"%!PS-Adobe-3.0 EPSF-3.0\n".to_vec(), "PostScript (EPS)", "Inkscape"),
        ("b.eps", at(0, b"\xc5\xd0\xd3\xc6"), "an EPS with a preview", "SVG"),
        ("a.gif", at(0, b"GIF89a"), "a GIF picture", "save it as PNG"),
        ("a.bmp", at(0, b"BM"), "a BMP picture", "PNG"),
        ("a.tif", at(0, b"II*\0"), "a TIFF picture", "PNG"),
        ("b.tiff", at(0, b"MM\0*"), "a TIFF picture", "PNG"),
        ("a.psd", at(0, b"8BPS"), "a Photoshop document", "PNG"),
        ("a.heic", at(4, b"ftypheic"), "a HEIC photograph", "PNG"),
        ("a.ttf", at(0, b"\0\x01\0\0"), "a font", "pathwarp text 'Words' --font FILE"),
        ("a.otf", at(0, b"OTTO"), "a font", "--font FILE"),
        ("a.cdr", [&b"RIFF....CDRvrsn"[..], &[0; 64]].concat(), "a CorelDRAW document", "export it as SVG"),
        ("b.cdr", at(0, b"PK\x03\x04"), "a document of another program", "export it as SVG"),
        ("a.zip", at(0, b"PK\x03\x04"), "an archive (ZIP)", "unpack"),
        ("a.dxf", b"  0\r\nSECTION\r\n  2\r\nHEADER\r\n".to_vec(), "a DXF", "SVG"),
        ("a.dwg", at(0, b"AC1032"), "an AutoCAD drawing", "SVG"),
        ("a.html", b"<!DOCTYPE html>\n<html><body>".to_vec(), "a web page", "download"),
        ("a.txt", b"Hello world".to_vec(), "plain text", "pathwarp text --file FILE"),
        ("a.stl", b"solid cube\nfacet".to_vec(), "a 3D model", "pathwarp solid"),
        ("empty.svg", b"".to_vec(), "is empty", "SVG"),
    ];
    for (name, bytes, what, advice) in &kinds {
        // The content decides, whatever the name: as it is, without an extension, and as a drawing.
        let bare = name.split('.').next().unwrap().to_owned() + "-bare";
        let named_svg = format!("{bare}.svg");
        let by_name =
            ["a document of another program", "an Illustrator document"].contains(what) || name.ends_with("txt");
        let files = if by_name { vec![(*name).to_owned()] } else { vec![(*name).to_owned(), bare, named_svg] };
        for file in &files {
            fs::write(dir.path().join(file), bytes).unwrap();
            for args in [
                vec!["warp", file, "-o", "o.svg"],
                vec!["warp", file, "-o", "o.png"],
                vec!["render", file, "-o", "o.png"],
                vec!["paths", file],
                vec!["shaper", "--shaper", file, "-o", "o.svg"],
            ] {
                let out = pathwarp_in(dir.path(), &args, SQUARE.as_bytes());
                let said = text(&out.stderr);
                assert_eq!(out.status.code(), Some(3), "{args:?}: {said}");
                assert!(
                    said.contains(what) && said.contains(advice) && said.contains(file.as_str()),
                    "{args:?}: {said}"
                );
            }
        }
    }
    // Pictures are warped, but have no paths.
    fs::write(dir.path().join("s.svg"), SQUARE).unwrap();
    assert!(pathwarp_in(dir.path(), &["render", "s.svg", "-o", "p.png"], b"").status.success());
    let out = pathwarp_in(dir.path(), &["paths", "p.png"], b"");
    assert!(text(&out.stderr).contains("a PNG picture"), "{}", text(&out.stderr));
}

#[test]
fn errors_say_what_is_wrong_and_nothing_else_warns() {
    let dir = folder();
    refused(
        dir.path(),
        &[
            ("expr a.svg --x 1/0 -o o.svg", 4, "1/0 has no finite value"),
            ("expr a.svg --y 0/0 -o o.svg", 4, "0/0 has no finite value"),
            ("affine a.svg --scale-x 0 -o o.svg", 2, "leaves the artwork without width"),
            ("affine a.svg --scale-y 0% -o o.svg", 2, "leaves the artwork without height"),
            ("affine a.svg --matrix 1,2,2,4,0,0 -o o.svg", 2, "its determinant"),
            ("affine a.svg --skew-x 45 --skew-y 45 -o o.svg", 2, "without area, together with --skew-y"),
            ("affine a.svg --skew-x 90 -o o.svg", 2, "an angle between -90 and 90"),
            ("affine a.svg --skew-x 30 --skew-y 60 --rotate 20 -o o.svg", 2, "without area"),
            ("anamorph a.svg --distance 1mm --onto cylinder:radius=42mm -o o.svg", 2, "cylinder:radius=42mm"),
        ],
    );
    for line in ["expr a.svg --x 1/0 -o o.svg", "affine a.svg --scale-x 0 -o o.svg"] {
        let said = text(&pathwarp_in(dir.path(), &line.split(' ').collect::<Vec<_>>(), b"").stderr);
        assert!(!said.contains("horizon") && !said.contains("anchors"), "{said}");
    }
    let said = |args: &[&str], input: &str| {
        let out = pathwarp_in(dir.path(), args, input.as_bytes());
        assert!(out.status.code().is_some_and(|c| c < 2), "{args:?}: {}", text(&out.stderr));
        text(&out.stderr)
    };
    // Fonts matter only where text is bent.
    let words = SQUARE.replace("</svg>", "<text font-family='Nowhere' y='50'>A</text></svg>");
    assert!(said(&["swirl", "--no-system-fonts"], &words).contains("Nowhere"));
    assert!(!said(&["swirl", "--no-system-fonts", "--text", "skip"], &words).contains("Nowhere"));
    assert!(!said(&["swirl", "--no-system-fonts", "--select", "#s"], &words).contains("Nowhere"));
    // Curves in the wrong order.
    let upside = ["envelope", "--bottom", "M0,0 H100", "--top", "M0,80 Q50,120 100,80"];
    assert!(said(&upside, SQUARE).contains("the top curve lies below the bottom curve"), "{}", said(&upside, SQUARE));
    let right = ["envelope", "--top", "M0,0 H100", "--bottom", "M0,80 Q50,120 100,80"];
    assert!(!said(&right, SQUARE).contains("lies below"));
    // The page is empty, and not only exceeded.
    assert!(said(&["affine", "--move-x", "500"], SQUARE).contains("nothing is left on the page"));
    assert!(said(&["affine", "--move-x", "500", "--fit", "none"], SQUARE).contains("nothing is on the page"));
    assert!(said(&["affine", "--move-x", "50", "--fit", "none"], SQUARE).contains("extends past the page"));
    // A neighbouring weight is not used silently.
    let weight = said(&["text", "A", "--weight", "500", "--no-system-fonts"], "");
    assert!(weight.contains("--weight 500: the bundled font has no such weight; 400 is used"), "{weight}");
    assert_eq!(said(&["text", "A", "--weight", "regular", "--no-system-fonts"], ""), "");
    // Only a number that can be a percentage is read as one.
    assert!(!text(&pathwarp_in(dir.path(), &["warp", "--bend", "1.5"], SQUARE.as_bytes()).stderr).contains("per cent"));
    assert!(text(&pathwarp_in(dir.path(), &["warp", "--bend", "50"], SQUARE.as_bytes()).stderr).contains("write 50%"));
}

#[test]
fn a_batch_that_exits_1_names_the_cause() {
    let dir = folder();
    fs::write(dir.path().join("odd.svg"), SQUARE.replace("id='s' d='M0,0", "id='s' d='M-10,0")).unwrap();
    let args = ["expr", "a.svg", "odd.svg", "--x", "ln(x+5)", "--on-error", "skip", "--out-dir", "out"];
    let out = pathwarp_in(dir.path(), &args, b"");
    assert_eq!(out.status.code(), Some(1), "{}", text(&out.stderr));
    assert!(
        text(&out.stderr).contains("1 of 2 inputs were not warped in full, so the exit code is 1: odd.svg"),
        "{}",
        text(&out.stderr)
    );
    assert!(!text(&out.stderr).contains("horizon") && !text(&out.stderr).contains("anchors"), "{}", text(&out.stderr));
}

/// At 80 columns, a screen has room for the short help of every command.
#[test]
fn short_help_fits_a_screen() {
    let registry = pathwarp::deform::Registry::builtin();
    let whole = pathwarp_cli::command(&registry);
    let solid = whole.find_subcommand("solid").unwrap().get_subcommands();
    let solid = solid.map(|c| vec!["solid".to_owned(), c.get_name().to_owned()]);
    let all: Vec<Vec<String>> = whole.get_subcommands().map(|c| vec![c.get_name().to_owned()]).chain(solid).collect();
    assert!(all.len() > 40, "{}", all.len());
    for words in all.iter().map(|w| w.iter().map(String::as_str).collect::<Vec<_>>()) {
        let said = |help: &str| text(&pathwarp_in(Path::new("."), &[&words[..], &[help]].concat(), b"").stdout);
        let (short, name) = (said("-h"), words.join(" "));
        assert!((5..=40).contains(&short.lines().count()), "{name}: {} lines\n{short}", short.lines().count());
        assert!(short.lines().all(|l| l.chars().count() <= 80), "{name}:\n{short}");
        assert!(short.contains(&format!("pathwarp {name} --help")), "{short}");
        if registry.get(&name).is_some() {
            let long = said("--help");
            assert!(
                short.contains("[INPUT]") && short.contains("--out-dir") && !short.contains("--gradients"),
                "{short}"
            );
            assert!(long.contains("--gradients") && long.contains("Examples:"), "{long}");
        }
        let long = said("--help");
        assert!(long.lines().count() <= 130, "{name}: {} lines\n{long}", long.lines().count());
        // Commands are not broken, so that they can be copied.
        let is_wide = |l: &&str| l.chars().count() > 100 && !l.trim_start().starts_with("pathwarp ");
        assert_eq!(long.lines().find(is_wide), None, "{name}");
    }
}

/// Every common option appears once, in full, in `help options`, and the pages of deformations name that page.
#[test]
fn help_options_has_all_common_options() {
    let said = |words: &[&str]| text(&pathwarp_in(Path::new("."), words, b"").stdout);
    let (all, warp) = (said(&["help", "options"]), said(&["warp", "--help"]));
    let plain = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    for option in pathwarp_engine::options::OPTIONS {
        let name = format!("--{}", option.name);
        let heads = |l: &&str| {
            let words: Vec<&str> = l.split([' ', ',']).filter(|w| !w.is_empty()).take(2).collect();
            l.starts_with("  ") && !l.starts_with("        ") && words.contains(&name.as_str())
        };
        assert_eq!(all.lines().filter(heads).count(), 1, "{name}");
        assert!(plain(&all).contains(&plain(&option.help())), "{name}");
        assert!(warp.split([' ', '\n']).any(|w| w == name), "{name}");
    }
}

#[test]
fn completions_offer_the_values_of_choices() {
    for shell in ["bash", "zsh", "fish"] {
        let script = text(&pathwarp_in(Path::new("."), &["completions", shell], b"").stdout);
        for value in ["fisheye", "verticals", "repeat", "instantiate"] {
            assert!(script.contains(value), "{shell}: {value}");
        }
    }
}
