//! `cargo xtask heavy FOLDER`: makes realistic heavy files, twenty of each kind, runs a command on each, and prints the table in
//! `docs/reliability.md`. It fails if any is refused. Each kind has a folder below `FOLDER`; other files found there are run too.

use crate::chore::{Chore, ChoreError, at, program_option, workspace};
use crate::hostile::measure;
use crate::shell;
use crate::speed::generated::Random;
use clap::{Arg, ArgMatches, Command, value_parser};
use pathwarp_raster::{Picture, PictureFormat, Pixmap};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

pub(crate) const CHORE: Chore = Chore { command, run };

/// Files of each kind.
const EACH: usize = 20;
const MEBIBYTE: f64 = 1_048_576.0;

/// A kind of drawing: its name, the command, and a function that makes the content of a page of 1000 × 1000 of the given weight, from 1 to
/// [`EACH`].
type Kind = (&'static str, &'static str, fn(usize, &mut Random) -> String);

const BEND: &str = "wave IN -o OUT.svg";
const DRAW: &str = "render IN -o OUT.png";
const DRAWINGS: [Kind; 9] = [
    ("posters", BEND, poster),
    ("plots", DRAW, plot),
    ("maps", BEND, map),
    ("CAD", BEND, cad),
    ("scores", BEND, score),
    ("emoji", BEND, emoji),
    ("blurred logos", DRAW, blurred),
    ("icon sheets", BEND, icons),
    ("diagrams", BEND, diagram),
];

fn command() -> Command {
    Command::new("heavy")
        .about("Make honest heavy files, run commands on them, and print their time and memory")
        .arg(Arg::new("folder").required(true).value_name("FOLDER").value_parser(value_parser!(PathBuf)))
        .arg(program_option())
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let program = shell::program(&workspace(), arguments)?;
    let folder: &PathBuf = arguments.get_one("folder").ok_or("name a folder")?;
    let scratch = tempfile::tempdir().map_err(|e| e.to_string())?;
    let mut table = "| kind | command | files | largest | refused | most time, of that promised | most memory, of that promised |\n\
                     |---|---|---|---|---|---|---|\n"
        .to_owned();
    let mut refused = Vec::new();
    let photographs = ("photographs", "swirl IN -o OUT.jpg");
    for (kind, line) in std::iter::once(photographs).chain(DRAWINGS.map(|(kind, line, _)| (kind, line))) {
        let files = folder.join(kind);
        std::fs::create_dir_all(&files).map_err(at(&files))?;
        make(kind, &files)?;
        let (mut count, mut largest, refused_before) = (0, 0.0_f64, refused.len());
        // For time and memory: the largest fraction of what is promised, and a text with both numbers.
        let mut most = [(0.0, String::new()), (0.0, String::new())];
        for file in shell::files_below(&files, |_| true)? {
            let used = measure(&program, line, &file, scratch.path())?;
            let size = std::fs::metadata(&file).map_err(at(&file))?.len() as f64;
            let (size, promised) = promise(&file, size)?;
            (count, largest) = (count + 1, largest.max(size));
            let measured = [(used.cpu, promised[0], "s"), (used.megabytes(), promised[1], "MB")];
            for (most, (used, promised, unit)) in most.iter_mut().zip(measured) {
                if used / promised > most.0 {
                    *most = (used / promised, format!("{used:.1} of {promised:.0} {unit}"));
                }
            }
            // 1 is a result in which something was left unchanged or missed the tolerance.
            if !matches!(used.code, Some(0 | 1)) {
                refused.push(format!("{}: {:?}", file.display(), used.code));
            }
        }
        let refused = refused.len() - refused_before;
        let unit = if kind == photographs.0 { "megapixels" } else { "MB" };
        let [(_, time), (_, memory)] = most;
        let _ =
            writeln!(table, "| {kind} | `{line}` | {count} | {largest:.1} {unit} | {refused} | {time} | {memory} |");
    }
    if refused.is_empty() { Ok(table) } else { Err(format!("{table}\nrefused: {}", refused.join("; "))) }
}

/// The size of a file in megabytes or megapixels, and the seconds and megabytes that `docs/security.md` (*Work*) promises for it.
fn promise(file: &Path, bytes: f64) -> Result<(f64, [f64; 2]), ChoreError> {
    if shell::ends_in(file, &["svg"]) {
        let begun = (bytes / MEBIBYTE).ceil();
        return Ok((bytes / 1e6, [5.0 * begun, 400.0 + 100.0 * begun]));
    }
    let content = std::fs::read(file).map_err(at(file))?;
    let (width, height) = pathwarp_raster::header_size(&content).map_err(at(file))?;
    let pixels = f64::from(width) * f64::from(height) / 1e6;
    // The decoded picture takes four bytes per pixel.
    Ok((pixels, [(pixels / 10.0).ceil(), 60.0 * (pixels / 10.0).ceil() + 4.0 * pixels]))
}

