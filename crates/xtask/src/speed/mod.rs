//! `cargo xtask speed`: times the program as people run it, and prints a table for `docs/benchmarks.md`.
//!
//! The yardstick is `usvg IN OUT` on the input, which reads, resolves and writes a drawing without bending it. Both run alternately, as
//! whole processes. Unless a row says otherwise, it compares CPU times and gives the median of paired runs.

use crate::chore::{Chore, ChoreError, at, count_option, path_option, paths, program_option, workspace};
use crate::process::{Job, Usage, paired};
use crate::shell;
use clap::{Arg, ArgAction, ArgMatches, Command};
use cpu_time::ProcessTime;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

pub(crate) mod generated;

pub(crate) const CHORE: Chore = Chore { command, run };

fn command() -> Command {
    Command::new("speed")
        .about("Time whole runs against usvg, and print a table")
        .arg(
            path_option("drawings", "FOLDER")
                .action(ArgAction::Append)
                .required(true)
                .help("Drawings to warp; may be given several times"),
        )
        .arg(path_option("usvg", "FILE").default_value("usvg").help("The usvg program"))
        .arg(count_option("count", "200").help("Number of drawings, spread evenly over all"))
        .arg(count_option("rounds", "5").help("Paired runs; their median counts"))
        .arg(count_option("largest", "1000000").help("Segments of the largest generated drawing"))
        .arg(Arg::new("font").long("font").value_name("FAMILY").default_value("DejaVu Sans").help("An installed font"))
        .arg(
            Arg::new("only")
                .long("only")
                .value_name("PART")
                .action(ArgAction::Append)
                .value_parser(PARTS.map(|p| p.0))
                .help("Measure this part only; may be given several times"),
        )
        .arg(program_option())
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let number = |name: &str| arguments.get_one(name).copied().unwrap_or(1);
    let mut files = Vec::new();
    for folder in paths(arguments, "drawings") {
        files.extend(shell::files_below(&folder, |f| shell::ends_in(f, &["svg"]))?);
    }
    let count = number("count").clamp(1, files.len().max(1));
    let drawings = (0..count).filter_map(|i| files.get(i * files.len() / count).cloned()).collect();
    let usvg = arguments.get_one::<PathBuf>("usvg").cloned().unwrap_or_default();
    check(&usvg)?;
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let bench = Bench {
        program: shell::built(&workspace(), arguments, "dist")?,
        usvg,
        drawings,
        rounds: number("rounds").max(1),
        largest: number("largest"),
        font: arguments.get_one("font").cloned().unwrap_or_default(),
        folder: folder.path().to_owned(),
    };
    let only: Vec<&String> = arguments.get_many("only").unwrap_or_default().collect();
    let mut table = String::from("| what | measured |\n|---|---|\n");
    for (_, part) in PARTS.iter().filter(|(name, _)| only.is_empty() || only.iter().any(|o| o == name)) {
        part(&bench, &mut table)?;
    }
    Ok(table)
}

/// Fails if usvg does not run.
fn check(usvg: &Path) -> Result<(), ChoreError> {
    match Job::new(usvg, ["--version"]).run() {
        Ok(Some(_)) => Ok(()),
        _ => Err(format!(
            "{} does not run; install it with `cargo install usvg --version 0.49.0`, or name it with --usvg FILE",
            usvg.display()
        )),
    }
}

/// Everything needed to measure.
struct Bench {
    program: PathBuf,
    usvg: PathBuf,
    drawings: Vec<PathBuf>,
    rounds: usize,
    largest: usize,
    font: String,
    /// The folder for generated drawings and results.
    folder: PathBuf,
}

/// Measures something and adds rows to the table.
type Part = fn(&Bench, &mut String) -> Result<(), ChoreError>;

/// The parts of the table, by name.
const PARTS: [(&str, Part); 7] = [
    ("drawings", drawings),
    ("deformations", deformations),
    ("segments", segments),
    ("text", text),
    ("growth", growth),
    ("threads", threads),
    ("files", files),
];

