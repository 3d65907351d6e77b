//! Honest heavy files are accepted, and the advice of a message helps.

use super::bounded::{Folder, svg};
use super::pictures::{chunk, png};
use crate::support::{pathwarp, pathwarp_program, sample};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write as _;
use std::process::{Command, Output};

/// Runs the program without a limit on seconds, which depend on the machine.
fn run(folder: &Folder, args: &[&str]) -> Output {
    Command::new(pathwarp_program())
        .args(args)
        .args(["--limit", "seconds=none"])
        .current_dir(folder.path())
        .output()
        .unwrap()
}

#[track_caller]
fn taken(folder: &Folder, args: &[&str]) {
    let done = run(folder, args);
    assert_eq!(done.status.code(), Some(0), "{args:?}: {}", String::from_utf8_lossy(&done.stderr));
}

/// The photograph's file has a tenth of a megabyte. The result is small, since warping all of it takes a development build half a minute.
#[test]
fn a_photograph_of_a_hundred_megapixels() {
    const SIDE: usize = 10_000;
    let mut zlib = ZlibEncoder::new(Vec::new(), Compression::fast());
    (0..SIDE).for_each(|_| zlib.write_all(&[0; SIDE + 1]).unwrap());
    let photograph = png(10_000, 10_000, &[chunk(b"IDAT", &zlib.finish().unwrap())]);
    assert!(photograph.len() < 1 << 20);
    let folder = Folder::with(&[("p.png", &photograph)]);
    taken(&folder, &["swirl", "p.png", "-o", "o.jpg", "--size", "1000"]);
}

/// A fifth of a plot with a hundred thousand words, in a fifth of the bytes: letters were once limited to half as many for each megabyte.
#[test]
fn a_plot_of_very_many_words() {
    let word = |i: usize| format!("<text x='{}' y='{}' font-size='.2'>word{}</text>", i % 97, i % 89, 10 + i % 89);
    let folder = Folder::with(&[("a.svg", &svg(&(0..20_000).map(word).collect::<String>()))]);
    taken(&folder, &["render", "a.svg", "-o", "o.png"]);
}

#[test]
fn a_logo_of_two_dozen_blurred_blobs() {
    let blur = "<filter id='b' x='-.5' y='-.5' width='2' height='2'><feGaussianBlur stdDeviation='4'/></filter>";
    let blob = |i: usize| {
        format!("<circle cx='{}' cy='{}' r='{}' fill='#f0{i:02}' filter='url(#b)'/>", i * 37 % 100, i * 53 % 100, 5 + i)
    };
    let folder = Folder::with(&[("a.svg", &svg(&format!("{blur}{}", (0..24).map(blob).collect::<String>())))]);
    taken(&folder, &["render", "a.svg", "-o", "o.png", "--width", "1400"]);
    taken(&folder, &["convert", "a.svg", "-o", "o.pdf"]);
}

#[test]
fn thirty_thousand_letters() {
    let folder =
        Folder::with(&[("a.svg", &svg(&format!("<text font-size='.01' y='9'>{}</text>", "letters ".repeat(3750))))]);
    taken(&folder, &["wave", "a.svg", "-o", "o.svg"]);
}

#[test]
fn the_advice_of_a_message_helps() {
    let folder = Folder::with(&[("a.svg", &std::fs::read(sample("logo.svg")).unwrap())]);
    let wave = ["wave", "a.svg", "-o", "o.svg"];
    for limit in ["elements=3", "bytes=99"] {
        let done = run(&folder, &[&wave[..], &["--limit", limit]].concat());
        let said = String::from_utf8(done.stderr).unwrap();
        let (_, advised) = said.split_once("--limit ").unwrap_or_else(|| panic!("{limit}: {said}"));
        taken(&folder, &[&wave[..], &["--limit", advised.trim()]].concat());
    }
    let done = run(&folder, &[&wave[..], &["--limit", "work=99"]].concat());
    let said = String::from_utf8(done.stderr).unwrap();
    assert!(said.contains("--limit work=990, ten times as much"), "{said}");
}

#[test]
fn old_names_of_limits_lead_to_the_new_ones() {
    let file = sample("logo.svg");
    for old in ["comparisons", "segments", "letters", "painting", "evaluations", "image-bytes"] {
        let done = pathwarp(&["render", file.to_str().unwrap(), "-o", "-", "--limit", &format!("{old}=5e6")]);
        let said = String::from_utf8(done.stderr).unwrap();
        let new = if old == "image-bytes" { "--limit bytes=" } else { "--limit work=" };
        assert!(done.status.code() == Some(2) && said.contains(new), "{old}: {said}");
    }
}