/// Makes the files of a kind that do not exist yet.
fn make(kind: &str, folder: &Path) -> Result<(), ChoreError> {
    for n in 1..=EACH {
        let drawing = DRAWINGS.iter().find(|(name, ..)| *name == kind);
        let file = folder.join(format!("{n:02}.{}", if drawing.is_some() { "svg" } else { "jpg" }));
        if file.exists() {
            continue;
        }
        let content = match drawing {
            Some((.., body)) => {
                let body = body(n, &mut Random(n as u64));
                format!("<svg xmlns='http://www.w3.org/2000/svg' width='1000' height='1000'>{body}</svg>").into_bytes()
            }
            None => photograph(n).map_err(at(&file))?,
        };
        std::fs::write(&file, content).map_err(at(&file))?;
    }
    Ok(())
}

/// A photograph of 5·n megapixels: soft light, sometimes with grain, in the ratio 3:2.
fn photograph(n: usize) -> Result<Vec<u8>, pathwarp_raster::Error> {
    let height = (f64::from(u32::try_from(n).unwrap_or(1)) * 5e6 / 1.5).sqrt() as u32;
    let (width, has_grain) = (height * 3 / 2, n % 4 == 3);
    let mut pixmap = Pixmap::new(width, height).ok_or(pathwarp_raster::Error::Renderer)?;
    let mut random = Random(n as u64);
    for (i, pixel) in pixmap.data_mut().chunks_exact_mut(4).enumerate() {
        let (x, y) = (i as u64 % u64::from(width), i as u64 / u64::from(width));
        let noise = if has_grain { (random.next() * 24.0) as u64 } else { 0 };
        let light = |a: u64, b: u64| ((a * x + b * y) * 200 / (10 * u64::from(width)) + noise).min(255) as u8;
        pixel.copy_from_slice(&[light(7, 2), light(4, 4), light(1, 8), 255]);
    }
    Picture::from(pixmap).write(PictureFormat::Jpeg { quality: 85 })
}

fn point(random: &mut Random) -> [f64; 2] {
    [0.0; 2].map(|_| (1000.0 * random.next()).round() + 1.0)
}

fn color(random: &mut Random) -> String {
    format!("#{:06x}", (random.next() * f64::from(1 << 24)) as u32)
}

/// `count` words of two to nine letters.
fn words(count: usize, random: &mut Random) -> String {
    let letter = |r: &mut Random| char::from(b'a' + (26.0 * r.next()) as u8);
    (0..count)
        .map(|_| (0..2 + (8.0 * random.next()) as usize).map(|_| letter(random)).collect::<String>() + " ")
        .collect()
}

/// Up to 27,000 characters.
fn poster(n: usize, random: &mut Random) -> String {
    let y = |i: usize| 4 + 3 * i;
    (0..16 * n).map(|i| format!("<text x='5' y='{}' font-size='3'>{}</text>", y(i), words(13, random))).collect()
}

/// Up to 100,000 words, as plotting libraries write them.
fn plot(n: usize, random: &mut Random) -> String {
    let style = "font-family:'DejaVu Sans';font-size:4px;text-anchor:middle;fill:#333333";
    let word = |_| {
        let ([x, y], text) = (point(random), words(1, random));
        let text = text.trim();
        format!(
            "<g id='text_{x}'><text style=\"{style}\" x='{x}' y='{y}' transform='rotate(-30 {x} {y})'>{text}</text></g>\n"
        )
    };
    (0..5_000 * n).map(word).collect()
}

/// Coasts of up to 60,000 points in total.
fn map(n: usize, random: &mut Random) -> String {
    let coast = |_| {
        let ([x, y], fill, mut r) = (point(random), color(random), 5.0 + 20.0 * random.next());
        let mut d = String::from("M");
        for k in 0..300 {
            r *= 0.97 + 0.06 * random.next();
            let (s, c) = (TAU * f64::from(k) / 300.0).sin_cos();
            let _ = write!(d, "{:.3} {:.3}L", x + r * c, y + r * s);
        }
        format!("<path fill='{fill}' stroke='#333' stroke-width='.2' d='{}Z'/>", d.trim_end_matches('L'))
    };
    (0..10 * n).map(coast).collect()
}