/// The command that is measured by default, the first in the README.
const WARP: [&str; 5] = ["warp", "--style", "flag", "--bend", "40%"];
/// Every deformation that bends, with arguments from its help.
const DEFORMATIONS: [&[&str]; 20] = [
    &["shaper", "--shaper", "M0,120 Q60,90 120,120 L110,0 Q60,30 10,0 Z"],
    &["envelope", "--bottom", "M0,160 C120,100 260,220 400,150", "--height", "90"],
    &["warp", "--style", "flag", "--bend", "40%"],
    &["wordart", "--preset", "wave1"],
    &["bilinear"],
    &["birational", "--top", "0%,20% 30%,-60% 60%,90% 100%,0%", "--bottom", "0%,100% 35%,60% 60%,170% 100%,100%"],
    &["bend", "--along", "M20,170 C180,60 356,60 516,170", "--stretch", "scale"],
    &["bend", "--along", "0%,60% 25%,40% 50%,60% 75%,40% 100%,60%", "--spline", "3", "--stretch", "scale"],
    &["polar"],
    &["ffd", "--degree", "2x2", "--move", "1,1:0,-60%"],
    &["ffd", "--pin", "50%,50%:50%,20%", "--pin", "90%,50%:95%,70%", "--pin", "10%,50%:10%,50%"],
    &["triangle", "--move", "0,1,1:0,60%"],
    &["mls", "--pin", "0%,100%", "--pin", "100%,100%", "--pair", "50%,0%:65%,-10%"],
    &["projective", "--target", "0%,100% 100%,100% 75%,0% 25%,0%"],
    &["wave"],
    &["swirl"],
    &["bulge"],
    &["lens"],
    &["mobius"],
    &["expr", "--x", "x + w/40*sin(y/h*9)"],
];
/// Segments of the large generated drawings.
const LARGE: usize = 30_000;
/// Segments of the drawings for several threads.
const THREADED: usize = 100_000;
/// Segments per path in drawings of many paths.
const EACH: usize = 60;
/// Files in a batch.
const BATCH: usize = 3000;
/// Paragraphs on the page of text.
const PARAGRAPHS: usize = 85;
/// The memory of the program without input, in bytes. Only memory beyond this is compared with the size of the input.
const FIXED: f64 = 15e6;

impl Bench {
    fn warp(&self, file: &Path) -> Job {
        self.deform(&WARP, file)
    }

    fn deform(&self, words: &[&str], file: &Path) -> Job {
        let job = Job::new(&self.program, words.iter().copied());
        job.with(&[&file.to_string_lossy(), "-o", &self.folder.join("warped.svg").to_string_lossy()])
    }

    fn resolve(&self, file: &Path) -> Job {
        Job::new(&self.usvg, [file.to_owned(), self.folder.join("resolved.svg")])
    }

    fn generate(&self, name: &str, text: &str) -> Result<PathBuf, ChoreError> {
        let file = self.folder.join(name);
        fs::write(&file, text).map_err(at(&file))?;
        Ok(file)
    }

    /// The median ratio of the CPU times of two jobs, which must both succeed.
    fn cpu_ratio(&self, a: &Job, b: &Job) -> Result<String, ChoreError> {
        let (a, b) = paired(a, b, self.rounds)?.ok_or("a generated drawing was refused")?;
        Ok(ratio(a.cpu, b.cpu))
    }

    /// Compares two jobs on all drawings: the ratio of the sums of CPU times, and the median and the largest ratio.
    fn compare(&self, a: impl Fn(&Path) -> Job, b: impl Fn(&Path) -> Job) -> Result<String, ChoreError> {
        let mut timed = Vec::with_capacity(self.drawings.len());
        for file in &self.drawings {
            if let Some((a, b)) = paired(&a(file), &b(file), self.rounds)? {
                timed.push((a.cpu, b.cpu, file));
            }
        }
        timed.sort_by(|x, y| (x.0 / x.1).total_cmp(&(y.0 / y.1)));
        let (a, b) = timed.iter().fold((0.0, 0.0), |s, t| (s.0 + t.0, s.1 + t.1));
        let (Some(middle), Some(last)) = (timed.get(timed.len() / 2), timed.last()) else {
            return Err("neither program accepts any drawing".into());
        };
        let name = last.2.file_name().unwrap_or_default().to_string_lossy();
        Ok(format!(
            "sum {:.2}, median {:.2}, largest {:.2} ({name}: {:.0} ms)",
            a / b,
            middle.0 / middle.1,
            last.0 / last.1,
            last.0 * 1e3
        ))
    }
}

fn row(out: &mut String, what: &str, measured: &str) {
    let _ = writeln!(out, "| {what} | {measured} |");
}

