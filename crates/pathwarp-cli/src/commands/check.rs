//! `pathwarp check NAME|FILE`: checks a deformation, built in or a plug-in, as the tests check the built-in ones.

use crate::advice;
use crate::failure::Failure;
use crate::plugins::{Plugins, is_file_name};
use crate::status::Status;
use crate::{output, readable};
use clap::{Arg, ArgMatches, Command};
use pathwarp::check::{Check, frame, report};
use pathwarp::deform::{Deformation, Registry};
use pathwarp::kurbo::Point;
use pathwarp::map::{Jet, Map};
use pathwarp::param::Args;
use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

pub(super) const NAME: &str = "check";

pub(super) fn command() -> Command {
    Command::new(NAME)
        .about("Check a deformation, built in or a plug-in: help, parameters, derivatives, inverse, laws, speed")
        .arg(
            Arg::new("WHAT")
                .required(true)
                .value_name("NAME|FILE")
                .help("A deformation, or the file of a plug-in, which need not be installed"),
        )
        .after_help(
            "The deformation is built from its demo values over the box 0,0,100,100. A law or case that does not hold is shown with \
             the values and the place. A plug-in is started anew, even if it was broken before. The exit code is 1 if \
             something is wrong.\n\nExamples:\n  pathwarp check wave\n  pathwarp check ./pathwarp-ripple.py",
        )
}

pub(super) fn run(registry: &Registry, plugins: &Plugins, m: &ArgMatches) -> Result<Status, Failure> {
    let what = m.get_one::<String>("WHAT").map_or("", String::as_str);
    let by_file = || plugins.last_given().map(|p| p as &dyn Deformation);
    let named = registry.get(what).map(|e| &**e as &dyn Deformation);
    let entry = if is_file_name(Path::new(what)) { by_file() } else { named };
    let Some(entry) = entry else {
        return Err(match plugins.broken.iter().find(|b| b.name == what) {
            Some(b) => b.fault.of(&b.path).into(),
            None => {
                Failure::usage(advice::unknown("deformation", what, registry.entries().iter().map(|e| e.info().name)))
            }
        });
    };
    let name = entry.info().name;
    let mut out = match plugins.get(name) {
        None => format!("{name}, built in\n"),
        Some(p) => format!("{name}, the plug-in {}\n", p.path().display()),
    };
    let checks = report(entry);
    let wrong: usize = checks.iter().filter(|c| !c.faults.is_empty()).count();
    checks.iter().for_each(|check| show(check, &mut out));
    if wrong == 0 {
        if let Some(speed) = speed(entry) {
            let _ = writeln!(out, "  ok    {:<10}  {speed}", "speed");
        }
        let _ = writeln!(out, "{name} is sound");
    } else {
        let _ = writeln!(out, "{name} fails {wrong} of {} checks", checks.len());
    }
    output::to_stdout(out.as_bytes())?;
    Ok(Status::partial_if(wrong > 0))
}

/// The lines of one check.
fn show(check: &Check, out: &mut String) {
    let word = if check.faults.is_empty() { "ok  " } else { "FAIL" };
    let _ = writeln!(out, "  {word}  {:<10}  {}", check.name, readable::message(&check.detail));
    for fault in &check.faults {
        let _ = writeln!(out, "        {:<10}  {}", "", readable::message(fault));
    }
}

/// The time for a point and for a jet, alone and in large batches.
fn speed(entry: &dyn Deformation) -> Option<String> {
    /// Points in a batch.
    const BATCH: usize = 4096;
    /// Calls for single points.
    const CALLS: usize = 50;
    let map = entry.build_from(&Args::from_pairs(entry.info().demo), &frame()).ok()?.map;
    let place = |i: usize| Point::new(3.0 + 0.0231 * i as f64, 97.0 - 0.0229 * i as f64);
    let points: Vec<Point> = (0..BATCH).map(place).collect();
    let (mut images, mut jets) = (points.clone(), vec![Jet::default(); BATCH]);
    let clock = Instant::now();
    map.points(&points, &mut images);
    let point = clock.elapsed() / BATCH as u32;
    let clock = Instant::now();
    map.jets(&points, &mut jets);
    let jet = clock.elapsed() / BATCH as u32;
    let clock = Instant::now();
    points.iter().take(CALLS).for_each(|p| {
        let _ = map.point(*p);
    });
    let call = clock.elapsed() / CALLS as u32;
    Some(format!(
        "{point:.1?} for a point and {jet:.1?} for one with derivatives, in batches of {BATCH}; {call:.1?} for a single one"
    ))
}
