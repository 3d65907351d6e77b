//! `cargo xtask browser FOLDER…`: compares Chromium's rendering of drawings with its rendering of pathwarp's results.
//!
//! Every drawing is warped by each [`Bend`]: a shift that the program does not recognise as one, so that no element takes a shortcut, with
//! strokes kept where possible and then with outlined strokes; and a curved map. Both have exact inverses, so the picture of a result can be
//! computed from the picture of the original. Comparing the two reveals anything that pathwarp reads differently from browsers, and anything
//! left unbent. With `--as`, Chromium's rendering is compared with what `render` draws, or with the PDF of `convert` as poppler draws it. A
//! drawing that Chromium cannot parse does not count.
//!
//! Not compared: the frame, the sharpness of bitmaps, and anything off the page.

use crate::chore::{Chore, ChoreError, at, path_option, program_option, workspace};
use crate::shell;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use measure::{Bend, Gap, Picture, ToPixels, compare};
use pathwarp_raster::{decode_png, encode_png};
use resvg::tiny_skia::{IntSize, Pixmap, PremultipliedColorU8};
use serde::Deserialize;
use std::collections::HashMap;
use std::fmt::Write as _;
use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{self, Child, ChildStdin, ChildStdout, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use tempfile::TempDir;

mod measure;
#[cfg(test)]
mod tests;

pub(crate) const CHORE: Chore = Chore { command, run };

/// The largest fraction of a page's pixels that may differ.
const MAX_OF_PAGE: f64 = 1e-3;
/// The larger side of the pictures in pixels, whatever the size of the drawing, unless that takes a scale of more than [`MAX_SCALE`].
const SIDE: f64 = 1200.0;
const MAX_SCALE: f64 = 64.0;
/// The largest page, in px, that is shown whole.
const MAX_PAGE: f64 = 8000.0;
/// Length of the shift, as a fraction of the page's width.
const SHIFT: f64 = 0.04;

/// A way to try a drawing: its name, and the value of `--strokes` if the drawing is warped. Otherwise the name is the format drawn.
type Way = (&'static str, Option<&'static str>);

const WAYS: [Way; 5] =
    [("shift", Some("auto")), ("outline", Some("outline")), ("curve", Some("auto")), ("png", None), ("pdf", None)];

fn command() -> Command {
    let names = |warps: bool| WAYS.into_iter().filter(move |w| w.1.is_some() == warps).map(|w| w.0).collect::<Vec<_>>();
    Command::new("browser")
        .about("Compare drawings with their results as Chromium shows both")
        .arg(Arg::new("inputs").required(true).num_args(1..).value_name("FOLDER").value_parser(value_parser!(PathBuf)))
        .arg(program_option())
        .arg(path_option("sheet", "FOLDER").help("Write a contact sheet of what differs: before, after, difference"))
        .arg(path_option("json", "FILE").help("Write what was found for every drawing"))
        .arg(
            Arg::new("only")
                .long("only")
                .action(ArgAction::Append)
                .value_parser(names(true))
                .help("Try this way only [default: all]"),
        )
        .arg(
            Arg::new("as")
                .long("as")
                .action(ArgAction::Append)
                .value_parser(names(false))
                .conflicts_with("only")
                .help("Compare the drawings as they are, as pictures of `render` or as PDF"),
        )
        .after_help("Needs node, and `npm ci` in crates/pathwarp-editor/web; for PDF, poppler's pdftocairo.")
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let program = shell::program(&workspace(), arguments)?;
    let inputs: Vec<PathBuf> = crate::chore::paths(arguments, "inputs");
    let asked = ["only", "as"].into_iter().flat_map(|name| arguments.get_many::<String>(name).unwrap_or_default());
    let asked: Vec<&String> = asked.collect();
    let wanted = |w: &Way| if asked.is_empty() { w.1.is_some() } else { asked.iter().any(|a| *a == w.0) };
    let ways: Vec<Way> = WAYS.into_iter().filter(wanted).collect();
    let sheet: Option<&PathBuf> = arguments.get_one("sheet");
    let judge = Judge::new(program, ways, sheet.cloned())?;
    let found = judge.try_all(&inputs)?;
    if let Some(file) = arguments.get_one::<PathBuf>("json") {
        let all: Vec<_> = found.iter().map(Finding::json).collect();
        fs::write(file, serde_json::Value::from(all).to_string()).map_err(at(file))?;
    }
    if let Some(folder) = sheet {
        judge.contact_sheet(folder, &found)?;
    }
    let report = report(&found);
    if found.iter().any(Finding::differs) { Err(report) } else { Ok(report) }
}

/// The outcome of trying a drawing in one way.
struct Finding {
    file: PathBuf,
    way: Way,
    /// The exit code of the program; `None` if it was killed.
    code: Option<i32>,
    /// The program's first message.
    note: String,
    /// The difference of the pictures, or the reason why they could not be compared. `None` if Chromium cannot parse the drawing.
    gap: Option<Result<Gap, String>>,
    /// The file name of a picture of the difference.
    picture: Option<String>,
}

impl Finding {
    fn differs(&self) -> bool {
        self.gap.as_ref().is_some_and(|gap| gap.as_ref().map_or(true, |gap| gap.differs(MAX_OF_PAGE)))
    }

    fn line(&self) -> String {
        let share = match &self.gap {
            Some(Ok(gap)) => format!("{:.2} %", 100.0 * gap.of_page),
            Some(Err(why)) => why.clone(),
            None => "not XML".into(),
        };
        let code = self.code.map_or_else(|| "killed".to_owned(), |c| format!("exit {c}"));
        format!("{share}\t{}\t{}\t{code}\t{}", self.way.0, self.file.display(), self.note)
    }

    fn json(&self) -> serde_json::Value {
        let gap = self.gap.as_ref().and_then(|g| g.as_ref().ok());
        serde_json::json!({
            "file": self.file.display().to_string(), "way": self.way.0, "exit": self.code, "said": self.note,
            "counts": self.gap.is_some(), "differs": self.differs(), "share": gap.map(|g| g.of_page), "ofInk": gap.map(|g| g.of_ink),
            "problem": self.gap.as_ref().and_then(|g| g.as_ref().err()), "picture": self.picture,
        })
    }
}

fn report(found: &[Finding]) -> String {
    let mut out = String::new();
    for finding in found.iter().filter(|f| f.differs()) {
        let _ = writeln!(out, "{}", finding.line());
    }
    for way in WAYS {
        let all: Vec<&Finding> = found.iter().filter(|f| f.way == way && f.gap.is_some()).collect();
        if !all.is_empty() {
            let _ = writeln!(out, "{}: {} of {} differ", way.0, all.iter().filter(|f| f.differs()).count(), all.len());
        }
    }
    out.trim_end().to_owned()
}

/// Tries drawings.
struct Judge {
    program: PathBuf,
    ways: Vec<Way>,
    /// The folder for pictures of differences.
    sheet: Option<PathBuf>,
    browsers: Browsers,
    /// Copies of the drawings' folders, so that links work and nothing is written beside the originals.
    scratch: TempDir,
    copies: Mutex<HashMap<PathBuf, PathBuf>>,
    count: AtomicUsize,
}

impl Judge {
    fn new(program: PathBuf, ways: Vec<Way>, sheet: Option<PathBuf>) -> Result<Self, ChoreError> {
        if let Some(folder) = &sheet {
            fs::create_dir_all(folder).map_err(at(folder))?;
        }
        let scratch = tempfile::tempdir().map_err(|e| e.to_string())?;
        let browsers = Browsers::default();
        Ok(Self { program, ways, sheet, browsers, scratch, copies: Mutex::default(), count: AtomicUsize::new(0) })
    }

    /// Tries all drawings among files and folders.
    fn try_all(&self, inputs: &[PathBuf]) -> Result<Vec<Finding>, ChoreError> {
        let mut drawings = Vec::new();
        for input in inputs {
            let is_svg = |f: &Path| shell::ends_in(f, &["svg"]);
            drawings.extend(if input.is_dir() { shell::files_below(input, is_svg)? } else { vec![input.clone()] });
        }
        if drawings.is_empty() {
            return Err("there is no drawing".into());
        }
        let found = shell::in_parallel(&drawings, |file| self.try_drawing(file));
        Ok(found.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
    }

    /// Returns the drawing in a copy of its folder. Folders `images` and `resources` beside that folder are copied too.
    fn copy_of(&self, file: &Path) -> Result<PathBuf, ChoreError> {
        let file = file.canonicalize().map_err(at(file))?;
        let (folder, name) = file.parent().zip(file.file_name()).ok_or("a drawing has a name and a folder")?;
        let mut copies = self.copies.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(copy) = copies.get(folder) {
            return Ok(copy.join(name));
        }
        let around = self.scratch.path().join(copies.len().to_string());
        let copy = around.join(folder.file_name().unwrap_or_default());
        shell::copy_folder(folder, &copy)?;
        for beside in ["images", "resources"] {
            if let Some(from) = folder.parent().map(|p| p.join(beside)).filter(|p| p.is_dir()) {
                shell::copy_folder(&from, &around.join(beside))?;
            }
        }
        copies.insert(folder.to_owned(), copy.clone());
        Ok(copy.join(name))
    }

    /// Tries a drawing in all ways.
    fn try_drawing(&self, original: &Path) -> Result<Vec<Finding>, ChoreError> {
        let file = self.copy_of(original)?;
        let finding =
            |way, gap| Finding { file: original.to_owned(), way, code: None, note: String::new(), gap, picture: None };
        let shown = self.browsers.show(&file, None).and_then(|size| {
            // A drawing without an extent gets a window in which Chromium may show something.
            let size_px = [size.right, size.bottom].map(|c| if c > 0.0 { c.ceil().min(MAX_PAGE) } else { 600.0 });
            let scale = (SIDE / size_px[0].max(size_px[1])).min(MAX_SCALE);
            Ok((size.broken, size_px, scale, self.browsers.show(&file, Some((size_px, scale)))?))
        });
        let (broken, size, scale, before) = match shown {
            Ok(shown) => shown,
            Err(why) => return Ok(self.ways.iter().map(|way| finding(*way, Some(Err(why.clone())))).collect()),
        };
        if broken {
            return Ok(self.ways.iter().map(|way| finding(*way, None)).collect());
        }
        let compared = |way: &Way| {
            let mut finding = finding(*way, None);
            finding.gap = Some(match way.1 {
                Some(_) => self.compare_warped(&file, (size, scale), &before, &mut finding),
                None => self.compare_drawn(&file, scale, &mut finding),
            });
            finding
        };
        Ok(self.ways.iter().map(compared).collect())
    }

    /// Warps a drawing and compares the pictures. The page has this size in px, and `scale` pixels per px.
    fn compare_warped(
        &self,
        file: &Path,
        (size, scale): ([f64; 2], f64),
        before: &Shown,
        finding: &mut Finding,
    ) -> Result<Gap, String> {
        let original = before.picture.as_ref().ok_or("there is no picture")?;
        // Without a matrix from user units, or with one that turns, the drawing can only stay where it is.
        let upright = before.matrix.filter(|[a, b, c, d, ..]| *a > 0.0 && *d > 0.0 && *b == 0.0 && *c == 0.0);
        let [a, _, _, d, e, f] = upright.unwrap_or([1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
        let to_pixels = ToPixels { scale: [a * scale, d * scale], offset: [e * scale, f * scale] };
        let shift = if upright.is_some() { (SHIFT * size[0] * scale).round() as usize } else { 0 };
        let bend = match finding.way {
            ("curve", _) if upright.is_some() => Bend::curve(original.width, original.height),
            _ => Bend::Shift(shift),
        };
        let result = self.new_file_beside(file, "svg");
        let [x, y] = bend.formulas(to_pixels);
        let strokes = finding.way.1.unwrap_or("auto");
        self.run(&["expr", "--x", &x, "--y", &y, "--strokes", strokes, "--fit", "none"], file, &result, finding)?;
        let after = self.browsers.show(&result, Some((size, scale)));
        let _ = fs::remove_file(&result);
        let after = after?;
        if after.broken {
            return Err("the result is not XML".into());
        }
        let picture = after.picture.ok_or("there is no picture")?;
        if (picture.width, picture.height) != (original.width, original.height) {
            return Err("its page has another size".into());
        }
        let page = [before.right, before.bottom].map(|c| if c > 0.0 { (c * scale) as usize } else { usize::MAX });
        self.compare_pictures([original, &picture], bend, page, finding)
    }

    /// Draws a drawing as it is, with `scale` pixels per px, and compares the picture with Chromium's in a window of its size.
    fn compare_drawn(&self, file: &Path, scale: f64, finding: &mut Finding) -> Result<Gap, String> {
        let png = self.new_file_beside(file, "png");
        if finding.way.0 == "png" {
            self.run(&["render", "--scale", &scale.to_string()], file, &png, finding)?;
        } else {
            let pdf = self.new_file_beside(file, "pdf");
            self.run(&["convert"], file, &pdf, finding)?;
            let dpi = (96.0 * scale).to_string();
            let mut poppler = process::Command::new("pdftocairo");
            poppler.args(["-png", "-transp", "-singlefile", "-r", &dpi]).arg(&pdf).arg(png.with_extension(""));
            let drawn = poppler.output().map_err(|e| format!("pdftocairo does not start: {e}"));
            let _ = fs::remove_file(&pdf);
            drawn?;
        }
        let read = fs::read(&png).map_err(|e| format!("there is no picture: {e}"));
        let _ = fs::remove_file(&png);
        let picture = Picture::new(&decode_png(&read?).map_err(|e| e.to_string())?);
        let window = [picture.width, picture.height].map(|side| (side as f64 / scale).round().max(1.0));
        let original = self.browsers.show(file, Some((window, scale)))?.picture.ok_or("there is no picture")?;
        let page = [picture.width.min(original.width), picture.height.min(original.height)];
        let picture = picture.on_page([original.width, original.height]);
        self.compare_pictures([&original, &picture], Bend::Shift(0), page, finding)
    }

    /// The path of a new file beside the drawing.
    fn new_file_beside(&self, file: &Path, extension: &str) -> PathBuf {
        file.with_file_name(format!(".result-{}.{extension}", self.count.fetch_add(1, Ordering::Relaxed)))
    }

    /// Runs the program on a drawing, and notes exit code and message in `finding`. `words` are the subcommand and its options.
    fn run(&self, words: &[&str], file: &Path, result: &Path, finding: &mut Finding) -> Result<(), String> {
        let mut command = process::Command::new(&self.program);
        command.arg(words[0]).arg(file).args(&words[1..]).arg("-o").arg(result);
        let out = command.output().map_err(at(&self.program))?;
        finding.code = out.status.code();
        let messages = String::from_utf8_lossy(&out.stderr).replace(&file.display().to_string(), "");
        finding.note = messages.lines().find(|l| !l.is_empty()).unwrap_or_default().chars().take(150).collect();
        if result.exists() { Ok(()) } else { Err("no result".into()) }
    }

    /// Compares the pictures of a result and of the original, and draws the difference for the contact sheet.
    fn compare_pictures(
        &self,
        [original, found]: [&Picture; 2],
        bend: Bend,
        page: [usize; 2],
        finding: &mut Finding,
    ) -> Result<Gap, String> {
        let (gap, marks) = compare(original, found, bend, page);
        if let Some(folder) = self.sheet.as_ref().filter(|_| gap.differs(MAX_OF_PAGE)) {
            let stem = finding.file.file_stem().unwrap_or_default().to_string_lossy();
            let number = self.count.fetch_add(1, Ordering::Relaxed);
            let name = format!("{stem}-{}-{number}.png", finding.way.0);
            let to = folder.join(&name);
            fs::write(&to, side_by_side(original, found, &marks)?).map_err(at(&to))?;
            finding.picture = Some(name);
        }
        Ok(gap)
    }

    /// Writes a page that shows everything that differs, and a picture of the page.
    fn contact_sheet(&self, folder: &Path, found: &[Finding]) -> Result<(), ChoreError> {
        let escaped = |text: &str| text.replace('&', "&amp;").replace('<', "&lt;");
        let mut page = "<!doctype html><meta charset=utf-8><title>What differs</title><style>body{font:13px sans-serif;width:1180px}\
                        figure{margin:0 0 20px}img{width:1180px;border:1px solid #ccc}</style>\n"
            .to_owned();
        let differing: Vec<&Finding> = found.iter().filter(|f| f.differs()).collect();
        for finding in &differing {
            let image = finding.picture.as_ref().map(|p| format!("<img src='{}'>", escaped(p).replace('\'', "&#39;")));
            let _ = writeln!(page, "<figure>{}{}</figure>", escaped(&finding.line()), image.unwrap_or_default());
        }
        let (html, png) = (folder.join("index.html"), folder.join("sheet.png"));
        fs::write(&html, page).map_err(at(&html))?;
        let height = self.browsers.show(&html, None)?.bottom;
        // Browsers do not draw taller pictures.
        let shown = self.browsers.show(&html, Some(([1200.0, height.ceil().clamp(100.0, 16_000.0)], 1.0)))?;
        let picture = shown.picture.ok_or("there is no sheet")?;
        fs::write(&png, encode_png(&picture.pixmap()?).map_err(|e| e.to_string())?).map_err(at(&png))
    }
}

/// A PNG of both pictures on grey and of the pixels that differ, side by side at half their size.
fn side_by_side(before: &Picture, after: &Picture, marks: &[bool]) -> Result<Vec<u8>, ChoreError> {
    let (w, h) = (before.width.div_ceil(2), before.height.div_ceil(2));
    let mut out = Pixmap::new(3 * w as u32, h as u32).ok_or("there is no picture")?;
    for (i, pixel) in out.pixels_mut().iter_mut().enumerate() {
        let (column, x, y) = ((i / w) % 3, (i % w) * 2, (i / (3 * w)) * 2);
        let at = y * before.width + x;
        let on_grey = |data: &[u8]| {
            [0, 1, 2].map(|k| data[4 * at + k].saturating_add((3 * u16::from(255 - data[4 * at + 3]) / 4) as u8))
        };
        let near = [at, (at + 1).min(marks.len() - 1), (at + before.width).min(marks.len() - 1)];
        let [r, g, b] = match column {
            0 => on_grey(&before.data),
            1 => on_grey(&after.data),
            _ if near.iter().any(|i| marks[*i]) => [200, 0, 0],
            _ => [255; 3],
        };
        *pixel = PremultipliedColorU8::from_rgba(r, g, b, 255).unwrap_or(*pixel);
    }
    encode_png(&out).map_err(|e| e.to_string())
}

/// Chromium's answer about a drawing.
#[derive(Deserialize)]
struct Shown {
    /// `true` if the drawing is not well-formed XML.
    broken: bool,
    /// The page's right and lower edges in px.
    right: f64,
    bottom: f64,
    /// Maps user units to px.
    matrix: Option<[f64; 6]>,
    #[serde(default, rename = "png", deserialize_with = "decoded")]
    picture: Option<Picture>,
}

fn decoded<'a, D: serde::Deserializer<'a>>(d: D) -> Result<Option<Picture>, D::Error> {
    let bytes = STANDARD.decode(String::deserialize(d)?).map_err(serde::de::Error::custom)?;
    Ok(Some(Picture::new(&decode_png(&bytes).map_err(serde::de::Error::custom)?)))
}

impl Picture {
    fn pixmap(&self) -> Result<Pixmap, String> {
        let size = IntSize::from_wh(self.width as u32, self.height as u32).ok_or("an empty picture")?;
        Pixmap::from_vec(self.data.clone(), size).ok_or_else(|| "a picture of a wrong size".to_owned())
    }
}

/// Idle browsers. A new one is started if there is none.
#[derive(Default)]
struct Browsers(Mutex<Vec<Browser>>);

struct Browser {
    node: Child,
    requests: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Browsers {
    /// Shows a file on a page of this size in px, at this many pixels per px. Without a size, only asks for the size of the file.
    fn show(&self, file: &Path, size: Option<([f64; 2], f64)>) -> Result<Shown, String> {
        let free = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut browser = free.map_or_else(Browser::start, Ok)?;
        let mut request = serde_json::json!({ "file": file });
        if let Some((size, scale)) = size {
            request["size"] = size.map(|c| c as u32).to_vec().into();
            request["scale"] = scale.into();
        }
        let answer = browser.ask(&request.to_string()).map_err(|e| format!("Chromium: {e}"))?;
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(browser);
        let answer: serde_json::Value =
            serde_json::from_str(&answer).map_err(|e| format!("Chromium: {e}: {answer}"))?;
        if let Some(error) = answer.get("error") {
            return Err(error.to_string());
        }
        serde_json::from_value(answer).map_err(|e| e.to_string())
    }
}

impl Browser {
    fn start() -> Result<Self, String> {
        let script = workspace().join("crates/xtask/src/browser/pages.mjs");
        let mut command = process::Command::new("node");
        let started = command.arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut node = started.map_err(|e| format!("node does not start: {e}"))?;
        let pipes = node.stdin.take().zip(node.stdout.take());
        let (requests, answers) = pipes.ok_or("node has no pipes")?;
        Ok(Self { node, requests, answers: BufReader::new(answers) })
    }

    fn ask(&mut self, request: &str) -> std::io::Result<String> {
        writeln!(self.requests, "{request}")?;
        let mut answer = String::new();
        self.answers.read_line(&mut answer)?;
        Ok(answer)
    }
}

impl Drop for Browser {
    /// Ends node, and Chromium with it.
    fn drop(&mut self) {
        let _ = self.node.kill();
        let _ = self.node.wait();
    }
}