/// The ratio of two times in seconds, and both of them in milliseconds.
fn ratio(a: f64, b: f64) -> String {
    format!("{:.2} ({:.0} and {:.0} ms)", a / b, a * 1e3, b * 1e3)
}

/// Peak memory beyond [`FIXED`], in multiples of the size of the input.
fn memory(usage: &Usage, file: &Path) -> Result<f64, ChoreError> {
    let size = fs::metadata(file).map_err(at(file))?.len();
    Ok((usage.peak as f64 - FIXED).max(0.0) / size as f64)
}

fn drawings(b: &Bench, out: &mut String) -> Result<(), ChoreError> {
    let n = b.drawings.len();
    let (usvg, default) = (|f: &Path| b.resolve(f), |f: &Path| b.warp(f));
    row(out, &format!("{n} drawings, default ÷ usvg"), &b.compare(default, usvg)?);
    for options in [["--nodes", "source"], ["--text", "skip"]] {
        let what = format!("{n} drawings, `{}` ÷ usvg", options.join(" "));
        row(out, &what, &b.compare(|f| b.warp(f).with(&options), usvg)?);
    }
    let unmerged = |f: &Path| b.warp(f).with(&["--nodes", "source"]);
    row(out, &format!("{n} drawings, default ÷ `--nodes source`"), &b.compare(default, unmerged)?);
    let certified = |f: &Path| b.warp(f).with(&["--certify"]);
    row(out, &format!("{n} drawings, `--certify` ÷ default"), &b.compare(certified, default)?);
    Ok(())
}

fn deformations(b: &Bench, out: &mut String) -> Result<(), ChoreError> {
    let n = b.drawings.len();
    for words in DEFORMATIONS {
        let what = format!("{n} drawings, `{}` ÷ usvg", words.join(" "));
        row(out, &what, &b.compare(|f| b.deform(words, f), |f| b.resolve(f))?);
    }
    Ok(())
}

fn segments(b: &Bench, out: &mut String) -> Result<(), ChoreError> {
    let n = LARGE.min(b.largest);
    for (kind, each) in [("in one path", n), ("in paths of 60", EACH)] {
        let file = b.generate("segments.svg", &generated::flowers(n, each))?;
        let (default, usvg) = (b.warp(&file), b.resolve(&file));
        let what = format!("{n} smooth segments {kind}");
        row(out, &format!("{what}, default ÷ usvg"), &b.cpu_ratio(&default, &usvg)?);
        let unmerged = default.with(&["--nodes", "source"]);
        row(out, &format!("{what}, `--nodes source` ÷ usvg"), &b.cpu_ratio(&unmerged, &usvg)?);
        row(out, &format!("{what}, default ÷ `--nodes source`"), &b.cpu_ratio(&default, &unmerged)?);
        row(out, &format!("{what}, `--certify` ÷ default"), &b.cpu_ratio(&default.with(&["--certify"]), &default)?);
    }
    Ok(())
}

fn text(b: &Bench, out: &mut String) -> Result<(), ChoreError> {
    let file = b.generate("text.svg", &generated::page(PARAGRAPHS, &b.font))?;
    let (default, usvg) = (b.warp(&file), b.resolve(&file));
    let what = format!("{PARAGRAPHS} paragraphs of {} letters", generated::LETTERS);
    row(out, &format!("{what}, default ÷ usvg"), &b.cpu_ratio(&default, &usvg)?);
    row(out, &format!("{what}, `--nodes source` ÷ usvg"), &b.cpu_ratio(&default.with(&["--nodes", "source"]), &usvg)?);
    row(out, &format!("{what}, `--text skip` ÷ usvg"), &b.cpu_ratio(&default.with(&["--text", "skip"]), &usvg)?);
    Ok(())
}