/// Lines, arcs, circles and dashes, with dimensions.
fn cad(n: usize, random: &mut Random) -> String {
    let part = |_| {
        let ([x, y], [u, v]) = (point(random), point(random));
        format!(
            "<path d='M{x} {y}L{u} {v}A60 50 0 0 1 {y} {x}' /><circle cx='{x}' cy='{v}' r='{:.1}'/>\
             <path stroke-dasharray='9 2 1 2' d='M{u} {y}H{x}'/><text x='{x}' y='{y}' font-size='6'>{x}</text>",
            1.0 + u / 40.0
        )
    };
    let parts: String = (0..100 * n).map(part).collect();
    format!("<g fill='none' stroke='#000' stroke-width='.35'>{parts}</g>")
}

/// Staves, and notes with reused heads and stems.
fn score(n: usize, random: &mut Random) -> String {
    let head = "<defs><path id='h' d='M-4 2C-4-2 4-4 4-1C4 3-4 4-4 2Z'/></defs>";
    let note = |i: usize| {
        let pitch = (8.0 * random.next()) as usize * 3;
        let (x, y) = (20 + 12 * (i % 80), 30 + 60 * ((i / 80) % 16) + pitch);
        format!("<use href='#h' x='{x}' y='{y}'/><path d='M{} {y}v-25' stroke='#000'/>", x + 4)
    };
    let staff = |i: usize| {
        format!("<path d='M10 {y}H990' stroke='#000' stroke-width='.5'/>", y = 20 + 60 * (i / 5) + 6 * (i % 5))
    };
    let (staves, notes) = ((0..80).map(staff).collect::<String>(), (0..200 * n).map(note).collect::<String>());
    format!("{head}{staves}{notes}")
}

/// Faces with gradients, clips and opacity.
fn emoji(n: usize, random: &mut Random) -> String {
    let face = |i: usize| {
        let ([x, y], a, b) = (point(random), color(random), color(random));
        format!(
            "<radialGradient id='g{i}'><stop stop-color='{a}'/><stop offset='1' stop-color='{b}'/></radialGradient>\
             <clipPath id='c{i}'><circle cx='{x}' cy='{y}' r='18'/></clipPath><g transform='translate({x} {y})'>\
             <circle r='20' fill='url(#g{i})'/><g opacity='.8'><circle cx='-7' cy='-5' r='3'/><circle cx='7' cy='-5' r='3'/></g>\
             <path d='M-10 6C-5 14 5 14 10 6' fill='none' stroke='#420' stroke-width='2'/></g>\
             <path clip-path='url(#c{i})' fill='#fff6' d='M{x} {y}h20v20h-20z'/>"
        )
    };
    (0..10 * n).map(face).collect()
}

/// Up to two dozen blurred blobs.
fn blurred(n: usize, random: &mut Random) -> String {
    let blur =
        "<filter id='b' x='-50%' y='-50%' width='200%' height='200%'><feGaussianBlur stdDeviation='30'/></filter>";
    let blob = |_| {
        let ([x, y], fill) = (point(random), color(random));
        format!("<circle cx='{x}' cy='{y}' r='{:.0}' fill='{fill}' filter='url(#b)'/>", 50.0 + 250.0 * random.next())
    };
    format!("{blur}{}", (0..4 + n).map(blob).collect::<String>())
}

/// Fifty symbols, used over and over.
fn icons(n: usize, random: &mut Random) -> String {
    let symbol = |i: usize| {
        let [a, b, c, d] = [0; 4].map(|_| (24.0 * random.next()).round());
        let path = format!("<path d='M2 2C{a} {b} {c} {d} 9 9S{d} {a} 20 20Z'/>");
        format!("<symbol id='s{i}' viewBox='0 0 24 24'>{path}<rect x='4' y='4' width='9' height='7' rx='2'/></symbol>")
    };
    let symbols: String = (0..50).map(symbol).collect();
    let shown = |i: usize| {
        format!("<use href='#s{}' x='{}' y='{}' width='12' height='12'/>", i % 50, 14 * (i % 70), 14 * (i / 70))
    };
    format!("{symbols}{}", (0..150 * n).map(shown).collect::<String>())
}

/// Boxes with words, and arrows.
fn diagram(n: usize, random: &mut Random) -> String {
    let arrow = "<marker id='a' markerWidth='6' markerHeight='6' refX='5' refY='3' orient='auto'><path d='M0 0L6 3L0 6Z'/></marker>";
    let shape = |_| {
        let ([x, y], [u, v], label) = (point(random), point(random), words(2, random));
        format!(
            "<rect x='{x}' y='{y}' width='60' height='24' rx='4' fill='#eef' stroke='#336'/>\
             <text x='{}' y='{}' font-size='8' text-anchor='middle'>{label}</text>\
             <path d='M{x} {y}C{u} {y} {x} {v} {u} {v}' fill='none' stroke='#336' marker-end='url(#a)'/>",
            x + 30.0,
            y + 15.0
        )
    };
    format!("{arrow}{}", (0..60 * n).map(shape).collect::<String>())
}