/// Growth of the CPU time from 10³ segments in steps of ten, and memory for the largest drawing.
fn growth(b: &Bench, out: &mut String) -> Result<(), ChoreError> {
    let start = b.warp(&b.generate("small.svg", &generated::flowers(10, 10))?).median(b.rounds, |u| u.cpu)?;
    for (kind, each) in [("one path", usize::MAX), ("paths of 60", EACH)] {
        let (mut times, mut n, mut peak) = (Vec::new(), 1000, String::new());
        while n <= b.largest {
            let file = b.generate("growth.svg", &generated::flowers(n, each.min(n)))?;
            // The largest drawings take long enough to be measured well in one run.
            let rounds = if n > THREADED { 1 } else { b.rounds };
            let used = b.warp(&file).median(rounds, |u| u.cpu)?;
            times.push((n as f64, used.cpu - start.cpu));
            peak = format!("{:.1} at {n}", memory(&used, &file)?);
            n *= 10;
        }
        let exponents = times.windows(2).map(|w| format!("{:.2}", (w[1].1 / w[0].1).ln() / (w[1].0 / w[0].0).ln()));
        let list: Vec<String> = exponents.collect();
        row(out, &format!("growth with segments, {kind}: exponent from 10³, decade by decade"), &list.join(", "));
        row(out, &format!("peak memory beyond {:.0} MB ÷ bytes of the input, {kind}", FIXED / 1e6), &peak);
    }
    Ok(())
}

fn threads(b: &Bench, out: &mut String) -> Result<(), ChoreError> {
    let n = THREADED.min(b.largest);
    for (kind, each) in [("in one path", n), ("in paths of 60", EACH)] {
        let file = b.generate("threads.svg", &generated::flowers(n, each))?;
        let what = format!("{n} segments {kind}, elapsed time with one thread ÷ two");
        row(out, &what, &speedup(b, &b.warp(&file))?);
    }
    Ok(())
}

/// The ratio of elapsed times with one thread and with two.
fn speedup(b: &Bench, job: &Job) -> Result<String, ChoreError> {
    let with = |jobs: &str| job.with(&["--jobs", jobs]).median(b.rounds, |u| u.wall);
    let (one, two) = (with("1")?, with("2")?);
    Ok(ratio(one.wall, two.wall))
}

/// A batch of files in one process, compared with the usvg crate. Both read every file and write another; pathwarp writes it under a temporary
/// name first.
fn files(b: &Bench, out: &mut String) -> Result<(), ChoreError> {
    let (from, to) = (b.folder.join("batch"), b.folder.join("batch-warped"));
    fs::create_dir_all(&from).map_err(at(&from))?;
    // Drawings that usvg accepts, repeated.
    let accepted: Vec<&PathBuf> = b.drawings.iter().filter(|f| resolved(f).is_some()).collect();
    let mut batch = Vec::with_capacity(BATCH);
    for (i, file) in accepted.iter().cycle().take(BATCH).enumerate() {
        let copy = from.join(format!("{i:04}.svg"));
        fs::copy(file, &copy).map_err(at(file))?;
        batch.push(copy);
    }
    let names = batch.iter().map(|f| f.clone().into_os_string());
    let args = WARP.iter().map(Into::into).chain(names);
    let job = Job::new(&b.program, args).with(&["--on-error", "skip", "--quiet", "--out-dir", &to.to_string_lossy()]);
    row(out, &format!("{BATCH} files in one process, elapsed time with one thread ÷ two"), &speedup(b, &job)?);
    let mut pairs = Vec::with_capacity(b.rounds);
    for _ in 0..b.rounds {
        let ours = job.with(&["--jobs", "1"]).run()?.ok_or("the batch was refused")?.cpu;
        let started = ProcessTime::now();
        for (i, file) in batch.iter().enumerate() {
            let text = resolved(file).ok_or("usvg refused a drawing it had accepted")?;
            let result = b.folder.join(format!("batch-resolved-{i}.svg"));
            fs::write(&result, text).map_err(at(&result))?;
        }
        pairs.push((ours, ProcessTime::now().duration_since(started).as_secs_f64()));
    }
    pairs.sort_by(|x, y| (x.0 / x.1).total_cmp(&(y.0 / y.1)));
    let (ours, theirs) = pairs[pairs.len() / 2];
    let what = format!("{BATCH} files in one process ÷ usvg's crate, which reads, resolves and writes each");
    row(out, &what, &ratio(ours, theirs));
    Ok(())
}

/// A file as the usvg crate writes it; `None` if it refuses the file or would need fonts.
fn resolved(file: &Path) -> Option<String> {
    let text = fs::read_to_string(file).ok()?;
    if text.contains("<text") {
        return None;
    }
    Some(usvg::Tree::from_str(&text, &usvg::Options::default()).ok()?.to_string(&usvg::WriteOptions::default()))
}
